//! The edge graph of a triangulated hull: rows of neighbours, with the faces between them.

use std::array;

use super::surface::{Surface, triangle};
use super::top::LANES;
use crate::support::VertexId;

/// An edge is named by its lower vertex, above this many bits, and its place in that vertex's
/// row. With at most 2^15 vertices the name has 30 bits, as parry's packed feature ids do.
const PLACE_BITS: u32 = 15;

/// The neighbours of each vertex in rows.
#[derive(Clone, Debug)]
pub(super) struct EdgeGraph {
    /// Where the rows of each vertex begin, and with [`FRAGILE`] what sort of vertex it is; at the
    /// end, where the last rows end.
    first: Box<[u32]>,
    rows: Box<[Row]>,
}

/// A bit that no number of rows has: at this vertex a tie must be looked into.
const FRAGILE: u32 = 1 << 31;

/// Four neighbours of a vertex, clockwise seen from outside. The last row is filled up with the
/// first neighbour, which comes after the last one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub to: [u16; LANES],
    /// The face left of the edge to each of them. Right of it is that left of the next one.
    left: [u16; LANES],
}

impl EdgeGraph {
    /// From a surface whose triangles went to the faces `face_of`.
    pub fn new(surface: &Surface<'_>, face_of: &[u16]) -> Self {
        let count = surface.vertex_count();
        let mut first = Vec::with_capacity(count + 1);
        let mut rows = Vec::with_capacity(2 * count);
        first.push(0);
        for v in 0..count as u32 {
            let around = surface.leaving(v);
            for chunk in around.chunks(LANES) {
                let sides = array::from_fn(|i| chunk.get(i).unwrap_or(&around[0]));
                rows.push(Row {
                    to: sides.map(|side| side.to),
                    left: sides.map(|side| face_of[triangle(side.half_edge)]),
                });
            }
            first.push(rows.len() as u32);
        }
        Self {
            first: first.into(),
            rows: rows.into(),
        }
    }

    /// Marks the vertices at which a climb must look into ties.
    pub fn mark_fragile(&mut self, is_fragile: impl Fn(&Self, VertexId) -> bool) {
        for v in 0..self.first.len() - 1 {
            if is_fragile(self, v as VertexId) {
                self.first[v] |= FRAGILE;
            }
        }
    }

    /// Whether a climb must look into ties at this vertex.
    #[inline]
    pub fn is_fragile(&self, vertex: VertexId) -> bool {
        self.first[vertex as usize] & FRAGILE != 0
    }

    /// The neighbours of a vertex, in fours; the first may be repeated.
    #[inline]
    pub fn rows(&self, vertex: VertexId) -> &[Row] {
        let v = vertex as usize;
        &self.rows[row(self.first[v])..row(self.first[v + 1])]
    }

    /// The neighbours of a vertex; the first may be repeated.
    #[inline]
    pub fn neighbors(&self, vertex: VertexId) -> impl Iterator<Item = u16> {
        self.rows(vertex).iter().flat_map(|row| row.to)
    }

    /// The faces around a vertex, in fours, some of them more than once.
    #[inline]
    pub fn faces_at(&self, vertex: VertexId) -> impl Iterator<Item = [u16; LANES]> + Clone {
        self.rows(vertex).iter().map(|row| row.left)
    }

    /// The name of an edge, the same for both directions.
    pub fn edge_id(&self, from: VertexId, to: VertexId) -> Option<u32> {
        Some(edge_at(from.min(to), self.edge_place(from, to)?))
    }

    /// What the name of an edge has beside its lower vertex: its place there. All are looked at:
    /// where a search would end is not predictable.
    #[inline]
    pub fn edge_place(&self, from: VertexId, to: VertexId) -> Option<u16> {
        let (low, high) = (from.min(to), from.max(to));
        let rows = self.rows(low);
        let none = rows.len() * LANES;
        let mut place = none;
        for (r, row) in rows.iter().enumerate().rev() {
            for (lane, &w) in row.to.iter().enumerate().rev() {
                let here = r * LANES + lane;
                place = if VertexId::from(w) == high {
                    here
                } else {
                    place
                };
            }
        }
        (place < none).then_some(place as u16)
    }

    /// The end vertices of an edge.
    #[inline]
    pub fn edge(&self, id: u32) -> Option<[VertexId; 2]> {
        let (from, place) = split(id);
        let row = self.rows_of(from)?.get(place / LANES)?;
        Some([from, row.to[place % LANES].into()])
    }

    /// The faces on both sides of an edge.
    #[inline]
    pub fn faces_beside(&self, id: u32) -> Option<[u16; 2]> {
        let (from, place) = split(id);
        let rows = self.rows_of(from)?;
        let left = |place: usize| rows.get(place / LANES).map(|row| row.left[place % LANES]);
        Some([left(place)?, left(place + 1).or_else(|| left(0))?])
    }

    /// As [`rows`](Self::rows), of a vertex that there may not be.
    #[inline]
    fn rows_of(&self, vertex: VertexId) -> Option<&[Row]> {
        let v = vertex as usize;
        let (start, end) = (*self.first.get(v)?, *self.first.get(v + 1)?);
        self.rows.get(row(start)..row(end))
    }

    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.first) + size_of_val(&*self.rows)
    }
}

/// The number of a row, whatever is marked with it.
#[inline]
fn row(marked: u32) -> usize {
    (marked & !FRAGILE) as usize
}

/// The lower vertex of an edge, and its place there.
#[inline]
fn split(id: u32) -> (VertexId, usize) {
    (id >> PLACE_BITS, (id & ((1 << PLACE_BITS) - 1)) as usize)
}

/// The name of an edge from its lower vertex and its place there.
#[inline]
pub(super) fn edge_at(low: VertexId, place: u16) -> u32 {
    low << PLACE_BITS | u32::from(place)
}
