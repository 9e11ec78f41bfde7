//! Distance by GJK (Gilbert, Johnson, Keerthi, *A fast procedure for computing the distance
//! between complex objects in three-dimensional space*, IEEE J. Robotics and Automation 4(2),
//! 1988), with the separating-axis exit and the incremental start of van den Bergen (*A fast and
//! robust GJK implementation for collision detection of convex objects*, J. Graphics Tools 4(2),
//! 1999).
//!
//! The loop keeps a simplex of at most four vertices of the Minkowski difference and its point
//! `v` nearest to the origin. A support point `w` in direction `-v` bounds the distance from
//! below by `v·w / |v|`, `|v|` bounds it from above: every answer carries both bounds.

use glam::DVec3;

use crate::simplex::{DistanceSubalgorithm, Nearest};
use crate::stats::Cost;
use crate::support::{Cso, CsoVertex, Support, VertexId};
use crate::tolerance::{GJK_ABSOLUTE_GAP, GJK_RELATIVE_GAP, TOUCHING};

/// Convergence is finite, and even the adversarial families need far fewer iterations; the
/// bound only guards against a stall that no other test sees.
const MAX_ITERATIONS: usize = 256;

/// At most four vertices of the Minkowski difference.
#[derive(Clone, Copy, Debug, Default)]
pub struct Simplex {
    vertices: [CsoVertex; 4],
    len: usize,
}

impl Simplex {
    /// The vertices.
    pub fn vertices(&self) -> &[CsoVertex] {
        &self.vertices[..self.len]
    }

    fn push(&mut self, vertex: CsoVertex) {
        self.vertices[self.len] = vertex;
        self.len += 1;
    }

    fn contains(&self, vertex: &CsoVertex) -> bool {
        self.vertices().iter().any(|v| v.w == vertex.w)
    }

    /// Keeps the vertices whose bits are set in `face`, and their weights in order.
    fn reduce(&mut self, face: u8, lambda: [f64; 4]) -> [f64; 4] {
        let mut weights = [0.0; 4];
        let mut kept = 0;
        for i in 0..self.len {
            if face >> i & 1 == 1 {
                self.vertices[kept] = self.vertices[i];
                weights[kept] = lambda[i];
                kept += 1;
            }
        }
        self.len = kept;
        weights
    }
}

/// The nearest points of two disjoint shapes, in frame 1.
#[derive(Clone, Copy, Debug)]
pub struct Closest {
    /// The distance of the two points: an upper bound of the shapes' distance.
    pub distance: f64,
    /// A lower bound of the distance, proved by a support point along `normal`.
    pub lower_bound: f64,
    /// The unit direction from shape 1 to shape 2.
    pub normal: DVec3,
    /// The nearest point of shape 1.
    pub on_1: DVec3,
    /// The nearest point of shape 2.
    pub on_2: DVec3,
    /// The smallest simplex that holds the difference of the points.
    pub simplex: Simplex,
}

/// How a GJK run ended.
#[derive(Clone, Copy, Debug)]
pub enum Outcome {
    /// The shapes are farther apart than asked for.
    Apart(SeparatingAxis),
    /// The shapes are disjoint, this near.
    Near(Closest),
    /// The shapes touch or overlap: the origin lies in this simplex, up to rounding.
    Overlap(Simplex),
}

/// A direction along which the shapes are separated, as it is kept for the next frame.
#[derive(Clone, Copy, Debug)]
pub struct SeparatingAxis {
    /// Unit direction from shape 1 to shape 2, in frame 1.
    pub axis: DVec3,
    /// The separation along the axis: a lower bound of the distance.
    pub separation: f64,
    /// The extreme vertices along the axis.
    pub ids: [VertexId; 2],
}

/// One support pair along a cached `axis` (unit, frame 1): is it still separating by more than
/// `beyond`? The incremental part of separating-axis GJK. Also returns the vertex found, with
/// which a GJK run can go on.
#[inline]
pub fn test_axis<A: Support, B: Support>(
    cso: &Cso<'_, A, B>,
    axis: DVec3,
    start: [VertexId; 2],
    beyond: f64,
    cost: &mut Cost,
) -> Result<SeparatingAxis, CsoVertex> {
    let vertex = cso.support(axis, start, cost);
    let separation = -axis.dot(vertex.w);
    if separation > beyond {
        Ok(SeparatingAxis {
            axis,
            separation,
            ids: vertex.ids,
        })
    } else {
        Err(vertex)
    }
}

/// Distance and nearest points, starting from any vertex of the Minkowski difference; the nearer
/// to the origin it lies, the fewer the iterations. Ends early, with a separating axis, when the
/// distance is proved to exceed `max_distance`.
pub fn distance<S: DistanceSubalgorithm, A: Support, B: Support>(
    cso: &Cso<'_, A, B>,
    start: CsoVertex,
    max_distance: f64,
    cost: &mut Cost,
) -> Outcome {
    let size = cso.size();
    let mut simplex = Simplex::default();
    simplex.push(start);
    let mut weights = [1.0, 0.0, 0.0, 0.0];
    let mut v = start.w;
    let mut ids = start.ids;
    for _ in 0..MAX_ITERATIONS {
        cost.iterations += 1;
        let norm = v.length();
        if norm.partial_cmp(&(TOUCHING * size)) != Some(std::cmp::Ordering::Greater) {
            return Outcome::Overlap(simplex);
        }
        let w = cso.support(-v, ids, cost);
        ids = w.ids;
        let lower_bound = v.dot(w.w) / norm;
        if lower_bound > max_distance {
            return Outcome::Apart(SeparatingAxis {
                axis: -v / norm,
                separation: lower_bound,
                ids,
            });
        }
        let gap = norm - lower_bound;
        let converged = gap <= GJK_RELATIVE_GAP * norm || gap <= GJK_ABSOLUTE_GAP * size;
        if converged || simplex.contains(&w) {
            return Outcome::Near(closest(&simplex, weights, v, lower_bound));
        }
        let mut grown = simplex;
        grown.push(w);
        let nearest = nearest::<S>(&grown);
        if nearest.face == 0b1111 {
            return Outcome::Overlap(grown);
        }
        // In exact arithmetic the norm decreases strictly; where it does not, rounding has the
        // last word and the answer at hand is as good as it gets.
        if nearest.point.length_squared() >= norm * norm {
            return Outcome::Near(closest(&simplex, weights, v, lower_bound));
        }
        v = nearest.point;
        weights = grown.reduce(nearest.face, nearest.lambda);
        simplex = grown;
    }
    cost.fallbacks += 1;
    let w = cso.support(-v, ids, cost);
    Outcome::Near(closest(&simplex, weights, v, v.dot(w.w) / v.length()))
}

#[inline]
fn nearest<S: DistanceSubalgorithm>(simplex: &Simplex) -> Nearest {
    let points = simplex.vertices.map(|vertex| vertex.w);
    S::nearest(&points[..simplex.len])
}

fn closest(simplex: &Simplex, weights: [f64; 4], v: DVec3, lower_bound: f64) -> Closest {
    let distance = v.length();
    let on_1: DVec3 = simplex
        .vertices()
        .iter()
        .zip(weights)
        .map(|(vertex, weight)| vertex.on_1 * weight)
        .sum();
    Closest {
        distance,
        lower_bound: lower_bound.min(distance),
        normal: -v / distance,
        on_1,
        on_2: on_1 - v,
        simplex: *simplex,
    }
}
