//! Hill climbing against a full scan: the counterexample to the plain climb, then every published
//! hull in every kind of direction.

use std::f64::consts::TAU;

use glam::{DQuat, DVec2, DVec3, Vec3};
use isa_gjk::Hull;
use isa_gjk::internals::stats::Cost;
use isa_gjk::internals::support::{FaceId, Polytope, Support, VertexId};
use isa_gjk::internals::tolerance::{MAX_DENT, SUPPORT_TIE};
use testkit::cases::hulls;
use testkit::generate::Rng;

/// The climb as it was published (Cameron 1997): move to a better neighbour while there is one.
/// Kept here to show where it fails.
fn plain_climb(
    start: usize,
    value: impl Fn(usize) -> f64,
    neighbors: impl Fn(usize) -> Vec<usize>,
) -> usize {
    let mut at = start;
    loop {
        let around = neighbors(at);
        match around.into_iter().find(|&w| value(w) > value(at)) {
            Some(better) => at = better,
            None => return at,
        }
    }
}

#[test]
fn the_plain_climb_is_trapped_in_the_middle_of_an_edge() {
    let triangle = [(-1.0, 0.0), (0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].map(DVec2::from);
    let edges = [vec![1, 3], vec![0, 2], vec![1, 3], vec![0, 2]];
    let climb = |start| plain_climb(start, |v| triangle[v].y, |v| edges[v].clone());
    assert_eq!([0, 2, 3].map(climb), [3, 3, 3], "other starts are fine");
    assert_eq!(climb(1), 1, "both neighbours tie: it never moves");
}

fn neighbors(hull: &Hull) -> impl Fn(usize) -> Vec<usize> + '_ {
    |v| {
        let around = hull.neighbors(VertexId::new(v));
        around.map(VertexId::index).collect()
    }
}

/// Vertices far from the top in some direction, with all neighbours exactly as high as they are.
fn traps(hull: &Hull) -> Vec<(VertexId, DVec3)> {
    let mut traps = Vec::new();
    for v in hull.vertex_ids() {
        for face in hull.face_ids() {
            let down = -hull.face_normal(face);
            let level = down.dot(hull.vertex(v));
            if level > scan(hull, down) - 0.1 * hull.radius() {
                continue;
            }
            if hull.neighbors(v).all(|w| down.dot(hull.vertex(w)) == level) {
                traps.push((v, down));
            }
        }
    }
    traps
}

#[test]
fn the_plain_climb_is_trapped_inside_of_flat_faces() {
    for name in ["pyramid_grid4", "prism32_rings"] {
        let hull = published(name);
        let traps = traps(&hull);
        assert!(!traps.is_empty(), "{name} was made for this");
        for (v, dir) in traps {
            let value = |v: usize| dir.dot(hull.vertex(VertexId::new(v)));
            let best = scan(&hull, dir);
            let naive = plain_climb(v.index(), value, neighbors(&hull));
            assert!(
                value(naive) < best - 0.1 * hull.radius(),
                "{name}: not a trap"
            );
            let (found, _) = hull.support(dir, v, &mut Cost::default());
            assert_eq!(dir.dot(found), best, "{name}: from {v} along {dir}");
        }
    }
}

