//! A facet of the Minkowski difference as a polygon, and the origin: whether it projects inside, and
//! how deep it is in the pyramid beneath.

use glam::DVec3;

use crate::both::both;

/// The side of a polygon, counter-clockwise about `normal`, beyond which the origin projects
/// farthest, as the index of its first corner; `None` if it projects inside, up to `tolerance`.
#[inline]
pub(super) fn side_beyond(
    count: usize,
    corner: impl Fn(usize) -> DVec3,
    normal: DVec3,
    tolerance: f64,
) -> Option<usize> {
    let mut beyond = None;
    let mut farthest = tolerance * tolerance;
    let mut from = corner(count - 1);
    for i in 0..count {
        let to = corner(i);
        let inward = normal.cross(to - from);
        let height = -inward.dot(from);
        from = to;
        if height < 0.0 {
            let squared = height * height / inward.length_squared();
            if squared > farthest {
                farthest = squared;
                beyond = Some((i + count - 1) % count);
            }
        }
    }
    beyond
}

/// Whether the origin is at least `depth` inside of all side planes of the pyramid over a
/// polygon, counter-clockwise seen from outside, whose apex is beneath it.
#[inline]
pub(super) fn pyramid_holds_ball(
    count: usize,
    corner: impl Fn(usize) -> DVec3,
    apex: DVec3,
    depth: f64,
) -> bool {
    let depth = depth.max(0.0);
    let mut from = corner(count - 1);
    (0..count).all(|i| {
        let to = corner(i);
        let inward = (to - from).cross(apex - from);
        let height = -inward.dot(from);
        from = to;
        height >= 0.0 && height * height >= depth * depth * inward.length_squared()
    })
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
