//! Whole manifold updates on one coherent trajectory: this crate's dispatcher beside parry's, both
//! keeping their manifold from frame to frame as rapier does.
//!
//! Two random hulls of the unit sphere turn by half a degree and swing by two millimetres a frame
//! (`slow`), or ten times as much (`fast`), around a gap: separated by half a size, touching,
//! 1 % deep and 20 % deep. Then one hull with other shapes, slowly. Times are per update.

use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Vector};
use parry3d::query::{DefaultQueryDispatcher, PersistentQueryDispatcher};
use parry3d::shape::SharedShape;
use testkit::pair::{GAPS, Manifolds, VERTICES, hull, trajectory, update};

/// One pass over the trajectory with a manifold of its own.
fn pass<D: PersistentQueryDispatcher>(
    dispatcher: &D,
    shapes: &[SharedShape; 2],
    poses: &[Pose],
    manifolds: &mut Manifolds,
) {
    for pose in poses {
        update(dispatcher, shapes, pose, manifolds);
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
    let mut manifolds = Manifolds::default();
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

fn compare(
    criterion: &mut Criterion,
    name: &str,
    vertices: &[usize],
    other: impl Fn(usize) -> SharedShape,
    [gap, speed]: [f32; 2],
) {
    let ours = IsaGjkDispatcher::default();
    let mut group = criterion.benchmark_group(name);
    for &vertices in vertices {
        let shapes = [hull(vertices, 1), other(vertices)];
        let poses = trajectory(&shapes, gap, speed);
        group.bench_function(BenchmarkId::new("isa-gjk", vertices), |b| {
            b.iter_custom(|updates| time(&ours, &shapes, &poses, updates));
        });
        group.bench_function(BenchmarkId::new("parry", vertices), |b| {
            b.iter_custom(|updates| time(&DefaultQueryDispatcher, &shapes, &poses, updates));
        });
    }
    group.finish();
}

fn manifolds(criterion: &mut Criterion) {
    for (speed_name, speed) in [("slow", 1.0), ("fast", 10.0)] {
        for (gap_name, gap) in GAPS {
            let name = format!("{speed_name}/{gap_name}");
            let other = |vertices| hull(vertices, 2);
            compare(criterion, &name, &VERTICES, other, [gap, speed]);
        }
    }
}

/// Hulls with other shapes, in the same motion.
fn others(criterion: &mut Criterion) {
    let up = -Vector::new(0.36, 0.48, 0.8);
    let others = [
        ("ball", SharedShape::ball(0.5)),
        ("capsule", SharedShape::capsule_y(0.5, 0.3)),
        ("segment", SharedShape::segment(Vector::ZERO, Vector::X)),
        ("half-space", SharedShape::halfspace(up)),
        ("cuboid", SharedShape::cuboid(0.5, 0.6, 0.7)),
        ("cylinder", SharedShape::cylinder(0.5, 0.4)),
        ("cone", SharedShape::cone(0.5, 0.4)),
    ];
    for (name, other) in others {
        for (gap_name, gap) in GAPS {
            let name = format!("{name}/{gap_name}");
            let shape = |_| other.clone();
            compare(criterion, &name, &[10, 100, 1_000], shape, [gap, 1.0]);
        }
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(100))
        .measurement_time(Duration::from_millis(300));
    targets = manifolds, others
}
criterion_main!(benches);
