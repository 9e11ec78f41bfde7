//! The contact manifold of two convex shapes, from frame to frame.

mod curved;
mod curved_manifold;
mod flush;
mod half_space;
mod inherit;
mod kept;
mod kernel_manifold;
mod normals;
mod polytopes;
mod sink;
mod still;

use glam::Quat;
use parry3d::math::{Pose, Real};
use parry3d::query::{ContactManifold, Unsupported};

use crate::curved::SurfacePieces;
use crate::hull::Hull;
use crate::parry::apart_cache::ApartPair;
use crate::parry::constraints::Constraints;
use crate::parry::convert::HalfSpace;
use crate::parry::half_space as plane;
use crate::parry::instances::{FullWithHull, HullPartner};
use crate::parry::pair::{Pair, PairVisitor, valid_pose};
use crate::parry::still_cache::StillPair;
use crate::parry::workspace::Workspace;
use crate::pose::RelativePose;
use crate::query::Query;
use crate::stats::{Cost, SharedStats, Stage};
use crate::support::{Cso, Support};
pub(crate) use curved::{CurvedPair, CurvedUpdate};
use half_space::HalfSpaceContacts;
use kernel_manifold::{AxisFrame, KernelManifold, key_of};
use polytopes::PolytopeContacts;
use sink::ManifoldSink;
use still::SettledContacts;

/// Brings a manifold up to date.
pub(crate) struct UpdateManifold<'a, M, C> {
    pub pos12: &'a Pose,
    pub prediction: Real,
    pub constraints: &'a [Constraints<'a>; 2],
    pub manifold: &'a mut ContactManifold<M, C>,
    pub stats: &'a SharedStats,
}

impl<M: Default, C: Default + Copy> PairVisitor for UpdateManifold<'_, M, C> {
    /// Fails if the pair is not finite.
    type Answer = ();

    // perf: in a call the pair would go through memory, which small queries notice.
    #[inline(always)]
    fn visit<B: HullPartner>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Result<(), Unsupported> {
        let max_distance = pair.core_distance(self.prediction, pair.size());
        if let Some(apart) = self.apart_pair(pair)
            && workspace.apart_cache.proves(&apart, max_distance)
        {
            self.stats.record_free(apart.stage());
            return Ok(());
        }
        let pose = pair.pose(valid_pose(self.pos12)?);
        let cso = pair.cso(&pose);
        let mut settled = None;
        self.read_settled(pair, &pose, &mut settled, |rotation, key| {
            StillPair::of(&cso, rotation, key)
        });
        if self.hold_if_proved(pair, settled.as_ref(), max_distance, workspace) {
            return Ok(());
        }
        let mut cost = Cost::default();
        let stage = self.query(
            pair,
            &cso,
            max_distance,
            settled.as_ref(),
            workspace,
            &mut cost,
        )?;
        self.stats.record(stage, &cost);
        Ok(())
    }

    fn visit_half_space(
        &mut self,
        pair: &Pair<'_, HalfSpace>,
        workspace: &mut Workspace,
    ) -> Result<(), Unsupported> {
        let pose = pair.pose(valid_pose(self.pos12)?);
        let max_distance = pair.core_distance(self.prediction, pair.hull.radius());
        let mut settled = None;
        self.read_settled(pair, &pose, &mut settled, |rotation, key| {
            plane::still_pair(pair, &pose, rotation, key)
        });
        if self.hold_if_proved(pair, settled.as_ref(), max_distance, workspace) {
            return Ok(());
        }
        let contacts = HalfSpaceContacts {
            hull: pair.hull,
            pose: &pose,
            max_distance,
            scratch: &mut workspace.clip,
        };
        let frame = AxisFrame::First;
        let mut sink = ManifoldSink::new(self.manifold, pair, frame, contacts, settled.as_ref());
        let mut cost = Cost::default();
        let stage = plane::run_into(pair, &pose, max_distance, &mut sink, &mut cost);
        self.stats.record(sink.stage(stage), &cost);
        sink.store_held(&mut workspace.still_cache);
        Ok(())
    }

    fn visit_curved<B: SurfacePieces>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Result<(), Unsupported> {
        let pair = CurvedPair {
            shapes: (pair.hull, pair.other),
            border_radii: pair.border_radii,
            order: pair.order,
        };
        self.curved().run(&pair, workspace)
    }
}

