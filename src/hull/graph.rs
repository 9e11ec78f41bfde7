//! The edge graph of a triangulated hull: the neighbours of each vertex, and the faces between them.

use std::{array, iter};

use super::surface::{Side, Surface, triangle};
use crate::support::VertexId;

/// An edge is named by its lower vertex, above this many bits, and its place among that vertex's
/// neighbours. With at most 2^15 vertices the name has 30 bits, as parry's packed feature ids do.
const PLACE_BITS: u32 = 15;

/// The neighbours of each vertex.
#[derive(Clone, Debug)]
#[repr(C)]
pub(super) struct EdgeGraph {
    /// The first neighbours of each vertex, which of most vertices are all.
    stars: Box<[Star]>,
    /// Those after them, in no order that matters.
    more: Box<[Star]>,
}

/// Neighbours of a vertex, clockwise seen from outside. Unused slots repeat the first
/// neighbour, which comes after the last one. Where there are more, the last one is also the first in the next star.
///
/// Each vertex has one, so that it is found without another look into memory; and by its alignment
/// it is on one line of the cache.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(super) struct Star {
    /// Ids of vertices; the highest bits of the first two are marks.
    to: [u16; STAR],
    /// The face left of the edge to each of them. Right of it is that left of the next one. Where there
    /// are more neighbours, the last one is no face, but where their star is.
    left: [u16; STAR],
}

/// On a triangulated surface each vertex has six neighbours on the average.
const STAR: usize = 8;

/// A bit that no id of a vertex has.
const MARK: u16 = 1 << 15;
/// The neighbour whose mark says that at this vertex a tie must be looked into.
const FRAGILE: usize = 0;
/// The neighbour whose mark says that there are more of them in another star.
const CROWDED: usize = 1;
/// The last place of a star, and how many neighbours it has that the next one has not.
pub(super) const LAST: usize = STAR - 1;

impl Star {
    /// From the sides that leave a vertex, of which the `first` is to fill up with.
    fn new(sides: &[Side], first: &Side, face_of: &[u16]) -> Self {
        let sides: [&Side; STAR] = array::from_fn(|i| sides.get(i).unwrap_or(first));
        Self {
            to: sides.map(|side| side.to),
            left: sides.map(|side| face_of[triangle(side.half_edge)]),
        }
    }

    /// With others after it.
    fn with_more(mut self, place: usize) -> Self {
        self.to[CROWDED] |= MARK;
        self.left[LAST] = place as u16;
        self
    }

    /// The neighbours.
    #[inline(always)]
    pub fn to(&self) -> [u16; STAR] {
        let mut to = self.to;
        to[FRAGILE] &= !MARK;
        to[CROWDED] &= !MARK;
        to
    }

    /// Whether a climb must look into ties at this vertex.
    #[inline(always)]
    pub fn is_fragile(&self) -> bool {
        self.to[FRAGILE] & MARK != 0
    }

    /// Whether the vertex has others after these.
    #[inline(always)]
    pub fn is_crowded(&self) -> bool {
        self.to[CROWDED] & MARK != 0
    }

    /// The faces left of the edges to them, but for the last one where there are others after it.
    #[inline(always)]
    fn left(&self) -> [u16; STAR] {
        let mut left = self.left;
        if self.is_crowded() {
            left[LAST] = left[0];
        }
        left
    }
}

impl EdgeGraph {
    /// From a surface whose triangles went to the faces `face_of`.
    pub fn new(surface: &Surface<'_>, face_of: &[u16]) -> Self {
        let mut more = Vec::new();
        let stars = (0..surface.vertex_count()).map(|v| {
            let around = surface.leaving(v as u32);
            let star = |sides| Star::new(sides, &around[0], face_of);
            // From the last one on, so that each knows where the next is.
            let last = (around.len() - 2) / LAST;
            (1..=last)
                .rev()
                .fold(star(&around[last * LAST..]), |after, number| {
                    more.push(after);
                    let sides = &around[(number - 1) * LAST..][..STAR];
                    star(sides).with_more(more.len() - 1)
                })
        });
        Self {
            stars: stars.collect(),
            more: more.into(),
        }
    }

    /// Marks the vertices at which a climb must look into ties.
    pub fn mark_fragile(&mut self, is_fragile: impl Fn(&Self, VertexId) -> bool) {
        for v in 0..self.stars.len() {
            if is_fragile(self, v as VertexId) {
                self.stars[v].to[FRAGILE] |= MARK;
            }
        }
    }

    /// The first star of a vertex.
    #[inline(always)]
    pub fn star(&self, vertex: VertexId) -> &Star {
        &self.stars[vertex as usize]
    }

    /// The star after this one, if there are more neighbours.
    #[inline(always)]
    pub fn after(&self, star: &Star) -> Option<&Star> {
        star.is_crowded()
            .then(|| &self.more[usize::from(star.left[LAST])])
    }

    /// A star and those after it.
    #[inline(always)]
    pub fn stars_from<'a>(&'a self, star: &'a Star) -> impl Iterator<Item = &'a Star> + Clone {
        iter::successors(Some(star), |star| self.after(star))
    }

    #[inline(always)]
    fn stars(&self, vertex: VertexId) -> impl Iterator<Item = &Star> + Clone {
        self.stars_from(self.star(vertex))
    }

    /// The star with this place, and the place in it; there may be neither vertex nor place.
    #[inline(always)]
    fn find(&self, vertex: VertexId, mut place: usize) -> Option<(&Star, usize)> {
        let mut star = self.stars.get(vertex as usize)?;
        while place >= LAST
            && let Some(after) = self.after(star)
        {
            star = after;
            place -= LAST;
        }
        (place < STAR).then_some((star, place))
    }

