//! A long life: bodies come, go, jump, sleep and change their shapes, and nothing is lost.
//!
//! The short run is part of every test; `SOAK_STEPS=100000 cargo test --release --test worlds soak` is
//! the long one. `docs/robustness.md` has its figures.

use std::time::Instant;

use rapier3d::prelude::*;
use testkit::generate::{Rng, prepared};
use testkit::world::{Ground, deepest, mixed, ours, shapes, start};

const BODIES: usize = 40;
/// Frames between checks that look at every pair.
const CHECK_EVERY: usize = 250;
/// Bodies are put into each other, and need a moment to part.
const DEEPEST: Real = 0.9;

/// What was changed in the world.
#[derive(Debug, Default)]
struct Deeds {
    added: usize,
    removed: usize,
    teleported: usize,
    put_to_sleep: usize,
    reshaped: usize,
    impossible: usize,
}

struct Soak {
    world: PhysicsWorld,
    rng: Rng,
    shapes: Vec<SharedShape>,
    deeds: Deeds,
    /// Found below the ground, or beyond the walls.
    escaped: usize,
}

impl Soak {
    fn new(ground: Ground, seed: u128) -> Self {
        let mut rng = Rng::new(seed);
        let shapes = shapes(&mut rng);
        Self {
            world: mixed(ground, BODIES, ours()),
            shapes,
            rng,
            deeds: Deeds::default(),
            escaped: 0,
        }
    }

    fn some_body(&mut self) -> Option<RigidBodyHandle> {
        let dynamic = self.world.bodies.iter().map(|(handle, _)| handle);
        let handles: Vec<RigidBodyHandle> = dynamic.collect();
        let count = handles.len().checked_sub(1)?;
        Some(handles[self.rng.count(0, count)])
    }

    fn some_shape(&mut self) -> SharedShape {
        match self.rng.count(0, 3) {
            0 => self.rng.hull(16, 0.7).shape,
            1 => prepared(&self.rng.hull(40, 0.7).shape),
            _ => self.shapes[self.rng.count(0, self.shapes.len() - 1)].clone(),
        }
    }

    fn some_place(&mut self) -> Pose {
        let cell = self.rng.count(0, 35);
        start(cell, &mut self.rng)
    }

    fn add(&mut self) {
        let (shape, place) = (self.some_shape(), self.some_place());
        let body = RigidBodyBuilder::dynamic().pose(place);
        self.world.insert(body, ColliderBuilder::new(shape));
        self.deeds.added += 1;
    }

    /// One deed to one body.
    fn meddle(&mut self) {
        let Some(handle) = self.some_body() else {
            return self.add();
        };
        let place = self.some_place();
        let shape = self.some_shape();
        match self.rng.count(0, 7) {
            0 if self.world.bodies.len() < BODIES + 10 => self.add(),
            0 | 1 if self.world.bodies.len() > BODIES / 2 => {
                self.world.remove_body_with_colliders(handle, true);
                self.deeds.removed += 1;
            }
            2 => {
                self.world.bodies[handle].set_position(place, true);
                self.deeds.teleported += 1;
            }
            3 => {
                self.world.bodies[handle].sleep();
                self.deeds.put_to_sleep += 1;
            }
            4 => {
                // Rapier takes such a body out of the world.
                let nonsense = Vector::new(0.0, Real::NAN, 0.0);
                self.world.bodies[handle].set_linvel(nonsense, true);
                self.deeds.impossible += 1;
            }
            _ => {
                let collider = self.world.bodies[handle].colliders()[0];
                self.world.colliders[collider].set_shape(shape);
                self.deeds.reshaped += 1;
            }
        }
    }

    /// Removes what is no longer in the pen, and counts it.
    fn collect(&mut self) {
        let gone = self.world.bodies.iter().filter(|(_, body)| {
            let place = body.translation();
            let inside = place.x.abs().max(place.z.abs()) < 3.5 && place.y > -1.0;
            !(place.is_finite() && inside && body.is_enabled())
        });
        let gone: Vec<_> = gone
            .map(|(handle, body)| (handle, body.is_enabled()))
            .collect();
        for (handle, was_enabled) in gone {
            self.escaped += usize::from(was_enabled);
            self.world.remove_body_with_colliders(handle, true);
        }
    }

    fn live(&mut self, steps: usize) {
        for step in 0..steps {
            if self.rng.count(0, 9) == 0 {
                self.meddle();
            }
            self.world.step();
            self.collect();
            if step % CHECK_EVERY == CHECK_EVERY - 1 {
                let depth = deepest(&self.world);
                assert!(depth < DEEPEST, "step {step}: {depth} deep");
            }
        }
    }
}

#[test]
fn a_world_that_is_meddled_with_lives_on() {
    let steps = std::env::var("SOAK_STEPS").ok();
    let steps = steps.map_or(2_000, |text| text.parse().expect("a number"));
    for (i, ground) in Ground::ALL.into_iter().enumerate() {
        let mut soak = Soak::new(ground, 81 + i as u128);
        let began = Instant::now();
        soak.live(steps / 4);
        let (deeds, escaped) = (&soak.deeds, soak.escaped);
        let seconds = began.elapsed().as_secs_f32();
        println!(
            "{} steps on {ground:?} in {seconds} s: {deeds:?}, {escaped} escaped",
            steps / 4
        );
        // A body that is placed into the ground, or grows into it, may leave it on the other side.
        let moved = deeds.added + deeds.teleported + deeds.reshaped;
        assert!(escaped <= 2 + moved / 10, "{escaped} of {deeds:?}");
    }
}
