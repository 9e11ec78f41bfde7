//! The update of one manifold, by us or by the fallback.

use parry3d::math::{Pose, Real};
use parry3d::query::{ContactManifold, PersistentQueryDispatcher, Unsupported};

use crate::parry::constraints::Constraints;
use crate::parry::hull_cache::Find;
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
    pub epoch: Option<Epoch>,
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
    pub fn update<'a, 'b, M, C>(
        self,
        pos12: &Pose,
        (operand_1, operand_2): (Operand<'a, impl Find<'a>>, Operand<'b, impl Find<'b>>),
        constraints: [Constraints<'_>; 2],
        prediction: Real,
        manifold: &mut ContactManifold<M, C>,
    ) -> Result<(), Unsupported>
    where
        M: Default + Clone + Send + Sync,
        C: Default + Copy + Send + Sync,
        F: PersistentQueryDispatcher<M, C>,
    {
        let (g1, g2) = (operand_1.shape, operand_2.shape);
        let has_hull = operand_1.is_hull() || operand_2.is_hull();
        let update = UpdateManifold {
            pos12,
            prediction,
            constraints,
            manifold,
            stats: self.stats,
        };
        if pair::visit_operands(operand_1, operand_2, self.epoch, update).is_ok() {
            return Ok(());
        }
        if has_hull {
            self.stats.record_left(pair::why_left(pos12, [g1, g2]));
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
