//! The update of one manifold, by us or by the fallback.

use parry3d::math::{Pose, Real, Vector};
use parry3d::query::{ContactManifold, PersistentQueryDispatcher, Unsupported};

use crate::map_pair::map_pair;
use crate::parry::constraints::Constraints;
use crate::parry::hull_cache::epoch::Epoch;
use crate::parry::manifold::{ErasedManifold, UpdateManifold};
use crate::parry::operand::Operand;
use crate::parry::recording::{PairView, Recorder, bare};
use crate::parry::visit;
use crate::parry::without_hull::update_without_hull;
use crate::stats::{Left, SharedStats};

/// What all updates of one call share.
pub(crate) struct Updater<'a, F> {
    pub fallback: &'a F,
    pub stats: &'a SharedStats,
    /// Checks each pair, if there is a recorder.
    pub recorder: Option<&'a Recorder>,
    /// The epoch in which the shapes do not change.
    pub epoch: Epoch,
    /// Whether the fallback gets the pairs of a user's own shapes.
    pub leaves_custom: bool,
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
        operands: &[Operand<'_>; 2],
        constraints: &[Constraints<'_>; 2],
        prediction: Real,
        manifold: &mut ContactManifold<M, C>,
    ) -> Result<(), Unsupported>
    where
        M: Default + Clone + Send + Sync,
        C: Default + Copy + Send + Sync,
        F: PersistentQueryDispatcher<M, C>,
    {
        match self.recorder {
            Some(recorder) if recorder.is_open() => {
                self.update_recorded(recorder, pos12, operands, constraints, prediction, manifold)
            }
            _ => self.answer(pos12, operands, constraints, prediction, manifold),
        }
    }

    #[cold]
    #[inline(never)]
    fn update_recorded<M, C>(
        self,
        recorder: &Recorder,
        pos12: &Pose,
        operands: &[Operand<'_>; 2],
        constraints: &[Constraints<'_>; 2],
        prediction: Real,
        manifold: &mut ContactManifold<M, C>,
    ) -> Result<(), Unsupported>
    where
        M: Default + Clone + Send + Sync,
        C: Default + Copy + Send + Sync,
        F: PersistentQueryDispatcher<M, C>,
    {
        let before = bare(manifold);
        self.answer(pos12, operands, constraints, prediction, manifold)?;
        recorder.look_at(&PairView {
            shapes: map_pair(*operands, |operand| operand.shape),
            pos12,
            prediction,
            has_corrected_normals: !Constraints::are_none(constraints),
            before: &before,
            after: &bare(manifold),
        });
        Ok(())
    }

    // perf: as above.
    #[inline(always)]
    fn answer<M, C>(
        self,
        pos12: &Pose,
        operands: &[Operand<'_>; 2],
        constraints: &[Constraints<'_>; 2],
        prediction: Real,
        manifold: &mut ContactManifold<M, C>,
    ) -> Result<(), Unsupported>
    where
        M: Default + Clone + Send + Sync,
        C: Default + Copy + Send + Sync,
        F: PersistentQueryDispatcher<M, C>,
    {
        let update = UpdateManifold {
            pos12,
            prediction,
            constraints,
            manifold: ErasedManifold::new(manifold),
            stats: self.stats,
            leaves_custom: self.leaves_custom,
        };
        if answer_by_us(operands, self.epoch, update).is_ok() {
            return Ok(());
        }
        let [g1, g2] = map_pair(*operands, |operand| operand.shape);
        let [c1, c2] = *constraints;
        let answered = c1.with(|c1| {
            c2.with(|c2| {
                self.fallback
                    .contact_manifold_convex_convex(pos12, g1, g2, c1, c2, prediction, manifold)
            })
        });
        // Normals that a pose without numbers left would stay while the shapes are far apart.
        if manifold.points.is_empty()
            && !(manifold.local_n1.is_finite() && manifold.local_n2.is_finite())
        {
            (manifold.local_n1, manifold.local_n2) = (Vector::ZERO, Vector::ZERO);
        }
        answered
    }
}

/// Fails if the pair is left to the fallback. It is generic over nothing, so that this crate has the code, and not
/// every program that steps a world.
fn answer_by_us(
    operands: &[Operand<'_>; 2],
    epoch: Epoch,
    mut update: UpdateManifold<'_>,
) -> Result<(), Unsupported> {
    let shapes = map_pair(*operands, |operand| operand.shape);
    if operands[0].is_hull() || operands[1].is_hull() {
        visit::operands(operands, epoch, &mut update).inspect_err(|_| {
            update
                .stats
                .record_left(visit::why_left(update.pos12, shapes))
        })
    } else {
        update_without_hull(shapes, &mut update)
            .inspect_err(|_| update.stats.record_left(Left::NoHull))
    }
}
