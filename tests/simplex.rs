//! The distance sub-algorithms against an independent oracle, against each other, and against the
//! optimality condition, on simplices of every kind of degeneracy.

use glam::DVec3;
use isa_gjk::simplex::{DistanceSubalgorithm, Johnson, Nearest, SignedVolumes, Voronoi};
use oorandom::Rand64;
use proptest::prelude::*;

/// Simplices per regime; every one is put to all three algorithms.
const CASES: usize = 150_000;

/// What an answer may miss, relative to the farthest vertex.
struct Tolerance {
    /// The oracle's norm.
    norm: f64,
    /// The optimality condition `v·(v − y_i) ≤ 0`, relative to the square.
    optimality: f64,
}

/// Where features are well separated, all three algorithms agree to rounding.
const WELL_CONDITIONED: Tolerance = Tolerance {
    norm: 1e-13,
    optimality: 1e-11,
};

/// Squared quantities lose an aspect ratio's digits twice.
const NEARLY_FLAT: Tolerance = Tolerance {
    norm: 3e-8,
    optimality: 1e-7,
};

type Solve = fn(&[DVec3]) -> Nearest;

const ALGORITHMS: [(&str, Solve); 3] = [
    ("Johnson", Johnson::nearest),
    ("Voronoi", Voronoi::nearest),
    ("SignedVolumes", SignedVolumes::nearest),
];

// --- The oracle: orthogonal bases of all 15 faces, refined, clamped into the face. ---

/// The least norm over a simplex. Every candidate is a convex combination, so that no error of a
/// nearly dependent basis can undercut the truth, and the nearest feature's is accurate.
fn oracle(y: &[DVec3]) -> f64 {
    let subsets = 1..1_usize << y.len();
    subsets
        .map(|s| face_distance(y, s))
        .fold(f64::INFINITY, f64::min)
}

fn face_distance(y: &[DVec3], subset: usize) -> f64 {
    let mut face: Vec<DVec3> = (0..y.len())
        .filter(|i| subset >> i & 1 == 1)
        .map(|i| y[i])
        .collect();
    face.sort_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    let edges: Vec<DVec3> = face[1..].iter().map(|&p| p - face[0]).collect();
    let mut x = vec![0.0; edges.len()];
    for _ in 0..4 {
        let residual = edges.iter().zip(&x).fold(face[0], |r, (&e, &x)| r + e * x);
        for (x, dx) in x.iter_mut().zip(least_squares(&edges, -residual)) {
            *x += dx;
        }
    }
    x.iter_mut().for_each(|x| *x = x.max(0.0));
    let sum = x.iter().sum::<f64>().max(1.0);
    edges
        .iter()
        .zip(&x)
        .fold(face[0], |v, (&e, &x)| v + e * (x / sum))
        .length()
}

/// Minimizes ‖Σ x_i e_i − target‖ by Gram-Schmidt with pivoting and reorthogonalization.
fn least_squares(edges: &[DVec3], target: DVec3) -> Vec<f64> {
    let n = edges.len();
    let mut left: Vec<(usize, DVec3)> = edges.iter().copied().enumerate().collect();
    let mut basis: Vec<(usize, DVec3)> = Vec::new();
    while !left.is_empty() {
        let longest = (0..left.len())
            .max_by(|&i, &j| {
                left[i]
                    .1
                    .length_squared()
                    .total_cmp(&left[j].1.length_squared())
            })
            .unwrap();
        let (i, rest) = left.swap_remove(longest);
        let q = basis.iter().fold(rest, |r, (_, q)| r - *q * q.dot(r));
        if q.length() <= 1e-14 * edges[i].length() {
            break;
        }
        let q = q.normalize();
        let q = basis
            .iter()
            .fold(q, |r, (_, q)| r - *q * q.dot(r))
            .normalize();
        left.iter_mut().for_each(|(_, r)| *r -= q * q.dot(*r));
        basis.push((i, q));
    }
    let mut x = vec![0.0; n];
    for k in (0..basis.len()).rev() {
        let (i, q) = basis[k];
        let known: f64 = basis[k + 1..]
            .iter()
            .map(|&(j, _)| q.dot(edges[j]) * x[j])
            .sum();
        x[i] = (q.dot(target) - known) / q.dot(edges[i]);
    }
    x
}

// --- Simplices ---

struct Source(Rand64);

