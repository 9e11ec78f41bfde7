//! Manifolds of pairs with a cylinder or a cone.

use glam::{DVec3, Vec3};
use parry3d::math::{Pose, Real};
use parry3d::query::Unsupported;

use super::curved_manifold::CurvedManifold;
use super::kernel_manifold::AxisFrame;
use super::normals::Normals;
use super::still::{SettledContacts, Still};
use crate::curved::{self, CurvedAnswer, CurvedQuery, Patch, SurfacePieces};
use crate::manifold::Contacts;
use crate::parry::constraints::{ConstrainedPair, Constraints};
use crate::parry::order::PairOrder;
use crate::parry::pair::valid_pose;
use crate::parry::still_cache::StillPair;
use crate::parry::workspace::Workspace;
use crate::pose::RelativePose;
use crate::query::{Feature, LastContacts, Proximity};
use crate::stats::{Cost, SharedStats, Stage};
use crate::support::{Cso, FaceId, VertexId};
use crate::tolerance::{DEPTH_GAP, MIN_DIRECTED_DISTANCE, UNCORRECTED};
use crate::tuning::ABSURD_DEPTH;

/// Two shapes in the kernels' order.
pub(crate) struct CurvedPair<'a, A, B> {
    pub shapes: (&'a A, &'a B),
    pub border_radii: [f64; 2],
    pub order: PairOrder,
}

impl<'a, A, B> CurvedPair<'a, A, B> {
    fn cso<'c>(&self, pose: &'c RelativePose) -> Cso<'c, A, B>
    where
        'a: 'c,
    {
        let (shape_1, shape_2) = self.shapes;
        Cso {
            shape_1,
            shape_2,
            pose,
        }
    }
}

/// Brings a manifold up to date.
pub(crate) struct CurvedUpdate<'a> {
    pub pos12: &'a Pose,
    pub prediction: Real,
    pub constraints: &'a [Constraints<'a>; 2],
    pub(super) manifold: &'a mut dyn CurvedManifold,
    pub stats: &'a SharedStats,
}

impl CurvedUpdate<'_> {
    /// Of two shapes, at least one of which is curved.
    pub fn run<A: SurfacePieces, B: SurfacePieces>(
        &mut self,
        pair: &CurvedPair<'_, A, B>,
        workspace: &mut Workspace,
    ) -> Result<(), Unsupported> {
        let pose = pair.order.pose(valid_pose(self.pos12)?);
        let cso = pair.cso(&pose);
        let borders = pair.border_radii[0] + pair.border_radii[1];
        let touching = MIN_DIRECTED_DISTANCE * (cso.size() + borders);
        let max_distance = f64::from(self.prediction) + touching;
        let settled = self.settled_contacts(&cso, pair.order);
        let still = settled.as_ref().map(|settled| &settled.still);
        if self.hold_if_proved(pair, still, max_distance + borders, workspace) {
            return Ok(());
        }
        let read = || self.manifold.last_contacts(pair.order, &pose);
        let last = settled
            .as_ref()
            .map_or_else(read, |settled| Some(settled.last));
        let mut cost = Cost::default();
        let hint = self.manifold.hint(pair.order, AxisFrame::of(&cso), borders);
        let mut query = CurvedQuery {
            cso: &cso,
            border_radii: pair.border_radii,
            max_distance: max_distance + borders,
            last: last.as_ref(),
            scratch: &mut workspace.curved,
            cost: &mut cost,
        };
        let (answer, mut stage) = query.run(hint).ok_or(Unsupported)?;
        match answer {
            CurvedAnswer::SpheresApart => self.manifold.forget(),
            CurvedAnswer::Separated(apart) => {
                let (frame, order) = (AxisFrame::of(&cso), pair.order);
                self.manifold.set_axis(order, frame, apart.axis, apart.ids);
            }
            CurvedAnswer::Near {
                signed_distance,
                normal,
                on_1,
            } => {
                let near = Near {
                    cso: &cso,
                    order: pair.order,
                    border_radii: pair.border_radii,
                    least: signed_distance - borders,
                    normal,
                    on_1,
                    max_distance,
                    last: last.as_ref(),
                };
                let is_kept = self.update_contacts(&near, still, workspace);
                if is_kept && stage == Stage::Feature {
                    stage = Stage::Kept;
                }
            }
        }
        self.stats.record(stage, &cost);
        Ok(())
    }

    /// The contacts of the manifold, if they may stay as they are.
    fn settled_contacts<A: SurfacePieces, B: SurfacePieces>(
        &mut self,
        cso: &Cso<'_, A, B>,
        order: PairOrder,
    ) -> Option<SettledContacts> {
        let are_free = matches!(self.constraints, [Constraints::None, Constraints::None]);
        let key = self
            .manifold
            .settled_key(order, cso.pose)
            .filter(|_| are_free)?;
        let pair = StillPair::of(cso, self.pos12.rotation, key)?;
        self.manifold.settled_contacts(order, cso.pose, pair)
    }

    /// Only measures the contacts of a pair at rest anew, if that is proved to be enough. Returns whether it is.
    fn hold_if_proved<A, B>(
        &mut self,
        pair: &CurvedPair<'_, A, B>,
        still: Option<&Still>,
        max_distance: f64,
        workspace: &Workspace,
    ) -> bool {
        let proofs = &workspace.still_cache;
        let is_proved = |still: &&Still| still.is_proved(proofs, max_distance, pair.border_radii);
        let held = still.filter(is_proved);
        if let Some(still) = held {
            self.manifold.hold(still);
            self.stats.record_free(Stage::Still);
        }
        held.is_some()
    }

    /// Returns whether the contacts stayed where they were.
    fn update_contacts<A: SurfacePieces, B: SurfacePieces>(
        &mut self,
        near: &Near<'_, '_, A, B>,
        still: Option<&Still>,
        workspace: &mut Workspace,
    ) -> bool {
        if let Some(still) = still.filter(|still| still.shows(near.least)) {
            self.manifold.hold(still);
            let core_distance = near.least + near.border_radii[0] + near.border_radii[1];
            still.store(&mut workspace.still_cache, core_distance);
            return true;
        }
        let patch = &mut workspace.curved.patch;
        if let [Constraints::None, Constraints::None] = self.constraints {
            return near.update(self.manifold, patch);
        }
        near.update_constrained(self, patch);
        false
    }
}

