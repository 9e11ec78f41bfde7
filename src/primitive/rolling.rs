//! Contacts on round surfaces stay below the body's axis while it rolls, and do not turn with it.

use glam::DVec3;

use crate::tuning::{ROLLING, SMALL_TURN};

/// Whether unit vectors turn by more than a body at rest does.
#[inline]
pub(super) fn turns(from: DVec3, to: DVec3) -> bool {
    from.cross(to).length_squared() > ROLLING * ROLLING
}

/// The same about an axis of any length, by their parts across it. Vectors along the axis do not turn about it.
#[inline]
pub(super) fn turns_about(axis: DVec3, from: DVec3, to: DVec3) -> bool {
    let Some(axis) = axis.try_normalize() else {
        return turns(from, to);
    };
    let across = [from, to].map(|v| v.reject_from_normalized(axis));
    let [a, b] = across.map(|v| v.length_squared());
    let turn = axis.dot(across[0].cross(across[1]));
    let least = SMALL_TURN * SMALL_TURN;
    a > least && b > least && turn * turn > ROLLING * ROLLING * a * b
}
