//! Steps both worlds in turn in one process, so that whatever else the machine does meets both.

use indicatif::ProgressBar;
use isa_gjk::{IsaGjkDispatcher, Stats};
use rapier3d::prelude::{ContactPair, Real};

use crate::verify::{Verified, Verifier};
use testkit::quality::{Observer, Quality};
use testkit::scenes::{self, Scene, SceneParams, World};

/// Frames that one world steps before it is the other's turn.
pub const BLOCK: usize = 8;

/// How long a run takes.
#[derive(Clone, Copy)]
pub struct RunLength {
    /// Frames before counting.
    pub warmup: usize,
    /// Frames after that.
    pub frames: usize,
    /// Manifolds to check meanwhile.
    pub verify: u32,
}

impl RunLength {
    /// Steps of both worlds together.
    pub fn steps(self) -> u64 {
        2 * (self.warmup + self.frames) as u64
    }
}

/// Where the time of one frame went, in milliseconds.
#[derive(Clone, Copy)]
pub struct Times {
    /// The whole step.
    pub step: f64,
    /// Finding pairs of bounding boxes.
    pub broad_phase: f64,
    /// Finding the contacts of these pairs.
    pub narrow_phase: f64,
    /// Solving the contacts.
    pub solver: f64,
    /// Keeping fast bodies from tunnelling.
    pub ccd: f64,
    /// Making new hulls before the step.
    pub making: f64,
}

impl Times {
    /// The step, and what comes before it.
    pub fn frame(&self) -> f64 {
        self.making + self.step
    }
}

/// One frame after the warm-up.
pub struct Frame {
    /// Whether it takes part in the figures: the first of a block finds the other world's data
    /// in the caches, and does not.
    pub counted: bool,
    /// What it cost.
    pub times: Times,
    /// Contact pairs of the narrow phase.
    pub pairs: usize,
    /// Pairs with an active contact.
    pub touching: usize,
}

/// What one world did in one run.
pub struct Side {
    /// Every frame after the warm-up, in order.
    pub frames: Vec<Frame>,
    /// For each counted frame and touching pair, how deep its deepest point is by its manifolds;
    /// negative if the pair is only close.
    pub depths: Vec<Real>,
    /// Of all dynamic bodies at the end, in joules.
    pub kinetic_energy: f64,
    /// Of all dynamic bodies at the end, in metres.
    pub mean_height: f64,
    /// Dynamic bodies asleep at the end.
    pub sleeping: usize,
    /// Observations of its contacts; drift and patches are from the second half of the frames.
    pub quality: Quality,
    /// Of all poses at the end.
    pub pose_hash: u64,
}

/// One run of both worlds.
pub struct Run {
    /// With rapier's own dispatcher.
    pub default: Side,
    /// With ours.
    pub ours: Side,
    /// What our queries cost after the warm-up.
    pub stats: Stats,
    /// What the checks of our manifolds found, if there were to be any.
    pub verified: Option<Verified>,
}

/// Builds both worlds, ours with this dispatcher, and steps them, block by block in turn.
pub fn run(
    scene: Scene,
    params: &SceneParams,
    dispatcher: &IsaGjkDispatcher,
    length: RunLength,
    progress: &ProgressBar,
) -> Result<Run, String> {
    let mut default = Recorder::new(scenes::build(scene, params, None)?);
    let mut ours = Recorder::new(scenes::build(scene, params, Some(dispatcher.clone()))?);

    in_blocks(length.warmup, |frames| {
        for recorder in [&mut default, &mut ours] {
            (0..frames).for_each(|_| recorder.warm_up());
            progress.inc(frames as u64);
        }
    });
    let before = dispatcher.stats();
    let halves = [length.frames / 2, length.frames.div_ceil(2)];
    let blocks = halves.map(|frames| frames.div_ceil(BLOCK)).iter().sum();
    let mut verifier = (length.verify > 0).then(|| Verifier::new(length.verify, blocks));
    for half in halves {
        for recorder in [&mut default, &mut ours] {
            recorder.observer.mark(&recorder.world);
        }
        in_blocks(half, |frames| {
            for recorder in [&mut default, &mut ours] {
                (0..frames).for_each(|frame| recorder.step(frame > 0));
                progress.inc(frames as u64);
            }
            // Between blocks: the frame that finds its data evicted by this is not counted.
            if let Some(verifier) = &mut verifier {
                verifier.check(&ours.world);
            }
        });
    }
    Ok(Run {
        default: default.finish(),
        ours: ours.finish(),
        stats: dispatcher.stats().since(&before),
        verified: verifier.map(|verifier| verifier.found),
    })
}

/// Calls `step` with block lengths that sum to `frames`.
pub fn in_blocks(frames: usize, mut step: impl FnMut(usize)) {
    for start in (0..frames).step_by(BLOCK) {
        step(BLOCK.min(frames - start));
    }
}

struct Recorder {
    world: World,
    observer: Observer,
    frames: Vec<Frame>,
    depths: Vec<Real>,
}

impl Recorder {
    fn new(world: World) -> Self {
        Self {
            observer: Observer::new(&world),
            world,
            frames: Vec::new(),
            depths: Vec::new(),
        }
    }

    fn warm_up(&mut self) {
        self.world.step();
        self.observer.step(&self.world);
    }

    fn step(&mut self, counted: bool) {
        self.warm_up();
        let mut pairs = 0;
        let mut touching = 0;
        for pair in self.world.physics.narrow_phase.contact_pairs() {
            pairs += 1;
            if pair.has_any_active_contact() {
                touching += 1;
                if counted {
                    self.depths.extend(deepest(pair));
                }
            }
        }
        self.frames.push(Frame {
            counted,
            times: times(&self.world),
            pairs,
            touching,
        });
    }

    fn finish(self) -> Side {
        Side {
            frames: self.frames,
            depths: self.depths,
            kinetic_energy: self.world.kinetic_energy(),
            mean_height: self.world.mean_height(),
            sleeping: self.world.sleeping(),
            quality: self.observer.finish(&self.world),
            pose_hash: self.world.pose_hash(),
        }
    }
}

/// How deep the deepest point of a pair is.
fn deepest(pair: &ContactPair) -> Option<Real> {
    let points = pair.manifolds().iter().flat_map(|m| &m.points);
    points.map(|point| -point.dist).reduce(Real::max)
}

fn times(world: &World) -> Times {
    let counters = &world.physics.physics_pipeline.counters;
    Times {
        step: counters.step_time_ms(),
        broad_phase: counters.broad_phase_time_ms(),
        narrow_phase: counters.narrow_phase_time_ms(),
        solver: counters.solver_time_ms(),
        ccd: counters.ccd.toi_computation_time.time_ms(),
        making: world.making.as_secs_f64() * 1e3,
    }
}
