//! The polytope of an expansion, kept to prove depths in later frames.
//!
//! Its vertices, re-evaluated at other poses, are again points of the Minkowski difference, and its triangles
//! form a closed surface, oriented outwards. If the origin is on the inner side of all their planes, at least
//! `d` away from each, the surface winds around the ball of radius `d` about the origin. So the ball lies in
//! the convex hull of the vertices, hence in the difference, and no direction has a smaller depth than `d`. The
//! surface need not be convex any more, and may come from another pair.

use glam::DVec3;

use super::clearance::{Cap, Clearance, KnownDepth};
use super::polytope::{EpaScratch, ExpandingPolytope, min_no_nan};
use crate::at::{At, to_u16};
use crate::stats::Cost;
use crate::support::{Cso, CsoVertex, Polytope, Support, VertexId};
use crate::tolerance::{DEPTH_GAP, PROOF_MARGIN};
use crate::tuning::MIN_GROWABLE;

/// Hulls of a thousand vertices that overlap by a fifth of their size usually need nineteen.
const MOST_VERTICES: usize = 32;
/// A closed surface of triangles has no more faces than this.
const MOST_FACES: usize = 2 * MOST_VERTICES - 4;

/// A surface that needs more expansions than this is no better a start than the features are.
const MAX_EXPANSIONS: usize = 12;

/// The key of the difference's centre.
const CENTER: [u16; 2] = [u16::MAX; 2];

/// A polytope inside a Minkowski difference, without coordinates.
#[derive(Clone, Debug)]
pub(super) struct CachedPolytope {
    /// For each vertex, the two vertices, one of each shape, whose difference it is.
    vertices: [[u16; 2]; MOST_VERTICES],
    /// Counter-clockwise as seen from outside.
    faces: [[u8; 3]; MOST_FACES],
    vertex_count: u8,
    /// Zero in an empty cache, which proves nothing.
    face_count: u8,
    /// The last proof.
    clearance: Option<Clearance>,
}

impl Default for CachedPolytope {
    fn default() -> Self {
        Self {
            vertices: [[0; 2]; MOST_VERTICES],
            faces: [[0; 3]; MOST_FACES],
            vertex_count: 0,
            face_count: 0,
            clearance: None,
        }
    }
}

impl CachedPolytope {
    /// Whether [`penetration_below`](super::penetration_below) is known to find no smaller depth: by this surface,
    /// after a few expansions if necessary, or by an earlier proof.
    pub fn proves_depth<A: Polytope, B: Polytope>(
        &mut self,
        cso: &Cso<'_, A, B>,
        known: &KnownDepth,
        scratch: &mut EpaScratch,
        cost: &mut Cost,
    ) -> bool {
        let radius = known.depth - PROOF_MARGIN * DEPTH_GAP * cso.min_radius();
        if known.is_wide()
            && let Some(clearance) = &self.clearance
            && clearance.proves(cso, known, radius)
        {
            return true;
        }
        let polytope = &mut scratch.polytope;
        polytope.clear(cso.size(), radius);
        for &key in &self.vertices[..self.vertex_count.into()] {
            match vertex_at(key, cso) {
                Some(vertex) => polytope.push(vertex),
                None => return false,
            }
        }
        let cap = known.narrow_cap();
        let reach = self.reach(polytope, &cap);
        if reach >= radius {
            if known.is_wide() {
                self.clearance = Clearance::new(cso, cap, reach);
            }
            return true;
        }
        reach > MIN_GROWABLE * radius && self.grow(cso, radius, scratch, cost)
    }

    fn faces(&self) -> &[[u8; 3]] {
        &self.faces[..self.face_count.into()]
    }

    /// A lower bound of the polytope's support in all directions outside a cap. Negative infinity if the origin is not
    /// on the inner side of all planes, or if there are none.
    fn reach(&self, polytope: &ExpandingPolytope, cap: &Cap) -> f64 {
        let mut least = f64::INFINITY;
        for face in self.faces() {
            let [a, b, c] = face.map(|v| polytope.vertex(v.into()).w);
            let outward = (b - a).cross(c - a);
            let height = outward.dot(a);
            let squared = height * height;
            // A face without area also ends here.
            if !(height > 0.0 && squared > 0.0) {
                return f64::NEG_INFINITY;
            }
            // Along any direction a plane is no nearer than its distance, and most planes are far away.
            if squared < least * outward.length_squared() {
                least = min_no_nan(least, cap.squared_reach(outward, height));
            }
        }
        if self.face_count > 0 {
            least.sqrt()
        } else {
            f64::NEG_INFINITY
        }
    }

