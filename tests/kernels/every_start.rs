//! Climbs from every vertex of hulls whose flat sides hold inner vertices, against a scan in f64: such
//! sides are dented by the rounding of their vertices, and dents are false summits.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DQuat, DVec3, EulerRot, Vec3};
use isa_gjk::internals::stats::Cost;
use isa_gjk::internals::support::{Polytope, Support, VertexId};
use isa_gjk::internals::tolerance::{BOWL_LOSS, SUPPORT_TIE};
use isa_gjk::{Hull, HullError, HullShape, IsaGjkDispatcher};
use parry3d::math::Pose;
use parry3d::shape::SharedShape;
use testkit::divided::{Mesh, divided_block, divided_icosahedron};
use testkit::generate::Rng;
use testkit::memory::{Manifold, UpdateManifolds};

fn build((points, triangles): &Mesh) -> Result<Hull, HullError> {
    let points = points.iter().map(|p| p.as_vec3()).collect();
    Hull::from_triangles(points, triangles)
}

fn map(mesh: &Mesh, mut to: impl FnMut(DVec3) -> DVec3) -> Mesh {
    (mesh.0.iter().map(|&p| to(p)).collect(), mesh.1.clone())
}

/// Normals of faces and their opposites, which are the worst, tilted by little or much; directions
/// across edges, and any.
fn directions(hull: &Hull, rng: &mut Rng) -> Vec<DVec3> {
    const FACES: usize = 4;
    const TILTS: [f64; 8] = [0.0, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2];
    let mut dirs = Vec::new();
    for face in hull.face_ids().step_by(hull.face_count() / FACES + 1) {
        for by in TILTS {
            let dir = hull.face_normal(face) + rng.direction() * by;
            dirs.extend([dir, -dir]);
        }
        let v = VertexId::new(rng.count(0, hull.points().len() - 1));
        let w = hull.neighbors(v).next().expect("a vertex has neighbours");
        dirs.push((hull.vertex(v) - hull.vertex(w)).cross(rng.direction()));
        dirs.push(rng.direction());
    }
    dirs.retain(|dir| dir.length() > 0.0);
    dirs
}

/// The most that a climb loses, in plateaus: from every vertex, or of large hulls from every few.
fn worst_climb(hull: &Hull, rng: &mut Rng) -> f64 {
    const STARTS: usize = 200;
    let step = hull.points().len() / STARTS + 1;
    let mut worst = 0.0_f64;
    for dir in directions(hull, rng) {
        let heights = hull.points().iter().map(|p| dir.dot(p.as_dvec3()));
        let most = heights.fold(f64::NEG_INFINITY, f64::max);
        for start in hull.vertex_ids().step_by(step) {
            let (found, _) = hull.support(dir, start, &mut Cost::default());
            let lost = most - dir.dot(found);
            worst = worst.max(lost / (SUPPORT_TIE * hull.radius() * dir.length()));
        }
    }
    worst
}

/// What `hull/climb.rs` promises of dented hulls, in plateaus.
const PROMISED: f64 = 4.0;

const HALVES: [DVec3; 4] = [
    DVec3::new(1.0, 1.0, 0.5),
    DVec3::new(1.0, 1.0, 0.02),
    DVec3::new(1.0, 0.1, 0.3),
    DVec3::new(1.0, 1.0, 0.001),
];

#[test]
fn climbs_on_divided_sides_end_at_the_top() {
    let mut rng = Rng::new(5);
    for cells in [4, 5, 12, 30, 79] {
        for half in HALVES {
            let by = [
                DQuat::from_euler(EulerRot::XYZ, 1.4, 0.6, 0.0),
                rng.rotation(),
            ];
            for by in by {
                let mesh = map(&divided_block(cells, half), |p| by * p);
                let hull = build(&mesh).expect("a block");
                let worst = worst_climb(&hull, &mut rng);
                assert!(
                    worst <= PROMISED,
                    "{cells} cells of {half}: {worst} plateaus"
                );
            }
        }
    }
}

/// As scanned plates are. Where noise is steeper than building takes there is no hull.
#[test]
fn climbs_on_noisy_sides_end_at_the_top() {
    let mut rng = Rng::new(6);
    let mut built = 0;
    for cells in [4, 12, 30, 79] {
        for half in HALVES {
            for noise in [1e-7, 3e-7, 1e-6] {
                let by = rng.rotation();
                let block = divided_block(cells, half);
                let mesh = map(&block, |p| by * p + rng.direction() * noise);
                let Ok(hull) = build(&mesh) else { continue };
                built += 1;
                let worst = worst_climb(&hull, &mut rng);
                assert!(
                    worst <= PROMISED,
                    "{cells} cells of {half}, {noise}: {worst} plateaus"
                );
            }
        }
    }
    assert!(built >= 25, "only {built} built");
}

