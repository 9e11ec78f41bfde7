//! A facet of the Minkowski difference as a polygon: whether the origin projects into it, and how deep the
//! origin is in the pyramid beneath.

use crate::simd::{LANES, f32x4};
use glam::DVec3;

use crate::map_pair::map_pair;
use crate::support::{FaceId, FacePoints, Polytope};
use crate::tolerance::INSET_ROUNDING;

/// A lower bound on how far inside a face the projection of a point is; at most zero if it may be outside. It
/// is computed in f32 for four sides at a time, and rounding is subtracted. The point is at most `distance`
/// from the plane.
#[inline]
pub(crate) fn inset(
    shape: &impl Polytope,
    face: FaceId,
    normal: DVec3,
    point: DVec3,
    distance: f64,
) -> f64 {
    let count = shape.face_len(face);
    inset_among(shape, face, count, |i| i, (normal, point, distance))
}

/// The same of a quadrilateral between corners of the face.
#[inline]
pub(in crate::query) fn inset_of_quadrilateral(
    shape: &impl Polytope,
    face: FaceId,
    normal: DVec3,
    point: DVec3,
    distance: f64,
) -> f64 {
    let len = shape.face_len(face);
    let count = len.min(LANES);
    inset_among(
        shape,
        face,
        count,
        |i| i * len / count,
        (normal, point, distance),
    )
}

/// The same of so many corners of a face, which `numbered` gives.
// perf: in a call the point would go through memory.
#[inline(always)]
fn inset_among(
    shape: &impl Polytope,
    face: FaceId,
    count: usize,
    numbered: impl Fn(usize) -> usize,
    (normal, point, distance): (DVec3, DVec3, f64),
) -> f64 {
    let (normal, at) = (normal.as_vec3(), point.as_vec3());
    let mut least = f32x4::splat(f32::INFINITY);
    let mut is_inside = f32x4::ZERO.simd_eq(f32x4::ZERO);
    for first in (0..count).step_by(4) {
        // After the last corner, the first ones come again.
        let wrapped = |i: usize| if i < count { i } else { i - count };
        let number = |i: usize| numbered(wrapped(first + i));
        let [a, b, c, d, next] = shape.face_points_at(face, [0, 1, 2, 3, 4].map(number));
        let row = |axis: usize| {
            let from = f32x4::new([a[axis], b[axis], c[axis], d[axis]]);
            let to = f32x4::new([b[axis], c[axis], d[axis], next[axis]]);
            (from - at[axis], to - from)
        };
        let [(from_x, x), (from_y, y), (from_z, z)] = [row(0), row(1), row(2)];
        let inward_x = z * normal.y - y * normal.z;
        let inward_y = x * normal.z - z * normal.x;
        let inward_z = y * normal.x - x * normal.y;
        let squared = inward_x * inward_x + inward_y * inward_y + inward_z * inward_z;
        let height = -(inward_x * from_x + inward_y * from_y + inward_z * from_z) / squared.sqrt();
        // For a side without length, the height is NaN.
        is_inside &= height.simd_gt(f32x4::ZERO);
        least = least.fast_min(height);
    }
    if !is_inside.all() {
        return 0.0;
    }
    let [a, b, c, d] = least.to_array().map(f64::from);
    let size = 2.0 * shape.radius() + distance.abs() + point.length();
    a.min(b).min(c.min(d)) - INSET_ROUNDING * size
}

/// Whether the ball of radius `depth` around the origin is in the hull of an apex and a disc of radius
/// `inset`. The disc is a part of a face, and its centre is `depth` along the normal.
///
/// The disc alone reaches that far in all directions, except those within an angle of the reversed normal;
/// half of this angle has the tangent `depth / inset`. In those directions the apex reaches that far, if it
/// does so at that angle.
#[inline]
pub(crate) fn cone_contains_ball(inset: f64, depth: f64, apex: DVec3, normal: DVec3) -> bool {
    if inset <= depth.max(0.0) {
        return false;
    }
    let beneath = -apex.dot(normal);
    let aside = (apex + normal * beneath).length();
    let [inset_squared, depth_squared] = [inset * inset, depth * depth];
    let at_angle = beneath * (inset_squared - depth_squared) - 2.0 * aside * inset * depth;
    beneath > 0.0 && at_angle >= depth * (inset_squared + depth_squared)
}

/// A side of a polygon.
pub(in crate::query) struct PolygonEdge {
    /// The indices of its corners.
    pub ends: [usize; 2],
    /// From the first to the second.
    pub along: DVec3,
}

/// How far from its sides the origin projects into a polygon, counter-clockwise about `normal`: zero if it projects
/// outside, up to `tolerance`. Beyond that, the side beyond which it projects farthest is the error.
#[inline]
pub(in crate::query) fn inset_of_origin(
    corners: impl FacePoints,
    normal: DVec3,
    tolerance: f64,
) -> Result<f64, PolygonEdge> {
    let mut beyond = None;
    let mut farthest = tolerance * tolerance;
    let mut nearest = f64::INFINITY;
    let Some(mut from) = corners.clone().next_back() else {
        return Ok(0.0);
    };
    let mut number = corners.len() - 1;
    for (i, to) in corners.enumerate() {
        let along = to - from;
        let inward = normal.cross(along);
        let height = -inward.dot(from);
        let squared = height * height / inward.length_squared();
        if height >= 0.0 {
            nearest = if squared < nearest { squared } else { nearest };
        } else {
            nearest = 0.0;
            if squared > farthest {
                farthest = squared;
                beyond = Some(PolygonEdge {
                    ends: [number, i],
                    along,
                });
            }
        }
        (number, from) = (i, to);
    }
    beyond.map_or(Ok(nearest.sqrt()), Err)
}

/// Whether the origin is at least `depth` inside all side planes of the pyramid over a
/// polygon, counter-clockwise seen from outside, whose apex is beneath it.
#[inline]
pub(in crate::query) fn pyramid_contains_ball(
    mut corners: impl FacePoints,
    apex: DVec3,
    depth: f64,
) -> bool {
    let Some(mut from) = corners.clone().next_back() else {
        return false;
    };
    corners.all(|to| {
        let (corner, inward) = (from, (to - from).cross(apex - from));
        from = to;
        ball_is_inside(corner, inward, depth)
    })
}

/// Whether the ball around the origin with this radius, which may be negative, is on the inner side of the
/// plane through a corner.
#[inline]
pub(in crate::query) fn ball_is_inside(corner: DVec3, inward: DVec3, radius: f64) -> bool {
    let (height, radius) = (-inward.dot(corner), radius.max(0.0));
    height >= 0.0 && height * height >= radius * radius * inward.length_squared()
}

/// The parameters at which the lines `a + s along_1` and `b + t along_2` are nearest, where `offset` is `a -
/// b`.
#[inline]
pub(in crate::query) fn crossing(offset: DVec3, along_1: DVec3, along_2: DVec3) -> [f64; 2] {
    let cross = along_1.cross(along_2);
    let (area_squared, across) = (cross.length_squared(), offset.cross(cross));
    map_pair([along_2, along_1], |along| along.dot(across) / area_squared)
}
