//! The expanding polytope: a closed triangulated surface with adjacency, and a queue of its faces ordered by
//! signed distance from the origin. How it expands is in `horizon`.

use glam::DVec3;

use super::face_queue::FaceQueue;
use crate::at::At;
use crate::support::CsoVertex;
use crate::tolerance::COPLANAR;

/// An edge as one of its faces sees it: four times the face, plus the number of the corner where the edge
/// starts.
pub(super) type FaceEdge = u32;

pub(super) fn face_edge(face: u32, number: u32) -> FaceEdge {
    4 * face + number
}

pub(super) fn face_of(edge: FaceEdge) -> u32 {
    edge / 4
}

/// The number of the edge within its face.
pub(super) fn number(edge: FaceEdge) -> usize {
    (edge % 4) as usize
}

/// Its triangles, counter-clockwise seen from outside if corner 3 is below (0, 1, 2).
const TETRAHEDRON: [[u8; 3]; 4] = [[0, 1, 2], [1, 0, 3], [2, 1, 3], [0, 2, 3]];

/// The number of the next corner.
pub(super) const NEXT: [usize; 3] = [1, 2, 0];

#[derive(Clone, Debug)]
pub(super) struct Face {
    pub corners: [u32; 3],
    /// The same edges as seen from the neighbouring faces.
    pub across: [FaceEdge; 3],
    pub normal: DVec3,
    pub distance: f64,
    /// Whether it is still part of the surface.
    pub alive: bool,
}

impl Face {
    /// How far a point is above the plane.
    pub fn height(&self, w: DVec3) -> f64 {
        self.normal.dot(w) - self.distance
    }
}

/// See the module documentation. Vectors are cleared between queries, but never freed.
#[derive(Clone, Debug, Default)]
pub(super) struct ExpandingPolytope {
    pub vertices: Vec<CsoVertex>,
    pub faces: Vec<Face>,
    queue: FaceQueue,
    pub horizon: Vec<FaceEdge>,
    pub visible: Vec<u32>,
    pub stack: Vec<FaceEdge>,
    /// The edges of an added surface, in rows by their start vertex.
    edges: Vec<FaceEdge>,
    /// A point this near to a plane counts as on it.
    pub coplanar: f64,
    /// Faces whose planes are no nearer than this are not searched.
    search_radius: f64,
}

impl ExpandingPolytope {
    /// Removes everything. Tolerances are relative to `size`. Faces no nearer to the origin than
    /// `search_radius` are not searched.
    pub fn clear(&mut self, size: f64, search_radius: f64) {
        self.vertices.clear();
        self.faces.clear();
        self.queue.clear();
        self.coplanar = COPLANAR * size;
        self.search_radius = search_radius;
    }

    pub fn push(&mut self, vertex: CsoVertex) {
        self.vertices.push(vertex);
    }

    /// Adds the triangles of a closed surface over the vertices pushed so far. Returns `false` if an edge occurs
    /// twice in the same direction, or has no triangle on its other side.
    pub fn add_surface(&mut self, triangles: &[[u8; 3]]) -> bool {
        const NONE: FaceEdge = FaceEdge::MAX;
        let count = self.vertices.len();
        let index = |from: u8, to: u8| usize::from(from) * count + usize::from(to);
        self.edges.clear();
        self.edges.resize(count * count, NONE);
        for (triangle, face) in triangles.iter().zip(0..) {
            for (k, number) in (0..3).zip(0..) {
                let edge = &mut self.edges[index(triangle[k], triangle[NEXT[k]])];
                if *edge != NONE {
                    return false;
                }
                *edge = face_edge(face, number);
            }
        }
        triangles.iter().all(|triangle| {
            let across = [0, 1, 2].map(|k| self.edges[index(triangle[NEXT[k]], triangle[k])]);
            self.add(triangle.map(u32::from), across);
            !across.contains(&NONE)
        })
    }

    /// Like [`clear`](Self::clear), but starts with a tetrahedron that has volume.
    pub fn start(&mut self, corners: [CsoVertex; 4], size: f64, search_radius: f64) {
        self.clear(size, search_radius);
        let [a, b, c, d] = corners.map(|v| v.w);
        let outward = (b - a).cross(c - a).dot(d - a) < 0.0;
        self.vertices.extend(if outward {
            corners
        } else {
            [corners[0], corners[2], corners[1], corners[3]]
        });
        let is_closed = self.add_surface(&TETRAHEDRON);
        debug_assert!(is_closed, "each of its edges is there once each way");
    }

