//! How the work grows with the number of vertices; prints the tables of `docs/complexity.md`.

mod families;
mod observed;

use std::hint::black_box;
use std::time::Instant;

use families::{Cloud, direction, orbit, sphere};
use glam::{DQuat, DVec3};
use isa_gjk::Hull;
use isa_gjk::internals::epa::{EpaScratch, PolytopeCache};
use isa_gjk::internals::pose::RelativePose;
use isa_gjk::internals::primitive::Ball;
use isa_gjk::internals::query::{PairMemory, Query};
use isa_gjk::internals::stats::Cost;
use isa_gjk::internals::support::{Cso, Support};
use observed::{Direction, Observation, run};
use oorandom::Rand64;
use parry3d::math::Pose;

const SIZES: [usize; 11] = [8, 16, 32, 64, 128, 256, 512, 1024, 2048, 5000, 10_000];
const FRAMES: usize = 2000;
/// The machine is shared: the best of a few measurements is the least disturbed.
const REPEATS: usize = 5;
/// Around the cluster of the death polytope.
const POINTS: usize = 20_000;

fn main() {
    queries("Apart by 30 cm, asked about 2 cm", 1.3, 0.02);
    queries(
        "Near: apart by 5 cm, asked for the distance",
        1.05,
        f64::INFINITY,
    );
    queries("Overlapping by 5 cm", 0.95, f64::INFINITY);
    by_scan();
    variants();
    death();
}

/// What one regime costs, cold and coherent, on average per query.
fn queries(title: &str, distance: f64, max_distance: f64) {
    println!("\n### {title}\n");
    println!(
        "| vertices | cold: iterations | supports | moves | µs | coherent: iterations | supports | moves | µs |"
    );
    println!("|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for size in SIZES {
        let hulls = [sphere(size, 1), sphere(size, 2)];
        let poses = orbit(FRAMES, distance);
        let cold = measure(&hulls, &poses, max_distance, false);
        let coherent = measure(&hulls, &poses, max_distance, true);
        println!("| {size} | {cold} | {coherent} |");
    }
}

/// Averages, as cells of a table.
fn measure(hulls: &[Hull; 2], poses: &[Pose], max_distance: f64, coherent: bool) -> String {
    let poses: Vec<_> = poses.iter().filter_map(RelativePose::new).collect();
    let mut scratch = EpaScratch::default();
    let mut best = f64::INFINITY;
    let mut total = [0_u64; 3];
    for _ in 0..REPEATS {
        total = [0; 3];
        let mut memory = PairMemory::None;
        let mut cache = PolytopeCache::default();
        let clock = Instant::now();
        for pose in &poses {
            let mut cost = Cost::default();
            let answer = Query {
                cso: &Cso {
                    shape_1: &hulls[0],
                    shape_2: &hulls[1],
                    pose,
                },
                max_distance,
                polytope_cache: coherent.then_some((&mut cache, 0)),
                scratch: &mut scratch,
                cost: &mut cost,
            }
            .run(if coherent { &memory } else { &PairMemory::None });
            let counts = [cost.iterations, cost.supports, cost.climb_moves];
            for (sum, count) in total.iter_mut().zip(counts) {
                *sum += u64::from(count);
            }
            memory = black_box(answer).expect("spheres have volume").0.memory();
        }
        best = best.min(clock.elapsed().as_secs_f64());
    }
    let count = poses.len() as f64;
    let [iterations, supports, moves] = total.map(|sum| sum as f64 / count);
    let time = best * 1.0e6 / count;
    format!("{iterations:.2} | {supports:.2} | {moves:.2} | {time:.2}")
}

/// Microseconds of each call of `work`, the best of a few rounds.
fn time(poses: &[RelativePose], mut work: impl FnMut(&RelativePose) -> Observation) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..REPEATS {
        let clock = Instant::now();
        for pose in poses {
            black_box(work(pose));
        }
        best = best.min(clock.elapsed().as_secs_f64());
    }
    best * 1.0e6 / poses.len() as f64
}

/// The same loop with the hull's own supports and with a plain scan.
fn by_scan() {
    println!("\n### Supports by the hull and by a plain scan: cold distance\n");
    println!("| vertices | hull µs | scanning µs |");
    println!("|---:|---:|---:|");
    for size in SIZES {
        let hulls = [sphere(size, 1), sphere(size, 2)];
        let clouds = hulls.each_ref().map(Cloud::of);
        let poses: Vec<_> = orbit(200, 1.05)
            .iter()
            .filter_map(RelativePose::new)
            .collect();
        let searching = time(&poses, |pose| {
            between::<false, _, _>((&hulls[0], &hulls[1]), pose, Direction::Gilbert)
        });
        let scanning = time(&poses, |pose| {
            between::<false, _, _>((&clouds[0], &clouds[1]), pose, Direction::Gilbert)
        });
        println!("| {size} | {searching:.2} | {scanning:.2} |");
    }
}