impl<'a, M: Default, C: Default + Copy> UpdateManifold<'a, M, C> {
    /// The same for pairs with a cylinder or a cone.
    pub fn curved(&mut self) -> CurvedUpdate<'_> {
        CurvedUpdate {
            pos12: self.pos12,
            prediction: self.prediction,
            constraints: self.constraints,
            manifold: &mut *self.manifold,
            stats: self.stats,
        }
    }

    /// Reads the contacts of the manifold, if they may stay as they are. They are written to `settled`: a return value
    /// would be copied even where there are none.
    #[inline]
    fn read_settled<B>(
        &mut self,
        pair: &Pair<'_, B>,
        pose: &RelativePose,
        settled: &mut Option<SettledContacts>,
        still_pair: impl FnOnce(Quat, u64) -> Option<StillPair>,
    ) {
        // Corrected normals need not be those of the query.
        if matches!(self.constraints, [Constraints::None, Constraints::None])
            && still::is_settled(self.manifold, pair.order, pose)
            && let Some(still_pair) = still_pair(self.pos12.rotation, key_of(self.manifold))
        {
            let manifold = KernelManifold::new(self.manifold, pair, AxisFrame::First);
            SettledContacts::read(&manifold, pose, still_pair, settled);
        }
    }

    /// Only measures the contacts of a pair at rest anew, if that is proved to be enough. Returns whether it is.
    #[inline]
    fn hold_if_proved<B>(
        &mut self,
        pair: &Pair<'_, B>,
        settled: Option<&SettledContacts>,
        max_distance: f64,
        workspace: &Workspace,
    ) -> bool {
        let Some(SettledContacts { still, .. }) = settled else {
            return false;
        };
        let is_proved = still.is_proved(&workspace.still_cache, max_distance, pair.border_radii);
        if is_proved {
            KernelManifold::new(self.manifold, pair, AxisFrame::First).hold(still);
            self.stats.record_free(Stage::Still);
        }
        is_proved
    }

    /// Runs the query. If the shapes are still apart along the manifold's axis, stores the proof.
    #[inline]
    fn query<B: HullPartner>(
        &mut self,
        pair: &Pair<'_, B>,
        cso: &Cso<'_, Hull, B>,
        max_distance: f64,
        settled: Option<&SettledContacts>,
        workspace: &mut Workspace,
        cost: &mut Cost,
    ) -> Result<Stage, Unsupported> {
        let frame = AxisFrame::of(cso);
        let mut query = Query {
            cso,
            max_distance,
            polytope_cache: Some((&mut workspace.polytope_cache, key_of(self.manifold))),
            scratch: &mut workspace.epa,
            cost,
        };
        let contacts = PolytopeContacts {
            cso,
            max_distance,
            constraints: self.constraints,
            pos12: self.pos12,
            scratch: &mut workspace.clip,
        };
        let mut sink = ManifoldSink::new(self.manifold, pair, frame, contacts, settled);
        let stage = query.run_into(FullWithHull, &mut sink).ok_or(Unsupported)?;
        let (apart_by, stage) = (sink.still_apart(stage, cso), sink.stage(stage));
        sink.store_held(&mut workspace.still_cache);
        if let (Some(separation), Some(apart)) = (apart_by, self.apart_pair(pair)) {
            let proofs = &mut workspace.apart_cache;
            proofs.store(&apart, separation, [cso.size(), frame.lever(cso)]);
        }
        Ok(stage)
    }

    /// The key of a proof that two hulls are apart, if the manifold has an axis that separates them.
    #[inline]
    fn apart_pair<B: Support>(&self, pair: &Pair<'_, B>) -> Option<ApartPair<'a>> {
        let is_empty = self.manifold.points.is_empty();
        is_empty.then_some(ApartPair {
            key: key_of(self.manifold),
            shapes: [pair.hull.id()?, pair.other.id()?],
            axis: self.manifold.local_n1,
            pose: self.pos12,
        })
    }
}
