//! The surface of a small hull as an adjacency matrix: for each two vertices, the triangle left of the edge from one
//! to the other. Nothing is sorted or searched for, and the neighbours of a vertex are the bits of a word.

use std::mem;

use crate::hull::graph::FaceCorner;
use crate::hull::lists::Rows;
use crate::hull::scan;

/// The largest number of vertices that a matrix has room for.
pub(super) const VERTICES: usize = scan::LARGEST;

/// Room for the triangles, of which there are four fewer.
pub(super) const TRIANGLES: usize = 2 * VERTICES;

/// A triangulated surface, and memory for the next one.
pub(super) struct AdjacencyMatrix {
    /// Each from its lowest corner, in the order of their corners.
    pub triangles: Vec<[u32; 3]>,
    /// The face of each triangle: itself, or a polygon.
    face_of: [u8; TRIANGLES],
    /// The corners of all faces, after an entry that belongs to no face.
    corners: Vec<FaceCorner>,
    /// The neighbours of each vertex: a bit for each.
    neighbors: [u64; VERTICES],
    /// The edges from each vertex to its neighbours. Other entries may be left over from an earlier surface.
    edges: Box<[[MatrixEdge; VERTICES]; VERTICES]>,
}

/// A directed edge.
#[derive(Clone, Copy, Default)]
struct MatrixEdge {
    /// The triangle left of it, and the corner of this triangle opposite to it.
    triangle: u8,
    third: u8,
    /// The index of its start among the corners, or [`DIAGONAL`].
    start: u16,
}

/// The start of an edge across a face.
const DIAGONAL: u16 = 0;

/// No polygon, or no face.
const NONE: u8 = u8::MAX;

const NO_FACE: FaceCorner = FaceCorner { vertex: 0, slot: 0 };

/// An edge on the way around the vertex that it leaves.
#[derive(Clone, Copy)]
pub(super) struct Spoke {
    /// The next neighbour clockwise.
    pub next: u32,
    /// The triangle to its left, and the one to its right, which is between the two neighbours.
    left: u8,
    right: u8,
    /// The indices of its start and its end among the corners.
    starts: [u16; 2],
}

impl Spoke {
    /// The triangles on its sides.
    #[inline]
    pub fn sides(&self) -> [usize; 2] {
        [index(self.left), index(self.right)]
    }
}

