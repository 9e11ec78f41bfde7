//! Steps many independent worlds on all cores, as reinforcement learning does: one dispatcher and
//! one set of prepared hulls for all of them. A cluster runs one shard in each of its jobs:
//!
//! ```sh
//! cargo run --release -p fleet -- --worlds 256                     # all of them here
//! cargo run --release -p fleet -- --shard 3/16 --out part-3.jsonl  # the fourth of 16 jobs
//! cargo run --release -p fleet -- merge part-*.jsonl               # one summary of all shards
//! ```

mod record;
mod shard;
mod summary;
mod world;

use std::error::Error;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use clap::{Args, Parser, Subcommand, value_parser};
use indicatif::{ParallelProgressIterator, ProgressBar, ProgressStyle};
use isa_gjk::IsaGjkDispatcher;
use rayon::prelude::*;

use record::Record;
use shard::Shard;
use summary::Summary;
use testkit::console::print;
use world::Bin;

/// Steps many independent worlds of convex parts in bins on all cores
#[derive(Parser)]
#[command(name = "fleet", args_conflicts_with_subcommands = true)]
struct Options {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    run: Run,
}

#[derive(Subcommand)]
enum Command {
    /// Summarises the records of shards; fails if a world is missing or came twice
    Merge {
        /// Files that were written with `--out`
        #[arg(required = true)]
        files: Vec<PathBuf>,
    },
}

#[derive(Args)]
struct Run {
    /// Worlds in all shards together
    #[arg(long, default_value_t = 64, value_parser = value_parser!(u32).range(1..))]
    worlds: u32,

    /// Bodies in each world
    #[arg(long, default_value_t = 24, value_parser = value_parser!(u32).range(1..=1000))]
    bodies: u32,

    /// Steps of each world, sixty of which are a second
    #[arg(long, default_value_t = 240, value_parser = value_parser!(u32).range(1..))]
    steps: u32,

    /// The first world's seed; the others' follow
    #[arg(long, default_value_t = 1)]
    seed: u64,

    /// Which of how many shards to run, counted from zero: 3/16 is the fourth of 16
    #[arg(long, default_value_t = Shard::WHOLE)]
    shard: Shard,

    /// Step with rapier's own narrow phase, to compare
    #[arg(long)]
    default_dispatcher: bool,

    /// Write a line of JSON for each world to this file
    #[arg(long)]
    out: Option<PathBuf>,

    /// Show no progress
    #[arg(long)]
    quiet: bool,
}

fn main() -> ExitCode {
    let Options { command, run } = Options::parse();
    let result = match command {
        Some(Command::Merge { files }) => merge(&files),
        None => run.run(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn merge(files: &[PathBuf]) -> Result<(), Box<dyn Error>> {
    let summary = Summary::of(&record::read_all(files)?)?;
    Ok(print(&format!("{summary}\n"))?)
}

impl Run {
    fn run(&self) -> Result<(), Box<dyn Error>> {
        let dispatcher = (!self.default_dispatcher).then(IsaGjkDispatcher::default);
        let bin = Bin::new(self.bodies, dispatcher)?;
        // Before the run, so that a wrong path does not cost it.
        let create = |path: &PathBuf| {
            File::create(path).map_err(|error| format!("cannot write {}: {error}", path.display()))
        };
        let out = self.out.as_ref().map(create).transpose()?;
        let worlds: Vec<u32> = self.shard.worlds(self.worlds).collect();
        let progress = self.progress(worlds.len());
        let start = Instant::now();
        let records: Vec<Record> = worlds
            .into_par_iter()
            .progress_with(progress)
            .map(|world| self.step(&bin, world))
            .collect();
        let seconds = start.elapsed().as_secs_f64();

        if let Some(file) = out {
            write_all(&records, BufWriter::new(file))?;
        }
        let steps: u64 = records.iter().map(|record| u64::from(record.steps)).sum();
        let told = format!(
            "{} worlds, {:.0} steps per second on {} threads\n",
            records.len(),
            steps as f64 / seconds,
            rayon::current_num_threads()
        );
        Ok(print(&told)?)
    }

    /// One world from its start to its end.
    fn step(&self, bin: &Bin, world: u32) -> Record {
        let start = Instant::now();
        let mut physics = bin.fill(self.seed.wrapping_add(u64::from(world)));
        for _ in 0..self.steps {
            physics.step();
        }
        Record {
            world,
            worlds: self.worlds,
            seed: self.seed,
            steps: self.steps,
            seconds: start.elapsed().as_secs_f64(),
            asleep: world::asleep(&physics),
            bodies: self.bodies,
            lost: world::outside(&physics),
        }
    }

    fn progress(&self, worlds: usize) -> ProgressBar {
        if self.quiet {
            return ProgressBar::hidden();
        }
        let style = ProgressStyle::with_template("{bar:40} {pos}/{len} worlds, {eta} left");
        ProgressBar::new(worlds as u64).with_style(style.expect("a template of indicatif's"))
    }
}

fn write_all(records: &[Record], mut out: impl Write) -> io::Result<()> {
    for record in records {
        serde_json::to_writer(&mut out, record)?;
        out.write_all(b"\n")?;
    }
    out.flush()
}
