//! The edge graph of a triangulated hull: the neighbours of each vertex, and the faces between them.

use std::iter;

use crate::at::to_u16;
use crate::support::{EdgeId, VertexId};

/// The lower bits of an edge's id are its slot among the neighbours of its lower vertex; the bits above are
/// this vertex. With at most 2^15 vertices the id has 30 bits, as in parry's packed feature ids.
const SLOT_BITS: u32 = 15;

/// A corner of a polygon.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceCorner {
    pub vertex: u16,
    /// The slot of the edge that starts here: its id is made of this and of its lower vertex.
    pub(super) slot: u16,
}

impl FaceCorner {
    /// A corner at a vertex, whose number fits into 16 bits.
    #[inline]
    pub fn new(vertex: u32, slot: u16) -> Self {
        Self {
            vertex: vertex as u16,
            slot,
        }
    }
}

/// The slot of a side that is no edge, but cuts across faces.
pub(super) const NO_EDGE: u16 = u16::MAX;

/// The neighbours of each vertex.
#[derive(Clone, Debug)]
#[repr(C)]
pub(super) struct EdgeGraph {
    /// The first neighbours of each vertex. Most vertices have no others.
    pub(super) blocks: Box<[NeighborBlock]>,
    /// The other neighbours, in no particular order.
    pub(super) overflow: Box<[NeighborBlock]>,
}

/// Neighbours of a vertex, clockwise seen from outside. Unused slots repeat the first neighbour, which also
/// follows the last one. If there are more, the last one is repeated as the first in the next block.
///
/// Each vertex has its own first block, so that no pointer need be followed to it, and each block lies on one
/// cache line.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(super) struct NeighborBlock {
    /// Vertices. The highest bits of the first two are marks.
    pub(super) to: [u16; BLOCK],
    /// The face left of the edge to each of them; the face right of it is the next entry. If there are more
    /// neighbours, the last entry is the index of the next block instead.
    pub(super) left: [u16; BLOCK],
}

/// On average, a vertex of a triangulated surface has six neighbours.
pub(super) const BLOCK: usize = 8;

/// A bit that no vertex id has.
pub(super) const MARK: u16 = 1 << 15;
/// The entry whose mark says that ties at this vertex need a plateau search.
pub(super) const PLATEAU_SEARCH: usize = 0;
/// The entry whose mark says that another block follows.
pub(super) const OVERFLOW: usize = 1;
/// The last slot of a block. As a number, it is how many neighbours the next block does not repeat.
pub(super) const LAST: usize = BLOCK - 1;

impl NeighborBlock {
    /// The neighbours.
    #[inline(always)]
    pub fn to(&self) -> [u16; BLOCK] {
        let mut to = self.to;
        to[PLATEAU_SEARCH] &= !MARK;
        to[OVERFLOW] &= !MARK;
        to
    }

    /// Whether ties at this vertex need a plateau search.
    #[inline(always)]
    pub fn needs_plateau_search(&self) -> bool {
        self.to[PLATEAU_SEARCH] & MARK != 0
    }

    /// Whether another block follows.
    #[inline(always)]
    pub fn has_overflow(&self) -> bool {
        self.to[OVERFLOW] & MARK != 0
    }

    /// The faces left of the edges to the neighbours. If another block follows, the last entry repeats the
    /// first.
    #[inline(always)]
    fn left(&self) -> [u16; BLOCK] {
        let mut left = self.left;
        if self.has_overflow() {
            left[LAST] = left[0];
        }
        left
    }
}

impl EdgeGraph {
    /// The first block of a vertex.
    #[inline(always)]
    pub fn block(&self, vertex: VertexId) -> &NeighborBlock {
        &self.blocks[vertex.index()]
    }

    /// The block after this one, if there are more neighbours.
    #[inline(always)]
    pub fn next_block(&self, block: &NeighborBlock) -> Option<&NeighborBlock> {
        block
            .has_overflow()
            .then(|| &self.overflow[usize::from(block.left[LAST])])
    }

