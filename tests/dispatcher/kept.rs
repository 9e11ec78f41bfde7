//! Contacts keep their places on both shapes while these hardly move, and stay correct.

use glam::DVec3;
use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Real, Rotation, Vector};
use parry3d::shape::{HeightField, HeightFieldFlags, SharedShape, TriMeshFlags};
use parry3d::utils::Array2;
use testkit::generate::Rng;
use testkit::memory::{Manifold, Memory, UpdateManifolds, cold_manifold, kept};
use testkit::scenes::hulls;

/// The share of the smaller radius that the two points of a contact may be apart across the normal.
const DRIFT: f64 = 2e-2;
const PREDICTION: Real = 0.02;

fn prism(sides: u32, radius: Real) -> SharedShape {
    hulls::prism(sides, radius, 0.4 * radius).expect("a solid")
}

fn grounds() -> [SharedShape; 3] {
    let corner = |i: u32| {
        let side = |bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
        Vector::new(6.0 * side(0), 0.5 * side(1) - 0.5, 6.0 * side(2))
    };
    let corners: Vec<Vector> = (0..8).map(corner).collect();
    [
        SharedShape::convex_hull(&corners).expect("a slab"),
        SharedShape::cuboid(6.0, 1e-3, 6.0),
        SharedShape::halfspace(Vector::Y),
    ]
}

/// Upright at the origin of the ground, moved and turned by up to `noise`.
fn rocked(height: Real, noise: f64, rng: &mut Rng) -> Pose {
    let small = |rng: &mut Rng| (rng.direction() * noise).as_vec3();
    let turn = Rotation::from_scaled_axis(small(rng));
    Pose::from_parts(Vector::Y * height + small(rng), turn)
}

fn places(manifold: &Manifold) -> Vec<[Vector; 2]> {
    let points = manifold.points.iter();
    points.map(|p| [p.local_p1, p.local_p2]).collect()
}

#[test]
fn contacts_of_a_resting_body_keep_their_places() {
    let mut rng = Rng::new(3);
    for ground in grounds() {
        for sides in [3, 4, 8, 16, 64] {
            for radius in [0.01, 0.05, 1.0] {
                let shape = prism(sides, radius);
                let dispatcher = IsaGjkDispatcher::default();
                let mut memory = Memory::default();
                let mut first = None;
                let what = format!("{sides} sides, radius {radius}");
                for _ in 0..50 {
                    let lift = if ground.as_cuboid().is_some() {
                        1e-3
                    } else {
                        0.0
                    };
                    let noise = 4e-6 * f64::from(radius);
                    let pose = rocked(0.399 * radius + lift, noise, &mut rng);
                    let manifold = memory
                        .update(&dispatcher, &pose, [&ground, &shape], PREDICTION)
                        .expect("supported");
                    assert!(manifold.points.len() >= 3, "{what}");
                    let places = places(manifold);
                    assert_eq!(&places, first.get_or_insert(places.clone()), "{what}");
                }
                let kept = kept(&dispatcher.stats());
                assert!(kept >= 47, "{what}: only {kept} of 49 updates kept");
            }
        }
    }
}

/// Flat squares made of triangles, without flags and with normals corrected for inner edges.
fn triangulated_grounds() -> [SharedShape; 4] {
    let mesh = |flags| {
        let corners = [[-6.0, -6.0], [6.0, -6.0], [6.0, 6.0], [-6.0, 6.0]];
        let corners = corners.map(|[x, z]| Vector::new(x, 0.0, z)).to_vec();
        SharedShape::trimesh_with_flags(corners, vec![[0, 2, 1], [0, 3, 2]], flags).expect("flat")
    };
    let field = |flags| {
        let heights = Array2::new(2, 2, vec![0.0; 4]);
        let size = Vector::new(12.0, 1.0, 12.0);
        SharedShape::new(HeightField::with_flags(heights, size, flags))
    };
    [
        mesh(TriMeshFlags::empty()),
        mesh(TriMeshFlags::FIX_INTERNAL_EDGES),
        field(HeightFieldFlags::empty()),
        field(HeightFieldFlags::FIX_INTERNAL_EDGES),
    ]
}

