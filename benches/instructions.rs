//! Instructions per warm manifold update, counted by callgrind: a gate that no noise can hide
//! behind. `cargo bench --bench instructions` compares with `benches/instructions.json` and fails
//! where a count has grown by more than the tolerance; `-- --accept` writes the file anew. Counts
//! depend on the compiler a little, on the machine hardly.
//!
//! Each case runs twice in a process of its own under valgrind, over a short and a long part of
//! its trajectory: the difference is free of the start.

use std::collections::BTreeMap;
use std::process::{Command, ExitCode};

use isa_gjk::IsaGjkDispatcher;
use parry3d::math::Pose;
use parry3d::shape::SharedShape;
use testkit::pair::{FRAMES, GAPS, Manifolds, VERTICES, hull, trajectory, update};

/// What another minor version of the compiler may cost.
const TOLERANCE: f64 = 0.05;
const KNOWN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/instructions.json");
/// Frames of the short run; the long one has them all.
const SHORT: usize = 40;

type Counts = BTreeMap<String, u64>;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [flag, gap, vertices, frames] = &arguments[..]
        && flag == "--run"
    {
        run(parse(gap), parse(vertices), parse(frames));
        return ExitCode::SUCCESS;
    }
    let counts = match count_all() {
        Ok(counts) => counts,
        Err(why) => {
            eprintln!("cannot count instructions: {why}");
            return ExitCode::FAILURE;
        }
    };
    if arguments.iter().any(|a| a == "--accept") {
        let text = serde_json::to_string_pretty(&counts).expect("numbers can be written");
        std::fs::write(KNOWN, text + "\n").expect("the repository can be written to");
    }
    let known = std::fs::read_to_string(KNOWN).unwrap_or_default();
    compare(&counts, &serde_json::from_str(&known).unwrap_or_default())
}

fn parse(number: &str) -> usize {
    number.parse().expect("a number, from count()")
}

/// Updates the manifold of two hulls along their trajectory.
fn run(gap: usize, vertices: usize, frames: usize) {
    let shapes = [hull(vertices, 1), hull(vertices, 2)];
    let dispatcher = IsaGjkDispatcher::default();
    let mut manifolds = Manifolds::new();
    for pose in &trajectory(&shapes, GAPS[gap].1, 1.0)[..frames] {
        measured_update(&dispatcher, &shapes, pose, &mut manifolds);
    }
}

/// Callgrind knows it by this name.
#[inline(never)]
fn measured_update(
    dispatcher: &IsaGjkDispatcher,
    shapes: &[SharedShape; 2],
    pose: &Pose,
    manifolds: &mut Manifolds,
) {
    update(dispatcher, shapes, pose, manifolds);
}

fn count_all() -> Result<Counts, String> {
    let mut counts = Counts::new();
    for (gap, (name, _)) in GAPS.iter().enumerate() {
        for vertices in VERTICES {
            let [short, long] = [SHORT, FRAMES].map(|frames| count(gap, vertices, frames));
            let each = (long? - short?) / (FRAMES - SHORT) as u64;
            counts.insert(format!("{name}/{vertices}"), each);
        }
    }
    Ok(counts)
}

/// The instructions of [`measured_update`] and all that it calls.
fn count(gap: usize, vertices: usize, frames: usize) -> Result<u64, String> {
    let this = std::env::current_exe().map_err(|e| e.to_string())?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg("--toggle-collect=*measured_update*")
        .arg(this)
        .args([
            "--run".to_owned(),
            gap.to_string(),
            vertices.to_string(),
            frames.to_string(),
        ])
        .output()
        .map_err(|e| format!("valgrind: {e}"))?;
    let report = String::from_utf8_lossy(&output.stderr);
    let collected = report
        .lines()
        .find_map(|line| line.split_once("Collected :"));
    let (_, number) = collected.ok_or_else(|| format!("valgrind said:\n{report}"))?;
    number
        .trim()
        .parse()
        .map_err(|_| format!("no number: {number}"))
}

fn compare(counts: &Counts, known: &Counts) -> ExitCode {
    println!("{:16} {:>12} {:>12}", "instructions", "known", "now");
    let mut verdict = ExitCode::SUCCESS;
    for (case, &now) in counts {
        let before = known.get(case).copied().unwrap_or(0);
        let grown = now as f64 > before as f64 * (1.0 + TOLERANCE);
        let mark = if grown { "  more" } else { "" };
        println!("{case:16} {before:12} {now:12}{mark}");
        if grown {
            verdict = ExitCode::FAILURE;
        }
    }
    verdict
}