impl Default for AdjacencyMatrix {
    fn default() -> Self {
        Self {
            triangles: Vec::new(),
            face_of: [0; _],
            corners: Vec::new(),
            neighbors: [0; _],
            edges: Box::new([[MatrixEdge::default(); _]; _]),
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
        (self.triangles.len() == triangles.len()).then_some(())
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
        // No index is too large, and no two edges are the same.
        let are_good = bits >> VERTICES.ilog2() == 0
            && unused.iter().all(|&row| row == 0)
            && Ok(edges) == u32::try_from(3 * triangles.len());
        are_good.then_some(())
    }

    fn number_triangles(&mut self, count: usize) {
        self.triangles.clear();
        self.corners.clear();
        self.corners.push(NO_FACE);
        for a in (0..).take(count) {
            let mut higher = self.neighbors[row(a)] & !0 << a;
            while higher != 0 {
                let b = higher.trailing_zeros();
                higher &= higher - 1;
                let c = u32::from(self.edges[row(a)][row(b)].third);
                if c > a {
                    self.number([a, b, c]);
                }
            }
        }
    }

    /// Adds the next triangle, as a face of its own.
    #[inline]
    fn number(&mut self, corners: [u32; 3]) {
        let [a, b, c] = corners;
        let triangle = self.triangles.len() as u8;
        for (from, to) in [(a, b), (b, c), (c, a)] {
            self.edges[row(from)][row(to)].triangle = triangle;
            self.add_corner(from, to);
        }
        self.face_of[index(triangle)] = triangle;
        self.triangles.push(corners);
    }

    /// Adds the corner of a face from which an edge starts.
    #[inline]
    fn add_corner(&mut self, from: u32, to: u32) {
        // There are fewer corners than a u16 can count.
        let start = u16::try_from(self.corners.len()).unwrap_or(DIAGONAL);
        self.edges[row(from)][row(to)].start = start;
        self.corners.push(FaceCorner::new(from, 0));
    }

    /// Merges the triangle strips of polygons into these. Calls `add` for each face, with a triangle of it and
    /// the number of its polygon.
    pub fn merge(&mut self, polygons: &Rows<u32>, mut add: impl FnMut(usize, Option<usize>)) {
        let mut polygon_of = [NONE; TRIANGLES];
        self.mark_polygons(polygons, &mut polygon_of);
        let mut faces = [NONE; TRIANGLES];
        self.corners.truncate(1);
        let mut count = 0;
        let triangles = mem::take(&mut self.triangles);
        for (triangle, (&corners, &polygon)) in triangles.iter().zip(&polygon_of).enumerate() {
            let polygon = (polygon != NONE).then_some(index(polygon));
            if let Some(polygon) = polygon
                && faces[polygon] != NONE
            {
                self.face_of[triangle] = faces[polygon];
                continue;
            }
            self.face_of[triangle] = count;
            add(triangle, polygon);
            if let Some(polygon) = polygon {
                faces[polygon] = count;
                self.add_corners(polygons.row(polygon));
            } else {
                self.add_corners(&corners);
            }
            count += 1;
        }
        self.triangles = triangles;
    }

    /// Finds the polygon of each triangle. All edges of these become diagonals.
    fn mark_polygons(&mut self, polygons: &Rows<u32>, polygon_of: &mut [u8; TRIANGLES]) {
        // Each has a triangle of its own, so these are fewer than a u8 can count.
        for (number, polygon) in (0..NONE).zip(polygons.rows()) {
            for (from, to) in sides(polygon) {
                let edge = self.edges[row(from)][row(to)];
                polygon_of[index(edge.triangle)] = number;
            }
        }
        for (triangle, &polygon) in self.triangles.iter().zip(&*polygon_of) {
            if polygon != NONE {
                for (from, to) in sides(triangle) {
                    self.edges[row(from)][row(to)].start = DIAGONAL;
                }
            }
        }
    }

    fn add_corners(&mut self, polygon: &[u32]) {
        for (from, to) in sides(polygon) {
            self.add_corner(from, to);
        }
    }

    /// The lowest neighbour of a vertex, and how many there are.
    #[inline]
    pub fn neighbors(&self, vertex: u32) -> (u32, u32) {
        let neighbors = self.neighbors[row(vertex)];
        (neighbors.trailing_zeros(), neighbors.count_ones())
    }

    /// Whether there is an edge from one vertex to another.
    #[inline]
    pub fn has(&self, from: u32, to: u32) -> bool {
        self.neighbors[row(from)] >> row(to) & 1 == 1
    }

    /// An edge, if its triangles are there.
    #[inline]
    pub fn spoke(&self, vertex: u32, to: u32) -> Spoke {
        let there = self.edges[row(vertex)][row(to)];
        let back = self.edges[row(to)][row(vertex)];
        Spoke {
            next: back.third.into(),
            left: there.triangle,
            right: back.triangle,
            starts: [there.start, back.start],
        }
    }

    /// The face of a triangle.
    #[inline]
    pub fn face_of(&self, triangle: usize) -> u8 {
        self.face_of[triangle % TRIANGLES]
    }

    /// Stores the slot of an edge: its place among the neighbours of its lower vertex.
    #[inline]
    pub fn set_slot(&mut self, spoke: &Spoke, slot: u16) {
        for start in spoke.starts {
            self.corners[usize::from(start)].slot = slot;
        }
    }

    /// The corners of all faces, in the order of the faces.
    pub fn corners(&self) -> &[FaceCorner] {
        &self.corners[1..]
    }
}

/// The index of a vertex. The compiler knows it to be below [`VERTICES`].
#[inline]
pub(super) fn row(vertex: u32) -> usize {
    vertex as usize % VERTICES
}

/// The index of a triangle. The compiler knows it to be below [`TRIANGLES`].
#[inline]
fn index(triangle: u8) -> usize {
    usize::from(triangle) % TRIANGLES
}

/// The sides of a polygon.
fn sides(polygon: &[u32]) -> impl Iterator<Item = (u32, u32)> {
    let ends = polygon.iter().skip(1).chain(polygon.first());
    polygon.iter().copied().zip(ends.copied())
}
