//! Pairs whose distance from origin to origin shows that they are apart: most of those that the broad phase reports in
//! a heap. Only what a shape of parry's tells is read, and nothing is converted for the kernels.

use parry3d::math::{Pose, Real, Vector};
use parry3d::shape::{Shape, ShapeType, TypedShape};

use crate::parry::manifold::UpdateManifold;
use crate::pose::is_nearly_unit;
use crate::stats::Stage;
use crate::tolerance::PROOF_MARGIN;

/// Whether two shapes are seen to be far apart, which is counted as an answer.
pub(crate) fn is_answered_by_reach(shapes: [&dyn Shape; 2], update: &UpdateManifold<'_>) -> bool {
    // Of shapes in contact, few are far apart in the next step.
    let is_answered =
        update.manifold.is_empty() && are_far_apart(update.pos12, shapes, update.prediction);
    if is_answered {
        update.stats.record_free(Stage::BoundingSpheres);
    }
    is_answered
}

/// Whether two shapes are certainly farther apart than the prediction. `false` if one of them is of a kind whose reach
/// is not known.
fn are_far_apart(pos12: &Pose, shapes: [&dyn Shape; 2], prediction: Real) -> bool {
    let (Some(first), Some(second)) = (reach(shapes[0]), reach(shapes[1])) else {
        return false;
    };
    let least = (first + second + f64::from(prediction)) / PROOF_MARGIN;
    least >= 0.0
        && pos12.translation.as_dvec3().length_squared() > least * least
        // Another quaternion would scale the second shape.
        && is_nearly_unit(pos12.rotation)
}

/// How far a shape reaches from the origin of its frame, at most.
#[inline]
fn reach(shape: &dyn Shape) -> Option<f64> {
    // The typed shape of a user's own shape may only be similar.
    if shape.shape_type() == ShapeType::Custom {
        return None;
    }
    let on_rim = |half_height: Real, radius: Real| Vector::new(radius, half_height, 0.0);
    let (corner, border) = match shape.as_typed_shape() {
        TypedShape::Ball(ball) => (Vector::ZERO, ball.radius),
        TypedShape::Capsule(capsule) => {
            let [a, b] = [capsule.segment.a, capsule.segment.b];
            let [from_a, from_b] = [a, b].map(|end| end.as_dvec3().length_squared());
            (if from_a > from_b { a } else { b }, capsule.radius)
        }
        TypedShape::Cuboid(cuboid) => (cuboid.half_extents, 0.0),
        TypedShape::RoundCuboid(round) => (round.inner_shape.half_extents, round.border_radius),
        TypedShape::Cylinder(solid) => (on_rim(solid.half_height, solid.radius), 0.0),
        TypedShape::Cone(solid) => (on_rim(solid.half_height, solid.radius), 0.0),
        TypedShape::RoundCylinder(round) => {
            let solid = &round.inner_shape;
            (on_rim(solid.half_height, solid.radius), round.border_radius)
        }
        TypedShape::RoundCone(round) => {
            let solid = &round.inner_shape;
            (on_rim(solid.half_height, solid.radius), round.border_radius)
        }
        _ => return None,
    };
    Some(corner.as_dvec3().length() + f64::from(border))
}
