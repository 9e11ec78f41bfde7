//! The edge graph of a surface.

use super::half_edge::{DirectedEdge, HalfEdgeMesh};
use crate::at::to_u16;
use crate::hull::graph::{BLOCK, EdgeGraph, LAST, MARK, NeighborBlock, OVERFLOW, PLATEAU_SEARCH};
use crate::support::VertexId;

/// A neighbour of a vertex, and the face left of the edge to it.
#[derive(Clone, Copy)]
pub(super) struct Neighbor {
    pub to: u16,
    pub left: u16,
}

/// Adds the neighbours of one vertex after the other.
pub(super) struct GraphBuilder {
    blocks: Vec<NeighborBlock>,
    overflow: Vec<NeighborBlock>,
}

impl GraphBuilder {
    pub fn new(count: usize) -> Self {
        Self {
            blocks: Vec::with_capacity(count),
            overflow: Vec::new(),
        }
    }

    /// Adds the only block of the next vertex.
    #[inline]
    pub fn push_block(&mut self, block: NeighborBlock) {
        self.blocks.push(block);
    }

    /// Adds the neighbours of the next vertex, clockwise seen from outside.
    #[inline]
    pub fn push(&mut self, around: &[Neighbor]) {
        let block = |neighbors| NeighborBlock::new(neighbors, around[0]);
        if around.len() <= BLOCK {
            self.blocks.push(block(around));
            return;
        }
        // From the last block to the first, since each stores the index of the next.
        let last = (around.len() - 2) / LAST;
        let mut after = block(&around[last * LAST..]);
        for number in (0..last).rev() {
            self.overflow.push(after);
            let neighbors = &around[number * LAST..][..BLOCK];
            after = block(neighbors).with_overflow(self.overflow.len() - 1);
        }
        self.blocks.push(after);
    }

    pub fn finish(self) -> EdgeGraph {
        EdgeGraph {
            blocks: self.blocks.into(),
            overflow: self.overflow.into(),
        }
    }
}

impl NeighborBlock {
    /// The `first` neighbour fills up unused slots.
    #[inline]
    fn new(neighbors: &[Neighbor], first: Neighbor) -> Self {
        let mut block = Self {
            to: [first.to; BLOCK],
            left: [first.left; BLOCK],
        };
        let slots = block.to.iter_mut().zip(&mut block.left);
        for ((to, left), neighbor) in slots.zip(neighbors) {
            (*to, *left) = (neighbor.to, neighbor.left);
        }
        block
    }

    /// With another block after it.
    fn with_overflow(mut self, slot: usize) -> Self {
        self.to[OVERFLOW] |= MARK;
        self.left[LAST] = to_u16(slot);
        self
    }
}

impl EdgeGraph {
    /// From a surface, and the face of each triangle.
    pub fn new(mesh: &HalfEdgeMesh<'_>, face_of: &[u16]) -> Self {
        let neighbor = |side: &DirectedEdge| Neighbor {
            to: side.to,
            left: face_of[usize::from(side.triangle)],
        };
        let mut builder = GraphBuilder::new(mesh.vertex_count());
        let mut around = Vec::new();
        for v in (0..).take(mesh.vertex_count()) {
            around.clear();
            around.extend(mesh.outgoing(v).iter().map(neighbor));
            builder.push(&around);
        }
        builder.finish()
    }

    /// Marks the vertices at which ties need a plateau search.
    pub fn mark_plateau_search(&mut self, needs_plateau_search: impl Fn(&Self, VertexId) -> bool) {
        for v in 0..self.blocks.len() {
            if needs_plateau_search(self, VertexId::new(v)) {
                self.blocks[v].to[PLATEAU_SEARCH] |= MARK;
            }
        }
    }
}
