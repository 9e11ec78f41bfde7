//! The deepest contact of two shapes, without memory.

use parry3d::math::{Pose, Real};
use parry3d::query::{Contact, Unsupported};
use parry3d::shape::{PolygonalFeatureMap, Shape};

use crate::curved::Body;
use crate::epa;
use crate::parry::convert::HalfSpace;
use crate::parry::pair::{self, Pair, PairVisitor, valid_pose};
use crate::parry::scaled;
use crate::parry::scene::caller::{KernelFrame, NearestPoints};
use crate::parry::scene::separation::{Separation, SeparationQuery, over_half_space};
use crate::parry::workspace::Workspace;
use crate::pose::ValidPose;
use crate::query::{Full, Query};
use crate::stats::Cost;
use crate::support::{Polytope, Support};
use crate::tolerance::GJK_CURVED_GAP;

/// The deepest contact of shapes that overlap or are at most `prediction` apart.
pub(crate) fn contact(
    pos12: &Pose,
    shape_1: &dyn Shape,
    shape_2: &dyn Shape,
    prediction: Real,
) -> Result<Option<Contact>, Unsupported> {
    let query = ContactQuery { pos12, prediction };
    pair::visit(shape_1, shape_2, query)
}

struct ContactQuery<'a> {
    pos12: &'a Pose,
    prediction: Real,
}

impl ContactQuery<'_> {
    /// The contact of shapes that touch or overlap, by EPA.
    fn depth<B: Support>(&self, pair: &Pair<'_, B>, workspace: &mut Workspace) -> Option<Contact> {
        let pose = pair.pose(ValidPose::new(self.pos12)?);
        let cost = &mut Cost::default();
        let found = epa::penetration(&pair.cso(&pose), &[], &mut workspace.epa, cost)?;
        let points = [found.on_1, found.on_2];
        let near = KernelFrame::new(pair, &pose).near(found.normal, points, -found.depth);
        Some(near.contact())
    }
}

impl PairVisitor for ContactQuery<'_> {
    type Answer = Option<Contact>;

    const HALF_SPACES: bool = true;

    const CURVED: bool = true;

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

    /// parry answers how deep they overlap. If they only touch, it may fail.
    fn visit_curved<B: Body>(
        &mut self,
        pair: &Pair<'_, B>,
        features: &dyn PolygonalFeatureMap,
        workspace: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        let query = SeparationQuery {
            pos12: self.pos12,
            max_distance: self.prediction,
        };
        match query.separation(pair, GJK_CURVED_GAP, workspace)? {
            Separation::Overlapping => {
                let contact = scaled::contact(pair, features, self.pos12);
                Ok(contact.or_else(|| self.depth(pair, workspace)))
            }
            Separation::Within(near) => Ok(Some(near.contact())),
            Separation::Beyond => Ok(None),
        }
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
