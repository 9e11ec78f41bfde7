//! A pair that is judged and recorded.

use parry3d::math::{Pose, Real};
use parry3d::query::ContactManifold;
use parry3d::shape::Shape;

/// A pair, by reference.
pub(crate) struct PairView<'a> {
    pub shapes: [&'a dyn Shape; 2],
    pub pos12: &'a Pose,
    pub prediction: Real,
    pub has_corrected_normals: bool,
    pub before: &'a ContactManifold<(), ()>,
    pub after: &'a ContactManifold<(), ()>,
}
