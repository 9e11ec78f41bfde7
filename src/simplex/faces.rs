//! What the geometric sub-algorithms share: segments, the choice among faces, and the tetrahedron.
//! Weights are barycentric coordinates in the order of the vertices given.

use glam::DVec3;

use super::{Nearest, combine};

/// Below this sine of a triangle's widest corner its normal has lost half of its digits: the nearest
/// point is then chosen among all faces by distance, rather than by the signs of areas. Half of
/// the digits balances the loss of trusting the normal against the loss of ignoring the interior.
const SLIVER_SINE: f64 = 1e-8;

/// Below this ratio of a tetrahedron's volume to the product of three edges at a corner, rounding
/// (some ten half-ulps of that product) decides the sign of the volume: it is taken as flat.
const FLAT_RATIO: f64 = 1e-14;

/// Answers for 1 to 4 vertices, given the weights of the nearest point of a triangle.
#[inline]
pub fn nearest(points: &[DVec3], triangle: impl Fn([DVec3; 3]) -> [f64; 3]) -> Nearest {
    let lambda = match *points {
        [] => [0.0; 4],
        [_] => [1.0, 0.0, 0.0, 0.0],
        [a, b] => {
            let [p, q] = segment([a, b]);
            [p, q, 0.0, 0.0]
        }
        [a, b, c] => {
            let [p, q, r] = triangle([a, b, c]);
            [p, q, r, 0.0]
        }
        [a, b, c, d, ..] => tetrahedron([a, b, c, d], triangle),
    };
    Nearest::new(points, lambda)
}

/// The nearest point of a segment: the origin's projection, clamped.
#[inline]
pub fn segment([a, b]: [DVec3; 2]) -> [f64; 2] {
    let ab = b - a;
    let (along, length) = (-a.dot(ab), ab.length_squared());
    if along > 0.0 && along < length {
        let t = along / length;
        [1.0 - t, t]
    } else if along >= length && length > 0.0 {
        [0.0, 1.0]
    } else {
        [1.0, 0.0]
    }
}

/// The nearest point of a triangle's chosen edges; edge i lies opposite to vertex i.
#[inline]
pub fn nearest_edge(y: [DVec3; 3], chosen: [bool; 3]) -> [f64; 3] {
    let mut best = ([1.0, 0.0, 0.0], f64::INFINITY);
    for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        if chosen[i] {
            let mut lambda = [0.0; 3];
            [lambda[j], lambda[k]] = segment([y[j], y[k]]);
            keep_nearer(&mut best, &y, lambda);
        }
    }
    best.0
}

/// Replaces the best weights, and their squared distance, by nearer ones. Never by NaN.
#[inline]
fn keep_nearer<const N: usize>(best: &mut ([f64; N], f64), y: &[DVec3; N], lambda: [f64; N]) {
    let distance = combine(y, &lambda).length_squared();
    if distance < best.1 {
        *best = (lambda, distance);
    }
}

/// The nearest point of a triangle whose normal is not to be trusted: the best of its edges and of
/// `inside`, the weights of the projected origin, should these be convex.
#[inline(never)]
pub fn nearest_in_sliver(y: [DVec3; 3], inside: [f64; 3]) -> [f64; 3] {
    let edge = nearest_edge(y, [true; 3]);
    let mut best = (edge, combine(&y, &edge).length_squared());
    if inside.iter().all(|&area| area > 0.0) {
        keep_nearer(&mut best, &y, normalized(inside));
    }
    best.0
}

/// A triangle's normal, of twice its area's length, and whether the triangle is a sliver.
/// The product of the two shortest edges carries the least rounding.
#[inline]
pub fn normal([a, b, c]: [DVec3; 3]) -> (DVec3, bool) {
    let (ab, bc, ca) = (b - a, c - b, a - c);
    let [x, y, z] = [ab, bc, ca].map(DVec3::length_squared);
    let (normal, product) = if x >= y && x >= z {
        (bc.cross(ca), y * z)
    } else if y >= z {
        (ca.cross(ab), z * x)
    } else {
        (ab.cross(bc), x * y)
    };
    let trusted = normal.length_squared() > SLIVER_SINE * SLIVER_SINE * product;
    (normal, !trusted)
}

/// Positive weights, scaled to sum 1.
#[inline]
pub fn normalized<const N: usize>(weights: [f64; N]) -> [f64; N] {
    let sum: f64 = weights.iter().sum();
    weights.map(|weight| weight / sum)
}

/// The nearest point of a tetrahedron: the origin if no face has it on its outer side, else the
/// best of the faces that do. A flat tetrahedron has no inside: its nearest face wins.
#[inline]
fn tetrahedron(y: [DVec3; 4], triangle: impl Fn([DVec3; 3]) -> [f64; 3]) -> [f64; 4] {
    let volumes = sub_volumes(y);
    if volumes.iter().all(|&volume| volume > 0.0) {
        return normalized(volumes);
    }
    let mut best = ([1.0, 0.0, 0.0, 0.0], f64::INFINITY);
    for (i, [j, k, l]) in [
        (0, [1, 2, 3]),
        (1, [0, 2, 3]),
        (2, [0, 1, 3]),
        (3, [0, 1, 2]),
    ] {
        let inner = volumes[i] > 0.0;
        if !inner {
            let mut lambda = [0.0; 4];
            [lambda[j], lambda[k], lambda[l]] = triangle([y[j], y[k], y[l]]);
            keep_nearer(&mut best, &y, lambda);
        }
    }
    best.0
}

/// Signed volumes of the origin with each face, opposite to vertex i: positive on the inner side.
/// All zero when the tetrahedron is flat.
#[inline]
fn sub_volumes([a, b, c, d]: [DVec3; 4]) -> [f64; 4] {
    let volume = corner_volume(b - a, c - a, d - a)
        .or_else(|| corner_volume(a - b, d - b, c - b))
        .or_else(|| corner_volume(d - c, a - c, b - c))
        .or_else(|| corner_volume(c - d, b - d, a - d));
    let Some(volume) = volume else {
        return [0.0; 4];
    };
    let sign = volume.signum();
    [
        sign * b.dot((c - b).cross(d - b)),
        -sign * c.dot((d - c).cross(a - c)),
        sign * d.dot((a - d).cross(b - d)),
        -sign * a.dot((b - a).cross(c - a)),
    ]
}

/// The signed volume spanned by three edges, unless its sign may be rounding.
#[inline]
fn corner_volume(u: DVec3, v: DVec3, w: DVec3) -> Option<f64> {
    let volume = u.cross(v).dot(w);
    let product = u.length_squared() * v.length_squared() * w.length_squared();
    (volume * volume > FLAT_RATIO * FLAT_RATIO * product).then_some(volume)
}
