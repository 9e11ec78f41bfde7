//! Manifolds of pairs with a cylinder or a cone.

use glam::{DVec3, Vec3};
use parry3d::math::Pose;
use parry3d::query::Unsupported;

use super::axis_frame::AxisFrame;
use super::kernel_manifold::KernelManifold;
use super::normals::Normals;
use super::own_contacts::{OwnCheck, ids};
use super::still::{PresentContacts, Still};
use super::update::UpdateManifold;
use crate::curved::{self, CurvedAnswer, CurvedQuery, Hint, Patch, SurfacePieces};
use crate::manifold::Contacts;
use crate::parry::constraints::{ConstrainedPair, Constraints, Corrected};
use crate::parry::pair::{Pair, valid_pose};
use crate::parry::still_cache::{StillCache, StillPair};
use crate::parry::workspace::Workspace;
use crate::query::{Feature, LastContacts, Proximity};
use crate::stats::{Cost, Stage};
use crate::support::{Cso, FaceId};
use crate::tolerance::DEPTH_GAP;
use crate::tuning::ABSURD_DEPTH;

impl UpdateManifold<'_> {
    /// For two shapes, at least one of which is curved.
    pub fn update_curved<A: SurfacePieces, B: SurfacePieces>(
        &mut self,
        pair: &Pair<'_, B, A>,
        workspace: &mut Workspace,
    ) -> Result<(), Unsupported> {
        let pose = pair.pose(valid_pose(self.pos12)?);
        let cso = pair.cso(&pose);
        let borders = pair.border_radii[0] + pair.border_radii[1];
        let max_distance = f64::from(self.prediction) + pair.touching(cso.size());
        let mut present = PresentContacts::default();
        let still_pair = |rotation, key| StillPair::of(&cso, rotation, key);
        let at = (&pose, max_distance + borders);
        if self.hold_if_proved(pair, at, &mut present, &workspace.still_cache, still_pair) {
            return Ok(());
        }
        self.query_curved(pair, &cso, max_distance, &mut present, workspace)
    }

    /// Up to a maximum distance of the shapes with their borders.
    fn query_curved<A: SurfacePieces, B: SurfacePieces>(
        &mut self,
        pair: &Pair<'_, B, A>,
        cso: &Cso<'_, A, B>,
        max_distance: f64,
        present: &mut PresentContacts,
        workspace: &mut Workspace,
    ) -> Result<(), Unsupported> {
        let borders = pair.border_radii[0] + pair.border_radii[1];
        let (order, frame) = (pair.order, AxisFrame::of(cso, pair.order));
        let mut manifold = KernelManifold::with_borders(&mut self.manifold, order, frame);
        if present.last.is_none() {
            manifold.read_contacts(cso.pose, &mut present.last);
        }
        let mut cost = Cost::default();
        let last = present.last.as_ref();
        let hint = manifold.hint(cso, last);
        let mut query = CurvedQuery {
            cso,
            border_radii: pair.border_radii,
            max_distance: max_distance + borders,
            last,
            scratch: &mut workspace.curved,
            cost: &mut cost,
        };
        let (answer, mut stage) = query.run(hint).ok_or(Unsupported)?;
        match answer {
            CurvedAnswer::SpheresApart => manifold.forget(),
            CurvedAnswer::Separated(apart) => manifold.set_axis(apart.axis, apart.ids, cso.pose),
            CurvedAnswer::Near {
                signed_distance,
                normal,
                on_1,
            } => {
                let near = Near {
                    cso,
                    border_radii: pair.border_radii,
                    least: signed_distance - borders,
                    normal,
                    on_1,
                    max_distance,
                    last,
                    hint,
                };
                let constraints = (self.constraints, self.pos12);
                let still = present.still.as_ref();
                let is_kept = near.update_contacts(constraints, &mut manifold, still, workspace);
                if is_kept && stage == Stage::Feature {
                    stage = Stage::Kept;
                }
            }
        }
        self.stats.record(stage, &cost);
        Ok(())
    }
}

