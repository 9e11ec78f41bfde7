//! Manifolds of pairs with a cylinder or a cone.

use glam::{DVec3, Vec3};
use parry3d::query::Unsupported;

use super::UpdateManifold;
use super::normals::Normals;
use super::record::{AxisFrame, KernelManifold};
use crate::curved::{self, Body, CurvedAnswer, CurvedQuery, CurvedScratch, Hint, Patch};
use crate::manifold::Contacts;
use crate::parry::constraints::{ConstrainedPair, Constraints};
use crate::parry::order::PairOrder;
use crate::parry::pair::valid_pose;
use crate::query::{Feature, LastContacts, PairMemory, Proximity};
use crate::stats::{Cost, Stage};
use crate::support::{Cso, FaceId, VertexId};
use crate::tolerance::{DEPTH_GAP, MIN_DIRECTED_DISTANCE, UNCORRECTED};
use crate::tuning::ABSURD_DEPTH;

/// Two shapes in the kernels' order.
pub(crate) struct CurvedPair<'a, A, B> {
    pub shapes: (&'a A, &'a B),
    pub border_radii: [f64; 2],
    pub order: PairOrder,
}

impl<M: Default, C: Default + Copy> UpdateManifold<'_, M, C> {
    /// Brings the manifold of two shapes up to date, at least one of which is curved.
    pub(crate) fn update_curved<A: Body, B: Body>(
        &mut self,
        pair: &CurvedPair<'_, A, B>,
        scratch: &mut CurvedScratch,
    ) -> Result<(), Unsupported> {
        let pose = pair.order.pose(valid_pose(self.pos12)?);
        let cso = Cso {
            shape_1: pair.shapes.0,
            shape_2: pair.shapes.1,
            pose: &pose,
        };
        let borders = pair.border_radii[0] + pair.border_radii[1];
        let touching = MIN_DIRECTED_DISTANCE * (cso.size() + borders);
        let max_distance = f64::from(self.prediction) + touching;
        let mut manifold =
            KernelManifold::with_borders(self.manifold, pair.order, AxisFrame::of(&cso));
        let mut cost = Cost::default();
        let last = manifold.last_contacts(&pose);
        let mut query = CurvedQuery {
            cso: &cso,
            border_radii: pair.border_radii,
            max_distance: max_distance + borders,
            last: last.as_ref(),
            scratch,
            cost: &mut cost,
        };
        let (answer, mut stage) = query.run(hint(&manifold, borders)).ok_or(Unsupported)?;
        match answer {
            CurvedAnswer::SpheresApart => manifold.forget(),
            CurvedAnswer::Separated(apart) => manifold.set_axis(apart.axis, apart.ids),
            CurvedAnswer::Near {
                signed_distance,
                normal,
                on_1,
            } => {
                let near = Near {
                    cso: &cso,
                    border_radii: pair.border_radii,
                    least: signed_distance - borders,
                    normal,
                    on_1,
                    max_distance,
                    last: last.as_ref(),
                };
                let is_kept = if let [Constraints::None, Constraints::None] = self.constraints {
                    near.update(&mut manifold, &mut scratch.patch)
                } else {
                    let constraints = (*self.constraints, self.pos12);
                    near.update_constrained(&mut manifold, constraints, &mut scratch.patch);
                    false
                };
                if is_kept && stage == Stage::Feature {
                    stage = Stage::Kept;
                }
            }
        }
        self.stats.record(stage, &cost);
        Ok(())
    }
}

/// What a manifold remembers of its pair. With `borders` around them, the cores may be apart although the
/// shapes overlap.
fn hint<M, C>(manifold: &KernelManifold<'_, M, C>, borders: f64) -> Hint {
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

impl<A: Body, B: Body> Near<'_, '_, A, B> {
    fn proximity(&self) -> Proximity {
        Proximity {
            signed_distance: self.least,
            normal: self.normal,
            on_1: self.on_1,
            on_2: self.on_1 + self.normal * self.least,
            features: [Feature::Face(FaceId::default()); 2],
        }
    }

    /// Leaves the contacts where they are, if that is right, or chooses new ones. Returns whether they stayed.
    fn update<M, C: Default + Copy>(
        &self,
        manifold: &mut KernelManifold<'_, M, C>,
        patch: &mut Patch,
    ) -> bool {
        let near = self.proximity();
        let normals = Normals::of(&near, self.cso.pose);
        let radius = self.cso.min_radius();
        let is_kept = manifold
            .keep_places(self.last, self.least, &normals, radius)
            .is_some();
        if !is_kept {
            patch.complete(self.cso, self.border_radii);
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
    fn update_constrained<M, C: Default + Copy>(
        &self,
        manifold: &mut KernelManifold<'_, M, C>,
        (constraints, pos12): ([Constraints<'_>; 2], &parry3d::math::Pose),
        patch: &mut Patch,
    ) {
        let normals = Normals::of(&self.proximity(), self.cso.pose);
        let pair = ConstrainedPair {
            cso: self.cso,
            order: manifold.order,
            constraints,
            pos12,
            max_distance: self.max_distance + self.border_radii[0] + self.border_radii[1],
        };
        let Some(found) = pair.correct(manifold.order.to_caller(normals.rounded)) else {
            manifold.set_axis(self.normal, [VertexId::default(); 2]);
            return;
        };
        let corrected = manifold.order.to_kernel(found.normals);
        if corrected[0].abs_diff_eq(normals.rounded[0], UNCORRECTED) {
            self.update(manifold, patch);
        } else if let Some(contacts) = self.along(corrected, patch) {
            manifold.set_contacts(corrected, &contacts);
        } else if self.least < 0.0 {
            // What overlaps must be pushed out, if not along the corrected normal.
            patch.find(self.cso, self.normal, self.border_radii);
            manifold.set_contacts(normals.rounded, &self.contacts(patch));
        } else {
            manifold.set_axis(self.normal, [VertexId::default(); 2]);
        }
    }

    /// The contacts along a corrected normal. The depth that the query found is along another one.
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
