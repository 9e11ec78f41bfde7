//! The contacts of a hull and another polytope.

use glam::Vec3;
use parry3d::math::Pose;

use super::normals::Normals;
use super::record::KernelManifold;
use super::sink::UpdateContacts;
use crate::hull::Hull;
use crate::manifold::{self, ClipScratch, Contacts};
use crate::parry::constraints::{self, Constraints};
use crate::pose::RelativePose;
use crate::query::{self, FlushFaces, LastContacts, Proximity};
use crate::support::{Cso, Polytope};
use crate::tolerance::UNCORRECTED;

pub(super) struct PolytopeContacts<'a, 'c, B> {
    pub cso: &'a Cso<'c, Hull, B>,
    pub max_distance: f64,
    /// In the caller's order, as `pos12`.
    pub constraints: &'a [Constraints<'a>; 2],
    pub pos12: &'a Pose,
    pub scratch: &'a mut ClipScratch,
}

impl<B: Polytope> UpdateContacts for PolytopeContacts<'_, '_, B> {
    #[inline(always)]
    fn pose(&self) -> Option<&RelativePose> {
        Some(self.cso.pose)
    }

    fn flush_faces<M, C>(
        &self,
        manifold: &KernelManifold<'_, M, C>,
        last: &LastContacts,
    ) -> Option<FlushFaces> {
        manifold.flush_faces(self.cso, last)
    }

    /// Leaves the contacts where they are, if that is right, or chooses them anew.
    #[inline(always)]
    fn update_contacts<M, C: Default + Copy>(
        &mut self,
        manifold: &mut KernelManifold<'_, M, C>,
        last: Option<&LastContacts>,
        near: &Proximity,
    ) -> bool {
        let normals = Normals::of(near, self.cso.pose);
        if !matches!(self.constraints, [Constraints::None, Constraints::None]) {
            // Only parts of meshes and compounds have some. (A copy: that of other pairs stays in registers.)
            let contacts = PolytopeContacts {
                scratch: &mut *self.scratch,
                ..*self
            };
            return contacts.update_constrained(manifold, last, near, &normals);
        }
        let is_kept = manifold.keep_contacts(last, near, &normals, self.cso.min_radius());
        if !is_kept {
            let contacts = manifold::contacts(self.cso, near, self.max_distance, self.scratch);
            manifold.set_contacts(normals.rounded, &contacts);
        }
        is_kept
    }
}

impl<B: Polytope> PolytopeContacts<'_, '_, B> {
    /// The same along normals that the constraints correct.
    fn update_constrained<M, C: Default + Copy>(
        self,
        manifold: &mut KernelManifold<'_, M, C>,
        last: Option<&LastContacts>,
        near: &Proximity,
        normals: &Normals,
    ) -> bool {
        let (cso, max_distance) = (self.cso, self.max_distance);
        let corrected = constraints::correct(
            *self.constraints,
            self.pos12,
            (cso, manifold.order),
            max_distance,
            manifold.order.to_caller(normals.rounded),
        );
        let corrected = corrected.map(|corrected| manifold.order.to_kernel(corrected));
        let contacts = match corrected {
            None => None,
            // The query's depth says nothing about contacts along a corrected normal.
            Some(corrected) if !corrected[0].abs_diff_eq(normals.rounded[0], UNCORRECTED) => {
                let normal = corrected[0].as_dvec3().normalize();
                manifold::contacts_along(cso, near, normal, max_distance, &mut *self.scratch)
                    .map(|contacts| (corrected, contacts))
                    // What overlaps must be pushed out, if not along the corrected normal.
                    .or_else(|| {
                        (near.signed_distance < 0.0).then(|| self.along_normal(near, normals))
                    })
            }
            Some(_) => {
                if manifold.keep_contacts(last, near, normals, cso.min_radius()) {
                    return true;
                }
                Some(self.along_normal(near, normals))
            }
        };
        match contacts {
            Some((normals, contacts)) => manifold.set_contacts(normals, &contacts),
            // Discarded: there is no contact, but there is a place to start from.
            None => manifold.set_axis(near.normal, query::vertices(cso, near.features)),
        }
        false
    }

    fn along_normal(self, near: &Proximity, normals: &Normals) -> ([Vec3; 2], Contacts) {
        let contacts = manifold::contacts(self.cso, near, self.max_distance, self.scratch);
        (normals.rounded, contacts)
    }
}
