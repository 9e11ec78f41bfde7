//! One pair's contact manifold in several engines, in one process and one run, judged by an oracle.

mod cases;
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
}

/// One engine on one trajectory.
struct Row {
    case: String,
    engine: &'static str,
    nanoseconds: f64,
    verdict: Verdict,
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    println!("| pair | engine | ns | missing | phantom | gross | error |");
    println!("|---|---|---|---|---|---|---|");
    let mut csv = String::from("pair,engine,ns,missing,phantom,gross,error\n");
    for case in cases::all() {
        for row in measure(&case, options.turns) {
            let Row {
                case,
                engine,
                nanoseconds,
                verdict: v,
            } = row;
            println!(
                "| {case} | {engine} | {nanoseconds:.0} | {} | {} | {} | {:.1e} |",
                v.missing, v.phantom, v.gross, v.worst
            );
            let _ = writeln!(
                csv,
                "{case},{engine},{nanoseconds:.0},{},{},{},{:.3e}",
                v.missing, v.phantom, v.gross, v.worst
            );
        }
    }
    if let Some(path) = options.csv {
        fs::write(&path, csv)
            .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    }
    Ok(())
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
        case: case.name.clone(),
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
