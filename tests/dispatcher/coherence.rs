//! What the dispatcher remembers may make it faster, never wrong.
//!
//! The state of a pair lives in the manifold that rapier keeps for it, so it can be anything: a
//! frame old, a teleport old, made by another dispatcher, made for other shapes, or nonsense.
//! Whatever it is, the answer must be the one a cold query gives, and the manifold must keep the
//! contract that the solver relies on.

use isa_gjk::{HullShape, IsaGjkDispatcher};
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::{DefaultQueryDispatcher, TrackedContact};
use parry3d::shape::{PackedFeatureId, SharedShape};
use testkit::cases::{Hull, hulls, trajectories};
use testkit::generate::Rng;
use testkit::memory::{Manifold, Memory, UpdateManifolds};
use testkit::report::Report;
use testkit::scene::{Scene, random_scene};

/// Follows one pair through its frames, both ways round, and compares with cold queries.
fn follow<'a>(report: &mut Report, name: &str, scenes: impl Iterator<Item = (String, Scene<'a>)>) {
    let dispatcher = IsaGjkDispatcher::default();
    let (mut memory, mut mirrored) = (Memory::default(), Memory::default());
    for (id, scene) in scenes {
        let cold = scene.cold(&dispatcher);
        let warm = scene.update(&dispatcher, &mut memory);
        report.add(
            &format!("{name}, warm"),
            &id,
            scene.judge_warm(warm, cold.as_ref()),
        );
        report.add(&format!("{name}, cold"), &id, scene.judge(cold.as_ref()));

        let swapped = scene.swapped();
        let warm = swapped.update(&dispatcher, &mut mirrored);
        report.add(
            &format!("{name}, warm, swapped"),
            &id,
            swapped.judge_warm(warm, cold.as_ref()),
        );
    }
}

/// Two hulls of 8 to 300 corners, and about how far apart their centres are when they touch.
fn random_pair(rng: &mut Rng) -> (Hull, Hull, f64) {
    let [a, b] = [(); 2].map(|()| {
        let corners = if rng.range(0.0, 1.0) < 0.2 {
            rng.count(100, 300)
        } else {
            rng.count(8, 100)
        };
        let size = rng.range(0.5, 1.5);
        rng.hull(corners, size)
    });
    let reach = 0.5 * (a.solid.diameter() + b.solid.diameter());
    (a, b, reach)
}

#[test]
fn published_trajectories_are_answered_warm_as_cold() {
    let mut report = Report::new("published trajectories");
    for frames in trajectories() {
        let scenes = frames.iter().map(|case| {
            let (a, b) = (&hulls()[&case.shape_a], &hulls()[&case.shape_b]);
            let scene = Scene {
                solids: [&a.solid, &b.solid],
                shapes: [&a.shape, &b.shape],
                pose: case.pose(),
                exact: case.signed_distance,
                scale: case.scale,
            };
            (case.id.clone(), scene)
        });
        follow(&mut report, "manifold", scenes);
    }
    report.conclude();
}

#[test]
fn smooth_motions_are_answered_warm_as_cold() {
    let mut report = Report::new("smooth random motions");
    let mut rng = Rng::new(1);
    for motion in 0..100 {
        let (a, b, reach) = random_pair(&mut rng);
        let poses = rng.trajectory(60, reach);
        let scenes = poses.into_iter().enumerate().map(|(frame, pose)| {
            let id = format!("motion {motion} frame {frame}");
            (id, Scene::new(&a, &b, pose))
        });
        follow(&mut report, "manifold", scenes);
    }
    report.conclude();
}

#[test]
fn a_teleport_is_answered_as_if_nothing_were_remembered() {
    let mut report = Report::new("teleports");
    let mut rng = Rng::new(2);
    for motion in 0..100 {
        let (a, b, reach) = random_pair(&mut rng);
        let mut poses = rng.trajectory(40, reach);
        for frame in (7..40).step_by(4) {
            poses[frame] = rng.pose(1.2 * reach);
        }
        let scenes = poses.into_iter().enumerate().map(|(frame, pose)| {
            let id = format!("motion {motion} frame {frame}");
            (id, Scene::new(&a, &b, pose))
        });
        follow(&mut report, "manifold", scenes);
    }
    report.conclude();
}

