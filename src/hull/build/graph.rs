//! The edge graph of a surface.

use super::half_edge::{DirectedEdge, HalfEdgeMesh};
use crate::hull::graph::{BLOCK, EdgeGraph, LAST, MARK, NeighborBlock, OVERFLOW, PLATEAU_SEARCH};
use crate::support::VertexId;

impl NeighborBlock {
    /// From sides that leave a vertex. The `first` fills up unused slots.
    #[inline]
    fn new(sides: &[DirectedEdge], first: &DirectedEdge, face_of: &[u16]) -> Self {
        let left = |side: &DirectedEdge| face_of[usize::from(side.triangle)];
        let mut block = Self {
            to: [first.to; BLOCK],
            left: [left(first); BLOCK],
        };
        for (i, side) in sides.iter().take(BLOCK).enumerate() {
            (block.to[i], block.left[i]) = (side.to, left(side));
        }
        block
    }

    /// With another block after it.
    fn with_overflow(mut self, slot: usize) -> Self {
        self.to[OVERFLOW] |= MARK;
        self.left[LAST] = slot as u16;
        self
    }
}

impl EdgeGraph {
    /// From a surface, and the face of each triangle.
    pub fn new(mesh: &HalfEdgeMesh<'_>, face_of: &[u16]) -> Self {
        let mut overflow = Vec::new();
        let blocks = (0..mesh.vertex_count()).map(|v| {
            let around = mesh.outgoing(v as u32);
            let block = |sides| NeighborBlock::new(sides, &around[0], face_of);
            if around.len() <= BLOCK {
                return block(around);
            }
            // From the last block to the first, since each stores the index of the next.
            let last = (around.len() - 2) / LAST;
            (1..=last)
                .rev()
                .fold(block(&around[last * LAST..]), |after, number| {
                    overflow.push(after);
                    let sides = &around[(number - 1) * LAST..][..BLOCK];
                    block(sides).with_overflow(overflow.len() - 1)
                })
        });
        Self {
            blocks: blocks.collect(),
            overflow: overflow.into(),
        }
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
