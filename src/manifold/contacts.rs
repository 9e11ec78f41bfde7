//! Up to four contacts, stored coordinate by coordinate, so that four are computed at once.

use crate::simd::f32x4;
use glam::{DVec3, Vec3};

use crate::pose::RelativePose;
use crate::query::{Feature, Proximity};
use crate::simd::LANES;

/// More points than these add no stiffness to a rigid contact.
pub const MAX_POINTS: usize = LANES;

/// One contact: a point on each shape, on a line along the manifold's normal.
#[derive(Clone, Copy, Debug)]
pub struct ContactPoint {
    /// On the first shape, in frame 1.
    pub on_1: Vec3,
    /// On the second shape, in frame 2.
    pub on_2: Vec3,
    /// From the first to the second point along the normal; negative where the shapes overlap.
    pub distance: f32,
    /// The features that meet there.
    pub features: [Feature; 2],
}

/// Up to four contacts with one normal; the witness of the query comes first.
#[derive(Clone, Copy, Debug)]
pub struct Contacts {
    pub(crate) on_1: [f32x4; 3],
    pub(crate) on_2: [f32x4; 3],
    pub(crate) distance: f32x4,
    pub(crate) features: [[Feature; 2]; MAX_POINTS],
    pub(crate) len: usize,
}

impl Contacts {
    /// The contacts, one by one.
    pub fn iter(&self) -> impl Iterator<Item = ContactPoint> {
        let point = |of: &[f32x4; 3], lane: usize| Vec3::from(of.map(|row| row.to_array()[lane]));
        (0..self.len).map(move |lane| ContactPoint {
            on_1: point(&self.on_1, lane),
            on_2: point(&self.on_2, lane),
            distance: self.distance.to_array()[lane],
            features: self.features[lane],
        })
    }

    /// The witness as the only contact.
    pub fn witness(proximity: &Proximity, pose: &RelativePose) -> Self {
        let splat = |p: DVec3| p.as_vec3().to_array().map(f32x4::splat);
        Self {
            on_1: splat(proximity.on_1),
            on_2: splat(pose.point_to_2(proximity.on_2)),
            distance: f32x4::splat(proximity.signed_distance as f32),
            features: [proximity.features; MAX_POINTS],
            len: 1,
        }
    }
}