impl Source {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.rand_float()
    }

    fn log_uniform(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    fn cube(&mut self) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|_| self.between(-1.0, 1.0)))
    }

    fn grid(&mut self) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|_| {
            self.0.rand_range(0..5) as f64 - 2.0
        }))
    }

    fn simplex(&mut self, mut vertex: impl FnMut(&mut Self) -> DVec3) -> Vec<DVec3> {
        let count = self.0.rand_range(1..5);
        (0..count).map(|_| vertex(self)).collect()
    }

    /// Integer coordinates: the origin lies on vertices, edges and faces all the time, and
    /// degenerate simplices are exactly so.
    fn on_the_grid(&mut self) -> Vec<DVec3> {
        self.simplex(Self::grid)
    }

    fn generic(&mut self) -> Vec<DVec3> {
        let offset = self.cube();
        self.simplex(|source| source.cube() + offset)
    }

    /// A small simplex far away.
    fn distant(&mut self) -> Vec<DVec3> {
        let (offset, size) = (self.cube(), self.log_uniform(1e-6, 1.0));
        self.simplex(|source| offset + source.cube() * size)
    }

    /// A generic simplex at the scales the crate may meet.
    fn scaled(&mut self) -> Vec<DVec3> {
        let scale = self.log_uniform(1e-6, 1e6);
        self.generic().iter().map(|&p| p * scale).collect()
    }

    /// Flattened in one or two skew directions, the origin near, inside or off its plane.
    fn nearly_flat(&mut self) -> Vec<DVec3> {
        let (u, v, w) = (self.cube(), self.cube(), self.cube());
        let thin = self.log_uniform(1e-8, 1.0);
        let thinner = if self.0.rand_range(0..2) == 0 {
            thin
        } else {
            1.0
        };
        let lift = self.log_uniform(1e-8, 1.0);
        let offset = self.cube() * lift;
        self.simplex(|source| {
            let p = source.cube();
            offset + u * p.x + v * (p.y * thinner) + w * (p.z * thin)
        })
    }

    /// Vertices repeated, or combined from others: dependent to the last digit or nearly.
    fn dependent(&mut self) -> Vec<DVec3> {
        let mut y = self.generic();
        for i in 1..y.len() {
            let (j, k) = (
                self.0.rand_range(0..i as u64),
                self.0.rand_range(0..i as u64),
            );
            let t = self.between(-1.0, 2.0).max(0.0);
            if self.0.rand_range(0..3) > 0 {
                y[i] = y[j as usize].lerp(y[k as usize], t);
            }
        }
        y
    }
}

// --- Checks ---

fn size(y: &[DVec3]) -> f64 {
    y.iter()
        .map(|p| p.length())
        .fold(f64::MIN_POSITIVE, f64::max)
}

/// What every answer satisfies, on any input.
fn check_convex(name: &str, y: &[DVec3], nearest: &Nearest) {
    let Nearest {
        point,
        face,
        lambda,
    } = *nearest;
    let case = || format!("{name}: {y:?}: {nearest:?}");
    assert!(point.is_finite(), "not finite: {}", case());
    assert!(
        lambda.iter().all(|l| (0.0..=1.0).contains(l)),
        "not convex: {}",
        case()
    );
    assert!(
        (lambda.iter().sum::<f64>() - 1.0).abs() < 1e-15 * 4.0,
        "sum: {}",
        case()
    );
    let support = (0..4)
        .filter(|&i| lambda[i] > 0.0)
        .fold(0, |mask, i| mask | 1 << i);
    assert_eq!(face, support, "face: {}", case());
    assert!(u32::from(face) < 1 << y.len(), "no such vertex: {}", case());
    if face == 0b1111 {
        assert_eq!(point, DVec3::ZERO, "inside: {}", case());
    }
}

fn check_nearest(name: &str, y: &[DVec3], truth: f64, tolerance: &Tolerance) -> [f64; 3] {
    let solve = ALGORITHMS.iter().find(|a| a.0 == name).unwrap().1;
    let nearest = solve(y);
    check_convex(name, y, &nearest);
    let (v, size) = (nearest.point, size(y));
    let combination = y
        .iter()
        .zip(nearest.lambda)
        .fold(DVec3::ZERO, |s, (&p, l)| s + p * l);
    let errors = [
        (v.length() - truth).abs() / size,
        y.iter().map(|&p| v.dot(v - p)).fold(0.0, f64::max) / (size * size),
        v.distance(combination) / size,
    ];
    let allowed = [tolerance.norm, tolerance.optimality, tolerance.norm];
    if let Ok(x) = std::env::var("SHOW") {
        let x: f64 = x.parse().unwrap();
        if errors[0] > x {
            eprintln!("{name}: {y:?}: {nearest:?}, truth {truth}: {errors:?}");
        }
    } else {
        for i in 0..3 {
            assert!(
                errors[i] <= allowed[i],
                "{name}: {y:?}: {nearest:?}, truth {truth}: {errors:?}"
            );
        }
    }
    errors
}

fn check_regime(
    name: &str,
    seed: u128,
    regime: fn(&mut Source) -> Vec<DVec3>,
    tolerance: &Tolerance,
) {
    let mut source = Source(Rand64::new(seed));
    let mut worst = [[0.0_f64; 3]; 3];
    for _ in 0..CASES {
        let y = regime(&mut source);
        let truth = oracle(&y);
        for (worst, (algorithm, _)) in worst.iter_mut().zip(ALGORITHMS) {
            let errors = check_nearest(algorithm, &y, truth, tolerance);
            for (worst, error) in worst.iter_mut().zip(errors) {
                *worst = worst.max(error);
            }
        }
    }
    for (worst, (algorithm, _)) in worst.iter().zip(ALGORITHMS) {
        println!(
            "{name:12} {algorithm:14} norm {:.1e}, optimality {:.1e}, combination {:.1e}",
            worst[0], worst[1], worst[2]
        );
    }
}

#[test]
fn grid() {
    check_regime("grid", 1, Source::on_the_grid, &WELL_CONDITIONED);
}

#[test]
fn generic() {
    check_regime("generic", 2, Source::generic, &WELL_CONDITIONED);
}

#[test]
fn distant() {
    check_regime("distant", 3, Source::distant, &WELL_CONDITIONED);
}

#[test]
fn scaled() {
    check_regime("scaled", 4, Source::scaled, &WELL_CONDITIONED);
}

#[test]
fn nearly_flat() {
    check_regime("nearly flat", 5, Source::nearly_flat, &NEARLY_FLAT);
}

#[test]
fn dependent() {
    check_regime("dependent", 6, Source::dependent, &WELL_CONDITIONED);
}
