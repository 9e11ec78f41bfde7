//! Lists of what is around the vertices of a surface.

use crate::hull::build::adjacency::VERTICES;
use crate::hull::build::graph::{GraphBuilder, Neighbor};
use crate::hull::graph::{BLOCK, NeighborBlock};

/// Room for the edges between faces, of which there are fewer than three for each vertex.
pub(super) const EDGES: usize = 4 * VERTICES;

/// What the walks find.
pub(super) struct AroundVertices {
    /// The neighbours of a vertex, clockwise seen from outside, and the faces left of the edges to them.
    pub to: [u16; VERTICES],
    pub left: [u16; VERTICES],
    /// The edges between two faces.
    pub edges: Box<[EdgeBetweenFaces; EDGES]>,
}

/// An edge between two faces, by the triangles left and right of it.
#[derive(Clone, Copy, Default)]
pub(super) struct EdgeBetweenFaces {
    pub from: u8,
    pub left: u8,
    pub right: u8,
    /// The corner of the right triangle opposite to it.
    pub right_corner: u8,
}

impl Default for AroundVertices {
    fn default() -> Self {
        Self {
            to: [0; _],
            left: [0; _],
            edges: Box::new([EdgeBetweenFaces::default(); _]),
        }
    }
}

impl AroundVertices {
    /// Fills the first block with one neighbour and the face left of the edge to it.
    #[inline]
    pub fn fill_block(&mut self, to: u16, left: u16) {
        let (all_to, all_left) = (&mut self.to, &mut self.left);
        if let (Some(first), Some(faces)) = (all_to.first_chunk_mut(), all_left.first_chunk_mut()) {
            (*first, *faces) = ([to; BLOCK], [left; BLOCK]);
        }
    }

    /// Adds the neighbours of a vertex to the graph.
    #[inline]
    pub fn push_to(&self, graph: &mut GraphBuilder, count: usize) {
        match (self.to.first_chunk(), self.left.first_chunk()) {
            (Some(&to), Some(&left)) if count <= BLOCK => {
                graph.push_block(NeighborBlock { to, left });
            }
            _ => self.push_many_to(graph, count),
        }
    }

    #[cold]
    fn push_many_to(&self, graph: &mut GraphBuilder, count: usize) {
        let all = self.to.iter().zip(&self.left).take(count);
        let around: Vec<_> = all.map(|(&to, &left)| Neighbor { to, left }).collect();
        graph.push(&around);
    }
}
