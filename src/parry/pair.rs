//! Converts parry's shapes to polytopes for the kernels.

use parry3d::math::{Pose, Real};
use parry3d::query::Unsupported;
use parry3d::shape::{Shape, ShapeType, TypedShape};

use crate::curved::Body;
use crate::hull::Hull;
use crate::map_pair::map_pair;
use crate::parry::convert::{self, Core, HalfSpace};
use crate::parry::hull_cache::HullCache;
use crate::parry::hull_cache::epoch::Epoch;
use crate::parry::instances::HullPartner;
use crate::parry::operand::{Operand, PreparedOperand};
use crate::parry::order::PairOrder;
use crate::parry::workspace::{ThreadWorkspace, Workspace};
use crate::pose::{RelativePose, ValidPose};
use crate::stats::Left;
use crate::support::{Cso, Support};
use crate::tolerance::MIN_DIRECTED_DISTANCE;

/// A hull and another shape, as the kernels see a pair: in the frame of the hull. Scene queries have pairs
/// with another shape `A` in its place.
pub(crate) struct Pair<'a, B, A = Hull> {
    pub hull: &'a A,
    pub other: &'a B,
    /// The radii of the rounded borders around them.
    pub border_radii: [f64; 2],
    /// Which of the caller's shapes the hull is.
    pub order: PairOrder,
}

impl<'a, B, A> Pair<'a, B, A> {
    /// The pose of the other shape in the hull's frame, from the caller's pose.
    #[inline(always)]
    pub fn pose(&self, pos12: ValidPose<'_>) -> RelativePose {
        self.order.pose(pos12)
    }

    /// The radii of both shapes, with their borders.
    pub fn radii(&self) -> [f64; 2]
    where
        A: Support,
        B: Support,
    {
        let [border_1, border_2] = self.border_radii;
        [
            self.hull.radius() + border_1,
            self.other.radius() + border_2,
        ]
    }

    /// The size of both shapes without borders.
    #[inline]
    pub fn size(&self) -> f64
    where
        A: Support,
        B: Support,
    {
        self.hull.radius() + self.other.radius()
    }

    /// The Minkowski difference without borders.
    #[inline(always)]
    pub fn cso<'c>(&self, pose: &'c RelativePose) -> Cso<'c, A, B>
    where
        'a: 'c,
    {
        Cso {
            shape_1: self.hull,
            shape_2: self.other,
            pose,
        }
    }

    /// The distance up to which the shapes touch. `size` is the size of both without borders.
    #[inline(always)]
    pub fn touching(&self, size: f64) -> f64 {
        MIN_DIRECTED_DISTANCE * (size + self.border_radii[0] + self.border_radii[1])
    }

    /// The distance of the cores, if the shapes with their borders have this distance, or touch at that
    /// distance. `size` is the size of both without borders.
    #[inline(always)]
    pub fn core_distance(&self, distance: Real, size: f64) -> f64 {
        f64::from(distance) + self.border_radii[0] + self.border_radii[1] + self.touching(size)
    }
}

/// The pose, if the kernels can work with it.
#[inline(always)]
pub(crate) fn valid_pose(pos12: &Pose) -> Result<ValidPose<'_>, Unsupported> {
    ValidPose::new(pos12).ok_or(Unsupported)
}

/// An operation on a pair.
pub(crate) trait PairVisitor: Sized {
    /// The result. [`Unsupported`] pairs are left to parry.
    type Answer;

    /// The other shape is a polytope.
    fn visit<B: HullPartner>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported>;

    /// The other shape is a half-space.
    fn visit_half_space(
        &mut self,
        pair: &Pair<'_, HalfSpace>,
        workspace: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        let _ = (pair, workspace);
        Err(Unsupported)
    }

    /// The other shape is a cylinder or a cone.
    fn visit_curved<B: Body>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        let _ = (pair, workspace);
        Err(Unsupported)
    }
}

