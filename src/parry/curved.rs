//! Pairs without a hull: cylinders and cones with other shapes, and two capsules.

use parry3d::math::Real;
use parry3d::query::Unsupported;
use parry3d::shape::{Shape, ShapeType, TypedShape};

use crate::curved::Body;
use crate::parry::capsules::update_capsules;
use crate::parry::convert::{self, CurvedShape};
use crate::parry::manifold::{CurvedPair, UpdateManifold};
use crate::parry::order::PairOrder;
use crate::parry::workspace::ThreadWorkspace;

/// Whether a shape is a cylinder or a cone.
pub(crate) fn is_curved(shape: &dyn Shape) -> bool {
    use ShapeType::{Cone, Cylinder, RoundCone, RoundCylinder};
    matches!(
        shape.shape_type(),
        Cylinder | Cone | RoundCylinder | RoundCone
    )
}

/// Brings a manifold up to date; pairs of other shapes are not supported.
pub(crate) fn update_without_hull<M: Default, C: Default + Copy>(
    [shape_1, shape_2]: [&dyn Shape; 2],
    update: UpdateManifold<'_, M, C>,
) -> Result<(), Unsupported> {
    let (order, curved, other) = match [is_curved(shape_1), is_curved(shape_2)] {
        [_, true] => (PairOrder::Given, shape_2, shape_1),
        [true, false] => (PairOrder::Reversed, shape_1, shape_2),
        [false, false] => {
            let shapes = [shape_1, shape_2];
            return update_capsules(update.pos12, shapes, update.prediction, update.manifold);
        }
    };
    let mut pair = CurvedSecond { order, update };
    match curved.as_typed_shape() {
        TypedShape::Cylinder(cylinder) => pair.first(other, cylinder, 0.0),
        TypedShape::RoundCylinder(round) => {
            pair.first(other, &round.inner_shape, round.border_radius)
        }
        TypedShape::Cone(cone) => pair.first(other, cone, 0.0),
        TypedShape::RoundCone(round) => pair.first(other, &round.inner_shape, round.border_radius),
        _ => Err(Unsupported),
    }
}

/// A pair whose curved shape comes second in the kernels.
struct CurvedSecond<'a, M, C> {
    order: PairOrder,
    update: UpdateManifold<'a, M, C>,
}

impl<M: Default, C: Default + Copy> CurvedSecond<'_, M, C> {
    fn first(
        &mut self,
        first: &dyn Shape,
        second: &impl CurvedShape,
        border_radius: Real,
    ) -> Result<(), Unsupported> {
        let second = second.kernel().ok_or(Unsupported)?;
        let second = (&second, border_radius);
        match first.as_typed_shape() {
            TypedShape::Cuboid(cuboid) => self.both(convert::cuboid(cuboid), 0.0, second),
            TypedShape::RoundCuboid(round) => self.both(
                convert::cuboid(&round.inner_shape),
                round.border_radius,
                second,
            ),
            TypedShape::Triangle(triangle) => self.both(convert::triangle(triangle), 0.0, second),
            TypedShape::RoundTriangle(round) => self.both(
                convert::triangle(&round.inner_shape),
                round.border_radius,
                second,
            ),
            TypedShape::Capsule(capsule) => {
                let core = convert::segment(&capsule.segment, capsule.radius);
                self.both(core, capsule.radius, second)
            }
            TypedShape::Segment(segment) => self.both(convert::segment(segment, 0.0), 0.0, second),
            TypedShape::Cylinder(cylinder) => self.both(cylinder.kernel(), 0.0, second),
            TypedShape::RoundCylinder(round) => {
                self.both(round.inner_shape.kernel(), round.border_radius, second)
            }
            TypedShape::Cone(cone) => self.both(cone.kernel(), 0.0, second),
            TypedShape::RoundCone(round) => {
                self.both(round.inner_shape.kernel(), round.border_radius, second)
            }
            _ => Err(Unsupported),
        }
    }

    fn both<A: Body, B: Body>(
        &mut self,
        first: Option<A>,
        border_radius: Real,
        (second, second_border): (&B, Real),
    ) -> Result<(), Unsupported> {
        let first = first.ok_or(Unsupported)?;
        let pair = CurvedPair {
            shapes: (&first, second),
            border_radii: [border_radius.into(), second_border.into()],
            order: self.order,
        };
        ThreadWorkspace::with(|thread| {
            self.update
                .update_curved(&pair, &mut thread.workspace.curved)
        })
    }
}