/// Shapes that are near each other.
struct Near<'a, 'c, A, B> {
    cso: &'a Cso<'c, A, B>,
    order: PairOrder,
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

    /// Keeps the contacts where they are, or chooses new ones. Returns whether they stayed.
    fn update(&self, manifold: &mut dyn CurvedManifold, patch: &mut Patch) -> bool {
        let near = self.proximity();
        let normals = Normals::of(&near, self.cso.pose);
        let radius = self.cso.min_radius();
        let is_kept = manifold.keep_places(self.order, self.last, self.least, &normals, radius);
        if !is_kept {
            patch.complete(self.cso, self.border_radii);
            manifold.set_contacts(self.order, normals.rounded, &self.contacts(patch));
        }
        is_kept
    }

    fn contacts(&self, patch: &Patch) -> Contacts {
        let deepest = (self.on_1, self.least);
        let scale = self.cso.min_radius();
        curved::contacts(patch, self.cso.pose, deepest, self.max_distance, scale)
    }

    /// Like [`update`](Self::update), along normals that the constraints correct.
    fn update_constrained(&self, update: &mut CurvedUpdate<'_>, patch: &mut Patch) {
        let manifold = &mut *update.manifold;
        let normals = Normals::of(&self.proximity(), self.cso.pose);
        let pair = ConstrainedPair {
            cso: self.cso,
            order: self.order,
            constraints: *update.constraints,
            pos12: update.pos12,
            max_distance: self.max_distance + self.border_radii[0] + self.border_radii[1],
        };
        let Some(found) = pair.correct(self.order.to_caller(normals.rounded)) else {
            self.set_axis(manifold);
            return;
        };
        let corrected = self.order.to_kernel(found.normals);
        if corrected[0].abs_diff_eq(normals.rounded[0], UNCORRECTED) {
            self.update(manifold, patch);
        } else if let Some(contacts) = self.along(corrected, patch) {
            manifold.set_contacts(self.order, corrected, &contacts);
        } else if self.least < 0.0 {
            // Overlapping shapes must be pushed apart, even if not along the corrected normal.
            patch.find(self.cso, self.normal, self.border_radii);
            manifold.set_contacts(self.order, normals.rounded, &self.contacts(patch));
        } else {
            self.set_axis(manifold);
        }
    }

    /// Leaves no contact, but a place for the next query to start from.
    fn set_axis(&self, manifold: &mut dyn CurvedManifold) {
        let frame = AxisFrame::of(self.cso);
        manifold.set_axis(self.order, frame, self.normal, [VertexId::default(); 2]);
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
