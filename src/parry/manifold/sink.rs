//! Writes the answer of a query into a manifold.

use super::axis_frame::AxisFrame;
use super::erased::ErasedManifold;
use super::kernel_manifold::KernelManifold;
use super::own_contacts::ids;
use super::polytopes::PolytopeContacts;
use super::still::{PresentContacts, Still};
use crate::gjk::SeparatingAxis;
use crate::parry::pair::Pair;
use crate::query::{FlushFaces, LastContacts, PairMemory, Proximity, Sink};
use crate::stats::Stage;
use crate::support::{Cso, Polytope, Support};

/// Brings a manifold up to date. It holds only references: most pairs are apart, and copies that only contacts
/// need would cost them more than the rest.
pub(super) struct ManifoldSink<'a, 'm, A, B> {
    manifold: &'a mut ErasedManifold<'m>,
    pair: &'a Pair<'a, B, A>,
    frame: AxisFrame<'a>,
    contacts: PolytopeContacts<'a, A, B>,
    /// The contacts of the manifold. They are read when they are first needed.
    last: &'a mut Option<LastContacts>,
    /// The same, if they may stay as they are.
    still: Option<&'a Still>,
    is_kept: bool,
    /// The separation that is proved by what the manifold remembers, if it need not change.
    still_apart: Option<f64>,
}

impl<'a, 'm, A: Polytope, B: Polytope> ManifoldSink<'a, 'm, A, B> {
    /// A sink for a manifold. `present` are its contacts, as far as they are read.
    #[inline(always)]
    pub fn new(
        manifold: &'a mut ErasedManifold<'m>,
        pair: &'a Pair<'a, B, A>,
        frame: AxisFrame<'a>,
        contacts: PolytopeContacts<'a, A, B>,
        present: &'a mut PresentContacts,
    ) -> Self {
        Self {
            manifold,
            pair,
            frame,
            contacts,
            last: &mut present.last,
            still: present.still.as_ref(),
            is_kept: false,
            still_apart: None,
        }
    }

    #[inline(always)]
    fn kernel_manifold(&mut self) -> KernelManifold<'_, 'm> {
        KernelManifold::new(self.manifold, self.pair, self.frame)
    }

    /// The separation, if what the manifold already remembers still proves that the shapes are apart.
    #[inline]
    pub fn still_apart(
        &self,
        stage: Stage,
        cso: &Cso<'_, impl Support, impl Support>,
    ) -> Option<f64> {
        match stage {
            Stage::BoundingSpheres => Some(cso.center().length() - cso.size()),
            _ => self.still_apart,
        }
    }

    /// The stage to count: the query's, unless the contacts stayed where they were.
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
impl<A: Polytope, B: Polytope> Sink for ManifoldSink<'_, '_, A, B> {
    #[inline(always)]
    fn memory(&mut self) -> PairMemory {
        let manifold = KernelManifold::new(self.manifold, self.pair, self.frame);
        if !manifold.manifold.is_empty() && self.last.is_none() {
            manifold.read_contacts(self.contacts.cso.pose, self.last);
        }
        manifold.memory_of(self.contacts.cso, self.last.as_ref())
    }

    #[inline]
    fn flush_faces(&mut self) -> Option<FlushFaces> {
        let manifold = KernelManifold::new(self.manifold, self.pair, self.frame);
        manifold.flush_faces(self.contacts.cso, self.last.as_ref()?)
    }

    #[inline(always)]
    fn spheres_apart(&mut self) {
        let mut manifold = self.kernel_manifold();
        if !manifold.manifold.is_empty() || manifold.keeps_axis_in_second() {
            manifold.forget();
        }
    }

    /// The manifold stays as it is, with the vertices of the first proof. So nothing depends on whether this was
    /// found here or in the cache of proofs.
    #[inline]
    fn still_separated(&mut self, apart: &SeparatingAxis) {
        if self.manifold.is_empty() {
            let pose = self.contacts.cso.pose;
            let mut manifold = self.kernel_manifold();
            if manifold.keeps_axis_in_second() {
                manifold.turn_axis(apart.axis, pose);
            } else {
                self.still_apart = Some(apart.separation);
            }
        } else {
            self.separated(apart);
        }
    }

    #[inline(always)]
    fn separated(&mut self, apart: &SeparatingAxis) {
        let pose = self.contacts.cso.pose;
        self.kernel_manifold().set_axis(apart.axis, apart.ids, pose);
    }

    #[inline(always)]
    fn near(&mut self, near: &Proximity) {
        let mut manifold = KernelManifold::new(self.manifold, self.pair, self.frame);
        let [border_1, border_2] = self.pair.border_radii;
        if let Some(still) = self.still
            && still.shows(near.signed_distance - (border_1 + border_2))
            && let Some(last) = self.last.as_ref()
        {
            if still.is_of(self.contacts.cso, (&manifold, self.pair.border_radii), last) {
                manifold.manifold.hold(still);
                self.is_kept = true;
                still.store(self.contacts.still_cache, near.signed_distance);
                return;
            }
            *self.last = None;
        }
        let last = self.last.as_ref();
        self.is_kept = self.contacts.update_contacts(&mut manifold, last, near);
        if !self.is_kept && self.contacts.is_free() {
            manifold.note_chosen(ids(self.contacts.cso), self.contacts.still_cache);
        }
    }
}
