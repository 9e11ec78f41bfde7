//! The parts that the geometric sub-algorithms share: segments, the choice among faces, and the tetrahedron.

use glam::DVec3;

use super::Nearest;
use crate::tolerance::{INTERIOR_RESIDUAL, MIN_TRIANGLE_SINE, MIN_VOLUME_RATIO};
use crate::tuning::WIDE_SINE;

/// A convex combination of N vertices.
#[derive(Clone, Copy)]
pub struct Combination<const N: usize> {
    pub point: DVec3,
    pub lambda: [f64; N],
}

impl<const N: usize> Combination<N> {
    /// Combines the vertices with the weights, scaled to sum 1, if all are positive, so that the point is in
    /// the interior.
    #[inline]
    pub fn interior(y: [DVec3; N], weights: [f64; N]) -> Option<Self> {
        let positive = weights.iter().all(|&weight| weight > 0.0);
        if positive {
            Self::weighted(y, weights)
        } else {
            None
        }
    }

    /// Combines the vertices with the weights, scaled to sum 1, unless these overflow.
    #[inline]
    pub fn weighted(y: [DVec3; N], weights: [f64; N]) -> Option<Self> {
        let sum = weights.iter().sum::<f64>();
        let lambda = weights.map(|weight| weight / sum);
        let point = (0..N).fold(DVec3::ZERO, |point, i| point + y[i] * lambda[i]);
        sum.is_finite().then_some(Self { point, lambda })
    }

    /// Vertex i as a combination.
    #[inline]
    pub fn vertex(point: DVec3, i: usize) -> Self {
        let mut lambda = [0.0; N];
        lambda[i] = 1.0;
        Self { point, lambda }
    }

    /// The same point as a combination of more vertices.
    #[inline]
    pub fn among<const M: usize>(
        self,
        lambda: impl FnOnce([f64; N]) -> [f64; M],
    ) -> Combination<M> {
        Combination {
            point: self.point,
            lambda: lambda(self.lambda),
        }
    }

    /// Squared distance from the origin.
    #[inline]
    pub fn distance(&self) -> f64 {
        self.point.length_squared()
    }

    /// The nearer of two. It contains no NaN if `self` contains none.
    #[inline]
    pub fn nearer(self, other: Self) -> Self {
        if other.distance() < self.distance() {
            other
        } else {
            self
        }
    }
}

/// Finds the nearest point of a triangle: the step in which the geometric sub-algorithms differ.
pub trait Triangle {
    fn triangle(a: DVec3, b: DVec3, c: DVec3) -> Combination<3>;
}

/// Answers for 1 to 4 vertices.
#[inline(always)]
pub fn nearest<T: Triangle>(points: &[DVec3]) -> Nearest {
    let found = match *points {
        [] => return Nearest::default(),
        [a] => Combination::vertex(a, 0),
        [a, b] => segment(a, b).among(|[p, q]| [p, q, 0.0, 0.0]),
        [a, b, c] => T::triangle(a, b, c).among(|[p, q, r]| [p, q, r, 0.0]),
        [a, b, c, d, ..] => tetrahedron::<T>(a, b, c, d),
    };
    found.into()
}

/// The nearest point of a segment: the origin's projection, clamped.
#[inline]
pub fn segment(a: DVec3, b: DVec3) -> Combination<2> {
    let ab = b - a;
    let (along, length) = (-a.dot(ab), ab.length_squared());
    if along > 0.0 && along < length {
        let t = along / length;
        Combination {
            point: a + ab * t,
            lambda: [1.0 - t, t],
        }
    } else if along > 0.0 && length > 0.0 {
        Combination::vertex(b, 1)
    } else {
        Combination::vertex(a, 0)
    }
}

/// The nearest point of a triangle's chosen edges, or vertex a; edge i lies opposite to vertex i.
#[inline]
pub fn nearest_edge(a: DVec3, b: DVec3, c: DVec3, chosen: [bool; 3]) -> Combination<3> {
    let mut best = Combination::vertex(a, 0);
    if chosen[0] {
        best = best.nearer(segment(b, c).among(|[p, q]| [0.0, p, q]));
    }
    if chosen[1] {
        best = best.nearer(segment(c, a).among(|[p, q]| [q, 0.0, p]));
    }
    if chosen[2] {
        best = best.nearer(segment(a, b).among(|[p, q]| [p, q, 0.0]));
    }
    best
}

