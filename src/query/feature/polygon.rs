//! A facet of the Minkowski difference as a polygon, and the origin: whether it projects inside, and
//! how deep it is in the pyramid beneath.

use glam::DVec3;

use crate::both::both;
use crate::support::Corners;

/// A side of a polygon.
pub(super) struct PolygonSide {
    /// The numbers of its corners.
    pub ends: [usize; 2],
    /// From the first to the second.
    pub along: DVec3,
}

/// The side of a polygon, counter-clockwise about `normal`, beyond which the origin projects
/// farthest; `None` if it projects inside, up to `tolerance`.
#[inline]
pub(super) fn side_beyond(
    corners: impl Corners,
    normal: DVec3,
    tolerance: f64,
) -> Option<PolygonSide> {
    let mut beyond = None;
    let mut farthest = tolerance * tolerance;
    let mut from = corners.clone().next_back()?;
    let mut number = corners.len() - 1;
    for (i, to) in corners.enumerate() {
        let along = to - from;
        let inward = normal.cross(along);
        let height = -inward.dot(from);
        if height < 0.0 {
            let squared = height * height / inward.length_squared();
            if squared > farthest {
                farthest = squared;
                beyond = Some(PolygonSide {
                    ends: [number, i],
                    along,
                });
            }
        }
        (number, from) = (i, to);
    }
    beyond
}

/// Whether the origin is at least `depth` inside of all side planes of the pyramid over a
/// polygon, counter-clockwise seen from outside, whose apex is beneath it.
#[inline]
pub(super) fn pyramid_holds_ball(mut corners: impl Corners, apex: DVec3, depth: f64) -> bool {
    let Some(mut from) = corners.clone().next_back() else {
        return false;
    };
    corners.all(|to| {
        let (corner, inward) = (from, (to - from).cross(apex - from));
        from = to;
        ball_is_inside(corner, inward, depth)
    })
}

/// Whether the ball around the origin with this radius, which may be negative, is inside of the plane
/// through a corner.
#[inline]
pub(in crate::query) fn ball_is_inside(corner: DVec3, inward: DVec3, radius: f64) -> bool {
    let (height, radius) = (-inward.dot(corner), radius.max(0.0));
    height >= 0.0 && height * height >= radius * radius * inward.length_squared()
}

/// Where the lines `a + s along_1` and `b + t along_2`, `offset` being `a - b`, are nearest.
#[inline]
pub(super) fn crossing(offset: DVec3, along_1: DVec3, along_2: DVec3) -> [f64; 2] {
    let cross = along_1.cross(along_2);
    let area_squared = cross.length_squared();
    both([along_2, along_1], |along| {
        -offset.dot(along.cross(cross)) / area_squared
    })
}
