//! A closed triangulated surface as half-edges: what building needs of a mesh, in linear time.

use crate::hull::HullError;

/// A side of a triangle, from one vertex to the next: number `3 t + k` is side `k` of triangle `t`.
pub(in crate::hull) type HalfEdge = u32;

/// A half-edge with its end.
#[derive(Clone, Copy, Default)]
pub(in crate::hull) struct DirectedEdge {
    pub to: u16,
    pub half_edge: HalfEdge,
}

/// Triangles, counter-clockwise seen from outside, that form one sphere.
pub(in crate::hull) struct HalfEdgeMesh<'a> {
    pub triangles: &'a [[u32; 3]],
    /// Those that leave vertex `v` are `first[v]..first[v + 1]`, clockwise seen from outside.
    sides: Vec<DirectedEdge>,
    first: Vec<u32>,
    /// Where each half-edge stands in `sides`.
    position: Vec<u32>,
    /// The same side as the neighbouring triangle has it.
    twin: Vec<HalfEdge>,
}

impl<'a> HalfEdgeMesh<'a> {
    /// From triangles over `count` vertices, of which there are no more than 16 bits can name.
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

    /// The sides that leave a vertex, clockwise: right of each of them is the triangle left of the
    /// next one.
    #[inline]
    pub fn outgoing(&self, vertex: u32) -> &[DirectedEdge] {
        let v = vertex as usize;
        &self.sides[self.first[v] as usize..self.first[v + 1] as usize]
    }

    /// The slot of an edge among those that leave its lower vertex.
    pub fn edge_slot(&self, h: HalfEdge) -> u16 {
        let twin = self.twin(h);
        let outgoing = if self.start(h) < self.start(twin) {
            h
        } else {
            twin
        };
        (self.position[outgoing as usize] - self.first[self.start(outgoing) as usize]) as u16
    }

    /// Finds the twin of each side. `false` if one has none, or several.
    fn pair_twins(&mut self) -> bool {
        const NOWHERE: u32 = u32::MAX;
        // Of the vertex at hand, the side that leaves it to each neighbour; and whose it is.
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

    /// Brings the sides around each vertex into their order, from that to the lowest vertex on.
    /// `false` if the triangles around a vertex are not one fan.
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

    /// Euler's number is that of a sphere, and all of it hangs together.
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

/// The side before it in the same triangle.
#[inline]
fn previous(h: HalfEdge) -> HalfEdge {
    if h.is_multiple_of(3) { h + 2 } else { h - 1 }
}

#[inline]
pub(in crate::hull) fn triangle(h: HalfEdge) -> usize {
    h as usize / 3
}

/// The sides of all triangles by the vertex that they leave (a counting sort), and where those of
/// each vertex begin.
fn sides_by_start(triangles: &[[u32; 3]], count: usize) -> (Vec<DirectedEdge>, Vec<u32>) {
    let starts = triangles.as_flattened();
    // One place further on, so that filling moves each to where its own begin.
    let mut first = vec![0; count + 2];
    for &from in starts {
        first[from as usize + 2] += 1;
    }
    for v in 2..first.len() {
        first[v] += first[v - 1];
    }
    let mut sides = vec![DirectedEdge::default(); starts.len()];
    for (half_edge, &from) in (0..).zip(starts) {
        let place = &mut first[from as usize + 1];
        sides[*place as usize] = DirectedEdge {
            to: starts[next(half_edge) as usize] as u16,
            half_edge,
        };
        *place += 1;
    }
    first.pop();
    (sides, first)
}
