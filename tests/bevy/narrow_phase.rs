//! Narrow phases that are compiled with this crate.

use isa_gjk::{IsaGjkDispatcher, rapier};
use rapier3d::prelude::*;
use testkit::world::state;

/// A hull above a floor.
fn world(narrow_phase: NarrowPhase) -> PhysicsWorld {
    let mut world = PhysicsWorld {
        narrow_phase,
        ..PhysicsWorld::default()
    };
    world.insert_collider(ColliderBuilder::cuboid(5.0, 0.5, 5.0), None);
    let corners = [Vector::X, Vector::Y, Vector::Z].map(|axis| [axis, -axis]);
    let hull = SharedShape::convex_hull(&corners.concat()).expect("an octahedron is solid");
    let body = RigidBodyBuilder::dynamic().translation(Vector::new(0.0, 2.0, 0.0));
    world.insert(body, ColliderBuilder::new(hull));
    world
}

#[test]
fn they_are_like_those_compiled_with_the_program() {
    let dispatchers = [(); 3].map(|()| IsaGjkDispatcher::default());
    let [there, here, later] = dispatchers.clone();
    let mut worlds = [
        world(NarrowPhase::with_query_dispatcher(there)),
        world(rapier::narrow_phase(here)),
        world(NarrowPhase::new()),
    ];
    rapier::set_dispatcher(&mut worlds[2].narrow_phase, later);
    for _ in 0..60 {
        worlds.iter_mut().for_each(PhysicsWorld::step);
    }
    let [there, here, later] = worlds.each_ref().map(state);
    assert_eq!(there, here);
    assert_eq!(there, later);
    let queries = dispatchers.map(|dispatcher| dispatcher.stats().queries());
    assert!(queries[0] > 0 && queries.iter().all(|count| *count == queries[0]));
}
