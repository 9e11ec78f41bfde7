//! The command line.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Parser, ValueEnum, value_parser};
use rapier3d::prelude::Real;

use crate::measure::RunLength;
use testkit::numbers::positive;
use testkit::scenes::{CurvedScene, Ground, HullSource, Hulls, Scene, SceneParams, Solid};

/// How long a world is watched until its bodies sleep: most need two to six seconds.
const SECONDS_UNTIL_ASLEEP: u32 = 12;

/// Steps two equal rapier worlds in turn, one with rapier's own narrow phase and one with
/// isa-gjk, and prints what each cost.
#[derive(Parser)]
#[command(name = "compare")]
pub struct Options {
    /// What is in the world: drum, pile, stack, coins, wall, dominoes, spin, top, rolling, asleep,
    /// cuboids, balls, mixed, solids, compound, trimesh, heightfield, rocks, stones, dice, pebbles, cubes,
    /// plates, needles, pencils, rings, breach, rubble, grippers, shaken-grippers, reshaped or bursts
    #[arg(long, default_value_t = Scene::Drum)]
    pub scene: Scene,

    /// Kinds of bodies in the scene solids, which take turns: ball, cuboid, rounded-cuboid, capsule,
    /// cylinder, rounded-cylinder, log, coin, cone or hull [default: all of them]
    #[arg(long, value_delimiter = ',')]
    solids: Option<Vec<Solid>>,

    /// What they fall on: floor, mesh, corrected-mesh (with FIX_INTERNAL_EDGES), heightfield or boxes (one compound)
    #[arg(long, default_value = Ground::Floor.name())]
    ground: Ground,

    /// The hulls: random, prism, box, real, or the path of an .obj file [default: random; stack,
    /// coins, spin and top have prisms; stack can have real ones that are flat below and above]
    #[arg(long)]
    shape: Option<Shape>,

    /// Sides of a prism, or of a ring, which has as many parts [default: half of the vertices; 64 for
    /// coins, tops and rings]
    #[arg(long, value_parser = value_parser!(u32).range(3..=10_000))]
    sides: Option<u32>,

    /// Dynamic bodies [default: 128 to 1000, by scene]
    #[arg(long, value_parser = value_parser!(u32).range(1..=100_000))]
    bodies: Option<u32>,

    /// The largest extent of the largest body, in metres [default: 5 to 40 cm for rocks, stones,
    /// dice, pebbles, cubes, plates, needles, pencils, rings, breach, rubble, grippers and bursts;
    /// about a metre elsewhere]
    #[arg(long, value_parser = positive::<Real>)]
    size: Option<Real>,

    /// Friction of all colliders [default: rapier's]
    #[arg(long, value_parser = positive::<Real>)]
    friction: Option<Real>,

    /// Steps per second
    #[arg(long, default_value_t = 60, value_parser = value_parser!(u32).range(10..=1000))]
    hz: u32,

    /// Vertices of a random hull or of a prism
    #[arg(long, default_value_t = 100, value_parser = value_parser!(u32).range(4..=20_000))]
    pub vertices: u32,

    /// How many different hulls the scene has [default: 16, or all of the real ones]
    #[arg(long, value_parser = value_parser!(u32).range(1..=100_000))]
    distinct: Option<u32>,

    /// Frames to step after the warm-up, at least 2 [default: 480; 240 for piles, which then rest;
    /// 12 seconds with --until-asleep]
    #[arg(long, value_parser = value_parser!(u32).range(2..))]
    frames: Option<u32>,

    /// Frames to step before counting
    #[arg(long, default_value_t = 60)]
    warmup: u32,

    /// Seed of shapes and starting poses
    #[arg(long, default_value_t = 1)]
    pub seed: u64,

    /// Whether rapier may keep the contacts of pairs that hardly moved
    #[arg(long, value_enum, default_value_t = Switch::On)]
    recycling: Switch,

    /// Let bodies fall asleep, to see whether and when they do; sleeping ones cost nothing
    #[arg(long)]
    sleep: bool,

    /// Let bodies fall asleep, and tell when 19 of 20 sleep for good, what all steps of the run cost
    /// together, and how far bodies move after that, for each of --seeds. --csv writes steps and
    /// awake bodies of every frame, --chart draws the awake bodies
    #[arg(long, conflicts_with_all = ["sweep", "verify", "warmup", "repeat"])]
    pub until_asleep: bool,

