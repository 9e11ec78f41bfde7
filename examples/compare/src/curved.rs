//! How cylinders, cones and capsules lie, stand and roll in both worlds.

use std::fmt;

use indicatif::ProgressBar;
use isa_gjk::IsaGjkDispatcher;
use serde::Serialize;

use crate::measure;
use testkit::scenes::{CurvedScene, Figure, Watched};

/// What was measured of some scenes.
#[derive(Serialize)]
pub struct Curved {
    scenes: Vec<SceneFigures>,
}

#[derive(Serialize)]
struct SceneFigures {
    scene: &'static str,
    seed: u64,
    figures: Vec<Compared>,
}

/// `None` is never.
#[derive(Serialize)]
struct Compared {
    name: &'static str,
    default: Option<f64>,
    ours: Option<f64>,
}

impl Curved {
    /// Steps both worlds of each scene and seed, block by block in turn.
    pub fn run(scenes: &[CurvedScene], seed: u64, seeds: u32, progress: &ProgressBar) -> Self {
        let runs = scenes.iter().flat_map(|scene| {
            let seeds = seed..seed + u64::from(seeds);
            seeds.map(|seed| SceneFigures::run(*scene, seed, progress))
        });
        Self {
            scenes: runs.collect(),
        }
    }
}

impl SceneFigures {
    fn run(scene: CurvedScene, seed: u64, progress: &ProgressBar) -> Self {
        let ours = Some(IsaGjkDispatcher::default());
        let mut worlds = [None, ours].map(|dispatcher| Watched::new(scene, seed, dispatcher));
        measure::in_blocks(scene.steps(), |steps| {
            for world in &mut worlds {
                (0..steps).for_each(|_| world.step());
                progress.inc(steps as u64);
            }
        });
        let [default, ours] = worlds.map(|world| world.figures());
        let compared = |(default, ours): (Figure, Figure)| Compared {
            name: default.name,
            default: default.value,
            ours: ours.value,
        };
        Self {
            scene: scene.name(),
            seed,
            figures: default.into_iter().zip(ours).map(compared).collect(),
        }
    }
}

impl fmt::Display for Curved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = |value: Option<f64>| match value {
            Some(value) => format!("{value:.4}"),
            None => "never".to_owned(),
        };
        writeln!(
            f,
            "{:12} {:>4} {:24} {:>10} {:>10}",
            "", "seed", "", "default", "isa-gjk"
        )?;
        for run in &self.scenes {
            for (i, figure) in run.figures.iter().enumerate() {
                let (scene, seed) = if i == 0 {
                    (run.scene, run.seed.to_string())
                } else {
                    ("", String::new())
                };
                let [default, ours] = [figure.default, figure.ours].map(number);
                writeln!(
                    f,
                    "{scene:12} {seed:>4} {:24} {default:>10} {ours:>10}",
                    figure.name
                )?;
            }
        }
        Ok(())
    }
}
