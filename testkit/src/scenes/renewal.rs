//! Hulls that come into being while a world runs.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use isa_gjk::HullShape;
use oorandom::Rand32;
use rapier3d::prelude::*;

use super::{HullSource, Scene, SceneParams, hulls};

/// Frames between two bursts.
const BURST_EVERY: u32 = 30;
/// A burst replaces one of so many bodies.
const BURST_SHARE: usize = 3;

/// Gives bodies new hulls that no other body has.
pub(super) struct Renewal {
    scene: Scene,
    /// Of all dynamic bodies, the oldest first.
    bodies: VecDeque<(RigidBodyHandle, ColliderHandle)>,
    /// Where bodies of a burst begin.
    places: Vec<Pose>,
    source: HullSource,
    size: Option<Real>,
    /// Whether the hulls are [`isa_gjk::HullShape`]s.
    hull_shape: bool,
    can_sleep: bool,
    random: Rand32,
    /// What it took to make hulls of points.
    making: Duration,
}

impl Renewal {
    /// Of a filled world.
    pub fn new(scene: Scene, params: &SceneParams, physics: &PhysicsWorld, ours: bool) -> Self {
        let bodies: VecDeque<_> = (physics.bodies.iter())
            .filter(|(_, body)| body.is_dynamic())
            .map(|(handle, body)| (handle, body.colliders()[0]))
            .collect();
        // The uppermost layers, above the walls.
        let top = bodies.iter().rev().take(bodies.len() / BURST_SHARE);
        let top: Vec<Pose> = top.map(|(b, _)| *physics.bodies[*b].position()).collect();
        let heights = top.iter().map(|pose| pose.translation.y);
        let rise = Pose::translation(0.0, heights.fold(0.0, Real::max), 0.0);
        Self {
            scene,
            places: top.into_iter().map(|pose| rise * pose).collect(),
            bodies,
            source: params.hulls.clone(),
            size: params.size.or(scene.default_size()),
            hull_shape: params.hull_shape && ours,
            can_sleep: params.can_sleep,
            // Not the hulls of the other world, which the caches of this one could know.
            random: Rand32::new(2 * params.seed + u64::from(ours)),
            making: Duration::ZERO,
        }
    }

    /// Before a step. Returns how long it took to make new hulls.
    pub fn renew(&mut self, physics: &mut PhysicsWorld, step: u32) -> Duration {
        self.making = Duration::ZERO;
        match self.scene {
            Scene::Reshaped => self.reshape(physics),
            _ if step.is_multiple_of(BURST_EVERY) => self.burst(physics),
            _ => {}
        }
        self.making
    }

    /// Every body gets another hull.
    fn reshape(&mut self, physics: &mut PhysicsWorld) {
        for i in 0..self.bodies.len() {
            if let Some(shape) = self.new_shape() {
                physics.colliders[self.bodies[i].1].set_shape(shape);
            }
        }
    }

    /// New bodies replace the oldest ones.
    fn burst(&mut self, physics: &mut PhysicsWorld) {
        for i in 0..self.places.len() {
            let (Some(shape), Some((oldest, _))) = (self.new_shape(), self.bodies.pop_front())
            else {
                continue;
            };
            physics.remove_body(oldest);
            let body = RigidBodyBuilder::dynamic()
                .pose(self.places[i])
                .can_sleep(self.can_sleep);
            let new = physics.insert(body, ColliderBuilder::new(shape));
            self.bodies.push_back(new);
        }
    }

    /// `None` if the source happens to yield no solid.
    fn new_shape(&mut self) -> Option<SharedShape> {
        let mut shapes = hulls::make(&self.source, 1, &mut self.random).ok()?;
        if let Some(size) = self.size {
            shapes = hulls::scaled(&shapes, size).ok()?;
        }
        let points = shapes.pop()?.as_convex_polyhedron()?.points().to_vec();
        let start = Instant::now();
        let shape = if self.hull_shape {
            HullShape::from_points(&points).ok().map(SharedShape::new)
        } else {
            SharedShape::convex_hull(&points)
        };
        self.making += start.elapsed();
        shape
    }
}
