//! A rapier world with the dispatcher of choice.

use std::time::Duration;

use isa_gjk::IsaGjkDispatcher;
use rapier3d::prelude::*;

use super::gripping::{self, Shaken};
use super::renewal::Renewal;

/// Radians per second at which a drum turns.
const DRUM_SPEED: Real = 0.5;

/// All of rapier's sets, and the drum that turns in them.
pub struct World {
    /// The sets and the pipeline, whose counters hold the times of the last step.
    pub physics: PhysicsWorld,
    /// Told before each step that no shape changes in it.
    told: Option<IsaGjkDispatcher>,
    drum: Option<RigidBodyHandle>,
    shaken: Shaken,
    renewal: Option<Renewal>,
    /// How long it took to make new hulls before the last step.
    pub making: Duration,
    steps: u32,
}

impl World {
    /// An empty world; `None` leaves rapier its own dispatcher. Ours may be told that shapes are
    /// unchanged during a step.
    pub fn new(dispatcher: Option<IsaGjkDispatcher>, unchanged_shapes: bool) -> Self {
        let told = dispatcher.clone().filter(|_| unchanged_shapes);
        let narrow_phase = dispatcher
            .as_ref()
            .map_or_else(NarrowPhase::new, crate::world::narrow_phase);
        Self {
            physics: PhysicsWorld {
                narrow_phase,
                ..PhysicsWorld::default()
            },
            told,
            drum: None,
            shaken: Vec::new(),
            renewal: None,
            making: Duration::ZERO,
            steps: 0,
        }
    }

    /// Makes a kinematic body turn about the z axis.
    pub(super) fn turn(&mut self, drum: RigidBodyHandle) {
        self.drum = Some(drum);
    }

    /// Shakes hands from now on.
    pub(super) fn shake(&mut self, hands: Shaken) {
        self.shaken = hands;
    }

    /// Makes hulls come into being from now on.
    pub(super) fn renew(&mut self, renewal: Renewal) {
        self.renewal = Some(renewal);
    }

    /// One frame.
    pub fn step(&mut self) {
        self.steps += 1;
        if let Some(renewal) = &mut self.renewal {
            self.making = renewal.renew(&mut self.physics, self.steps);
        }
        // From the count of steps, so that rounding does not add up over a long run.
        let time = self.physics.integration_parameters.dt * self.steps as Real;
        gripping::shake(&self.shaken, &mut self.physics.bodies, time);
        if let Some(drum) = self.drum {
            let angle = DRUM_SPEED * time;
            self.physics.bodies[drum].set_next_kinematic_rotation(Rotation::from_rotation_z(angle));
        }
        match &self.told {
            Some(dispatcher) => dispatcher.with_unchanged_shapes(|| self.physics.step()),
            None => self.physics.step(),
        }
    }

    /// Kinetic energy of the dynamic bodies.
    pub fn kinetic_energy(&self) -> f64 {
        self.dynamic_bodies()
            .map(|body| f64::from(body.kinetic_energy()))
            .sum()
    }

    /// How many dynamic bodies sleep.
    pub fn sleeping(&self) -> usize {
        self.dynamic_bodies()
            .filter(|body| body.is_sleeping())
            .count()
    }

    /// Mean height of the dynamic bodies: it tells whether what was stacked still stands.
    pub fn mean_height(&self) -> f64 {
        let heights = self.dynamic_bodies().map(|body| body.translation().y);
        heights.map(f64::from).sum::<f64>() / self.dynamic_bodies().count().max(1) as f64
    }

    /// FNV-1a over the bits of every pose: equal hashes mean equal histories.
    pub fn pose_hash(&self) -> u64 {
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        for (_, body) in self.physics.bodies.iter() {
            let Pose {
                translation,
                rotation,
                ..
            } = *body.position();
            for value in translation
                .to_array()
                .into_iter()
                .chain(rotation.to_array())
            {
                for byte in value.to_bits().to_le_bytes() {
                    hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
                }
            }
        }
        hash
    }

    /// The bodies that move freely, in the order in which they were inserted, if none was removed.
    pub fn dynamic_bodies(&self) -> impl Iterator<Item = &RigidBody> {
        let bodies = self.physics.bodies.iter().map(|(_, body)| body);
        bodies.filter(|body| body.is_dynamic())
    }
}
