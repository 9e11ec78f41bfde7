//! Convex hulls prepared for coherent queries: the edge graph, the faces, and a search for extreme vertices.
//! Large hulls are climbed from a start-vertex table, small ones are scanned.

pub(crate) mod build;
mod climb;
mod cluster_growth;
mod clusters;
mod convex_outline;
mod error;
mod faces;
mod graph;
mod lists;
mod rolling;
mod scan;
mod search;
mod start_table;

pub(crate) use build::solid::{bends_everywhere, surface_of_points};
pub use error::HullError;

use glam::{DVec3, Vec3};

use crate::face_planes::FacePlanes;
use crate::oriented_box::OrientedBox;
use crate::stats::Cost;
use crate::support::{
    EdgeId, FaceCorners, FaceId, FacePoints, Polytope, ShapeId, Support, VertexId,
};
use climb::HillClimb;
use cluster_growth::grow_clusters;
use faces::{Faces, PolygonCorners};
use graph::EdgeGraph;
use rolling::rolls_over_faces;
use search::SupportSearch;

/// A convex polytope, with everything that a query needs precomputed. A [`HullShape`](crate::HullShape) makes a collider
/// of it. Lengths are in the units of the points it was built from, positions in their frame.
// Most pairs are proved apart by the bounding sphere, and by the pointers to points and neighbours. This
// order and alignment puts these on one cache line.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Hull {
    center: DVec3,
    radius: f64,
    points: Box<[Vec3]>,
    graph: EdgeGraph,
    faces: Faces,
    search: SupportSearch,
    id: ShapeId,
    /// If it is a box.
    oriented_box: Option<Box<OrientedBox>>,
}

impl Hull {
    /// The vertices, in the order of their ids.
    pub fn points(&self) -> &[Vec3] {
        &self.points
    }

    /// The number of faces, after coplanar triangles were merged.
    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// The ids of all vertices.
    pub fn vertex_ids(&self) -> impl ExactSizeIterator<Item = VertexId> + Clone + use<> {
        (0..self.points.len()).map(VertexId::new)
    }

    /// The ids of all faces.
    pub fn face_ids(&self) -> impl ExactSizeIterator<Item = FaceId> + Clone + use<> {
        (0..self.face_count()).map(FaceId::new)
    }

    /// The heap memory in bytes. A surface of triangles, with six around each vertex, takes 118 bytes per
    /// vertex: 12 for the point, 32 for the neighbours and the faces between them, 48 for the planes of two
    /// faces, 24 for their corners and edges, and 2 for the start table. A vertex with more than eight
    /// neighbours takes 32 more. Merged faces take less. Hulls that are scanned need 12 bytes per vertex
    /// instead of the start table. From the first contact where faces lie nearly in one plane on, clusters take
    /// some 20 bytes per vertex more.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.points)
            + self.search.heap_bytes()
            + self.graph.heap_bytes()
            + self.faces.heap_bytes()
            + self.oriented_box.as_deref().map_or(0, size_of_val)
    }

    /// The extreme vertices in many directions. All climbs take their first step together: its memory is not
    /// in the cache yet, so the processor waits once for all of them.
    pub(crate) fn extreme_vertices<const N: usize>(&self, dirs: [DVec3; N]) -> [VertexId; N] {
        match &self.search {
            SupportSearch::Scan(scan) => {
                dirs.map(|dir| scan.extreme_vertex(&self.points, dir, VertexId::default()))
            }
            SupportSearch::Climb(start) => {
                let starts = dirs.map(|dir| start.lookup(dir));
                climb::extreme_vertices(self.climb(), dirs, starts)
            }
        }
    }

    #[inline(always)]
    fn climb(&self) -> HillClimb<'_> {
        HillClimb {
            points: &self.points,
            graph: &self.graph,
            center: self.center,
            radius: self.radius,
        }
    }

    /// The extreme vertex in a direction. Its coordinates are separate arguments, so that they stay in
    /// registers: a vector that is written one coordinate at a time and read in pairs stalls on store
    /// forwarding.
    #[inline(never)]
    fn extreme_vertex(&self, x: f64, y: f64, z: f64, start: VertexId, cost: &mut Cost) -> VertexId {
        debug_assert!(start.index() < self.points.len(), "no vertex: {start}");
        match &self.search {
            SupportSearch::Scan(scan) => {
                scan.extreme_vertex(&self.points, DVec3::new(x, y, z), start)
            }
            SupportSearch::Climb(_) => self.climb_from(start, x, y, z, cost),
        }
    }

    /// A function of its own: what it needs on the stack would cost a scan a third of its time.
    #[inline(never)]
    fn climb_from(&self, start: VertexId, x: f64, y: f64, z: f64, cost: &mut Cost) -> VertexId {
        climb::extreme_vertex(self.climb(), DVec3::new(x, y, z), start, cost)
    }
}

