//! Scene queries without memory, by rapier's default dispatcher and by ours, side by side.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use isa_gjk::IsaGjkDispatcher;
use oorandom::Rand32;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::{
    DefaultQueryDispatcher, NonlinearRigidMotion, QueryDispatcher, ShapeCastOptions,
};
use parry3d::shape::SharedShape;

/// Pairs of poses per hull: apart, touching and overlapping.
const POSES: usize = 64;

fn within(random: &mut Rand32) -> Real {
    2.0 * random.rand_float() - 1.0
}

fn vector(random: &mut Rand32) -> Vector {
    Vector::new(within(random), within(random), within(random))
}

fn hull(vertices: usize, random: &mut Rand32) -> SharedShape {
    let points: Vec<Vector> = (0..vertices)
        .map(|_| vector(random).normalize_or(Vector::X))
        .collect();
    SharedShape::convex_hull(&points).expect("a solid")
}

fn compound(vertices: usize, random: &mut Rand32) -> SharedShape {
    let part =
        |x: Real, random: &mut Rand32| (Pose::translation(x, 0.0, 0.0), hull(vertices, random));
    SharedShape::compound(vec![part(-0.7, random), part(0.7, random)])
}

fn queries(criterion: &mut Criterion) {
    for vertices in [8, 24, 60, 300] {
        let random = &mut Rand32::new(7);
        let pairs = [
            ("hull", hull(vertices, random), hull(vertices, random)),
            (
                "compound",
                compound(vertices, random),
                hull(vertices, random),
            ),
        ];
        let poses: Vec<Pose> = (0..POSES)
            .map(|_| Pose::new(vector(random) * 2.5, vector(random) * 3.0))
            .collect();
        for (kind, a, b) in &pairs {
            let dispatchers: [(&str, Box<dyn QueryDispatcher>); 2] = [
                ("default", Box::new(DefaultQueryDispatcher)),
                ("ours", Box::new(IsaGjkDispatcher::default())),
            ];
            for (name, asked) in &dispatchers {
                let mut bench = |query: &str, ask: &dyn Fn(&Pose)| {
                    let mut group = criterion.benchmark_group(format!("{kind}/{vertices}/{query}"));
                    group.bench_function(BenchmarkId::from_parameter(name), |bencher| {
                        bencher.iter(|| poses.iter().for_each(ask));
                    });
                };
                bench("intersection_test", &|pose| {
                    black_box(asked.intersection_test(pose, &**a, &**b)).ok();
                });
                bench("distance", &|pose| {
                    black_box(asked.distance(pose, &**a, &**b)).ok();
                });
                bench("contact", &|pose| {
                    black_box(asked.contact(pose, &**a, &**b, 0.1)).ok();
                });
                bench("cast_shapes", &|pose| {
                    let options = ShapeCastOptions::default();
                    let from = Pose::from_parts(pose.translation * 3.0, pose.rotation);
                    let velocity = -pose.translation;
                    black_box(asked.cast_shapes(&from, velocity, &**a, &**b, options)).ok();
                });
                bench("cast_shapes_nonlinear", &|pose| {
                    let still = NonlinearRigidMotion::identity();
                    let from = Pose::from_parts(pose.translation * 3.0, pose.rotation);
                    let velocity = -pose.translation * 3.0;
                    let moving = NonlinearRigidMotion::new(from, Vector::ZERO, velocity, Vector::X);
                    let hit =
                        asked.cast_shapes_nonlinear(&still, &**a, &moving, &**b, 0.0, 1.0, true);
                    black_box(hit).ok();
                });
            }
        }
    }
}

criterion_group!(benches, queries);
criterion_main!(benches);
