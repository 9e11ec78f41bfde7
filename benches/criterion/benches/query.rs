//! Queries without memory, as scene queries ask them: `contact` of this crate's dispatcher beside
//! parry's, on the poses of one trajectory (see `manifold`). Times are per query.

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use isa_gjk::IsaGjkDispatcher;
use parry3d::query::{DefaultQueryDispatcher, QueryDispatcher};
use testkit::pair::{GAPS, PREDICTION, VERTICES, hull, trajectory};

fn queries(criterion: &mut Criterion) {
    let ours = IsaGjkDispatcher::default();
    let dispatchers: [(&str, &dyn QueryDispatcher); 2] =
        [("isa-gjk", &ours), ("parry", &DefaultQueryDispatcher)];
    for (gap_name, gap) in GAPS {
        let mut group = criterion.benchmark_group(format!("contact/{gap_name}"));
        for vertices in VERTICES {
            let shapes = [hull(vertices, 1), hull(vertices, 2)];
            let mut poses = trajectory(&shapes, gap, 1.0).into_iter().cycle();
            for (name, dispatcher) in dispatchers {
                group.bench_function(BenchmarkId::new(name, vertices), |b| {
                    b.iter(|| {
                        let pose = poses.next().expect("a cycle has no end");
                        let [a, b] = &shapes;
                        dispatcher.contact(black_box(&pose), &**a, &**b, PREDICTION)
                    });
                });
            }
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
    targets = queries
}
criterion_main!(benches);