#[test]
fn climbs_on_divided_facets_end_at_the_top() {
    let mut rng = Rng::new(7);
    for times in 1..=4 {
        for on_sphere in [false, true] {
            for stretch in [
                DVec3::ONE,
                DVec3::new(1.0, 1.0, 0.01),
                DVec3::new(0.01, 0.01, 1.0),
            ] {
                let by = rng.rotation();
                let mesh = map(&divided_icosahedron(times, on_sphere), |p| {
                    by * (p * stretch)
                });
                let hull = build(&mesh).expect("an icosahedron");
                let worst = worst_climb(&hull, &mut rng);
                assert!(
                    worst <= PROMISED,
                    "{times} times, {on_sphere}, {stretch}: {worst}"
                );
            }
        }
    }
}

/// Each of its edges is a dent that building takes for rounding; all together are none.
#[test]
fn a_bowl_is_not_convex() {
    for cells in [20, 40, 79] {
        let cell = 2.0 / f64::from(cells);
        let bowl = map(&divided_block(cells, HALVES[0]), |p| {
            let rise = 0.5e-6 * p.truncate().length_squared() / (cell * cell);
            p + DVec3::Z * p.z.signum() * rise
        });
        let hull = build(&bowl);
        assert!(
            matches!(hull, Err(HullError::NotConvex(_))),
            "{cells}: {hull:?}"
        );
        let points = bowl.0.iter().map(|p| p.as_vec3()).collect();
        let shape = HullShape::from_triangles(points, &bowl.1);
        assert_eq!(shape.err(), hull.err(), "{cells}");
    }
}

/// Bowls, troughs and funnels so shallow that building takes them: dents that add up. Where the rim is on both
/// sides, a climb towards a tilted direction may end on the lower one.
#[test]
fn climbs_on_shallow_bowls_lose_little() {
    let mut rng = Rng::new(9);
    let (mut built, mut most) = (0, 0.0_f64);
    for cells in [3, 6, 9, 12, 16, 24] {
        for half in HALVES {
            for dent in [0.1e-6, 0.3e-6, 0.5e-6, 0.7e-6, 0.9e-6] {
                let cell = 2.0 / f64::from(cells);
                let kind = rng.count(0, 2);
                let turn = [DQuat::IDENTITY, rng.rotation()][rng.count(0, 1)];
                let bowl = map(&divided_block(cells, half), |p| {
                    let in_cells = (p / half).truncate() / cell;
                    let rise = match kind {
                        0 => in_cells.length_squared(),
                        1 => in_cells.x * in_cells.x,
                        _ => in_cells.length(),
                    };
                    turn * (p + DVec3::Z * p.z.signum() * dent * rise)
                });
                let Ok(hull) = build(&bowl) else { continue };
                built += 1;
                most = most.max(worst_climb(&hull, &mut rng) * SUPPORT_TIE);
            }
        }
    }
    println!("{built} bowls, {most:e} of the radius");
    assert!(built >= 50, "only {built} built");
    assert!(most <= BOWL_LOSS, "{most:e} of the radius");
}

/// The vertex that is remembered lies inside of the side that looks away after the slab turned over.
#[test]
fn a_slab_that_turns_over_keeps_its_contact() {
    let by = DQuat::from_euler(EulerRot::XYZ, 1.4, 0.6, 0.0);
    let (points, triangles) = map(&divided_block(12, HALVES[0]), |p| by * p);
    let points: Vec<Vec3> = points.iter().map(|p| p.as_vec3()).collect();
    let slab = HullShape::from_triangles(points.clone(), &triangles).expect("a slab");
    let slab = SharedShape::new(slab);
    let lying = DQuat::from_rotation_x(-FRAC_PI_2) * by.inverse();
    let grounds = [
        (SharedShape::halfspace(Vec3::Y), 0.0),
        (SharedShape::cuboid(3.0, 1.0, 3.0), 1.0),
    ];
    for (ground, top) in grounds {
        let mut manifolds = Vec::new();
        for turn in [0.0, PI, PI, 0.0, PI] {
            let rotation = (DQuat::from_rotation_x(turn) * lying).as_quat();
            let pose = Pose::from_parts(Vec3::new(0.0, 0.49 + top, 0.0), rotation);
            IsaGjkDispatcher::default()
                .update_manifolds(&pose, [&*ground, &*slab], 0.02, &mut manifolds, &mut None)
                .expect("supported");
            let lowest = |p: &Vec3| pose.transform_point(*p).y - top;
            let lowest = points.iter().map(lowest).fold(f32::INFINITY, f32::min);
            let found: &Manifold = &manifolds[0];
            let deepest = found.find_deepest_contact().map(|point| point.dist);
            let off = deepest.map(|deepest| (deepest - lowest).abs());
            assert!(
                off.is_some_and(|off| off < 1e-5),
                "{deepest:?} instead of {lowest}"
            );
        }
    }
}
