//! The contact manifold of two convex shapes, coherently.

mod by_parry;
mod inherit;
mod kept;
pub(crate) mod record;

use glam::{DVec3, Vec3};
use parry3d::math::{Pose, Real};
use parry3d::query::ContactManifold;
use parry3d::shape::PolygonalFeatureMap;

use crate::hull::Hull;
use crate::manifold::{self, ClipScratch, Contacts};
use crate::map_pair::map_pair;
use crate::parry::constraints::{self, Constraints};
use crate::parry::convert::HalfSpace;
use crate::parry::half_space;
use crate::parry::order::PairOrder;
use crate::parry::pair::{Pair, PairVisitor};
use crate::parry::workspace::Workspace;
use crate::pose::{RelativePose, ValidPose};
use crate::query::{Answer, PairMemory, Proximity, Query, Start, Verdict};
use crate::stats::{Cost, Left, SharedStats, Stage};
use crate::support::{Cso, Polytope, Support};
use crate::tolerance::UNCORRECTED;
use inherit::write_points;
use kept::Present;
use record::AxisFrame;

/// Brings a manifold up to date.
pub(crate) struct UpdateManifold<'a, M, C> {
    pub pos12: &'a Pose,
    pub prediction: Real,
    pub constraints: [Constraints<'a>; 2],
    pub manifold: &'a mut ContactManifold<M, C>,
    pub stats: &'a SharedStats,
}

impl<M: Default, C: Default + Copy> PairVisitor for UpdateManifold<'_, M, C> {
    /// There is one unless the pair is not finite.
    type Answer = ();

    const HALF_SPACES: bool = true;

    const CURVED: bool = true;

    // perf: in a call the pair would go through memory, which small queries notice.
    #[inline(always)]
    fn visit<B: Polytope>(&mut self, pair: &Pair<'_, B>, workspace: &mut Workspace) -> Option<()> {
        let pose = pair.pose(ValidPose::new(self.pos12)?);
        let cso = pair.cso(&pose);
        let max_distance = pair.core_distance(self.prediction, cso.size());
        let frame = AxisFrame::of(&cso);
        let mut cost = Cost::default();
        // Half of the pairs that are apart, or more, end here: before anything else is done for them.
        if cso.are_spheres_apart(max_distance) {
            self.stats.record(Stage::BoundingSpheres, &cost);
            record::forget(self.manifold);
            return Some(());
        }
        let mut query = Query {
            cso: &cso,
            max_distance,
            polytope_cache: Some((&mut workspace.polytope_cache, key_of(self.manifold))),
            scratch: &mut workspace.epa,
            cost: &mut cost,
        };
        // Stage by stage: copying an answer stalls on store forwarding.
        let answer = match record::read(self.manifold, pair.order, frame) {
            PairMemory::None => query.start_from_centers(),
            PairMemory::Axis(axis, ids) => match query.test_axis(axis, ids) {
                Ok(apart) => {
                    self.stats.record(Stage::Axis, &cost);
                    record::set_axis(self.manifold, &apart, frame);
                    return Some(());
                }
                Err(vertex) => query.start_from_tilted_axis(axis, vertex, Start::Warm),
            },
            PairMemory::Contact(normal, features) => {
                let verdict = query.certify(features);
                if let Verdict::Certified(near) = &verdict {
                    let is_kept =
                        self.update_contacts(pair, &cso, near, max_distance, &mut workspace.clip);
                    let stage = if is_kept { Stage::Kept } else { Stage::Feature };
                    self.stats.record(stage, &cost);
                    return Some(());
                }
                query.start_from_features(normal, features, &verdict)
            }
        };
        let (answer, stage) = answer.as_ref()?;
        self.stats.record(*stage, &cost);
        match answer {
            Answer::Separated(apart) => record::set_axis(self.manifold, apart, frame),
            Answer::Near(near) => {
                self.update_contacts(pair, &cso, near, max_distance, &mut workspace.clip);
            }
        }
        Some(())
    }

    fn visit_half_space(
        &mut self,
        pair: &Pair<'_, HalfSpace>,
        workspace: &mut Workspace,
    ) -> Option<()> {
        let pose = pair.pose(ValidPose::new(self.pos12)?);
        let max_distance = pair.core_distance(self.prediction, pair.hull.radius());
        let mut cost = Cost::default();
        if half_space::is_sphere_apart(pair, &pose, max_distance) {
            self.stats.record(Stage::BoundingSpheres, &cost);
            record::forget(self.manifold);
            return Some(());
        }
        let memory = record::read(self.manifold, pair.order, AxisFrame::First);
        let near = half_space::deepest(pair, &pose, &memory, &mut cost);
        if near.signed_distance > max_distance {
            self.stats.record(Stage::Axis, &cost);
            record::set_axis(
                self.manifold,
                &half_space::axis(pair, &near),
                AxisFrame::First,
            );
        } else if self.keep_contacts(pair, &pose, &near, pair.hull.radius()) {
            self.stats.record(Stage::Kept, &cost);
        } else {
            self.stats.record(Stage::Feature, &cost);
            let contacts = manifold::half_space_contacts(
                pair.hull,
                &pose,
                &near,
                max_distance,
                &mut workspace.clip,
            );
            self.write(pair, rounded(&near, &pose, pair.order), &contacts);
        }
        Some(())
    }

    fn visit_curved<B: Support>(
        &mut self,
        pair: &Pair<'_, B>,
        features: &dyn PolygonalFeatureMap,
        workspace: &mut Workspace,
    ) -> Option<()> {
        let pos12 = ValidPose::new(self.pos12)?;
        if self.manifold.points.is_empty() {
            let pose = pair.pose(pos12);
            let cso = pair.cso(&pose);
            let mut cost = Cost::default();
            let apart = Query {
                cso: &cso,
                max_distance: pair.core_distance(self.prediction, cso.size()),
                polytope_cache: None,
                scratch: &mut workspace.epa,
                cost: &mut cost,
            }
            .prove_apart(&record::read(self.manifold, pair.order, AxisFrame::First));
            if let Some((apart, stage)) = apart {
                self.stats.record(stage, &cost);
                record::set_axis(self.manifold, &apart, AxisFrame::First);
                return Some(());
            }
        }
        self.stats.record_left(Left::CurvedContact);
        self.update_by_parry(pair, features);
        Some(())
    }
}

