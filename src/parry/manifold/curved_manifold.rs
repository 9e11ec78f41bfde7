//! What the update of a curved pair needs of its manifold, whatever data the solver keeps there.

use glam::{DVec3, Vec3};
use parry3d::query::ContactManifold;

use super::normals::Normals;
use super::record::{AxisFrame, KernelManifold};
use crate::curved::Hint;
use crate::manifold::Contacts;
use crate::parry::order::PairOrder;
use crate::pose::RelativePose;
use crate::query::{LastContacts, PairMemory};
use crate::support::VertexId;

/// A manifold of any solver, in the kernels' order. The data type is behind these functions, so that the update of
/// each pair is compiled once, with this crate, and not again in every program that steps a world.
pub(super) trait CurvedManifold {
    fn last_contacts(&mut self, order: PairOrder, pose: &RelativePose) -> Option<LastContacts>;

    /// What is remembered of the pair. With `borders` around them, the cores may be apart although the shapes
    /// overlap.
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

    /// Leaves the contacts where they are, if that is right.
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
        kernel_manifold(self, order).last_contacts(pose)
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

/// A manifold of which no axis is read or written.
fn kernel_manifold<M, C>(
    manifold: &mut ContactManifold<M, C>,
    order: PairOrder,
) -> KernelManifold<'_, M, C> {
    KernelManifold::with_borders(manifold, order, AxisFrame::First)
}
