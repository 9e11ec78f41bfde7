//! A pair of a recording as a world.

use std::error::Error;
use std::fs;
use std::path::Path;

use isa_gjk::IsaGjkDispatcher;
use isa_gjk::recording;
use rapier3d::prelude::{ColliderBuilder, RigidBodyBuilder, Vector};
use testkit::scenes::World;

/// The pair with this number, counted from 0, in a file: the first shape fixed, the second one free.
pub fn world(
    path: &Path,
    number: usize,
    dispatcher: Option<IsaGjkDispatcher>,
) -> Result<World, Box<dyn Error>> {
    let text = fs::read_to_string(path)
        .map_err(|error| format!("cannot read {}: {error}", path.display()))?;
    let pairs = recording::read(&text)
        .map_err(|error| format!("cannot read {}: {error}", path.display()))?;
    let count = pairs.len();
    let pair = pairs.into_iter().nth(number).ok_or_else(|| {
        format!(
            "{} has no pair of number {number}: {count} in all, counted from 0",
            path.display()
        )
    })?;
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
