//! The surface of a small hull as an adjacency matrix: for each two vertices, the triangle left of the edge from one
//! to the other. Nothing is sorted or searched for, and the neighbours of a vertex are the bits of a word.

use crate::hull::graph::FaceCorner;
use crate::hull::lists::Rows;
use crate::hull::scan;

/// The largest number of vertices that a matrix has room for.
pub(super) const VERTICES: usize = scan::LARGEST;

/// Room for the triangles, of which there are four fewer.
pub(super) const TRIANGLES: usize = 2 * VERTICES;

/// A triangulated surface, and memory for the next one.
pub(super) struct AdjacencyMatrix {
    triangles: Box<[[u32; 3]; TRIANGLES]>,
    count: usize,
    /// The neighbours of each vertex: a bit for each.
    neighbors: [u64; VERTICES],
    /// The edges from each vertex to its neighbours. Other entries may be left over from an earlier surface.
    edges: Box<[[MatrixEdge; VERTICES]; VERTICES]>,
    merged: MergedTriangles,
}

/// A directed edge.
#[derive(Clone, Copy, Default)]
#[repr(align(4))]
struct MatrixEdge {
    /// The triangle left of it, and the corner of this triangle opposite to it.
    triangle: u8,
    third: u8,
    /// Its place among the neighbours of its start.
    slot: u8,
}

/// The faces of triangles that are merged into polygons.
struct MergedTriangles {
    /// The face of each triangle.
    face_of: [u8; TRIANGLES],
    /// The polygon of each triangle, or [`NONE`].
    polygon_of: [u8; TRIANGLES],
    /// The first triangle of each face.
    first_of: Vec<u8>,
}

/// No polygon, or no face.
const NONE: u8 = u8::MAX;

/// An edge on the way around the vertex that it leaves.
#[derive(Clone, Copy)]
pub(super) struct Spoke {
    /// The next neighbour clockwise.
    pub next: u8,
    /// The triangle between the two neighbours, which is right of the edge.
    pub right: u8,
}

impl Default for AdjacencyMatrix {
    fn default() -> Self {
        Self {
            triangles: Box::new([[0; 3]; _]),
            count: 0,
            neighbors: [0; _],
            edges: Box::new([[MatrixEdge::default(); _]; _]),
            merged: MergedTriangles {
                face_of: [0; _],
                polygon_of: [NONE; _],
                first_of: Vec::with_capacity(TRIANGLES),
            },
        }
    }
}

impl AdjacencyMatrix {
    /// Reads a surface of `count` vertices, whose triangles are in any order. `None` if these are too many, or if
    /// two triangles are on the same side of an edge. That each edge has two triangles is left to
    /// [`has`](Self::has).
    pub fn read(&mut self, count: usize, triangles: &[[u32; 3]]) -> Option<()> {
        if count > VERTICES || triangles.len() + 4 != 2 * count {
            return None;
        }
        self.add(count, triangles)?;
        self.number_triangles(count);
        (self.count == triangles.len()).then_some(())
    }

    /// Adds the edges of all triangles.
    fn add(&mut self, count: usize, triangles: &[[u32; 3]]) -> Option<()> {
        self.neighbors = [0; _];
        let mut add = |from: u32, to: u32, third: u32| {
            self.neighbors[row(from)] |= 1 << row(to);
            self.edges[row(from)][row(to)].third = third as u8;
        };
        let mut bits = 0;
        for &[a, b, c] in triangles {
            bits |= a | b | c;
            add(a, b, c);
            add(b, c, a);
            add(c, a, b);
        }
        let (used, unused) = self.neighbors.split_at(count);
        let edges: u32 = used.iter().map(|row| row.count_ones()).sum();
        // No index is too large, no vertex is without edges, and no two edges are the same.
        let are_good = bits >> VERTICES.ilog2() == 0
            && used.iter().all(|&row| row != 0)
            && unused.iter().all(|&row| row == 0)
            && Ok(edges) == u32::try_from(3 * triangles.len());
        are_good.then_some(())
    }

