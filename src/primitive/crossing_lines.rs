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

/// The part of a stretch from `low` to `high` along two lines in which both are near each other. At its ends the second
/// line is `beside` the first one by so much. `radii` gives the sum of the radii of the surfaces at a place. The whole
/// stretch if they are near each other nowhere.
pub(crate) fn stretch_beside(
    [low, high]: [f64; 2],
    beside: [f64; 2],
    radii: impl FnOnce(f64) -> f64,
) -> [f64; 2] {
    let slope = (beside[1] - beside[0]) / (high - low);
    let crossing = low - beside[0] / slope;
    let way = CROSSING_REACH * radii(crossing.max(low).min(high)) / slope.abs();
    let near = [low.max(crossing - way), high.min(crossing + way)];
    // Of parallel lines, they are not numbers.
    if near[0] < near[1] { near } else { [low, high] }
}
