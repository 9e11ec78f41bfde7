//! Support by hill climbing on the edge graph (Cameron, *Enhancing GJK: computing minimum and
//! penetration distances between convex polyhedra*, ICRA 1997), with the base case corrected.
//!
//! From a vertex, move to the best neighbour while one is better. On a convex hull a vertex
//! with no better neighbour is extreme, unless it ties with all of its neighbours: a vertex in
//! the interior of a flat face may be the *worst* vertex in the direction of the face's inward
//! normal. A vertex reached by an improving move has a strictly worse neighbour, so that only
//! the start can be such a vertex. If it is, its plateau is searched for a vertex with a
//! neighbour off the plateau: a better one to climb from, or a worse one, which proves that the
//! plateau is the maximum.
//!
//! Promise: with `s` the returned vertex, `h(d) - d·s <= PLATEAU * radius * |d|` wherever the
//! hull is convex to rounding.

use glam::{DVec3, Vec3};

use super::graph::{EdgeGraph, LANES};
use crate::stats::Cost;
use crate::support::VertexId;
use crate::tolerance::PLATEAU;

/// The extreme vertex in direction `dir`, climbing from `start`.
#[inline]
pub(super) fn support(
    points: &[Vec3],
    graph: &EdgeGraph,
    radius: f64,
    dir: DVec3,
    start: VertexId,
    cost: &mut Cost,
) -> (DVec3, VertexId) {
    cost.supports += 1;
    let start_value = dir.dot(points[start as usize].as_dvec3());
    let mut best = start;
    let mut value = start_value;
    let worst_neighbor;
    (value, best, worst_neighbor) = best_neighbor(points, graph.rows(best), dir, value, best);
    let mut last = start;
    while best != last {
        last = best;
        cost.climb_moves += 1;
        (value, best, _) = best_neighbor(points, graph.rows(best), dir, value, best);
    }
    // If a neighbour of the start lies off the plateau, or the climb left it upwards, the end
    // is a maximum.
    let off = (value - start_value).max(start_value - worst_neighbor);
    let tie = PLATEAU * radius;
    if off * off <= tie * tie * dir.length_squared()
        && let Some(exit) = leave_plateau(points, graph, tie, dir, best)
    {
        cost.climb_moves += 1;
        return support(points, graph, radius, dir, exit, cost);
    }
    (points[best as usize].as_dvec3(), best)
}

/// The best of a vertex, `best` with `value`, and its neighbours; and the least value of these.
/// Four at a time, and selections instead of branches: neither how many neighbours there are nor
/// which of them is better is predictable.
#[inline(always)]
fn best_neighbor(
    points: &[Vec3],
    rows: &[[u16; LANES]],
    dir: DVec3,
    mut value: f64,
    mut best: VertexId,
) -> (f64, VertexId, f64) {
    let mut worst = f64::INFINITY;
    for row in rows {
        let values = row.map(|w| dir.dot(points[w as usize].as_dvec3()));
        for (&w, d) in row.iter().zip(values) {
            let better = d > value;
            best = if better { w.into() } else { best };
            value = if better { d } else { value };
            worst = if d < worst { d } else { worst };
        }
    }
    (value, best, worst)
}

/// A vertex above the plateau around `start`, or `None` if the plateau is the maximum.
#[cold]
#[inline(never)]
fn leave_plateau(
    points: &[Vec3],
    graph: &EdgeGraph,
    tie: f64,
    dir: DVec3,
    start: VertexId,
) -> Option<VertexId> {
    let tie = tie * dir.length();
    let level = dir.dot(points[start as usize].as_dvec3());
    let mut seen = vec![false; points.len()];
    let mut stack = vec![start];
    seen[start as usize] = true;
    while let Some(v) = stack.pop() {
        for &w in graph.neighbors(v) {
            let d = dir.dot(points[w as usize].as_dvec3());
            if d > level + tie {
                return Some(w.into());
            }
            if d < level - tie {
                return None;
            }
            if !std::mem::replace(&mut seen[w as usize], true) {
                stack.push(w.into());
            }
        }
    }
    None
}
