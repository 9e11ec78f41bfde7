//! The pose of the second shape in the frame of the first, in f64.

use glam::{DMat3, DQuat, DVec3};
use parry3d::math::Pose;

/// Maps points and directions between the frames of a pair: frame 1 is the first shape's.
#[derive(Clone, Copy, Debug)]
pub struct RelativePose {
    rotation: DMat3,
    translation: DVec3,
}

impl RelativePose {
    /// From an f32 pose of shape 2 in frame 1; its quaternion is normalised here, in f64.
    ///
    /// `None` when the pose is not finite or its quaternion has no direction.
    #[inline(always)]
    pub fn new(pos12: &Pose) -> Option<Self> {
        let q = pos12.rotation;
        let q = DQuat::from_xyzw(q.x.into(), q.y.into(), q.z.into(), q.w.into());
        let length = q.length_squared();
        let translation = pos12.translation.as_dvec3();
        if !(length.is_finite() && length > f64::MIN_POSITIVE && translation.is_finite()) {
            return None;
        }
        let rotation = DMat3::from_quat(q * length.sqrt().recip());
        Some(Self {
            rotation,
            translation,
        })
    }

    /// The pose of shape 1 in frame 2.
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.transpose();
        Self {
            rotation,
            translation: -(rotation * self.translation),
        }
    }

    /// A point of frame 2, in frame 1.
    #[inline]
    pub fn point_to_1(&self, p: DVec3) -> DVec3 {
        self.rotation * p + self.translation
    }

    /// A point of frame 1, in frame 2.
    #[inline]
    pub fn point_to_2(&self, p: DVec3) -> DVec3 {
        self.direction_to_2(p - self.translation)
    }

    /// A direction of frame 2, in frame 1.
    #[inline]
    pub fn direction_to_1(&self, d: DVec3) -> DVec3 {
        self.rotation * d
    }

    /// A direction of frame 1, in frame 2.
    #[inline]
    pub fn direction_to_2(&self, d: DVec3) -> DVec3 {
        DVec3::new(
            self.rotation.x_axis.dot(d),
            self.rotation.y_axis.dot(d),
            self.rotation.z_axis.dot(d),
        )
    }
}