    /// The face whose plane is nearest to the origin, among those still on the surface.
    pub fn nearest_face(&mut self) -> Option<u32> {
        while let Some(face) = self.queue.nearest() {
            if self.faces.at_ref(face).alive {
                return Some(face);
            }
            self.queue.pop();
        }
        None
    }

    /// The outward unit normal of a face, and the signed distance of the origin beneath its plane.
    pub fn plane(&self, face: u32) -> (DVec3, f64) {
        let face = self.faces.at_ref(face);
        (face.normal, face.distance)
    }

    /// The corners of all faces.
    pub fn surface(&self) -> impl Iterator<Item = &[u32; 3]> + Clone {
        self.faces
            .iter()
            .filter(|face| face.alive)
            .map(|face| &face.corners)
    }

    pub fn vertex(&self, vertex: u32) -> &CsoVertex {
        self.vertices.at_ref(vertex)
    }

    pub fn corners(&self, face: u32) -> [CsoVertex; 3] {
        self.faces.at_ref(face).corners.map(|v| *self.vertex(v))
    }

    /// Whether the polytope already has this vertex.
    pub fn contains(&self, vertex: &CsoVertex) -> bool {
        self.vertices.iter().any(|v| v.w == vertex.w)
    }

    /// Removes a face from the search, but not from the surface.
    pub fn remove_from_queue(&mut self, face: u32) {
        if self.queue.nearest() == Some(face) {
            self.queue.pop();
        }
    }

    /// From now on faces no nearer than `search_radius` are not searched.
    pub fn limit_search(&mut self, search_radius: f64) {
        self.search_radius = self.search_radius.min(search_radius);
    }

    /// Adds a face, to the queue as well if it is to be searched.
    pub fn add(&mut self, corners: [u32; 3], across: [FaceEdge; 3]) {
        let [a, b, c] = corners.map(|v| self.vertex(v).w);
        let area = (b - a).cross(c - a);
        let squared = area.length_squared();
        // A face without area has no plane. It stays in the surface, but is never searched.
        let (normal, distance) = if squared > 0.0 {
            let normal = area * squared.sqrt().recip();
            let heights = [a, b, c].map(|corner| normal.dot(corner));
            (
                normal,
                min_no_nan(heights[0], min_no_nan(heights[1], heights[2])),
            )
        } else {
            (DVec3::ZERO, f64::INFINITY)
        };
        let face = self.faces.short_len();
        self.faces.push(Face {
            corners,
            across,
            normal,
            distance,
            alive: true,
        });
        if distance < self.search_radius {
            self.queue.push(distance, face);
        }
    }
}

/// Memory for expansions, kept from query to query so that queries do not allocate.
#[derive(Clone, Debug, Default)]
pub struct EpaScratch {
    pub(super) polytope: ExpandingPolytope,
}

impl EpaScratch {
    /// The triangles of the last expansion: a closed surface inside the Minkowski difference,
    /// counter-clockwise seen from outside.
    pub(crate) fn surface(&self) -> impl Iterator<Item = [CsoVertex; 3]> + Clone {
        let polytope = &self.polytope;
        let corners = polytope.surface();
        corners.map(|corners| corners.map(|vertex| *polytope.vertex(vertex)))
    }
}

/// The lesser of two numbers. Neither may be NaN: this saves the check in `f64::min`.
pub(super) fn min_no_nan(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether these triangles over five points can be added.
    fn can_be_added(triangles: &[[u8; 3]]) -> bool {
        let mut polytope = ExpandingPolytope::default();
        polytope.clear(1.0, f64::INFINITY);
        for w in [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE] {
            polytope.push(CsoVertex {
                w,
                ..Default::default()
            });
        }
        polytope.add_surface(triangles)
    }

    #[test]
    fn only_surfaces_that_tell_their_neighbors_are_added() {
        let tetrahedron = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        assert!(can_be_added(&tetrahedron));
        assert!(!can_be_added(&tetrahedron[..3]), "an open surface");
        let doubled = [tetrahedron, tetrahedron].concat();
        assert!(!can_be_added(&doubled), "two layers");
        let other = [[0, 2, 1], [0, 1, 4], [1, 2, 4], [2, 0, 4]];
        let pinched = [&tetrahedron[1..], &other[1..], &[[0, 2, 1], [0, 2, 1]]].concat();
        assert!(!can_be_added(&pinched), "edges of four triangles");
    }
}
