//! Johnson's sub-algorithm: barycentric coordinates as tabulated determinants.

use glam::DVec3;

use super::faces::{Combination, proves_inside};
use super::{DistanceSubalgorithm, Nearest};
use crate::tolerance::JOHNSON_ERROR;

/// Subsets in increasing order of their bit mask, by Cramer's rule, with the backup procedure
/// (E. Gilbert, D. Johnson, S. Keerthi, *A fast procedure for computing the distance between
/// complex objects in three-dimensional space*, IEEE Journal of Robotics and Automation 4(2), 1988).
pub struct Johnson;

impl DistanceSubalgorithm for Johnson {
    #[inline]
    fn nearest(points: &[DVec3]) -> Nearest {
        let found = match *points {
            [] => return Nearest::default(),
            [a] => Combination::vertex(a, 0),
            [a, b] => solve::<2, 4>([a, b]).among(|[p, q]| [p, q, 0.0, 0.0]),
            [a, b, c] => solve::<3, 8>([a, b, c]).among(|[p, q, r]| [p, q, r, 0.0]),
            [a, b, c, d, ..] => solve::<4, 16>([a, b, c, d]),
        };
        found.into()
    }
}

/// Δ_i(Y_s) at `[s][i]`, with the subset s as a bit mask.
type Determinants<const N: usize, const S: usize> = [[f64; N]; S];

/// The nearest point; S = 2^N is the number of subsets.
#[inline]
fn solve<const N: usize, const S: usize>(y: [DVec3; N]) -> Combination<N> {
    let mut delta: Determinants<N, S> = [[0.0; N]; S];
    for i in 0..N {
        delta[1 << i][i] = 1.0;
    }
    for s in 1..S {
        let beyond = extend(&mut delta, &y, s);
        if !beyond
            && let Some(found) = in_subset(&delta[s], &y, s)
            && certified(&y, found.point)
        {
            return found;
        }
    }
    backup(&delta, &y)
}

/// Tabulates Δ_j(Y_s ∪ {y_j}) for every j outside of s; true if any is positive, so that v(aff Y_s)
/// is not the nearest point.
#[inline]
fn extend<const N: usize, const S: usize>(
    delta: &mut Determinants<N, S>,
    y: &[DVec3; N],
    s: usize,
) -> bool {
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

/// v(aff Y_s) with λ_i = Δ_i / ΣΔ, if it lies in the interior of conv Y_s.
#[inline]
fn in_subset<const N: usize>(delta: &[f64; N], y: &[DVec3; N], s: usize) -> Option<Combination<N>> {
    let interior = (0..N).all(|i| s >> i & 1 == 0 || delta[i] > 0.0);
    if interior {
        Combination::weighted(*y, *delta)
    } else {
        None
    }
}

/// Whether the distance is proved to within `JOHNSON_ERROR`: ‖v‖ − min v·y_i/‖v‖ bounds its error.
#[inline]
fn certified<const N: usize>(y: &[DVec3; N], v: DVec3) -> bool {
    let reach = y
        .iter()
        .fold(0.0, |r: f64, p| r.max(p.length_squared()))
        .sqrt();
    let (norm, allowed) = (v.length(), JOHNSON_ERROR * reach);
    norm <= allowed || y.iter().all(|&p| v.dot(v - p) <= allowed * norm)
}

/// The backup procedure: the nearest among all v(aff Y_s) in conv Y_s. Each is a point of the simplex even if
/// its determinants are mere rounding, so the nearest is never a bad choice. (The tetrahedron comes last, and
/// must prove that the origin is inside.)
#[cold]
fn backup<const N: usize, const S: usize>(
    delta: &Determinants<N, S>,
    y: &[DVec3; N],
) -> Combination<N> {
    let mut best = Combination::vertex(y[0], 0);
    for (s, delta) in delta.iter().enumerate().skip(1) {
        match in_subset(delta, y, s) {
            Some(found) if s < 0b1111 => best = best.nearer(found),
            Some(found) if proves_inside(found.distance(), best.distance()) => best = found,
            _ => {}
        }
    }
    best
}
