//! Draws a pair of hulls at one frame of a trajectory, with its memory, which stage answered, and what came
//! out: `cargo run --release -p inspect -- --help`.

mod picture;
mod recorded;
mod rule;
mod rules;
mod seam;
mod shape_faces;
mod svg;

use std::error::Error;
use std::f32::consts::{FRAC_PI_2, PI};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, ValueEnum, value_parser};
use glam::Vec3;
use isa_gjk::internals::epa::EpaScratch;
use isa_gjk::internals::manifold::{self, ClipScratch};
use isa_gjk::internals::pose::RelativePose;
use isa_gjk::internals::query::{Answer, PairMemory, Query};
use isa_gjk::internals::stats::Cost;
use isa_gjk::internals::support::Cso;
use isa_gjk::{Hull, HullShape};
use oorandom::Rand32;
use rapier3d::prelude::{Pose, Real, Rotation};

use picture::Snapshot;
use recorded::Recorded;
use svg::YAW;
use testkit::console::print;
use testkit::numbers::finite;
use testkit::scenes::{HullSource, hulls};

/// Two hulls meet, roll over each other and part again. Draws one frame of it as an SVG picture. With
/// `--pair` it draws a pair that a recorder wrote down.
#[derive(Parser)]
#[command(name = "inspect")]
struct Options {
    /// The frame to draw: first contact is after about a third of the frames
    #[arg(long, default_value_t = 60)]
    frame: u32,

    /// Frames of the whole trajectory; the more, the slower the motion
    #[arg(long, default_value_t = 120, value_parser = value_parser!(u32).range(2..))]
    frames: u32,

    /// What the hulls are
    #[arg(long, value_enum, default_value_t = Kind::Random)]
    shape: Kind,

    /// Vertices of each hull
    #[arg(long, default_value_t = 40, value_parser = value_parser!(u32).range(4..=20_000))]
    vertices: u32,

    /// Seed of the hulls and of their attitudes
    #[arg(long, default_value_t = 1)]
    seed: u64,

    /// Contacts reach this far, in metres; the hulls have a radius of half a metre
    #[arg(long, default_value_t = 0.02, value_parser = finite::<f64>)]
    prediction: f64,

    /// Magnifies the contact, or the gap
    #[arg(long, default_value_t = 1.0, value_parser = at_least_one)]
    zoom: f64,

    /// A recording of pairs, to draw one of them
    #[arg(long, conflicts_with_all = ["frame", "frames", "shape", "vertices", "seed", "prediction"])]
    pair: Option<PathBuf>,

    /// Which pair of the recording, counted from 0
    #[arg(long, default_value_t = 0, requires = "pair")]
    number: usize,

    /// Radians by which the picture of the recorded pair is turned: at 0 the normal points to the right
    #[arg(long, default_value_t = YAW, value_parser = finite::<f64>, requires = "pair")]
    yaw: f64,

    /// Print a test of the recorded pair, and draw nothing
    #[arg(long, requires = "pair")]
    test: bool,

    /// Draw the rules by which contacts are chosen, into this folder
    #[arg(long, conflicts_with = "pair")]
    rules: Option<PathBuf>,

    /// Where to write the picture
    #[arg(long, default_value = "inspect.svg")]
    out: PathBuf,
}

#[derive(Clone, Copy, ValueEnum)]
enum Kind {
    /// Hulls of random points on a sphere
    Random,
    /// Prisms
    Prism,
}

