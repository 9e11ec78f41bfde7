//! Logs stacked in rows. With one contact for each two capsules, as the default makes them, they never
//! rest and sink into each other. Cylinders rest, but twice as late, and deeper in each other.

use rapier3d::prelude::*;

const RADIUS: Real = 0.1;
const STEPS: usize = 400;

/// Five rows of logs, one fewer in each, between two posts; the step after which all sleep, and the
/// deepest overlap at the end.
fn stack(mut world: PhysicsWorld, log: &ColliderBuilder) -> (Option<usize>, Real) {
    let ground = ColliderBuilder::cuboid(5.0, 0.5, 5.0).translation(Vector::new(0.0, -0.5, 0.0));
    world.insert_collider(ground, None);
    for side in [-1.0, 1.0] {
        let place = Vector::new(side * (5.0 * RADIUS + 0.1), 0.2, 0.0);
        world.insert_collider(
            ColliderBuilder::cuboid(0.1, 0.2, 1.0).translation(place),
            None,
        );
    }
    let mut logs = Vec::new();
    for row in 0..5 {
        for i in 0..5 - row {
            let x = (2.0 * i as Real - (4 - row) as Real) * RADIUS;
            let y = RADIUS + row as Real * RADIUS * 3.0_f32.sqrt();
            let body = RigidBodyBuilder::dynamic().translation(Vector::new(x, y, 0.0));
            logs.push(world.insert(body, log.clone()).0);
        }
    }
    let asleep = (0..STEPS).find(|_| {
        world.step();
        logs.iter().all(|&log| world.bodies[log].is_sleeping())
    });
    let pairs = world.narrow_phase.contact_pairs();
    let points = pairs
        .flat_map(|pair| pair.manifolds())
        .flat_map(|m| &m.points);
    (asleep, -points.map(|point| point.dist).fold(0.0, Real::min))
}

fn ours() -> PhysicsWorld {
    PhysicsWorld {
        narrow_phase: testkit::world::ours(),
        ..PhysicsWorld::default()
    }
}

/// Stacks logs beside the default, and asserts that they sleep by a step and overlap by no more.
fn assert_rest(log: &ColliderBuilder, by: usize, most: Real) {
    let (asleep, overlap) = stack(ours(), log);
    let (by_default, default_overlap) = stack(PhysicsWorld::default(), log);
    println!("{asleep:?} {overlap}, default {by_default:?} {default_overlap}");
    assert!(asleep.is_some_and(|step| step <= by), "awake: {asleep:?}");
    assert!(overlap <= most, "they overlap by {overlap}");
    assert!(overlap < default_overlap);
}

#[test]
fn stacked_capsules_come_to_rest() {
    for half_length in [0.3, 0.5, 1.0] {
        assert_rest(&ColliderBuilder::capsule_z(half_length, RADIUS), 60, 2e-3);
    }
}

#[test]
fn stacked_cylinders_come_to_rest() {
    for half_length in [0.3, 0.5, 1.0] {
        let lying = Vector::new(std::f32::consts::FRAC_PI_2, 0.0, 0.0);
        let log = ColliderBuilder::cylinder(half_length, RADIUS).rotation(lying);
        assert_rest(&log, 40, 2e-3);
    }
}
