//! The polytope of an expansion, kept to prove depths in later frames.
//!
//! Its vertices, re-evaluated at other poses, are again points of the Minkowski difference, and its triangles
//! form a closed surface, oriented outwards. If the origin is on the inner side of all their planes, at least
//! `d` away from each, the surface winds around the ball of radius `d` about the origin. So the ball is in
//! the convex hull of the vertices, and in the difference: no direction has a smaller depth than `d`. It does
//! not matter whether the surface is still convex, or from which pair it came.

use glam::DVec3;

use super::polytope::{EpaScratch, ExpandingPolytope, min_no_nan};
use crate::stats::Cost;
use crate::support::{Cso, CsoVertex, Polytope, Support, VertexId};
use crate::tolerance::{DEPTH_GAP, PROOF_MARGIN};
use crate::tuning::MIN_GROWABLE;

/// Hulls of a thousand vertices that overlap by a fifth of their size usually need nineteen.
const MOST_VERTICES: usize = 32;
/// A closed surface of triangles has no more faces than this.
const MOST_FACES: usize = 2 * MOST_VERTICES - 4;

/// A surface that must grow by more than this is no better a start than the features are.
const MAX_EXPANSIONS: usize = 12;

/// The key of the difference's centre.
const CENTER: [u16; 2] = [u16::MAX; 2];

/// A polytope inside a Minkowski difference, without coordinates.
#[derive(Clone, Debug)]
pub(super) struct CachedPolytope {
    /// For each vertex, the vertices of the two shapes whose difference it is.
    vertices: [[u16; 2]; MOST_VERTICES],
    /// Counter-clockwise seen from outside.
    faces: [[u8; 3]; MOST_FACES],
    vertex_count: u8,
    /// Zero if the cache is empty: then it proves nothing.
    face_count: u8,
}

impl Default for CachedPolytope {
    fn default() -> Self {
        Self {
            vertices: [[0; 2]; MOST_VERTICES],
            faces: [[0; 3]; MOST_FACES],
            vertex_count: 0,
            face_count: 0,
        }
    }
}

impl CachedPolytope {
    /// Whether this surface, or what it grows to in a few expansions, proves that
    /// [`penetration_below`](super::penetration_below) would find no smaller depth.
    pub fn proves_depth<A: Polytope, B: Polytope>(
        &mut self,
        cso: &Cso<'_, A, B>,
        known_depth: f64,
        scratch: &mut EpaScratch,
        cost: &mut Cost,
    ) -> bool {
        let radius = known_depth - PROOF_MARGIN * DEPTH_GAP * cso.min_radius();
        let polytope = &mut scratch.polytope;
        polytope.clear(cso.size(), radius);
        for &key in &self.vertices[..self.vertex_count.into()] {
            match vertex_at(key, cso) {
                Some(vertex) => polytope.push(vertex),
                None => return false,
            }
        }
        let distance = self.distance(polytope);
        distance >= radius
            || distance > MIN_GROWABLE * radius && self.grow(cso, radius, scratch, cost)
    }

    fn faces(&self) -> &[[u8; 3]] {
        &self.faces[..self.face_count.into()]
    }

    /// The distance of the origin from the nearest plane, if the origin is on the inner side of all planes;
    /// otherwise, or without planes, negative infinity.
    fn distance(&self, polytope: &ExpandingPolytope) -> f64 {
        let mut least = f64::INFINITY;
        for face in self.faces() {
            let [a, b, c] = face.map(|v| polytope.vertex(v.into()).w);
            let outward = (b - a).cross(c - a);
            let height = outward.dot(a);
            let squared = height * height / outward.length_squared();
            // Also for a face without area, whose distance is NaN.
            if !(height > 0.0 && squared > 0.0) {
                return f64::NEG_INFINITY;
            }
            least = min_no_nan(least, squared);
        }
        if self.face_count > 0 {
            least.sqrt()
        } else {
            f64::NEG_INFINITY
        }
    }

    /// Grows where the ball sticks out. If this does not help, returns `false` and changes nothing.
    fn grow<A: Polytope, B: Polytope>(
        &mut self,
        cso: &Cso<'_, A, B>,
        radius: f64,
        scratch: &mut EpaScratch,
        cost: &mut Cost,
    ) -> bool {
        let polytope = &mut scratch.polytope;
        if !polytope.add_surface(self.faces()) {
            return false;
        }
        for _ in 0..MAX_EXPANSIONS {
            let Some(face) = polytope.nearest_face() else {
                self.store(cso, scratch);
                return true;
            };
            let (normal, _) = polytope.plane(face);
            cost.iterations += 1;
            let vertex = cso.support(normal, cso.start_vertices(normal), cost);
            let is_farther = normal.dot(vertex.w) >= radius && !polytope.contains(&vertex);
            if !is_farther || !polytope.expand(face, vertex) {
                return false;
            }
        }
        false
    }

    /// Keeps the polytope of the last expansion in a Minkowski difference, if it is small enough.
    pub fn store<A: Support, B: Support>(&mut self, cso: &Cso<'_, A, B>, scratch: &EpaScratch) {
        if self.copy(&scratch.polytope, cso.center()).is_none() {
            self.face_count = 0;
        }
    }

    fn copy(&mut self, polytope: &ExpandingPolytope, center: DVec3) -> Option<()> {
        const NONE: u8 = u8::MAX;
        (self.vertex_count, self.face_count) = (0, 0);
        // From the polytope's vertices to ours. Many of the former are inside by now.
        let mut numbers = [NONE; 4 * MOST_VERTICES];
        for corners in polytope.surface() {
            let face = self.faces.get_mut(usize::from(self.face_count))?;
            for (corner, &vertex) in face.iter_mut().zip(corners) {
                let number = numbers.get_mut(vertex as usize)?;
                if *number == NONE {
                    let key = self.vertices.get_mut(usize::from(self.vertex_count))?;
                    *key = vertex_key(polytope.vertex(vertex), center);
                    *number = self.vertex_count;
                    self.vertex_count += 1;
                }
                *corner = *number;
            }
            self.face_count += 1;
        }
        Some(())
    }
}

fn vertex_key(vertex: &CsoVertex, center: DVec3) -> [u16; 2] {
    if vertex.w == center {
        CENTER
    } else {
        vertex.ids.map(|id| id.index() as u16)
    }
}

/// The point with this key, if the shapes have these vertices.
fn vertex_at<A: Polytope, B: Polytope>(key: [u16; 2], cso: &Cso<'_, A, B>) -> Option<CsoVertex> {
    if key == CENTER {
        return Some(cso.center_as_vertex([VertexId::default(); 2]));
    }
    let ids @ [id_1, id_2] = key.map(VertexId::from);
    let known = cso.shape_1.clamp_vertex(id_1) == id_1 && cso.shape_2.clamp_vertex(id_2) == id_2;
    known.then(|| cso.vertex(ids))
}
