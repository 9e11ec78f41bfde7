//! A closed triangulated surface as half-edges, built in linear time.

use std::mem;

use crate::at::{At, to_u16};
use crate::hull::HullError;
use crate::hull::graph::FaceCorner;

/// A side of a triangle, from one vertex to the next: number `3 t + k` is side `k` of triangle `t`.
pub(in crate::hull) type HalfEdge = u32;

/// A side of a triangle, seen from the vertex that it leaves.
#[derive(Clone, Copy, Default)]
pub(in crate::hull) struct DirectedEdge {
    pub to: u16,
    /// The vertex of the triangle opposite to the side. The triangle is left of the side.
    pub third: u16,
    pub triangle: u16,
    side: u16,
}

impl DirectedEdge {
    #[inline]
    pub fn half_edge(self) -> HalfEdge {
        3 * HalfEdge::from(self.triangle) + HalfEdge::from(self.side)
    }

    /// The previous side of the same triangle.
    #[inline]
    fn previous(self) -> HalfEdge {
        let h = self.half_edge();
        if self.side == 0 { h + 2 } else { h - 1 }
    }
}

/// Triangles, counter-clockwise seen from outside. Around each vertex they form a single fan.
pub(in crate::hull) struct HalfEdgeMesh<'a> {
    pub triangles: &'a [[u32; 3]],
    /// The sides that leave vertex `v` are at `first[v]..first[v + 1]`, clockwise seen from outside, starting
    /// with the side to the lowest neighbour.
    sides: Vec<DirectedEdge>,
    first: Vec<u32>,
    /// For each half-edge, its place among the sides that leave its lower vertex.
    slots: Vec<u16>,
    /// The half-edge of the neighbouring triangle on the same edge.
    twin: Vec<HalfEdge>,
}

impl<'a> HalfEdgeMesh<'a> {
    /// From triangles over `count` vertices, whose indices must fit into 16 bits.
    pub fn new(count: usize, triangles: &'a [[u32; 3]]) -> Result<Self, HullError> {
        let mut first = first_sides(triangles, count);
        if let Some(loose) = first.windows(2).position(|pair| pair[0] == pair[1]) {
            return Err(HullError::LooseVertex(loose));
        }
        // As many triangles as a closed surface without holes has (Euler's formula).
        if triangles.len() + 4 != 2 * count {
            return Err(HullError::NotManifold);
        }
        let unsorted = sides_by_start(triangles, &mut first);
        let mut mesh = Self {
            triangles,
            sides: vec![DirectedEdge::default(); unsorted.len()],
            first,
            slots: vec![0; unsorted.len()],
            twin: vec![0; unsorted.len()],
        };
        match mesh.sort_around_vertices(&unsorted) {
            true => Ok(mesh),
            false => Err(HullError::NotManifold),
        }
    }

    pub fn vertex_count(&self) -> usize {
        self.first.len() - 1
    }

    #[inline]
    pub fn start(&self, h: HalfEdge) -> u32 {
        self.triangles.as_flattened().at(h)
    }

    #[inline]
    pub fn end(&self, h: HalfEdge) -> u32 {
        self.start(next(h))
    }

    #[inline]
    pub fn twin(&self, h: HalfEdge) -> HalfEdge {
        self.twin.at(h)
    }

    /// The sides that leave a vertex, clockwise: the triangle right of each is the one left of the next.
    #[inline]
    pub fn outgoing(&self, vertex: u32) -> &[DirectedEdge] {
        let v = vertex as usize;
        &self.sides[self.first[v] as usize..self.first[v + 1] as usize]
    }

    /// The sides of a triangle.
    #[inline]
    pub fn sides_of(&self, triangle: usize) -> [HalfEdge; 3] {
        let h = 3 * triangle as HalfEdge;
        [h, h + 1, h + 2]
    }

    /// The corners of all triangles.
    pub fn corners(&self) -> impl Iterator<Item = [FaceCorner; 3]> {
        let (slots, _) = self.slots.as_chunks();
        let triangles = self.triangles.iter().zip(slots);
        triangles.map(|(&[a, b, c], &[at_a, at_b, at_c])| {
            [(a, at_a), (b, at_b), (c, at_c)].map(|(vertex, slot)| FaceCorner::new(vertex, slot))
        })
    }

