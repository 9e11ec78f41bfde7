//! The edge graph of a triangulated hull: rows of neighbours, and the face left of each edge.

use std::array;

use glam::{DVec3, Vec3};
use wide::f64x4;

use super::surface::{HalfEdge, Side, Surface, triangle};
use crate::support::{FaceId, VertexId};

/// Neighbours are stored and evaluated in fours, so that a climb has no branch per neighbour.
pub(super) const LANES: usize = 4;

/// An edge is named by its lower vertex, above this many bits, and its place in that vertex's
/// row. With at most 2^15 vertices the name has 30 bits, as parry's packed feature ids do.
const PLACE_BITS: u32 = 15;

/// All that a query asks about four neighbours of a vertex, on one line of the cache. In a world of
/// many different hulls none of them is in the near caches, and a query costs what it fetches.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Row {
    x: [f32; LANES],
    y: [f32; LANES],
    z: [f32; LANES],
    pub to: [u16; LANES],
    /// The face left of the edge to each.
    left: [u16; LANES],
}

impl Row {
    /// The heights of the neighbours in a direction, as [`DVec3::dot`] computes them.
    #[inline]
    pub fn heights(&self, dir: DVec3) -> [f64; LANES] {
        let [x, y, z] = [self.x, self.y, self.z].map(|c| f64x4::from(c.map(f64::from)));
        (x * dir.x + y * dir.y + z * dir.z).to_array()
    }

    #[inline]
    fn point(&self, lane: usize) -> DVec3 {
        Vec3::new(self.x[lane], self.y[lane], self.z[lane]).as_dvec3()
    }
}

/// The neighbours of vertex `v` are the rows `first[v]..first[v + 1]`; the last row is filled up
/// with its own last neighbour.
#[derive(Clone, Debug)]
pub(super) struct EdgeGraph {
    first: Box<[u32]>,
    rows: Box<[Row]>,
}

impl EdgeGraph {
    /// From a surface whose triangles went to the faces `face_of`.
    pub fn new(points: &[Vec3], surface: &Surface<'_>, face_of: &[u16]) -> Self {
        let mut first = Vec::with_capacity(points.len() + 1);
        let mut rows = Vec::with_capacity(2 * points.len());
        first.push(0);
        for v in 0..points.len() as u32 {
            for chunk in surface.leaving(v).chunks(LANES) {
                let lanes: [Side; LANES] = array::from_fn(|i| chunk[i.min(chunk.len() - 1)]);
                let ends = lanes.map(|side| points[usize::from(side.to)]);
                rows.push(Row {
                    x: ends.map(|end| end.x),
                    y: ends.map(|end| end.y),
                    z: ends.map(|end| end.z),
                    to: lanes.map(|side| side.to),
                    left: lanes.map(|side| face_of[triangle(side.half_edge)]),
                });
            }
            first.push(rows.len() as u32);
        }
        Self {
            first: first.into(),
            rows: rows.into(),
        }
    }

    /// The neighbours of a vertex, in fours; the last may be repeated.
    #[inline]
    pub fn rows(&self, vertex: VertexId) -> &[Row] {
        let v = vertex as usize;
        &self.rows[self.first[v] as usize..self.first[v + 1] as usize]
    }

    /// The neighbours of a vertex and where they are; the last may be repeated.
    #[inline]
    pub fn neighbors(&self, vertex: VertexId) -> impl Iterator<Item = (VertexId, DVec3)> {
        let rows = self.rows(vertex).iter();
        rows.flat_map(|row| array::from_fn::<_, LANES, _>(|i| (row.to[i].into(), row.point(i))))
    }

    /// The faces around a vertex, some of them more than once.
    #[inline]
    pub fn faces_at(&self, vertex: VertexId) -> impl Iterator<Item = u16> {
        self.rows(vertex).iter().flat_map(|row| row.left)
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
        let mut place = usize::MAX;
        for (r, row) in self.rows(from).iter().enumerate().rev() {
            for (lane, &w) in row.to.iter().enumerate().rev() {
                let is_it = VertexId::from(w) == to;
                place = if is_it { r * LANES + lane } else { place };
            }
        }
        (place != usize::MAX).then_some(place)
    }

    /// The end vertices of an edge.
    pub fn edge(&self, id: u32) -> Option<[VertexId; 2]> {
        let (from, place) = (id >> PLACE_BITS, id & ((1 << PLACE_BITS) - 1));
        if from as usize + 1 >= self.first.len() {
            return None;
        }
        let row = self.rows(from).get(place as usize / LANES)?;
        Some([from, row.to[place as usize % LANES].into()])
    }

    /// The faces on both sides of the edge between two neighbours.
    pub fn faces_beside(&self, ends: [VertexId; 2]) -> Option<[FaceId; 2]> {
        let left = |from, to| {
            let place = self.place(from, to)?;
            Some(self.rows(from)[place / LANES].left[place % LANES].into())
        };
        Some([left(ends[0], ends[1])?, left(ends[1], ends[0])?])
    }

    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.first) + size_of_val(&*self.rows)
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
