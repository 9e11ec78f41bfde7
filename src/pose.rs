//! The pose of the second shape in the frame of the first, in f64.

use glam::{DMat3, DQuat, DVec3, Quat, Vec3};
use parry3d::math::Pose;

use crate::simd::DVec3x4;
use crate::tolerance::NEARLY_UNIT;

/// Maps points and directions between the frames of a pair: frame 1 is the first shape's.
#[derive(Clone, Copy, Debug)]
pub struct RelativePose {
    rotation: DMat3,
    translation: DVec3,
}

/// A finite pose whose quaternion is not zero.
#[derive(Clone, Copy)]
pub(crate) struct ValidPose<'a>(&'a Pose);

impl<'a> ValidPose<'a> {
    #[inline]
    pub fn new(pos12: &'a Pose) -> Option<Self> {
        let length = pos12.rotation.length_squared();
        let is_valid =
            length.is_finite() && length > f32::MIN_POSITIVE && pos12.translation.is_finite();
        is_valid.then_some(Self(pos12))
    }
}

// Built in place: copying it out of an `Option` would stall every query on store forwarding.
impl From<ValidPose<'_>> for RelativePose {
    #[inline(always)]
    fn from(ValidPose(pos12): ValidPose<'_>) -> Self {
        let q = pos12.rotation;
        let q = DQuat::from_xyzw(q.x.into(), q.y.into(), q.z.into(), q.w.into());
        Self {
            rotation: DMat3::from_quat(q * unit_scale(q.length_squared())),
            translation: pos12.translation.as_dvec3(),
        }
    }
}

/// The factor that normalises something of about unit length, from its squared length.
///
/// This is one Newton step of the reciprocal root. A root and a division would be the longest dependency
/// chain of a separated query. The error is 3/8 of the squared excess.
#[inline(always)]
pub(crate) fn unit_scale(length_squared: f64) -> f64 {
    let excess = length_squared - 1.0;
    if excess.abs() < NEARLY_UNIT {
        1.0 - 0.5 * excess
    } else {
        length_squared.sqrt().recip()
    }
}

/// Whether a quaternion was normalised in f32.
#[inline]
pub(crate) fn is_nearly_unit(rotation: Quat) -> bool {
    (rotation.length_squared() - 1.0).abs() < NEARLY_UNIT as f32
}

/// How far a point at the distance 1 from the centre moves between two rotations, at most. Both quaternions are nearly
/// unit.
#[inline]
pub(crate) fn chord(a: Quat, b: Quat) -> f64 {
    // A chord of a turned unit sphere is at most twice that between the unit quaternions.
    2.0 * f64::from((a - b).length())
}

/// Whether this is a unit vector up to the rounding of f32, or not finite. For assertions.
pub(crate) fn is_unit(direction: DVec3) -> bool {
    let excess = direction.length_squared() - 1.0;
    excess.abs() < 2.0 * NEARLY_UNIT || !excess.is_finite()
}

impl RelativePose {
    /// From an f32 pose of shape 2 in frame 1. Its quaternion is normalised in f64. `None` if the pose is not
    /// finite, or its quaternion is zero.
    pub fn new(pos12: &Pose) -> Option<Self> {
        ValidPose::new(pos12).map(Self::from)
    }

    /// From the rotation and the place of shape 2 in frame 1.
    pub(crate) fn from_parts(rotation: DQuat, translation: DVec3) -> Self {
        Self {
            rotation: DMat3::from_quat(rotation),
            translation,
        }
    }

    /// Where the origin of frame 2 is, in frame 1.
    #[inline]
    pub(crate) fn translation(&self) -> DVec3 {
        self.translation
    }

    /// The rows of the rotation from frame 2 to frame 1, in f32.
    #[inline]
    pub(crate) fn rotation_rows(&self) -> [Vec3; 3] {
        let rows = self.rotation.transpose();
        [
            rows.x_axis.as_vec3(),
            rows.y_axis.as_vec3(),
            rows.z_axis.as_vec3(),
        ]
    }

    /// The pose of shape 1 in frame 2.
    #[inline]
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.transpose();
        Self {
            rotation,
            translation: -(rotation * self.translation),
        }
    }

    /// The pose of shape 2 after a translation `by` a vector in frame 1.
    #[inline]
    pub(crate) fn moved(&self, by: DVec3) -> Self {
        Self {
            translation: self.translation + by,
            ..*self
        }
    }

    /// How far a point of shape 2 has moved since an earlier pose, at most, if it is no farther than `lever` from
    /// the origin of frame 2.
    #[inline]
    pub(crate) fn way_from(&self, before: &Self, lever: f64) -> f64 {
        let [now, then] = [self.rotation, before.rotation];
        // Twice the squared chord of a point that is turned on the unit sphere, at most.
        let turned = now.x_axis.distance_squared(then.x_axis)
            + now.y_axis.distance_squared(then.y_axis)
            + now.z_axis.distance_squared(then.z_axis);
        self.translation.distance(before.translation) + (0.5 * turned).sqrt() * lever
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

    /// Four points of frame 2, in frame 1.
    #[inline(always)]
    pub(crate) fn points_to_1(&self, points: DVec3x4) -> DVec3x4 {
        let row = |axis: usize| {
            let row = DVec3::new(
                self.rotation.x_axis[axis],
                self.rotation.y_axis[axis],
                self.rotation.z_axis[axis],
            );
            points.dot(row) + self.translation[axis]
        };
        DVec3x4([row(0), row(1), row(2)])
    }

    /// Four points of frame 1, in frame 2.
    #[inline(always)]
    pub(crate) fn points_to_2(&self, points: DVec3x4) -> DVec3x4 {
        let from = points - self.translation;
        DVec3x4([
            from.dot(self.rotation.x_axis),
            from.dot(self.rotation.y_axis),
            from.dot(self.rotation.z_axis),
        ])
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
