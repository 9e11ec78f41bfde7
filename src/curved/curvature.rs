//! How the extreme point of the difference moves as the normal turns: along the tangents of rims.

use glam::DVec3;

use super::separation::NormalSeparation;
use super::surface_pieces::{CircularEdge, SurfacePieces};
use crate::support::Cso;
use crate::tolerance::SAME_NORMAL;

/// The derivative of the extreme point with respect to the unit normal, a symmetric matrix: the weighted sum
/// of `tangent ⊗ tangent` over the rims.
pub(super) struct Curvature([(DVec3, f64); 2]);

impl Curvature {
    /// `None` if a flat side is perpendicular to the normal.
    pub fn of<A: SurfacePieces, B: SurfacePieces>(
        cso: &Cso<'_, A, B>,
        at: &NormalSeparation,
    ) -> Option<Self> {
        let outward_2 = -cso.pose.direction_to_2(at.normal);
        let of_first = bend(cso.shape_1.rim(at.normal), at.normal)?;
        let (tangent, weight) = bend(cso.shape_2.rim(outward_2), outward_2)?;
        Some(Self([of_first, (cso.pose.direction_to_1(tangent), weight)]))
    }

    /// The rate at which the point moves along `b` as the normal turns along `a`.
    pub fn between(&self, a: DVec3, b: DVec3) -> f64 {
        let [first, second] = self
            .0
            .each_ref()
            .map(|(tangent, weight)| weight * tangent.dot(a) * tangent.dot(b));
        first + second
    }
}

/// The tangent of a rim at its extreme point, not normalised, and its weight.
fn bend(rim: Option<CircularEdge>, normal: DVec3) -> Option<(DVec3, f64)> {
    let Some(rim) = rim else {
        return Some((DVec3::ZERO, 0.0));
    };
    let tangent = rim.axis.cross(normal);
    let squared = tangent.length_squared();
    let is_tilted = squared > SAME_NORMAL * SAME_NORMAL;
    is_tilted.then(|| (tangent, rim.radius / (squared * squared.sqrt())))
}
