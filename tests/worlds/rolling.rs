//! What rolls slowly neither speeds up nor slows down.

use std::f32::consts::FRAC_PI_2;

use rapier3d::prelude::*;
use testkit::scenes::hulls;

const RADIUS: Real = 0.1;
const SPEED: Real = 0.01;

/// The speed after two seconds.
fn rolled(floor: SharedShape, body: SharedShape) -> Real {
    let mut world = PhysicsWorld {
        narrow_phase: testkit::world::ours(),
        ..PhysicsWorld::default()
    };
    let top = floor.compute_local_aabb().maxs.y;
    let floor = ColliderBuilder::new(floor).translation(Vector::NEG_Y * top);
    world.insert_collider(floor, None);
    let lying = Rotation::from_rotation_x(FRAC_PI_2);
    let pose = Pose::from_parts(Vector::Y * RADIUS, lying);
    let dynamic = RigidBodyBuilder::dynamic().pose(pose).can_sleep(false);
    let (body, _) = world.insert(dynamic, ColliderBuilder::new(body));
    world.bodies[body].set_linvel(Vector::X * SPEED, true);
    world.bodies[body].set_angvel(Vector::NEG_Z * (SPEED / RADIUS), true);
    for _ in 0..120 {
        world.step();
    }
    world.bodies[body].linvel().length()
}

/// Contacts that turned with the body were behind its lowest place, and pushed it on: it rolled four times as fast
/// after two seconds, and never came to rest.
#[test]
fn contacts_do_not_push_what_rolls() {
    let cuboid = || SharedShape::cuboid(2.0, 0.5, 2.0);
    let hull = || hulls::cuboid(Vector::new(2.0, 0.5, 2.0)).expect("a solid");
    let cases = [
        (
            "cylinder on cuboid",
            cuboid(),
            SharedShape::cylinder(0.1, RADIUS),
        ),
        (
            "cylinder on hull",
            hull(),
            SharedShape::cylinder(0.1, RADIUS),
        ),
        (
            "round cylinder",
            cuboid(),
            SharedShape::round_cylinder(0.1, 0.08, 0.02),
        ),
        (
            "capsule on hull",
            hull(),
            SharedShape::capsule_y(0.1, RADIUS),
        ),
        ("ball on hull", hull(), SharedShape::ball(RADIUS)),
    ];
    for (what, floor, body) in cases {
        let speed = rolled(floor, body);
        println!("{what}: {speed}");
        let change = (speed / SPEED - 1.0).abs();
        assert!(change < 0.1, "{what}: {speed} m/s after {SPEED}");
    }
}
