//! Distance by GJK (Gilbert, Johnson, Keerthi, *A fast procedure for computing the distance
//! between complex objects in three-dimensional space*, IEEE J. Robotics and Automation 4(2),
//! 1988), with the separating-axis exit and the incremental start of van den Bergen (*A fast and
//! robust GJK implementation for collision detection of convex objects*, J. Graphics Tools 4(2),
//! 1999).
//!
//! The loop keeps a simplex of at most four vertices of the Minkowski difference and its point
//! `v` nearest to the origin. A support point `w` in direction `-v` bounds the distance from
//! below by `v·w / |v|`, `|v|` bounds it from above: every answer carries both bounds.

mod simplex;

pub use simplex::Simplex;

use glam::DVec3;

use crate::pose::is_unit;
use crate::simplex::{DistanceSubalgorithm, Nearest};
use crate::stats::Cost;
use crate::support::{Cso, CsoVertex, Support, VertexId};
use crate::tolerance::{DEPTH_GAP, GJK_GAP_OF_DISTANCE, GJK_GAP_OF_SIZE, MIN_DIRECTED_DISTANCE};

/// Convergence is finite, and even the adversarial families need far fewer iterations. This limit only guards
/// against a stall that no other test detects.
const MAX_ITERATIONS: usize = 256;

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
    /// The shapes are farther apart than the maximum distance.
    Separated(SeparatingAxis),
    /// The shapes are disjoint, this near.
    Disjoint(Closest),
    /// Rounding ended the search: the shapes may be this near, or overlap.
    Unsure(Closest),
    /// The shapes touch or overlap: the origin lies in this simplex, up to rounding.
    Overlapping(Simplex),
}

/// A direction along which the shapes are separated.
#[derive(Clone, Copy, Debug)]
pub struct SeparatingAxis {
    /// Unit direction from shape 1 to shape 2, in frame 1.
    pub axis: DVec3,
    /// The separation along the axis: a lower bound of the distance.
    pub separation: f64,
    /// The extreme vertices along the axis.
    pub ids: [VertexId; 2],
}

/// The result of a support pair along an axis.
pub enum AxisTest {
    /// The axis separates the shapes by more than the given distance.
    Separating(SeparatingAxis),
    /// It does not: this vertex is extreme along it, and a search can go on from there.
    Supporting(CsoVertex),
}

/// Whether an `axis` (unit, frame 1) that separated before still separates by more than `beyond`. Mostly it
/// does, and then bounds often show it that cost less than a support pair.
#[inline]
pub fn test_cached_axis<A: Support, B: Support>(
    cso: &Cso<'_, A, B>,
    axis: DVec3,
    start: [VertexId; 2],
    beyond: f64,
    cost: &mut Cost,
) -> AxisTest {
    match separation_bound(cso, axis, cost) {
        Some(separation) if separation > beyond => AxisTest::Separating(SeparatingAxis {
            axis,
            separation,
            ids: start,
        }),
        _ => test_axis(cso, axis, start, beyond, cost),
    }
}

/// Whether an `axis` (unit, frame 1) separates by more than `beyond`, by one support pair. This is the
/// incremental part of separating-axis GJK.
#[inline(always)]
pub fn test_axis<A: Support, B: Support>(
    cso: &Cso<'_, A, B>,
    axis: DVec3,
    start: [VertexId; 2],
    beyond: f64,
    cost: &mut Cost,
) -> AxisTest {
    debug_assert!(is_unit(axis), "no unit vector: {axis}");
    let (on_2, id_2) = cso.support_2(axis, start[1], cost);
    // The bounding sphere of shape 1 may suffice: then none of its vertices is read. Rounding may make the
    // axis longer than 1; the mean of 1 and its squared length is at least its length.
    let longest = 0.5 + 0.5 * axis.length_squared();
    let reach_1 = axis.dot(cso.shape_1.center()) + cso.shape_1.radius() * longest;
    let separation = axis.dot(on_2) - reach_1;
    if separation > beyond {
        return AxisTest::Separating(SeparatingAxis {
            axis,
            separation,
            ids: [start[0], id_2],
        });
    }
    let (on_1, id_1) = cso.shape_1.support(axis, start[0], cost);
    let vertex = CsoVertex {
        w: on_1 - on_2,
        on_1,
        ids: [id_1, id_2],
    };
    let separation = -axis.dot(vertex.w);
    if separation > beyond {
        AxisTest::Separating(SeparatingAxis {
            axis,
            separation,
            ids: vertex.ids,
        })
    } else {
        AxisTest::Supporting(vertex)
    }
}

/// A lower bound of the separation along an axis, if it costs less than a support pair.
#[inline]
fn separation_bound<A: Support, B: Support>(
    cso: &Cso<'_, A, B>,
    axis: DVec3,
    cost: &mut Cost,
) -> Option<f64> {
    let reach_1 = cso.shape_1.extent_bound(axis, cost)?;
    let reach_2 = (cso.shape_2).extent_bound(-cso.pose.direction_to_2(axis), cost)?;
    Some(axis.dot(cso.pose.translation()) - reach_2 - reach_1)
}

