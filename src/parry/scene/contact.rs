//! The deepest contact of two shapes, without memory.

use parry3d::math::{Pose, Real};
use parry3d::query::{Contact, Unsupported};
use parry3d::shape::Shape;

use crate::curved::{CurvedAnswer, CurvedQuery, Hint, SurfacePieces};
use crate::epa;
use crate::parry::balls;
use crate::parry::convert::{Core, HalfSpace};
use crate::parry::pair::{Pair, PairVisitor, valid_pose};
use crate::parry::scene::caller::{KernelFrame, NearestPoints};
use crate::parry::scene::capsules;
use crate::parry::scene::convex;
use crate::parry::scene::separation::{CoreSeparation, SeparationQuery, over_half_space};
use crate::parry::visit;
use crate::parry::workspace::Workspace;
use crate::pose::ValidPose;
use crate::query::{Full, Query, moved_apart};
use crate::stats::Cost;
use crate::support::{Polytope, Support};
use crate::tolerance::{GJK_CURVED_GAP, GJK_GAP_OF_SIZE};

/// The deepest contact of shapes that overlap or are at most `prediction` apart.
pub(crate) fn contact(
    pos12: &Pose,
    shape_1: &dyn Shape,
    shape_2: &dyn Shape,
    prediction: Real,
) -> Result<Option<Contact>, Unsupported> {
    let query = ContactQuery { pos12, prediction };
    let shapes = [shape_1, shape_2];
    visit::shapes(shape_1, shape_2, query)
        .or_else(|_| capsules::contact(pos12, shapes, prediction))
        .or_else(|_| balls::contact(pos12, shapes, prediction))
        .or_else(|_| convex::visit_inexact(shapes, |pair, workspace| query.convex(pair, workspace)))
}

/// The deepest contact of two convex shapes, also where [`contact`] leaves it to parry.
pub(super) fn contact_of_any(
    pos12: &Pose,
    shapes: [&dyn Shape; 2],
) -> Result<Option<Contact>, Unsupported> {
    let query = ContactQuery {
        pos12,
        prediction: Real::MAX,
    };
    contact(pos12, shapes[0], shapes[1], Real::MAX)
        .or_else(|_| convex::visit(shapes, |pair, workspace| query.convex(pair, workspace)))
}

#[derive(Clone, Copy)]
struct ContactQuery<'a> {
    pos12: &'a Pose,
    prediction: Real,
}

impl ContactQuery<'_> {
    /// Of shapes without a hull.
    fn convex(
        &self,
        pair: &Pair<'_, Core<'_>, Core<'_>>,
        workspace: &mut Workspace,
    ) -> Result<Option<Contact>, Unsupported> {
        if pair.hull.is_curved() || pair.other.is_curved() {
            self.search(pair, workspace, Self::curved_depth)
        } else {
            self.search(pair, workspace, Self::depth)
        }
    }

    /// By GJK, or by `depth` if the cores touch or overlap.
    fn search<A: Support, B: Support>(
        &self,
        pair: &Pair<'_, B, A>,
        workspace: &mut Workspace,
        depth: fn(&Self, &Pair<'_, B, A>, &mut Workspace) -> Option<Contact>,
    ) -> Result<Option<Contact>, Unsupported> {
        let query = SeparationQuery {
            pos12: self.pos12,
            max_distance: self.prediction,
        };
        match query.of_cores(pair, GJK_CURVED_GAP, workspace)? {
            CoreSeparation::Overlapping => {
                depth(self, pair, workspace).ok_or(Unsupported).map(Some)
            }
            CoreSeparation::Within(near) => Ok(Some(near.contact())),
            CoreSeparation::Beyond => Ok(None),
        }
    }

    /// The contact of a cylinder or a cone and another shape whose cores touch or overlap, as manifolds have it.
    fn curved_depth<A: SurfacePieces, B: SurfacePieces>(
        &self,
        pair: &Pair<'_, B, A>,
        workspace: &mut Workspace,
    ) -> Option<Contact> {
        let pose = pair.pose(ValidPose::new(self.pos12)?);
        let mut query = CurvedQuery {
            cso: &pair.cso(&pose),
            border_radii: [0.0; 2],
            max_distance: f64::INFINITY,
            last: None,
            scratch: &mut workspace.curved,
            cost: &mut Cost::default(),
        };
        let (
            CurvedAnswer::Near {
                signed_distance,
                normal,
                on_1,
            },
            _,
        ) = query.run(Hint::None)?
        else {
            return None;
        };
        let points = [on_1, on_1 + normal * signed_distance];
        let near = KernelFrame::new(pair, &pose).near(normal, points, signed_distance);
        Some(near.contact())
    }

    /// The contact of shapes whose cores touch or overlap, by EPA.
    fn depth<A: Support, B: Support>(
        &self,
        pair: &Pair<'_, B, A>,
        workspace: &mut Workspace,
    ) -> Option<Contact> {
        let pose = pair.pose(ValidPose::new(self.pos12)?);
        let cso = pair.cso(&pose);
        let cost = &mut Cost::default();
        let found = epa::penetration(&cso, &[], &mut workspace.epa, cost)?;
        let normal = found.normal;
        let start = cso.start_vertices(normal);
        let closest = moved_apart(
            &cso,
            normal * found.depth,
            normal,
            |apart, cost| [apart.support(normal, start, cost)],
            GJK_GAP_OF_SIZE,
            cost,
        );
        let points = closest.map_or([found.on_1, found.on_2], |near| [near.on_1, near.on_2]);
        let near = KernelFrame::new(pair, &pose).near(normal, points, -found.depth);
        Some(near.contact())
    }
}

impl PairVisitor for ContactQuery<'_> {
    type Answer = Option<Contact>;

    fn visit<B: Polytope>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        let pose = pair.pose(valid_pose(self.pos12)?);
        let cso = pair.cso(&pose);
        let max_distance = pair.core_distance(self.prediction, cso.size());
        let mut sink = NearestPoints::new(pair, &pose);
        Query::new(&cso, max_distance, &mut workspace.epa, &mut Cost::default())
            .run_into(Full, &mut sink)
            .ok_or(Unsupported)?;
        Ok(sink.nearest.map(|near| near.contact()))
    }

    fn visit_curved<B: SurfacePieces>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        self.search(pair, workspace, Self::curved_depth)
    }

    fn visit_half_space(
        &mut self,
        pair: &Pair<'_, HalfSpace>,
        _: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        let near = over_half_space(pair, self.pos12, self.prediction)?;
        Ok(near.map(|near| near.contact()))
    }
}
