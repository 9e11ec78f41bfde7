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
//! otherwise the contacts are chosen anew.

use glam::Vec3;
use parry3d::query::TrackedContact;

use super::kernel_manifold::KernelManifold;
use super::normals::Normals;
use crate::pose::RelativePose;
use crate::query::{LastContacts, Proximity, first_least};
use crate::simd::{DVec3x4, LANES, coordinates, widened};
use crate::tolerance::{KEPT_ANGLE_COS, KEPT_DEPTH, KEPT_DRIFT};
use crate::tuning::{ROCKING_COS, ROCKING_RISE};

impl<M, C> KernelManifold<'_, M, C> {
    /// Reads the contacts at the present pose, if there are any. Lanes beyond the last contact repeat it.
    // perf: inlining it costs pairs that are apart 3 % more instructions. Returning the contacts would copy them: 1 %
    // more in touching/8.
    #[inline(never)]
    pub fn read_contacts(&self, pose: &RelativePose, last: &mut Option<LastContacts>) {
        let contacts = &self.manifold.points[..];
        let lanes = match contacts {
            [a] => [a, a, a, a],
            [a, b] => [a, b, b, b],
            [a, b, c] => [a, b, c, c],
            [a, b, c, d] => [a, b, c, d],
            _ => return,
        };
        let points =
            |of: fn(&TrackedContact<C>) -> &Vec3| DVec3x4(coordinates(lanes.map(of)).map(widened));
        let (on_1, on_2) = if self.order.is_reversed() {
            (points(|c| &c.local_p2), points(|c| &c.local_p1))
        } else {
            (points(|c| &c.local_p1), points(|c| &c.local_p2))
        };
        *last = Some(LastContacts::new(on_1, on_2, pose));
    }

    /// Measures the contacts anew where they are. Returns `false`, and changes nothing, if they have to be
    /// chosen anew. `radius` is that of the smaller shape.
    // perf: a call would pass the normals through memory.
    #[inline(always)]
    pub fn keep_contacts(
        &mut self,
        last: Option<&LastContacts>,
        near: &Proximity,
        normals: &Normals,
        radius: f64,
    ) -> bool {
        let kept = self.keep_places(last, near.signed_distance, normals, radius);
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
    ) -> Option<usize> {
        let old_normals = [self.manifold.local_n1, self.manifold.local_n2];
        let last = last?;
        let turned_less = |cos| normals.are_near(self.order.to_kernel(old_normals), cos);
        if !turned_less(ROCKING_COS) {
            return None;
        }
        let normal = normals.exact[0];
        if !last.are_within(normal, KEPT_DRIFT * radius) {
            return None;
        }
        let distances = last.distances(normal).to_array();
        if !turned_less(KEPT_ANGLE_COS) && !self.rise_within(distances, ROCKING_RISE * radius) {
            return None;
        }
        let deepest = first_least(distances);
        let signed_distance = signed_distance - (self.border_radii[0] + self.border_radii[1]);
        let excess = distances[deepest] - signed_distance;
        if excess.abs() > KEPT_DEPTH * radius {
            return None;
        }
        for (point, distance) in self.manifold.points.iter_mut().zip(distances) {
            point.dist = distance as f32;
        }
        self.manifold.points[deepest].dist = signed_distance as f32;
        self.set_normals(normals.rounded);
        Some(deepest)
    }

    /// Whether no contact's distance differs by more than this from that of the previous update.
    fn rise_within(&self, distances: [f64; LANES], most: f64) -> bool {
        let mut points = self.manifold.points.iter().zip(distances);
        points.all(|(old, now)| (now - f64::from(old.dist)).abs() <= most)
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
