//! A hull that crosses a thin plate within one step.
//!
//! Rapier stops it by continuous collision detection, and then by the contacts of that moment: the
//! solver uses points far beyond the prediction distance if their velocities would close the gap
//! within the step. A manifold that keeps only its near points lets the hull turn and slip through.

use rapier3d::prelude::*;
use testkit::generate::Rng;
use testkit::world::ours;

fn plate() -> SharedShape {
    let corners: Vec<Vector> = (0..8)
        .map(|i| {
            let sign = |bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
            Vector::new(3.0 * sign(0), 0.01 * sign(1), 3.0 * sign(2))
        })
        .collect();
    SharedShape::convex_hull(&corners).expect("a plate has volume")
}

#[test]
fn a_fast_hull_does_not_pass_a_thin_plate() {
    let mut rng = Rng::new(9);
    for vertices in [8, 16, 30, 250] {
        let shape = rng.hull(vertices, 0.9).shape;
        let mut world = PhysicsWorld {
            narrow_phase: ours(),
            ..PhysicsWorld::default()
        };
        world.insert(RigidBodyBuilder::fixed(), ColliderBuilder::new(plate()));
        let body = RigidBodyBuilder::dynamic()
            .translation(Vector::new(0.0, 2.0, 0.0))
            .linvel(Vector::new(0.0, -200.0, 0.0))
            .ccd_enabled(true);
        let (body, _) = world.insert(body, ColliderBuilder::new(shape));
        for step in 0..20 {
            world.step();
            let y = world.bodies[body].translation().y;
            assert!(y > 0.0, "{vertices} vertices, step {step}: at y = {y}");
        }
    }
}