/// Triangles have the same hysteresis as other shapes, as long as their normals stay uncorrected.
#[test]
fn contacts_on_triangles_keep_their_places() {
    let mut rng = Rng::new(5);
    for (i, ground) in triangulated_grounds().into_iter().enumerate() {
        for sides in [3, 8, 64] {
            let shape = prism(sides, 0.05);
            let dispatcher = IsaGjkDispatcher::default();
            let mut manifolds: Vec<Manifold> = Vec::new();
            let mut workspace = None;
            let mut first = None;
            for _ in 0..50 {
                // Beside the inner edge.
                let mut pose = rocked(0.399 * 0.05, 2e-7, &mut rng);
                pose.translation += Vector::new(3.0, 0.0, -2.0);
                let shapes = [&ground, &shape].map(|shape| &**shape);
                dispatcher
                    .update_manifolds(&pose, shapes, PREDICTION, &mut manifolds, &mut workspace)
                    .expect("supported");
                let mut places: Vec<_> = manifolds.iter().map(places).collect();
                places.retain(|places| !places.is_empty());
                assert_eq!(places.len(), 1, "ground {i}, {sides} sides");
                assert!(places[0].len() >= 3, "ground {i}, {sides} sides");
                let first = first.get_or_insert(places.clone());
                assert_eq!(&places, first, "ground {i}, {sides} sides");
            }
            let kept = kept(&dispatcher.stats());
            assert!(
                kept >= 47,
                "ground {i}, {sides} sides: only {kept} of 49 kept"
            );
        }
    }
}

/// Whatever moves slowly: the kept points are nearly above one another, no distance is below the true one,
/// and the least is the true one.
#[test]
fn kept_contacts_never_show_an_overlap_that_is_not_there() {
    let mut rng = Rng::new(4);
    let dispatcher = IsaGjkDispatcher::default();
    for _ in 0..40 {
        let [a, b] = [(); 2].map(|()| {
            let corners = rng.count(8, 40);
            rng.hull(corners, 1.0)
        });
        // A ball around the shape may be larger than half of its diameter.
        let radius = 0.6 * a.solid.diameter().min(b.solid.diameter());
        let mut memory = Memory::default();
        for pose in rng.trajectory(600, radius * 2.0) {
            let pose = pose.to_f32();
            let shapes = [&a.shape, &b.shape];
            let manifold = memory.update(&dispatcher, &pose, shapes, PREDICTION);
            let manifold = manifold.expect("supported");
            let cold = cold_manifold(&dispatcher, &pose, shapes, PREDICTION);
            let cold = cold.expect("supported");
            let depth = |m: &Manifold| m.find_deepest_contact().map(|p| f64::from(p.dist));
            let (Some(least), Some(exact)) = (depth(manifold), depth(&cold)) else {
                assert_eq!(depth(manifold), depth(&cold));
                continue;
            };
            assert!((least - exact).abs() < 1e-5 * radius, "{least} for {exact}");
            let normal = manifold.local_n1.as_dvec3();
            for point in &manifold.points {
                let between: DVec3 = (pose * point.local_p2 - point.local_p1).as_dvec3();
                let along = between.dot(normal);
                let across = (between - normal * along).length();
                assert!((along - f64::from(point.dist)).abs() < 2e-4 * radius);
                assert!(along > exact - 1e-5 * radius);
                assert!(across < DRIFT * radius, "{across} across");
            }
        }
    }
    let kept = kept(&dispatcher.stats());
    assert!(kept > 500, "only {kept} updates kept their contacts");
}

/// Prisms on each other, beside the edge of the other one or not, tilted by up to a thousandth and trembling
/// by less: all corners are about equally deep, and which of them is the deepest changes from frame to frame.
/// Distance and depth equal those of a cold query, and hardly any update needs a search.
#[test]
fn flush_faces_are_as_deep_as_a_cold_query_finds_them() {
    let mut rng = Rng::new(6);
    let dispatcher = IsaGjkDispatcher::default();
    let judge = IsaGjkDispatcher::default();
    let mut updates = 0;
    for round in 0..240 {
        let [below, above] = [rng.count(3, 9), rng.count(3, 65)].map(|sides| sides as u32);
        let [r1, r2] = [1.0, [0.3, 1.0, 2.0][round % 3]];
        let shapes = [prism(below, r1), prism(above, r2)];
        let depth = [0.0, 1e-4, 3e-3, 2e-2][round / 3 % 4];
        let gap = if depth > 0.0 { -depth } else { 2e-3 };
        let height = 0.4 * (r1 + r2) + gap;
        let mut aside = (rng.direction() * f64::from(r1)).as_vec3();
        aside.y = height;
        let turn = Rotation::from_rotation_y(rng.direction().x as f32);
        let tilt = (rng.direction() * [0.0, 1e-6, 1e-4, 1e-3][round / 12 % 4]).as_vec3();
        let mut memory = Memory::default();
        for _ in 0..20 {
            let tremble = [(); 2].map(|()| (rng.direction() * 1e-7).as_vec3());
            let rotation = Rotation::from_scaled_axis(tilt + tremble[0]) * turn;
            let pose = Pose::from_parts(aside + tremble[1], rotation);
            let sides = [&shapes[0], &shapes[1]];
            let warm = memory.update(&dispatcher, &pose, sides, PREDICTION);
            let warm = warm.expect("supported").clone();
            let cold = cold_manifold(&judge, &pose, sides, PREDICTION).expect("supported");
            let deepest = |m: &Manifold| m.find_deepest_contact().map(|p| f64::from(p.dist));
            let (Some(warm_depth), Some(cold_depth)) = (deepest(&warm), deepest(&cold)) else {
                assert_eq!(deepest(&warm), deepest(&cold), "round {round}");
                continue;
            };
            let off = (warm_depth - cold_depth).abs() / f64::from(r1.min(r2));
            assert!(
                off < 4e-6,
                "round {round}: {off} off a depth of {cold_depth}"
            );
            updates += 1;
        }
    }
    let kept = kept(&dispatcher.stats());
    assert!(
        10 * kept > 8 * updates,
        "only {kept} of {updates} updates kept"
    );
}