/// Rolled back, copied to another world or stepped by another dispatcher, a pair goes on as it
/// would have gone on, to the last bit.
#[test]
fn a_copy_goes_on_alike() {
    let mut rng = Rng::new(8);
    for _ in 0..20 {
        let (a, b, reach) = random_pair(&mut rng);
        let poses = rng.trajectory(60, reach);
        let shapes = [&a.shape, &b.shape];
        let dispatcher = IsaGjkDispatcher::default();
        let mut memory = Memory::default();
        let mut history = Vec::new();
        for pose in &poses {
            history.push(memory.clone());
            memory.update(&dispatcher, &pose.to_f32(), shapes, 0.02);
        }
        for start in [10, 25, 30, 45] {
            let mut copy = history[start].clone();
            let dispatcher = IsaGjkDispatcher::default();
            for frame in start..start + 10 {
                copy.update(&dispatcher, &poses[frame].to_f32(), shapes, 0.02);
                let (now, then) = (&copy.manifolds, &history[frame + 1].manifolds);
                assert_eq!(format!("{now:?}"), format!("{then:?}"), "frame {frame}");
            }
        }
    }
}

/// Queries `scene` with a memory that is not its own, twice: the second frame sees what the
/// first one made of it.
fn judge_with(report: &mut Report, route: &str, id: &str, scene: &Scene, mut memory: Memory) {
    let dispatcher = IsaGjkDispatcher::default();
    for frame in ["first frame", "second frame"] {
        let manifold = scene.update(&dispatcher, &mut memory);
        report.add(&format!("{route}, {frame}"), id, scene.judge(manifold));
    }
}

#[test]
fn manifolds_of_another_dispatcher_do_no_harm() {
    let mut report = Report::new("manifolds filled by parry");
    let mut rng = Rng::new(3);
    for pair in 0..100 {
        let (a, b, reach) = random_pair(&mut rng);
        let scene = random_scene(&mut rng, &a, &b, reach);
        let earlier = random_scene(&mut rng, &a, &b, reach);
        for (route, source) in [("same pose", &scene), ("another pose", &earlier)] {
            let mut memory = Memory::default();
            DefaultQueryDispatcher
                .update_manifolds(
                    &source.pose.to_f32(),
                    [&**source.shapes[0], &**source.shapes[1]],
                    source.prediction(),
                    &mut memory.manifolds,
                    &mut memory.workspace,
                )
                .expect("parry supports hulls");
            judge_with(&mut report, route, &format!("pair {pair}"), &scene, memory);
        }
    }
    report.conclude();
}

#[test]
fn manifolds_of_larger_hulls_do_no_harm() {
    let mut report = Report::new("manifolds of other hulls");
    let mut rng = Rng::new(4);
    for pair in 0..100 {
        let [large_a, large_b] = [(); 2].map(|()| rng.hull(300, 1.0));
        let [small_a, small_b] = [(); 2].map(|()| {
            let corners = rng.count(4, 12);
            rng.hull(corners, 1.0)
        });
        let large = random_pose_scene(&mut rng, &large_a, &large_b);
        let small = random_scene(&mut rng, &small_a, &small_b, 1.0);
        let mut memory = Memory::default();
        large.update(&IsaGjkDispatcher::default(), &mut memory);
        memory.workspace = None;
        judge_with(
            &mut report,
            "indices out of range",
            &format!("pair {pair}"),
            &small,
            memory,
        );
    }
    report.conclude();
}

/// A pose of hulls that only serve to fill a manifold: no oracle needed.
fn random_pose_scene<'a>(rng: &mut Rng, a: &'a Hull, b: &'a Hull) -> Scene<'a> {
    Scene {
        solids: [&a.solid, &b.solid],
        shapes: [&a.shape, &b.shape],
        pose: rng.pose(1.2),
        exact: f64::NAN,
        scale: 1.0,
    }
}

