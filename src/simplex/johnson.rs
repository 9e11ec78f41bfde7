//! Johnson's sub-algorithm: barycentric coordinates as tabulated determinants.

use glam::DVec3;

use super::faces::proves_inside;
use super::{DistanceSubalgorithm, Nearest, combine};

/// Subsets in increasing order of their bit mask, by Cramer's rule, with the backup procedure
/// (E. Gilbert, D. Johnson, S. Keerthi, *A fast procedure for computing the distance between
/// complex objects in three-dimensional space*, IEEE Journal of Robotics and Automation 4(2), 1988).
pub struct Johnson;

impl DistanceSubalgorithm for Johnson {
    #[inline]
    fn nearest(points: &[DVec3]) -> Nearest {
        let lambda = match *points {
            [] => [0.0; 4],
            [_] => [1.0, 0.0, 0.0, 0.0],
            [a, b] => solve([a, b]),
            [a, b, c] => solve([a, b, c]),
            [a, b, c, d, ..] => solve([a, b, c, d]),
        };
        Nearest::new(points, lambda)
    }
}

/// The distance, relative to the farthest vertex, that an answer may miss the true one by before
/// the backup procedure is asked. The determinants of a nearly flat simplex are mere rounding, and
/// satisfy the halt condition by chance; 1e-10 is far above the rounding of a good answer.
const TRUST: f64 = 1e-10;

/// Δ_i(Y_s) at `[s][i]`, with the subset s as a bit mask.
type Determinants = [[f64; 4]; 16];

#[inline]
fn solve<const N: usize>(y: [DVec3; N]) -> [f64; 4] {
    let reach = y
        .iter()
        .fold(0.0, |r: f64, v| r.max(v.length_squared()))
        .sqrt();
    let mut delta: Determinants = [[0.0; 4]; 16];
    for i in 0..N {
        delta[1 << i][i] = 1.0;
    }
    for s in 1..1 << N {
        let beyond = extend(&mut delta, &y, s);
        if !beyond
            && let Some(lambda) = weights::<N>(&delta[s], s)
            && certified(&y, &lambda, reach)
        {
            return lambda;
        }
    }
    backup(&delta, &y)
}

/// Tabulates Δ_j(Y_s ∪ {y_j}) for every j outside of s; true if any is positive, so that v(aff Y_s)
/// is not the nearest point.
#[inline]
fn extend<const N: usize>(delta: &mut Determinants, y: &[DVec3; N], s: usize) -> bool {
    let k = s.trailing_zeros() as usize;
    let mut beyond = false;
    for j in (0..N).filter(|j| s >> j & 1 == 0) {
        let step = y[k] - y[j];
        let sum = (0..N)
            .filter(|i| s >> i & 1 == 1)
            .map(|i| delta[s][i] * step.dot(y[i]))
            .sum();
        delta[s | 1 << j][j] = sum;
        beyond |= sum > 0.0;
    }
    beyond
}

/// λ_i = Δ_i / ΣΔ, if v(aff Y_s) lies in the interior of conv Y_s.
#[inline]
fn weights<const N: usize>(delta: &[f64; 4], s: usize) -> Option<[f64; 4]> {
    let interior = (0..N).all(|i| s >> i & 1 == 0 || delta[i] > 0.0);
    let sum: f64 = delta.iter().sum();
    (interior && sum.is_finite()).then(|| delta.map(|d| d / sum))
}

/// Whether the distance is proved to within `TRUST`: ‖v‖ − min v·y_i/‖v‖ bounds its error.
#[inline]
fn certified<const N: usize>(y: &[DVec3; N], lambda: &[f64; 4], reach: f64) -> bool {
    let v = combine(y, lambda);
    let (norm, allowed) = (v.length(), TRUST * reach);
    norm <= allowed || y.iter().all(|&p| v.dot(v - p) <= allowed * norm)
}

/// The backup procedure: the nearest among all v(aff Y_s) in conv Y_s. Each is a point of the
/// simplex even if its determinants are rounding, so that the nearest is never a bad choice. (The
/// tetrahedron comes last, and must prove that it has the origin inside.)
#[cold]
fn backup<const N: usize>(delta: &Determinants, y: &[DVec3; N]) -> [f64; 4] {
    let mut best = ([1.0, 0.0, 0.0, 0.0], f64::INFINITY);
    for s in 1..1 << N {
        if let Some(lambda) = weights::<N>(&delta[s], s) {
            let distance = combine(y, &lambda).length_squared();
            let nearer = if s == 0b1111 {
                proves_inside(distance, best.1)
            } else {
                distance < best.1
            };
            if nearer {
                best = (lambda, distance);
            }
        }
    }
    best.0
}
