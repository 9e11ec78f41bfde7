//! The faces and edges of a shape.

use std::iter;

use glam::DVec3;

use super::mapping::Support;
use crate::corners::{FaceCorners, FacePoints};
use crate::face_planes::FacePlanes;
use crate::ids::{EdgeId, FaceId, VertexId};
use crate::oriented_box::OrientedBox;

/// A convex polytope: a support mapping with faces and edges around it.
///
/// The methods may panic for vertices and faces that do not exist ([`has_face`](Self::has_face)). Edges are
/// checked.
pub trait Polytope: Support {
    /// The position of a vertex.
    fn vertex(&self, vertex: VertexId) -> DVec3;

    /// The neighbours of a vertex along edges. Some may occur more than once.
    fn neighbors(&self, vertex: VertexId) -> impl Iterator<Item = VertexId>;

    /// The neighbours, four at a time.
    #[inline]
    fn neighbors_in_fours(&self, vertex: VertexId) -> impl Iterator<Item = [VertexId; 4]> {
        let mut neighbors = self.neighbors(vertex);
        iter::from_fn(move || {
            let first = neighbors.next()?;
            let mut next = || neighbors.next().unwrap_or(first);
            Some([first, next(), next(), next()])
        })
    }

    /// Whether the face exists.
    fn has_face(&self, face: FaceId) -> bool;

    /// The outward unit normal of a face. It is zero for a sliver, whose plane is unreliable, and for the
    /// only face of a point or a segment.
    fn face_normal(&self, face: FaceId) -> DVec3;

    /// The largest `normal · p` over the shape.
    fn face_offset(&self, face: FaceId) -> f64;

    /// The number of vertices around a face.
    fn face_len(&self, face: FaceId) -> usize;

    /// The `i`-th vertex of a face, counter-clockwise seen from outside.
    fn face_vertex(&self, face: FaceId, i: usize) -> VertexId;

    /// The corners of a face by their numbers: for more than one, this is a single look-up.
    fn face_corners(&self, face: FaceId) -> impl FaceCorners;

    /// How far inside a face a point of its plane is, negative outside, if this costs less than a look at its
    /// corners.
    fn face_inset(&self, _face: FaceId, _p: DVec3) -> Option<f64> {
        None
    }

    /// How far a line from a point of the shape goes along a unit vector until it is `width` away from the shape, if
    /// this costs less than a look at its faces.
    fn height_of_border(&self, _point: DVec3, _dir: DVec3, _width: f64) -> Option<f64> {
        None
    }

    /// The planes of all faces, if they are at hand.
    fn face_planes(&self) -> Option<&FacePlanes> {
        None
    }

    /// The box that the shape is, if it is known to be one.
    fn oriented_box(&self) -> Option<&OrientedBox> {
        None
    }

    /// The corners of a face, counter-clockwise seen from outside.
    fn face_points(&self, face: FaceId) -> impl FacePoints {
        (0..self.face_len(face)).map(move |i| self.vertex(self.face_vertex(face, i)))
    }

    /// The face at `vertex` whose normal is nearest to `dir`.
    fn face_at_vertex(&self, vertex: VertexId, dir: DVec3) -> FaceId;

    /// The face at an edge whose normal is nearest to `dir`; some face if there is no such edge.
    fn face_at_edge(&self, edge: EdgeId, dir: DVec3) -> FaceId;

    /// The id of the edge between two neighbouring vertices.
    fn edge_between(&self, from: VertexId, to: VertexId) -> Option<EdgeId>;

    /// The id of the edge from the `i`-th vertex of a face to the next.
    fn face_edge(&self, face: FaceId, i: usize) -> Option<EdgeId> {
        let next = (i + 1) % self.face_len(face);
        self.edge_between(self.face_vertex(face, i), self.face_vertex(face, next))
    }

    /// The cluster of a face, if it has neighbours that lie nearly in its plane: the id of a convex outline
    /// around them all, and the faces under the outline. `face_len`, `face_vertex` and `face_edge` take this
    /// id, although it is not a face.
    fn cluster(&self, _face: FaceId) -> Option<(FaceId, &[u16])> {
        None
    }

    /// The end vertices of an edge.
    fn edge_ends(&self, edge: EdgeId) -> Option<[VertexId; 2]>;
}