    /// The neighbour in a place.
    #[inline(always)]
    pub fn neighbor(&self, vertex: VertexId, place: usize) -> Option<VertexId> {
        let (star, place) = self.find(vertex, place)?;
        Some((star.to[place] & !MARK).into())
    }

    /// The neighbours of a vertex; the first may be repeated.
    #[inline]
    pub fn neighbors(&self, vertex: VertexId) -> impl Iterator<Item = u16> {
        self.stars(vertex).flat_map(Star::to)
    }

    /// The same in fours.
    #[inline]
    pub fn neighbors_in_fours(&self, vertex: VertexId) -> impl Iterator<Item = [VertexId; 4]> {
        self.stars(vertex).flat_map(|star| {
            let [a, b, c, d, e, f, g, h] = star.to();
            [[a, b, c, d], [e, f, g, h]].map(|four| four.map(VertexId::from))
        })
    }

    /// The faces around a vertex, some of them more than once.
    #[inline]
    pub fn faces_at(&self, vertex: VertexId) -> impl Iterator<Item = [u16; STAR]> + Clone {
        self.stars(vertex).map(Star::left)
    }

    /// The name of an edge, the same for both directions.
    pub fn edge_id(&self, from: VertexId, to: VertexId) -> Option<u32> {
        Some(edge_at(from.min(to), self.edge_place(from, to)?))
    }

    /// What the name of an edge has beside its lower vertex: its first place there. All are looked
    /// at: where a search would end is not predictable.
    #[inline]
    pub fn edge_place(&self, from: VertexId, to: VertexId) -> Option<u16> {
        const NONE: usize = usize::MAX;
        let (low, high) = (from.min(to), from.max(to));
        let mut place = NONE;
        for (s, star) in self.stars(low).enumerate() {
            for (i, w) in star.to().into_iter().enumerate() {
                let is_first = (VertexId::from(w) == high) & (place == NONE);
                place = if is_first { s * LAST + i } else { place };
            }
        }
        (place != NONE).then_some(place as u16)
    }

    /// The end vertices of an edge.
    #[inline]
    pub fn edge(&self, id: u32) -> Option<[VertexId; 2]> {
        let (from, place) = split(id);
        Some([from, self.neighbor(from, place)?])
    }

    /// The faces on both sides of an edge.
    #[inline]
    pub fn faces_beside(&self, id: u32) -> Option<[u16; 2]> {
        let (from, place) = split(id);
        let left = |place| self.find(from, place).map(|(star, place)| star.left[place]);
        Some([left(place)?, left(place + 1).or_else(|| left(0))?])
    }

    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.stars) + size_of_val(&*self.more)
    }
}

/// The lower vertex of an edge, and its place there.
#[inline]
fn split(id: u32) -> (VertexId, usize) {
    (id >> PLACE_BITS, (id & ((1 << PLACE_BITS) - 1)) as usize)
}

/// The name of an edge from its lower vertex and its place there.
#[inline]
pub(super) fn edge_at(low: VertexId, place: u16) -> u32 {
    low << PLACE_BITS | u32::from(place)
}

#[cfg(test)]
mod tests {
    use std::f32::consts::TAU;

    use glam::Vec3;

    use super::*;
    use crate::Hull;
    use crate::support::{FaceId, Polytope};

    /// A pyramid over a regular polygon: its top has as many neighbours as that has sides.
    fn pyramid(sides: usize) -> Hull {
        let corner = |i: usize| {
            let (sin, cos) = (TAU * i as f32 / sides as f32).sin_cos();
            Vec3::new(cos, 0.0, sin)
        };
        let points: Vec<Vec3> = (0..sides).map(corner).chain([Vec3::Y]).collect();
        Hull::from_points(&points).expect("a solid pyramid")
    }

    #[test]
    fn edges_and_faces_are_found_around_vertices_with_any_number_of_neighbors() {
        for sides in (3..40).chain([200]) {
            let hull = pyramid(sides);
            let vertices = 0..hull.points().len() as VertexId;
            let top = vertices.clone().find(|&v| hull.vertex(v).y > 0.5);
            let top = top.expect("a pyramid has a top");
            let mut around: Vec<u16> = hull.graph.neighbors(top).collect();
            around.sort_unstable();
            around.dedup();
            assert_eq!(around.len(), sides);
            for v in vertices {
                let mut faces: Vec<u16> = hull.graph.faces_at(v).flatten().collect();
                faces.sort_unstable();
                faces.dedup();
                let has = |f: &u16, v| {
                    let f = FaceId::from(*f);
                    (0..hull.face_len(f)).any(|i| hull.face_vertex(f, i) == v)
                };
                let all: Vec<u16> = (0..hull.face_count() as u16)
                    .filter(|f| has(f, v))
                    .collect();
                assert_eq!(faces, all, "{sides} sides, around {v}");
                for w in hull.graph.neighbors(v).map(VertexId::from) {
                    let id = hull.edge_id(v, w).expect("neighbours have an edge");
                    assert_eq!(hull.edge(id), Some([v.min(w), v.max(w)]));
                    let mut beside = hull.graph.faces_beside(id).expect("an edge has faces");
                    beside.sort_unstable();
                    let both: Vec<u16> = all.iter().copied().filter(|f| has(f, w)).collect();
                    assert!(both == beside || beside[0] == beside[1] && both.contains(&beside[0]));
                }
            }
            let beyond = hull.points().len() + STAR;
            assert_eq!(hull.graph.neighbor(top, beyond), None);
            assert_eq!(hull.graph.neighbor(beyond as VertexId, 0), None);
        }
    }
}
