//! The nearly flat edges of a surface. Faces are merged only over these, and most hulls have few of them.

use glam::DVec3;

use super::area_vectors::AreaVectors;
use super::half_edge::{HalfEdge, HalfEdgeMesh, triangle};
use crate::at::At;
use crate::tolerance::NEARLY_FLAT_COS;

/// Edges at which a surface bends by less than four degrees, and edges of slivers.
pub(super) struct NearlyFlatEdges {
    /// For each half-edge; empty if no edge is flat.
    is_flat: Vec<bool>,
}

impl NearlyFlatEdges {
    /// The nearly flat edges among some edges.
    pub fn among(
        edges: &[HalfEdge],
        points: &[DVec3],
        mesh: &HalfEdgeMesh<'_>,
        surface: &AreaVectors,
        radius: f64,
    ) -> Self {
        let mut is_flat = Vec::new();
        for &h in edges {
            let beside = [h, mesh.twin(h)].map(triangle);
            let is_sliver = |t| surface.is_sliver(points, mesh.triangles, t, radius);
            let [one, other] = beside.map(|t| &surface.triangles[t]);
            if one.is_within(NEARLY_FLAT_COS, other) || beside.into_iter().any(is_sliver) {
                is_flat.resize(3 * mesh.triangles.len(), false);
                *is_flat.at_mut(h) = true;
                *is_flat.at_mut(mesh.twin(h)) = true;
            }
        }
        Self { is_flat }
    }

    pub fn is_empty(&self) -> bool {
        self.is_flat.is_empty()
    }

    #[inline]
    pub fn contains(&self, h: HalfEdge) -> bool {
        self.is_flat.at(h)
    }
}
