//! Where two capsules or ruled sides that cross, or lie side by side, have contacts beside the nearest place.
//!
//! One that lies across another, seen along the contact normal, can rock on it. It does so about an axis across the
//! direction between both lines, in which the gap widens least: as it were on a rocker whose radius is large against
//! theirs. A single contact would not hold it. So there is one on either side, where both lines are apart by a share of
//! the radii, or where one of them ends.

use glam::DVec3;

use crate::tuning::CROSSING_REACH;

/// A unit vector between the directions of two lines, seen along a normal. It leads where the first one does.
pub(crate) fn middle_direction([first, second]: [DVec3; 2], normal: DVec3) -> Option<DVec3> {
    let [first, second] = [first, second].map(|line| line.reject_from_normalized(normal));
    let (first, second) = (first.try_normalize()?, second.try_normalize()?);
    (first + second * first.dot(second).signum()).try_normalize()
}

/// The stretch that two lines share, from the places of their ends. It is empty if its end comes before its start.
pub(crate) fn common_stretch(ends: [[f64; 2]; 2]) -> [f64; 2] {
    let reach = ends.map(|[a, b]| [a.min(b), a.max(b)]);
    [reach[0][0].max(reach[1][0]), reach[0][1].min(reach[1][1])]
}

/// The part of a stretch from `low` to `high` along two lines in which both are near each other. `beside` tells by how
/// much the second line is beside the first one at a place, and `radii` the sum of the radii of the surfaces. The whole
/// stretch if they are near each other nowhere.
pub(crate) fn stretch_beside(
    [low, high]: [f64; 2],
    beside: impl Fn(f64) -> f64,
    radii: impl FnOnce(f64) -> f64,
) -> [f64; 2] {
    let [at_low, at_high] = [low, high].map(beside);
    let slope = (at_high - at_low) / (high - low);
    let crossing = low - at_low / slope;
    let way = CROSSING_REACH * radii(crossing.max(low).min(high)) / slope.abs();
    let near = [low.max(crossing - way), high.min(crossing + way)];
    // Of parallel lines, they are not numbers.
    if near[0] < near[1] { near } else { [low, high] }
}
