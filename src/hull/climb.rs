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
//! Such vertices are known when the hull is built ([`is_fragile`]). A climb that ends at one of them
//! with a neighbour that ties searches the plateau for a vertex above it, and climbs on from
//! there.
//!
//! Promise: with `s` the returned vertex, `h(d) - d·s` is at most [`PLATEAU`]` * radius * |d|` on
//! convex hulls, and four times that on those that f32 rounding has dented, up to needles of
//! 1:1000. The cross-section of longer ones is a few roundings; there it is at most two
//! [`CONVEXITY`](crate::tolerance::CONVEXITY)` * radius * |d|`. Building refuses the surfaces on
//! which a climb would lose more: with deeper dents, folds, or two layers. The limits are those
//! measured in `tests/hill_climbing.rs`.

use glam::{DVec3, Vec3};

use super::graph::{EdgeGraph, LAST, Star};
use super::top::{Highest, LANES, coordinates};
use crate::stats::Cost;
use crate::support::VertexId;
use crate::tolerance::{LARGE_FACE, PLATEAU, SHORT_EDGE};

/// What a climb goes over.
#[derive(Clone, Copy)]
pub(super) struct Slope<'a> {
    pub points: &'a [Vec3],
    pub graph: &'a EdgeGraph,
    pub radius: f64,
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
        let fall = value - height;
        let tie = PLATEAU * slope.radius;
        let ties = fall * fall <= tie * tie * dir.length_squared();
        // Together: ties are not predictable (along an edge's normal its ends tie), fragile
        // vertices are.
        if ties & slope.graph.star(at).is_fragile()
            && let Some(exit) = slope.leave_plateau(dir, at)
        {
            (at, value) = (exit, slope.height(dir, exit));
            cost.climb_moves += 1;
            continue;
        }
        return at;
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
        let is_better = height > slope.height(dir, start);
        arrived[i] = !is_better & !slope.graph.star(start).is_fragile();
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

    /// A vertex above the plateau around `start`, or `None` if the plateau is the maximum.
    #[cold]
    #[inline(never)]
    fn leave_plateau(&self, dir: DVec3, start: VertexId) -> Option<VertexId> {
        let tie = PLATEAU * self.radius * dir.length();
        let level = self.height(dir, start);
        let mut plateau = vec![start];
        let mut next = 0;
        while let Some(&v) = plateau.get(next) {
            for w in self.graph.neighbors(v) {
                let height = self.height(dir, w.into());
                if height > level + tie {
                    return Some(w.into());
                }
                if height >= level - tie && !plateau.contains(&w.into()) {
                    plateau.push(w.into());
                }
            }
            next += 1;
        }
        None
    }
}

/// Whether a tie at a vertex may hide a way up: inside of a face or of a straight edge (with fewer
/// than three faces), with a very short edge, or on a face of many corners.
pub(super) fn is_fragile(
    points: &[DVec3],
    graph: &EdgeGraph,
    radius: f64,
    face_len: impl Fn(u16) -> usize,
    vertex: VertexId,
) -> bool {
    let shortest = SHORT_EDGE * radius;
    let to = |w: u16| points[vertex as usize].distance_squared(points[w as usize]);
    let mut neighbors = graph.neighbors(vertex);
    let short = neighbors.any(|w| to(w) < shortest * shortest);
    let mut faces = graph.faces_at(vertex).flatten();
    let large = faces.clone().any(|f| face_len(f) >= LARGE_FACE);
    let first = faces.next();
    let mut others = faces.filter(|&f| Some(f) != first);
    let second = others.next();
    let corner = others.any(|f| Some(f) != second);
    short || !corner || large
}
