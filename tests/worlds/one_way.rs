//! One-way platforms: what comes from above lands on them, and what comes from below passes.
//!
//! rapier's `update_as_oneway_platform` learns from the normal of an empty manifold from where a body comes. A body that
//! falls fast overlaps the platform in its first step in contact, and falls through if it seemed to come from below.

use rapier3d::prelude::*;
use testkit::scenes::hulls;
use testkit::world::ours;

struct OneWay(ColliderHandle);

impl PhysicsHooks for OneWay {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        // In the frame of the first shape, which may tumble.
        let up = if context.collider1 == self.0 {
            Vector::Y
        } else {
            let first = context.colliders[context.collider1].position();
            first.rotation.inverse() * -Vector::Y
        };
        context.update_as_oneway_platform(up, 0.2);
    }
}

/// Of this half width: a hull, a cuboid and a disc, 40 cm high.
fn platforms(half_width: Real) -> [SharedShape; 3] {
    let half = Vector::new(half_width, 0.2, half_width);
    [
        hulls::cuboid(half).expect("a solid"),
        SharedShape::cuboid(half.x, half.y, half.z),
        SharedShape::cylinder(half.y, half.x),
    ]
}

/// Where a body is that starts at a height with a velocity.
fn height_after(
    shapes: [&SharedShape; 2],
    platform_first: bool,
    [height, velocity]: [Real; 2],
    spin: Option<Vector>,
    steps: usize,
) -> Real {
    let mut world = PhysicsWorld {
        narrow_phase: ours(),
        ..PhysicsWorld::default()
    };
    let [platform, body] = shapes.map(|shape| ColliderBuilder::new(shape.clone()));
    let platform = platform.active_hooks(ActiveHooks::MODIFY_SOLVER_CONTACTS);
    let start = RigidBodyBuilder::dynamic()
        .translation(Vector::new(0.1, height, 0.05))
        .linvel(Vector::Y * velocity);
    let start = match spin {
        Some(spin) => start.angvel(spin).rotation(0.3 * spin),
        None => start.lock_rotations(),
    };
    let (hooks, handle) = if platform_first {
        let hooks = OneWay(world.insert_collider(platform, None));
        (hooks, world.insert(start, body).0)
    } else {
        let handle = world.insert(start, body).0;
        (OneWay(world.insert_collider(platform, None)), handle)
    };
    for _ in 0..steps {
        world.step_with_events(&hooks, &());
    }
    world.bodies[handle].translation().y
}

#[test]
fn bodies_land_on_one_way_platforms_and_jump_through_them() {
    let platforms = platforms(3.0);
    let bodies = [
        hulls::cuboid(Vector::splat(0.25)).expect("a solid"),
        SharedShape::cuboid(0.25, 0.25, 0.25),
        SharedShape::cylinder(0.25, 0.25),
        SharedShape::ball(0.25),
    ];
    for platform in &platforms {
        for body in &bodies {
            for first in [true, false] {
                let what = || format!("{:?} on {:?}", body.shape_type(), platform.shape_type());
                // It falls from above, or jumps from below and falls then.
                for start in [[1.5, 0.0], [2.0, -3.0], [-0.8, 9.0]] {
                    let end = height_after([platform, body], first, start, None, 240);
                    assert!((end - 0.45).abs() < 0.02, "{}, {start:?}: {end}", what());
                }
                let passed = height_after([platform, body], first, [-0.8, 9.0], None, 20);
                assert!(passed > 0.5, "{} stops at {passed}", what());
            }
        }
    }
}

/// Wherever they tumble to, they end on the platform, whichever shape is first. (If the empty manifold of a body that is
/// first tells the normal in the frame of the platform, some fall through.)
#[test]
fn bodies_that_tumble_land_on_one_way_platforms() {
    let platforms = platforms(6.0);
    let bodies = [
        hulls::cuboid(Vector::splat(0.25)).expect("a solid"),
        hulls::cuboid(Vector::splat(0.8)).expect("a solid"),
        SharedShape::cylinder(0.25, 0.25),
    ];
    for platform in &platforms {
        for body in &bodies {
            for (seed, first) in (0..8).flat_map(|seed| [(seed, true), (seed, false)]) {
                let angles = Vector::new(1.7, 2.3, 3.1) * seed as Real;
                let spin = Vector::new(angles.x.sin(), angles.y.cos(), angles.z.sin()) * 6.0;
                let end = height_after([platform, body], first, [2.5, -6.0], Some(spin), 240);
                let what = || format!("{:?} on {:?}", body.shape_type(), platform.shape_type());
                assert!(end > 0.3, "{}, {seed}, {first}: {end}", what());
            }
        }
    }
}
