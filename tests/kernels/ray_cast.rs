//! The ray cast against bisection on the distance, which is a convex function of time.

use glam::{DQuat, DVec3, Vec3};
use isa_gjk::Hull;
use isa_gjk::internals::gjk::{self, Outcome};
use isa_gjk::internals::pose::RelativePose;
use isa_gjk::internals::ray_cast::{RayCast, ray_cast};
use isa_gjk::internals::simplex::{Johnson, SignedVolumes, Voronoi};
use isa_gjk::internals::stats::Cost;
use isa_gjk::internals::support::{Cso, Support, VertexId};
use parry3d::math::Pose;
use testkit::cases::{self, hulls};
use testkit::generate::Rng;
use testkit::report::{Finding, Report};

/// Relative to the pair's size: what the cast calls touching after a way of a few sizes.
const TOLERANCE: f64 = 1.0e-7;

/// A shape that is elsewhere, exactly.
struct Shifted<'a, S> {
    shape: &'a S,
    by: DVec3,
}

impl<S: Support> Support for Shifted<'_, S> {
    fn support(&self, dir: DVec3, start: VertexId, cost: &mut Cost) -> (DVec3, VertexId) {
        let (point, id) = self.shape.support(dir, start, cost);
        (point + self.by, id)
    }
    fn start_vertex(&self, dir: DVec3) -> VertexId {
        self.shape.start_vertex(dir)
    }
    fn clamp_vertex(&self, vertex: VertexId) -> VertexId {
        self.shape.clamp_vertex(vertex)
    }
    fn center(&self) -> DVec3 {
        self.shape.center() + self.by
    }
    fn radius(&self) -> f64 {
        self.shape.radius()
    }
}

/// A cast to be checked.
struct Cast<'a> {
    shapes: [&'a Hull; 2],
    pose: RelativePose,
    velocity: DVec3,
    target: f64,
}

impl<'a> Cast<'a> {
    fn cso(&self) -> Cso<'_, Hull, Hull> {
        Cso {
            shape_1: self.shapes[0],
            shape_2: self.shapes[1],
            pose: &self.pose,
        }
    }

    fn run(&self, max_time: f64) -> RayCast {
        let mut cost = Cost::default();
        let hit =
            ray_cast::<Voronoi, _, _>(&self.cso(), self.velocity, max_time, self.target, &mut cost);
        assert_eq!(cost.fallbacks, 0, "stalled after {} steps", cost.iterations);
        hit
    }

    fn shifted(&self, time: f64) -> Shifted<'a, Hull> {
        Shifted {
            shape: self.shapes[1],
            by: self.pose.direction_to_2(self.velocity * time),
        }
    }

    /// The distance of the shapes after some time; zero where they overlap.
    fn distance(&self, time: f64) -> f64 {
        let cso = Cso {
            shape_1: self.shapes[0],
            shape_2: &self.shifted(time),
            pose: &self.pose,
        };
        let mut cost = Cost::default();
        let start = cso.support(DVec3::X, cso.start_vertices(DVec3::X), &mut cost);
        match gjk::distance::<Voronoi, _, _>(&cso, &[start], f64::INFINITY, &mut cost) {
            Outcome::Disjoint(near) | Outcome::Unsure(near) => near.distance,
            Outcome::Overlapping(_) => 0.0,
            Outcome::Separated(_) => unreachable!("nothing is beyond infinity"),
        }
    }

    /// How far the shapes are apart along `normal` after some time.
    fn separation(&self, normal: DVec3, time: f64) -> f64 {
        let cso = Cso {
            shape_1: self.shapes[0],
            shape_2: &self.shifted(time),
            pose: &self.pose,
        };
        -normal.dot(
            cso.support(normal, cso.start_vertices(normal), &mut Cost::default())
                .w,
        )
    }

    /// The time up to `max_time` at which the shapes are nearest.
    fn nearest_time(&self, max_time: f64) -> f64 {
        let (mut low, mut high) = (0.0, max_time);
        for _ in 0..100 {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            // The lowest level can be flat; its early end is what counts.
            if self.distance(a) <= self.distance(b) {
                high = b;
            } else {
                low = a;
            }
        }
        low
    }

    /// The first time within the target distance, given a time that is.
    fn first_time(&self, touching: f64) -> f64 {
        let (mut apart, mut touching) = (0.0, touching);
        for _ in 0..100 {
            let middle = 0.5 * (apart + touching);
            if self.distance(middle) > self.target {
                apart = middle;
            } else {
                touching = middle;
            }
        }
        touching
    }

    fn judge(&self, max_time: f64, size: f64) -> (&'static str, Finding) {
        let mut finding = Finding::default();
        let answer = self.run(max_time);
        let nearest_time = self.nearest_time(max_time);
        let nearest = self.distance(nearest_time) - self.target;
        let at_start = self.distance(0.0) - self.target;
        let kind = match answer {
            RayCast::Miss => {
                finding.at_most("overlooked", -nearest / size, TOLERANCE);
                finding.require(nearest > 0.0 || self.distance(nearest_time) > 0.0, || {
                    "passed through".into()
                });
                "miss"
            }
            RayCast::Overlap => {
                finding.at_most("not yet there", at_start / size, TOLERANCE);
                "overlap"
            }
            RayCast::Hit(hit) => {
                let reach = self.distance(hit.time) - self.target;
                finding.at_most("not there", reach / size, TOLERANCE);
                if nearest < 0.0 || self.distance(nearest_time) == 0.0 {
                    let late = hit.time - self.first_time(nearest_time);
                    let speed = self.velocity.length();
                    finding.at_most("late", late * speed / size, TOLERANCE);
                }
                finding.at_most("normal", (hit.normal.length() - 1.0).abs(), 1.0e-12);
                let regret = self.target - self.separation(hit.normal, hit.time);
                finding.at_most("regret", regret / size, TOLERANCE);
                finding.require(self.velocity.dot(hit.normal) < 0.0, || "moving away".into());
                let gap = hit.on_2 - hit.on_1 - hit.normal * self.target;
                finding.at_most("witness gap", gap.length() / size, TOLERANCE);
                let on_2 = hit.on_2 - self.velocity * hit.time;
                let outside = outside(self.shapes[0], hit.on_1)
                    .max(outside(self.shapes[1], self.pose.point_to_2(on_2)));
                finding.at_most("witness outside", outside / size, 1.0e-6);
                "hit"
            }
        };
        (kind, finding)
    }
}

