//! The contacts of a hull and another polytope.

use glam::Vec3;
use parry3d::math::Pose;

use super::kept::Present;
use super::normals::Normals;
use super::record::KernelManifold;
use super::sink::UpdateContacts;
use crate::hull::Hull;
use crate::manifold::{self, ClipScratch};
use crate::parry::constraints::{self, Constraints};
use crate::parry::order::PairOrder;
use crate::query::{self, Proximity};
use crate::support::{Cso, Polytope};
use crate::tolerance::UNCORRECTED;

pub(super) struct PolytopeContacts<'a, 'c, B> {
    pub cso: &'a Cso<'c, Hull, B>,
    pub max_distance: f64,
    /// In the caller's order, as `pos12`.
    pub constraints: [Constraints<'a>; 2],
    pub pos12: &'a Pose,
    pub scratch: &'a mut ClipScratch,
}

impl<B: Polytope> UpdateContacts for PolytopeContacts<'_, '_, B> {
    /// Leaves the contacts where they are, if that is right, or chooses them anew.
    #[inline(always)]
    fn update_contacts<M, C: Default + Copy>(
        &mut self,
        manifold: &mut KernelManifold<'_, M, C>,
        near: &Proximity,
    ) -> bool {
        let normals = Normals::of(near, self.cso.pose);
        let Some(constrained) = self.constrained(manifold.order, normals.rounded) else {
            // Discarded: there is no contact, but there is a place to start from.
            self.set_hint(manifold, near);
            return false;
        };
        // The query's depth says nothing about contacts along a corrected normal.
        if !constrained[0].abs_diff_eq(normals.rounded[0], UNCORRECTED) {
            self.set_corrected(manifold, near, (constrained, &normals));
            return false;
        }
        let is_kept = manifold.keep_contacts(&Present {
            pose: self.cso.pose,
            normals: &normals,
            signed_distance: near.signed_distance,
            radius: self.cso.min_radius(),
        });
        if !is_kept {
            self.set_contacts(manifold, near, &normals);
        }
        is_kept
    }
}

impl<B: Polytope> PolytopeContacts<'_, '_, B> {
    /// Chooses contacts along the query's normal.
    fn set_contacts<M, C: Default + Copy>(
        &mut self,
        manifold: &mut KernelManifold<'_, M, C>,
        near: &Proximity,
        normals: &Normals,
    ) {
        let contacts = manifold::contacts(self.cso, near, self.max_distance, self.scratch);
        manifold.set_contacts(normals.rounded, &contacts);
    }

    /// Chooses contacts along corrected normals, if each shape has a face that looks along its own.
    fn set_corrected<M, C: Default + Copy>(
        &mut self,
        manifold: &mut KernelManifold<'_, M, C>,
        near: &Proximity,
        (corrected, normals): ([Vec3; 2], &Normals),
    ) {
        let normal = corrected[0].as_dvec3().normalize();
        let contacts =
            manifold::contacts_along(self.cso, near, normal, self.max_distance, self.scratch);
        match contacts {
            Some(contacts) => manifold.set_contacts(corrected, &contacts),
            // What overlaps must be pushed out, if not along the corrected normal.
            None if near.signed_distance < 0.0 => self.set_contacts(manifold, near, normals),
            None => self.set_hint(manifold, near),
        }
    }

    /// Leaves a contact that was discarded, as a place for the next query to start from.
    fn set_hint<M, C>(&self, manifold: &mut KernelManifold<'_, M, C>, near: &Proximity) {
        manifold.set_axis(near.normal, query::vertices(self.cso, near.features));
    }

    /// The contact's normals as the constraints leave them, if they do.
    #[inline(always)]
    fn constrained(&self, order: PairOrder, normals: [Vec3; 2]) -> Option<[Vec3; 2]> {
        match self.constraints {
            // Only parts of meshes and compounds have some.
            [Constraints::None, Constraints::None] => Some(normals),
            both => constraints::correct(
                both,
                self.pos12,
                (self.cso, order),
                self.max_distance,
                order.to_caller(normals),
            )
            .map(|corrected| order.to_kernel(corrected)),
        }
    }
}