    /// Lists the triangles, each from its lowest corner, in the order of their corners.
    fn number_triangles(&mut self, count: usize) {
        let mut number = 0;
        for a in (0..).take(count) {
            let mut higher = self.neighbors[row(a)] & !0 << a;
            while higher != 0 {
                let b = higher.trailing_zeros();
                higher &= higher - 1;
                let c = u32::from(self.edges[row(a)][row(b)].third);
                // Whether this is the lowest corner is not predictable: otherwise the next triangle takes its place.
                self.triangles[number % TRIANGLES] = [a, b, c];
                number += usize::from(c > a);
            }
        }
        self.count = number;
        for (number, &[a, b, c]) in (0..).zip(&self.triangles[..number]) {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                self.edges[row(from)][row(to)].triangle = number;
            }
        }
    }

    /// The triangles, each from its lowest corner, in the order of their corners.
    #[inline]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles[..self.count]
    }

    /// Merges the triangle strips of polygons into these. Calls `add` for each face, with a triangle of it and
    /// the number of its polygon.
    pub fn merge(&mut self, polygons: &Rows<u32>, mut add: impl FnMut(usize, Option<usize>)) {
        self.merged.polygon_of = [NONE; _];
        // Each has a triangle of its own, so these are fewer than a u8 can count.
        for (number, polygon) in (0..NONE).zip(polygons.rows()) {
            for (from, to) in sides(polygon) {
                let edge = self.edges[row(from)][row(to)];
                self.merged.polygon_of[index(edge.triangle)] = number;
            }
        }
        let mut faces = [NONE; TRIANGLES];
        self.merged.first_of.clear();
        for triangle in (0..).take(self.count) {
            let polygon = self.merged.polygon_of(triangle);
            if let Some(polygon) = polygon
                && faces[polygon] != NONE
            {
                self.merged.face_of[index(triangle)] = faces[polygon];
                continue;
            }
            let face = self.merged.first_of.len() as u8;
            self.merged.face_of[index(triangle)] = face;
            add(index(triangle), polygon);
            if let Some(polygon) = polygon {
                faces[polygon] = face;
            }
            self.merged.first_of.push(triangle);
        }
    }

    /// The lowest neighbour of a vertex.
    #[inline]
    pub fn lowest_neighbor(&self, vertex: u8) -> u8 {
        self.neighbors[row(vertex.into())].trailing_zeros() as u8
    }

    /// Whether there is an edge from one vertex to another.
    #[inline]
    pub fn has(&self, from: u8, to: u8) -> bool {
        self.neighbors[row(from.into())] >> row(to.into()) & 1 == 1
    }

    /// The triangle left of an edge, if it is there.
    #[inline]
    pub fn left(&self, from: u8, to: u8) -> u8 {
        self.edges[row(from.into())][row(to.into())].triangle
    }

    /// An edge, if its triangles are there, which has this slot among the neighbours of `vertex`.
    #[inline]
    pub fn spoke(&mut self, vertex: u8, to: u8, slot: u8) -> Spoke {
        let [vertex, to] = [vertex, to].map(|v| row(v.into()));
        self.edges[vertex][to].slot = slot;
        let back = self.edges[to][vertex];
        Spoke {
            next: back.third,
            right: back.triangle,
        }
    }

    /// The face of a triangle: itself, unless [`merge`](Self::merge) found another one.
    #[inline]
    pub fn face_of(&self, triangle: u8, are_merged: bool) -> u8 {
        if are_merged {
            self.merged.face_of[index(triangle)]
        } else {
            triangle
        }
    }

    /// The corners of all faces, some of which are these polygons, if all slots are known.
    pub fn corners(&self, polygons: &Rows<u32>) -> Box<[FaceCorner]> {
        if polygons.len() > 0 {
            return self.merged_corners(polygons);
        }
        let corners = self.triangles().iter().map(|&[a, b, c]| {
            let (from_a, from_c) = (self.slot(a, b), self.slot(a, c));
            [
                FaceCorner::new(a, from_a),
                self.corner(b, c),
                FaceCorner::new(c, from_c),
            ]
        });
        let corners: Vec<_> = corners.collect();
        corners.into_flattened().into()
    }

    fn merged_corners(&self, polygons: &Rows<u32>) -> Box<[FaceCorner]> {
        let mut corners = Vec::with_capacity(3 * self.count);
        for &triangle in &self.merged.first_of {
            let face = match self.merged.polygon_of(triangle) {
                Some(polygon) => polygons.row(polygon),
                None => &self.triangles[index(triangle)],
            };
            corners.extend(sides(face).map(|(from, to)| self.corner(from, to)));
        }
        corners.into()
    }

    /// The corner of a face from which an edge starts.
    #[inline]
    fn corner(&self, from: u32, to: u32) -> FaceCorner {
        FaceCorner::new(from, self.slot(from.min(to), from.max(to)))
    }

    /// The slot of an edge at its lower vertex.
    #[inline]
    fn slot(&self, low: u32, high: u32) -> u16 {
        self.edges[row(low)][row(high)].slot.into()
    }
}

impl MergedTriangles {
    #[inline]
    fn polygon_of(&self, triangle: u8) -> Option<usize> {
        let polygon = self.polygon_of[index(triangle)];
        (polygon != NONE).then_some(index(polygon))
    }
}

/// The index of a vertex. The compiler knows it to be below [`VERTICES`].
#[inline]
pub(super) fn row(vertex: u32) -> usize {
    vertex as usize % VERTICES
}

/// The index of a triangle. The compiler knows it to be below [`TRIANGLES`].
#[inline]
pub(super) fn index(triangle: u8) -> usize {
    usize::from(triangle) % TRIANGLES
}

/// The sides of a polygon.
fn sides(polygon: &[u32]) -> impl Iterator<Item = (u32, u32)> {
    let next = |i: usize| polygon[if i + 1 < polygon.len() { i + 1 } else { 0 }];
    polygon
        .iter()
        .enumerate()
        .map(move |(i, &from)| (from, next(i)))
}
