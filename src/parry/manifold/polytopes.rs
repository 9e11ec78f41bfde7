//! The contacts of two polytopes.

use glam::Vec3;
use parry3d::math::Pose;

use super::kernel_manifold::KernelManifold;
use super::normals::Normals;
use super::own_contacts::OwnCheck;
use crate::manifold::{self, ClipScratch, Contacts};
use crate::map_pair::map_pair;
use crate::parry::constraints::{ConstrainedPair, Constraints, Corrected};
use crate::parry::still_cache::StillCache;
use crate::query::{self, LastContacts, Proximity};
use crate::support::{Cso, Polytope};
use crate::tuning::ABSURD_DEPTH;

pub(super) struct PolytopeContacts<'a, A, B> {
    pub cso: &'a Cso<'a, A, B>,
    pub max_distance: f64,
    /// In the caller's order, as `pos12`.
    pub constraints: &'a [Constraints<'a>; 2],
    pub pos12: &'a Pose,
    pub scratch: &'a mut ClipScratch,
    pub still_cache: &'a mut StillCache,
}

impl<A: Polytope, B: Polytope> PolytopeContacts<'_, A, B> {
    /// Whether nothing constrains the normals.
    #[inline]
    pub fn is_free(&self) -> bool {
        Constraints::are_none(self.constraints)
    }

    /// Writes the contacts, or leaves the `last` ones where they are. Returns whether it left them.
    #[inline(always)]
    pub fn update_contacts(
        &mut self,
        manifold: &mut KernelManifold<'_, '_>,
        last: Option<&LastContacts>,
        near: &Proximity,
    ) -> bool {
        let normals = Normals::of(near, self.cso.pose);
        if !self.is_free() {
            // Only parts of meshes and compounds have constraints. The copy keeps the answer of other pairs
            // in registers.
            let contacts = PolytopeContacts {
                scratch: &mut *self.scratch,
                still_cache: &mut *self.still_cache,
                ..*self
            };
            return contacts.update_constrained(manifold, last, near, &normals);
        }
        let is_kept = self.keep(manifold, last, near, &normals);
        if !is_kept {
            let mut contacts = manifold::contacts(self.cso, near, self.max_distance, self.scratch);
            if manifold.border_radii != [0.0; 2] && contacts.len > 1 {
                let (least, borders) = (near.signed_distance, manifold.border_radii);
                contacts.fit_to_borders(self.cso, normals.exact, borders, least);
            }
            manifold.set_contacts(normals.rounded, &contacts);
        }
        is_kept
    }

    /// Keeps the contacts where they are, if they are still in place.
    #[inline]
    fn keep(
        &mut self,
        manifold: &mut KernelManifold<'_, '_>,
        last: Option<&LastContacts>,
        near: &Proximity,
        normals: &Normals,
    ) -> bool {
        let (cso, border_radii) = (self.cso, manifold.border_radii);
        let check = OwnCheck {
            cache: &mut *self.still_cache,
            key: manifold.manifold.key(),
        };
        let are_own = |last: &LastContacts, normals| check.passes(cso, border_radii, last, normals);
        !manifold.has_rolled(cso, normals.exact)
            && manifold.keep_contacts(last, near, normals, cso.min_radius(), are_own)
    }

    /// Like [`update_contacts`](Self::update_contacts), along normals that the constraints correct.
    fn update_constrained(
        mut self,
        manifold: &mut KernelManifold<'_, '_>,
        last: Option<&LastContacts>,
        near: &Proximity,
        normals: &Normals,
    ) -> bool {
        let cso = self.cso;
        let pair = ConstrainedPair {
            cso,
            order: manifold.order,
            constraints: *self.constraints,
            pos12: self.pos12,
            max_distance: self.max_distance,
            border: manifold.border_radii.iter().sum(),
        };
        let corrected = pair.correct(pair.order.to_caller(normals.rounded));
        let is_as_it_was = pair.leaves(corrected.as_ref(), normals.rounded);
        if is_as_it_was && self.keep(manifold, last, near, normals) {
            return true;
        }
        let contacts = if is_as_it_was {
            Some(self.along_normal(near, normals))
        } else {
            corrected.and_then(|corrected| self.along_corrected(&pair, near, normals, &corrected))
        };
        let along = |out: &Corrected| self.along(&pair, near, out);
        match pair.uncovered(contacts, pair.least(near), along) {
            Some((normals, contacts)) => write_corrected(cso, manifold, normals, contacts),
            // There is no contact, but the next query has a place to start from.
            None => {
                let vertices = query::vertices(cso, near.features);
                manifold.set_axis(near.normal, vertices, cso.pose);
            }
        }
        false
    }

    fn along_normal(&mut self, near: &Proximity, normals: &Normals) -> ([Vec3; 2], Contacts) {
        let contacts = manifold::contacts(self.cso, near, self.max_distance, self.scratch);
        (normals.rounded, contacts)
    }

    fn along_corrected(
        &mut self,
        pair: &ConstrainedPair<'_, '_, A, B>,
        near: &Proximity,
        normals: &Normals,
        corrected: &Corrected,
    ) -> Option<([Vec3; 2], Contacts)> {
        let found = self.along(pair, near, corrected);
        let is_edge_on = found.is_none();
        let found = found.filter(|(_, contacts)| contacts.len > 0);
        if found.is_some() || pair.least(near) >= 0.0 {
            return found;
        } else if pair.obeys() {
            return pair.at_witness(near, corrected, self.max_distance);
        } else if !(is_edge_on || pair.is_beyond_border()) {
            return None;
        }
        // Overlapping shapes must be pushed apart, even if not along the corrected normal.
        Some(self.along_normal(near, normals))
    }

    fn along(
        &mut self,
        pair: &ConstrainedPair<'_, '_, A, B>,
        near: &Proximity,
        corrected: &Corrected,
    ) -> Option<([Vec3; 2], Contacts)> {
        let normals = pair.order.to_kernel(corrected.normals);
        let normal = normals[0].as_dvec3().normalize();
        // The query's depth says little about contacts along a corrected normal.
        let absurd = || ABSURD_DEPTH * pair.least(near).min(0.0) + pair.border;
        let range = [corrected.least.unwrap_or_else(absurd), self.max_distance];
        let contacts = manifold::contacts_along(self.cso, near, normal, range, self.scratch)?;
        Some((normals, contacts))
    }
}

impl<A: Polytope, B: Polytope> ConstrainedPair<'_, '_, A, B> {
    /// The signed distance of the shapes with their borders.
    fn least(&self, near: &Proximity) -> f64 {
        near.signed_distance - self.border
    }
}

/// Writes contacts along normals that are not the query's.
fn write_corrected<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    manifold: &mut KernelManifold<'_, '_>,
    normals: [Vec3; 2],
    mut contacts: Contacts,
) {
    let borders = manifold.border_radii;
    if borders != [0.0; 2] {
        let along = map_pair(normals, |normal| normal.as_dvec3());
        contacts.fit_to_borders(cso, along, borders, f64::NEG_INFINITY);
    }
    manifold.set_contacts(normals, &contacts);
}
