//! Contact hysteresis: contacts keep their places while the shapes hardly move.
//!
//! A solver starts from the impulses of the previous step, which only fit contacts that are still
//! where they were. If points are chosen anew in each step, a heap of small bodies never comes to rest,
//! although each choice is right. So while the two points of each contact stay close together, the
//! manifold keeps them, and only its normal and its distances are measured anew.
//!
//! The query of the present step vouches for what is kept. Its normal `n` and its signed distance `d`
//! are exact: along `n` the shapes lie on either side of two supporting planes that are `d` apart.
//! So no pair of points is deeper than `d`, and a kept contact never shows an overlap that does not
//! exist. The deepest kept contact must show `d` itself, up to a tolerance, and is then reported at `d`;
//! otherwise the contacts are chosen anew. They also are if they do not lie on the shapes, which may have been
//! exchanged.

use glam::Vec3;

use super::kernel_manifold::KernelManifold;
use super::normals::Normals;
use super::own_contacts::StoredNormals;
use crate::pose::RelativePose;
use crate::query::{LastContacts, Proximity, first_least};
use crate::simd::LANES;
use crate::tolerance::{KEPT_ANGLE_COS, KEPT_DEPTH, KEPT_DRIFT};
use crate::tuning::{ROCKING_COS, ROCKING_RISE};

impl KernelManifold<'_, '_> {
    /// Reads the contacts at the present pose, if there are any.
    #[inline]
    pub fn read_contacts(&self, pose: &RelativePose, last: &mut Option<LastContacts>) {
        self.manifold.points().read(self.order, pose, last);
    }

    /// Measures the contacts anew where they are. Returns `false`, and changes nothing, if they have to be
    /// chosen anew. `radius` is that of the smaller shape. `are_own` tells whether contacts belong to the shapes; it gets
    /// the normal that is stored, and the one that will be if so.
    // perf: a call would pass the normals through memory.
    #[inline(always)]
    pub fn keep_contacts(
        &mut self,
        last: Option<&LastContacts>,
        near: &Proximity,
        normals: &Normals,
        radius: f64,
        are_own: impl FnOnce(&LastContacts, StoredNormals) -> bool,
    ) -> bool {
        let kept = self.keep_places(last, near.signed_distance, normals, radius, are_own);
        if let Some(deepest) = kept {
            self.set_deepest_features(deepest, near.features);
        }
        kept.is_some()
    }

    /// The same without new feature ids. Returns the index of the deepest contact if the contacts stay.
    #[inline]
    pub fn keep_places(
        &mut self,
        last: Option<&LastContacts>,
        signed_distance: f64,
        normals: &Normals,
        radius: f64,
        are_own: impl FnOnce(&LastContacts, StoredNormals) -> bool,
    ) -> Option<usize> {
        let old_normals = [*self.manifold.local_n1, *self.manifold.local_n2];
        let last = last?;
        let turned_less = |cos| normals.are_near(self.order.to_kernel(old_normals), cos);
        if !turned_less(ROCKING_COS) {
            return None;
        }
        let normal = normals.exact[0];
        if !last.are_within(normal, KEPT_DRIFT * radius) {
            return None;
        }
        let mut distances = last.distances(normal).to_array();
        if !turned_less(KEPT_ANGLE_COS) && !self.rise_within(distances, ROCKING_RISE * radius) {
            return None;
        }
        let deepest = first_least(distances);
        let signed_distance = signed_distance - (self.border_radii[0] + self.border_radii[1]);
        let excess = distances[deepest] - signed_distance;
        let stored = StoredNormals {
            before: self.stored_normal(),
            after: normals.rounded[0],
        };
        if excess.abs() > KEPT_DEPTH * radius || !are_own(last, stored) {
            return None;
        }
        distances[deepest] = signed_distance;
        self.manifold.points_mut().set_distances(&distances);
        self.set_normals(normals.rounded);
        Some(deepest)
    }

    /// Whether no contact's distance differs by more than this from that of the previous update.
    fn rise_within(&self, distances: [f64; LANES], most: f64) -> bool {
        let points = self.manifold.points();
        let old = (0..).map_while(|i| points.distance(i));
        old.zip(distances)
            .all(|(old, now)| (now - f64::from(old)).abs() <= most)
    }
}

impl Normals {
    /// Whether they have turned from those of the manifold by at most an angle with this cosine.
    #[inline]
    fn are_near(&self, [old_1, old_2]: [Vec3; 2], cos: f64) -> bool {
        let [new_1, new_2] = self.exact;
        old_1.as_dvec3().dot(new_1) >= cos && old_2.as_dvec3().dot(new_2) >= cos
    }
}
