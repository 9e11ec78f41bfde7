//! Pairs whose distance from origin to origin shows that they are apart: most of those that the broad phase reports in
//! a heap. Only what a shape of parry's tells is read, and nothing is converted for the kernels.

use parry3d::math::{Pose, Real};
use parry3d::shape::{Shape, ShapeType, TypedShape};

use crate::pose::is_nearly_unit;
use crate::tolerance::PROOF_MARGIN;

/// Whether two shapes are certainly farther apart than the prediction. `false` if one of them is of a kind whose reach
/// is not known.
pub(crate) fn are_far_apart(pos12: &Pose, shapes: [&dyn Shape; 2], prediction: Real) -> bool {
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
    let (squared, border) = match shape.as_typed_shape() {
        TypedShape::Ball(ball) => (0.0, ball.radius),
        TypedShape::Capsule(capsule) => {
            let ends = [capsule.segment.a, capsule.segment.b];
            let [a, b] = ends.map(|end| end.as_dvec3().length_squared());
            (a.max(b), capsule.radius)
        }
        TypedShape::Cuboid(cuboid) => (cuboid.half_extents.as_dvec3().length_squared(), 0.0),
        TypedShape::RoundCuboid(round) => {
            let half_extents = round.inner_shape.half_extents.as_dvec3();
            (half_extents.length_squared(), round.border_radius)
        }
        TypedShape::Cylinder(solid) => (squares(solid.half_height, solid.radius), 0.0),
        TypedShape::Cone(solid) => (squares(solid.half_height, solid.radius), 0.0),
        TypedShape::RoundCylinder(round) => {
            let solid = &round.inner_shape;
            (
                squares(solid.half_height, solid.radius),
                round.border_radius,
            )
        }
        TypedShape::RoundCone(round) => {
            let solid = &round.inner_shape;
            (
                squares(solid.half_height, solid.radius),
                round.border_radius,
            )
        }
        _ => return None,
    };
    Some(squared.sqrt() + f64::from(border))
}

#[inline]
fn squares(a: Real, b: Real) -> f64 {
    let [a, b] = [a, b].map(f64::from);
    a * a + b * b
}
