//! When the bodies of a world come to rest, and what the way there costs.

use std::fmt;
use std::io::{self, BufWriter, Write};

use indicatif::ProgressBar;
use isa_gjk::IsaGjkDispatcher;
use rapier3d::prelude::{RigidBody, Vector};
use serde::Serialize;

use crate::measure;
use testkit::quality::quantile;
use testkit::scenes::{self, Scene, SceneParams, World};

/// Of so many bodies all but one must sleep.
const ONE_AWAKE_OF: usize = 20;
/// Ours keep the limit if they rest no later than this many times the default's frame of rest and so many frames more.
const LIMIT_FACTOR: f64 = 1.25;
const LIMIT_FRAMES: f64 = 30.0;

/// Runs of one scene from several seeds.
#[derive(Serialize)]
pub struct Rest {
    scene: &'static str,
    hulls: String,
    /// Of the scene; some have one more to push the others.
    pub bodies: u32,
    size: Option<f32>,
    friction: Option<f32>,
    hz: u32,
    recycling: bool,
    hull_shape: bool,
    /// Of each run.
    pub frames: usize,
    /// One for each seed.
    pub runs: Vec<Run>,
    /// The median over the runs of how many times longer the default took for all steps.
    ratio: f64,
    /// The same for the narrow phase.
    narrow_phase_ratio: f64,
    /// In how many runs ours rested no later than [`Run::keeps_limit`] allows.
    kept: usize,
}

/// Both worlds from one seed.
#[derive(Serialize)]
pub struct Run {
    seed: u64,
    /// With rapier's own dispatcher.
    pub default: Side,
    /// With ours.
    pub ours: Side,
    /// Of the sums of all steps, default over ours.
    ratio: f64,
}

/// What one world did.
#[derive(Serialize)]
pub struct Side {
    /// The frame from which on at most one of twenty bodies was awake.
    rest: Option<usize>,
    /// All steps of the run, in milliseconds.
    steps_ms: f64,
    /// Of these, the narrow phase.
    narrow_phase_ms: f64,
    /// How far the body that moved most came after it rested, in millimetres.
    drift_mm: Option<f64>,
    /// Bodies asleep at the end.
    asleep: usize,
    /// Every frame of the run.
    #[serde(skip)]
    pub frames: Vec<Frame>,
}

/// One frame of a world.
pub struct Frame {
    step_ms: f64,
    narrow_phase_ms: f64,
    /// Bodies that do not sleep.
    pub awake: usize,
}

impl Rest {
    /// Steps both worlds for so many frames from each seed, block by block in turn.
    pub fn run(
        scene: Scene,
        params: &SceneParams,
        seeds: u32,
        frames: usize,
        progress: &ProgressBar,
    ) -> Result<Self, String> {
        let seeds = params.seed..params.seed + u64::from(seeds);
        let runs = seeds
            .map(|seed| {
                let params = SceneParams {
                    seed,
                    ..params.clone()
                };
                Run::new(scene, &params, frames, progress)
            })
            .collect::<Result<Vec<_>, _>>()?;
        let median = |of: fn(&Run) -> f64| quantile(runs.iter().map(of).collect(), 0.5);
        Ok(Self {
            scene: scene.name(),
            hulls: params.contents(scene),
            bodies: params.bodies,
            size: params.size.or(scene.default_size()),
            friction: params.friction,
            hz: params.hz,
            recycling: params.recycling,
            hull_shape: params.hull_shape,
            frames,
            ratio: median(|run| run.ratio),
            narrow_phase_ratio: median(Run::narrow_phase_ratio),
            kept: runs.iter().filter(|run| run.keeps_limit(frames)).count(),
            runs,
        })
    }

    /// A short description of what was compared.
    pub fn title(&self) -> String {
        let size = self.size.map(|size| format!(", up to {} m", size));
        let size = size.unwrap_or_default();
        format!(
            "{}: {} bodies, {}{size}",
            self.scene, self.bodies, self.hulls
        )
    }

    /// The mean frame of rest; runs that never rested count whole and are told.
    fn mean_rest(&self, rest: fn(&Run) -> Option<usize>) -> String {
        let frames = self.runs.iter().map(|run| rest(run).unwrap_or(self.frames));
        let mean = frames.sum::<usize>() / self.runs.len();
        match self.runs.iter().filter(|run| rest(run).is_none()).count() {
            0 => format!("{mean} frames"),
            never => format!("{mean} frames ({never} never)"),
        }
    }

    /// Writes every frame of all runs, of both worlds side by side.
    pub fn write_csv(&self, mut file: BufWriter<impl Write>) -> io::Result<()> {
        writeln!(
            file,
            "seed,frame,default_step_ms,default_awake,ours_step_ms,ours_awake"
        )?;
        for run in &self.runs {
            let frames = run.default.frames.iter().zip(&run.ours.frames);
            for (frame, (default, ours)) in frames.enumerate() {
                writeln!(
                    file,
                    "{},{frame},{:.6},{},{:.6},{}",
                    run.seed, default.step_ms, default.awake, ours.step_ms, ours.awake
                )?;
            }
        }
        file.flush()
    }
}

