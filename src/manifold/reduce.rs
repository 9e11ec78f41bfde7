//! Which corners of the contact patch to keep.

use glam::DVec2;

use super::MAX_POINTS;
use super::clip::ClipVertex;

/// The corner where the faces are nearest or overlap most.
pub(super) fn deepest(corners: &[ClipVertex]) -> Option<&ClipVertex> {
    corners
        .iter()
        .min_by(|a, b| a.distance().total_cmp(&b.distance()))
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
    if let Some(far) = best(corners, same, |p| p.distance(first)) {
        let line = far.at - first;
        let along = line.normalize_or_zero();
        let left = best(corners, same, |p| along.perp_dot(p - first));
        let right = best(corners, same, |p| -along.perp_dot(p - first));
        chosen = [Some(far), left, right];
        // A patch on one side of the line: the last corner is farthest beyond the triangle.
        if let (Some(side), None) | (None, Some(side)) = (left, right) {
            let third = best(corners, same, |p| beyond(p - first, line, side.at - first));
            chosen = [Some(far), Some(side), third];
        }
    }
    chosen.into_iter().flatten()
}

/// How far `p` lies outside of the triangle of the origin, `a` and `b`, beyond its two edges at
/// `b`.
fn beyond(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let outside = |from: DVec2, to: DVec2| {
        let edge = (to - from).normalize_or_zero();
        -edge.perp_dot(p - from)
    };
    if a.perp_dot(b) > 0.0 {
        outside(a, b).max(outside(b, DVec2::ZERO))
    } else {
        outside(b, a).max(outside(DVec2::ZERO, b))
    }
}

/// The corner with the greatest measure above `least`.
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