/// How far a point is beyond the plane it violates most.
fn outside(hull: &Hull, point: DVec3) -> f64 {
    use isa_gjk::internals::support::Polytope;
    hull.face_ids()
        .map(|f| hull.face_normal(f).dot(point) - hull.face_offset(f))
        .fold(f64::NEG_INFINITY, f64::max)
}

fn rebuilt(hull: &cases::Hull) -> Hull {
    let points = hull.solid.points.iter().map(|p| p.as_vec3()).collect();
    Hull::from_triangles(points, hull.solid.faces()).expect("a published hull is convex")
}

/// A random approach of `b` towards `a`: most hit, some pass by, some start inside.
fn roll<'a>(rng: &mut Rng, shapes: [&'a Hull; 2]) -> Cast<'a> {
    let size = shapes[0].radius() + shapes[1].radius();
    let from = rng.direction() * size * rng.range(0.2, 3.0);
    let aim = rng.direction() * size * rng.range(0.0, 0.9);
    let target = if rng.range(0.0, 1.0) < 0.5 {
        0.0
    } else {
        size * rng.range(0.0, 0.2)
    };
    let pose = Pose::from_parts(from.as_vec3(), rng.rotation().as_quat());
    Cast {
        shapes,
        pose: RelativePose::new(&pose).expect("a finite pose"),
        velocity: (aim - from) * rng.range(0.1, 10.0),
        target,
    }
}

fn judge_rolls<'a>(casts: usize, seed: u128, mut pair: impl FnMut(&mut Rng) -> [&'a Hull; 2]) {
    let mut report = Report::new("casts");
    let mut rng = Rng::new(seed);
    let mut kinds = std::collections::BTreeMap::<_, usize>::new();
    for i in 0..casts {
        let shapes = pair(&mut rng);
        let cast = roll(&mut rng, shapes);
        let size = shapes[0].radius() + shapes[1].radius();
        let way = size * rng.range(1.0, 6.0);
        let (kind, finding) = cast.judge(way / cast.velocity.length(), size);
        *kinds.entry(kind).or_default() += 1;
        report.add(kind, &format!("cast {i}"), finding);
    }
    report.conclude();
    assert_eq!(kinds.len(), 3, "not every outcome occurred: {kinds:?}");
}

