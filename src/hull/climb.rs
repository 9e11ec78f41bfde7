//! Support by hill climbing on the edge graph (Cameron, *Enhancing GJK: computing minimum and
//! penetration distances between convex polyhedra*, ICRA 1997), with the base case corrected.
//!
//! From a vertex, move to the best neighbour while that is better. On a convex hull a vertex without a better
//! neighbour is extreme, unless it ties with its neighbours: a vertex inside a flat face may be the *worst*
//! vertex in the direction of the face's inward normal. In exact arithmetic only the start can be such a
//! vertex, since a vertex reached by an improving move has a strictly worse neighbour. With rounded
//! coordinates a tie may also hide a small rise or fall, over a very short edge or along the rim of a face
//! with many corners.
//!
//! The vertices at which this may happen are found when the hull is built: they have an edge that is flat up
//! to rounding, or very short. If a climb ends at one of them, next to a neighbour that is hardly lower, it
//! searches the plateau around it for a higher vertex and climbs on from there. A plateau of more than a few
//! vertices is not searched: scanning all points takes less time.
//!
//! For directions that point into the hull, any dent may be a false summit. But the top is above the centre,
//! so a climb that ends below the centre is finished by a scan.
//!
//! Promise: for the returned vertex `s`, `h(d) - d·s` is at most [`SUPPORT_TIE`]` * radius * |d|` on convex
//! hulls, and four times that on hulls that f32 rounding has dented, up to needles of 1:1000. The
//! cross-section of longer needles is only a few roundings; there it is at most two
//! [`MAX_DENT`](crate::tolerance::MAX_DENT)` * radius * |d|`. Building refuses surfaces on which a climb
//! would lose more: those with deeper dents, folds, or two layers. `tests/kernels/hill_climbing.rs` measures
//! these limits.

use std::array;

use glam::{DVec3, Vec3};

use super::graph::{EdgeGraph, LAST, NeighborBlock};
use crate::arg_max::ArgMaxDot;
use crate::simd::{LANES, coordinates};
use crate::stats::Cost;
use crate::support::VertexId;
use crate::tolerance::{DIP, SHORT_EDGE, SUPPORT_TIE};

/// The hull that is climbed.
#[derive(Clone, Copy)]
pub(super) struct HillClimb<'a> {
    pub points: &'a [Vec3],
    pub graph: &'a EdgeGraph,
    pub center: DVec3,
    pub radius: f64,
}

/// Larger plateaus are not searched.
const SMALL_PLATEAU: usize = 16;

/// The result of searching a plateau.
enum Plateau {
    /// This vertex is above it.
    Exit(VertexId),
    /// Nothing is above it.
    Summit,
    /// It is too large to be searched.
    Large,
}

/// The extreme vertex in direction `dir`, climbing from `start`.
#[inline(always)]
pub(super) fn extreme_vertex(
    climb: HillClimb<'_>,
    dir: DVec3,
    start: VertexId,
    cost: &mut Cost,
) -> VertexId {
    let mut at = start;
    let mut value = climb.support_value(dir, at);
    loop {
        let (best, height) = climb.best_neighbor(dir, at);
        if height > value {
            (at, value) = (best, height);
            cost.climb_moves += 1;
            continue;
        }
        if value < dir.dot(climb.center) {
            return climb.scan(dir, at);
        }
        if climb.graph.block(at).needs_plateau_search()
            && climb.is_hardly_lower(dir, value - height)
        {
            match climb.search_plateau(dir, at) {
                Plateau::Exit(exit) => {
                    (at, value) = (exit, climb.support_value(dir, exit));
                    cost.climb_moves += 1;
                    continue;
                }
                Plateau::Large => return climb.scan(dir, at),
                Plateau::Summit => {}
            }
        }
        return at;
    }
}

/// A vertex that has no better neighbour, and its height.
pub(super) fn nearest_summit(climb: HillClimb<'_>, dir: DVec3, start: VertexId) -> (VertexId, f64) {
    let (mut at, mut value) = (start, climb.support_value(dir, start));
    loop {
        let (best, height) = climb.best_neighbor(dir, at);
        if height <= value {
            return (at, value);
        }
        (at, value) = (best, height);
    }
}

/// Like [`extreme_vertex`], in many directions. All climbs take their first step together: its memory is not
/// in the cache yet, so the processor waits once for all of them. Half of them need no other step.
#[inline]
pub(super) fn extreme_vertices<const N: usize>(
    climb: HillClimb<'_>,
    dirs: [DVec3; N],
    starts: [VertexId; N],
) -> [VertexId; N] {
    let mut vertices = starts;
    let mut arrived = [false; N];
    for (i, &dir) in dirs.iter().enumerate() {
        let start = starts[i];
        let (best, height) = climb.best_neighbor(dir, start);
        let value = climb.support_value(dir, start);
        let is_better = height > value;
        let is_above = value >= dir.dot(climb.center);
        arrived[i] = !is_better & is_above & !climb.graph.block(start).needs_plateau_search();
        vertices[i] = if is_better { best } else { start };
    }
    for (i, &dir) in dirs.iter().enumerate() {
        if !arrived[i] {
            vertices[i] = extreme_vertex(climb, dir, vertices[i], &mut Cost::default());
        }
    }
    vertices
}

