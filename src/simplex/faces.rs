//! What the geometric sub-algorithms share: segments, the choice among faces, and the tetrahedron.
//! Weights are barycentric coordinates in the order of the vertices given.

use glam::DVec3;

use super::{Nearest, combine};

/// Below this sine of a triangle's widest corner its normal has lost half of its digits: the nearest
/// point is then chosen among all faces by distance, rather than by the signs of areas. Half of
/// the digits balances the loss of trusting the normal against the loss of ignoring the interior.
const SLIVER_SINE: f64 = 1e-8;

/// Above this sine of a corner, the product of its edges is as good a normal as that of any other.
const WIDE_SINE: f64 = 1e-2;

/// Below this ratio of a tetrahedron's volume to the product of three edges at a corner, the outer
/// sides of its faces have lost half of their digits: all of the faces are tried.
const FLAT_RATIO: f64 = 1e-8;

/// How well the weights of a tetrahedron must reproduce the origin, relative to a vertex, to be
/// believed without a look at the faces: above the rounding of all but nearly flat tetrahedra.
const INSIDE: f64 = 1e-12;

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
#[inline]
pub fn normal([a, b, c]: [DVec3; 3]) -> (DVec3, bool) {
    let (ab, bc, ca) = (b - a, c - b, a - c);
    let normal = ca.cross(ab);
    let product = ca.length_squared() * ab.length_squared();
    if normal.length_squared() > WIDE_SINE * WIDE_SINE * product {
        return (normal, false);
    }
    widest_corner([ab, bc, ca])
}

/// The normal as the product of the two shortest edges, which carries the least rounding.
#[cold]
fn widest_corner([ab, bc, ca]: [DVec3; 3]) -> (DVec3, bool) {
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

/// The nearest point of a tetrahedron: the origin if inside, else the best of the faces that have
/// it on their outer side; of all faces, if the tetrahedron is too flat to tell.
#[inline]
fn tetrahedron(y: [DVec3; 4], triangle: impl Fn([DVec3; 3]) -> [f64; 3]) -> [f64; 4] {
    let volumes = sub_volumes(y);
    let inside = normalized(volumes);
    if !inside.iter().all(|&l| l > 0.0) {
        return nearest_face(
            y,
            volumes.map(|volume| volume * trusted_volume(y)),
            triangle,
        )
        .0;
    }
    let error = combine(&y, &inside).length_squared();
    if y.iter()
        .any(|p| error <= INSIDE * INSIDE * p.length_squared())
    {
        return inside;
    }
    let face = nearest_face(y, [0.0; 4], triangle);
    if proves_inside(error, face.1) {
        inside
    } else {
        face.0
    }
}

/// Whether a point of the tetrahedron is so much nearer to the origin than all of the faces that
/// the origin must be inside: else the segment from the point would leave through a nearer face.
/// The factor 2 keeps the rounding of equal distances from passing as proof.
#[inline]
pub fn proves_inside(squared_distance: f64, squared_face_distance: f64) -> bool {
    4.0 * squared_distance < squared_face_distance
}

/// The nearest point of the faces that do not have the origin on their inner side, and its squared
/// distance.
#[inline]
fn nearest_face(
    y: [DVec3; 4],
    inner: [f64; 4],
    triangle: impl Fn([DVec3; 3]) -> [f64; 3],
) -> ([f64; 4], f64) {
    let mut best = ([1.0, 0.0, 0.0, 0.0], f64::INFINITY);
    for (i, [j, k, l]) in [
        (0, [1, 2, 3]),
        (1, [0, 2, 3]),
        (2, [0, 1, 3]),
        (3, [0, 1, 2]),
    ] {
        let skip = inner[i] > 0.0;
        if !skip {
            let mut lambda = [0.0; 4];
            [lambda[j], lambda[k], lambda[l]] = triangle([y[j], y[k], y[l]]);
            keep_nearer(&mut best, &y, lambda);
        }
    }
    best
}

/// Signed volumes of the tetrahedra in which the origin takes the place of one vertex each.
#[inline]
fn sub_volumes([a, b, c, d]: [DVec3; 4]) -> [f64; 4] {
    [
        b.dot((c - b).cross(d - b)),
        -c.dot((d - c).cross(a - c)),
        d.dot((a - d).cross(b - d)),
        -a.dot((b - a).cross(c - a)),
    ]
}

/// The signed volume, measured at the first corner at which it is no sliver; zero if there is none.
#[inline]
fn trusted_volume([a, b, c, d]: [DVec3; 4]) -> f64 {
    corner_volume(b - a, c - a, d - a)
        .or_else(|| corner_volume(a - b, d - b, c - b))
        .or_else(|| corner_volume(d - c, a - c, b - c))
        .or_else(|| corner_volume(c - d, b - d, a - d))
        .unwrap_or(0.0)
}

/// The signed volume spanned by three edges, unless they are nearly dependent.
#[inline]
fn corner_volume(u: DVec3, v: DVec3, w: DVec3) -> Option<f64> {
    let volume = u.cross(v).dot(w);
    let product = u.length_squared() * v.length_squared() * w.length_squared();
    (volume * volume > FLAT_RATIO * FLAT_RATIO * product).then_some(volume)
}
