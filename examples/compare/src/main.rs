//! Steps two equal rapier worlds in turn, one with rapier's own narrow phase and one with `isa-gjk`, and
//! reports the cost of each: `cargo run --release -p compare -- --help`.

mod chart;
mod curved;
mod files;
mod measure;
mod options;
mod report;
mod rest;
mod sweep;
mod verify;

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;

use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use isa_gjk::IsaGjkDispatcher;
use isa_gjk::recording::{Recorder, RecorderSummary};

use curved::Curved;
use options::Options;
use report::Report;
use rest::Rest;
use sweep::Sweep;
use testkit::console::print;

fn main() -> ExitCode {
    let options = Options::parse();
    let outcome = match options.sweep {
        _ if options.curved.is_some() => curved(&options),
        None if options.until_asleep => until_asleep(&options),
        None => compare(&options),
        Some(options::Sweep::Vertices) => sweep(&options),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn compare(options: &Options) -> Result<(), Box<dyn Error>> {
    let params = options.scene_params(options.vertices)?;
    let length = options.run_length();
    // Before the run, so that a wrong path does not cost it.
    let outputs = Outputs::create(options)?;
    let recorder = recorder(options)?;
    let dispatcher = match &recorder {
        Some(recorder) => IsaGjkDispatcher::default().with_recorder(recorder.clone()),
        None => IsaGjkDispatcher::default(),
    };
    let progress = progress_bar(options, length.steps() * u64::from(options.repeat));
    let runs = (0..options.repeat)
        .map(|_| measure::run(options.scene, &params, &dispatcher, length, &progress))
        .collect::<Result<Vec<_>, _>>()?;
    progress.finish_and_clear();

    let report = Report::new(options.scene, &params, length, &runs);
    if let Some(file) = outputs.json {
        files::write_json(file, &report)?;
    }
    if let Some(file) = outputs.csv {
        files::write_csv(file, &runs)?;
    }
    if let Some(path) = &options.chart {
        chart::frames(path, &report.title(), &runs)?;
    }
    print(&report)?;
    if let Some(recorder) = recorder {
        print_summary(&recorder.summary())?;
    }
    match report.failed_check() {
        true => Err("a manifold is off by more than the limit: see the table".into()),
        false => Ok(()),
    }
}

fn recorder(options: &Options) -> Result<Option<Arc<Recorder>>, String> {
    let create = |path: &PathBuf| match Recorder::create(path) {
        Ok(recorder) => Ok(Arc::new(recorder)),
        Err(error) => Err(format!("cannot write {}: {error}", path.display())),
    };
    options.record.as_ref().map(create).transpose()
}

fn print_summary(summary: &RecorderSummary) -> Result<(), Box<dyn Error>> {
    let wrong = summary.recorded + summary.repeated;
    print(&format!("{wrong} of {} updates look wrong\n", summary.seen))?;
    if summary.is_full {
        print(&"the recording is full: the updates after these were not checked\n")?;
    }
    match summary.error {
        Some(error) => Err(format!("the recording ended too soon: {error}").into()),
        None => Ok(()),
    }
}

fn sweep(options: &Options) -> Result<(), Box<dyn Error>> {
    let outputs = Outputs::create(options)?;
    let progress = progress_bar(options, Sweep::steps(options));
    let sweep = Sweep::run(options, &progress)?;
    progress.finish_and_clear();

    if let Some(file) = outputs.json {
        files::write_json(file, &sweep)?;
    }
    if let Some(file) = outputs.csv {
        sweep.write_csv(file)?;
    }
    if let Some(path) = &options.chart {
        chart::sweep(path, &sweep)?;
    }
    Ok(print(&sweep)?)
}

fn until_asleep(options: &Options) -> Result<(), Box<dyn Error>> {
    let outputs = Outputs::create(options)?;
    let frames = options.frames_until_asleep();
    let steps = 2 * frames as u64 * u64::from(options.seeds);
    let progress = progress_bar(options, steps);
    let params = options.scene_params(options.vertices)?;
    let rest = Rest::run(options.scene, &params, options.seeds, frames, &progress)?;
    progress.finish_and_clear();

    if let Some(file) = outputs.json {
        files::write_json(file, &rest)?;
    }
    if let Some(file) = outputs.csv {
        rest.write_csv(file)?;
    }
    if let Some(path) = &options.chart {
        chart::awake(path, &rest)?;
    }
    Ok(print(&rest)?)
}

fn curved(options: &Options) -> Result<(), Box<dyn Error>> {
    let scenes = options.curved_scenes()?;
    let outputs = Outputs::create(options)?;
    let steps: usize = scenes.iter().map(|scene| 2 * scene.steps()).sum();
    let progress = progress_bar(options, steps as u64 * u64::from(options.seeds));
    let figures = Curved::run(&scenes, options.seed, options.seeds, &progress);
    progress.finish_and_clear();

    if let Some(file) = outputs.json {
        files::write_json(file, &figures)?;
    }
    Ok(print(&figures)?)
}

/// The requested files.
struct Outputs {
    json: Option<BufWriter<File>>,
    csv: Option<BufWriter<File>>,
}

impl Outputs {
    fn create(options: &Options) -> Result<Self, String> {
        // The chart is written by its name; this proves that it can be.
        files::create(options.chart.as_deref())?;
        Ok(Self {
            json: files::create(options.json.as_deref())?,
            csv: files::create(options.csv.as_deref())?,
        })
    }
}

fn progress_bar(options: &Options, steps: u64) -> ProgressBar {
    if options.quiet {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(steps);
    match ProgressStyle::with_template("{wide_bar} {pos}/{len} steps, {eta} left") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}
