//! Shapes as the kernels see them: extreme points with vertex ids, and the faces of polytopes.

mod cso_vertex;

use std::{cmp::Ordering, iter};

use glam::DVec3;

pub use self::cso_vertex::CsoVertex;
pub use crate::corners::{FaceCorners, FacePoints};
pub(crate) use crate::ids::ShapeKind;
pub use crate::ids::{EdgeId, FaceId, ShapeId, VertexId};
use crate::oriented_box::OrientedBox;
use crate::pose::RelativePose;
use crate::stats::Cost;

/// A convex shape as its support mapping, in its own frame.
pub trait Support {
    /// A point that is extreme in direction `dir` (of any length), and its vertex.
    ///
    /// `start` is the vertex where the search begins, usually the answer of a similar query. A bad choice
    /// costs time, never accuracy.
    ///
    /// # Panics
    ///
    /// May panic if the shape has no vertex `start`: see [`clamp_vertex`](Self::clamp_vertex).
    fn support(&self, dir: DVec3, start: VertexId, cost: &mut Cost) -> (DVec3, VertexId);

    /// The greatest `dir · p` over the shape. This is exact even on a surface that rounding has dented, where
    /// [`support`](Self::support) may find a vertex that is only nearly extreme.
    #[inline]
    fn extent(&self, dir: DVec3) -> f64 {
        let start = self.start_vertex(dir);
        let (extreme, _) = self.support(dir, start, &mut Cost::default());
        dir.dot(extreme)
    }

    /// A start vertex for [`support`](Self::support) if no similar query is known.
    #[inline]
    fn start_vertex(&self, _dir: DVec3) -> VertexId {
        VertexId::default()
    }

    /// `vertex` if the shape has it, and some other vertex if not.
    #[inline]
    fn clamp_vertex(&self, _vertex: VertexId) -> VertexId {
        VertexId::default()
    }

    /// An upper bound of the greatest `dir · p` over the shape, for about a unit vector `dir`. It is close where
    /// there is one that costs less than a support point.
    fn extent_bound(&self, dir: DVec3, cost: &mut Cost) -> Option<f64> {
        let _ = (dir, cost);
        None
    }

    /// How far the shape may reach beyond a support point, if that is rounded to f32.
    fn rounding(&self) -> f64 {
        0.0
    }

    /// Whether contacts roll over a round surface if their outward unit normal turns from one to another.
    #[inline]
    fn rolls(&self, _from: DVec3, _to: DVec3) -> bool {
        false
    }

    /// Tells the shape from all others, if it has such an id.
    #[doc(hidden)]
    fn id(&self) -> Option<ShapeId> {
        None
    }

    /// A point inside, and not on the boundary if the shape has volume.
    #[inline]
    fn center(&self) -> DVec3 {
        DVec3::ZERO
    }

    /// The largest distance of a point from [`center`](Self::center).
    fn radius(&self) -> f64;
}

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

    /// The planes of all faces, if they are at hand.
    fn face_planes(&self) -> Option<&crate::face_planes::FacePlanes> {
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

/// The Minkowski difference of shape 1 and shape 2 (the configuration space obstacle). It is never built, and
/// only its extreme points are computed. Everything is in frame 1.
pub struct Cso<'a, A, B> {
    /// Shape 1.
    pub shape_1: &'a A,
    /// Shape 2.
    pub shape_2: &'a B,
    /// The pose of shape 2.
    pub pose: &'a RelativePose,
}

