//! Two boxes, whose depth all separating axes prove together.

use crate::support::{Cso, Polytope};

/// Whether the shapes are known to be boxes, and no direction has a smaller depth.
#[inline]
pub(super) fn are_deep_boxes<P: Polytope, Q: Polytope>(cso: &Cso<'_, P, Q>, depth: f64) -> bool {
    match (cso.shape_1.oriented_box(), cso.shape_2.oriented_box()) {
        (Some(first), Some(second)) => first.overlap_by(second, cso.pose, depth, cso.size()),
        _ => false,
    }
}
