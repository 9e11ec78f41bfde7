//! Why a query about two shapes has no answer.

use parry3d::math::Pose;
use parry3d::shape::Shape;

use crate::parry::operand::is_hull;
use crate::parry::visit;
use crate::query::QueryError;
use crate::stats::Left;

#[cold]
pub(super) fn why_not(pos12: &Pose, shapes: [&dyn Shape; 2]) -> QueryError {
    if !shapes.into_iter().any(is_hull) {
        return QueryError::NoHull;
    }
    match visit::why_left(pos12, shapes) {
        Left::HullNotPrepared => QueryError::HullNotPrepared,
        Left::NotFinite => QueryError::NotFinite,
        _ => QueryError::OtherShape,
    }
}
