//! Which corners of the contact patch to keep.

use glam::DVec2;

use super::MAX_POINTS;
use super::clip::ClipVertex;

/// The corners up to a distance, and those beyond it, the nearest of these first.
#[inline]
pub(super) fn split(
    corners: &mut [ClipVertex],
    max_distance: f64,
) -> (&[ClipVertex], &[ClipVertex]) {
    let near = partition(corners, |corner| corner.distance <= max_distance);
    let (near, beyond) = corners.split_at_mut(near);
    beyond.sort_unstable_by(|a, b| a.distance.total_cmp(&b.distance));
    (near, beyond)
}

/// The wanted corners, in their order.
pub(super) fn keep(
    corners: &mut [ClipVertex],
    wanted: impl Fn(&ClipVertex) -> bool,
) -> &[ClipVertex] {
    let count = partition(corners, wanted);
    &corners[..count]
}

/// Brings the wanted corners to the front, in their order, and counts them.
#[inline]
fn partition(corners: &mut [ClipVertex], wanted: impl Fn(&ClipVertex) -> bool) -> usize {
    let mut count = 0;
    for i in 0..corners.len() {
        let is_wanted = wanted(&corners[i]);
        corners.swap(count, i);
        count += usize::from(is_wanted);
    }
    count
}

/// The corner where the faces are nearest or overlap most.
#[inline]
pub(super) fn deepest(corners: &[ClipVertex]) -> Option<&ClipVertex> {
    corners
        .iter()
        .min_by(|a, b| a.distance.total_cmp(&b.distance))
}

/// Corners that, with the contact at `first`, span a large area: the farthest from it, the
/// farthest from the line through both, and the farthest on its other side. None of them is
/// nearer than `same` to another.
pub(super) fn spread(
    corners: &[ClipVertex],
    first: DVec2,
    same: f64,
) -> impl Iterator<Item = &ClipVertex> {
    let mut chosen: [Option<&ClipVertex>; MAX_POINTS - 1] = [None; MAX_POINTS - 1];
    if let Some(far) = best(corners, same * same, |p| p.distance_squared(first)) {
        let line = far.at - first;
        // Areas over the line are heights times its length.
        let least = same * line.length();
        let left = best(corners, least, |p| line.perp_dot(p - first));
        let right = best(corners, least, |p| -line.perp_dot(p - first));
        chosen = [Some(far), left, right];
        // A patch on one side of the line: the last corner adds most area to the triangle.
        if let (Some(side), None) | (None, Some(side)) = (left, right) {
            let third = best(corners, least, |p| {
                added_area(p - first, line, side.at - first)
            });
            chosen = [Some(far), Some(side), third];
        }
    }
    chosen.into_iter().flatten()
}

/// Twice the area that `p` adds to the triangle of the origin, `a` and `b` beyond one of its two
/// edges at `b`.
#[inline]
fn added_area(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let beyond_ab = -(b - a).perp_dot(p - a);
    let beyond_bo = b.perp_dot(p);
    if a.perp_dot(b) > 0.0 {
        beyond_ab.max(beyond_bo)
    } else {
        -beyond_ab.min(beyond_bo)
    }
}

/// The corner with the greatest measure above `least`.
#[inline]
fn best(corners: &[ClipVertex], least: f64, measure: impl Fn(DVec2) -> f64) -> Option<&ClipVertex> {
    let mut best = None;
    let mut greatest = least;
    for corner in corners {
        let m = measure(corner.at);
        if m > greatest {
            greatest = m;
            best = Some(corner);
        }
    }
    best
}
