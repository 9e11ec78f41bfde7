//! Whole steps of a world of 64 hulls that fall about in a closed box whose gravity turns: rapier's
//! dispatcher, ours, and ours with `HullShape`s. `compare` has the larger scenes.

use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use isa_gjk::{HullShape, IsaGjkDispatcher};
use rapier3d::prelude::*;
use testkit::pair::hull;

const VERTICES: [usize; 4] = [32, 100, 300, 1000];
/// Hulls along each edge of the first heap.
const EDGE: usize = 4;
/// Steps until the heap has fallen.
const WARM_UP: usize = 60;

fn world(narrow_phase: NarrowPhase, shapes: &[SharedShape]) -> PhysicsWorld {
    let mut world = PhysicsWorld {
        narrow_phase,
        ..PhysicsWorld::default()
    };
    for axis in [Vector::X, Vector::Y, Vector::Z] {
        for side in [-1.0, 1.0] {
            let wall = ColliderBuilder::cuboid(8.0, 8.0, 8.0).translation(axis * side * 13.0);
            world.insert_collider(wall, None);
        }
    }
    for i in 0..EDGE.pow(3) {
        let [x, y, z] = [i % EDGE, i / EDGE % EDGE, i / EDGE / EDGE].map(|k| k as f32 - 1.5);
        let body = RigidBodyBuilder::dynamic().translation(2.1 * Vector::new(x, y, z));
        world.insert(body, ColliderBuilder::new(shapes[i % shapes.len()].clone()));
    }
    world
}

/// Gravity turns once in six seconds, so that nothing comes to rest.
fn run(world: &mut PhysicsWorld, steps: usize) -> Duration {
    let start = Instant::now();
    for step in 0..steps {
        let (sin, cos) = (step as f32 * std::f32::consts::TAU / 360.0).sin_cos();
        world.gravity = 9.81 * Vector::new(sin, -cos, 0.0);
        world.step();
    }
    start.elapsed()
}

fn steps(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("step");
    let ours = || NarrowPhase::with_query_dispatcher(IsaGjkDispatcher::default());
    for vertices in VERTICES {
        let plain: Vec<SharedShape> = (1..=8).map(|seed| hull(vertices, seed)).collect();
        let prepared = plain.iter().map(|shape| {
            let polyhedron = shape.as_convex_polyhedron().expect("made as one");
            let shape = HullShape::from_points(polyhedron.points()).expect("a hull of a hull");
            SharedShape::new(shape)
        });
        let prepared: Vec<SharedShape> = prepared.collect();
        let mut bench = |name: &str, narrow_phase: &dyn Fn() -> NarrowPhase, shapes: &[_]| {
            group.bench_function(BenchmarkId::new(name, vertices), |b| {
                b.iter_custom(|count| {
                    let mut world = world(narrow_phase(), shapes);
                    run(&mut world, WARM_UP);
                    run(&mut world, count as usize)
                });
            });
        };
        bench("rapier", &NarrowPhase::new, &plain);
        bench("isa-gjk", &ours, &plain);
        bench("HullShape", &ours, &prepared);
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(100))
        .measurement_time(Duration::from_millis(500));
    targets = steps
}
criterion_main!(benches);
