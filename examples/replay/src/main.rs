//! Records a scene of `compare` to one HTML file that plays in a browser:
//! `cargo run --release -p replay -- --scene stack --out replay.html`.

mod mesh;
mod tape;

use std::error::Error;
use std::fs;
use std::path::PathBuf;

use clap::{Parser, ValueEnum, value_parser};
use isa_gjk::IsaGjkDispatcher;
use serde_json::json;

use tape::Tape;
use testkit::scenes::{self, HullSource, Hulls, Scene, SceneParams};

/// The page, with gaps for the header and the tape.
const PLAYER: &str = include_str!("player.html");
const HEADER: &str = "\"HEADER\"";
const TAPE: &str = "\"TAPE\"";

/// Records a scene to one HTML file that plays in a browser, without a network.
#[derive(Parser)]
#[command(name = "replay")]
struct Options {
    /// What is in the world, as for `compare`
    #[arg(long, default_value_t = Scene::Drum)]
    scene: Scene,

    /// Whose narrow phase it runs with
    #[arg(long, value_enum, default_value_t = Dispatcher::Ours)]
    dispatcher: Dispatcher,

    /// Dynamic bodies [default: 128 to 1000, by scene]
    #[arg(long, value_parser = value_parser!(u32).range(1..=10_000))]
    bodies: Option<u32>,

    /// Vertices of a hull
    #[arg(long, default_value_t = 100, value_parser = value_parser!(u32).range(4..=2000))]
    vertices: u32,

    /// Hulls of real objects, where the scene takes any
    #[arg(long, conflicts_with = "vertices")]
    real: bool,

    /// Seconds to record
    #[arg(long, default_value_t = 10.0)]
    seconds: f64,

    /// Steps from one recorded frame to the next; the player moves evenly between them
    #[arg(long, default_value_t = 2, value_parser = value_parser!(u32).range(1..=60))]
    every: u32,

    /// Seed of shapes and starting poses
    #[arg(long, default_value_t = 1)]
    seed: u64,

    /// Where to write the page
    #[arg(long, default_value = "replay.html")]
    out: PathBuf,
}

#[derive(Clone, Copy, ValueEnum)]
enum Dispatcher {
    /// This crate's
    Ours,
    /// Rapier's own
    Default,
}

impl Options {
    fn params(&self) -> SceneParams {
        let hulls = match self.scene.hulls() {
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
        let bodies = self.bodies.unwrap_or(self.scene.default_bodies());
        SceneParams {
            seed: self.seed,
            ..SceneParams::new(hulls, bodies)
        }
    }

    fn title(&self, params: &SceneParams) -> String {
        let what = match self.scene.hulls() {
            Hulls::None => String::new(),
            _ => format!(", {}", params.hulls),
        };
        let dispatcher = match self.dispatcher {
            Dispatcher::Ours => "isa-gjk",
            Dispatcher::Default => "rapier's default",
        };
        let Self { scene, .. } = self;
        format!("{scene}: {} bodies{what}, {dispatcher}", params.bodies)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    let params = options.params();
    let dispatcher = match options.dispatcher {
        Dispatcher::Ours => Some(IsaGjkDispatcher::default()),
        Dispatcher::Default => None,
    };
    let mut world = scenes::build(options.scene, &params, dispatcher)?;
    let step = f64::from(world.physics.integration_parameters.dt);
    let seconds_per_frame = step * f64::from(options.every);
    let mut tape = Tape::new(&world);
    tape.record(&world);
    for _ in 0..(options.seconds / seconds_per_frame) as usize {
        (0..options.every).for_each(|_| world.step());
        tape.record(&world);
    }

    let header = json!({
        "title": options.title(&params),
        "framesPerSecond": seconds_per_frame.recip(),
        "tape": tape.header(),
    });
    // No text in it can end the script that it stands in.
    let header = header.to_string().replace('<', "\\u003c");
    let page =
        PLAYER
            .replacen(HEADER, &header, 1)
            .replacen(TAPE, &format!("\"{}\"", tape.encode()?), 1);
    fs::write(&options.out, &page)
        .map_err(|error| format!("cannot write {}: {error}", options.out.display()))?;
    println!(
        "{} frames, {:.1} MB, in {}",
        tape.len(),
        page.len() as f64 / 1e6,
        options.out.display()
    );
    Ok(())
}
