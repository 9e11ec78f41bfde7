//! The points from which a polytope expands.

use super::feature::{CORNERS, Feature};
use crate::support::{Cso, CsoVertex, Polytope};

/// A few points of the Minkowski difference.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct EpaSeeds {
    points: [CsoVertex; CORNERS + 1],
    len: usize,
}

impl EpaSeeds {
    /// The corners of the facet that `features` span, and the centre beneath it.
    pub fn under<A: Polytope, B: Polytope>(cso: &Cso<'_, A, B>, features: [Feature; 2]) -> Self {
        let mut seeds = Self::default();
        let (corners_1, count_1) = features[0].corners(cso.shape_1);
        let (corners_2, count_2) = features[1].corners(cso.shape_2);
        for id_1 in &corners_1[..count_1.min(CORNERS)] {
            for id_2 in &corners_2[..count_2.min(CORNERS)] {
                seeds.push(cso.vertex([*id_1, *id_2]));
            }
        }
        seeds.push(cso.center_as_vertex([corners_1[0], corners_2[0]]));
        seeds
    }

    pub fn as_slice(&self) -> &[CsoVertex] {
        &self.points[..self.len]
    }

    pub fn push(&mut self, point: CsoVertex) {
        debug_assert!(self.len <= CORNERS, "more seeds than there is room for");
        self.points[self.len] = point;
        self.len += 1;
    }
}
