//! Bounding boxes of points, and by support queries.

use glam::{Mat3A, Vec3, Vec3A};
use parry3d::bounding_volume::Aabb;
use parry3d::math::{Pose, Vector};

use super::HullShape;

/// A scan of this many points takes as long as six climbs, and its memory access is predictable.
const SCAN_UP_TO: usize = 180;

impl HullShape {
    /// The axis-aligned box around the hull at a pose.
    #[inline]
    pub(super) fn aabb(&self, pose: &Pose) -> Aabb {
        if self.hull().points().len() <= SCAN_UP_TO {
            aabb_of_points(self.hull().points(), pose)
        } else {
            self.climbed_aabb(pose)
        }
    }

    fn climbed_aabb(&self, pose: &Pose) -> Aabb {
        let to_local = pose.rotation.inverse();
        let axes = [Vector::X, Vector::Y, Vector::Z].map(|axis| to_local * axis);
        let [x, y, z] = axes.map(|axis| axis.as_dvec3());
        let hull = self.hull();
        let ends = hull.extreme_vertices([-x, -y, -z, x, y, z]);
        let reach = |i: usize| axes[i % 3].dot(hull.points()[ends[i].index()]);
        Aabb::new(
            pose.translation + Vector::new(reach(0), reach(1), reach(2)),
            pose.translation + Vector::new(reach(3), reach(4), reach(5)),
        )
    }
}

/// The axis-aligned box around points at a pose.
pub(crate) fn aabb_of_points(points: &[Vec3], pose: &Pose) -> Aabb {
    let rotation = Mat3A::from_quat(pose.rotation);
    let (mut mins, mut maxs) = (Vec3A::INFINITY, Vec3A::NEG_INFINITY);
    for &point in points {
        let turned = rotation * Vec3A::from(point);
        mins = mins.min(turned);
        maxs = maxs.max(turned);
    }
    Aabb::new(
        pose.translation + Vector::from(mins),
        pose.translation + Vector::from(maxs),
    )
}
