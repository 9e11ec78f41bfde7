//! Which corners of the contact patch to keep.

use glam::DVec2;

use super::MAX_POINTS;
use super::clip::ClipVertex;

/// The corners of the previous frame stay while they span this share of what others could. Between
/// the corners of a many-sided face nothing else decides, and rounding would choose anew in every
/// frame; a smaller share would leave bodies standing on one side of their faces.
const ENOUGH: f64 = 0.95;

/// The corners kept beside the first contact.
type Chosen<'c> = [Option<&'c ClipVertex>; MAX_POINTS - 1];

/// Notes which corners were there before, where there is a choice.
pub(super) fn mark(corners: &mut [ClipVertex], was_there: impl Fn(&ClipVertex) -> bool) {
    if corners.len() > MAX_POINTS {
        for corner in corners {
            corner.was_there = was_there(corner);
        }
    }
}

/// The corners up to a distance, and those beyond it, the nearest of these first.
pub(super) fn split(
    corners: &mut [ClipVertex],
    max_distance: f64,
) -> (&mut [ClipVertex], &[ClipVertex]) {
    let mut near = 0;
    for i in 0..corners.len() {
        if corners[i].distance <= max_distance {
            corners.swap(near, i);
            near += 1;
        }
    }
    let (near, beyond) = corners.split_at_mut(near);
    beyond.sort_unstable_by(|a, b| a.distance.total_cmp(&b.distance));
    (near, beyond)
}

/// The corner where the surfaces are nearest or overlap most; of those as deep up to `slack`, one
/// that was there before.
pub(super) fn deepest(corners: &[ClipVertex], slack: f64) -> Option<&ClipVertex> {
    let by_distance = |a: &&ClipVertex, b: &&ClipVertex| a.distance.total_cmp(&b.distance);
    let deepest = corners.iter().min_by(by_distance)?;
    let as_deep = |corner: &&ClipVertex| corner.distance <= deepest.distance + slack;
    let before = corners.iter().filter(|corner| corner.was_there);
    before.filter(as_deep).min_by(by_distance).or(Some(deepest))
}

/// Corners that, with the contact at `first`, span a large area, none of them nearer than `same`
/// to `first`: those that were there before, if they span enough.
pub(super) fn choose(
    corners: &[ClipVertex],
    first: DVec2,
    same: f64,
) -> impl Iterator<Item = &ClipVertex> {
    let widest = spread(corners, first, same);
    let before = before(corners, first, same);
    let keep = before[0].is_some() && area(first, &before) >= ENOUGH * area(first, &widest);
    let chosen = if keep { before } else { widest };
    chosen.into_iter().flatten()
}

/// The corners of the previous frame. If `first` is none of them, it takes the place of the
/// nearest.
fn before(corners: &[ClipVertex], first: DVec2, same: f64) -> Chosen<'_> {
    let mut found = [None; MAX_POINTS];
    let others = corners
        .iter()
        .filter(|corner| corner.was_there && corner.at.distance_squared(first) > same * same);
    for (found, corner) in found.iter_mut().zip(others) {
        *found = Some(corner);
    }
    if let [Some(_), Some(_), Some(_), Some(_)] = found {
        let away = |corner: &Option<&ClipVertex>| {
            corner.map_or(f64::INFINITY, |corner| corner.at.distance_squared(first))
        };
        found.sort_unstable_by(|a, b| away(b).total_cmp(&away(a)));
    }
    [found[0], found[1], found[2]]
}

/// Twice the area that corners of a convex polygon span: the product of its diagonals, which are
/// the pair with the largest.
fn area(first: DVec2, chosen: &Chosen<'_>) -> f64 {
    let [a, b, c] = chosen.map(|corner| corner.map_or(first, |corner| corner.at));
    let product = |p: DVec2, q: DVec2, r: DVec2| (p - first).perp_dot(r - q).abs();
    product(a, b, c).max(product(b, a, c)).max(product(c, a, b))
}

/// The farthest corner from `first`, the farthest from the line through both, and the farthest on
/// its other side. None of them is nearer than `same` to another.
fn spread(corners: &[ClipVertex], first: DVec2, same: f64) -> Chosen<'_> {
    let Some(far) = best(corners, same * same, |p| p.distance_squared(first)) else {
        return [None; MAX_POINTS - 1];
    };
    let line = far.at - first;
    // Areas over the line are heights times its length.
    let least = same * line.length();
    let left = best(corners, least, |p| line.perp_dot(p - first));
    let right = best(corners, least, |p| -line.perp_dot(p - first));
    let ((Some(side), None) | (None, Some(side))) = (left, right) else {
        return [Some(far), left, right];
    };
    // A patch on one side of the line: the last corner adds most area to the triangle.
    let third = best(corners, least, |p| {
        added_area(p - first, line, side.at - first)
    });
    [Some(far), Some(side), third]
}

/// Twice the area that `p` adds to the triangle of the origin, `a` and `b` beyond one of its two
/// edges at `b`.
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