/// Visits the pair if one of its shapes is a hull and the other is known.
#[inline]
pub(crate) fn visit<V: PairVisitor>(
    shape_1: &dyn Shape,
    shape_2: &dyn Shape,
    visitor: V,
) -> Result<V::Answer, Unsupported> {
    let operands = map_pair([shape_1, shape_2], Operand::new);
    visit_operands(&operands, Epoch::of_pair(), visitor)
}

/// Like [`visit`], for shapes that do not change during `epoch`.
// perf: in a call the operands would go through memory, which pairs that are apart notice.
#[inline(always)]
pub(crate) fn visit_operands<V: PairVisitor>(
    [operand_1, operand_2]: &[Operand<'_>; 2],
    epoch: Epoch,
    mut visitor: V,
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
        [true, false] => hull(operand_1).visit(operand_2.shape, &mut visitor),
        [false, _] => hull(operand_2).visit(operand_1.shape, &mut visitor),
    }
}

/// The hulls of both operands, if they have one. Those that are new are prepared.
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
    /// Visits the hull and another shape, if that is known and neither too flat nor too small.
    #[inline(never)]
    fn visit<V: PairVisitor>(
        &self,
        other: &dyn Shape,
        visitor: &mut V,
    ) -> Result<V::Answer, Unsupported> {
        // The typed shape of a user's own shape may only be similar.
        if other.shape_type() == ShapeType::Custom {
            return Err(Unsupported);
        }
        let typed = other.as_typed_shape();
        if let TypedShape::HalfSpace(half_space) = typed {
            let half_space = convert::half_space(half_space).ok_or(Unsupported)?;
            return self.with(&half_space, 0.0, |pair, workspace| {
                visitor.visit_half_space(pair, workspace)
            });
        }
        let found = Core::of_typed(typed);
        let Some((core, border_radius)) = &found else {
            return Err(Unsupported);
        };
        match core {
            Core::Ball(core) => self.polytope(core, *border_radius, visitor),
            Core::Segment(core) => self.polytope(core, *border_radius, visitor),
            Core::Triangle(core) => self.polytope(core, *border_radius, visitor),
            Core::Cuboid(core) => self.polytope(core, *border_radius, visitor),
            Core::Cylinder(core) => self.curved(core, *border_radius, visitor),
            Core::Cone(core) => self.curved(core, *border_radius, visitor),
        }
    }

    #[inline]
    fn polytope<V: PairVisitor>(
        &self,
        other: &impl HullPartner,
        border_radius: Real,
        visitor: &mut V,
    ) -> Result<V::Answer, Unsupported> {
        self.with(other, border_radius, |pair, workspace| {
            visitor.visit(pair, workspace)
        })
    }

    #[inline]
    fn curved<V: PairVisitor>(
        &self,
        other: &impl Body,
        border_radius: Real,
        visitor: &mut V,
    ) -> Result<V::Answer, Unsupported> {
        self.with(other, border_radius, |pair, workspace| {
            visitor.visit_curved(pair, workspace)
        })
    }

    /// Calls the visitor with the hull and the other shape.
    #[inline]
    fn with<B, T>(
        &self,
        other: &B,
        border_radius: Real,
        visit: impl FnOnce(&Pair<'_, B>, &mut Workspace) -> Result<T, Unsupported>,
    ) -> Result<T, Unsupported> {
        ThreadWorkspace::with(
            |ThreadWorkspace {
                 hulls, workspace, ..
             }| {
                hulls.begin();
                let prepared = self.operand.prepare(hulls, self.epoch).ok_or(Unsupported)?;
                let prepared = prepared.hull(hulls).ok_or(Unsupported)?;
                let pair = Pair {
                    hull: prepared.hull,
                    other,
                    border_radii: [prepared.border_radius, border_radius.into()],
                    order: self.order,
                };
                visit(&pair, workspace)
            },
        )
    }
}
