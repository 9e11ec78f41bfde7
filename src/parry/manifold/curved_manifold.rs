//! The interface of a manifold to the update of a curved pair, whatever data the solver keeps in it.

use glam::{DVec3, Vec3};
use parry3d::query::ContactManifold;

use super::kernel_manifold::{AxisFrame, KernelManifold, key_of};
use super::normals::Normals;
use super::still::{SettledContacts, Still, is_settled};
use crate::curved::Hint;
use crate::manifold::Contacts;
use crate::parry::order::PairOrder;
use crate::parry::still_cache::StillPair;
use crate::pose::RelativePose;
use crate::query::{LastContacts, PairMemory};
use crate::support::VertexId;

/// A manifold of any solver, in the kernels' order. It hides the type of the solver's data, so that updates
/// are compiled once, with this crate, and not in every program that steps a world.
pub(super) trait CurvedManifold {
    fn last_contacts(&mut self, order: PairOrder, pose: &RelativePose) -> Option<LastContacts>;

    /// The manifold's key, if the shapes hardly turned against its normals.
    fn settled_key(&self, order: PairOrder, pose: &RelativePose) -> Option<u64>;

    /// The contacts of such a manifold.
    fn settled_contacts(
        &mut self,
        order: PairOrder,
        pose: &RelativePose,
        pair: StillPair,
    ) -> Option<SettledContacts>;

    /// Leaves the contacts as they are, at their distances now.
    fn hold(&mut self, still: &Still);

    /// The memory of the pair. The cores may be apart although the shapes, with their `borders`, overlap.
    fn hint(&mut self, order: PairOrder, frame: AxisFrame<'_>, borders: f64) -> Hint;

    fn forget(&mut self);

    fn set_axis(
        &mut self,
        order: PairOrder,
        frame: AxisFrame<'_>,
        axis: DVec3,
        vertices: [VertexId; 2],
    );

    fn set_contacts(&mut self, order: PairOrder, normals: [Vec3; 2], contacts: &Contacts);

    /// Keeps the contacts where they are, if the shapes hardly moved.
    fn keep_places(
        &mut self,
        order: PairOrder,
        last: Option<&LastContacts>,
        least: f64,
        normals: &Normals,
        radius: f64,
    ) -> bool;
}

impl<M, C: Default + Copy> CurvedManifold for ContactManifold<M, C> {
    fn last_contacts(&mut self, order: PairOrder, pose: &RelativePose) -> Option<LastContacts> {
        let mut last = None;
        kernel_manifold(self, order).read_contacts(pose, &mut last);
        last
    }

    fn settled_key(&self, order: PairOrder, pose: &RelativePose) -> Option<u64> {
        is_settled(self, order, pose).then(|| key_of(self))
    }

    fn settled_contacts(
        &mut self,
        order: PairOrder,
        pose: &RelativePose,
        pair: StillPair,
    ) -> Option<SettledContacts> {
        let mut settled = None;
        SettledContacts::read(&kernel_manifold(self, order), pose, pair, &mut settled);
        settled
    }

    fn hold(&mut self, still: &Still) {
        kernel_manifold(self, PairOrder::Given).hold(still);
    }

    fn hint(&mut self, order: PairOrder, frame: AxisFrame<'_>, borders: f64) -> Hint {
        let manifold = KernelManifold::with_borders(self, order, frame);
        if let Some(least) = manifold.least_distance() {
            return match manifold.normals() {
                Some(normals) => Hint::Contact(normals, f64::from(least) + borders < 0.0),
                None => Hint::None,
            };
        }
        match manifold.memory(None) {
            PairMemory::Axis(axis, ids) => Hint::Apart(axis, ids),
            _ => Hint::None,
        }
    }

    fn forget(&mut self) {
        kernel_manifold(self, PairOrder::Given).forget();
    }

    fn set_axis(
        &mut self,
        order: PairOrder,
        frame: AxisFrame<'_>,
        axis: DVec3,
        vertices: [VertexId; 2],
    ) {
        KernelManifold::with_borders(self, order, frame).set_axis(axis, vertices);
    }

    fn set_contacts(&mut self, order: PairOrder, normals: [Vec3; 2], contacts: &Contacts) {
        kernel_manifold(self, order).set_contacts(normals, contacts);
    }

    fn keep_places(
        &mut self,
        order: PairOrder,
        last: Option<&LastContacts>,
        least: f64,
        normals: &Normals,
        radius: f64,
    ) -> bool {
        kernel_manifold(self, order)
            .keep_places(last, least, normals, radius)
            .is_some()
    }
}

/// A manifold whose axis is neither read nor written.
fn kernel_manifold<M, C>(
    manifold: &mut ContactManifold<M, C>,
    order: PairOrder,
) -> KernelManifold<'_, M, C> {
    KernelManifold::with_borders(manifold, order, AxisFrame::First)
}
