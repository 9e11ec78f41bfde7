//! Inserts the bodies of a scene.

use oorandom::Rand32;
use rapier3d::prelude::*;

use super::world::World;

/// Below and between the parts of a tower, so that these do not touch exactly at the start.
pub(super) const GAP: Real = 0.001;

/// Fills a world with one scene.
pub(super) struct Filler<'a> {
    pub world: &'a mut World,
    /// The shapes by which the bodies are placed.
    pub shapes: Vec<SharedShape>,
    /// The same shapes, as they are inserted into the world.
    pub colliders: Vec<SharedShape>,
    /// The largest reach of a shape.
    pub reach: Real,
    pub random: Rand32,
    pub bodies: usize,
    /// A pile that falls asleep costs nothing, and its figures would say so of both worlds.
    pub can_sleep: bool,
}

impl Filler<'_> {
    pub fn shape(&self, i: usize) -> &SharedShape {
        &self.shapes[i % self.shapes.len()]
    }

    /// Body `i`, and its collider.
    pub fn insert(&mut self, i: usize, pose: Pose) -> (RigidBodyHandle, ColliderHandle) {
        let body = RigidBodyBuilder::dynamic()
            .pose(pose)
            .can_sleep(self.can_sleep);
        let shape = self.colliders[i % self.colliders.len()].clone();
        let collider = ColliderBuilder::new(shape);
        self.world.physics.insert(body, collider)
    }

    /// A random number between `-limit` and `limit`.
    pub fn within(&mut self, limit: Real) -> Real {
        limit * (2.0 * self.random.rand_float() - 1.0)
    }

    /// A pose at `place`, turned at random.
    pub fn tumbled(&mut self, place: Vector) -> Pose {
        let axis_angle = Vector::new(self.within(2.0), self.within(2.0), self.within(2.0));
        Pose::new(place, axis_angle)
    }
}

/// Cell `i` of a square of `side` times `side` cells around the origin.
pub(super) fn square_cell(i: usize, side: usize, spacing: Real) -> (Real, Real) {
    let along = |step: usize| (step as Real - (side - 1) as Real / 2.0) * spacing;
    (along(i % side), along(i / side))
}

/// No point of the shape is farther from its origin.
pub(super) fn reach(shape: &SharedShape) -> Real {
    let sphere = shape.compute_local_bounding_sphere();
    sphere.center.length() + sphere.radius
}
