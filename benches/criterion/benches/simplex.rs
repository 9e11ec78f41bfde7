//! The three distance sub-algorithms on the same simplices, as GJK meets them.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec3;
use isa_gjk::internals::simplex::{DistanceSubalgorithm, Johnson, SignedVolumes, Voronoi};
use oorandom::Rand64;

/// Enough that no branch predictor learns them by heart.
const SIMPLICES: usize = 4096;

fn cube(random: &mut Rand64) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| 2.0 * random.rand_float() - 1.0))
}

/// Simplices GJK builds on clouds of unit size, whose hulls lie near the origin.
fn simplices<const N: usize>() -> Vec<[DVec3; N]> {
    let mut random = Rand64::new(1988);
    let mut found = Vec::with_capacity(SIMPLICES);
    while found.len() < SIMPLICES {
        let offset = cube(&mut random).normalize_or(DVec3::X) * (1.0 + random.rand_float());
        let cloud: Vec<DVec3> = (0..32)
            .map(|_| offset + cube(&mut random).normalize_or(DVec3::X))
            .collect();
        found.extend(run_to_size(&cloud));
    }
    found
}

/// Runs GJK on a cloud of points until its simplex has N vertices, if it ever has.
fn run_to_size<const N: usize>(cloud: &[DVec3]) -> Option<[DVec3; N]> {
    let mut simplex = vec![cloud[0]];
    for _ in 0..cloud.len() {
        if let Ok(full) = simplex.clone().try_into() {
            return Some(full);
        }
        let nearest = Voronoi::nearest(&simplex);
        let kept = (0..simplex.len()).filter(|i| nearest.face >> i & 1 == 1);
        simplex = kept.map(|i| simplex[i]).collect();
        let v = nearest.point;
        let support = *cloud
            .iter()
            .min_by(|a, b| v.dot(**a).total_cmp(&v.dot(**b)))?;
        if v.dot(v - support) <= 1e-12 * v.length_squared() {
            break;
        }
        simplex.push(support);
    }
    None
}

fn measure<A: DistanceSubalgorithm, const N: usize>(criterion: &mut Criterion, name: &str) {
    let simplices = simplices::<N>();
    let mut group = criterion.benchmark_group("simplex");
    group.throughput(Throughput::Elements(SIMPLICES as u64));
    group.bench_function(BenchmarkId::new(name, N), |bencher| {
        bencher.iter(|| {
            for simplex in &simplices {
                black_box(A::nearest(black_box(simplex)));
            }
        });
    });
    group.finish();
}

fn compare<const N: usize>(criterion: &mut Criterion) {
    measure::<Johnson, N>(criterion, "Johnson");
    measure::<Voronoi, N>(criterion, "Voronoi");
    measure::<SignedVolumes, N>(criterion, "SignedVolumes");
}

criterion_group!(benches, compare::<2>, compare::<3>, compare::<4>);
criterion_main!(benches);