fn main() -> ExitCode {
    match draw(&Options::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn draw(options: &Options) -> Result<(), Box<dyn Error>> {
    if let Some(folder) = &options.rules {
        return rules::draw(folder);
    }
    if let Some(path) = &options.pair {
        let recorded = Recorded::open(path, options.number)?;
        if options.test {
            return Ok(print(&format!("{}\n", recorded.test()))?);
        }
        print(&format!("{}\n", recorded.summary().join("\n")))?;
        return write(&options.out, &recorded.draw(options.yaw, options.zoom));
    }
    if options.frame >= options.frames {
        return Err(format!("the last frame is {}", options.frames - 1).into());
    }
    let mut random = Rand32::new(options.seed);
    let source = match options.shape {
        Kind::Random => HullSource::Random {
            vertices: options.vertices,
        },
        Kind::Prism => HullSource::Prism {
            sides: (options.vertices / 2).max(3),
        },
    };
    let shapes = hulls::make(&source, 2, &mut random)?;
    let shapes = shapes
        .iter()
        .filter_map(|shape| shape.as_convex_polyhedron())
        .map(|polyhedron| HullShape::try_from(polyhedron.clone()))
        .collect::<Result<Vec<_>, _>>()?;
    let [first, second] = [shapes[0].hull(), shapes[1].hull()];
    let attitude = attitude(&mut random);

    let mut memory = PairMemory::None;
    for frame in 0..options.frame {
        let pose = place(attitude, frame, options.frames);
        memory = ask([first, second], &pose, memory, options)?.learned();
    }
    let pose = place(attitude, options.frame, options.frames);
    let snapshot = ask([first, second], &pose, memory, options)?;
    print(&format!("{}\n", snapshot.summary().join("\n")))?;
    write(&options.out, &snapshot.draw(options.zoom))
}

fn write(out: &Path, picture: &str) -> Result<(), Box<dyn Error>> {
    fs::write(out, picture).map_err(|error| format!("cannot write {}: {error}", out.display()))?;
    Ok(print(&format!("drawn to {}\n", out.display()))?)
}

/// What the dispatcher would ask and remember of the pair.
fn ask<'a>(
    hulls: [&'a Hull; 2],
    pose: &Pose,
    memory: PairMemory,
    options: &Options,
) -> Result<Snapshot<'a>, Box<dyn Error>> {
    let pose = RelativePose::new(pose).ok_or("the pose is not finite")?;
    let cso = Cso {
        shape_1: hulls[0],
        shape_2: hulls[1],
        pose: &pose,
    };
    let mut cost = Cost::default();
    let mut scratch = EpaScratch::default();
    let (answer, stage) = Query::new(&cso, options.prediction, &mut scratch, &mut cost)
        .run(&memory)
        .ok_or("the shapes are no solids")?;
    let contacts = match &answer {
        Answer::Separated(_) => Vec::new(),
        Answer::Near(near) => {
            let scratch = &mut ClipScratch::default();
            let contacts = manifold::contacts(&cso, near, options.prediction, scratch);
            contacts.iter().collect()
        }
    };
    Ok(Snapshot {
        hulls,
        pose,
        frame: options.frame,
        memory,
        answer,
        stage,
        cost,
        contacts,
    })
}

fn at_least_one(text: &str) -> Result<f64, String> {
    let number: f64 = finite(text)?;
    (number >= 1.0)
        .then_some(number)
        .ok_or_else(|| "give 1 or more".to_owned())
}

fn attitude(random: &mut Rand32) -> Rotation {
    let mut angle = || PI * (2.0 * random.rand_float() - 1.0);
    Rotation::from_scaled_axis(Vec3::new(angle(), angle(), angle()))
}

/// Where the second hull is in the frame of the first: it comes from the right, rolls over the
/// first by a right angle, and goes.
fn place(attitude: Rotation, frame: u32, frames: u32) -> Pose {
    /// Of the centres, in bounding radii: at the start and the end, and half way.
    const FAR: Real = 2.5;
    const NEAR: Real = 1.88;
    let time = frame as Real / (frames - 1) as Real;
    let swing = 0.5 + 0.5 * (2.0 * PI * time).cos();
    let distance = hulls::RADIUS * (NEAR + (FAR - NEAR) * swing);
    let roll = Rotation::from_rotation_z(FRAC_PI_2 * (time - 0.5));
    Pose::from_parts(roll * Vec3::new(distance, 0.0, 0.0), roll * roll * attitude)
}