fn published(name: &str) -> Hull {
    let solid = &hulls()[name].solid;
    let points = solid.points.iter().map(|p| p.as_vec3()).collect();
    Hull::from_triangles(points, solid.faces()).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// The largest `dir · p`.
fn scan(hull: &Hull, dir: DVec3) -> f64 {
    hull.points()
        .iter()
        .map(|p| dir.dot(p.as_dvec3()))
        .fold(f64::NEG_INFINITY, f64::max)
}

/// What a hull's climbs have lost at worst, as a share of what they may.
#[derive(Default)]
struct Tally {
    climbs: usize,
    worst: f64,
    complaint: String,
}

impl Tally {
    fn climb(
        &mut self,
        name: &str,
        hull: &Hull,
        dir: DVec3,
        starts: impl Iterator<Item = VertexId>,
    ) {
        let best = scan(hull, dir);
        let allowed = SUPPORT_TIE * hull.radius() * dir.length();
        for start in starts {
            let (point, id) = hull.support(dir, start, &mut Cost::default());
            assert_eq!(point, hull.vertex(id));
            let lost = (best - dir.dot(point)) / allowed;
            self.climbs += 1;
            if lost > self.worst {
                self.worst = lost;
                self.complaint = format!("{name}: {lost} of the plateau, from {start} along {dir}");
            }
        }
    }

    fn conclude(self, kind: &str, limit: f64) {
        println!("{kind}: {} climbs, worst {:.3}", self.climbs, self.worst);
        assert!(self.worst <= limit, "{kind}: {}", self.complaint);
    }
}

/// Every published hull as its triangles and as parry triangulates its points.
fn builds() -> Vec<(String, Hull)> {
    let mut names: Vec<_> = hulls().keys().collect();
    names.sort();
    let mut builds = Vec::new();
    for name in names {
        let hull = published(name);
        let from_points =
            Hull::from_points(hull.points()).unwrap_or_else(|e| panic!("{name}: {e}"));
        builds.push((format!("{name} (triangles)"), hull));
        builds.push((format!("{name} (points)"), from_points));
    }
    builds
}

#[test]
fn a_million_random_climbs_end_at_the_top() {
    const CLIMBS: usize = 1_000_000;
    let builds = builds();
    let each = CLIMBS / builds.len() + 1;
    let mut rng = Rng::new(1997);
    let mut tally = Tally::default();
    for (name, hull) in &builds {
        let last = hull.points().len() - 1;
        for _ in 0..each {
            let dir = rng.direction() * 10_f64.powf(rng.range(-6.0, 6.0));
            let start = VertexId::new(rng.count(0, last));
            tally.climb(name, hull, dir, std::iter::once(start));
        }
    }
    assert!(tally.climbs >= CLIMBS);
    tally.conclude("random", 1.0);
}

/// Directions along which many vertices tie, or almost: the normals of faces, and directions
/// square to an edge or along it.
fn adversarial_directions(hull: &Hull, rng: &mut Rng, most: usize) -> Vec<DVec3> {
    let mut exact = Vec::new();
    for _ in 0..most.min(hull.face_count()) {
        let face = FaceId::new(rng.count(0, hull.face_count() - 1));
        exact.push(hull.face_normal(face));
    }
    for _ in 0..most {
        let v = VertexId::new(rng.count(0, hull.points().len() - 1));
        let around: Vec<_> = hull.neighbors(v).collect();
        let edge = hull.vertex(around[rng.count(0, around.len() - 1)]) - hull.vertex(v);
        exact.extend([
            edge,
            edge.cross(rng.direction()),
            edge.cross(hull.vertex(v)),
        ]);
    }
    exact.retain(|d| d.length_squared() > 0.0);
    let nudged: Vec<DVec3> = exact
        .iter()
        .flat_map(|d| [1.0e-7, 1.0e-6, 1.0e-5, 1.0e-4, 1.0e-3].map(|by| (*d, by)))
        .map(|(d, by)| d + rng.direction() * d.length() * by)
        .collect();
    exact.extend(nudged);
    exact.iter().flat_map(|d| [*d, -*d]).collect()
}

/// Every vertex of small hulls; of large ones the vertices around the lowest, and some others.
fn adversarial_starts(hull: &Hull, dir: DVec3, rng: &mut Rng) -> Vec<VertexId> {
    const SMALL: usize = 64;
    let count = hull.points().len();
    if count <= SMALL {
        return hull.vertex_ids().collect();
    }
    let (_, lowest) = hull.support(-dir, hull.start_vertex(-dir), &mut Cost::default());
    let random = (0..8).map(|_| VertexId::new(rng.count(0, count - 1)));
    hull.neighbors(lowest)
        .chain([lowest, hull.start_vertex(dir)])
        .chain(random)
        .collect()
}

fn climb_adversarially(kind: &str, builds: &[(String, Hull)], most: usize, limit: f64) {
    let mut rng = Rng::new(4);
    let mut tally = Tally::default();
    for (name, hull) in builds {
        for dir in adversarial_directions(hull, &mut rng, most) {
            let starts = adversarial_starts(hull, dir, &mut rng);
            tally.climb(name, hull, dir, starts.into_iter());
        }
    }
    tally.conclude(kind, limit);
}

#[test]
fn adversarial_climbs_end_at_the_top() {
    climb_adversarially("adversarial", &builds(), 40, 1.0);
}

/// The hull turned and rounded to f32: its flat faces are flat no longer, its straight edges bent
/// inwards and outwards by a rounding.
fn turned(points: &[Vec3], by: DQuat) -> Vec<Vec3> {
    let turn = |p: &Vec3| (by * p.as_dvec3()).as_vec3();
    points.iter().map(turn).collect()
}

/// The published hulls after a rotation, as far as they can be built, and how many cannot.
fn rounded_builds() -> (Vec<(String, Hull)>, Vec<String>) {
    let mut rng = Rng::new(32);
    let (mut builds, mut refused) = (Vec::new(), Vec::new());
    let mut names: Vec<_> = hulls().keys().collect();
    names.sort();
    for name in names {
        let solid = &hulls()[name].solid;
        let points: Vec<Vec3> = solid.points.iter().map(|p| p.as_vec3()).collect();
        for _ in 0..4 {
            let points = turned(&points, rng.rotation());
            let by_points = Hull::from_points(&points);
            for hull in [Hull::from_triangles(points, solid.faces()), by_points] {
                match hull {
                    Ok(hull) => builds.push((name.clone(), hull)),
                    Err(e) => refused.push(format!("{name}: {e}")),
                }
            }
        }
    }
    (builds, refused)
}

/// What a climb may lose on a hull that is convex only up to f32 rounding, in plateaus.
const ROUNDED: f64 = 4.0;

#[test]
fn climbs_on_rounded_hulls_end_at_the_top() {
    climb_adversarially("rounded", &rounded_builds().0, 10, ROUNDED);
}

/// Rounding may fold a surface; but of the hulls that people have, hardly any.
#[test]
fn rounded_hulls_build() {
    let (builds, refused) = rounded_builds();
    assert!(
        refused.len() * 100 <= builds.len(),
        "{} of {} refused: {refused:#?}",
        refused.len(),
        builds.len()
    );
}

/// Spikes on rough discs, and long prisms: the builder, working in f32, takes their cross-section
/// for rounding, and folds their surface or wraps it around them twice.
fn needles(rng: &mut Rng, length: f64) -> Vec<(String, Hull)> {
    let mut needles = Vec::new();
    for i in 0..80 {
        let mut spike: Vec<DVec3> = (0..20)
            .map(|_| rng.direction() * DVec3::new(1.0, 1.0, 0.01))
            .collect();
        spike.push(DVec3::new(0.001, -0.002, length));
        let sides = rng.count(4, 16);
        let corner = |k: usize| DVec2::from_angle(TAU * k as f64 / sides as f64);
        let prism = (0..sides)
            .flat_map(|k| [-0.5, 0.5].map(|end| corner(k).extend(end * length)))
            .collect();
        for (kind, corners) in [("spike", spike), ("prism", prism)] {
            let points: Vec<Vec3> = corners.iter().map(|p| p.as_vec3()).collect();
            let name = format!("{kind} {i} of 1:{length}");
            let hull = Hull::from_points(&points).unwrap_or_else(|e| panic!("{name}: {e}"));
            needles.push((name, hull));
        }
    }
    needles
}

fn climb_needles(length: f64, limit: f64) {
    let mut rng = Rng::new(1000);
    let needles = needles(&mut rng, length);
    let mut tally = Tally::default();
    for (name, hull) in &needles {
        // Across the needle as often as along it.
        let dirs = (0..200).map(|_| rng.direction() / DVec3::new(1.0, 1.0, length));
        for dir in dirs.collect::<Vec<_>>() {
            tally.climb(name, hull, dir, hull.vertex_ids());
        }
    }
    tally.conclude(&format!("needles of 1:{length}"), limit);
    climb_adversarially(&format!("needles of 1:{length}"), &needles, 20, limit);
}

#[test]
fn climbs_on_needles_end_at_the_top() {
    for length in [30.0, 100.0, 300.0, 1000.0] {
        climb_needles(length, ROUNDED);
    }
}

/// Of needles this thin the cross-section is a few roundings of the length: a climb may lose what
/// their hull may be dented by.
#[test]
fn climbs_on_the_thinnest_needles_end_near_the_top() {
    for length in [1.0e4, 1.0e5] {
        climb_needles(length, 2.0 * MAX_DENT / SUPPORT_TIE);
    }
}

#[test]
fn directions_that_point_nowhere_end_the_climb() {
    let hull = published("rand100");
    for dir in [
        DVec3::ZERO,
        DVec3::NAN,
        DVec3::INFINITY,
        DVec3::splat(f64::MIN_POSITIVE),
    ] {
        let (_, id) = hull.support(dir, VertexId::default(), &mut Cost::default());
        assert!(id.index() < hull.points().len());
    }
}
