//! One support query on a random hull: hill climbing beside parry's scan, for a direction that
//! turns by half a degree from query to query, and for directions all over the sphere.

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use glam::DVec3;
use isa_gjk::internals::hull::Hull;
use isa_gjk::internals::stats::Cost;
use isa_gjk::internals::support::{Support, VertexId};
use parry3d::shape::SupportMap;
use testkit::pair::hull;

/// Up to where a graph no longer fits into the first-level cache.
const VERTICES: [usize; 7] = [8, 16, 32, 100, 300, 1000, 10_000];
const DIRECTIONS: usize = 720;

/// A great circle in small steps, and the same directions in an order without coherence.
fn directions() -> [(&'static str, Vec<DVec3>); 2] {
    let (u, v) = (DVec3::new(0.6, 0.0, 0.8), DVec3::new(0.48, 0.8, -0.36));
    let on_circle = |i: usize| {
        let (sin, cos) = (std::f64::consts::TAU * i as f64 / DIRECTIONS as f64).sin_cos();
        u * cos + v * sin
    };
    // 331 is prime to 720: every direction once, far from the one before.
    let scattered = (0..DIRECTIONS).map(|i| on_circle(i * 331 % DIRECTIONS));
    [
        ("coherent", (0..DIRECTIONS).map(on_circle).collect()),
        ("scattered", scattered.collect()),
    ]
}

fn supports(criterion: &mut Criterion) {
    for (order, directions) in directions() {
        let mut group = criterion.benchmark_group(format!("support/{order}"));
        for vertices in VERTICES {
            let shape = hull(vertices, 1);
            let polyhedron = shape.as_convex_polyhedron().expect("made as one");
            let hull = Hull::from_points(polyhedron.points()).expect("a hull of a hull");
            let mut turning = directions.iter().cycle();
            let mut last = VertexId::default();
            group.bench_function(BenchmarkId::new("isa-gjk", vertices), |b| {
                b.iter(|| {
                    let dir = *turning.next().expect("a cycle has no end");
                    let start = if order == "coherent" {
                        last
                    } else {
                        hull.start_vertex(dir)
                    };
                    let (point, vertex) = hull.support(black_box(dir), start, &mut Cost::default());
                    last = vertex;
                    point
                });
            });
            let mut turning = directions.iter().map(|dir| dir.as_vec3()).cycle();
            group.bench_function(BenchmarkId::new("parry", vertices), |b| {
                b.iter(|| {
                    let dir = turning.next().expect("a cycle has no end");
                    polyhedron.local_support_point(black_box(dir))
                });
            });
        }
        group.finish();
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(100))
        .measurement_time(Duration::from_millis(300));
    targets = supports
}
criterion_main!(benches);
