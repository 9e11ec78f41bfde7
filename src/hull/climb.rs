//! Support by hill climbing on the edge graph (Cameron, *Enhancing GJK: computing minimum and
//! penetration distances between convex polyhedra*, ICRA 1997), with the base case corrected.
//!
//! From a vertex, move to the best neighbour while one is better. On a convex hull a vertex
//! with no better neighbour is extreme, unless it ties with neighbours: a vertex in the interior
//! of a flat face may be the *worst* vertex in the direction of the face's inward normal. In
//! exact arithmetic only the start can be such a vertex, since a vertex reached by an improving
//! move has a strictly worse neighbour. With rounded coordinates a tie may also hide a small rise
//! or a small fall: over a very short edge, or along the rim of a face with many corners.
//!
//! All vertices at which that may happen are known when the hull is built: they have an edge that is
//! flat up to rounding, or a very short one. A climb that ends at one of them with a neighbour that is
//! hardly lower searches the plateau around for a vertex above it, and climbs on from there. A plateau
//! of more than a few vertices is not searched: a scan of all points takes less time.
//!
//! A dent may be a false summit for directions that point into the hull, however deep it is. But the
//! top is above the centre. So a climb that ends below the centre is finished by a scan.
//!
//! Promise: with `s` the returned vertex, `h(d) - d·s` is at most [`PLATEAU`]` * radius * |d|` on
//! convex hulls, and four times that on those that f32 rounding has dented, up to needles of
//! 1:1000. The cross-section of longer ones is a few roundings; there it is at most two
//! [`CONVEXITY`](crate::tolerance::CONVEXITY)` * radius * |d|`. Building refuses the surfaces on
//! which a climb would lose more: with deeper dents, folds, or two layers. The limits are those
//! measured in `tests/kernels/hill_climbing.rs`.

use std::array;

use glam::{DVec3, Vec3};

use super::graph::{EdgeGraph, LAST, Star};
use super::top::{Highest, LANES, coordinates};
use crate::stats::Cost;
use crate::support::VertexId;
use crate::tolerance::{DIP, PLATEAU, SHORT_EDGE};

/// What a climb goes over.
#[derive(Clone, Copy)]
pub(super) struct Slope<'a> {
    pub points: &'a [Vec3],
    pub graph: &'a EdgeGraph,
    pub center: DVec3,
    pub radius: f64,
}

/// A larger plateau is not searched.
const SMALL_PLATEAU: usize = 16;

/// What a search of a plateau found.
enum Plateau {
    /// A vertex above it.
    Exit(VertexId),
    /// It is the maximum.
    Top,
    /// It is too large for a search.
    Large,
}

/// The extreme vertex in direction `dir`, climbing from `start`.
#[inline(always)]
pub(super) fn extreme_vertex(
    slope: Slope<'_>,
    dir: DVec3,
    start: VertexId,
    cost: &mut Cost,
) -> VertexId {
    let mut at = start;
    let mut value = slope.height(dir, at);
    loop {
        let (best, height) = slope.best_neighbor(dir, at);
        if height > value {
            (at, value) = (best, height);
            cost.climb_moves += 1;
            continue;
        }
        if value < dir.dot(slope.center) {
            return slope.scan(dir, at);
        }
        if slope.graph.star(at).is_fragile() && slope.is_hardly_lower(dir, value - height) {
            match slope.search_plateau(dir, at) {
                Plateau::Exit(exit) => {
                    (at, value) = (exit, slope.height(dir, exit));
                    cost.climb_moves += 1;
                    continue;
                }
                Plateau::Large => return slope.scan(dir, at),
                Plateau::Top => {}
            }
        }
        return at;
    }
}

/// A vertex without a better neighbour, and its height.
pub(super) fn nearest_summit(slope: Slope<'_>, dir: DVec3, start: VertexId) -> (VertexId, f64) {
    let (mut at, mut value) = (start, slope.height(dir, start));
    loop {
        let (best, height) = slope.best_neighbor(dir, at);
        if height <= value {
            return (at, value);
        }
        (at, value) = (best, height);
    }
}