/// Distance and nearest points, starting from vertices of the Minkowski difference. Only the first three are
/// used; at least one is required. The nearer to the origin they lie, the fewer iterations are needed. Ends
/// early, with a separating axis, once the distance is proved to exceed `max_distance`.
// perf: answers and vectors that go through memory cost a tenth of a cold query.
#[inline(always)]
pub fn distance<S: DistanceSubalgorithm, A: Support, B: Support>(
    cso: &Cso<'_, A, B>,
    start: &[CsoVertex],
    max_distance: f64,
    cost: &mut Cost,
) -> Outcome {
    distance_within::<S, A, B>(cso, start, max_distance, GJK_GAP_OF_SIZE, cost)
}

/// Like [`distance`], but stops when the bounds differ by less than `gap`, relative to the pair's size.
#[inline(always)]
pub fn distance_within<S: DistanceSubalgorithm, A: Support, B: Support>(
    cso: &Cso<'_, A, B>,
    start: &[CsoVertex],
    max_distance: f64,
    gap: f64,
    cost: &mut Cost,
) -> Outcome {
    let size = cso.size();
    let absolute_gap = gap * size;
    debug_assert!(!start.is_empty(), "no vertex to start from");
    let start = &start[..start.len().min(3)];
    let mut simplex = Simplex::default();
    start.iter().for_each(|&vertex| simplex.push(vertex));
    let mut ids = start.last().map(|vertex| vertex.ids).unwrap_or_default();
    let mut nearest = simplex.nearest::<S>(DVec3::ZERO);
    simplex.keep(nearest.face);
    for iteration in 0..MAX_ITERATIONS {
        cost.iterations += 1;
        let v = nearest.point;
        let norm = v.length();
        if norm.partial_cmp(&(MIN_DIRECTED_DISTANCE * size)) != Some(std::cmp::Ordering::Greater) {
            return Outcome::Overlapping(simplex);
        }
        let w = cso.support(-v, climb_start(cso, iteration, -v, ids), cost);
        ids = w.ids;
        let lower_bound = v.dot(w.w) / norm;
        if lower_bound > max_distance {
            return Outcome::Separated(SeparatingAxis {
                axis: -v / norm,
                separation: lower_bound,
                ids,
            });
        }
        let between = norm - lower_bound;
        let converged = between <= GJK_GAP_OF_DISTANCE * norm || between <= absolute_gap;
        if converged {
            return Outcome::Disjoint(closest(&simplex, &nearest, lower_bound));
        }
        if simplex.contains(&w) {
            return ended(cso, closest(&simplex, &nearest, lower_bound));
        }
        let before = simplex.occupied;
        simplex.push(w);
        let next = simplex.nearest::<S>(DVec3::ZERO);
        if next.face == 0b1111 {
            return Outcome::Overlapping(simplex);
        }
        // In exact arithmetic the norm decreases strictly.
        if next.point.length_squared() >= norm * norm {
            simplex.keep(before);
            return ended(cso, closest(&simplex, &nearest, lower_bound));
        }
        nearest = next;
        simplex.keep(nearest.face);
    }
    cost.fallbacks += 1;
    let v = nearest.point;
    let lower_bound = v.dot(cso.support(-v, ids, cost).w) / v.length();
    ended(cso, closest(&simplex, &nearest, lower_bound))
}

/// The outcome of a search that rounding ended. Its answer is good if the bounds are close enough. With a
/// nearly flat simplex they may not be, and the direction of the nearest point may be arbitrary. But shapes that the
/// lower bound proves clearly apart have no depth to search for.
fn ended<A: Support, B: Support>(cso: &Cso<'_, A, B>, closest: Closest) -> Outcome {
    let promised = DEPTH_GAP * cso.min_radius() + MIN_DIRECTED_DISTANCE * cso.size();
    let gap = closest.distance - closest.lower_bound;
    if gap <= promised || gap < closest.lower_bound {
        Outcome::Disjoint(closest)
    } else {
        Outcome::Unsure(closest)
    }
}

/// In the first iterations the direction turns so far that the start table has a better vertex than the last
/// one found.
const TABLE_START_ITERATIONS: usize = 4;

/// The start vertices for the climbs of an iteration.
#[inline]
pub(crate) fn climb_start<A: Support, B: Support>(
    cso: &Cso<'_, A, B>,
    iteration: usize,
    dir: DVec3,
    last: [VertexId; 2],
) -> [VertexId; 2] {
    if iteration < TABLE_START_ITERATIONS {
        cso.start_vertices(dir)
    } else {
        last
    }
}

fn closest(simplex: &Simplex, nearest: &Nearest, lower_bound: f64) -> Closest {
    let v = nearest.point;
    let distance = v.length();
    let on_1 = simplex.on_1(nearest);
    Closest {
        distance,
        lower_bound: lower_bound.min(distance),
        normal: -v / distance,
        on_1,
        on_2: on_1 - v,
        simplex: *simplex,
    }
}