/// The nearest point of a triangle with an unreliable normal: the best of its edges, and of the projected
/// origin if its weights `areas` are convex.
#[cold]
pub fn nearest_in_sliver(a: DVec3, b: DVec3, c: DVec3, areas: [f64; 3]) -> Combination<3> {
    let edge = nearest_edge(a, b, c, [true; 3]);
    let inside = Combination::interior([a, b, c], areas);
    inside.map_or(edge, |inside| edge.nearer(inside))
}

/// A triangle's normal, whose length is twice the area, and whether the triangle is a sliver.
#[inline]
pub fn normal(ab: DVec3, bc: DVec3, ca: DVec3) -> (DVec3, bool) {
    let normal = ca.cross(ab);
    let product = ca.length_squared() * ab.length_squared();
    if normal.length_squared() > WIDE_SINE * WIDE_SINE * product {
        return (normal, false);
    }
    widest_corner(ab, bc, ca)
}

/// The normal as the cross product of the two shortest edges, which has the least rounding.
#[cold]
fn widest_corner(ab: DVec3, bc: DVec3, ca: DVec3) -> (DVec3, bool) {
    let [x, y, z] = [ab, bc, ca].map(DVec3::length_squared);
    let (normal, product) = if x >= y && x >= z {
        (bc.cross(ca), y * z)
    } else if y >= z {
        (ca.cross(ab), z * x)
    } else {
        (ab.cross(bc), x * y)
    };
    let trusted = normal.length_squared() > MIN_TRIANGLE_SINE * MIN_TRIANGLE_SINE * product;
    (normal, !trusted)
}

/// The nearest point of a tetrahedron: the origin if it is inside, and otherwise the best of the faces that
/// have the origin on their outer side. If the tetrahedron is too flat to decide, all faces are tried.
#[inline]
fn tetrahedron<T: Triangle>(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Combination<4> {
    let (inner, trusted) = sub_volumes(a, b, c, d);
    let Some(inside) = Combination::interior([a, b, c, d], inner) else {
        let chosen = inner.map(|volume| !(trusted && volume > 0.0));
        return nearest_face::<T>(a, b, c, d, chosen);
    };
    let within =
        |y: DVec3| inside.distance() <= INTERIOR_RESIDUAL * INTERIOR_RESIDUAL * y.length_squared();
    if within(a) || within(b) || within(c) || within(d) {
        return inside;
    }
    let face = nearest_face::<T>(a, b, c, d, [true; 4]);
    if proves_inside(inside.distance(), face.distance()) {
        inside
    } else {
        face
    }
}

/// Whether a point of the tetrahedron is so much nearer to the origin than all faces that the origin must be
/// inside: otherwise the segment from the point to the origin would leave through a nearer face. The factor 2
/// keeps rounding of equal distances from counting as proof.
#[inline]
pub fn proves_inside(squared_distance: f64, squared_face_distance: f64) -> bool {
    4.0 * squared_distance < squared_face_distance
}

/// The nearest point of a tetrahedron's chosen faces, or vertex a; face i lies opposite to vertex i.
#[inline]
fn nearest_face<T: Triangle>(
    a: DVec3,
    b: DVec3,
    c: DVec3,
    d: DVec3,
    chosen: [bool; 4],
) -> Combination<4> {
    let mut best = Combination::vertex(a, 0);
    if chosen[0] {
        best = best.nearer(T::triangle(b, c, d).among(|[p, q, r]| [0.0, p, q, r]));
    }
    if chosen[1] {
        best = best.nearer(T::triangle(a, c, d).among(|[p, q, r]| [p, 0.0, q, r]));
    }
    if chosen[2] {
        best = best.nearer(T::triangle(a, b, d).among(|[p, q, r]| [p, q, 0.0, r]));
    }
    if chosen[3] {
        best = best.nearer(T::triangle(a, b, c).among(|[p, q, r]| [p, q, r, 0.0]));
    }
    best
}

/// The volumes of the four tetrahedra in which the origin replaces one vertex, positive on the inner side of
/// the opposite face; and whether their signs are reliable.
#[inline]
fn sub_volumes(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> ([f64; 4], bool) {
    let (ab, ac, ad) = (b - a, c - a, d - a);
    let (acd, adb, abc) = (ac.cross(ad), ad.cross(ab), ab.cross(ac));
    let volume = ab.dot(acd);
    let product = ab.length_squared() * ac.length_squared() * ad.length_squared();
    let toward = a * -volume.signum();
    let (at_b, at_c, at_d) = (toward.dot(acd), toward.dot(adb), toward.dot(abc));
    let at_a = volume.abs() - (at_b + at_c + at_d);
    let trusted = volume * volume > MIN_VOLUME_RATIO * MIN_VOLUME_RATIO * product;
    ([at_a, at_b, at_c, at_d], trusted)
}