impl Run {
    /// Whether ours rested no later than the limit. Who never rested counts as having rested in the last frame.
    fn keeps_limit(&self, frames: usize) -> bool {
        let [default, ours] = [&self.default, &self.ours].map(|side| side.rest.unwrap_or(frames));
        ours as f64 <= LIMIT_FACTOR * default as f64 + LIMIT_FRAMES
    }

    fn narrow_phase_ratio(&self) -> f64 {
        self.default.narrow_phase_ms / self.ours.narrow_phase_ms
    }

    fn new(
        scene: Scene,
        params: &SceneParams,
        frames: usize,
        progress: &ProgressBar,
    ) -> Result<Self, String> {
        let mut default = Watch::new(scenes::build(scene, params, None)?);
        let ours = Some(IsaGjkDispatcher::default());
        let mut ours = Watch::new(scenes::build(scene, params, ours)?);
        measure::in_blocks(frames, |frames| {
            for watch in [&mut default, &mut ours] {
                (0..frames).for_each(|_| watch.step());
                progress.inc(frames as u64);
            }
        });
        let (default, ours) = (default.finish(), ours.finish());
        Ok(Self {
            seed: params.seed,
            ratio: default.steps_ms / ours.steps_ms,
            default,
            ours,
        })
    }
}

/// Steps a world and watches its bodies.
struct Watch {
    world: World,
    bodies: usize,
    frames: Vec<Frame>,
    /// Since when at most one of twenty is awake, and where the bodies were then.
    rest: Option<(usize, Vec<Vector>)>,
}

impl Watch {
    fn new(world: World) -> Self {
        Self {
            bodies: world.dynamic_bodies().count(),
            world,
            frames: Vec::new(),
            rest: None,
        }
    }

    fn step(&mut self) {
        self.world.step();
        let counters = &self.world.physics.physics_pipeline.counters;
        let awake = self.bodies - self.world.sleeping();
        let frame = self.frames.len();
        self.frames.push(Frame {
            step_ms: counters.step_time_ms(),
            narrow_phase_ms: counters.narrow_phase_time_ms(),
            awake,
        });
        if awake * ONE_AWAKE_OF > self.bodies {
            self.rest = None;
        } else if self.rest.is_none() {
            self.rest = Some((frame, self.places()));
        }
    }

    fn places(&self) -> Vec<Vector> {
        let bodies = self.world.dynamic_bodies();
        bodies.map(RigidBody::translation).collect()
    }

    fn finish(self) -> Side {
        let drift = self.rest.as_ref().map(|(_, places)| {
            let now = self.places();
            let ways = now
                .iter()
                .zip(places)
                .map(|(now, then)| now.distance(*then));
            1e3 * f64::from(ways.fold(0.0, f32::max))
        });
        let sum = |of: fn(&Frame) -> f64| self.frames.iter().map(of).sum();
        Side {
            rest: self.rest.as_ref().map(|(frame, _)| *frame),
            steps_ms: sum(|frame| frame.step_ms),
            narrow_phase_ms: sum(|frame| frame.narrow_phase_ms),
            drift_mm: drift,
            asleep: self.world.sleeping(),
            frames: self.frames,
        }
    }
}

impl fmt::Display for Rest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let recycling = if self.recycling { "on" } else { "off" };
        let friction = self
            .friction
            .map(|friction| format!(", friction {friction}"));
        writeln!(
            f,
            "{}, {} frames at {} Hz{}, recycling {recycling}\n",
            self.title(),
            self.frames,
            self.hz,
            friction.unwrap_or_default()
        )?;
        writeln!(
            f,
            "{:>4} {:>15} {:>15} {:>24} {:>19}",
            "", "frame of rest", "asleep at last", "all steps, ms", "drift then, mm"
        )?;
        writeln!(
            f,
            "seed {:>7} {:>7} {:>7} {:>7} {:>8} {:>8} {:>6} {:>9} {:>9}",
            "default",
            "isa-gjk",
            "default",
            "isa-gjk",
            "default",
            "isa-gjk",
            "ratio",
            "default",
            "isa-gjk"
        )?;
        for run in &self.runs {
            write!(f, "{run}")?;
        }
        let [default, ours] = [|run: &Run| run.default.rest, |run: &Run| run.ours.rest];
        writeln!(
            f,
            "rest after {} by default and {} with isa-gjk in the mean; {} of {} runs keep the limit",
            self.mean_rest(default),
            self.mean_rest(ours),
            self.kept,
            self.runs.len()
        )?;
        writeln!(
            f,
            "median ratio of all steps {:.2}, of the narrow phase {:.2}",
            self.ratio, self.narrow_phase_ratio
        )
    }
}

impl fmt::Display for Run {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rest = |side: &Side| match side.rest {
            Some(frame) => frame.to_string(),
            None => "never".to_owned(),
        };
        let drift = |side: &Side| match side.drift_mm {
            Some(drift) => format!("{drift:.2}"),
            None => "-".to_owned(),
        };
        let (default, ours) = (&self.default, &self.ours);
        writeln!(
            f,
            "{:4} {:>7} {:>7} {:7} {:7} {:8.0} {:8.0} {:6.2} {:>9} {:>9}",
            self.seed,
            rest(default),
            rest(ours),
            default.asleep,
            ours.asleep,
            default.steps_ms,
            ours.steps_ms,
            self.ratio,
            drift(default),
            drift(ours)
        )
    }
}
