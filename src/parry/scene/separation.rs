//! Queries without memory: distance, closest points and intersection of convex shapes.
//!
//! Only `contact` needs the depth of an overlap; these queries end with GJK. For all of them, shapes touch if
//! they are at most [`MIN_DIRECTED_DISTANCE`](crate::tolerance::MIN_DIRECTED_DISTANCE) apart.

use parry3d::math::{Pose, Real};
use parry3d::query::{ClosestPoints, Unsupported};
use parry3d::shape::Shape;

use crate::curved::SurfacePieces;
use crate::parry::convert::HalfSpace;
use crate::parry::half_space;
use crate::parry::pair::{Pair, PairVisitor, valid_pose};
use crate::parry::scene::caller::{CallerProximity, KernelFrame, NearestPoints};
use crate::parry::scene::convex;
use crate::parry::visit;
use crate::parry::workspace::Workspace;
use crate::query::{Distance, Query};
use crate::stats::Cost;
use crate::support::{Polytope, Support};
use crate::tolerance::{GJK_CURVED_GAP, GJK_GAP_OF_SIZE};

/// Whether two shapes touch or overlap.
pub(crate) fn intersect(
    pos12: &Pose,
    shape_1: &dyn Shape,
    shape_2: &dyn Shape,
) -> Result<bool, Unsupported> {
    let separation = separation(pos12, shape_1, shape_2, 0.0)?;
    Ok(matches!(separation, Separation::Overlapping))
}

/// The distance; zero if the shapes overlap.
pub(crate) fn distance(
    pos12: &Pose,
    shape_1: &dyn Shape,
    shape_2: &dyn Shape,
) -> Result<Real, Unsupported> {
    Ok(match separation(pos12, shape_1, shape_2, Real::INFINITY)? {
        Separation::Overlapping => 0.0,
        Separation::Within(near) => near.signed_distance as Real,
        Separation::Beyond => Real::INFINITY,
    })
}

/// The nearest points of shapes that are at most `max_distance` apart.
pub(crate) fn closest_points(
    pos12: &Pose,
    shape_1: &dyn Shape,
    shape_2: &dyn Shape,
    max_distance: Real,
) -> Result<ClosestPoints, Unsupported> {
    Ok(match separation(pos12, shape_1, shape_2, max_distance)? {
        Separation::Overlapping => ClosestPoints::Intersecting,
        Separation::Within(near) => {
            let [p1, p2] = near.points.map(|p| p.as_vec3());
            ClosestPoints::WithinMargin(p1, p2)
        }
        Separation::Beyond => ClosestPoints::Disjoint,
    })
}

/// The gap between two shapes.
pub(super) enum Separation {
    /// There is none: they touch or overlap.
    Overlapping,
    /// A gap, and its nearest points.
    Within(CallerProximity),
    /// More than the maximum distance.
    Beyond,
}

impl Separation {
    /// Shapes up to the distance `touching` apart touch.
    fn of(near: CallerProximity, touching: f64) -> Self {
        if near.signed_distance <= touching {
            Self::Overlapping
        } else {
            Self::Within(near)
        }
    }
}

fn separation(
    pos12: &Pose,
    shape_1: &dyn Shape,
    shape_2: &dyn Shape,
    max_distance: Real,
) -> Result<Separation, Unsupported> {
    let query = SeparationQuery {
        pos12,
        max_distance,
    };
    visit::shapes(shape_1, shape_2, query).or_else(|_| {
        convex::visit_inexact([shape_1, shape_2], |pair, workspace| {
            query.separation(pair, GJK_CURVED_GAP, workspace)
        })
    })
}

/// What lies between the cores of two shapes, which may have borders.
pub(super) enum CoreSeparation {
    /// Nothing, up to rounding.
    Overlapping,
    /// A gap, and where it is narrowest. Borders may overlap there.
    Within(CallerProximity),
    /// More than was asked about.
    Beyond,
}

#[derive(Clone, Copy)]
pub(super) struct SeparationQuery<'a> {
    pub pos12: &'a Pose,
    pub max_distance: Real,
}

impl SeparationQuery<'_> {
    /// The separation of any two convex shapes. GJK's bounds may differ by `gap`, relative to their size.
    pub fn separation<A: Support, B: Support>(
        &self,
        pair: &Pair<'_, B, A>,
        gap: f64,
        workspace: &mut Workspace,
    ) -> Result<Separation, Unsupported> {
        let size = pair.hull.radius() + pair.other.radius();
        let touching = pair.touching(size) + gap * size;
        Ok(match self.of_cores(pair, gap, workspace)? {
            CoreSeparation::Overlapping => Separation::Overlapping,
            CoreSeparation::Within(near) => Separation::of(near, touching),
            CoreSeparation::Beyond => Separation::Beyond,
        })
    }

    /// The same without regard to borders that overlap.
    pub fn of_cores<A: Support, B: Support>(
        &self,
        pair: &Pair<'_, B, A>,
        gap: f64,
        workspace: &mut Workspace,
    ) -> Result<CoreSeparation, Unsupported> {
        let pose = pair.pose(valid_pose(self.pos12)?);
        let cso = pair.cso(&pose);
        // Within this gap GJK cannot tell. There, too, they touch, for all queries.
        let slack = gap * cso.size();
        let max_distance = pair.core_distance(self.max_distance, cso.size()) + slack;
        let mut sink = NearestPoints::new(pair, &pose);
        let found = Query::new(&cso, max_distance, &mut workspace.epa, &mut Cost::default())
            .run_into(Distance { gap }, &mut sink);
        Ok(match (found, sink.nearest) {
            (None, _) => CoreSeparation::Overlapping,
            (_, None) => CoreSeparation::Beyond,
            (_, Some(near)) => CoreSeparation::Within(near),
        })
    }
}

impl PairVisitor for SeparationQuery<'_> {
    type Answer = Separation;

    fn visit<B: Polytope>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        self.separation(pair, GJK_GAP_OF_SIZE, workspace)
    }

    fn visit_curved<B: SurfacePieces>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        self.separation(pair, GJK_CURVED_GAP, workspace)
    }

    fn visit_half_space(
        &mut self,
        pair: &Pair<'_, HalfSpace>,
        _: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        let near = over_half_space(pair, self.pos12, self.max_distance)?;
        let touching = pair.touching(pair.hull.radius());
        Ok(near.map_or(Separation::Beyond, |near| Separation::of(near, touching)))
    }
}

/// The deepest point of a hull in a half-space; `None` if it is farther away than `max_distance`.
pub(super) fn over_half_space(
    pair: &Pair<'_, HalfSpace>,
    pos12: &Pose,
    max_distance: Real,
) -> Result<Option<CallerProximity>, Unsupported> {
    let pose = pair.pose(valid_pose(pos12)?);
    let max_distance = pair.core_distance(max_distance, pair.hull.radius());
    let near = half_space::deepest(pair, &pose, max_distance);
    Ok(near.map(|near| CallerProximity::of_proximity(&near, &KernelFrame::new(pair, &pose))))
}
