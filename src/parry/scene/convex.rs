//! Convex shapes without a hull, for queries without memory.

use parry3d::query::Unsupported;
use parry3d::shape::{Shape, ShapeType};

use crate::map_pair::map_pair;
use crate::parry::convert::Core;
use crate::parry::order::PairOrder;
use crate::parry::pair::Pair;
use crate::parry::workspace::{ThreadWorkspace, Workspace};

/// Hands two convex shapes without a hull to `answer`, if both are known.
pub(super) fn visit<T>(
    shapes: [&dyn Shape; 2],
    answer: impl FnOnce(&Pair<'_, Core<'_>, Core<'_>>, &mut Workspace) -> Result<T, Unsupported>,
) -> Result<T, Unsupported> {
    let cores = map_pair(shapes, Core::of);
    let [Some((first, border_1)), Some((second, border_2))] = &cores else {
        return Err(Unsupported);
    };
    let pair = Pair {
        hull: first,
        other: second,
        border_radii: [*border_1, *border_2].map(f64::from),
        order: PairOrder::default(),
    };
    ThreadWorkspace::with(|thread| answer(&pair, &mut thread.workspace))
}

/// As [`visit`], but for balls with shapes on whose surface parry projects their centre: that is exact, and
/// cheaper.
pub(super) fn visit_inexact<T>(
    shapes: [&dyn Shape; 2],
    answer: impl FnOnce(&Pair<'_, Core<'_>, Core<'_>>, &mut Workspace) -> Result<T, Unsupported>,
) -> Result<T, Unsupported> {
    let kinds = shapes.map(|shape| shape.shape_type());
    let is_ours = |kind: &ShapeType| {
        use ShapeType::{Custom, RoundCone, RoundCuboid, RoundCylinder, RoundTriangle};
        matches!(
            kind,
            RoundCone | RoundCuboid | RoundCylinder | RoundTriangle | Custom
        )
    };
    if kinds.contains(&ShapeType::Ball) && !kinds.iter().any(is_ours) {
        return Err(Unsupported);
    }
    visit(shapes, answer)
}
