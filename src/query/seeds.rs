//! Where an expanding polytope starts from.

use std::array;

use crate::query::types::Feature;
use crate::support::{Cso, CsoVertex, Polytope, VertexId};

/// Of a face with more corners some are enough.
const CORNERS: usize = 4;

/// A few points of the Minkowski difference.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct EpaSeeds {
    points: [CsoVertex; CORNERS + 1],
    len: usize,
}

impl EpaSeeds {
    /// Around the facet that `features` span, and the centre beneath it.
    pub fn under<A: Polytope, B: Polytope>(cso: &Cso<'_, A, B>, features: [Feature; 2]) -> Self {
        let mut seeds = Self::default();
        let (corners_1, count_1) = corners(cso.shape_1, features[0]);
        let (corners_2, count_2) = corners(cso.shape_2, features[1]);
        for id_1 in &corners_1[..count_1] {
            for id_2 in &corners_2[..count_2] {
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

/// The corners of a feature, those of a large face spread around it, and how many they are.
fn corners(shape: &impl Polytope, feature: Feature) -> ([VertexId; CORNERS], usize) {
    match feature {
        Feature::Vertex(vertex) => ([vertex; CORNERS], 1),
        Feature::Edge(edge) => {
            let [from, to] = shape.edge_ends(edge).unwrap_or_default();
            ([from, to, from, to], 2)
        }
        Feature::Face(face) => {
            let len = shape.face_len(face);
            let count = len.min(CORNERS);
            let corner = |i: usize| shape.face_vertex(face, i % count * len / count);
            (array::from_fn(corner), count)
        }
    }
}