    /// The corner of a polygon from which a side starts.
    #[inline]
    pub fn corner(&self, side: HalfEdge) -> FaceCorner {
        FaceCorner::new(self.start(side), self.slots.at(side))
    }

    /// Sorts the sides around each vertex, and so finds their twins. `false` if the triangles around a vertex
    /// are not a single fan.
    fn sort_around_vertices(&mut self, unsorted: &[DirectedEdge]) -> bool {
        // For each neighbour, the side whose triangle is right of the edge to it.
        let mut right = vec![0_u32; self.vertex_count()];
        let mut sides = self.sides.as_mut_slice();
        (0..).zip(self.first.windows(2)).all(|(v, ends)| {
            let (start, count) = (ends[0], (ends[1] - ends[0]) as usize);
            let mut lowest = (u16::MAX, start);
            for (place, side) in (start..).zip(&unsorted[start as usize..][..count]) {
                right[usize::from(side.third)] = place;
                if side.to < lowest.0 {
                    lowest = (side.to, place);
                }
            }
            let mut place = lowest.1;
            let mut side = unsorted.at(place);
            let (around, others) = mem::take(&mut sides).split_at_mut(count);
            sides = others;
            for (slot, sorted) in (0..).zip(around) {
                let next = right[usize::from(side.to)];
                let beside = unsorted.at(next);
                // Otherwise this was written for an earlier vertex, or never.
                let is_beside = next >= start && beside.third == side.to;
                if !is_beside || (slot > 0 && place == lowest.1) {
                    return false;
                }
                *sorted = side;
                if v < side.to {
                    let [here, there] = [side.half_edge(), beside.previous()];
                    for (h, twin) in [(here, there), (there, here)] {
                        (*self.slots.at_mut(h), *self.twin.at_mut(h)) = (slot, twin);
                    }
                }
                (place, side) = (next, beside);
            }
            place == lowest.1
        })
    }

    /// Whether the surface is connected.
    pub fn is_connected(&self) -> bool {
        let count = self.vertex_count();
        let mut seen = vec![false; count];
        let mut stack = vec![0];
        seen[0] = true;
        let mut reached = 0;
        while let Some(v) = stack.pop() {
            reached += 1;
            for side in self.outgoing(v) {
                if !mem::replace(&mut seen[usize::from(side.to)], true) {
                    stack.push(side.to.into());
                }
            }
        }
        reached == count
    }
}

/// The next side of the same triangle.
#[inline]
pub(in crate::hull) fn next(h: HalfEdge) -> HalfEdge {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

#[inline]
pub(in crate::hull) fn triangle(h: HalfEdge) -> usize {
    h as usize / 3
}

/// Where the sides that leave each vertex begin, and where the last ones end.
fn first_sides(triangles: &[[u32; 3]], count: usize) -> Vec<u32> {
    let mut first = vec![0; count + 1];
    for &from in triangles.as_flattened() {
        *first[1..].at_mut(from) += 1;
    }
    let mut end = 0;
    for place in &mut first {
        end += *place;
        *place = end;
    }
    first
}

/// The sides of all triangles, sorted by the vertex that they leave (a counting sort).
fn sides_by_start(triangles: &[[u32; 3]], first: &mut [u32]) -> Vec<DirectedEdge> {
    let mut sides = vec![DirectedEdge::default(); 3 * triangles.len()];
    // From the last to the first: each vertex's place moves from the end of its sides to their beginning.
    let ends = &mut first[1..];
    for (t, &[a, b, c]) in triangles.iter().enumerate().rev() {
        for (side, [from, to, third]) in [(2, [c, a, b]), (1, [b, c, a]), (0, [a, b, c])] {
            let place = ends.at_mut(from);
            *place -= 1;
            *sides.at_mut(*place) = DirectedEdge {
                to: to as u16,
                third: third as u16,
                triangle: to_u16(t),
                side,
            };
        }
    }
    // Now each entry is where the sides of the vertex before it begin.
    first.rotate_left(1);
    if let Some(end) = first.last_mut() {
        *end = sides.short_len();
    }
    sides
}
