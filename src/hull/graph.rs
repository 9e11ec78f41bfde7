//! The edge graph of a triangulated hull: rows of neighbours, and the face left of each edge.

use std::array;

use super::surface::{HalfEdge, Side, Surface, triangle};
use super::top::LANES;
use crate::support::VertexId;

/// An edge is named by its lower vertex, above this many bits, and its place in that vertex's
/// row. With at most 2^15 vertices the name has 30 bits, as parry's packed feature ids do.
const PLACE_BITS: u32 = 15;

/// The neighbours of vertex `v` are the rows `first[v]..first[v + 1]`; the last row is filled up
/// with its own last neighbour. `left` and `right` have the faces beside each directed edge.
#[derive(Clone, Debug)]
pub(super) struct EdgeGraph {
    first: Box<[u32]>,
    rows: Box<[[u16; LANES]]>,
    left: Box<[[u16; LANES]]>,
    right: Box<[[u16; LANES]]>,
}

impl EdgeGraph {
    /// From a surface whose triangles went to the faces `face_of`.
    pub fn new(surface: &Surface<'_>, face_of: &[u16]) -> Self {
        let count = surface.vertex_count();
        let mut first = Vec::with_capacity(count + 1);
        let mut rows = Vec::with_capacity(2 * count);
        let mut left = Vec::with_capacity(2 * count);
        let mut right = Vec::with_capacity(2 * count);
        let face = |half_edge| face_of[triangle(half_edge)];
        first.push(0);
        for v in 0..count as u32 {
            for chunk in surface.leaving(v).chunks(LANES) {
                let lanes: [Side; LANES] = array::from_fn(|i| chunk[i.min(chunk.len() - 1)]);
                rows.push(lanes.map(|side| side.to));
                left.push(lanes.map(|side| face(side.half_edge)));
                right.push(lanes.map(|side| face(surface.twin(side.half_edge))));
            }
            first.push(rows.len() as u32);
        }
        Self {
            first: first.into(),
            rows: rows.into(),
            left: left.into(),
            right: right.into(),
        }
    }

    /// The neighbours of a vertex, in fours; the last may be repeated.
    #[inline]
    pub fn rows(&self, vertex: VertexId) -> &[[u16; LANES]] {
        let v = vertex as usize;
        &self.rows[self.first[v] as usize..self.first[v + 1] as usize]
    }

    /// The neighbours of a vertex; the last may be repeated.
    #[inline]
    pub fn neighbors(&self, vertex: VertexId) -> &[u16] {
        self.rows(vertex).as_flattened()
    }

    /// The faces around a vertex, some of them more than once.
    #[inline]
    pub fn faces_at(&self, vertex: VertexId) -> &[u16] {
        let v = vertex as usize;
        self.left[self.first[v] as usize..self.first[v + 1] as usize].as_flattened()
    }

    /// The name of an edge, the same for both directions.
    pub fn edge_id(&self, from: VertexId, to: VertexId) -> Option<u32> {
        let (low, high) = (from.min(to), from.max(to));
        let place = self.place(low, high)?;
        Some(low << PLACE_BITS | place as u32)
    }

    /// Where `to` first occurs among the neighbours of `from`. All are looked at: where a search
    /// would end is not predictable.
    #[inline]
    fn place(&self, from: VertexId, to: VertexId) -> Option<usize> {
        let around = self.neighbors(from);
        let mut place = around.len();
        for (i, &w) in around.iter().enumerate().rev() {
            place = if VertexId::from(w) == to { i } else { place };
        }
        (place < around.len()).then_some(place)
    }

    /// The end vertices of an edge.
    #[inline]
    pub fn edge(&self, id: u32) -> Option<[VertexId; 2]> {
        let (from, row, lane) = self.locate(id)?;
        Some([from, self.rows[row][lane].into()])
    }

    /// The faces on both sides of an edge.
    #[inline]
    pub fn faces_beside(&self, id: u32) -> Option<[u16; 2]> {
        let (_, row, lane) = self.locate(id)?;
        Some([self.left[row][lane], self.right[row][lane]])
    }

    /// The lower vertex of an edge, and where the other one is among the rows.
    #[inline]
    fn locate(&self, id: u32) -> Option<(VertexId, usize, usize)> {
        let (from, place) = (id >> PLACE_BITS, (id & ((1 << PLACE_BITS) - 1)) as usize);
        let (start, end) = (
            *self.first.get(from as usize)?,
            *self.first.get(from as usize + 1)?,
        );
        let row = start as usize + place / LANES;
        (row < end as usize).then_some((from, row, place % LANES))
    }

    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.first)
            + size_of_val(&*self.rows)
            + size_of_val(&*self.left)
            + size_of_val(&*self.right)
    }
}

/// The name that the graph of a surface gives to an edge.
pub(super) fn edge_name(surface: &Surface<'_>, h: HalfEdge) -> u32 {
    let twin = surface.twin(h);
    let h = if surface.start(h) < surface.start(twin) {
        h
    } else {
        twin
    };
    surface.start(h) << PLACE_BITS | surface.place(h)
}
