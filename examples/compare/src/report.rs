//! The figures of a comparison, and their table.

use std::fmt;

use isa_gjk::{Stage, Stats};
use serde::Serialize;

use crate::measure::{BLOCK, Frame, Run, RunLength, Side, Times};
use crate::verify::Verified;
use testkit::quality::quantile;
use testkit::scenes::{Scene, SceneParams};

/// Everything the table shows.
#[derive(Serialize)]
pub struct Report {
    scene: &'static str,
    hulls: String,
    bodies: u32,
    seed: u64,
    recycling: bool,
    hull_shape: bool,
    unchanged_shapes: bool,
    own_shapes: bool,
    warmup: usize,
    frames: usize,
    repeat: usize,
    /// Medians over the repeats.
    figures: Vec<Figure>,
    /// Hash of the final poses of the first run with rapier's own dispatcher.
    default_pose_hash: String,
    /// The same with ours.
    our_pose_hash: String,
    /// Whether every repeat ended in these poses.
    repeatable: bool,
    /// What our queries cost in the first run.
    queries: Queries,
    /// What became of the manifolds that were checked in the first run.
    #[serde(skip_serializing_if = "Option::is_none")]
    verified: Option<Verified>,
}

/// One row of the table.
#[derive(Serialize)]
struct Figure {
    name: &'static str,
    unit: &'static str,
    default: f64,
    ours: f64,
    /// Default over ours, of figures that are times and not zero.
    ratio: Option<f64>,
}

/// Counts of the dispatcher, per query.
#[derive(Serialize)]
struct Queries {
    count: u64,
    /// Share of the queries that each stage answered.
    answered: Vec<(&'static str, f64)>,
    iterations: f64,
    supports: f64,
    climb_moves: f64,
    fallbacks: u64,
}

impl Report {
    /// Summarises `runs`. There must be at least one.
    pub fn new(scene: Scene, params: &SceneParams, length: RunLength, runs: &[Run]) -> Self {
        let first = &runs[0];
        let hashes = |run: &Run| (run.default.pose_hash, run.ours.pose_hash);
        Self {
            scene: scene.name(),
            hulls: params.contents(scene),
            bodies: params.bodies,
            seed: params.seed,
            recycling: params.recycling,
            hull_shape: params.hull_shape,
            unchanged_shapes: params.unchanged_shapes,
            own_shapes: params.own_shapes,
            warmup: length.warmup,
            frames: length.frames,
            repeat: runs.len(),
            figures: figures(scene, runs),
            default_pose_hash: format!("{:016x}", first.default.pose_hash),
            our_pose_hash: format!("{:016x}", first.ours.pose_hash),
            repeatable: runs.iter().all(|run| hashes(run) == hashes(first)),
            queries: Queries::new(&first.stats),
            verified: first.verified,
        }
    }

    /// A short description of what was compared.
    pub fn title(&self) -> String {
        format!("{}: {} bodies, {}", self.scene, self.bodies, self.hulls)
    }

    /// Whether a manifold was checked and found wrong.
    pub fn failed_check(&self) -> bool {
        self.verified.is_some_and(|verified| verified.failed())
    }
}

fn figures(scene: Scene, runs: &[Run]) -> Vec<Figure> {
    let time = |name, of: fn(&Frame) -> f64| Figure::time(name, runs, of);
    let other = |name, unit, of: fn(&Side) -> f64| Figure::other(name, unit, runs, of);
    let mut figures = vec![
        time("whole step", |frame| frame.times.step),
        time("broad phase", |frame| frame.times.broad_phase),
        time("narrow phase", |frame| frame.times.narrow_phase),
        time("solver", |frame| frame.times.solver),
        time("ccd", |frame| frame.times.ccd),
        Figure::all_steps("all steps", runs, |times| times.map(|t| t.step).sum()),
        Figure::all_steps("worst step", runs, |times| {
            times.map(|t| t.step).fold(0.0, f64::max)
        }),
        other("pairs", "", |side| per_frame(side, |f| f.pairs as f64)),
        other("touching pairs", "", |side| {
            per_frame(side, |f| f.touching as f64)
        }),
        other("reported penetration, worst", "mm", |side| depth(side, 1.0)),
        other("reported, 99th percentile", "mm", |side| depth(side, 0.99)),
        other("kinetic energy at the end", "J", |side| side.kinetic_energy),
        other("mean height at the end", "m", |side| side.mean_height),
        other("true overlap, 99th perc.", "mm", |side| {
            side.quality.overlap * 1e3
        }),
        other("median speed at the end", "mm/s", |side| {
            side.quality.median_speed * 1e3
        }),
        other("largest drift at the end", "mm", |side| {
            side.quality.drift * 1e3
        }),
        other("asleep at the end", "", |side| side.sleeping as f64),
        other("all asleep after steps", "", |side| {
            side.quality
                .asleep_after
                .map_or(f64::INFINITY, |n| n as f64)
        }),
    ];
    if scene.renews() {
        figures.extend([
            Figure::all_steps("making hulls", runs, |times| times.map(|t| t.making).sum()),
            Figure::all_steps("all frames", runs, |times| times.map(Times::frame).sum()),
            Figure::all_steps("worst frame", runs, |times| {
                times.map(Times::frame).fold(0.0, f64::max)
            }),
        ]);
    }
    if scene.stands() {
        figures.extend([
            other("largest tilt at the end", "°", |side| side.quality.tilt),
            other("patch off centre", "radii", |side| {
                side.quality.patch_offset
            }),
            other("patch moves per step", "radii", |side| {
                side.quality.patch_step
            }),
            other("in the worst step", "radii", |side| {
                side.quality.worst_patch_step
            }),
        ]);
    }
    figures
}

impl Figure {
    fn time(name: &'static str, runs: &[Run], of: fn(&Frame) -> f64) -> Self {
        Self::with_ratio(name, runs, |side| per_frame(side, of))
    }