#[test]
fn random_hulls_touch_when_bisection_says() {
    let mut rng = Rng::new(2004);
    let hulls: Vec<Hull> = [4, 8, 20, 60, 200]
        .into_iter()
        .flat_map(|n| [n, n])
        .map(|n| rebuilt(&rng.hull(n, 1.0)))
        .collect();
    judge_rolls(1500, 1, |rng| {
        [0, 1].map(|_| &hulls[rng.count(0, hulls.len() - 1)])
    });
}

#[test]
fn published_hulls_touch_when_bisection_says() {
    let mut names: Vec<_> = hulls().keys().collect();
    names.sort();
    let built: Vec<Hull> = names.iter().map(|n| rebuilt(&hulls()[*n])).collect();
    judge_rolls(1500, 2, |rng| {
        [0, 1].map(|_| &built[rng.count(0, built.len() - 1)])
    });
}

fn cube() -> Hull {
    let corner = |i: u32| Vec3::from_array([0, 1, 2].map(|k| (i >> k & 1) as f32 - 0.5));
    let corners: Vec<Vec3> = (0..8).map(corner).collect();
    Hull::from_points(&corners).expect("a cube is a hull")
}

/// Two unit cubes; the second starts at `from` without rotation.
fn cubes(cube: &Hull, from: Vec3, velocity: DVec3) -> Cast<'_> {
    Cast {
        shapes: [cube, cube],
        pose: RelativePose::new(&Pose::from_translation(from)).expect("a finite pose"),
        velocity,
        target: 0.0,
    }
}

fn expect_hit(answer: RayCast) -> isa_gjk::internals::ray_cast::Impact {
    match answer {
        RayCast::Hit(impact) => impact,
        other => panic!("{other:?} instead of a hit"),
    }
}

#[test]
fn a_cube_falls_on_a_cube() {
    let cube = cube();
    let hit = expect_hit(cubes(&cube, Vec3::Y * 3.0, DVec3::NEG_Y * 4.0).run(f64::INFINITY));
    assert!((hit.time - 0.5).abs() < 1.0e-12, "{hit:?}");
    assert!(hit.normal.distance(DVec3::Y) < 1.0e-12, "{hit:?}");
    assert!(hit.on_1.distance(hit.on_2) < 1.0e-9, "{hit:?}");
    let mut rounded = cubes(&cube, Vec3::Y * 3.0, DVec3::NEG_Y * 4.0);
    rounded.target = 0.5;
    let hit = expect_hit(rounded.run(1.0));
    assert!((hit.time - 0.375).abs() < 1.0e-7, "{hit:?}");
}

#[test]
fn time_runs_out_just_before_and_just_after() {
    let cube = cube();
    let cast = cubes(&cube, Vec3::X * 2.0, DVec3::NEG_X);
    assert_eq!(cast.run(1.0 - 1.0e-9), RayCast::Miss);
    assert!(matches!(cast.run(1.0 + 1.0e-9), RayCast::Hit(_)));
}

#[test]
fn grazing_is_decided_to_rounding() {
    let cube = cube();
    for offset in [0.999_f32, 0.999_999] {
        let cast = cubes(&cube, Vec3::new(3.0, offset, 0.0), DVec3::NEG_X);
        let hit = expect_hit(cast.run(f64::INFINITY));
        assert!((hit.time - 2.0).abs() < 1.0e-9, "{hit:?}");
        assert!(hit.normal.distance(DVec3::X) < 1.0e-9, "{hit:?}");
    }
    for offset in [1.001_f32, 1.000_001] {
        let cast = cubes(&cube, Vec3::new(3.0, offset, 0.0), DVec3::NEG_X);
        assert_eq!(cast.run(f64::INFINITY), RayCast::Miss, "{offset}");
    }
}

#[test]
fn standing_or_leaving_shapes_never_meet() {
    let cube = cube();
    let from = Vec3::new(0.3, 1.5, 0.1);
    for velocity in [DVec3::ZERO, DVec3::Y, DVec3::X, DVec3::new(3.0, 1e-9, 1.0)] {
        let cast = cubes(&cube, from, velocity);
        assert_eq!(cast.run(f64::INFINITY), RayCast::Miss, "{velocity}");
    }
}

