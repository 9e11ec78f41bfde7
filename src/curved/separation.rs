//! The separation of two shapes along a normal.

use glam::DVec3;

use super::surface_pieces::SurfacePieces;
use crate::stats::Cost;
use crate::support::{Cso, CsoVertex};

/// A normal, the extreme vertex of the difference along it, and the separation of the shapes along it.
#[derive(Clone, Copy, Debug)]
pub(super) struct NormalSeparation {
    pub normal: DVec3,
    pub extreme: CsoVertex,
    pub distance: f64,
}

impl NormalSeparation {
    /// The separation along a unit vector. Climbs start at the vertices of `near`, found along another one.
    pub fn along<A: SurfacePieces, B: SurfacePieces>(
        cso: &Cso<'_, A, B>,
        normal: DVec3,
        near: &CsoVertex,
        cost: &mut Cost,
    ) -> Self {
        let extreme = cso.support(normal, near.ids, cost);
        Self {
            normal,
            extreme,
            distance: -normal.dot(extreme.w),
        }
    }

    pub fn or(self, other: Self) -> Self {
        if other.distance > self.distance {
            other
        } else {
            self
        }
    }
}
