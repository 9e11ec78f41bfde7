//! The contact normal in the frames of both shapes.

use glam::{DVec3, Vec3};

use crate::map_pair::map_pair;
use crate::pose::RelativePose;
use crate::query::Proximity;

/// Unit normals that point out of both shapes, each in the frame of its shape, in the kernels' order.
pub(super) struct Normals {
    pub exact: [DVec3; 2],
    /// As a manifold has them.
    pub rounded: [Vec3; 2],
}

impl Normals {
    #[inline(always)]
    pub fn of(near: &Proximity, pose: &RelativePose) -> Self {
        let exact = [near.normal, -pose.direction_to_2(near.normal)];
        Self {
            exact,
            rounded: map_pair(exact, |normal| normal.as_vec3()),
        }
    }
}