    /// A block and all blocks after it.
    #[inline(always)]
    pub fn blocks_from<'a>(
        &'a self,
        block: &'a NeighborBlock,
    ) -> impl Iterator<Item = &'a NeighborBlock> + Clone {
        iter::successors(Some(block), |block| self.next_block(block))
    }

    #[inline(always)]
    fn blocks(&self, vertex: VertexId) -> impl Iterator<Item = &NeighborBlock> + Clone {
        self.blocks_from(self.block(vertex))
    }

    /// The block that has this slot of a vertex, and the slot within it. `None` if there is no such vertex or
    /// slot.
    #[inline(always)]
    fn find(&self, vertex: VertexId, mut slot: usize) -> Option<(&NeighborBlock, usize)> {
        let mut block = self.blocks.get(vertex.index())?;
        while slot >= LAST
            && let Some(after) = self.next_block(block)
        {
            block = after;
            slot -= LAST;
        }
        (slot < BLOCK).then_some((block, slot))
    }

    /// The neighbour in a slot.
    #[inline(always)]
    pub fn neighbor(&self, vertex: VertexId, slot: usize) -> Option<VertexId> {
        let (block, slot) = self.find(vertex, slot)?;
        Some((block.to[slot] & !MARK).into())
    }

    /// The neighbours of a vertex. The first may be repeated.
    #[inline]
    pub fn neighbors(&self, vertex: VertexId) -> impl Iterator<Item = u16> {
        self.blocks(vertex).flat_map(NeighborBlock::to)
    }

    /// The same in fours.
    #[inline]
    pub fn neighbors_in_fours(&self, vertex: VertexId) -> impl Iterator<Item = [VertexId; 4]> {
        self.blocks(vertex).flat_map(|block| {
            let [a, b, c, d, e, f, g, h] = block.to();
            [[a, b, c, d], [e, f, g, h]].map(|four| four.map(VertexId::from))
        })
    }

    /// The faces around a vertex, some of them more than once.
    #[inline]
    pub fn faces_around(&self, vertex: VertexId) -> impl Iterator<Item = [u16; BLOCK]> + Clone {
        self.blocks(vertex).map(NeighborBlock::left)
    }

    /// The id of an edge. It is the same in both directions.
    pub fn edge_between(&self, from: VertexId, to: VertexId) -> Option<EdgeId> {
        Some(pack_edge(from.min(to), self.edge_slot(from, to)?))
    }

    /// The first slot of an edge at its lower vertex. It looks at all slots: where a search would end is not
    /// predictable.
    #[inline]
    pub fn edge_slot(&self, from: VertexId, to: VertexId) -> Option<u16> {
        const NONE: usize = usize::MAX;
        let (low, high) = (from.min(to), from.max(to));
        let mut slot = NONE;
        for (s, block) in self.blocks(low).enumerate() {
            for (i, w) in block.to().into_iter().enumerate() {
                let is_first = (VertexId::from(w) == high) & (slot == NONE);
                slot = if is_first { s * LAST + i } else { slot };
            }
        }
        (slot != NONE).then(|| to_u16(slot))
    }

    /// The end vertices of an edge.
    #[inline]
    pub fn edge_ends(&self, edge: EdgeId) -> Option<[VertexId; 2]> {
        let (from, slot) = unpack_edge(edge);
        Some([from, self.neighbor(from, slot)?])
    }

    /// The faces on both sides of an edge.
    #[inline]
    pub fn faces_of_edge(&self, edge: EdgeId) -> Option<[u16; 2]> {
        let (from, slot) = unpack_edge(edge);
        let left = |slot| self.find(from, slot).map(|(block, slot)| block.left[slot]);
        Some([left(slot)?, left(slot + 1).or_else(|| left(0))?])
    }

    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.blocks) + size_of_val(&*self.overflow)
    }
}

/// The lower vertex of an edge, and its slot there.
#[inline]
fn unpack_edge(edge: EdgeId) -> (VertexId, usize) {
    let id = edge.index();
    (VertexId::new(id >> SLOT_BITS), id & ((1 << SLOT_BITS) - 1))
}

/// The id of an edge from its lower vertex and its slot there.
#[inline]
pub(super) fn pack_edge(low: VertexId, slot: u16) -> EdgeId {
    debug_assert!(u32::from(slot) < 1 << SLOT_BITS, "a slot of too many bits");
    EdgeId::from(u32::from(low) << SLOT_BITS | u32::from(slot))
}

#[cfg(test)]
mod tests {
    use std::f32::consts::TAU;

    use glam::Vec3;

    use super::*;
    use crate::Hull;
    use crate::support::{FaceId, Polytope};

    /// A pyramid over a regular polygon: its top has as many neighbours as that has sides.
    fn pyramid(sides: usize) -> Hull {
        let corner = |i: usize| {
            let (sin, cos) = (TAU * i as f32 / sides as f32).sin_cos();
            Vec3::new(cos, 0.0, sin)
        };
        let points: Vec<Vec3> = (0..sides).map(corner).chain([Vec3::Y]).collect();
        Hull::from_points(&points).expect("a solid pyramid")
    }

    #[test]
    fn edges_and_faces_are_found_around_vertices_with_any_number_of_neighbors() {
        for sides in (3..40).chain([200]) {
            let hull = pyramid(sides);
            let vertices = hull.vertex_ids();
            let top = vertices.clone().find(|&v| hull.vertex(v).y > 0.5);
            let top = top.expect("a pyramid has a top");
            let mut around: Vec<u16> = hull.graph.neighbors(top).collect();
            around.sort_unstable();
            around.dedup();
            assert_eq!(around.len(), sides);
            for v in vertices {
                let mut faces: Vec<u16> = hull.graph.faces_around(v).flatten().collect();
                faces.sort_unstable();
                faces.dedup();
                let has = |f: &u16, v| {
                    let f = FaceId::from(*f);
                    (0..hull.face_len(f)).any(|i| hull.face_vertex(f, i) == v)
                };
                let all: Vec<u16> = (0..)
                    .take(hull.face_count())
                    .filter(|f| has(f, v))
                    .collect();
                assert_eq!(faces, all, "{sides} sides, around {v}");
                for w in hull.graph.neighbors(v).map(VertexId::from) {
                    let id = hull.edge_between(v, w).expect("neighbours have an edge");
                    assert_eq!(hull.edge_ends(id), Some([v.min(w), v.max(w)]));
                    let mut beside = hull.graph.faces_of_edge(id).expect("an edge has faces");
                    beside.sort_unstable();
                    let both: Vec<u16> = all.iter().copied().filter(|f| has(f, w)).collect();
                    assert!(both == beside || beside[0] == beside[1] && both.contains(&beside[0]));
                }
            }
            let beyond = hull.points().len() + BLOCK;
            assert_eq!(hull.graph.neighbor(top, beyond), None);
            assert_eq!(hull.graph.neighbor(VertexId::new(beyond), 0), None);
        }
    }
}