/// Where the manifold is: mostly where it was in the frame before.
#[inline]
fn key_of<T>(manifold: &T) -> u64 {
    (&raw const *manifold).addr() as u64
}

/// The contact normal as both shapes see it, outwards.
#[inline]
fn normals(near: &Proximity, pose: &RelativePose) -> [DVec3; 2] {
    [near.normal, -pose.direction_to_2(near.normal)]
}

/// The same in the manifold's order and precision.
#[inline(always)]
fn rounded(near: &Proximity, pose: &RelativePose, order: PairOrder) -> [Vec3; 2] {
    let normals = map_pair(normals(near, pose), |normal| normal.as_vec3());
    order.to_caller(normals)
}

impl<M: Default, C: Default + Copy> UpdateManifold<'_, M, C> {
    /// Leaves the contacts where they are, if that is right, and returns whether it is. Otherwise it
    /// chooses them anew.
    #[inline(always)]
    fn update_contacts<B: Polytope>(
        &mut self,
        pair: &Pair<'_, B>,
        cso: &Cso<'_, Hull, B>,
        near: &Proximity,
        max_distance: f64,
        scratch: &mut ClipScratch,
    ) -> bool {
        let normals = rounded(near, cso.pose, pair.order);
        let Some(constrained) = self.constrained(cso, pair.order, max_distance, normals) else {
            // Discarded: there is no contact, but there is a place to start from.
            record::set_hint(self.manifold, near, cso);
            return false;
        };
        // The query's depth says nothing about contacts along a corrected normal.
        if !constrained[0].abs_diff_eq(normals[0], UNCORRECTED) {
            self.write_corrected(pair, cso, (near, constrained), max_distance, scratch);
            return false;
        }
        let is_kept = self.keep_contacts(pair, cso.pose, near, cso.min_radius());
        if !is_kept {
            self.write_contacts(pair, cso, near, max_distance, scratch);
        }
        is_kept
    }

    /// Leaves the contacts along the query's normal where they are, if that is right.
    #[inline(always)]
    fn keep_contacts<B>(
        &mut self,
        pair: &Pair<'_, B>,
        pose: &RelativePose,
        near: &Proximity,
        radius: f64,
    ) -> bool {
        let present = Present {
            pose,
            normals: normals(near, pose),
            signed_distance: near.signed_distance - (pair.border_radii[0] + pair.border_radii[1]),
            radius,
            order: pair.order,
        };
        kept::keep_contacts(self.manifold, &present)
    }

    /// Chooses contacts along the query's normal.
    fn write_contacts<B: Polytope>(
        &mut self,
        pair: &Pair<'_, B>,
        cso: &Cso<'_, Hull, B>,
        near: &Proximity,
        max_distance: f64,
        scratch: &mut ClipScratch,
    ) {
        let contacts = manifold::contacts(cso, near, max_distance, scratch);
        self.write(pair, rounded(near, cso.pose, pair.order), &contacts);
    }

    /// Chooses contacts along corrected `normals`, if each shape has a face that looks along its own.
    fn write_corrected<B: Polytope>(
        &mut self,
        pair: &Pair<'_, B>,
        cso: &Cso<'_, Hull, B>,
        (near, normals): (&Proximity, [Vec3; 2]),
        max_distance: f64,
        scratch: &mut ClipScratch,
    ) {
        let [normal, _] = pair.order.to_kernel(normals);
        let normal = normal.as_dvec3().normalize();
        match manifold::contacts_along(cso, near, normal, max_distance, scratch) {
            Some(contacts) => self.write(pair, normals, &contacts),
            // What overlaps must be pushed out, if not along the corrected normal.
            None if near.signed_distance < 0.0 => {
                self.write_contacts(pair, cso, near, max_distance, scratch);
            }
            None => record::set_hint(self.manifold, near, cso),
        }
    }

    #[inline(always)]
    fn write<B>(&mut self, pair: &Pair<'_, B>, normals: [Vec3; 2], contacts: &Contacts) {
        [self.manifold.local_n1, self.manifold.local_n2] = normals;
        write_points(self.manifold, contacts, pair.border_radii, pair.order);
    }

    /// The contact's normals as the constraints leave them, if they do.
    #[inline(always)]
    fn constrained<B: Polytope>(
        &self,
        cso: &Cso<'_, Hull, B>,
        order: PairOrder,
        max_distance: f64,
        normals: [Vec3; 2],
    ) -> Option<[Vec3; 2]> {
        match self.constraints {
            // Only parts of meshes and compounds have some.
            [Constraints::None, Constraints::None] => Some(normals),
            both => constraints::correct(both, self.pos12, (cso, order), max_distance, normals),
        }
    }
}
