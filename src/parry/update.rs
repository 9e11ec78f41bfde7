//! The update of one manifold, by us or by the fallback.

use parry3d::math::{Pose, Real};
use parry3d::query::{ContactManifold, PersistentQueryDispatcher, Unsupported};

use crate::map_pair::map_pair;
use crate::parry::capsules::update_capsules;
use crate::parry::constraints::Constraints;
use crate::parry::hull_cache::epoch::Epoch;
use crate::parry::manifold::UpdateManifold;
use crate::parry::operand::Operand;
use crate::parry::pair;
use crate::stats::SharedStats;

/// What the updates of one call have in common.
pub(crate) struct Updater<'a, F> {
    pub fallback: &'a F,
    pub stats: &'a SharedStats,
    /// In which the shapes are unchanged.
    pub epoch: Epoch,
}

impl<F> Clone for Updater<'_, F> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<F> Copy for Updater<'_, F> {}

impl<F> Updater<'_, F> {
    /// Brings the manifold of two convex shapes up to date.
    // perf: in a call the operands would go through memory, which pairs that are apart notice.
    #[inline(always)]
    pub fn update<M, C>(
        self,
        pos12: &Pose,
        operands: [Operand<'_>; 2],
        constraints: [Constraints<'_>; 2],
        prediction: Real,
        manifold: &mut ContactManifold<M, C>,
    ) -> Result<(), Unsupported>
    where
        M: Default + Clone + Send + Sync,
        C: Default + Copy + Send + Sync,
        F: PersistentQueryDispatcher<M, C>,
    {
        let [g1, g2] = map_pair(operands, |operand| operand.shape);
        let has_hull = operands[0].is_hull() || operands[1].is_hull();
        let update = UpdateManifold {
            pos12,
            prediction,
            constraints,
            manifold,
            stats: self.stats,
        };
        if pair::visit_operands(operands, self.epoch, update).is_ok() {
            return Ok(());
        }
        if has_hull {
            self.stats.record_left(pair::why_left(pos12, [g1, g2]));
        }
        if !has_hull && update_capsules(pos12, [g1, g2], prediction, manifold).is_ok() {
            return Ok(());
        }
        let [c1, c2] = constraints;
        c1.with(|c1| {
            c2.with(|c2| {
                self.fallback
                    .contact_manifold_convex_convex(pos12, g1, g2, c1, c2, prediction, manifold)
            })
        })
    }
}
