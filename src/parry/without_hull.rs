//! Pairs without a hull: cylinders, cones and shapes of a user's own with other shapes, capsules and rounded polytopes
//! with each other and with sharp ones.

use parry3d::math::Real;
use parry3d::query::Unsupported;
use parry3d::shape::{HalfSpace as ParryHalfSpace, Shape, ShapeType};

use crate::curved::SurfacePieces;
use crate::map_pair::map_pair;
use crate::parry::capsules::update_capsules;
use crate::parry::convert::{self, Core, HalfSpace};
use crate::parry::core_pair::CorePair;
use crate::parry::custom::has_support_map;
use crate::parry::far_apart::is_answered_by_reach;
use crate::parry::manifold::UpdateManifold;
use crate::parry::operand::is_hull;
use crate::parry::order::PairOrder;
use crate::parry::pair::Pair;
use crate::parry::workspace::ThreadWorkspace;

/// Whether a shape is a cylinder or a cone, or may be curved since it is a user's own.
fn is_curved(shape: &dyn Shape) -> bool {
    use ShapeType::{Cone, Custom, Cylinder, RoundCone, RoundCylinder};
    let kind = shape.shape_type();
    matches!(kind, Cylinder | Cone | RoundCylinder | RoundCone)
        || kind == Custom && has_support_map(shape)
}

/// Whether a shape is a hull, curved or rounded: those whose pairs with parts of other shapes are ours.
pub(crate) fn makes_pair_ours(shape: &dyn Shape) -> bool {
    is_hull(shape) || is_curved(shape) || is_rounded(shape)
}

/// The same for pairs with triangles: on meshes the default's cuboids rarely rest.
pub(crate) fn makes_pair_with_triangle_ours(shape: &dyn Shape) -> bool {
    shape.shape_type() == ShapeType::Cuboid || makes_pair_ours(shape)
}

/// Whether a shape other than a hull is a polytope with a rounded border.
fn is_rounded(shape: &dyn Shape) -> bool {
    use ShapeType::{Capsule, RoundCuboid, RoundTriangle};
    matches!(shape.shape_type(), Capsule | RoundCuboid | RoundTriangle)
}

/// Brings a manifold up to date; pairs of other shapes are not supported.
pub(crate) fn update_without_hull(
    shapes: [&dyn Shape; 2],
    update: &mut UpdateManifold<'_>,
) -> Result<(), Unsupported> {
    use ShapeType::{Ball, Capsule, Cuboid, HalfSpace, Triangle};
    // The curved shape comes second in the kernels.
    if let Some(order) = PairOrder::with_second(shapes.map(is_curved)) {
        return update_cores(order, shapes, update);
    }
    let kinds = map_pair(shapes, |shape| shape.shape_type());
    let is_second = match kinds {
        [Triangle, Cuboid] | [Cuboid, Triangle] => kinds.map(|kind| kind == Cuboid),
        _ => shapes.map(is_rounded),
    };
    let order = PairOrder::with_second(is_second).ok_or(Unsupported)?;
    match kinds {
        [Capsule, Capsule] => update_capsules(update, shapes),
        // Closed forms of parry's.
        [Capsule, Ball | HalfSpace] | [Ball | HalfSpace, Capsule] => Err(Unsupported),
        _ => update_cores(order, shapes, update),
    }
}

fn update_cores(
    order: PairOrder,
    shapes: [&dyn Shape; 2],
    update: &mut UpdateManifold<'_>,
) -> Result<(), Unsupported> {
    let [first, second] = order.to_kernel(shapes);
    if let Some(half_space) = first.as_shape() {
        return update_on_half_space(order, half_space, second, update);
    }
    if is_answered_by_reach(shapes, update) {
        update.manifold.forget();
        return Ok(());
    }
    // One by one: as parts of a pair they would be copied.
    let first = Core::of(first);
    let second = Core::of(second);
    let (Some((first, border_1)), Some((second, border_2))) = (&first, &second) else {
        return Err(Unsupported);
    };
    let mut pair = CorePair {
        border_radii: [*border_1, *border_2].map(f64::from),
        order,
        update,
    };
    pair.update(first, second)
}

/// Parry's routine is exact for cylinders and cones without a border.
fn update_on_half_space(
    order: PairOrder,
    half_space: &ParryHalfSpace,
    solid: &dyn Shape,
    update: &mut UpdateManifold<'_>,
) -> Result<(), Unsupported> {
    let half_space = &convert::half_space(half_space).ok_or(Unsupported)?;
    match Core::of(solid) {
        Some((Core::Cylinder(solid), border)) if border > 0.0 => {
            on_half_space(order, half_space, (&solid, border), update)
        }
        Some((Core::Cone(solid), border)) if border > 0.0 => {
            on_half_space(order, half_space, (&solid, border), update)
        }
        Some((Core::Cuboid(solid), border)) => {
            on_half_space(order, half_space, (&solid, border), update)
        }
        Some((Core::Triangle(solid), border)) => {
            on_half_space(order, half_space, (&solid, border), update)
        }
        Some((Core::Custom(solid), border)) if !update.leaves_custom => {
            on_half_space(order, half_space, (&solid, border), update)
        }
        _ => Err(Unsupported),
    }
}

fn on_half_space(
    order: PairOrder,
    half_space: &HalfSpace,
    (solid, border): (&impl SurfacePieces, Real),
    update: &mut UpdateManifold<'_>,
) -> Result<(), Unsupported> {
    let pair = Pair {
        hull: half_space,
        other: solid,
        border_radii: [0.0, border.into()],
        order,
    };
    ThreadWorkspace::with(|thread| update.update_on_plane(&pair, &mut thread.workspace))
}
