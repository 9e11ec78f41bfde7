//! Proofs of a depth by how much the surfaces bend: where rims cross.

use glam::DVec3;

use super::separation::NormalSeparation;
use super::surface_pieces::SurfacePieces;
use crate::support::Cso;

/// Whether no direction has a smaller depth than a normal, up to `tolerance`: because of the discs in both rims on which
/// the extreme points lie (T18).
pub(super) fn prove_depth<A: SurfacePieces, B: SurfacePieces>(
    cso: &Cso<'_, A, B>,
    at: &NormalSeparation,
    tolerance: f64,
) -> bool {
    let depth = -at.distance;
    let beside = (at.extreme.w - at.normal * depth).length();
    // Most normals miss by far: they are those of flat and ruled sides.
    if depth < 0.0 || beside > tolerance {
        return false;
    }
    let outward_2 = -cso.pose.direction_to_2(at.normal);
    let (Some(first), Some(second)) = (cso.shape_1.rim(at.normal), cso.shape_2.rim(outward_2))
    else {
        return false;
    };
    let axis_2 = cso.pose.direction_to_1(second.axis);
    let discs = [(first.axis, first.radius), (axis_2, second.radius)];
    2.0 * (depth - least_bend(at.normal, discs)).max(0.0) + beside <= tolerance
}

/// The least radius of curvature of the sum of two discs, each with its axis and its radius, over all great circles
/// through a normal: the smaller eigenvalue of the sum of `radius * axis ⊗ axis`, seen along the normal.
fn least_bend(normal: DVec3, discs: [(DVec3, f64); 2]) -> f64 {
    let [(a, r), (b, s)] =
        discs.map(|(axis, radius)| (axis.reject_from_normalized(normal), radius));
    let trace = r * a.length_squared() + s * b.length_squared();
    let area = a.cross(b).dot(normal);
    let determinant = r * s * area * area;
    // Without cancellation.
    let greater = trace + (trace * trace - 4.0 * determinant).max(0.0).sqrt();
    2.0 * determinant / greater.max(f64::MIN_POSITIVE)
}