#[test]
fn overlap_at_the_start_is_named_whatever_the_motion() {
    let cube = cube();
    for velocity in [DVec3::ZERO, DVec3::X, DVec3::NEG_Y * 1.0e6] {
        for height in [0.0, 0.5, 1.0] {
            let cast = cubes(&cube, Vec3::Y * height, velocity);
            assert_eq!(cast.run(1.0), RayCast::Overlap, "{velocity} {height}");
        }
        let mut cast = cubes(&cube, Vec3::Y * 1.25, velocity);
        cast.target = 0.3;
        assert_eq!(cast.run(1.0), RayCast::Overlap, "{velocity}");
    }
}

#[test]
fn units_of_length_and_time_do_not_matter() {
    let cube = cube();
    for speed in [1.0e-150, 1.0e-12, 1.0e12, 1.0e150] {
        let hit = expect_hit(cubes(&cube, Vec3::Y * 2.0, DVec3::NEG_Y * speed).run(f64::INFINITY));
        assert!((hit.time * speed - 1.0).abs() < 1.0e-9, "{hit:?}");
    }
    let far = cubes(&cube, Vec3::X * 1.0e6, DVec3::new(-1.0e3, 1.0e-6, 0.0));
    let hit = expect_hit(far.run(f64::INFINITY));
    assert!((hit.time - 999.999).abs() < 1.0e-6, "{hit:?}");
}

#[test]
fn input_that_is_not_finite_ends_soon() {
    let cube = cube();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for velocity in [DVec3::splat(bad), DVec3::new(0.0, bad, 0.0)] {
            let mut cost = Cost::default();
            let cast = cubes(&cube, Vec3::Y * 3.0, velocity);
            let answer = ray_cast::<Voronoi, _, _>(&cast.cso(), velocity, 1.0, 0.0, &mut cost);
            assert_eq!(answer, RayCast::Miss, "{velocity}");
        }
        let mut cost = Cost::default();
        let cast = cubes(&cube, Vec3::Y * 3.0, DVec3::NEG_Y);
        ray_cast::<Voronoi, _, _>(&cast.cso(), DVec3::NEG_Y, bad, bad, &mut cost);
        assert!(cost.iterations <= 256);
    }
    let cast = cubes(&cube, Vec3::Y * 3.0, DVec3::NEG_Y);
    assert_eq!(cast.run(f64::NAN), RayCast::Miss);
}

#[test]
fn the_distance_subalgorithms_agree() {
    let mut rng = Rng::new(7);
    let hulls = [30, 80].map(|n| rebuilt(&rng.hull(n, 1.0)));
    let mut hits = 0;
    for _ in 0..200 {
        let cast = roll(&mut rng, [&hulls[0], &hulls[1]]);
        let (cso, velocity, target) = (cast.cso(), cast.velocity, cast.target);
        let mut cost = Cost::default();
        let answers = [
            ray_cast::<Voronoi, _, _>(&cso, velocity, f64::INFINITY, target, &mut cost),
            ray_cast::<Johnson, _, _>(&cso, velocity, f64::INFINITY, target, &mut cost),
            ray_cast::<SignedVolumes, _, _>(&cso, velocity, f64::INFINITY, target, &mut cost),
        ];
        let times = answers.map(|answer| match answer {
            RayCast::Hit(hit) => hit.time,
            RayCast::Overlap => 0.0,
            RayCast::Miss => f64::MAX,
        });
        hits += usize::from(times[0] > 0.0 && times[0] < f64::MAX);
        for time in times {
            assert!((time - times[0]).abs() <= 1.0e-7 * times[0], "{answers:?}");
        }
    }
    assert!(hits > 50, "only {hits} hits");
}

#[test]
fn a_rotated_pose_turns_the_answer_with_it() {
    let cube = cube();
    let turn = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_4);
    let pose = Pose::from_parts(Vec3::X * 3.0, turn.as_quat());
    let cast = Cast {
        shapes: [&cube, &cube],
        pose: RelativePose::new(&pose).expect("a finite pose"),
        velocity: DVec3::NEG_X,
        target: 0.0,
    };
    let hit = expect_hit(cast.run(f64::INFINITY));
    let edge_first = 3.0 - 0.5 - 0.5 * 2.0_f64.sqrt();
    assert!((hit.time - edge_first).abs() < 1.0e-6, "{hit:?}");
    assert!(hit.normal.distance(DVec3::X) < 1.0e-6, "{hit:?}");
}
