//! The edge graph of a triangulated hull: rows of neighbours, and the face left of each edge.

use super::HullError;
use crate::support::{FaceId, VertexId};

/// Neighbours are stored and evaluated in fours, so that a climb has no branch per neighbour.
pub(super) const LANES: usize = 4;

/// An edge is named by its lower vertex, above this many bits, and its place in that vertex's
/// row. With at most 2^15 vertices the name has 30 bits, as parry's packed feature ids do.
const PLACE_BITS: u32 = 15;

/// The neighbours of vertex `v` are the rows `first[v]..first[v + 1]`; the last row is filled up
/// with its own last neighbour. `left` has the face left of each directed edge.
#[derive(Clone, Debug)]
pub(super) struct EdgeGraph {
    first: Box<[u32]>,
    rows: Box<[[u16; LANES]]>,
    left: Box<[[u16; LANES]]>,
}

impl EdgeGraph {
    /// From triangles, counter-clockwise seen from outside, over `count` vertices.
    pub fn new(count: usize, triangles: &[[u32; 3]]) -> Result<Self, HullError> {
        let mut neighbors = vec![Vec::with_capacity(2 * LANES); count];
        for triangle in triangles {
            for k in 0..3 {
                neighbors[triangle[k] as usize].push(triangle[(k + 1) % 3] as u16);
            }
        }
        require_manifold(&neighbors, triangles.len())?;
        let mut first = Vec::with_capacity(count + 1);
        let mut rows = Vec::with_capacity(2 * count);
        first.push(0);
        for around in &neighbors {
            for chunk in around.chunks(LANES) {
                let mut row = [chunk[chunk.len() - 1]; LANES];
                row[..chunk.len()].copy_from_slice(chunk);
                rows.push(row);
            }
            first.push(rows.len() as u32);
        }
        Ok(Self {
            left: vec![[0; LANES]; rows.len()].into(),
            first: first.into(),
            rows: rows.into(),
        })
    }

    /// Tells the graph which face each triangle belongs to.
    pub fn set_faces(&mut self, triangles: &[[u32; 3]], face_of: &[u16]) {
        for (triangle, &face) in triangles.iter().zip(face_of) {
            for k in 0..3 {
                let (from, to) = (triangle[k], triangle[(k + 1) % 3]);
                let first = self.first[from as usize] as usize;
                let end = self.first[from as usize + 1] as usize;
                let targets = self.rows[first..end].as_flattened();
                let faces = self.left[first..end].as_flattened_mut();
                // All copies of a neighbour, those that fill up the row, too.
                for (target, left) in targets.iter().zip(faces) {
                    if VertexId::from(*target) == to {
                        *left = face;
                    }
                }
            }
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

    fn place(&self, from: VertexId, to: VertexId) -> Option<usize> {
        let mut around = self.neighbors(from).iter();
        around.position(|&w| VertexId::from(w) == to)
    }

    /// The end vertices of an edge.
    pub fn edge(&self, id: u32) -> Option<[VertexId; 2]> {
        let (from, place) = (id >> PLACE_BITS, id & ((1 << PLACE_BITS) - 1));
        if from as usize + 1 >= self.first.len() {
            return None;
        }
        let to = *self.neighbors(from).get(place as usize)?;
        Some([from, to.into()])
    }

    /// The faces on both sides of the edge between two neighbours.
    pub fn faces_beside(&self, ends: [VertexId; 2]) -> Option<[FaceId; 2]> {
        let left = |from, to| Some(self.faces_at(from)[self.place(from, to)?].into());
        Some([left(ends[0], ends[1])?, left(ends[1], ends[0])?])
    }

    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.first) + size_of_val(&*self.rows) + size_of_val(&*self.left)
    }
}

/// Every directed edge is there once and has its reverse, and the surface is one sphere.
fn require_manifold(neighbors: &[Vec<u16>], triangles: usize) -> Result<(), HullError> {
    if let Some(loose) = neighbors.iter().position(Vec::is_empty) {
        return Err(HullError::LooseVertex(loose));
    }
    for (v, around) in neighbors.iter().enumerate() {
        for (i, &w) in around.iter().enumerate() {
            let reversed = neighbors[w as usize].contains(&(v as u16));
            if !reversed || around[..i].contains(&w) {
                return Err(HullError::NotManifold);
            }
        }
    }
    let sphere = neighbors.len() + triangles == triangles * 3 / 2 + 2;
    if sphere && reachable(neighbors) == neighbors.len() {
        Ok(())
    } else {
        Err(HullError::NotManifold)
    }
}

fn reachable(neighbors: &[Vec<u16>]) -> usize {
    let mut seen = vec![false; neighbors.len()];
    let mut stack = vec![0_u16];
    seen[0] = true;
    let mut reached = 0;
    while let Some(v) = stack.pop() {
        reached += 1;
        for &w in &neighbors[v as usize] {
            if !std::mem::replace(&mut seen[w as usize], true) {
                stack.push(w);
            }
        }
    }
    reached
}