/// As [`extreme_vertex`], in many directions. Their climbs take the first step together: it is the one
/// from memory that is in no cache, and so the processor waits for all of it at once. Half of them need
/// no other.
#[inline]
pub(super) fn extreme_vertices<const N: usize>(
    slope: Slope<'_>,
    dirs: [DVec3; N],
    starts: [VertexId; N],
) -> [VertexId; N] {
    let mut vertices = starts;
    let mut arrived = [false; N];
    for (i, &dir) in dirs.iter().enumerate() {
        let start = starts[i];
        let (best, height) = slope.best_neighbor(dir, start);
        let value = slope.height(dir, start);
        let is_better = height > value;
        let is_above = value >= dir.dot(slope.center);
        arrived[i] = !is_better & is_above & !slope.graph.star(start).is_fragile();
        vertices[i] = if is_better { best } else { start };
    }
    for (i, &dir) in dirs.iter().enumerate() {
        if !arrived[i] {
            vertices[i] = extreme_vertex(slope, dir, vertices[i], &mut Cost::default());
        }
    }
    vertices
}

impl Slope<'_> {
    #[inline]
    fn height(&self, dir: DVec3, vertex: VertexId) -> f64 {
        dir.dot(self.points[vertex as usize].as_dvec3())
    }

    /// The best neighbour of a vertex, and its height. Four at a time, and selections instead of
    /// branches: neither how many neighbours there are nor which of them is better is predictable.
    #[inline(always)]
    fn best_neighbor(&self, dir: DVec3, at: VertexId) -> (VertexId, f64) {
        let star = self.graph.star(at);
        let mut highest = Highest::new(dir);
        self.look_at(star, 0, &mut highest);
        if let Some(after) = self.graph.after(star) {
            highest = self.look_further(after, highest);
        }
        let top = highest.top();
        let best = self.graph.neighbor(at, top.name as usize);
        (best.unwrap_or(at), top.value)
    }

    /// At the neighbours in a star, of which the first has this `place`.
    #[inline(always)]
    fn look_at(&self, star: &Star, place: usize, highest: &mut Highest) {
        let to = star.to();
        let (fours, _) = to.as_chunks::<LANES>();
        for (i, four) in fours.iter().enumerate() {
            let corners = four.map(|w| &self.points[usize::from(w)]);
            highest.look_at(place + i * LANES, coordinates(corners));
        }
    }

    /// At those in the stars from `star` on.
    #[cold]
    #[inline(never)]
    fn look_further(&self, star: &Star, mut highest: Highest) -> Highest {
        for (number, star) in (1..).zip(self.graph.stars_from(star)) {
            self.look_at(star, number * LAST, &mut highest);
        }
        highest
    }

    /// Whether a neighbour that is lower by `fall` may hide a way up.
    #[inline(always)]
    fn is_hardly_lower(&self, dir: DVec3, fall: f64) -> bool {
        let dip = DIP * self.radius;
        fall * fall <= dip * dip * dir.length_squared()
    }

    /// Looks for a vertex above the plateau around `start`.
    #[cold]
    #[inline(never)]
    fn search_plateau(&self, dir: DVec3, start: VertexId) -> Plateau {
        let [tie, dip] = [PLATEAU, DIP].map(|share| share * self.radius * dir.length());
        let level = self.height(dir, start);
        let mut plateau = [start; SMALL_PLATEAU];
        let (mut next, mut count) = (0, 1);
        while next < count {
            for w in self.graph.neighbors(plateau[next]).map(VertexId::from) {
                let height = self.height(dir, w);
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
        Plateau::Top
    }

    /// The highest of all vertices, or `preferred` if that ties.
    #[cold]
    #[inline(never)]
    fn scan(&self, dir: DVec3, preferred: VertexId) -> VertexId {
        let mut highest = Highest::new(dir);
        for (number, chunk) in self.points.chunks(LANES).enumerate() {
            let corners = array::from_fn(|lane| chunk.get(lane).unwrap_or(&chunk[0]));
            highest.look_at(number * LANES, coordinates(corners));
        }
        let top = highest.top();
        let tie = PLATEAU * self.radius * dir.length();
        let is_above = top.value > self.height(dir, preferred) + tie;
        // What fills up the last four repeats its first one, which is preferred among ties.
        if is_above {
            top.name as VertexId
        } else {
            preferred
        }
    }
}

/// Whether a vertex has an edge so short that its ends' rounding hides a way up.
pub(super) fn has_short_edge(
    points: &[DVec3],
    graph: &EdgeGraph,
    radius: f64,
    vertex: VertexId,
) -> bool {
    let shortest = SHORT_EDGE * radius;
    let to = |w: u16| points[vertex as usize].distance_squared(points[w as usize]);
    graph.neighbors(vertex).any(|w| to(w) < shortest * shortest)
}
