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
//! exist. The deepest kept contact must show `d` itself, up to a tolerance, and is then told at `d`;
//! otherwise the contacts are chosen anew.

use glam::{DVec3, Vec3};
use parry3d::query::{ContactManifold, TrackedContact};

use crate::manifold::MAX_POINTS;
use crate::map_pair::map_pair;
use crate::parry::order::PairOrder;
use crate::pose::RelativePose;
use crate::simd::DVec3x4;
use crate::tolerance::{KEPT_ANGLE_COS, KEPT_DEPTH, KEPT_DRIFT};

/// What the query of the present step found, in the order of the kernels.
pub(crate) struct Present<'a> {
    pub pose: &'a RelativePose,
    /// Unit normals out of both shapes, each in its own frame.
    pub normals: [DVec3; 2],
    /// Between the shapes, borders included.
    pub signed_distance: f64,
    /// The radius of the smaller shape.
    pub radius: f64,
    /// The manifold's second shape is the kernels' first.
    pub order: PairOrder,
}

/// Measures the contacts of a manifold anew where they are. Returns `false`, and changes nothing, if they
/// have to be chosen anew.
#[inline]
pub(crate) fn keep_contacts<M, C>(
    manifold: &mut ContactManifold<M, C>,
    present: &Present<'_>,
) -> bool {
    let normals = [manifold.local_n1, manifold.local_n2];
    if !(1..=MAX_POINTS).contains(&manifold.points.len()) || !present.has_normals(normals) {
        return false;
    }
    let [distances, drifts_squared] = present.measure(&manifold.points);
    let limit = KEPT_DRIFT * present.radius;
    // A drift that is not a number is too far.
    if !drifts_squared
        .iter()
        .all(|&squared| squared <= limit * limit)
    {
        return false;
    }
    let mut deepest = 0;
    for lane in 1..MAX_POINTS {
        if distances[lane] < distances[deepest] {
            deepest = lane;
        }
    }
    let excess = distances[deepest] - present.signed_distance;
    if excess.abs() > KEPT_DEPTH * present.radius {
        return false;
    }
    for (point, distance) in manifold.points.iter_mut().zip(distances) {
        point.dist = distance as f32;
    }
    manifold.points[deepest].dist = present.signed_distance as f32;
    let normals = map_pair(present.normals, |normal| normal.as_vec3());
    [manifold.local_n1, manifold.local_n2] = present.order.to_caller(normals);
    true
}

impl Present<'_> {
    /// Whether the normal is still about that of the manifold, seen from both shapes.
    #[inline]
    fn has_normals(&self, manifold: [Vec3; 2]) -> bool {
        let [old_1, old_2] = self.order.to_kernel(manifold);
        let [new_1, new_2] = self.normals;
        old_1.as_dvec3().dot(new_1) >= KEPT_ANGLE_COS
            && old_2.as_dvec3().dot(new_2) >= KEPT_ANGLE_COS
    }

    /// The distances of up to four contacts along the normal, and the squares of how far their two points
    /// are apart across it. Lanes beyond the last contact repeat it.
    #[inline]
    fn measure<C>(&self, contacts: &[TrackedContact<C>]) -> [[f64; MAX_POINTS]; 2] {
        let last = contacts.len() - 1;
        let lanes = [0, 1, 2, 3].map(|lane: usize| &contacts[lane.min(last)]);
        let points = |of: fn(&TrackedContact<C>) -> Vec3| {
            DVec3x4::gather(lanes, |contact| of(contact).as_dvec3())
        };
        let (on_1, on_2) = if self.order.is_reversed() {
            (points(|c| c.local_p2), points(|c| c.local_p1))
        } else {
            (points(|c| c.local_p1), points(|c| c.local_p2))
        };
        let between = self.pose.points_to_1(on_2) - on_1;
        let distance = between.dot(self.normals[0]);
        let drift_squared = between.length_squared() - distance * distance;
        [distance.to_array(), drift_squared.to_array()]
    }
}
