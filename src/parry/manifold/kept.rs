//! Contact hysteresis: contacts keep their places while the shapes hardly move.
//!
//! A solver starts from the impulses of the previous step, which only fit contacts that are still
//! where they were. If the points are chosen anew in each step, a heap of small bodies never comes to
//! rest, although each choice is right. So while the two points of each contact stay close together,
//! the manifold keeps them, and only its normal and its distances are measured anew.
//!
//! The query of the present step vouches for what is kept. Its normal `n` and its signed distance `d`
//! are exact: along `n` the shapes lie on either side of two supporting planes that are `d` apart.
//! So no pair of points is deeper than `d`, and a kept contact never shows an overlap that does not
//! exist. The deepest kept contact must show `d` itself, up to a tolerance, and is then reported at `d`;
//! otherwise the contacts are chosen anew.

use glam::{DVec3, Vec3};
use parry3d::query::TrackedContact;

use super::normals::Normals;
use super::record::KernelManifold;
use crate::manifold::MAX_POINTS;
use crate::parry::order::PairOrder;
use crate::pose::RelativePose;
use crate::query::Proximity;
use crate::simd::{DVec3x4, f64x4};
use crate::tolerance::{KEPT_ANGLE_COS, KEPT_DEPTH, KEPT_DRIFT};

impl<M, C> KernelManifold<'_, M, C> {
    /// Measures the contacts anew where they are. Returns `false`, and changes nothing, if they have to be
    /// chosen anew. `radius` is that of the smaller shape.
    // perf: in a call the normals would go through memory.
    #[inline(always)]
    pub fn keep_contacts(
        &mut self,
        near: &Proximity,
        pose: &RelativePose,
        normals: &Normals,
        radius: f64,
    ) -> bool {
        let old_normals = [self.manifold.local_n1, self.manifold.local_n2];
        let points = &mut self.manifold.points;
        if !(1..=MAX_POINTS).contains(&points.len())
            || !normals.are_near(self.order.to_kernel(old_normals))
        {
            return false;
        }
        let (distance, drift_squared) = measure(points, self.order, pose, normals.exact[0]);
        let limit = f64x4::splat(KEPT_DRIFT * radius * (KEPT_DRIFT * radius));
        // A drift that is not a number is too far.
        if !drift_squared.simd_le(limit).all() {
            return false;
        }
        let distances = distance.to_array();
        let mut deepest = 0;
        for lane in 1..MAX_POINTS {
            if distances[lane] < distances[deepest] {
                deepest = lane;
            }
        }
        let signed_distance = near.signed_distance - (self.border_radii[0] + self.border_radii[1]);
        let excess = distances[deepest] - signed_distance;
        if excess.abs() > KEPT_DEPTH * radius {
            return false;
        }
        for (point, distance) in points.iter_mut().zip(distances) {
            point.dist = distance as f32;
        }
        points[deepest].dist = signed_distance as f32;
        self.set_normals(normals.rounded);
        true
    }
}

impl Normals {
    /// Whether they are about those of the manifold.
    #[inline]
    fn are_near(&self, [old_1, old_2]: [Vec3; 2]) -> bool {
        let [new_1, new_2] = self.exact;
        old_1.as_dvec3().dot(new_1) >= KEPT_ANGLE_COS
            && old_2.as_dvec3().dot(new_2) >= KEPT_ANGLE_COS
    }
}

/// The distances of up to four contacts along the normal, and the squares of how far their two points
/// are apart across it. Lanes beyond the last contact repeat it.
#[inline]
fn measure<C>(
    contacts: &[TrackedContact<C>],
    order: PairOrder,
    pose: &RelativePose,
    normal: DVec3,
) -> (f64x4, f64x4) {
    let last = contacts.len() - 1;
    let lanes = [0, 1, 2, 3].map(|lane: usize| &contacts[lane.min(last)]);
    let points = |of: fn(&TrackedContact<C>) -> Vec3| {
        DVec3x4::gather(lanes, |contact| of(contact).as_dvec3())
    };
    let (on_1, on_2) = if order.is_reversed() {
        (points(|c| c.local_p2), points(|c| c.local_p1))
    } else {
        (points(|c| c.local_p1), points(|c| c.local_p2))
    };
    let between = pose.points_to_1(on_2) - on_1;
    let distance = between.dot(normal);
    (distance, between.length_squared() - distance * distance)
}
