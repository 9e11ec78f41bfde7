//! Records a scene of `compare` to one HTML file that plays in a browser:
//! `cargo run --release -p replay -- --scene stack --out replay.html`. With `--film` it writes
//! scenes side by side, with either narrow phase, as one animated picture.

mod film;
mod mesh;
mod pair;
mod tape;
mod view;

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, ValueEnum, value_parser};
use isa_gjk::IsaGjkDispatcher;
use serde_json::json;

use film::Reel;
use tape::Tape;
use testkit::console::print;
use testkit::numbers::positive;
use testkit::scenes::{self, HullSource, Hulls, Scene, SceneParams, World};

/// The page, with gaps for the header and the tape.
const PLAYER: &str = include_str!("player.html");
const HEADER: &str = "\"HEADER\"";
const TAPE: &str = "\"TAPE\"";

/// Records a scene to one HTML file that plays in a browser, without a network.
#[derive(Parser)]
#[command(name = "replay")]
struct Options {
    /// What is in the world, as for `compare`; `--film` takes several, with commas between them
    #[arg(long, value_delimiter = ',', default_values_t = [Scene::Drum])]
    scene: Vec<Scene>,

    /// Whose narrow phase it runs with
    #[arg(long, value_enum, default_value_t = Dispatcher::Ours)]
    dispatcher: Dispatcher,

    /// Dynamic bodies [default: 128 to 1000, by scene]
    #[arg(long, value_parser = value_parser!(u32).range(1..=10_000))]
    bodies: Option<u32>,

    /// The largest extent of the largest body in metres, in scenes of small bodies [default: 5 to 40 cm, by scene]
    #[arg(long, value_parser = positive::<f32>)]
    size: Option<f32>,

    /// Vertices of a hull
    #[arg(long, default_value_t = 100, value_parser = value_parser!(u32).range(4..=2000))]
    vertices: u32,

    /// Hulls of real objects, where the scene takes any
    #[arg(long, conflicts_with = "vertices")]
    real: bool,

    /// Seconds to record
    #[arg(long, default_value_t = 10.0, value_parser = positive::<f64>)]
    seconds: f64,

    /// Steps from one recorded frame to the next; the player moves evenly between them
    #[arg(long, default_value_t = 2, value_parser = value_parser!(u32).range(1..=60))]
    every: u32,

    /// Seed of shapes and starting poses
    #[arg(long, default_value_t = 1)]
    seed: u64,

    /// A recording of pairs, to see what becomes of one: its first shape is fixed, the second one free,
    /// without gravity
    #[arg(long, conflicts_with_all = ["scene", "bodies", "size", "vertices", "real", "film"])]
    pair: Option<PathBuf>,

    /// Which pair of the recording, counted from 0
    #[arg(long, default_value_t = 0, requires = "pair")]
    number: usize,

    /// Where to write the page
    #[arg(long, default_value = "replay.html")]
    out: PathBuf,

    /// Write the scenes side by side, above with rapier's narrow phase and below with this crate's, to
    /// this animated SVG picture instead. What sleeps is grey
    #[arg(long, conflicts_with_all = ["dispatcher", "out"])]
    film: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Dispatcher {
    /// This crate's
    Ours,
    /// Rapier's own
    Default,
}

impl Options {
    fn params(&self, scene: Scene) -> SceneParams {
        let hulls = match scene.hulls() {
            Hulls::Any | Hulls::Upright if self.real => HullSource::Real,
            Hulls::Any | Hulls::None => HullSource::Random {
                vertices: self.vertices,
            },
            Hulls::Boxes => HullSource::Box,
            Hulls::Own => HullSource::Own,
            Hulls::Prisms | Hulls::Upright => HullSource::Prism {
                sides: (self.vertices / 2).max(3),
            },
        };
        let bodies = self.bodies.unwrap_or(scene.default_bodies());
        SceneParams {
            size: scene.default_size().map(|size| self.size.unwrap_or(size)),
            seed: self.seed,
            ..SceneParams::new(hulls, bodies)
        }
    }

    /// Steps the world, and calls back at first and after every `every` steps. Returns the seconds in
    /// between.
    fn run(&self, world: &mut World, mut record: impl FnMut(&World)) -> f64 {
        let step = f64::from(world.physics.integration_parameters.dt);
        let seconds_per_frame = step * f64::from(self.every);
        record(world);
        for _ in 0..(self.seconds / seconds_per_frame) as usize {
            (0..self.every).for_each(|_| world.step());
            record(world);
        }
        seconds_per_frame
    }

    /// The only scene of a page.
    fn one_scene(&self) -> Result<Scene, &'static str> {
        match self.scene[..] {
            [scene] => Ok(scene),
            _ => Err("a page shows one scene: only --film takes several"),
        }
    }

    fn title(&self, scene: Scene, params: &SceneParams) -> String {
        let what = match scene.hulls() {
            Hulls::None => String::new(),
            _ => format!(", {}", params.hulls),
        };
        let dispatcher = match self.dispatcher {
            Dispatcher::Ours => "isa-gjk",
            Dispatcher::Default => "rapier's default",
        };
        if let Some(path) = &self.pair {
            return format!("pair {} of {}, {dispatcher}", self.number, path.display());
        }
        format!("{scene}: {} bodies{what}, {dispatcher}", params.bodies)
    }
}

fn main() -> ExitCode {
    let options = Options::parse();
    let written = match &options.film {
        Some(out) => write_film(&options, out),
        None => write_page(&options),
    };
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn write_page(options: &Options) -> Result<(), Box<dyn Error>> {
    let scene = options.one_scene()?;
    let params = options.params(scene);
    let dispatcher = match options.dispatcher {
        Dispatcher::Ours => Some(IsaGjkDispatcher::default()),
        Dispatcher::Default => None,
    };
    let mut world = match &options.pair {
        Some(path) => pair::world(path, options.number, dispatcher)?,
        None => scenes::build(scene, &params, dispatcher)?,
    };
    let mut tape = Tape::new(&world);
    let seconds_per_frame = options.run(&mut world, |world| tape.record(world));

    let header = json!({
        "title": options.title(scene, &params),
        "framesPerSecond": seconds_per_frame.recip(),
        "tape": tape.header(),
    });
    // No text in it can end the script that it stands in.
    let header = header.to_string().replace('<', "\\u003c");
    let page =
        PLAYER
            .replacen(HEADER, &header, 1)
            .replacen(TAPE, &format!("\"{}\"", tape.encode()?), 1);
    write(&options.out, &page)?;
    Ok(print(&format!("{} frames\n", tape.len()))?)
}

fn write_film(options: &Options, out: &Path) -> Result<(), Box<dyn Error>> {
    let both = [
        ("rapier's default", None),
        ("isa-gjk", Some(IsaGjkDispatcher::default())),
    ];
    let mut rows = Vec::new();
    for (name, dispatcher) in both {
        let mut row = Vec::new();
        for &scene in &options.scene {
            let mut world = scenes::build(scene, &options.params(scene), dispatcher.clone())?;
            let mut reel = Reel::new(format!("{scene}: {name}"), &world);
            options.run(&mut world, |world| reel.record(world));
            row.push(reel);
        }
        rows.push(row);
    }
    write(out, &film::picture(&rows, options.seconds))
}

fn write(out: &Path, text: &str) -> Result<(), Box<dyn Error>> {
    fs::write(out, text).map_err(|error| format!("cannot write {}: {error}", out.display()))?;
    let megabytes = text.len() as f64 / 1e6;
    Ok(print(&format!("{megabytes:.2} MB in {}\n", out.display()))?)
}
