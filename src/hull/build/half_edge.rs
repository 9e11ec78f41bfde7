//! A closed triangulated surface as half-edges: what building needs of a mesh, in linear time.

use crate::hull::HullError;

/// A side of a triangle, from one vertex to the next: number `3 t + k` is side `k` of triangle `t`.
pub(in crate::hull) type HalfEdge = u32;

/// A half-edge with its ends.
#[derive(Clone, Copy, Default)]
pub(in crate::hull) struct DirectedEdge {
    pub from: u16,
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
        let all = directed_edges(triangles);
        let (by_end, _) = sort(&all, count, |side| side.to);
        let (sides, first) = sort(&by_end, count, |side| side.from);
        if let Some(loose) = first.windows(2).position(|pair| pair[0] == pair[1]) {
            return Err(HullError::LooseVertex(loose));
        }
        // Reversed, they come in the same order, if each side has one reverse.
        let (by_start, _) = sort(&all, count, |side| side.from);
        let (reversed, _) = sort(&by_start, count, |side| side.to);
        let mut twin = vec![0; all.len()];
        let mut before = None;
        for (side, reverse) in sides.iter().zip(&reversed) {
            let ends = (side.from, side.to);
            if ends != (reverse.to, reverse.from) || before == Some(ends) {
                return Err(HullError::NotManifold);
            }
            before = Some(ends);
            twin[side.half_edge as usize] = reverse.half_edge;
        }
        let mut mesh = Self {
            triangles,
            sides,
            first,
            position: vec![0; all.len()],
            twin,
        };
        if mesh.sort_around_vertices() && mesh.is_sphere() {
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

    /// Brings the sides around each vertex into their order, from that to the lowest vertex on.
    /// `false` if the triangles around a vertex are not one fan.
    fn sort_around_vertices(&mut self) -> bool {
        (0..self.vertex_count()).all(|v| {
            let [start, end] = [v, v + 1].map(|v| self.first[v] as usize);
            let first = self.sides[start].half_edge;
            let mut h = first;
            for place in start..end {
                if h == first && place > start {
                    return false;
                }
                self.sides[place] = DirectedEdge {
                    from: v as u16,
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

#[inline]
pub(in crate::hull) fn triangle(h: HalfEdge) -> usize {
    h as usize / 3
}

fn directed_edges(triangles: &[[u32; 3]]) -> Vec<DirectedEdge> {
    let sides =
        |(t, &[a, b, c]): (HalfEdge, &[u32; 3])| [(a, b), (b, c), (c, a)].into_iter().zip(3 * t..);
    let side = |((from, to), half_edge): ((u32, u32), HalfEdge)| DirectedEdge {
        from: from as u16,
        to: to as u16,
        half_edge,
    };
    (0..).zip(triangles).flat_map(sides).map(side).collect()
}

/// The sides by a vertex of theirs, otherwise in the order given (a counting sort), and where
/// those of each vertex begin.
fn sort(
    sides: &[DirectedEdge],
    count: usize,
    vertex: impl Fn(&DirectedEdge) -> u16,
) -> (Vec<DirectedEdge>, Vec<u32>) {
    let mut first = vec![0; count + 1];
    for side in sides {
        first[usize::from(vertex(side)) + 1] += 1;
    }
    for v in 0..count {
        first[v + 1] += first[v];
    }
    let mut fill = first.clone();
    let mut sorted = vec![DirectedEdge::default(); sides.len()];
    for side in sides {
        let place = &mut fill[usize::from(vertex(side))];
        sorted[*place as usize] = *side;
        *place += 1;
    }
    (sorted, first)
}
