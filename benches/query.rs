//! Whole manifold updates on one coherent trajectory: this crate's dispatcher beside parry's, both
//! keeping their manifold from frame to frame as rapier does.
//!
//! Two random hulls of the unit sphere turn by half a degree and swing by two millimetres a frame
//! (`slow`), or ten times as much (`fast`), around a gap: separated by half a size, touching,
//! 1 % deep and 20 % deep. Times are per update.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Rotation, Vector};
use parry3d::query::{
    ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher, QueryDispatcher,
};
use parry3d::shape::SharedShape;

const VERTICES: [usize; 5] = [10, 32, 100, 300, 1000];
const FRAMES: usize = 240;
/// Rapier's prediction distance.
const PREDICTION: f32 = 0.002;

/// Mean gap of the two hulls, whose radius is 1.
const GAPS: [(&str, f32); 4] = [
    ("separated", 1.0),
    ("touching", 0.0),
    ("shallow", -0.02),
    ("deep", -0.4),
];

fn hull(vertices: usize, seed: u128) -> SharedShape {
    let mut random = oorandom::Rand32::new(seed as u64);
    let points: Vec<Vector> = (0..vertices)
        .map(|_| {
            loop {
                let p = Vector::new(
                    random.rand_float() * 2.0 - 1.0,
                    random.rand_float() * 2.0 - 1.0,
                    random.rand_float() * 2.0 - 1.0,
                );
                if (0.1..1.0).contains(&p.length()) {
                    return p.normalize();
                }
            }
        })
        .collect();
    SharedShape::convex_hull(&points).expect("random points have volume")
}

/// Poses of the second hull in the frame of the first, each at its gap from it up to the swing.
fn trajectory(shapes: &[SharedShape; 2], gap: f32, speed: f32) -> Vec<Pose> {
    let direction = Vector::new(0.36, 0.48, 0.8);
    let axis = Vector::new(0.6, 0.0, 0.8);
    (0..FRAMES)
        .map(|frame| {
            let angle = speed * 0.5_f32.to_radians() * frame as f32;
            let rotation = Rotation::from_axis_angle(axis, angle);
            let swing = 0.002 * speed * (frame as f32 * 0.7).sin();
            // The distance along the line of centres at which this orientation touches.
            let far = Pose::from_parts(direction * 3.0, rotation);
            let apart = IsaGjkDispatcher::default()
                .cast_shapes(
                    &far,
                    -direction,
                    &*shapes[0],
                    &*shapes[1],
                    Default::default(),
                )
                .expect("hulls can be cast")
                .map_or(2.0, |hit| 3.0 - hit.time_of_impact);
            Pose::from_parts(direction * (apart + gap + swing), rotation)
        })
        .collect()
}

/// One pass over the trajectory with a manifold of its own.
fn pass<D: PersistentQueryDispatcher>(
    dispatcher: &D,
    shapes: &[SharedShape; 2],
    poses: &[Pose],
    manifolds: &mut Vec<ContactManifold<(), ()>>,
) {
    for pose in poses {
        let _ = dispatcher.contact_manifolds(
            black_box(pose),
            &*shapes[0],
            &*shapes[1],
            PREDICTION,
            manifolds,
            &mut None,
        );
    }
}

/// Per-update time: forth and back, so that no frame follows a jump.
fn time<D: PersistentQueryDispatcher>(
    dispatcher: &D,
    shapes: &[SharedShape; 2],
    poses: &[Pose],
    updates: u64,
) -> Duration {
    let round: Vec<Pose> = poses.iter().chain(poses.iter().rev()).copied().collect();
    let mut manifolds = Vec::new();
    pass(dispatcher, shapes, &round, &mut manifolds);
    let rounds = updates.div_ceil(round.len() as u64);
    let start = Instant::now();
    for _ in 0..rounds {
        pass(dispatcher, shapes, &round, &mut manifolds);
    }
    start
        .elapsed()
        .mul_f64(updates as f64 / (rounds * round.len() as u64) as f64)
}

fn queries(criterion: &mut Criterion) {
    let ours = IsaGjkDispatcher::default();
    for (speed_name, speed) in [("slow", 1.0), ("fast", 10.0)] {
        for (gap_name, gap) in GAPS {
            let mut group = criterion.benchmark_group(format!("{speed_name}/{gap_name}"));
            for vertices in VERTICES {
                let shapes = [hull(vertices, 1), hull(vertices, 2)];
                let poses = trajectory(&shapes, gap, speed);
                group.bench_function(BenchmarkId::new("isa-gjk", vertices), |b| {
                    b.iter_custom(|updates| time(&ours, &shapes, &poses, updates));
                });
                group.bench_function(BenchmarkId::new("parry", vertices), |b| {
                    b.iter_custom(|updates| {
                        time(&DefaultQueryDispatcher, &shapes, &poses, updates)
                    });
                });
            }
            group.finish();
        }
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(100))
        .measurement_time(Duration::from_millis(300));
    targets = queries
}
criterion_main!(benches);
