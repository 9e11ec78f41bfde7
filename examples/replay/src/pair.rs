//! A pair of a recording as a world.

use std::path::Path;

use isa_gjk::IsaGjkDispatcher;
use rapier3d::prelude::{ColliderBuilder, RigidBodyBuilder, Vector};
use testkit::scenes::World;

/// The pair with this number, counted from 0, in a file: the first shape fixed, the second one free.
pub fn world(
    path: &Path,
    number: usize,
    dispatcher: Option<IsaGjkDispatcher>,
) -> Result<World, String> {
    let pair = testkit::recorded::pair(path, number)?;
    let [first, second] = pair.shapes;
    let mut world = World::new(dispatcher, false);
    let physics = &mut world.physics;
    physics.gravity = Vector::ZERO;
    physics.insert_collider(ColliderBuilder::new(first), None);
    // Triangles and segments have no mass of their own.
    let body = RigidBodyBuilder::dynamic()
        .pose(pair.pos12)
        .additional_mass(1.0);
    physics.insert(body, ColliderBuilder::new(second));
    Ok(world)
}