    /// Measure how cylinders, cones and capsules lie, stand and roll instead, with either dispatcher:
    /// capsule-logs, logs, cones, coins, barrels, tall-barrels, roll, long-roll, mesh-roll, waves,
    /// thin-floor or heap; all of them if none is named
    #[arg(long, value_name = "SCENE", num_args = 0..=1, default_missing_value = "all",
        conflicts_with_all = ["sweep", "verify", "warmup", "repeat", "until_asleep", "csv", "chart"])]
    pub curved: Option<String>,

    /// How many seeds to run with --until-asleep or --curved, from --seed on
    #[arg(long, default_value_t = 1, value_parser = value_parser!(u32).range(1..=1000))]
    pub seeds: u32,

    /// Give the world of isa-gjk `HullShape` colliders; the default one keeps plain hulls
    #[arg(long)]
    hull_shape: bool,

    /// Tell isa-gjk that shapes do not change within a step, with `with_unchanged_shapes`
    #[arg(long)]
    unchanged_shapes: bool,

    /// Give each collider a shape of its own, in both worlds: copies, as in a world that was loaded
    #[arg(long, conflicts_with = "hull_shape")]
    own_shapes: bool,

    /// Whole runs; the table shows the median of each figure and of each ratio over them
    #[arg(long, default_value_t = 1, value_parser = value_parser!(u32).range(1..=1000))]
    pub repeat: u32,

    /// Write the figures of the table to this file as JSON
    #[arg(long)]
    pub json: Option<PathBuf>,

    /// Write the times of every frame of both worlds to this file, one row per frame
    #[arg(long)]
    pub csv: Option<PathBuf>,

    /// Draw the narrow phase's time in every frame of both worlds as an SVG picture (the median
    /// over the repeats); with --sweep, the time per pair over the sweep
    #[arg(long)]
    pub chart: Option<PathBuf>,

    /// Measure the scene at vertex counts from 8 to 1024 instead, with recycling and without, as
    /// plain hulls and as `HullShape`s, and print the narrow phase's time per contact pair; --json
    /// and --csv write these figures. Takes a median over the --repeat runs of each
    #[arg(long, value_enum, conflicts_with_all = ["vertices", "sides", "recycling", "hull_shape", "verify"])]
    pub sweep: Option<Sweep>,

    /// Check about so many of the contact manifolds that the world of isa-gjk keeps, drawn at random over
    /// the run: each is brought to the present poses, warm from what it remembers and cold from
    /// nothing. Both must have the same depth; the shapes must be that far apart along its normal by
    /// parry's support functions; and no direction that parry's own contact finds may separate
    /// them better. Ends with an error if one of these is off by more than 1e-5 of the larger
    /// shape's diameter
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub verify: u32,

    /// Write down pairs of the world of isa-gjk whose contacts look wrong, in a file for `inspect` and
    /// `replay`. Each update is checked, so the times mean nothing
    #[arg(long, conflicts_with_all = ["sweep", "until_asleep", "curved"])]
    pub record: Option<PathBuf>,

    /// Show no progress bar
    #[arg(long)]
    pub quiet: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Switch {
    On,
    Off,
}

/// What a sweep varies.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Sweep {
    /// The vertices of a hull.
    Vertices,
}

#[derive(Clone)]
enum Shape {
    Random,
    Prism,
    Box,
    Real,
    File(PathBuf),
}

impl FromStr for Shape {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "random" => Ok(Self::Random),
            "prism" => Ok(Self::Prism),
            "box" => Ok(Self::Box),
            "real" => Ok(Self::Real),
            _ if text.to_ascii_lowercase().ends_with(".obj") => Ok(Self::File(text.into())),
            _ => Err("give random, prism, box, real or the path of an .obj file".to_owned()),
        }
    }
}

impl Options {
    /// What to build, of hulls with so many vertices.
    pub fn scene_params(&self, vertices: u32) -> Result<SceneParams, String> {
        let hulls = self.hull_source(vertices)?;
        if self.scene != Scene::Solids && (self.solids.is_some() || self.ground != Ground::Floor) {
            return Err(
                "--solids and --ground are for piles of solids: add --scene solids".to_owned(),
            );
        }
        let bodies = self.bodies.unwrap_or(self.scene.default_bodies());
        let params = SceneParams::new(hulls, bodies);
        Ok(SceneParams {
            distinct: self.distinct.unwrap_or(params.distinct),
            size: self.size,
            solids: self.solids.clone().unwrap_or(params.solids),
            ground: self.ground,
            friction: self.friction,
            hz: self.hz,
            seed: self.seed,
            recycling: self.recycling == Switch::On,
            hull_shape: self.hull_shape,
            unchanged_shapes: self.unchanged_shapes,
            own_shapes: self.own_shapes,
            can_sleep: self.sleep || self.until_asleep || self.scene == Scene::Asleep,
            ..params
        })
    }

    /// The scenes of `--curved`.
    pub fn curved_scenes(&self) -> Result<Vec<CurvedScene>, String> {
        let wanted = self.curved.as_deref().unwrap_or("all");
        let is_wanted = |scene: &CurvedScene| wanted == "all" || wanted == scene.name();
        let scenes: Vec<_> = CurvedScene::ALL.into_iter().filter(is_wanted).collect();
        if scenes.is_empty() {
            let names = CurvedScene::ALL.map(CurvedScene::name).join(", ");
            return Err(format!("choose one of {names}"));
        }
        Ok(scenes)
    }

    /// How long to run.
    pub fn run_length(&self) -> RunLength {
        RunLength {
            warmup: self.warmup as usize,
            frames: self.frames.unwrap_or(self.scene.default_frames()) as usize,
            verify: self.verify,
        }
    }

    /// Frames of a run that waits for bodies to sleep.
    pub fn frames_until_asleep(&self) -> usize {
        self.frames.unwrap_or(SECONDS_UNTIL_ASLEEP * self.hz) as usize
    }

    fn hull_source(&self, vertices: u32) -> Result<HullSource, String> {
        let shape = match (&self.shape, self.scene.hulls()) {
            (Some(shape), Hulls::Any) => shape,
            (None | Some(Shape::Prism), Hulls::Prisms | Hulls::Upright) => &Shape::Prism,
            (Some(Shape::Real), Hulls::Upright) => &Shape::Real,
            (None, Hulls::Boxes) => &Shape::Box,
            (None, Hulls::Own) => return Ok(HullSource::Own),
            (None, Hulls::Any | Hulls::None) => &Shape::Random,
            (Some(_), Hulls::Prisms | Hulls::Upright | Hulls::Boxes | Hulls::Own | Hulls::None) => {
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
            Shape::Random => HullSource::Random { vertices },
            Shape::Prism => HullSource::Prism {
                sides: self.sides.unwrap_or(match self.scene {
                    Scene::Coins | Scene::Top | Scene::Rings => 64,
                    _ => (vertices / 2).max(3),
                }),
            },
            Shape::Box => HullSource::Box,
            Shape::Real => HullSource::Real,
            Shape::File(path) => HullSource::File(path.clone()),
        })
    }
}
