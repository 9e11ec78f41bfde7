//! Geometry shared by cylinders and cones: rotationally symmetric about the y axis, with discs at their ends.

use glam::DVec3;

use super::piece::{FlatSide, Outline};
use super::surface_pieces::BorderPlace;
use crate::tuning::SMALL_TURN;

/// The disc at an end, with the outward normal along the axis.
pub(super) fn end(normal: DVec3, offset: f64, radius: f64) -> FlatSide {
    FlatSide {
        normal,
        offset,
        outline: Outline::Disc {
            center: normal * offset,
            radius,
        },
    }
}

/// The distance of a point in the plane of an end from its rim, positive inside.
pub(super) fn inset_of_end(p: DVec3, radius: f64) -> f64 {
    radius - p.with_y(0.0).length()
}

/// Whether a unit vector is nearly parallel to the axis.
pub(super) fn is_along_axis(dir: DVec3) -> bool {
    dir.with_y(0.0).length_squared() < SMALL_TURN * SMALL_TURN
}

/// The projection of `near` along the axis onto the end at `height`, if it lies within the rim.
pub(super) fn point_on_end(near: DVec3, height: f64, radius: f64) -> Option<DVec3> {
    let from_axis = near.with_y(0.0);
    let is_on_it = from_axis.length_squared() <= radius * radius;
    is_on_it.then(|| from_axis.with_y(height))
}

/// The point of a circle around the axis that is extreme along `dir`.
pub(super) fn point_on_circle(dir: DVec3, height: f64, radius: f64) -> DVec3 {
    let across = dir.with_y(0.0);
    (across * (radius / across.length_squared().sqrt())).with_y(height)
}

/// The point of a rim at a height that is nearest to a point, unless that is on the axis.
pub(super) fn rim_near(near: DVec3, height: f64, radius: f64) -> Option<BorderPlace> {
    let across = near.with_y(0.0).try_normalize()?;
    Some(BorderPlace {
        at: (across * radius).with_y(height),
        along: DVec3::new(across.z, 0.0, -across.x),
    })
}

/// The squared length of the part of `v` that turns a point about the axis. `across` leads to the point.
pub(super) fn around_axis(across: DVec3, v: DVec3) -> f64 {
    let turn = across.x * v.z - across.z * v.x;
    turn * turn / across.length_squared()
}
