//! Contacts on round surfaces stay below the body's axis while it rolls, and do not turn with it.

use glam::{DVec2, DVec3};

use crate::tuning::{ROLLING, SMALL_TURN};

/// Whether unit vectors turn by more than a body at rest does.
#[inline]
pub(crate) fn turns(from: DVec3, to: DVec3) -> bool {
    from.cross(to).length_squared() > ROLLING * ROLLING
}

/// The same about an axis of any length, by their parts across it. Vectors along the axis do not turn about it.
#[inline]
pub(super) fn turns_about(axis: DVec3, from: DVec3, to: DVec3) -> bool {
    let Some(axis) = axis.try_normalize() else {
        return turns(from, to);
    };
    let across = [from, to].map(|v| v.reject_from_normalized(axis));
    let squares = across.map(|v| v.length_squared());
    turns_across(axis.dot(across[0].cross(across[1])), squares)
}

/// The same about the y axis.
#[inline]
pub(super) fn turns_about_y(from: DVec3, to: DVec3) -> bool {
    let (from, to) = (DVec2::new(from.z, from.x), DVec2::new(to.z, to.x));
    turns_across(
        from.perp_dot(to),
        [from.length_squared(), to.length_squared()],
    )
}

/// The angle by which unit vectors turn about an axis of unit length, by their parts across it. `None` if one of them is
/// nearly along the axis.
pub(crate) fn turn_about(axis: DVec3, from: DVec3, to: DVec3) -> Option<f64> {
    let [from, to] = [from, to].map(|v| v.reject_from_normalized(axis));
    let least = from.length_squared().min(to.length_squared());
    (least > SMALL_TURN * SMALL_TURN).then(|| axis.dot(from.cross(to)).atan2(from.dot(to)))
}

/// Whether two vectors in a plane turn, from their cross product and their squares.
#[inline]
fn turns_across(turn: f64, [a, b]: [f64; 2]) -> bool {
    let least = SMALL_TURN * SMALL_TURN;
    a > least && b > least && turn * turn > ROLLING * ROLLING * a * b
}