#[test]
fn manifolds_full_of_nonsense_do_no_harm() {
    let mut report = Report::new("nonsense in the manifold");
    let mut rng = Rng::new(5);
    let nonsense = [
        Vector::ZERO,
        Vector::NAN,
        Vector::INFINITY,
        Vector::NEG_INFINITY,
        Vector::MAX,
        Vector::splat(1.0e-40),
        Vector::new(7.0, -3.0, 1.0e9),
        Vector::new(0.5, Real::NAN, 4.0e9),
    ];
    for pair in 0..12 {
        let (a, b, reach) = random_pair(&mut rng);
        let scene = random_scene(&mut rng, &a, &b, reach);
        for n1 in nonsense {
            for n2 in nonsense {
                for (route, points) in [("no points", 0), ("one point", 1), ("four points", 4)] {
                    let memory = Memory {
                        manifolds: vec![nonsensical_manifold(n1, n2, points)],
                        workspace: None,
                    };
                    let id = format!("pair {pair}, n1 {n1:?}, n2 {n2:?}");
                    judge_with(&mut report, route, &id, &scene, memory);
                }
            }
        }
    }
    report.conclude();
}

fn nonsensical_manifold(n1: Vector, n2: Vector, points: u32) -> Manifold {
    let mut manifold = Manifold::new();
    manifold.local_n1 = n1;
    manifold.local_n2 = n2;
    manifold.points = (0..points)
        .map(|i| {
            let feature1 = PackedFeatureId::vertex(1000 * i);
            let feature2 = PackedFeatureId::face(1000 * i);
            TrackedContact::new(n2, n1, feature1, feature2, n1.x)
        })
        .collect();
    manifold
}

/// Two tips that are the first vertices of their hulls; what was there before had more vertices.
#[test]
fn a_vertex_that_a_shape_has_not_is_no_feature() {
    let triangles = [[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]];
    let tip = [
        Vector::ZERO,
        Vector::new(-0.5, 1.0, -0.5),
        Vector::new(0.5, 1.0, -0.5),
        Vector::new(0.0, 1.0, 0.5),
    ];
    let hull = |points: [Vector; 4], triangles: &[[u32; 3]]| {
        let shape = HullShape::from_triangles(points.to_vec(), triangles);
        SharedShape::new(shape.expect("a tetrahedron"))
    };
    let lower = hull(tip.map(|p| p * Vector::new(1.0, -1.0, 1.0)), &triangles);
    let upper = hull(tip, &triangles.map(|[a, b, c]| [a, c, b]));
    let ball = SharedShape::ball(0.01);
    for vertex in [3, 4, 100] {
        let id = PackedFeatureId::vertex(vertex);
        for (above, dist) in [(&upper, 0.05), (&ball, 0.04)] {
            let mut memory = Memory {
                manifolds: vec![nonsensical_manifold(Vector::Y, -Vector::Y, 1)],
                ..Memory::default()
            };
            let point = &mut memory.manifolds[0].points[0];
            (point.fid1, point.fid2) = (id, id);
            let pose = Pose::translation(0.0, 0.05, 0.0);
            let dispatcher = IsaGjkDispatcher::default();
            let manifold = memory.update(&dispatcher, &pose, [&lower, above], 0.1);
            let found = manifold.expect("supported").points[0].dist;
            assert!((found - dist).abs() < 1e-6, "vertex {vertex}: {found}");
        }
    }
}

/// An axis that is longer than 1 would show a gap that is wider than it is.
#[test]
fn an_axis_that_is_no_unit_vector_loses_no_contact() {
    let cube = &hulls()["box_unit"].shape;
    let width = cube.compute_local_aabb().extents().x;
    let pose = Pose::translation(1.9997 * width, 0.0, 0.0);
    for length in [1.0004, 1.00001, 0.9996] {
        let mut memory = Memory {
            manifolds: vec![nonsensical_manifold(Vector::X * length, Vector::ZERO, 0)],
            ..Memory::default()
        };
        let dispatcher = IsaGjkDispatcher::default();
        let manifold = memory.update(&dispatcher, &pose, [cube, cube], width);
        let deepest = manifold.and_then(|m| m.find_deepest_contact());
        let dist = deepest.expect("within the prediction").dist;
        assert!((dist - 0.9997 * width).abs() < 1e-5 * width, "{dist}");
    }
}
