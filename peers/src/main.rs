//! One pair's contact manifold in several engines, in one process and one run, judged by an oracle.

mod cases;
mod chart;
mod engines;
mod judge;

use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;
use std::time::Instant;

use clap::{Parser, value_parser};

use cases::Case;
use engines::Engine;
use judge::{Oracle, Verdict};

/// Times one pair's contact manifold in several engines, and judges their answers
#[derive(Parser)]
#[command(name = "peers")]
struct Options {
    /// How often each engine goes through a trajectory, in turn with the others
    #[arg(long, default_value_t = 51, value_parser = value_parser!(u32).range(1..))]
    turns: u32,

    /// Write the table as comma-separated values, too
    #[arg(long)]
    csv: Option<PathBuf>,

    /// Draw time and error against vertices, as SVG
    #[arg(long)]
    chart: Option<PathBuf>,
}

/// One engine on one trajectory.
struct Row {
    hulls: String,
    gap: &'static str,
    engine: &'static str,
    nanoseconds: f64,
    verdict: Verdict,
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    let mut rows = Vec::new();
    println!("| pair | gap | engine | ns | missing | phantom | gross | error |");
    println!("|---|---|---|---|---|---|---|---|");
    for case in cases::all() {
        for row in measure(&case, options.turns) {
            println!("| {} |", row.cells().join(" | "));
            rows.push(row);
        }
    }
    if let Some(path) = options.csv {
        fs::write(&path, as_csv(&rows))
            .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    }
    if let Some(path) = options.chart {
        chart::draw(&path, &rows)
            .map_err(|error| format!("cannot draw {}: {error}", path.display()))?;
    }
    Ok(())
}

impl Row {
    fn cells(&self) -> [String; 8] {
        let Verdict {
            missing,
            phantom,
            gross,
            worst,
        } = self.verdict;
        [
            self.hulls.clone(),
            self.gap.to_owned(),
            self.engine.to_owned(),
            format!("{:.0}", self.nanoseconds),
            missing.to_string(),
            phantom.to_string(),
            gross.to_string(),
            format!("{worst:.1e}"),
        ]
    }
}

fn as_csv(rows: &[Row]) -> String {
    let mut csv = String::from("pair,gap,engine,ns,missing,phantom,gross,error\n");
    for row in rows {
        let _ = writeln!(csv, "{}", row.cells().join(","));
    }
    csv
}

/// All engines on one trajectory, in turn, so that whatever else the machine does, it does to all.
fn measure(case: &Case, turns: u32) -> Vec<Row> {
    let mut engines = engines::all(case);
    let oracle = Oracle::new(case);
    let verdicts: Vec<_> = engines
        .iter_mut()
        .map(|engine| oracle.judge(case, &mut **engine))
        .collect();
    let mut times = vec![Vec::new(); engines.len()];
    for _ in 0..turns {
        for (engine, times) in engines.iter_mut().zip(&mut times) {
            times.push(time(case, &mut **engine));
        }
    }
    let rows = engines.iter().zip(times).zip(verdicts);
    rows.map(|((engine, times), verdict)| Row {
        hulls: case.hulls.clone(),
        gap: case.gap,
        engine: engine.name(),
        nanoseconds: median(times),
        verdict,
    })
    .collect()
}

fn time(case: &Case, engine: &mut dyn Engine) -> f64 {
    engine.forget();
    let start = Instant::now();
    for pose in &case.poses {
        engine.update(pose);
    }
    start.elapsed().as_nanos() as f64 / case.poses.len() as f64
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
