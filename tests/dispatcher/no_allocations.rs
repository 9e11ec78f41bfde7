//! No stage allocates once its buffers have grown: counted while coins rest on a box.

use std::f32::consts::TAU;

use glam::Vec3;
use isa_gjk::{HullShape, IsaGjkDispatcher};
use parry3d::math::{Pose, Rotation};
use parry3d::shape::SharedShape;

use crate::counting::allocations;
use testkit::memory::{Manifold, UpdateManifolds};

fn coin(sides: usize) -> Vec<Vec3> {
    let corner = |i: usize| {
        let (sin, cos) = (TAU * i as f32 / sides as f32).sin_cos();
        [-0.2, 0.2].map(|y| Vec3::new(cos, y, sin))
    };
    (0..sides).flat_map(corner).collect()
}

/// Allocations of 200 updates after 220 others. Contacts may keep their places for long, so it takes
/// some updates until every buffer has grown.
fn allocations_at_rest(shapes: [&SharedShape; 2], pose: impl Fn(usize) -> Pose) -> usize {
    let mut manifolds: Vec<Manifold> = Vec::new();
    let dispatcher = IsaGjkDispatcher::default();
    let mut update = |frame| {
        let [a, b] = shapes;
        dispatcher
            .update_manifolds(&pose(frame), [&**a, &**b], 0.02, &mut manifolds, &mut None)
            .expect("supported");
        assert!(!manifolds[0].points.is_empty());
    };
    (0..220).for_each(&mut update);
    let before = allocations();
    (220..420).for_each(&mut update);
    allocations() - before
}

#[test]
fn resting_coins_allocate_nothing() {
    let ground = SharedShape::cuboid(3.0, 1.0, 3.0);
    for sides in [24, 40, 64, 128, 500] {
        let plain = SharedShape::convex_hull(&coin(sides)).expect("a coin");
        let prepared = HullShape::from_points(&coin(sides)).expect("a coin");
        for coin in [plain, SharedShape::new(prepared)] {
            for spin in [0.0, 1e-3] {
                let pose = |frame: usize| {
                    let tilt = 1e-6 * (frame % 7) as f32;
                    let turn =
                        Rotation::from_scaled_axis(Vec3::new(tilt, spin * frame as f32, 0.0));
                    Pose::from_parts(Vec3::new(0.3, 1.199, 0.1), turn)
                };
                for shapes in [[&ground, &coin], [&coin, &coin]] {
                    let lift = if shapes[0].as_cuboid().is_some() {
                        0.0
                    } else {
                        -0.8
                    };
                    let pose = |frame| {
                        let pose = pose(frame);
                        Pose::from_parts(pose.translation + Vec3::Y * lift, pose.rotation)
                    };
                    assert_eq!(
                        allocations_at_rest(shapes, pose),
                        0,
                        "{sides} sides, turning by {spin}"
                    );
                }
            }
        }
    }
}

#[test]
fn resting_capsules_allocate_nothing() {
    let log = SharedShape::capsule_y(0.5, 0.1);
    for spin in [0.0, 1e-3] {
        let pose = |frame: usize| {
            let turn = Rotation::from_scaled_axis(Vec3::new(1e-6, spin, 0.0) * frame as f32);
            Pose::from_parts(Vec3::new(0.199, 0.1, 0.0), turn)
        };
        assert_eq!(
            allocations_at_rest([&log, &log], pose),
            0,
            "turning by {spin}"
        );
    }
}
