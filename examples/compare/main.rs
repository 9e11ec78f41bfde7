//! Steps two equal rapier worlds in turn, one with rapier's own narrow phase and one with
//! `isa-gjk`, and tells what each cost: `cargo run --release --example compare -- --help`.

mod files;
mod measure;
mod options;
mod quality;
mod report;
mod scenes;

use std::error::Error;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};

use options::Options;
use report::Report;

fn main() -> ExitCode {
    match run(&Options::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let params = options.scene_params()?;
    let length = options.run_length();
    let progress = progress_bar(options, length.steps());
    // Before the run, so that a wrong path does not cost it.
    let json = files::create(options.json.as_deref())?;
    let csv = files::create(options.csv.as_deref())?;
    let mut runs = Vec::new();
    for _ in 0..options.repeat {
        runs.push(measure::run(options.scene, &params, length, &progress)?);
    }
    progress.finish_and_clear();

    let report = Report::new(options.scene, &params, length, &runs);
    if let Some(file) = json {
        files::write_json(file, &report)?;
    }
    if let Some(file) = csv {
        files::write_csv(file, &runs)?;
    }
    match write!(io::stdout().lock(), "{report}") {
        // Whoever reads us has seen enough, as `head` does.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => Ok(result?),
    }
}

fn progress_bar(options: &Options, steps_per_run: u64) -> ProgressBar {
    if options.quiet {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(steps_per_run * u64::from(options.repeat));
    match ProgressStyle::with_template("{wide_bar} {pos}/{len} steps, {eta} left") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}
