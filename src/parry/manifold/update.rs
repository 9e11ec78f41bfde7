//! The update of a manifold.

use glam::Quat;
use parry3d::math::{Pose, Real};
use parry3d::query::Unsupported;

use super::axis_frame::AxisFrame;
use super::erased::ErasedManifold;
use super::half_space::HalfSpaceUpdate;
use super::kernel_manifold::KernelManifold;
use super::polytopes::PolytopeContacts;
use super::sink::ManifoldSink;
use super::still::{PresentContacts, is_settled};
use crate::curved::SurfacePieces;
use crate::parry::apart_cache::ApartPair;
use crate::parry::constraints::Constraints;
use crate::parry::convert::HalfSpace;
use crate::parry::half_space as plane;
use crate::parry::pair::{Pair, PairVisitor, valid_pose};
use crate::parry::still_cache::{StillCache, StillPair};
use crate::parry::workspace::Workspace;
use crate::pose::RelativePose;
use crate::query::{Full, Query};
use crate::stats::{Cost, SharedStats, Stage};
use crate::support::{Cso, Polytope, Support};

/// Brings a manifold up to date.
pub(crate) struct UpdateManifold<'a> {
    pub pos12: &'a Pose,
    pub prediction: Real,
    pub constraints: &'a [Constraints<'a>; 2],
    pub manifold: ErasedManifold<'a>,
    pub stats: &'a SharedStats,
    /// Whether the fallback gets the pairs of a user's own shapes.
    pub leaves_custom: bool,
}

impl PairVisitor for UpdateManifold<'_> {
    /// Fails if the pair is not finite.
    type Answer = ();

    #[inline]
    fn visit<B: Polytope>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Result<(), Unsupported> {
        self.update_polytopes(pair, workspace)
    }

    fn visit_half_space(
        &mut self,
        pair: &Pair<'_, HalfSpace>,
        workspace: &mut Workspace,
    ) -> Result<(), Unsupported> {
        let pose = pair.pose(valid_pose(self.pos12)?);
        let max_distance = pair.core_distance(self.prediction, pair.hull.radius());
        let mut present = PresentContacts::default();
        let still_pair = |rotation, key| plane::still_pair(pair, &pose, rotation, key);
        let at = (&pose, max_distance);
        if self.hold_if_proved(pair, at, &mut present, &workspace.still_cache, still_pair) {
            return Ok(());
        }
        let frame = AxisFrame::of_callers_first(&pose, pair.order);
        let mut update = HalfSpaceUpdate {
            pair,
            pose: &pose,
            max_distance,
            manifold: KernelManifold::new(&mut self.manifold, pair, frame),
            still: present.still.as_ref(),
            last: &mut present.last,
        };
        let mut cost = Cost::default();
        let Workspace {
            clip, still_cache, ..
        } = workspace;
        let stage = update.run(clip, still_cache, &mut cost);
        self.stats.record(stage, &cost);
        Ok(())
    }

    fn leaves_custom(&self) -> bool {
        self.leaves_custom
    }

    fn visit_curved<B: SurfacePieces>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Result<(), Unsupported> {
        self.update_curved(pair, workspace)
    }
}

impl<'a> UpdateManifold<'a> {
    /// For two polytopes. Fails if the pair is not finite.
    // perf: in a call the pair would go through memory, which small queries notice.
    #[inline(always)]
    pub fn update_polytopes<A: Polytope, B: Polytope>(
        &mut self,
        pair: &Pair<'_, B, A>,
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
        let mut present = PresentContacts::default();
        let still_pair = |rotation, key| StillPair::of(&cso, rotation, key);
        let at = (&pose, max_distance);
        if self.hold_if_proved(pair, at, &mut present, &workspace.still_cache, still_pair) {
            return Ok(());
        }
        let mut cost = Cost::default();
        let stage = self.query(pair, &cso, max_distance, &mut present, workspace, &mut cost)?;
        self.stats.record(stage, &cost);
        Ok(())
    }

    /// Only measures the contacts of a pair at rest anew, if that is proved to be enough. Returns whether it is.
    ///
    /// If contacts may stay as they are, it reads them into `present`: a return value would be copied even where there are
    /// none.
    #[inline]
    pub(super) fn hold_if_proved<B, A>(
        &mut self,
        pair: &Pair<'_, B, A>,
        (pose, max_distance): (&RelativePose, f64),
        present: &mut PresentContacts,
        still_cache: &StillCache,
        still_pair: impl FnOnce(Quat, u64) -> Option<StillPair>,
    ) -> bool {
        // Corrected normals need not be those of the query.
        if Constraints::are_none(self.constraints)
            && is_settled(&self.manifold, pair.order, pose)
            && let Some(still_pair) = still_pair(self.pos12.rotation, self.manifold.key())
        {
            let manifold = KernelManifold::new(&mut self.manifold, pair, AxisFrame::First);
            present.read(&manifold, pose, still_pair);
        }
        let Some(still) = &mut present.still else {
            return false;
        };
        let is_proved = still.is_proved(still_cache, max_distance, pair.border_radii);
        if is_proved {
            self.manifold.hold(still);
            self.stats.record_free(Stage::Still);
        } else {
            still.find_own(still_cache);
        }
        is_proved
    }

    /// Runs the query. If the shapes are still apart along the manifold's axis, stores the proof.
    #[inline]
    fn query<A: Polytope, B: Polytope>(
        &mut self,
        pair: &Pair<'_, B, A>,
        cso: &Cso<'_, A, B>,
        max_distance: f64,
        present: &mut PresentContacts,
        workspace: &mut Workspace,
        cost: &mut Cost,
    ) -> Result<Stage, Unsupported> {
        let frame = AxisFrame::of(cso, pair.order);
        let mut query = Query {
            cso,
            max_distance,
            polytope_cache: Some((&mut workspace.polytope_cache, self.manifold.key())),
            scratch: &mut workspace.epa,
            cost,
        };
        let contacts = PolytopeContacts {
            cso,
            max_distance,
            constraints: self.constraints,
            pos12: self.pos12,
            scratch: &mut workspace.clip,
            still_cache: &mut workspace.still_cache,
        };
        let mut sink = ManifoldSink::new(&mut self.manifold, pair, frame, contacts, present);
        let stage = query.run_into(Full, &mut sink).ok_or(Unsupported)?;
        let (apart_by, stage) = (sink.still_apart(stage, cso), sink.stage(stage));
        if let (Some(separation), Some(apart)) = (apart_by, self.apart_pair(pair)) {
            let proofs = &mut workspace.apart_cache;
            let lever = frame.lever(cso, pair.order);
            proofs.store(&apart, separation, [cso.size(), lever]);
        }
        Ok(stage)
    }

    /// The key of a proof that two shapes are apart, if the manifold has an axis that separates them.
    #[inline]
    fn apart_pair<A: Support, B: Support>(&self, pair: &Pair<'_, B, A>) -> Option<ApartPair<'a>> {
        let is_empty = self.manifold.is_empty();
        is_empty.then_some(ApartPair {
            key: self.manifold.key(),
            shapes: [pair.hull.id()?, pair.other.id()?],
            axis: *self.manifold.local_n1,
            pose: self.pos12,
        })
    }
}