/// Both hulls' GJK at one pose.
fn between<const WATCH: bool, A: Support, B: Support>(
    shapes: (&A, &B),
    pose: &RelativePose,
    direction: Direction,
) -> Observation {
    let cso = Cso {
        shape_1: shapes.0,
        shape_2: shapes.1,
        pose,
    };
    let along = (-cso.center()).normalize_or(DVec3::X);
    let start = cso.support(along, cso.start_vertices(along), &mut Cost::default());
    run::<WATCH, _, _>(&cso, start, direction)
}

/// Unrelated poses of two hulls, from almost touching to far apart.
fn strewn(count: usize) -> Vec<RelativePose> {
    let mut random = Rand64::new(2022);
    let mut pose = || {
        let gap = 10_f64.powf(4.0 * random.rand_float() - 4.0);
        let at = direction(&mut random) * (1.0 + gap);
        let turn = DQuat::from_axis_angle(direction(&mut random), 3.0 * random.rand_float());
        RelativePose::new(&Pose::from_parts(at.as_vec3(), turn.as_quat()))
    };
    (0..count).filter_map(|_| pose()).collect()
}

/// Gilbert's direction against Nesterov's, and whether a dropped vertex comes back.
fn variants() {
    println!("\n### Directions, and vertices that return\n");
    println!("Unrelated poses; gaps from 0.1 mm to 1 m.\n");
    println!(
        "| vertices | Gilbert: iterations | most | µs | returned / supports | Nesterov: iterations | most | µs | returned / supports |"
    );
    println!("|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for size in SIZES {
        let hulls = [sphere(size, 1), sphere(size, 2)];
        let poses = strewn(FRAMES);
        let cells = [Direction::Gilbert, Direction::Nesterov].map(|direction| {
            let pair = (&hulls[0], &hulls[1]);
            let time = time(&poses, |pose| between::<false, _, _>(pair, pose, direction));
            let seen: Vec<_> = poses
                .iter()
                .map(|pose| between::<true, _, _>(pair, pose, direction))
                .collect();
            assert!(seen.iter().all(|s| !s.unfinished), "a run did not end");
            let sum: u32 = seen.iter().map(|s| s.iterations).sum();
            let most = seen.iter().map(|s| s.iterations).max().unwrap_or(0);
            let returned: u32 = seen.iter().map(|s| s.returned).sum();
            let mean = f64::from(sum) / seen.len() as f64;
            format!("{mean:.2} | {most} | {time:.2} | {returned} / {sum}")
        });
        println!("| {size} | {} |", cells.join(" | "));
    }
}

/// A point around the cluster of the death polytope, at every scale.
fn death() {
    println!("\n### Death polytope against a point, near its cluster at every scale\n");
    println!(
        "{POINTS} points around the apex of a paraboloid on which each vertex is half as far from the\napex as the one before; distances from 1e-12 to 1.\n"
    );
    println!(
        "| vertices | Gilbert: iterations | most | returned | Nesterov: iterations | most | returned |"
    );
    println!("|---:|---:|---:|---:|---:|---:|---:|");
    for size in [4, 6, 8, 12, 16, 20, 24, 32, 48] {
        let cloud = Cloud::death(size);
        let cells = [Direction::Gilbert, Direction::Nesterov].map(|direction| {
            let seen: Vec<_> = around_the_cluster()
                .iter()
                .map(|pose| {
                    let cso = Cso {
                        shape_1: &cloud,
                        shape_2: &Ball::new(0.0),
                        pose,
                    };
                    // From the vertex farthest from the cluster: the way leads past all others.
                    let start = cso.support(DVec3::X, Default::default(), &mut Cost::default());
                    run::<true, _, _>(&cso, start, direction)
                })
                .collect();
            let unfinished = seen.iter().filter(|s| s.unfinished).count();
            assert_eq!(unfinished, 0, "runs did not end");
            let sum: u32 = seen.iter().map(|s| s.iterations).sum();
            let most = seen.iter().map(|s| s.iterations).max().unwrap_or(0);
            let returned: u32 = seen.iter().map(|s| s.returned).sum();
            format!(
                "{:.2} | {most} | {returned}",
                f64::from(sum) / seen.len() as f64
            )
        });
        println!("| {size} | {} |", cells.join(" | "));
    }
}

/// Points below the paraboloid's apex and beside it, their distances spread over the decades.
fn around_the_cluster() -> Vec<RelativePose> {
    let mut random = Rand64::new(1988);
    let mut scale = || 10_f64.powf(-12.0 * random.rand_float());
    let mut places = Vec::with_capacity(POINTS);
    for _ in 0..POINTS {
        places.push([scale(), scale(), scale()]);
    }
    let mut signs = Rand64::new(7);
    let poses = places.into_iter().filter_map(|[x, y, z]| {
        let sign = |r: &mut Rand64| if r.rand_float() < 0.5 { -1.0 } else { 1.0 };
        let at = DVec3::new(x * sign(&mut signs), y * sign(&mut signs), -z);
        RelativePose::new(&Pose::from_translation(at.as_vec3()))
    });
    poses.collect()
}