impl<A: Support, B: Support> Cso<'_, A, B> {
    /// Whether one of the shapes rolls over the other if their outward normals, each in its own frame, turn.
    #[inline]
    pub fn rolls(&self, from: [DVec3; 2], to: [DVec3; 2]) -> bool {
        self.shape_1.rolls(from[0], to[0]) || self.shape_2.rolls(from[1], to[1])
    }

    /// A point that is extreme in direction `dir`. The two climbs begin at `start`.
    #[inline(always)]
    pub fn support(&self, dir: DVec3, start: [VertexId; 2], cost: &mut Cost) -> CsoVertex {
        let (on_1, id_1) = self.shape_1.support(dir, start[0], cost);
        let (on_2, id_2) = self.support_2(dir, start[1], cost);
        CsoVertex {
            w: on_1 - on_2,
            on_1,
            ids: [id_1, id_2],
        }
    }

    /// The point of shape 2 that makes the difference extreme in direction `dir`, in frame 1.
    #[inline(always)]
    pub fn support_2(&self, dir: DVec3, start: VertexId, cost: &mut Cost) -> (DVec3, VertexId) {
        let dir = -self.pose.direction_to_2(dir);
        let (on_2, id_2) = self.shape_2.support(dir, start, cost);
        (self.pose.point_to_1(on_2), id_2)
    }

    /// The difference of two vertices.
    #[inline(always)]
    pub fn vertex(&self, ids: [VertexId; 2]) -> CsoVertex
    where
        A: Polytope,
        B: Polytope,
    {
        let on_1 = self.shape_1.vertex(ids[0]);
        CsoVertex {
            w: on_1 - self.pose.point_to_1(self.shape_2.vertex(ids[1])),
            on_1,
            ids,
        }
    }

    /// Start vertices for direction `dir` if no similar query is known.
    pub fn start_vertices(&self, dir: DVec3) -> [VertexId; 2] {
        [
            self.shape_1.start_vertex(dir),
            self.shape_2.start_vertex(-self.pose.direction_to_2(dir)),
        ]
    }

    /// The vertices if the shapes have them, and others if not.
    #[inline]
    pub fn clamp_vertices(&self, [id_1, id_2]: [VertexId; 2]) -> [VertexId; 2] {
        [
            self.shape_1.clamp_vertex(id_1),
            self.shape_2.clamp_vertex(id_2),
        ]
    }

    /// The extreme vertex from the centre towards the origin: the first vertex of a cold search. If the
    /// shapes are round, they are nearest there.
    pub fn vertex_towards_origin(&self, cost: &mut Cost) -> CsoVertex {
        let dir = self.towards_origin();
        self.support(dir, self.start_vertices(dir), cost)
    }

    /// The unit direction from the centre to the origin, that is, from the centre of shape 1 to the centre of
    /// shape 2; some direction if these coincide.
    pub fn towards_origin(&self) -> DVec3 {
        (-self.center()).normalize_or(DVec3::X)
    }

    /// The centre as a CSO vertex. It is no real vertex: `ids` are only hints for where climbs may start.
    pub fn center_as_vertex(&self, ids: [VertexId; 2]) -> CsoVertex {
        CsoVertex {
            w: self.center(),
            on_1: self.shape_1.center(),
            ids,
        }
    }

    /// A point inside: the difference of the two centres, in frame 1.
    #[inline]
    pub fn center(&self) -> DVec3 {
        self.shape_1.center() - self.pose.point_to_1(self.shape_2.center())
    }

    /// The direction between the centres and the distance of the bounding spheres, if that is more than
    /// `beyond`.
    #[inline(always)]
    pub fn spheres_apart(&self, beyond: f64) -> Option<(DVec3, f64)> {
        self.are_spheres_apart(beyond).then(|| {
            let offset = -self.center();
            let distance = offset.length();
            (offset / distance, distance - self.size())
        })
    }

    /// Whether the bounding spheres are apart by more than `beyond`.
    #[inline(always)]
    pub fn are_spheres_apart(&self, beyond: f64) -> bool {
        let reach = self.size() + beyond;
        let squared = self.center().length_squared();
        reach >= 0.0 && squared.partial_cmp(&(reach * reach)) == Some(Ordering::Greater)
    }

    /// The length to which tolerances of the whole pair are relative.
    #[inline]
    pub fn size(&self) -> f64 {
        self.shape_1.radius() + self.shape_2.radius()
    }

    /// The length to which tolerances are relative where the accuracy of the smaller shape matters.
    #[inline]
    pub fn min_radius(&self) -> f64 {
        self.shape_1.radius().min(self.shape_2.radius())
    }
}
