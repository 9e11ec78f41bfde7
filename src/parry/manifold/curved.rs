//! Manifolds of pairs with a cylinder or a cone.

use glam::{DVec3, Vec3};
use parry3d::math::Pose;
use parry3d::query::Unsupported;

use super::kernel_manifold::{AxisFrame, KernelManifold};
use super::normals::Normals;
use super::still::Still;
use super::update::UpdateManifold;
use crate::curved::{self, CurvedAnswer, CurvedQuery, Hint, Patch, SurfacePieces};
use crate::manifold::Contacts;
use crate::parry::constraints::{ConstrainedPair, Constraints};
use crate::parry::pair::{Pair, valid_pose};
use crate::parry::still_cache::StillPair;
use crate::parry::workspace::Workspace;
use crate::query::{Feature, LastContacts, PairMemory, Proximity};
use crate::stats::{Cost, Stage};
use crate::support::{Cso, FaceId, VertexId};
use crate::tolerance::{DEPTH_GAP, UNCORRECTED};
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
        let (mut last, mut still) = (None, None);
        let contacts = (&mut last, &mut still);
        let still_pair = |rotation, key| StillPair::of(&cso, rotation, key);
        let reach = (&pose, max_distance + borders);
        if self.hold_if_proved(pair, reach, contacts, &workspace.still_cache, still_pair) {
            return Ok(());
        }
        self.query_curved(pair, &cso, max_distance, (last, still.as_ref()), workspace)
    }

    /// Up to a maximum distance of the shapes with their borders.
    fn query_curved<A: SurfacePieces, B: SurfacePieces>(
        &mut self,
        pair: &Pair<'_, B, A>,
        cso: &Cso<'_, A, B>,
        max_distance: f64,
        (mut last, still): (Option<LastContacts>, Option<&Still>),
        workspace: &mut Workspace,
    ) -> Result<(), Unsupported> {
        let borders = pair.border_radii[0] + pair.border_radii[1];
        let frame = AxisFrame::of(cso);
        let mut manifold = KernelManifold::with_borders(&mut self.manifold, pair.order, frame);
        if last.is_none() {
            manifold.read_contacts(cso.pose, &mut last);
        }
        let mut cost = Cost::default();
        let hint = manifold.hint(borders);
        let mut query = CurvedQuery {
            cso,
            border_radii: pair.border_radii,
            max_distance: max_distance + borders,
            last: last.as_ref(),
            scratch: &mut workspace.curved,
            cost: &mut cost,
        };
        let (answer, mut stage) = query.run(hint).ok_or(Unsupported)?;
        match answer {
            CurvedAnswer::SpheresApart => manifold.forget(),
            CurvedAnswer::Separated(apart) => manifold.set_axis(apart.axis, apart.ids),
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
                    last: last.as_ref(),
                };
                let constraints = (self.constraints, self.pos12);
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

impl KernelManifold<'_, '_> {
    /// The memory of the pair. The cores may be apart although the shapes, with their `borders`, overlap.
    fn hint(&self, borders: f64) -> Hint {
        if let Some(least) = self.least_distance() {
            return match self.normals() {
                Some(normals) => Hint::Contact(normals, f64::from(least) + borders < 0.0),
                None => Hint::None,
            };
        }
        match self.memory(None) {
            PairMemory::Axis(axis, ids) => Hint::Apart(axis, ids),
            _ => Hint::None,
        }
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
            if !still.is_of(self.cso, self.border_radii, last) {
                let near = Near {
                    last: None,
                    ..*self
                };
                return near.update_contacts(constraints, manifold, None, workspace);
            }
            manifold.manifold.hold(still);
            let core_distance = self.least + self.border_radii[0] + self.border_radii[1];
            still.store(&mut workspace.still_cache, core_distance, last);
            return true;
        }
        let patch = &mut workspace.curved.patch;
        if let [Constraints::None, Constraints::None] = constraints.0 {
            return self.update(manifold, patch);
        }
        self.update_constrained(constraints, manifold, patch);
        false
    }

    /// Keeps the contacts where they are, or chooses new ones. Returns whether they stayed.
    fn update(&self, manifold: &mut KernelManifold<'_, '_>, patch: &mut Patch) -> bool {
        let near = self.proximity();
        let normals = Normals::of(&near, self.cso.pose);
        let radius = self.cso.min_radius();
        let is_kept = !manifold.has_rolled(self.cso, normals.exact)
            && (manifold.keep_places(self.last, self.least, &normals, radius)).is_some();
        if !is_kept {
            patch.complete_beside_deepest(self.cso, self.border_radii);
            manifold.set_contacts(normals.rounded, &self.contacts(patch));
        }
        is_kept
    }

    fn contacts(&self, patch: &Patch) -> Contacts {
        let deepest = (self.on_1, self.least);
        let scale = self.cso.min_radius();
        curved::contacts(patch, self.cso.pose, deepest, self.max_distance, scale)
    }

    /// Like [`update`](Self::update), along normals that the constraints correct.
    fn update_constrained(
        &self,
        (constraints, pos12): (&[Constraints<'_>; 2], &Pose),
        manifold: &mut KernelManifold<'_, '_>,
        patch: &mut Patch,
    ) {
        let normals = Normals::of(&self.proximity(), self.cso.pose);
        let order = manifold.order;
        let pair = ConstrainedPair {
            cso: self.cso,
            order,
            constraints: *constraints,
            pos12,
            max_distance: self.max_distance + self.border_radii[0] + self.border_radii[1],
        };
        let Some(found) = pair.correct(order.to_caller(normals.rounded)) else {
            self.set_axis(manifold);
            return;
        };
        let corrected = order.to_kernel(found.normals);
        if corrected[0].abs_diff_eq(normals.rounded[0], UNCORRECTED) {
            self.update(manifold, patch);
        } else if let Some(contacts) = self.along(corrected, patch) {
            manifold.set_contacts(corrected, &contacts);
        } else if self.least < 0.0 {
            // Overlapping shapes must be pushed apart, even if not along the corrected normal.
            patch.find(self.cso, self.normal, self.border_radii);
            manifold.set_contacts(normals.rounded, &self.contacts(patch));
        } else {
            self.set_axis(manifold);
        }
    }

    /// Leaves no contact, but a place for the next query to start from.
    fn set_axis(&self, manifold: &mut KernelManifold<'_, '_>) {
        manifold.set_axis(self.normal, [VertexId::default(); 2]);
    }

    /// The contacts along a corrected normal, whose depth is not the one that the query found.
    fn along(&self, corrected: [Vec3; 2], patch: &mut Patch) -> Option<Contacts> {
        let normal = corrected[0].as_dvec3().normalize();
        patch.find(self.cso, normal, self.border_radii);
        let scale = self.cso.min_radius();
        let least = ABSURD_DEPTH * self.least.min(0.0) - DEPTH_GAP * scale;
        patch.retain(least..=self.max_distance);
        let deepest = patch.deepest_point()?;
        Some(curved::contacts(
            patch,
            self.cso.pose,
            deepest,
            self.max_distance,
            scale,
        ))
    }
}
