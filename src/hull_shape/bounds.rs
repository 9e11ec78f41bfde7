//! Bounding boxes by support queries.

use glam::{Mat3A, Vec3A};
use parry3d::bounding_volume::Aabb;
use parry3d::math::{Pose, Vector};

use super::HullShape;

/// A scan of so many points takes as long as six climbs.
const SCAN_UP_TO: usize = 200;

impl HullShape {
    /// The box around the hull at a pose, its axes those of the world.
    #[inline]
    pub(super) fn aabb(&self, pose: &Pose) -> Aabb {
        if self.hull().points().len() <= SCAN_UP_TO {
            self.scanned_aabb(pose)
        } else {
            self.climbed_aabb(pose)
        }
    }

    fn scanned_aabb(&self, pose: &Pose) -> Aabb {
        let rotation = Mat3A::from_quat(pose.rotation);
        let (mut mins, mut maxs) = (Vec3A::INFINITY, Vec3A::NEG_INFINITY);
        for &point in self.hull().points() {
            let turned = rotation * Vec3A::from(point);
            mins = mins.min(turned);
            maxs = maxs.max(turned);
        }
        Aabb::new(
            pose.translation + Vector::from(mins),
            pose.translation + Vector::from(maxs),
        )
    }

    fn climbed_aabb(&self, pose: &Pose) -> Aabb {
        let to_local = pose.rotation.inverse();
        let axes = [Vector::X, Vector::Y, Vector::Z].map(|axis| to_local * axis);
        let reach =
            |axis: usize, sign: f32| axes[axis].dot(self.hull().support_toward(sign * axes[axis]));
        let corner = |sign| Vector::new(reach(0, sign), reach(1, sign), reach(2, sign));
        Aabb::new(
            pose.translation + corner(-1.0),
            pose.translation + corner(1.0),
        )
    }
}
