//! A pair of shapes as the kernels take it, and the visitor that makes code generic over the second shape.

use parry3d::math::{Pose, Real};
use parry3d::query::Unsupported;

use crate::curved::SurfacePieces;
use crate::hull::Hull;
use crate::parry::convert::HalfSpace;
use crate::parry::order::PairOrder;
use crate::parry::workspace::Workspace;
use crate::pose::{RelativePose, ValidPose};
use crate::support::{Cso, Polytope, Support};
use crate::tolerance::MIN_DIRECTED_DISTANCE;

/// A hull and another shape in the kernels' order. Frame 1 is that of the hull. In pairs without a hull the first shape is
/// another convex shape `A`.
pub(crate) struct Pair<'a, B, A = Hull> {
    pub hull: &'a A,
    pub other: &'a B,
    /// The radii of the rounded borders around them.
    pub border_radii: [f64; 2],
    /// The order of the caller's shapes.
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

    /// Shapes at most this far apart count as touching. `size` is the size of both without borders.
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
    fn visit<B: Polytope>(
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

    /// Whether the fallback gets the pairs of a user's own shapes.
    fn leaves_custom(&self) -> bool {
        false
    }

    /// The other shape is a cylinder or a cone, or a user's own.
    fn visit_curved<B: SurfacePieces>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        let _ = (pair, workspace);
        Err(Unsupported)
    }
}
