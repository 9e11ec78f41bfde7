//! A closed triangulated surface as half-edges, built in linear time.

use crate::hull::HullError;

/// A side of a triangle, from one vertex to the next: number `3 t + k` is side `k` of triangle `t`.
pub(in crate::hull) type HalfEdge = u32;

/// A half-edge with its end vertex.
#[derive(Clone, Copy, Default)]
pub(in crate::hull) struct DirectedEdge {
    pub to: u16,
    pub half_edge: HalfEdge,
}

/// Triangles, counter-clockwise seen from outside, that form a topological sphere.
pub(in crate::hull) struct HalfEdgeMesh<'a> {
    pub triangles: &'a [[u32; 3]],
    /// The sides that leave vertex `v` are at `first[v]..first[v + 1]`, clockwise seen from outside.
    sides: Vec<DirectedEdge>,
    first: Vec<u32>,
    /// The index of each half-edge in `sides`.
    position: Vec<u32>,
    /// The half-edge of the neighbouring triangle on the same edge.
    twin: Vec<HalfEdge>,
}

impl<'a> HalfEdgeMesh<'a> {
    /// From triangles over `count` vertices, whose indices must fit into 16 bits.
    pub fn new(count: usize, triangles: &'a [[u32; 3]]) -> Result<Self, HullError> {
        let (sides, first) = sides_by_start(triangles, count);
        if let Some(loose) = first.windows(2).position(|pair| pair[0] == pair[1]) {
            return Err(HullError::LooseVertex(loose));
        }
        let mut mesh = Self {
            triangles,
            position: vec![0; sides.len()],
            twin: vec![0; sides.len()],
            sides,
            first,
        };
        if mesh.pair_twins() && mesh.sort_around_vertices() && mesh.is_sphere() {
            Ok(mesh)
        } else {
            Err(HullError::NotManifold)
        }
    }

    pub fn vertex_count(&self) -> usize {
        self.first.len() - 1
    }

    #[inline]
    pub fn start(&self, h: HalfEdge) -> u32 {
        self.triangles.as_flattened()[h as usize]
    }

    #[inline]
    pub fn end(&self, h: HalfEdge) -> u32 {
        self.start(next(h))
    }

    #[inline]
    pub fn twin(&self, h: HalfEdge) -> HalfEdge {
        self.twin[h as usize]
    }

    /// The sides that leave a vertex, clockwise: the triangle right of each is the one left of the next.
    #[inline]
    pub fn outgoing(&self, vertex: u32) -> &[DirectedEdge] {
        let v = vertex as usize;
        &self.sides[self.first[v] as usize..self.first[v + 1] as usize]
    }

    /// The slot of an edge among the sides that leave its lower vertex.
    pub fn edge_slot(&self, h: HalfEdge) -> u16 {
        let twin = self.twin(h);
        let outgoing = if self.start(h) < self.start(twin) {
            h
        } else {
            twin
        };
        (self.position[outgoing as usize] - self.first[self.start(outgoing) as usize]) as u16
    }

    /// Finds the twin of each side. `false` if a side has no twin, or several.
    fn pair_twins(&mut self) -> bool {
        const NOWHERE: u32 = u32::MAX;
        // For each neighbour, the vertex that last had a side to it, and that side.
        let mut side_to = vec![(NOWHERE, 0); self.vertex_count()];
        (0..self.vertex_count() as u32).all(|v| {
            let outgoing = self.first[v as usize] as usize..self.first[v as usize + 1] as usize;
            let is_single = self.sides[outgoing.clone()].iter().all(|side| {
                let place = &mut side_to[usize::from(side.to)];
                std::mem::replace(place, (v, side.half_edge)).0 != v
            });
            // The side before an outgoing one in its triangle is an incoming one.
            is_single
                && outgoing.into_iter().all(|place| {
                    let incoming = previous(self.sides[place].half_edge);
                    let (owner, twin) = side_to[self.start(incoming) as usize];
                    self.twin[incoming as usize] = twin;
                    owner == v
                })
        })
    }

    /// Sorts the sides around each vertex, starting with the side to the lowest neighbour. `false` if the
    /// triangles around a vertex are not a single fan.
    fn sort_around_vertices(&mut self) -> bool {
        (0..self.vertex_count()).all(|v| {
            let [start, end] = [v, v + 1].map(|v| self.first[v] as usize);
            let lowest = self.sides[start..end].iter().min_by_key(|side| side.to);
            let first = lowest.map_or(0, |side| side.half_edge);
            let mut h = first;
            for place in start..end {
                if h == first && place > start {
                    return false;
                }
                self.sides[place] = DirectedEdge {
                    to: self.end(h) as u16,
                    half_edge: h,
                };
                self.position[h as usize] = place as u32;
                h = next(self.twin(h));
            }
            h == first
        })
    }

    /// Whether the surface is connected and has the Euler characteristic of a sphere.
    fn is_sphere(&self) -> bool {
        let count = self.vertex_count();
        if self.triangles.len() + 4 != 2 * count {
            return false;
        }
        let mut seen = vec![false; count];
        let mut stack = vec![0];
        seen[0] = true;
        let mut reached = 0;
        while let Some(v) = stack.pop() {
            reached += 1;
            for side in self.outgoing(v) {
                if !std::mem::replace(&mut seen[side.to as usize], true) {
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

/// The previous side of the same triangle.
#[inline]
fn previous(h: HalfEdge) -> HalfEdge {
    if h.is_multiple_of(3) { h + 2 } else { h - 1 }
}

#[inline]
pub(in crate::hull) fn triangle(h: HalfEdge) -> usize {
    h as usize / 3
}

/// The sides of all triangles, sorted by the vertex that they leave (a counting sort), and the first side of
/// each vertex.
fn sides_by_start(triangles: &[[u32; 3]], count: usize) -> (Vec<DirectedEdge>, Vec<u32>) {
    let starts = triangles.as_flattened();
    // The offsets are one entry too far. Filling moves each to its final value.
    let mut first = vec![0; count + 2];
    for &from in starts {
        first[from as usize + 2] += 1;
    }
    for v in 2..first.len() {
        first[v] += first[v - 1];
    }
    let mut sides = vec![DirectedEdge::default(); starts.len()];
    for (t, &[a, b, c]) in (0..).zip(triangles) {
        for (half_edge, from, to) in [(3 * t, a, b), (3 * t + 1, b, c), (3 * t + 2, c, a)] {
            let place = &mut first[from as usize + 1];
            sides[*place as usize] = DirectedEdge {
                to: to as u16,
                half_edge,
            };
            *place += 1;
        }
    }
    first.pop();
    (sides, first)
}