impl HillClimb<'_> {
    #[inline]
    fn support_value(&self, dir: DVec3, vertex: VertexId) -> f64 {
        dir.dot(self.points[vertex.index()].as_dvec3())
    }

    /// The best neighbour of a vertex, and its height. It compares four at a time, with selections instead of
    /// branches: neither the number of neighbours nor the better one is predictable.
    #[inline(always)]
    fn best_neighbor(&self, dir: DVec3, at: VertexId) -> (VertexId, f64) {
        let block = self.graph.block(at);
        let mut highest = ArgMaxDot::new(dir);
        self.scan_block(block, 0, &mut highest);
        if let Some(after) = self.graph.next_block(block) {
            highest = self.scan_overflow(after, highest);
        }
        let top = highest.finish();
        let best = self.graph.neighbor(at, top.id);
        (best.unwrap_or(at), top.value)
    }

    /// Compares the neighbours in a block whose first one has this slot.
    #[inline(always)]
    fn scan_block(&self, block: &NeighborBlock, slot: usize, highest: &mut ArgMaxDot) {
        let to = block.to();
        let (fours, _) = to.as_chunks::<LANES>();
        for (i, four) in fours.iter().enumerate() {
            let corners = four.map(|w| &self.points[usize::from(w)]);
            highest.update(slot + i * LANES, coordinates(corners));
        }
    }

    /// Compares the neighbours in `block` and all later blocks.
    #[cold]
    #[inline(never)]
    fn scan_overflow(&self, block: &NeighborBlock, mut highest: ArgMaxDot) -> ArgMaxDot {
        for (number, block) in (1..).zip(self.graph.blocks_from(block)) {
            self.scan_block(block, number * LAST, &mut highest);
        }
        highest
    }

    /// Whether a neighbour that is lower by `fall` may still lead upwards.
    #[inline(always)]
    fn is_hardly_lower(&self, dir: DVec3, fall: f64) -> bool {
        let dip = DIP * self.radius;
        fall * fall <= dip * dip * dir.length_squared()
    }

    /// Searches for a vertex above the plateau around `start`.
    #[cold]
    #[inline(never)]
    fn search_plateau(&self, dir: DVec3, start: VertexId) -> Plateau {
        let [tie, dip] = [SUPPORT_TIE, DIP].map(|share| share * self.radius * dir.length());
        let level = self.support_value(dir, start);
        let mut plateau = [start; SMALL_PLATEAU];
        let (mut next, mut count) = (0, 1);
        while next < count {
            for w in self.graph.neighbors(plateau[next]).map(VertexId::from) {
                let height = self.support_value(dir, w);
                if height > level + tie {
                    return Plateau::Exit(w);
                }
                if height >= level - dip && !plateau[..count].contains(&w) {
                    if count == SMALL_PLATEAU {
                        return Plateau::Large;
                    }
                    plateau[count] = w;
                    count += 1;
                }
            }
            next += 1;
        }
        Plateau::Summit
    }

    /// The highest of all vertices, or `preferred` if that ties.
    #[cold]
    #[inline(never)]
    fn scan(&self, dir: DVec3, preferred: VertexId) -> VertexId {
        let mut highest = ArgMaxDot::new(dir);
        for (number, chunk) in self.points.chunks(LANES).enumerate() {
            let corners = array::from_fn(|lane| chunk.get(lane).unwrap_or(&chunk[0]));
            highest.update(number * LANES, coordinates(corners));
        }
        let top = highest.finish();
        let tie = SUPPORT_TIE * self.radius * dir.length();
        let is_above = top.value > self.support_value(dir, preferred) + tie;
        // The last four are filled up by repeating their first one, which is preferred in a tie.
        if is_above {
            VertexId::new(top.id)
        } else {
            preferred
        }
    }
}

/// Whether a vertex has an edge so short that the rounding of its ends may hide a way up.
pub(super) fn has_short_edge(
    points: &[DVec3],
    graph: &EdgeGraph,
    radius: f64,
    vertex: VertexId,
) -> bool {
    let shortest = SHORT_EDGE * radius;
    let to = |w: u16| points[vertex.index()].distance_squared(points[usize::from(w)]);
    graph.neighbors(vertex).any(|w| to(w) < shortest * shortest)
}
