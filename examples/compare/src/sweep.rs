//! The time of a contact pair against the number of vertices.

use std::fmt;
use std::io::{self, BufWriter, Write};

use indicatif::ProgressBar;
use isa_gjk::IsaGjkDispatcher;
use serde::Serialize;

use crate::measure::{self, Run, Side};
use crate::options::Options;
use crate::report::per_frame;
use testkit::quality::quantile;
use testkit::scenes::SceneParams;

/// Evenly spaced on a logarithmic axis.
const VERTICES: [u32; 8] = [8, 16, 32, 64, 128, 256, 512, 1024];

/// A scene measured at many vertex counts.
#[derive(Serialize)]
pub struct Sweep {
    /// The scene in the world.
    pub scene: &'static str,
    /// How many of them.
    pub bodies: u32,
    seed: u64,
    warmup: usize,
    frames: usize,
    repeat: u32,
    /// From few vertices to many, with recycling and then without.
    pub rows: Vec<Row>,
}

/// The narrow phase's time per contact pair, in microseconds: medians over frames and repeats.
#[derive(Serialize)]
pub struct Row {
    /// Of each hull.
    pub vertices: u32,
    /// Whether rapier kept the contacts of pairs that hardly moved.
    pub recycling: bool,
    /// With rapier's own dispatcher.
    pub default: f64,
    /// With ours.
    pub ours: f64,
    /// Default over ours.
    ratio: f64,
    /// With ours, and `HullShape`s in the place of plain hulls.
    pub hull_shape: f64,
    /// Default over that, measured side by side in the same runs.
    hull_shape_ratio: f64,
}

impl Sweep {
    /// How many worlds' steps [`run`](Self::run) takes.
    pub fn steps(options: &Options) -> u64 {
        let runs = 2 * 2 * VERTICES.len() as u64 * u64::from(options.repeat);
        runs * options.run_length().steps()
    }

    /// Measures the scene at every vertex count.
    pub fn run(options: &Options, progress: &ProgressBar) -> Result<Self, String> {
        let scene = options.scene;
        let params = |vertices| options.scene_params(vertices);
        if params(VERTICES[0])?.hulls == params(VERTICES[1])?.hulls {
            return Err(format!(
                "there is nothing to sweep: the shapes of the scene {scene} do not depend on the \
                 number of vertices"
            ));
        }
        let length = options.run_length();
        let dispatcher = IsaGjkDispatcher::default();
        let mut rows = Vec::new();
        for recycling in [true, false] {
            for vertices in VERTICES {
                let measure = |hull_shape| {
                    let params = SceneParams {
                        recycling,
                        hull_shape,
                        ..params(vertices)?
                    };
                    (0..options.repeat)
                        .map(|_| measure::run(scene, &params, &dispatcher, length, progress))
                        .collect::<Result<Vec<_>, _>>()
                };
                rows.push(Row::new(
                    vertices,
                    recycling,
                    &measure(false)?,
                    &measure(true)?,
                ));
            }
        }
        let first = params(VERTICES[0])?;
        Ok(Self {
            scene: scene.name(),
            bodies: first.bodies,
            seed: first.seed,
            warmup: length.warmup,
            frames: length.frames,
            repeat: options.repeat,
            rows,
        })
    }

    /// Writes the rows of the table.
    pub fn write_csv(&self, mut file: BufWriter<impl Write>) -> io::Result<()> {
        writeln!(
            file,
            "vertices,recycling,default_us,ours_us,ratio,hull_shape_us,hull_shape_ratio"
        )?;
        for row in &self.rows {
            let recycling = u8::from(row.recycling);
            writeln!(
                file,
                "{},{recycling},{:.6},{:.6},{:.3},{:.6},{:.3}",
                row.vertices,
                row.default,
                row.ours,
                row.ratio,
                row.hull_shape,
                row.hull_shape_ratio
            )?;
        }
        file.flush()
    }
}

impl Row {
    fn new(vertices: u32, recycling: bool, plain: &[Run], prepared: &[Run]) -> Self {
        let [default, ours] = per_pair(plain);
        let [default_again, hull_shape] = per_pair(prepared);
        Self {
            vertices,
            recycling,
            default,
            ours,
            ratio: default / ours,
            hull_shape,
            hull_shape_ratio: default_again / hull_shape,
        }
    }
}

/// Of the default world and of ours.
fn per_pair(runs: &[Run]) -> [f64; 2] {
    let sides: [fn(&Run) -> &Side; 2] = [|run| &run.default, |run| &run.ours];
    sides.map(|side| median_per_pair(runs, side))
}

fn median_per_pair(runs: &[Run], side: fn(&Run) -> &Side) -> f64 {
    let medians = runs.iter().map(|run| {
        per_frame(side(run), |frame| {
            1e3 * frame.times.narrow_phase / frame.pairs.max(1) as f64
        })
    });
    quantile(medians.collect(), 0.5)
}

impl fmt::Display for Sweep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{}: {} bodies, seed {}; {} frames after {} of warm-up, {} run(s) of each",
            self.scene, self.bodies, self.seed, self.frames, self.warmup, self.repeat
        )?;
        writeln!(f, "narrow phase, microseconds per contact pair (medians)\n")?;
        writeln!(
            f,
            "{:>8} {:>9} {:>9} {:>9} {:>6} {:>9} {:>6}",
            "vertices", "recycling", "default", "isa-gjk", "ratio", "HullShape", "ratio"
        )?;
        for row in &self.rows {
            let recycling = if row.recycling { "on" } else { "off" };
            writeln!(
                f,
                "{:8} {recycling:>9} {:9.3} {:9.3} {:6.2} {:9.3} {:6.2}",
                row.vertices,
                row.default,
                row.ours,
                row.ratio,
                row.hull_shape,
                row.hull_shape_ratio
            )?;
        }
        Ok(())
    }
}
