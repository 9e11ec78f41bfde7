//! Recognises the polyhedron from which a hull was built.

use glam::Vec3;
use parry3d::shape::ConvexPolyhedron;

use crate::at::At;
use crate::mix::mix;

/// A hash of the points of a polyhedron. Polyhedra with the same points seldom have other edges.
pub(crate) fn fingerprint(polyhedron: &ConvexPolyhedron) -> u64 {
    let add = |hash: u64, words: [u32; 2]| {
        let [low, high] = words.map(u64::from);
        mix(hash ^ low ^ high << 32)
    };
    let coordinates = bytemuck::cast_slice::<Vec3, u32>(polyhedron.points());
    let (pairs, rest) = coordinates.as_chunks();
    let last = rest.first().map(|&bits| [bits, 0]);
    pairs.iter().copied().chain(last).fold(0, add)
}

/// The edges that a hull depends on besides its points: their ids and their ends.
///
/// Edges across which the surface bends are in every triangulation of the points. The others could have been
/// the other diagonal of their two triangles.
#[derive(Debug, Default)]
pub(crate) struct Diagonals(Box<[(u32, [u32; 2])]>);

impl Diagonals {
    pub(super) fn of(polyhedron: &ConvexPolyhedron, ids: impl Iterator<Item = u32>) -> Self {
        let ends = |id: u32| polyhedron.edges().at(id).vertices;
        Self(ids.map(|id| (id, ends(id))).collect())
    }

    pub(super) fn all(polyhedron: &ConvexPolyhedron) -> Self {
        Self::of(polyhedron, 0..polyhedron.edges().short_len())
    }

    /// Whether a polyhedron with the same points has the same hull.
    #[inline]
    pub fn are_of(&self, polyhedron: &ConvexPolyhedron) -> bool {
        self.0.is_empty() || self.are_among_edges_of(polyhedron)
    }

    #[inline(never)]
    fn are_among_edges_of(&self, polyhedron: &ConvexPolyhedron) -> bool {
        let edges = polyhedron.edges();
        self.0.iter().all(|&(id, ends)| {
            let edge = edges.try_at(id);
            edge.is_some_and(|edge| edge.vertices == ends)
        })
    }

    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.0)
    }
}

/// Whether two polyhedra have the same points and edges, so that their hulls are the same.
pub(crate) fn same_polyhedron(a: &ConvexPolyhedron, b: &ConvexPolyhedron) -> bool {
    let [edges_a, edges_b] = [a, b].map(|p| p.edges().iter().map(|edge| edge.vertices));
    same_points(a.points(), b.points()) && edges_a.eq(edges_b)
}

/// Whether two lists of points are bitwise equal, in one comparison of memory.
#[inline]
pub(crate) fn same_points(a: &[Vec3], b: &[Vec3]) -> bool {
    bytemuck::cast_slice::<Vec3, u8>(a) == bytemuck::cast_slice::<Vec3, u8>(b)
}
