//! From the answer of a query to a manifold.

use super::record::KernelManifold;
use crate::gjk::SeparatingAxis;
use crate::query::{PairMemory, Proximity, Sink};
use crate::stats::Stage;

/// How shapes that are near each other get their contacts.
pub(super) trait UpdateContacts {
    /// Writes the contacts, and returns whether they stayed where they were.
    fn update_contacts<M, C: Default + Copy>(
        &mut self,
        manifold: &mut KernelManifold<'_, M, C>,
        near: &Proximity,
    ) -> bool;
}

/// Of shapes that are only proved apart.
pub(super) struct NoContacts;

impl UpdateContacts for NoContacts {
    fn update_contacts<M, C: Default + Copy>(
        &mut self,
        _: &mut KernelManifold<'_, M, C>,
        _: &Proximity,
    ) -> bool {
        false
    }
}

/// Brings a manifold up to date.
pub(super) struct ManifoldSink<'a, M, C, U> {
    pub manifold: KernelManifold<'a, M, C>,
    pub contacts: U,
    pub is_kept: bool,
}

impl<'a, M, C, U> ManifoldSink<'a, M, C, U> {
    #[inline(always)]
    pub fn new(manifold: KernelManifold<'a, M, C>, contacts: U) -> Self {
        Self {
            manifold,
            contacts,
            is_kept: false,
        }
    }

    /// What the query's stage counts as.
    #[inline(always)]
    pub fn stage(&self, stage: Stage) -> Stage {
        if self.is_kept && stage == Stage::Feature {
            Stage::Kept
        } else {
            stage
        }
    }
}

// perf: in calls the answers would go through memory, which pairs that are apart notice.
impl<M, C: Default + Copy, U: UpdateContacts> Sink for ManifoldSink<'_, M, C, U> {
    #[inline(always)]
    fn memory(&self) -> PairMemory {
        self.manifold.memory()
    }

    #[inline(always)]
    fn spheres_apart(&mut self) {
        self.manifold.forget();
    }

    #[inline(always)]
    fn separated(&mut self, apart: &SeparatingAxis) {
        self.manifold.set_axis(apart.axis, apart.ids);
    }

    #[inline(always)]
    fn near(&mut self, near: &Proximity) {
        self.is_kept = self.contacts.update_contacts(&mut self.manifold, near);
    }
}
