//! From parry's shapes to the visitor of their pair: finds the hull, and the kind of the other shape.

use parry3d::math::{Pose, Real};
use parry3d::query::Unsupported;
use parry3d::shape::Shape;

use crate::map_pair::map_pair;
use crate::parry::convert::{self, Core};
use crate::parry::hull_cache::HullCache;
use crate::parry::hull_cache::epoch::Epoch;
use crate::parry::operand::{Operand, PreparedOperand};
use crate::parry::order::PairOrder;
use crate::parry::pair::{Pair, PairVisitor};
use crate::parry::workspace::{ThreadWorkspace, Workspace};
use crate::pose::ValidPose;
use crate::stats::Left;

/// Visits a pair of a hull and a shape that the kernels know.
#[inline]
pub(crate) fn shapes<V: PairVisitor>(
    shape_1: &dyn Shape,
    shape_2: &dyn Shape,
    mut visitor: V,
) -> Result<V::Answer, Unsupported> {
    let both = map_pair([shape_1, shape_2], Operand::new);
    operands(&both, Epoch::of_pair(), &mut visitor)
}

/// Like [`shapes`], for shapes that do not change during `epoch`.
// perf: in a call the operands would go through memory, which pairs that are apart notice.
#[inline(always)]
pub(crate) fn operands<V: PairVisitor>(
    [operand_1, operand_2]: &[Operand<'_>; 2],
    epoch: Epoch,
    visitor: &mut V,
) -> Result<V::Answer, Unsupported> {
    let are_hulls = [operand_1.is_hull(), operand_2.is_hull()];
    let order = PairOrder::with_first(are_hulls).ok_or(Unsupported)?;
    let hull = |operand| HullOperand {
        operand,
        epoch,
        order,
    };
    match are_hulls {
        [true, true] => ThreadWorkspace::with(
            |ThreadWorkspace {
                 hulls, workspace, ..
             }| {
                hulls.begin();
                let known = [operand_1.known(hulls, epoch), operand_2.known(hulls, epoch)];
                let [first, second] = match known {
                    [Some(first), Some(second)] => [first, second],
                    _ => prepare([operand_1, operand_2], hulls, epoch).ok_or(Unsupported)?,
                };
                let pair = Pair {
                    hull: first.hull,
                    other: second.hull,
                    border_radii: [first.border_radius, second.border_radius],
                    order,
                };
                visitor.visit(&pair, workspace)
            },
        ),
        [true, false] => hull(operand_1).visit(operand_2.shape, visitor),
        [false, _] => hull(operand_2).visit(operand_1.shape, visitor),
    }
}

/// The hulls of those operands that are hulls. New ones are prepared.
#[inline(never)]
fn prepare<'a>(
    [operand_1, operand_2]: [&Operand<'a>; 2],
    hulls: &'a mut HullCache,
    epoch: Epoch,
) -> Option<[PreparedOperand<'a>; 2]> {
    let first = operand_1.prepare(hulls, epoch)?;
    let second = operand_2.prepare(hulls, epoch)?;
    Some([first.hull(hulls)?, second.hull(hulls)?])
}

/// The same for one operand.
#[inline(never)]
fn prepare_one<'a>(
    operand: &Operand<'a>,
    hulls: &'a mut HullCache,
    epoch: Epoch,
) -> Option<PreparedOperand<'a>> {
    operand.prepare(hulls, epoch)?.hull(hulls)
}

/// Why a pair with a hull is left to the fallback.
#[cold]
pub(crate) fn why_left(pos12: &Pose, shapes: [&dyn Shape; 2]) -> Left {
    if ValidPose::new(pos12).is_none() {
        return Left::NotFinite;
    }
    let is_prepared = |shape| {
        let operand = Operand::new(shape);
        let is_found = |thread: &mut ThreadWorkspace| {
            operand
                .prepare(&mut thread.hulls, Epoch::of_pair())
                .is_some()
        };
        !operand.is_hull() || ThreadWorkspace::with(is_found)
    };
    if shapes.into_iter().all(is_prepared) {
        Left::OtherShape
    } else {
        Left::HullNotPrepared
    }
}

/// A hull and its position in the pair. It is looked up only once the other shape is known.
struct HullOperand<'a> {
    operand: &'a Operand<'a>,
    epoch: Epoch,
    order: PairOrder,
}

impl HullOperand<'_> {
    /// Visits the hull and another shape, if that is of a known kind and neither too flat nor too small.
    #[inline(never)]
    fn visit<V: PairVisitor>(
        &self,
        other: &dyn Shape,
        visitor: &mut V,
    ) -> Result<V::Answer, Unsupported> {
        if let Some(half_space) = other.as_shape() {
            let half_space = convert::half_space(half_space).ok_or(Unsupported)?;
            return self.with(&half_space, 0.0, visitor, V::visit_half_space);
        }
        let (core, border) = Core::of(other).ok_or(Unsupported)?;
        match &core {
            Core::Ball(core) => self.with(core, border, visitor, V::visit),
            Core::Segment(core) => self.with(core, border, visitor, V::visit),
            Core::Triangle(core) => self.with(core, border, visitor, V::visit),
            Core::Cuboid(core) => self.with(core, border, visitor, V::visit),
            Core::Cylinder(core) => self.with(core, border, visitor, V::visit_curved),
            Core::Cone(core) => self.with(core, border, visitor, V::visit_curved),
            Core::Custom(_) if visitor.leaves_custom() => Err(Unsupported),
            Core::Custom(core) => self.with(core, border, visitor, V::visit_curved),
        }
    }

    /// Calls one of the visitor's methods with the hull and the other shape.
    #[inline]
    fn with<V, B, T>(
        &self,
        other: &B,
        border_radius: Real,
        visitor: &mut V,
        visit: impl FnOnce(&mut V, &Pair<'_, B>, &mut Workspace) -> Result<T, Unsupported>,
    ) -> Result<T, Unsupported> {
        ThreadWorkspace::with(
            |ThreadWorkspace {
                 hulls, workspace, ..
             }| {
                hulls.begin();
                let prepared = match self.operand.known(hulls, self.epoch) {
                    Some(known) => known,
                    None => prepare_one(self.operand, hulls, self.epoch).ok_or(Unsupported)?,
                };
                let pair = Pair {
                    hull: prepared.hull,
                    other,
                    border_radii: [prepared.border_radius, border_radius.into()],
                    order: self.order,
                };
                visit(visitor, &pair, workspace)
            },
        )
    }
}