    /// Expands the polytope where the ball sticks out. If this does not help, returns `false` and changes nothing.
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
        // Maps the polytope's vertices to ours. Many of the former are inside the surface by now.
        let mut numbers = [NONE; 4 * MOST_VERTICES];
        for corners in polytope.surface() {
            let face = self.faces.get_mut(usize::from(self.face_count))?;
            for (corner, &vertex) in face.iter_mut().zip(corners) {
                let number = numbers.try_at_mut(vertex)?;
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
        vertex.ids.map(|id| to_u16(id.index()))
    }
}

/// The point with this key, if the shapes have these vertices.
fn vertex_at<A: Polytope, B: Polytope>(key: [u16; 2], cso: &Cso<'_, A, B>) -> Option<CsoVertex> {
    if key == CENTER {
        return Some(cso.center_as_vertex([VertexId::default(); 2]));
    }
    let ids @ [id_1, id_2] = key.map(VertexId::from);
    let known = cso.shape_1.clamp_vertex(id_1) == id_1 && cso.shape_2.clamp_vertex(id_2) == id_2;
    if !known {
        return None;
    }
    Some(cso.vertex(ids))
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, Vec3};

    use super::*;
    use crate::epa::penetration;
    use crate::hull::Hull;
    use crate::pose::RelativePose;

    fn vector(rng: &mut oorandom::Rand64) -> DVec3 {
        DVec3::from([(); 3].map(|()| 2.0 * rng.rand_float() - 1.0))
    }

    fn hull(rng: &mut oorandom::Rand64) -> Hull {
        let count = rng.rand_range(8..40);
        let points: Vec<Vec3> = (0..count)
            .map(|_| vector(rng).normalize().as_vec3())
            .collect();
        Hull::from_points(&points).expect("points on a ball are their own hull")
    }

    /// A triangle, if it lies on the boundary of the difference and the origin projects into it.
    fn facet(cso: &Cso<'_, Hull, Hull>, corners: [CsoVertex; 3]) -> Option<KnownDepth> {
        let corners = corners.map(|corner| cso.vertex(corner.ids).w);
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).try_normalize()?;
        let start = cso.start_vertices(normal);
        let top = cso.support(normal, start, &mut Cost::default()).w;
        let depth = normal.dot(a);
        let insets = [(a, b), (b, c), (c, a)].map(|(from, to)| {
            let inward = normal.cross(to - from).normalize();
            -inward.dot(from)
        });
        let inset = insets.into_iter().fold(f64::INFINITY, f64::min);
        let is_facet = normal.dot(top - a) < 1e-12 && depth > 0.0 && inset > 0.0;
        is_facet.then_some(KnownDepth {
            depth,
            normal,
            inset,
        })
    }

    /// Two random poses that differ by a motion of this size.
    fn poses(motion: f64, rng: &mut oorandom::Rand64) -> [RelativePose; 2] {
        let [turn, place, turned, moved] = [(); 4].map(|()| vector(rng));
        [0.0, motion].map(|motion| {
            let turn =
                DQuat::from_scaled_axis(turned * motion) * DQuat::from_scaled_axis(3.0 * turn);
            RelativePose::from_parts(turn, place + moved * motion)
        })
    }

    /// The cached polytope of an expansion, its nearest facet, and its triangles.
    fn prove(cso: &Cso<'_, Hull, Hull>) -> Option<(Clearance, Vec<[CsoVertex; 3]>)> {
        let (scratch, cost) = (&mut EpaScratch::default(), &mut Cost::default());
        penetration(cso, &[], scratch, cost)?;
        let surface: Vec<_> = scratch.surface().collect();
        let mut cached = CachedPolytope::default();
        cached.store(cso, scratch);
        let facets = surface.iter().filter_map(|corners| facet(cso, *corners));
        let nearest = facets.min_by(|a, b| a.depth.total_cmp(&b.depth))?;
        cached.proves_depth(cso, &nearest, scratch, cost);
        Some((cached.clearance?, surface))
    }

    /// Small and large motions; all facets, one of which is the nearest.
    #[test]
    fn what_was_proved_before_a_motion_is_true_after_it() {
        let mut rng = oorandom::Rand64::new(5);
        let [mut proved, mut others] = [0; 2];
        for round in 0..2000 {
            let hulls = [hull(&mut rng), hull(&mut rng)];
            let poses = poses([0.0, 1e-4, 1e-3, 1e-2, 1e-1][round % 5], &mut rng);
            let [before, after] = [0, 1].map(|i| Cso {
                shape_1: &hulls[0],
                shape_2: &hulls[1],
                pose: &poses[i],
            });
            let Some((clearance, surface)) = prove(&before) else {
                continue;
            };
            let (scratch, cost) = (&mut EpaScratch::default(), &mut Cost::default());
            let depth = penetration(&after, &[], scratch, cost).map_or(f64::NAN, |p| p.depth);
            let gap = DEPTH_GAP * after.min_radius();
            for facet in surface.iter().filter_map(|t| facet(&after, *t)) {
                if clearance.proves(&after, &facet, facet.depth - gap) {
                    assert!(depth > facet.depth - 2.0 * gap, "{depth}, {facet:?}");
                    proved += 1;
                } else if depth < facet.depth - 2.0 * gap {
                    others += 1;
                }
            }
        }
        assert!(proved.min(others) > 50, "{proved} proved, {others} not");
    }
}
