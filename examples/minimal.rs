//! The shortest use: a rapier world whose hulls meet through `isa-gjk`.

use isa_gjk::IsaGjkDispatcher;
use rapier3d::prelude::*;

fn main() {
    let mut world = PhysicsWorld {
        // The only line that differs from a world without this crate.
        narrow_phase: NarrowPhase::with_query_dispatcher(IsaGjkDispatcher::default()),
        ..PhysicsWorld::default()
    };
    let floor = ColliderBuilder::cuboid(10.0, 0.5, 10.0).translation(Vector::new(0.0, -0.5, 0.0));
    world.insert_collider(floor, None);

    let diamond: Vec<_> = [Vector::X, Vector::Y, Vector::Z]
        .into_iter()
        .flat_map(|axis| [axis * 0.5, axis * -0.5])
        .collect();
    let hull = SharedShape::convex_hull(&diamond).expect("an octahedron is solid");
    let bodies = [1.0, 2.5, 4.0].map(|height| {
        let body = RigidBodyBuilder::dynamic().translation(Vector::new(0.2 * height, height, 0.0));
        world.insert(body, ColliderBuilder::new(hull.clone())).0
    });

    for _ in 0..300 {
        world.step();
    }
    for body in bodies {
        println!("at rest at {}", world.bodies[body].translation());
    }
}
