//! The command line.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Parser, ValueEnum, value_parser};

use crate::measure::RunLength;
use crate::scenes::{HullSource, Hulls, Scene, SceneParams};

/// Steps two equal rapier worlds in turn, one with rapier's own narrow phase and one with
/// isa-gjk, and prints what each cost.
#[derive(Parser)]
#[command(name = "compare")]
pub struct Options {
    /// What is in the world: drum, pile, stack, coins, asleep, cuboids, balls, mixed, compound,
    /// trimesh or heightfield
    #[arg(long, default_value_t = Scene::Drum)]
    pub scene: Scene,

    /// The hulls: random, prism, real, or the path of an .obj file [default: random; stack and
    /// coins stand on prisms]
    #[arg(long)]
    shape: Option<Shape>,

    /// Sides of a prism [default: half of the vertices; 64 for coins]
    #[arg(long, value_parser = value_parser!(u32).range(3..=10_000))]
    sides: Option<u32>,

    /// Dynamic bodies [default: 128 to 1000, by scene]
    #[arg(long, value_parser = value_parser!(u32).range(1..=100_000))]
    bodies: Option<u32>,

    /// Vertices of a random hull or of a prism
    #[arg(long, default_value_t = 100, value_parser = value_parser!(u32).range(4..=20_000))]
    vertices: u32,

    /// How many different hulls the scene has [default: 16, or all of the real ones]
    #[arg(long, value_parser = value_parser!(u32).range(1..=100_000))]
    distinct: Option<u32>,

    /// Frames to step after the warm-up, at least 2
    #[arg(long, default_value_t = 480, value_parser = value_parser!(u32).range(2..))]
    frames: u32,

    /// Frames to step before counting
    #[arg(long, default_value_t = 60)]
    warmup: u32,

    /// Seed of shapes and starting poses
    #[arg(long, default_value_t = 1)]
    seed: u64,

    /// Whether rapier may keep the contacts of pairs that hardly moved
    #[arg(long, value_enum, default_value_t = Switch::On)]
    recycling: Switch,

    /// Give the world of isa-gjk `HullShape` colliders; the default one keeps plain hulls
    #[arg(long)]
    hull_shape: bool,

    /// Whole runs; the table shows the median of each figure and of each ratio over them
    #[arg(long, default_value_t = 1, value_parser = value_parser!(u32).range(1..=1000))]
    pub repeat: u32,

    /// Write the figures of the table to this file as JSON
    #[arg(long)]
    pub json: Option<PathBuf>,

    /// Write the times of every frame of both worlds to this file, one row per frame
    #[arg(long)]
    pub csv: Option<PathBuf>,

    /// Show no progress bar
    #[arg(long)]
    pub quiet: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Switch {
    On,
    Off,
}

#[derive(Clone)]
enum Shape {
    Random,
    Prism,
    Real,
    File(PathBuf),
}

impl FromStr for Shape {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "random" => Ok(Self::Random),
            "prism" => Ok(Self::Prism),
            "real" => Ok(Self::Real),
            _ if text.to_ascii_lowercase().ends_with(".obj") => Ok(Self::File(text.into())),
            _ => Err("give random, prism, real or the path of an .obj file".to_owned()),
        }
    }
}

impl Options {
    /// What to build.
    pub fn scene_params(&self) -> Result<SceneParams, String> {
        let hulls = self.hull_source()?;
        let all_real = if hulls == HullSource::Real {
            u32::MAX
        } else {
            16
        };
        Ok(SceneParams {
            hulls,
            distinct: self.distinct.unwrap_or(all_real),
            bodies: self.bodies.unwrap_or(self.scene.default_bodies()),
            seed: self.seed,
            recycling: self.recycling == Switch::On,
            hull_shape: self.hull_shape,
        })
    }

    /// How long to run.
    pub fn run_length(&self) -> RunLength {
        RunLength {
            warmup: self.warmup as usize,
            frames: self.frames as usize,
        }
    }

    fn hull_source(&self) -> Result<HullSource, String> {
        let shape = match (&self.shape, self.scene.hulls()) {
            (Some(shape), Hulls::Any) => shape,
            (None | Some(Shape::Prism), Hulls::Prisms) => &Shape::Prism,
            (None, Hulls::Any | Hulls::None) => &Shape::Random,
            (Some(_), Hulls::Prisms | Hulls::None) => {
                return Err(format!(
                    "the scene {} makes its own shapes: leave --shape out, or choose another scene",
                    self.scene
                ));
            }
        };
        if self.sides.is_some() && !matches!(shape, Shape::Prism) {
            return Err("--sides is for prisms: add --shape prism".to_owned());
        }
        Ok(match shape {
            Shape::Random => HullSource::Random {
                vertices: self.vertices,
            },
            Shape::Prism => HullSource::Prism {
                sides: self.sides.unwrap_or(match self.scene {
                    Scene::Coins => 64,
                    _ => (self.vertices / 2).max(3),
                }),
            },
            Shape::Real => HullSource::Real,
            Shape::File(path) => HullSource::File(path.clone()),
        })
    }
}
