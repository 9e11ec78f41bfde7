//! A facet of the Minkowski difference as a polygon: whether the origin projects into it, and how deep the
//! origin is in the pyramid beneath.

use crate::simd::{LANES, f32x4};
use glam::{DVec3, Vec3};

use crate::map_pair::map_pair;
use crate::support::{FaceCorners, FaceId, FacePoints, Polytope};
use crate::tolerance::INSET_ROUNDING;
use crate::tuning::MANY_SIDES;

/// Whether all corners of a face are looked at, or a quadrilateral of some of them, which lies inside of it.
#[derive(Clone, Copy)]
pub(in crate::query) enum Corners {
    All,
    Four,
}

/// A lower bound on how far inside a face the projection of a point is; at most zero if it may be outside. It
/// is computed in f32 for four sides at a time, and rounding is subtracted. The point is at most `distance`
/// from the plane. The `radius` is that of the shape.
#[inline]
pub(crate) fn inset(
    face: impl FaceCorners,
    radius: f64,
    normal: DVec3,
    point: DVec3,
    distance: f64,
) -> f64 {
    inset_in(face, radius, normal, point, distance, Corners::All)
}

/// The same of all corners, or of four.
#[inline]
pub(in crate::query) fn inset_in(
    face: impl FaceCorners,
    radius: f64,
    normal: DVec3,
    point: DVec3,
    distance: f64,
    corners: Corners,
) -> f64 {
    let (corner, count) = (|i| face.point(i), face.count());
    let (normal, at) = (normal.as_vec3(), point.as_vec3());
    let mut least = f32x4::splat(f32::INFINITY);
    let mut is_inside = f32x4::ZERO.simd_eq(f32x4::ZERO);
    let mut pass = |sides: FourSides| {
        let [x, y, z] = sides.outward;
        let height = sides.height / (x * x + y * y + z * z).sqrt();
        // For a side without length, the height is NaN.
        is_inside &= height.simd_gt(f32x4::ZERO);
        least = least.fast_min(height);
    };
    match corners {
        Corners::Four if count > LANES => {
            let [b, c, d] = [count / 4, count / 2, 3 * count / 4];
            let corners = [corner(0), corner(b), corner(c), corner(d), corner(0)];
            pass(FourSides::new(corners, normal, at));
        }
        _ => four_by_four(corner, count, |corners| {
            pass(FourSides::new(corners, normal, at))
        }),
    }
    if !is_inside.all() {
        return 0.0;
    }
    let size = 2.0 * radius + distance.abs() + point.length();
    f64::from(least_of(least)) - INSET_ROUNDING * size
}

/// How far a point is beside a face, at most, along the face. `inside` is a point of its plane inside of it.
///
/// The way from there to the point leaves the face where it crosses the line of a side.
#[inline]
pub(in crate::query) fn distance_beside(
    shape: &impl Polytope,
    face: FaceId,
    normal: DVec3,
    inside: DVec3,
    point: DVec3,
) -> f64 {
    let face = shape.face_corners(face);
    let (corner, count) = (|i| face.point(i), face.count());
    let way = point - inside;
    let toward = way.as_vec3();
    let (normal, at) = (normal.as_vec3(), inside.as_vec3());
    // The share of the way that is in front of each side. It is negative, or infinite, if it does not lead there.
    let share = |corners| {
        let sides = FourSides::new(corners, normal, at);
        let share = sides.height / sides.climb(toward);
        share.simd_gt(f32x4::ZERO).select(share, f32x4::splat(1.0))
    };
    let mut least = f32x4::splat(1.0);
    if count > MANY_SIDES {
        let [from, to] = side_towards(corner, count, normal, at, toward);
        least = share([from, to, from, to, from]).fast_min(least);
    } else {
        four_by_four(corner, count, |corners| {
            least = share(corners).fast_min(least)
        });
    }
    let size = 2.0 * shape.radius() + point.length();
    way.length() * (1.0 - f64::from(least_of(least))) + INSET_ROUNDING * size
}

/// The least of four numbers, none of which is NaN.
fn least_of(four: f32x4) -> f32 {
    let [a, b, c, d] = four.to_array();
    let less = |a: f32, b: f32| if a < b { a } else { b };
    less(less(a, b), less(c, d))
}

/// Calls a function with the ends of four sides after the other. After the last side, the first ones come again.
#[inline]
fn four_by_four(corner: impl Fn(usize) -> Vec3, count: usize, mut call: impl FnMut([Vec3; 5])) {
    let wrapped = |i: usize| corner(if i < count { i } else { i - count });
    // perf: `step_by` divides.
    let mut i = 0;
    while i < count {
        let ends = [
            corner(i),
            wrapped(i + 1),
            wrapped(i + 2),
            wrapped(i + 3),
            wrapped(i + 4),
        ];
        call(ends);
        i += LANES;
    }
}

/// The side that is in a direction from a point inside of a polygon, found by halving.
#[inline]
fn side_towards(
    corner: impl Fn(usize) -> Vec3,
    count: usize,
    normal: Vec3,
    inside: Vec3,
    toward: Vec3,
) -> [Vec3; 2] {
    let (first, right) = (corner(0) - inside, toward.cross(normal));
    let left_of_first = normal.cross(first);
    // Whether it is to the left of the first corner, as are those up to the opposite one.
    let is_left = first.dot(right) >= 0.0;
    let [mut before, mut after] = [0, count];
    while after - before > 1 {
        let middle = usize::midpoint(before, after);
        let place = corner(middle) - inside;
        let (is_first_half, is_right) = (place.dot(left_of_first) >= 0.0, place.dot(right) >= 0.0);
        let is_before = if is_left {
            is_first_half && is_right
        } else {
            is_first_half || is_right
        };
        if is_before {
            before = middle;
        } else {
            after = middle;
        }
    }
    [
        corner(before),
        corner(if after < count { after } else { 0 }),
    ]
}

/// Four sides of a polygon, seen from a point.
struct FourSides {
    /// Out of the polygon, as long as the sides.
    outward: [f32x4; 3],
    /// How far they are outwards, times their lengths.
    height: f32x4,
}

impl FourSides {
    /// Between the corners.
    #[inline]
    fn new([a, b, c, d, next]: [Vec3; 5], normal: Vec3, at: Vec3) -> Self {
        let from_x = f32x4::new([a.x, b.x, c.x, d.x]);
        let from_y = f32x4::new([a.y, b.y, c.y, d.y]);
        let from_z = f32x4::new([a.z, b.z, c.z, d.z]);
        let x = f32x4::new([b.x, c.x, d.x, next.x]) - from_x;
        let y = f32x4::new([b.y, c.y, d.y, next.y]) - from_y;
        let z = f32x4::new([b.z, c.z, d.z, next.z]) - from_z;
        let outward_x = y * normal.z - z * normal.y;
        let outward_y = z * normal.x - x * normal.z;
        let outward_z = x * normal.y - y * normal.x;
        let height =
            outward_x * (from_x - at.x) + outward_y * (from_y - at.y) + outward_z * (from_z - at.z);
        Self {
            outward: [outward_x, outward_y, outward_z],
            height,
        }
    }

    /// How far a vector leads outwards, times their lengths.
    #[inline]
    fn climb(&self, vector: Vec3) -> f32x4 {
        let [x, y, z] = self.outward;
        x * vector.x + y * vector.y + z * vector.z
    }
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
