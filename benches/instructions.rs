//! Instructions per warm manifold update, counted by callgrind: a gate that no noise can hide behind.
//! `cargo bench --bench instructions` compares with `benches/instructions.json` and fails where a count has
//! grown by more than the tolerance; `-- --accept` rewrites the file. Counts depend on the compiler a little,
//! on the machine hardly.
//!
//! Each case runs twice in a process of its own under valgrind, over a short and a long part of
//! its frames: the difference is free of the start.
//!
//! - `separated`, `touching`, `shallow` (1 % deep), `deep` (20 %): two hulls of so many random vertices
//!   on a trajectory.
//! - `boxes`, `prisms` (of twelve sides): the same of two of them; touching (1), shallow (2), deep (3).
//! - `resting`: a prism of so many vertices on another one, trembling by thousandths of a millimetre; `shaken`, by
//!   fiftieths.
//! - `new`: in each frame another hull of so many vertices meets one that is known.
//! - `compound`: a hull of eight vertices slides over a compound of so many boxes as hulls.
//! - `cuboid-cylinder`, `cylinder-cylinder`: 5 mm apart (0), 50 mm deep (1), both on a trajectory; at rest (2).

use std::collections::BTreeMap;
use std::process::{Command, ExitCode};

use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Rotation, Vector};
use parry3d::shape::SharedShape;
use testkit::pair::{
    FRAMES, GAPS, Manifolds, REST, SHAKEN, hull, resting, trajectory, trembling, update,
};
use testkit::scenes::hulls;

/// What another minor version of the compiler may cost.
const TOLERANCE: f64 = 0.05;
const KNOWN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/instructions.json");
/// Frames of the short run; the long one has them all.
const SHORT: usize = 40;

/// The cases, and their numbers of vertices or parts.
const CASES: [(&str, &[usize]); 12] = [
    ("separated", &VERTICES),
    ("touching", &VERTICES),
    ("shallow", &VERTICES),
    ("deep", &VERTICES),
    ("boxes", &[1, 2, 3]),
    ("prisms", &[1, 2, 3]),
    ("resting", &[8, 16, 32, 64]),
    ("shaken", &[8, 64]),
    ("new", &[12, 60]),
    ("compound", &[9, 64]),
    ("cuboid-cylinder", &[0, 1, 2]),
    ("cylinder-cylinder", &[0, 1, 2]),
];
const VERTICES: [usize; 7] = [8, 10, 16, 32, 100, 300, 1000];

type Counts = BTreeMap<String, u64>;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [flag, case, size, frames] = &arguments[..]
        && flag == "--run"
    {
        run(case, parse(size), parse(frames));
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

/// Updates manifolds of a pair in each of so many frames. Hulls put some work off until a pair needs it: unless hulls
/// are new, all of it is done before.
fn run(case: &str, size: usize, frames: usize) {
    let dispatcher = IsaGjkDispatcher::default();
    let pairs = pairs(case, size);
    if case != "new" {
        let mut manifolds = Manifolds::default();
        for (shapes, pose) in &pairs {
            update(&dispatcher, shapes, pose, &mut manifolds);
        }
    }
    let mut manifolds = Manifolds::default();
    for (shapes, pose) in &pairs[..frames] {
        if case == "new" {
            manifolds.list.clear();
        }
        measured_update(&dispatcher, shapes, pose, &mut manifolds);
    }
}

/// The shapes of each frame, and where the second one is.
fn pairs(case: &str, size: usize) -> Vec<([SharedShape; 2], Pose)> {
    let along = |shapes: [SharedShape; 2], poses: Vec<Pose>| {
        let with_shapes = |pose| (shapes.clone(), pose);
        poses.into_iter().map(with_shapes).collect()
    };
    match case {
        "resting" | "shaken" => {
            let tremble = if case == "resting" { REST } else { SHAKEN };
            let (shapes, poses) = resting(size as u32 / 2, tremble);
            along(shapes, poses)
        }
        "new" => {
            let known = hull(size, 1);
            let pose = Pose::translation(1.2, 0.9, 0.0);
            let pair = |frame| ([known.clone(), hull(size, 2 + frame as u128)], pose);
            (0..FRAMES).map(pair).collect()
        }
        "compound" => {
            let half = Vector::new(0.5, 0.2, 0.5);
            let tile = hulls::cuboid(half).expect("a box");
            let side = size.isqrt();
            let part = |i: usize| {
                let place = Vector::new((i % side) as f32, 0.0, (i / side) as f32);
                (Pose::from_parts(place, Rotation::IDENTITY), tile.clone())
            };
            let tiles = SharedShape::compound((0..size).map(part).collect());
            let small = hulls::cuboid(Vector::splat(0.3)).expect("a box");
            let sliding = |frame: usize| {
                let x = 0.2 + (side as f32 - 1.4) * frame as f32 / FRAMES as f32;
                Pose::translation(x, 0.495, 0.4)
            };
            along([tiles, small], (0..FRAMES).map(sliding).collect())
        }
        "boxes" => {
            let halves = [Vector::new(0.6, 0.5, 0.7), Vector::new(0.8, 0.4, 0.5)];
            let shapes = halves.map(|half| hulls::cuboid(half).expect("a box"));
            let poses = trajectory(&shapes, GAPS[size].1, 1.0);
            along(shapes, poses)
        }
        "prisms" => {
            let heights = [0.5, 0.7];
            let shapes = heights.map(|half| hulls::prism(12, 1.0, half).expect("a prism"));
            let poses = trajectory(&shapes, GAPS[size].1, 1.0);
            along(shapes, poses)
        }
        "cuboid-cylinder" | "cylinder-cylinder" => {
            let cylinder = SharedShape::cylinder(0.5, 0.4);
            let partner = if case == "cuboid-cylinder" {
                SharedShape::cuboid(0.4, 0.5, 0.6)
            } else {
                cylinder.clone()
            };
            let shapes = [partner, cylinder];
            let poses = match size {
                0 => trajectory(&shapes, 0.005, 1.0),
                1 => trajectory(&shapes, -0.05, 1.0),
                // Both are a metre high: it stands 1 mm deep.
                _ => trembling(0.999, REST),
            };
            along(shapes, poses)
        }
        _ => {
            let gap = GAPS.iter().find(|(name, _)| *name == case);
            let (_, gap) = gap.expect("a case");
            let shapes = [hull(size, 1), hull(size, 2)];
            let poses = trajectory(&shapes, *gap, 1.0);
            along(shapes, poses)
        }
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
    for (case, sizes) in CASES {
        for &size in sizes {
            let [short, long] = [SHORT, FRAMES].map(|frames| count(case, size, frames));
            let each = (long? - short?) / (FRAMES - SHORT) as u64;
            counts.insert(format!("{case}/{size}"), each);
        }
    }
    Ok(counts)
}

/// The instructions of [`measured_update`] and all that it calls.
fn count(case: &str, size: usize, frames: usize) -> Result<u64, String> {
    let this = std::env::current_exe().map_err(|e| e.to_string())?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg("--toggle-collect=*measured_update*")
        .arg(this)
        .args([
            "--run".to_owned(),
            case.to_owned(),
            size.to_string(),
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