    /// A figure of the times of all whole steps, counted or not.
    fn all_steps(
        name: &'static str,
        runs: &[Run],
        of: fn(&mut dyn Iterator<Item = &Times>) -> f64,
    ) -> Self {
        Self::with_ratio(name, runs, |side| {
            of(&mut side.frames.iter().map(|frame| &frame.times))
        })
    }

    fn with_ratio(name: &'static str, runs: &[Run], of: impl Fn(&Side) -> f64) -> Self {
        let ratios = runs.iter().filter_map(|run| {
            let ours = of(&run.ours);
            (ours > 0.0).then(|| of(&run.default) / ours)
        });
        Self {
            ratio: Some(quantile(ratios.collect(), 0.5)).filter(|ratio| *ratio > 0.0),
            ..Self::other(name, "ms", runs, of)
        }
    }

    fn other(
        name: &'static str,
        unit: &'static str,
        runs: &[Run],
        of: impl Fn(&Side) -> f64,
    ) -> Self {
        let median =
            |side: fn(&Run) -> &Side| quantile(runs.iter().map(|run| of(side(run))).collect(), 0.5);
        Self {
            name,
            unit,
            default: median(|run| &run.default),
            ours: median(|run| &run.ours),
            ratio: None,
        }
    }
}

impl Queries {
    fn new(stats: &Stats) -> Self {
        let count = stats.queries();
        let per_query = |total: u64| total as f64 / count.max(1) as f64;
        Self {
            count,
            answered: Stage::ALL
                .map(|stage| (stage.name(), per_query(stats.answered[stage as usize])))
                .to_vec(),
            iterations: per_query(stats.iterations),
            supports: per_query(stats.supports),
            climb_moves: per_query(stats.climb_moves),
            fallbacks: stats.fallbacks,
        }
    }
}

/// The median over the counted frames.
pub fn per_frame(side: &Side, of: impl Fn(&Frame) -> f64) -> f64 {
    let counted = side.frames.iter().filter(|frame| frame.counted);
    quantile(counted.map(of).collect(), 0.5)
}

/// A quantile of the penetration depths, in millimetres; pairs that are only close count as
/// depth zero.
fn depth(side: &Side, share: f64) -> f64 {
    let depths = side.depths.iter().map(|d| f64::from(d.max(0.0)) * 1e3);
    quantile(depths.collect(), share)
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let recycling = if self.recycling { "on" } else { "off" };
        let prepared = match (self.hull_shape, self.unchanged_shapes) {
            (true, _) => " (HullShape for isa-gjk)",
            (false, true) => " (unchanged in a step, as isa-gjk is told)",
            (false, false) => "",
        };
        let own = if self.own_shapes {
            " that no two bodies share"
        } else {
            ""
        };
        writeln!(
            f,
            "{}: {} bodies, {}{own}{prepared}, seed {}, recycling {recycling}",
            self.scene, self.bodies, self.hulls, self.seed
        )?;
        writeln!(
            f,
            "{} frames after {} of warm-up, in blocks of {BLOCK} (the first of each not counted), {} run(s)\n",
            self.frames, self.warmup, self.repeat
        )?;
        writeln!(
            f,
            "{:28} {:>16} {:>16} {:>8}",
            "median per frame", "default", "isa-gjk", "ratio"
        )?;
        for figure in &self.figures {
            write!(f, "{figure}")?;
        }
        writeln!(
            f,
            "{:28} {:>16} {:>16}",
            "pose hash", self.default_pose_hash, self.our_pose_hash
        )?;
        if !self.repeatable {
            writeln!(
                f,
                "the repeats ended in different poses: the worlds are not deterministic"
            )?;
        }
        write!(f, "\n{}", self.queries)?;
        match &self.verified {
            Some(verified) => write!(f, "\n{verified}"),
            None => Ok(()),
        }
    }
}

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Counts are whole numbers; everything else has a unit.
        let digits = if self.unit.is_empty() { 0 } else { 3 };
        let name = format!("{} {}", self.name, self.unit);
        write!(
            f,
            "{name:28} {:16.digits$} {:16.digits$}",
            self.default, self.ours
        )?;
        match self.ratio {
            Some(ratio) => writeln!(f, " {ratio:8.2}"),
            None => writeln!(f),
        }
    }
}

impl fmt::Display for Queries {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.count == 0 {
            return writeln!(f, "isa-gjk answered no query of its own in this scene.");
        }
        writeln!(f, "isa-gjk answered {} queries, by", self.count)?;
        for (stage, share) in &self.answered {
            writeln!(f, "  {stage:12} {:6.2} %", share * 100.0)?;
        }
        writeln!(
            f,
            "per query {:.2} iterations, {:.2} supports, {:.2} climb moves; {} fallbacks in all",
            self.iterations, self.supports, self.climb_moves, self.fallbacks
        )
    }
}
