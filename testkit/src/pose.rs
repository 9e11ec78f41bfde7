//! A rigid pose in f64.

use glam::{DQuat, DVec3};
use parry3d::math::Pose;

/// The place of one shape in the frame of another: `p ↦ rotation · p + translation`.
#[derive(Clone, Copy, Debug, Default)]
pub struct ExactPose {
    pub rotation: DQuat,
    pub translation: DVec3,
}

impl ExactPose {
    pub fn apply(&self, point: DVec3) -> DVec3 {
        self.rotation * point + self.translation
    }

    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.inverse();
        Self {
            rotation,
            translation: rotation * -self.translation,
        }
    }

    /// The nearest pose that f32 can hold, so that the crate and the oracle see the same.
    pub fn rounded(self) -> Self {
        Self {
            rotation: self.rotation.as_quat().as_dquat().normalize(),
            translation: self.translation.as_vec3().as_dvec3(),
        }
    }

    /// The same pose as the crate is given it.
    pub fn to_f32(self) -> Pose {
        Pose::from_parts(self.translation.as_vec3(), self.rotation.as_quat())
    }
}