/// Shapes that are near each other.
struct Near<'a, 'c, A, B> {
    cso: &'a Cso<'c, A, B>,
    border_radii: [f64; 2],
    /// The signed distance with the borders.
    least: f64,
    normal: DVec3,
    on_1: DVec3,
    max_distance: f64,
    last: Option<&'a LastContacts>,
    hint: Hint,
}

impl<A: SurfacePieces, B: SurfacePieces> Near<'_, '_, A, B> {
    fn proximity(&self) -> Proximity {
        Proximity {
            signed_distance: self.least,
            normal: self.normal,
            on_1: self.on_1,
            on_2: self.on_1 + self.normal * self.least,
            features: [Feature::Face(FaceId::default()); 2],
        }
    }

    /// Leaves the contacts as they are, keeps their places, or chooses new ones. Returns whether they stayed.
    fn update_contacts(
        &self,
        constraints: (&[Constraints<'_>; 2], &Pose),
        manifold: &mut KernelManifold<'_, '_>,
        still: Option<&Still>,
        workspace: &mut Workspace,
    ) -> bool {
        if let Some(still) = still.filter(|still| still.shows(self.least))
            && let Some(last) = self.last
        {
            if !still.is_of(self.cso, (manifold, self.border_radii), last) {
                let near = Near {
                    last: None,
                    ..*self
                };
                return near.update_contacts(constraints, manifold, None, workspace);
            }
            manifold.manifold.hold(still);
            let core_distance = self.least + self.border_radii[0] + self.border_radii[1];
            still.store(&mut workspace.still_cache, core_distance);
            return true;
        }
        let normals = Normals::of(&self.proximity(), self.cso.pose);
        if Constraints::are_none(constraints.0) {
            let is_kept = self.keep(manifold, &normals, &mut workspace.still_cache);
            if !is_kept {
                let contacts = self.along_normal(&mut workspace.curved.patch);
                manifold.set_contacts(normals.rounded, &contacts);
                manifold.note_chosen(ids(self.cso), &mut workspace.still_cache);
            }
            return is_kept;
        }
        self.update_constrained(constraints, manifold, &normals, workspace)
    }

    /// Keeps the contacts where they are, if they are still in place.
    fn keep(
        &self,
        manifold: &mut KernelManifold<'_, '_>,
        normals: &Normals,
        cache: &mut StillCache,
    ) -> bool {
        let (cso, key) = (self.cso, manifold.manifold.key());
        let check = OwnCheck { cache, key };
        let are_own =
            |last: &LastContacts, normals| check.passes(cso, self.border_radii, last, normals);
        let (last, radius) = (self.last, cso.min_radius());
        !matches!(self.hint, Hint::Contact(before) if cso.rolls(before, normals.exact))
            && (manifold.keep_places(last, self.least, normals, radius, are_own)).is_some()
    }

    /// The contacts along the normal of the query, whose patch is begun.
    fn along_normal(&self, patch: &mut Patch) -> Contacts {
        patch.complete_beside_deepest(self.cso, self.border_radii);
        if let (Some(_), Hint::Contact([first, second])) = (self.last, self.hint) {
            let before = [first, self.cso.pose.direction_to_1(second)];
            patch.lead(before, self.max_distance);
        }
        self.contacts(patch)
    }

    fn contacts(&self, patch: &Patch) -> Contacts {
        self.contacts_at(patch, (self.on_1, self.least))
    }

    fn contacts_at(&self, patch: &Patch, deepest: (DVec3, f64)) -> Contacts {
        let scale = self.cso.min_radius();
        curved::contacts(patch, self.cso.pose, deepest, self.max_distance, scale)
    }

    /// Keeps the contacts where they are, or chooses new ones along normals that the constraints correct. Returns
    /// whether they stayed.
    fn update_constrained(
        &self,
        (constraints, pos12): (&[Constraints<'_>; 2], &Pose),
        manifold: &mut KernelManifold<'_, '_>,
        normals: &Normals,
        workspace: &mut Workspace,
    ) -> bool {
        let border = self.border_radii[0] + self.border_radii[1];
        let pair = ConstrainedPair {
            cso: self.cso,
            order: manifold.order,
            constraints: *constraints,
            pos12,
            max_distance: self.max_distance + border,
            border,
        };
        let corrected = pair.correct(pair.order.to_caller(normals.rounded));
        let is_as_it_was = pair.leaves(corrected.as_ref(), normals.rounded);
        if is_as_it_was && self.keep(manifold, normals, &mut workspace.still_cache) {
            return true;
        }
        let patch = &mut workspace.curved.patch;
        let chosen = if is_as_it_was {
            Some((normals.rounded, self.along_normal(patch)))
        } else {
            corrected.and_then(|corrected| self.along_corrected(&pair, normals, &corrected, patch))
        };
        let along = |out: &Corrected| self.along(&pair, out, patch);
        match pair.uncovered(chosen, self.least, along) {
            Some((normals, contacts)) => manifold.set_contacts(normals, &contacts),
            // There is no contact, but the next query has a place to start from.
            None => manifold.set_axis(self.normal, Default::default(), self.cso.pose),
        }
        false
    }

    /// The contacts along a corrected normal, or the query's. What rolls over a triangle is deepest over another.
    fn along_corrected(
        &self,
        pair: &ConstrainedPair<'_, '_, A, B>,
        normals: &Normals,
        corrected: &Corrected,
        patch: &mut Patch,
    ) -> Option<([Vec3; 2], Contacts)> {
        let is_absurd = self.find_along(pair, corrected, patch);
        let found = self.within_reach(pair, corrected, patch);
        if found.is_some() || self.least >= 0.0 {
            return found;
        } else if pair.obeys() {
            return pair.at_witness(&self.proximity(), corrected, self.max_distance);
        } else if !(is_absurd || pair.is_beyond_border()) {
            return None;
        }
        // Overlapping shapes must be pushed apart, even if not along the corrected normal.
        patch.find(self.cso, self.normal, self.border_radii);
        Some((normals.rounded, self.contacts(patch)))
    }

    fn along(
        &self,
        pair: &ConstrainedPair<'_, '_, A, B>,
        corrected: &Corrected,
        patch: &mut Patch,
    ) -> Option<([Vec3; 2], Contacts)> {
        self.find_along(pair, corrected, patch);
        self.within_reach(pair, corrected, patch)
    }

    /// Finds the places along a corrected normal, up to the depth that is possible. Whether all of them are
    /// deeper than the query's depth makes believable.
    fn find_along(
        &self,
        pair: &ConstrainedPair<'_, '_, A, B>,
        corrected: &Corrected,
        patch: &mut Patch,
    ) -> bool {
        let [normal, _] = pair.order.to_kernel(corrected.normals);
        let normal = normal.as_dvec3().normalize();
        patch.find(self.cso, normal, self.border_radii);
        patch.leave_out_corners_beside_lines();
        let least = corrected.least.map(|least| least - pair.border);
        let least = least.unwrap_or(ABSURD_DEPTH * self.least.min(0.0));
        let least = least - DEPTH_GAP * self.cso.min_radius();
        let is_found = patch.deepest_point().is_some();
        patch.retain(least..=f64::INFINITY);
        is_found && patch.deepest_point().is_none()
    }

    /// The contacts at the places of a patch, if any is within reach.
    fn within_reach(
        &self,
        pair: &ConstrainedPair<'_, '_, A, B>,
        corrected: &Corrected,
        patch: &mut Patch,
    ) -> Option<([Vec3; 2], Contacts)> {
        patch.retain(f64::NEG_INFINITY..=self.max_distance);
        let deepest = patch.deepest_point()?;
        let normals = pair.order.to_kernel(corrected.normals);
        Some((normals, self.contacts_at(patch, deepest)))
    }
}
