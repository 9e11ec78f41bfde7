//! Pairs without a hull: cylinders, cones and shapes of a user's own with other shapes, and two capsules.

use parry3d::math::Real;
use parry3d::query::Unsupported;
use parry3d::shape::{HalfSpace as ParryHalfSpace, Shape, ShapeType};

use crate::curved::SurfacePieces;
use crate::parry::balls::update_ball;
use crate::parry::capsules::update_capsules;
use crate::parry::convert::{self, Core, HalfSpace};
use crate::parry::custom::has_support_map;
use crate::parry::far_apart::are_far_apart;
use crate::parry::manifold::UpdateManifold;
use crate::parry::operand::is_hull;
use crate::parry::order::PairOrder;
use crate::parry::pair::Pair;
use crate::parry::workspace::ThreadWorkspace;
use crate::primitive::Revolved;
use crate::stats::Stage;

/// Whether a shape is a cylinder or a cone, or may be curved since it is a user's own.
fn is_curved(shape: &dyn Shape) -> bool {
    use ShapeType::{Cone, Custom, Cylinder, RoundCone, RoundCylinder};
    let kind = shape.shape_type();
    matches!(kind, Cylinder | Cone | RoundCylinder | RoundCone)
        || kind == Custom && has_support_map(shape)
}

/// Whether a shape is a hull or may be curved: those of which one makes a pair ours.
pub(crate) fn is_hull_or_curved(shape: &dyn Shape) -> bool {
    is_hull(shape) || is_curved(shape)
}

/// Brings a manifold up to date; pairs of other shapes are not supported.
pub(crate) fn update_without_hull(
    shapes: [&dyn Shape; 2],
    update: &mut UpdateManifold<'_>,
) -> Result<(), Unsupported> {
    // The curved shape comes second in the kernels.
    match PairOrder::with_second(shapes.map(is_curved)) {
        Some(order) => update_curved(order, shapes, update),
        None => update_capsules(
            update.pos12,
            shapes,
            update.prediction,
            &mut update.manifold,
        ),
    }
}

fn update_curved(
    order: PairOrder,
    shapes: [&dyn Shape; 2],
    update: &mut UpdateManifold<'_>,
) -> Result<(), Unsupported> {
    let [first, second] = order.to_kernel(shapes);
    if let Some(half_space) = first.as_shape() {
        return update_on_half_space(order, half_space, second, update);
    }
    if are_far_apart(update.pos12, shapes, update.prediction) {
        update.manifold.forget();
        update.stats.record_free(Stage::BoundingSpheres);
        return Ok(());
    }
    // One by one: as parts of a pair they would be copied.
    let first = Core::of(first);
    let second = Core::of(second);
    let (Some((first, border_1)), Some((second, border_2))) = (&first, &second) else {
        return Err(Unsupported);
    };
    let mut pair = PairUpdate {
        border_radii: [*border_1, *border_2].map(f64::from),
        order,
        update,
    };
    match second {
        Core::Cylinder(second) => pair.with(first, second),
        Core::Cone(second) => pair.with(first, second),
        Core::Custom(second) => pair.with_custom(first, second),
        _ => Err(Unsupported),
    }
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

/// The rest of an update, for cores whose types are known.
struct PairUpdate<'u, 'a> {
    border_radii: [f64; 2],
    order: PairOrder,
    update: &'u mut UpdateManifold<'a>,
}

impl PairUpdate<'_, '_> {
    fn with(
        &mut self,
        first: &Core,
        second: &(impl SurfacePieces + Revolved),
    ) -> Result<(), Unsupported> {
        match first {
            Core::Ball(_) => update_ball(second, self.border_radii, self.order, self.update),
            Core::Segment(first) => self.with_both(first, second),
            Core::Triangle(first) => self.with_both(first, second),
            Core::Cuboid(first) => self.with_both(first, second),
            Core::Cylinder(first) => self.with_both(first, second),
            Core::Cone(first) => self.with_both(first, second),
            Core::Custom(_) => self.with_custom(first, second),
        }
    }

    /// One of the shapes is a user's own.
    #[cold]
    fn with_custom(
        &mut self,
        first: &Core<'_>,
        second: &impl SurfacePieces,
    ) -> Result<(), Unsupported> {
        if self.update.leaves_custom {
            return Err(Unsupported);
        }
        self.with_both(first, second)
    }

    fn with_both(
        &mut self,
        first: &impl SurfacePieces,
        second: &impl SurfacePieces,
    ) -> Result<(), Unsupported> {
        let pair = Pair {
            hull: first,
            other: second,
            border_radii: self.border_radii,
            order: self.order,
        };
        ThreadWorkspace::with(|thread| self.update.update_curved(&pair, &mut thread.workspace))
    }
}