impl Support for Hull {
    #[inline(always)]
    fn support(&self, dir: DVec3, start: VertexId, cost: &mut Cost) -> (DVec3, VertexId) {
        cost.supports += 1;
        let vertex = self.extreme_vertex(dir.x, dir.y, dir.z, start, cost);
        (self.vertex(vertex), vertex)
    }

    fn extent(&self, dir: DVec3) -> f64 {
        let extents = self.points.iter().map(|point| dir.dot(point.as_dvec3()));
        extents.fold(f64::NEG_INFINITY, f64::max)
    }

    #[inline]
    fn extent_bound(&self, dir: DVec3, cost: &mut Cost) -> Option<f64> {
        let SupportSearch::Scan(scan) = &self.search else {
            return None;
        };
        cost.supports += 1;
        Some(dir.dot(self.center) + self.radius * scan.greatest_height(dir))
    }

    #[inline]
    fn rolls(&self, from: DVec3, to: DVec3) -> bool {
        self.may_roll() && rolls_over_faces(self, from, to)
    }

    #[inline]
    fn may_roll(&self) -> bool {
        self.faces.has_many_quads
    }

    #[inline]
    fn id(&self) -> Option<ShapeId> {
        Some(self.id)
    }

    #[inline]
    fn start_vertex(&self, dir: DVec3) -> VertexId {
        self.search.start_vertex(dir)
    }

    #[inline]
    fn clamp_vertex(&self, vertex: VertexId) -> VertexId {
        if vertex.index() < self.points.len() {
            vertex
        } else {
            VertexId::default()
        }
    }

    #[inline]
    fn center(&self) -> DVec3 {
        self.center
    }

    #[inline]
    fn radius(&self) -> f64 {
        self.radius
    }
}

impl Polytope for Hull {
    #[inline]
    fn vertex(&self, vertex: VertexId) -> DVec3 {
        self.points[vertex.index()].as_dvec3()
    }

    /// The neighbours on the triangulated surface; the first may be repeated.
    #[inline]
    fn neighbors(&self, vertex: VertexId) -> impl Iterator<Item = VertexId> {
        self.graph.neighbors(vertex).map(VertexId::from)
    }

    #[inline]
    fn neighbors_in_fours(&self, vertex: VertexId) -> impl Iterator<Item = [VertexId; 4]> {
        self.graph.neighbors_in_fours(vertex)
    }

    #[inline]
    fn has_face(&self, face: FaceId) -> bool {
        face.index() < self.faces.len()
    }

    #[inline]
    fn face_normal(&self, face: FaceId) -> DVec3 {
        self.faces.normal(face)
    }

    #[inline]
    fn face_offset(&self, face: FaceId) -> f64 {
        self.faces.offset(face)
    }

    #[inline]
    fn face_len(&self, face: FaceId) -> usize {
        self.faces.polygon(face).len()
    }

    #[inline]
    fn face_vertex(&self, face: FaceId, i: usize) -> VertexId {
        self.faces.polygon(face)[i].vertex.into()
    }

    #[inline]
    fn face_corners(&self, face: FaceId) -> impl FaceCorners {
        PolygonCorners {
            points: &self.points,
            corners: self.faces.polygon(face),
        }
    }

    #[inline]
    fn face_planes(&self) -> Option<&FacePlanes> {
        Some(self.faces.planes())
    }

    #[inline]
    fn oriented_box(&self) -> Option<&OrientedBox> {
        self.oriented_box.as_deref()
    }

    #[inline]
    fn face_points(&self, face: FaceId) -> impl FacePoints {
        let corners = self.faces.polygon(face).iter();
        corners.map(|corner| self.vertex(corner.vertex.into()))
    }

    #[inline]
    fn face_at_vertex(&self, vertex: VertexId, dir: DVec3) -> FaceId {
        self.faces
            .most_aligned(self.graph.faces_around(vertex), dir)
    }

    #[inline]
    fn face_at_edge(&self, edge: EdgeId, dir: DVec3) -> FaceId {
        match self.graph.faces_of_edge(edge) {
            Some(pair) => self.faces.most_aligned([pair], dir),
            None => self.face_at_vertex(VertexId::default(), dir),
        }
    }

    #[inline]
    fn edge_between(&self, from: VertexId, to: VertexId) -> Option<EdgeId> {
        self.graph.edge_between(from, to)
    }

    #[inline]
    fn face_edge(&self, face: FaceId, i: usize) -> Option<EdgeId> {
        self.faces.edge(face, i)
    }

    #[inline]
    fn cluster(&self, face: FaceId) -> Option<(FaceId, &[u16])> {
        let grow = || Box::new(grow_clusters(&self.points, &self.faces, &self.graph));
        self.faces.cluster(face, grow)
    }

    #[inline]
    fn edge_ends(&self, edge: EdgeId) -> Option<[VertexId; 2]> {
        self.graph.edge_ends(edge)
    }
}