/// A body that lies on the edge of another one, and sinks into it: flush faces prove its depth until the way out
/// is to the side.
#[test]
fn flush_faces_do_not_hide_a_shallower_way_out() {
    let dispatcher = IsaGjkDispatcher::default();
    for sides in [4, 16, 64] {
        for overlap in [0.02, 0.1] {
            // The flat sides of both look along x.
            let half_turn = Rotation::from_rotation_y(std::f32::consts::PI / sides as f32);
            let apothem = 2.0 * (std::f32::consts::PI / sides as f32).cos();
            let shapes = [prism(sides, 1.0), prism(sides, 1.0)];
            let mut memory = Memory::default();
            let mut ways = [0; 2];
            for frame in 0..120 {
                let depth = 1e-3 * frame as f32;
                let aside = half_turn * Vector::X * (apothem - overlap);
                let pose = Pose::from_parts(
                    aside + Vector::Y * (0.8 - depth),
                    Rotation::from_rotation_y(1e-5 * frame as f32),
                );
                let sides = [&shapes[0], &shapes[1]];
                let warm = memory.update(&dispatcher, &pose, sides, PREDICTION);
                let warm = warm.expect("supported");
                let cold = cold_manifold(&dispatcher, &pose, sides, PREDICTION);
                let cold = cold.expect("supported");
                let depth = |m: &Manifold| m.find_deepest_contact().expect("touching").dist;
                let off = (depth(warm) - depth(&cold)).abs();
                assert!(off < 4e-6, "frame {frame}: {off} off {}", depth(&cold));
                ways[usize::from(warm.local_n1.y < 0.5)] += 1;
            }
            assert!(ways[0] > 10 && (ways[1] > 10 || overlap > 0.09), "{ways:?}");
        }
    }
}

/// The corners of equal prisms lie on the rims of both, and drift to either side: flush faces prove the depth all the
/// same.
#[test]
fn flush_faces_prove_depths_on_their_rims() {
    const FRAMES: usize = 60;
    for sides in [4, 16, 64] {
        let dispatcher = IsaGjkDispatcher::default();
        let judge = IsaGjkDispatcher::default();
        let shape = prism(sides, 1.0);
        let mut memory = Memory::default();
        for frame in 0..FRAMES {
            let aside = 1.5e-4 * frame as f32;
            let tremble = 1e-6 * (0.7 * frame as f32).sin();
            let turn = Rotation::from_scaled_axis(Vector::new(3e-5, 0.0, 3e-5 + tremble));
            let pose = Pose::from_parts(Vector::new(aside, 0.799, -0.5 * aside), turn);
            let sides = [&shape, &shape];
            let warm = memory.update(&dispatcher, &pose, sides, PREDICTION);
            let warm = warm.expect("supported");
            let cold = cold_manifold(&judge, &pose, sides, PREDICTION).expect("supported");
            let depth = |m: &Manifold| m.find_deepest_contact().expect("touching").dist;
            let off = (depth(warm) - depth(&cold)).abs();
            assert!(off < 4e-6, "frame {frame}: {off} off {}", depth(&cold));
        }
        let stats = dispatcher.stats();
        assert!(
            stats.supports < 2 * FRAMES as u64 && stats.iterations < FRAMES as u64 / 2,
            "{sides} sides: {stats:?}"
        );
    }
}
