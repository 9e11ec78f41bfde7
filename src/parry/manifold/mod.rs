//! The contact manifold of two convex shapes, from frame to frame.

mod curved;
mod flush;
mod half_space;
mod inherit;
mod kept;
mod normals;
mod polytopes;
mod record;
mod sink;

use parry3d::math::{Pose, Real};
use parry3d::query::{ContactManifold, Unsupported};

use crate::curved::Body;
use crate::parry::constraints::Constraints;
use crate::parry::convert::HalfSpace;
use crate::parry::half_space as plane;
use crate::parry::pair::{Pair, PairVisitor, valid_pose};
use crate::parry::workspace::Workspace;
use crate::query::{Full, Query};
use crate::stats::{Cost, SharedStats};
use crate::support::{Polytope, Support};
pub(crate) use curved::CurvedPair;
use half_space::HalfSpaceContacts;
use polytopes::PolytopeContacts;
use record::AxisFrame;
use sink::ManifoldSink;

/// Brings a manifold up to date.
pub(crate) struct UpdateManifold<'a, M, C> {
    pub pos12: &'a Pose,
    pub prediction: Real,
    pub constraints: &'a [Constraints<'a>; 2],
    pub manifold: &'a mut ContactManifold<M, C>,
    pub stats: &'a SharedStats,
}

impl<M: Default, C: Default + Copy> PairVisitor for UpdateManifold<'_, M, C> {
    /// The manifold is up to date, unless the pair is not finite.
    type Answer = ();

    // perf: in a call the pair would go through memory, which small queries notice.
    #[inline(always)]
    fn visit<B: Polytope>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Result<(), Unsupported> {
        let pose = pair.pose(valid_pose(self.pos12)?);
        let cso = pair.cso(&pose);
        let max_distance = pair.core_distance(self.prediction, cso.size());
        let mut cost = Cost::default();
        let mut query = Query {
            cso: &cso,
            max_distance,
            polytope_cache: Some((&mut workspace.polytope_cache, key_of(self.manifold))),
            scratch: &mut workspace.epa,
            cost: &mut cost,
        };
        let mut sink = ManifoldSink {
            manifold: &mut *self.manifold,
            pair,
            frame: AxisFrame::of(&cso),
            contacts: PolytopeContacts {
                cso: &cso,
                max_distance,
                constraints: self.constraints,
                pos12: self.pos12,
                scratch: &mut workspace.clip,
            },
            last: None,
            is_kept: false,
        };
        let stage = query.run_into(Full, &mut sink).ok_or(Unsupported)?;
        self.stats.record(sink.stage(stage), &cost);
        Ok(())
    }

    fn visit_half_space(
        &mut self,
        pair: &Pair<'_, HalfSpace>,
        workspace: &mut Workspace,
    ) -> Result<(), Unsupported> {
        let pose = pair.pose(valid_pose(self.pos12)?);
        let max_distance = pair.core_distance(self.prediction, pair.hull.radius());
        let mut sink = ManifoldSink {
            manifold: &mut *self.manifold,
            pair,
            frame: AxisFrame::First,
            contacts: HalfSpaceContacts {
                hull: pair.hull,
                pose: &pose,
                max_distance,
                scratch: &mut workspace.clip,
            },
            last: None,
            is_kept: false,
        };
        let mut cost = Cost::default();
        let stage = plane::run_into(pair, &pose, max_distance, &mut sink, &mut cost);
        self.stats.record(sink.stage(stage), &cost);
        Ok(())
    }

    fn visit_curved<B: Body>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Result<(), Unsupported> {
        let pair = CurvedPair {
            shapes: (pair.hull, pair.other),
            border_radii: pair.border_radii,
            order: pair.order,
        };
        self.update_curved(&pair, &mut workspace.curved)
    }
}

/// The address of the manifold. Mostly, it is the same in the next frame.
#[inline]
fn key_of<T>(manifold: &T) -> u64 {
    (&raw const *manifold).addr() as u64
}
