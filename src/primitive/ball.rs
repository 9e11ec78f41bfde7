//! A ball: a point with a border.

use glam::DVec3;

use super::rolling::turns;
use crate::stats::Cost;
use crate::support::{
    EdgeId, FaceCorners, FaceId, Polytope, ShapeId, ShapeKind, Support, VertexId,
};

/// The core of a ball around its origin: a point. The radius is a border, which is subtracted from the
/// distance of the cores.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    radius: f64,
}

impl Ball {
    /// A ball of this radius.
    pub fn new(radius: f64) -> Self {
        Self { radius }
    }

    /// The width of the border around the core.
    pub fn border_radius(&self) -> f64 {
        self.radius
    }
}

impl Support for Ball {
    #[inline]
    fn support(&self, _: DVec3, _: VertexId, cost: &mut Cost) -> (DVec3, VertexId) {
        cost.supports += 1;
        (DVec3::ZERO, VertexId::default())
    }

    #[inline]
    fn rolls(&self, from: DVec3, to: DVec3) -> bool {
        turns(from, to)
    }

    #[inline]
    fn id(&self) -> Option<ShapeId> {
        Some(ShapeId::described_by(ShapeKind::Ball, [self.radius]))
    }

    /// The radius of the border: a point has no length to which a tolerance could be relative.
    #[inline]
    fn radius(&self) -> f64 {
        self.radius
    }
}

/// The core: one vertex, which is also a face without a plane.
impl Polytope for Ball {
    #[inline]
    fn vertex(&self, _: VertexId) -> DVec3 {
        DVec3::ZERO
    }

    #[inline]
    fn neighbors(&self, _: VertexId) -> impl Iterator<Item = VertexId> {
        std::iter::empty()
    }

    #[inline]
    fn has_face(&self, face: FaceId) -> bool {
        face == FaceId::default()
    }

    #[inline]
    fn face_normal(&self, _: FaceId) -> DVec3 {
        DVec3::ZERO
    }

    #[inline]
    fn face_offset(&self, _: FaceId) -> f64 {
        f64::INFINITY
    }

    #[inline]
    fn face_len(&self, _: FaceId) -> usize {
        1
    }

    #[inline]
    fn face_vertex(&self, _: FaceId, _: usize) -> VertexId {
        VertexId::default()
    }

    #[inline]
    fn face_corners(&self, face: FaceId) -> impl FaceCorners {
        (self, face)
    }

    #[inline]
    fn face_at_vertex(&self, _: VertexId, _: DVec3) -> FaceId {
        FaceId::default()
    }

    #[inline]
    fn face_at_edge(&self, _: EdgeId, _: DVec3) -> FaceId {
        FaceId::default()
    }

    #[inline]
    fn edge_between(&self, _: VertexId, _: VertexId) -> Option<EdgeId> {
        None
    }

    #[inline]
    fn edge_ends(&self, _: EdgeId) -> Option<[VertexId; 2]> {
        None
    }
}
