//! Which edges of a surface are nearly flat. Faces are merged and clusters grow only over these, and most
//! hulls have few of them.

use glam::DVec3;

use super::half_edge::{HalfEdge, HalfEdgeMesh, triangle};
use crate::tolerance::{MIN_TRIANGLE_HEIGHT, NEARLY_FLAT_COS};

/// Twice the area vector of a triangle.
pub(super) fn area_vector(points: &[DVec3], triangle: [u32; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(|v| points[v as usize]);
    (b - a).cross(c - a)
}

pub(super) fn longest_side(points: &[DVec3], triangle: [u32; 3]) -> f64 {
    let [a, b, c] = triangle.map(|v| points[v as usize]);
    let squares = [a - b, b - c, c - a].map(DVec3::length_squared);
    squares[0].max(squares[1]).max(squares[2]).sqrt()
}

/// The triangles of a surface as vectors.
pub(super) struct AreaVectors {
    /// Twice their area vectors.
    pub vectors: Vec<DVec3>,
    /// The lengths of these vectors.
    pub areas: Vec<f64>,
    /// Whether the normal of a triangle depends on how its corners are rounded.
    pub is_sliver: Vec<bool>,
}

impl AreaVectors {
    pub fn new(points: &[DVec3], triangles: &[[u32; 3]], radius: f64) -> Self {
        let vectors: Vec<DVec3> = triangles.iter().map(|&t| area_vector(points, t)).collect();
        let areas: Vec<f64> = vectors.iter().map(|vector| vector.length()).collect();
        let height = MIN_TRIANGLE_HEIGHT * radius;
        let is_sliver = (triangles.iter().zip(&areas)).map(|(&triangle, &area)| {
            // No side is longer than the hull.
            area <= 2.0 * radius * height && area <= height * longest_side(points, triangle)
        });
        Self {
            is_sliver: is_sliver.collect(),
            vectors,
            areas,
        }
    }

    fn are_nearly_parallel(&self, triangles: [usize; 2]) -> bool {
        let [a, b] = triangles.map(|t| self.vectors[t]);
        let [area, other] = triangles.map(|t| self.areas[t]);
        a.dot(b) >= NEARLY_FLAT_COS * area * other || triangles.iter().any(|&t| self.is_sliver[t])
    }
}

/// The edges at which a surface bends by less than four degrees, and all edges of slivers.
pub(super) struct NearlyFlatEdges {
    /// For each half-edge.
    is_flat: Vec<bool>,
    is_empty: bool,
}

impl NearlyFlatEdges {
    pub fn new(mesh: &HalfEdgeMesh<'_>, surface: &AreaVectors) -> Self {
        let mut edges = Self {
            is_flat: vec![false; 3 * mesh.triangles.len()],
            is_empty: true,
        };
        for h in 0..edges.is_flat.len() as HalfEdge {
            let twin = mesh.twin(h);
            if h < twin && surface.are_nearly_parallel([h, twin].map(triangle)) {
                edges.is_flat[h as usize] = true;
                edges.is_flat[twin as usize] = true;
                edges.is_empty = false;
            }
        }
        edges
    }

    pub fn is_empty(&self) -> bool {
        self.is_empty
    }

    #[inline]
    pub fn contains(&self, h: HalfEdge) -> bool {
        self.is_flat[h as usize]
    }
}
