//! Building hulls: from a surface that is known, from parry's polyhedron, and from points (where
//! parry's hull builder has to find the surface first).

use std::hint::black_box;

use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};
use isa_gjk::Hull;
use parry3d::math::Vector;
use parry3d::shape::ConvexPolyhedron;

/// Points spread evenly over the unit sphere, along a spiral.
fn sphere(count: usize) -> Vec<Vector> {
    let golden_angle = std::f32::consts::PI * (3.0 - 5.0_f32.sqrt());
    let point = |i: usize| {
        let y = 1.0 - (2 * i + 1) as f32 / count as f32;
        let (sin, cos) = (golden_angle * i as f32).sin_cos();
        let radius = (1.0 - y * y).sqrt();
        Vector::new(radius * cos, y, radius * sin)
    };
    (0..count).map(point).collect()
}

fn building(criterion: &mut Criterion) {
    for count in [32, 100, 1_000, 10_000] {
        let cloud = sphere(count);
        let (points, triangles) = parry3d::transformation::convex_hull(&cloud);
        let polyhedron = ConvexPolyhedron::from_convex_mesh(points.clone(), &triangles)
            .expect("a hull is convex");
        let mut group = criterion.benchmark_group("build");
        group.sample_size(20);
        group.bench_function(BenchmarkId::new("from_triangles", count), |b| {
            let setup = || points.clone();
            b.iter_batched(
                setup,
                |points| Hull::from_triangles(points, black_box(&triangles)),
                BatchSize::SmallInput,
            );
        });
        group.bench_function(BenchmarkId::new("from_polyhedron", count), |b| {
            b.iter(|| Hull::try_from(black_box(&polyhedron)));
        });
        group.bench_function(BenchmarkId::new("from_points", count), |b| {
            b.iter(|| Hull::from_points(black_box(&cloud)));
        });
    }
}

criterion_group!(benches, building);
criterion_main!(benches);
