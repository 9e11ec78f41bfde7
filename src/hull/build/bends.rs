//! How much a surface bends at its edges. No edge may be a dent, beyond rounding.

use std::mem;

use glam::DVec3;

use super::area_vectors::AreaVectors;
use super::half_edge::{DirectedEdge, HalfEdge, HalfEdgeMesh};
use crate::at::At;
use crate::hull::HullError;
use crate::tolerance::{FLAT_EDGE, MAX_DENT, NEARLY_FLAT_COS, STEEP_EDGE};

/// How much a surface bends at its edges.
#[derive(Default)]
pub(super) struct Bends {
    /// The edges that are not steep.
    pub not_steep: Vec<HalfEdge>,
    /// The edges that bend by less than four degrees.
    pub nearly_flat: Vec<HalfEdge>,
    /// The vertices of two triangles that are flat up to rounding; empty if there are none.
    at_flat_edge: Vec<bool>,
    /// The vertices with an edge that is not steep; empty if there are none.
    at_low_edge: Vec<bool>,
    /// Whether some edge is a [`FLAT_EDGE`], whatever point inside the radius is measured from.
    some_flat: bool,
}

/// An edge, from its lower vertex.
struct Edge<'a> {
    from: u32,
    side: &'a DirectedEdge,
    /// The next side clockwise, whose triangle is right of the edge.
    beside: &'a DirectedEdge,
}

impl Bends {
    /// Refuses edges that are dents. A closed surface in a single layer is convex if it is convex at every edge.
    ///
    /// The depth of a dent is how far its edge passes beneath the other diagonal of its two triangles. (Heights
    /// over the planes of the triangles mean nothing if these are slivers.)
    pub fn new(
        points: &[DVec3],
        mesh: &HalfEdgeMesh<'_>,
        surface: &AreaVectors,
        radius: f64,
    ) -> Result<Self, HullError> {
        let mut bends = Self::default();
        for from in (0..).take(points.len()) {
            let around = mesh.outgoing(from);
            let mut before = &around[around.len() - 1];
            for beside in around {
                let side = mem::replace(&mut before, beside);
                if u32::from(side.to) > from {
                    let edge = Edge { from, side, beside };
                    bends.add(points, surface, &edge, radius)?;
                }
            }
        }
        Ok(bends)
    }

    #[inline]
    fn add(
        &mut self,
        points: &[DVec3],
        surface: &AreaVectors,
        edge: &Edge<'_>,
        radius: f64,
    ) -> Result<(), HullError> {
        let [left, right] = [edge.side, edge.beside].map(|side| {
            let triangle = usize::from(side.triangle);
            &surface.triangles[triangle]
        });
        if left.is_within(NEARLY_FLAT_COS, right) {
            self.nearly_flat.push(edge.side.half_edge());
        }
        let across = points[usize::from(edge.beside.to)] - points.at(edge.from);
        // Six times the volume between the triangles, negative where the edge is convex.
        let rise = left.vector.dot(across);
        let area = if left.area > right.area {
            left.area
        } else {
            right.area
        };
        // The two diagonals span at most both areas, so such an edge is far from a dent.
        if -rise > STEEP_EDGE * radius * area {
            return Ok(());
        }
        // Twice, since the centre may be anywhere.
        self.some_flat |= -rise <= 2.0 * FLAT_EDGE * radius * area;
        self.note(points, edge, rise, radius)
    }

    /// Notes an edge that is not steep. An error if it is a dent.
    #[cold]
    fn note(
        &mut self,
        points: &[DVec3],
        edge: &Edge<'_>,
        rise: f64,
        radius: f64,
    ) -> Result<(), HullError> {
        let ends = [edge.from as usize, usize::from(edge.side.to)];
        let diagonal = [edge.side.third, edge.beside.to].map(usize::from);
        self.not_steep.push(edge.side.half_edge());
        mark(&mut self.at_low_edge, points.len(), &ends);
        let [along, across] = [ends, diagonal].map(|[a, b]| points[b] - points[a]);
        let rounding = MAX_DENT * radius * along.cross(across).length();
        if rise > rounding {
            return Err(HullError::NotConvex(diagonal[1]));
        }
        if rise >= -rounding {
            mark(&mut self.at_flat_edge, points.len(), &ends);
            mark(&mut self.at_flat_edge, points.len(), &diagonal);
        }
        Ok(())
    }

    /// Whether a vertex belongs to two triangles that are flat up to rounding.
    pub fn is_at_flat_edge(&self, vertex: usize) -> bool {
        self.at_flat_edge.get(vertex).is_some_and(|&is_at| is_at)
    }

    /// Whether all edges are steep.
    pub fn are_steep(&self) -> bool {
        self.not_steep.is_empty()
    }

    /// Whether all edges at a vertex are steep: no neighbour of its neighbours is as high as the planes around
    /// it.
    #[inline]
    pub fn is_steep(&self, vertex: u32) -> bool {
        self.at_low_edge.try_at(vertex).is_none_or(|&is_at| !is_at)
    }

    /// Whether no edge is a [`FLAT_EDGE`], so that the points have no other triangulation.
    pub fn everywhere(&self) -> bool {
        !self.some_flat
    }
}

fn mark(marks: &mut Vec<bool>, count: usize, vertices: &[usize]) {
    marks.resize(count, false);
    vertices.iter().for_each(|&v| marks[v] = true);
}
