//! What is measured of worlds of cylinders, cones and capsules.

use isa_gjk::IsaGjkDispatcher;
use rapier3d::prelude::{Real, RigidBody, Vector};

use super::curved::CurvedScene;
use super::world::World;
use crate::quality::{self, Observer};

/// Steps from one measurement of the overlaps to the next.
const OVERLAPS_EVERY: usize = 8;
/// Of what rolls: steps until it has come down on its ground.
const LANDED: usize = 30;

/// A figure with its name; `None` is never.
#[derive(Clone, Copy, Debug)]
pub struct Figure {
    pub name: &'static str,
    pub value: Option<f64>,
}

/// A world on its way, and what was seen of it so far.
pub struct Watched {
    scene: CurvedScene,
    world: World,
    observer: Observer,
    starts: Vec<Vector>,
    heights: [Real; 2],
    energy: Option<f64>,
    overlap: f64,
    steps: usize,
    narrow_phase_ms: f64,
}

impl Watched {
    pub fn new(scene: CurvedScene, seed: u64, dispatcher: Option<IsaGjkDispatcher>) -> Self {
        let world = scene.build(seed, dispatcher);
        Self {
            scene,
            observer: Observer::new(&world),
            starts: places(&world).collect(),
            world,
            heights: [Real::INFINITY, Real::NEG_INFINITY],
            energy: None,
            overlap: 0.0,
            steps: 0,
            narrow_phase_ms: 0.0,
        }
    }

    /// One step, unless all were made.
    pub fn step(&mut self) {
        if self.steps == self.scene.steps() {
            return;
        }
        self.steps += 1;
        self.world.step();
        let counters = &self.world.physics.physics_pipeline.counters;
        self.narrow_phase_ms += counters.narrow_phase_time_ms();
        self.observer.step(&self.world);
        if self.steps.is_multiple_of(OVERLAPS_EVERY) {
            let overlaps = quality::overlaps(&self.world);
            self.overlap = overlaps.fold(self.overlap, f64::max);
        }
        if self.steps >= LANDED {
            let heights = places(&self.world).map(|place| place.y);
            let [low, high] = &mut self.heights;
            heights.for_each(|height| (*low, *high) = (low.min(height), high.max(height)));
            self.energy.get_or_insert(energy(&self.world));
        }
    }

    pub fn figures(&self) -> Vec<Figure> {
        let quality = self.observer.finish(&self.world);
        let figure = |name, value: f64| Figure {
            name,
            value: Some(value),
        };
        let asleep = Figure {
            name: "asleep after, steps",
            value: quality.asleep_after.map(|steps| steps as f64),
        };
        let sleepers = figure("asleep at last", self.world.sleeping() as f64);
        let overlap = figure("largest overlap, mm", 1.0e3 * self.overlap);
        let narrow_phase = figure("narrow phase, ms", self.narrow_phase_ms);
        let mut figures = match self.scene {
            CurvedScene::CapsuleLogs | CurvedScene::Logs | CurvedScene::Cones => {
                vec![asleep, sleepers, overlap]
            }
            CurvedScene::Heap => {
                let usual = figure("overlap, 99 of 100, mm", 1.0e3 * quality.overlap);
                vec![asleep, sleepers, usual, overlap]
            }
            CurvedScene::Coins | CurvedScene::Barrels | CurvedScene::TallBarrels => {
                let moved = self.ways().map(|way| way.x.hypot(way.z));
                let moved = f64::from(moved.fold(0.0, Real::max));
                let tilt = figure("tilt, degrees", quality.tilt);
                vec![tilt, figure("moved, mm", 1.0e3 * moved), overlap]
            }
            CurvedScene::Roll | CurvedScene::LongRoll | CurvedScene::MeshRoll => {
                let [low, high] = self.heights;
                let speed = self
                    .world
                    .dynamic_bodies()
                    .map(|body| body.linvel().length());
                let way = self.ways().map(|way| way.x);
                vec![
                    figure("height varies by, mm", 1.0e3 * f64::from(high - low)),
                    figure("speed at last, m/s", f64::from(speed.sum::<Real>())),
                    figure("way, m", f64::from(way.sum::<Real>())),
                ]
            }
            CurvedScene::Waves => {
                let before = self.energy.unwrap_or(f64::NAN);
                let change = energy(&self.world) / before - 1.0;
                vec![figure("energy, %", 100.0 * change)]
            }
            CurvedScene::ThinFloor => {
                let ways = || self.ways().map(|way| f64::from(way.length()));
                vec![
                    figure("least way, m", ways().fold(f64::INFINITY, f64::min)),
                    figure("longest way, m", ways().fold(0.0, f64::max)),
                ]
            }
        };
        figures.push(narrow_phase);
        figures
    }

    /// Of each body, since the start.
    fn ways(&self) -> impl Iterator<Item = Vector> {
        places(&self.world)
            .zip(&self.starts)
            .map(|(now, start)| now - *start)
    }
}

fn places(world: &World) -> impl Iterator<Item = Vector> {
    world.dynamic_bodies().map(RigidBody::translation)
}

/// Kinetic, and potential above the ground.
fn energy(world: &World) -> f64 {
    let gravity = world.physics.gravity;
    let potential = world.dynamic_bodies().map(|body| {
        let place = body.translation() - Vector::Y * super::curved::WHEEL_RADIUS;
        f64::from(-body.mass() * gravity.dot(place))
    });
    world.kinetic_energy() + potential.sum::<f64>()
}
