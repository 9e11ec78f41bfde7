//! A triangle as a flat polytope with two faces.

use glam::DVec3;

use crate::stats::Cost;
use crate::support::{
    EdgeId, FaceCorners, FaceId, Polytope, ShapeId, ShapeKind, Support, VertexId,
};

/// A triangle. Face 0 is seen counter-clockwise, face 1 is its back.
#[derive(Clone, Copy, Debug)]
pub struct TrianglePolytope {
    vertices: [DVec3; 3],
    normal: DVec3,
    center: DVec3,
    radius: f64,
}

impl TrianglePolytope {
    /// A triangle with these corners; `None` if they lie on a line or are not finite.
    pub fn new(vertices: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = vertices;
        let normal = (b - a).cross(c - a).try_normalize()?;
        let center = (a + b + c) / 3.0;
        let [a, b, c] = vertices.map(|v| v.distance_squared(center));
        Some(Self {
            vertices,
            normal,
            center,
            radius: a.max(b).max(c).sqrt(),
        })
    }
}

impl Support for TrianglePolytope {
    #[inline]
    fn support(&self, dir: DVec3, start: VertexId, cost: &mut Cost) -> (DVec3, VertexId) {
        cost.supports += 1;
        let mut best = start.index();
        let mut value = dir.dot(self.vertices[best]);
        for (i, v) in self.vertices.iter().enumerate() {
            let d = dir.dot(*v);
            if d > value {
                value = d;
                best = i;
            }
        }
        (self.vertices[best], VertexId::new(best))
    }

    #[inline]
    fn clamp_vertex(&self, vertex: VertexId) -> VertexId {
        if vertex.index() < 3 {
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
    fn may_roll(&self) -> bool {
        false
    }

    #[inline]
    fn id(&self) -> Option<ShapeId> {
        let [a, b, c] = self.vertices;
        let numbers = [a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z];
        Some(ShapeId::described_by(ShapeKind::Triangle, numbers))
    }

    #[inline]
    fn radius(&self) -> f64 {
        self.radius
    }
}

impl Polytope for TrianglePolytope {
    #[inline]
    fn vertex(&self, vertex: VertexId) -> DVec3 {
        self.vertices[vertex.index()]
    }

    #[inline]
    fn neighbors(&self, vertex: VertexId) -> impl Iterator<Item = VertexId> {
        (1..3).map(move |k| VertexId::new((vertex.index() + k) % 3))
    }

    #[inline]
    fn has_face(&self, face: FaceId) -> bool {
        face.index() < 2
    }

    #[inline]
    fn face_normal(&self, face: FaceId) -> DVec3 {
        if face.index() == 0 {
            self.normal
        } else {
            -self.normal
        }
    }

    #[inline]
    fn face_offset(&self, face: FaceId) -> f64 {
        let normal = self.face_normal(face);
        let [a, b, c] = self.vertices.map(|v| normal.dot(v));
        a.max(b).max(c)
    }

    #[inline]
    fn face_len(&self, _: FaceId) -> usize {
        3
    }

    #[inline]
    fn face_vertex(&self, face: FaceId, i: usize) -> VertexId {
        VertexId::new(if face.index() == 0 { i } else { 2 - i })
    }

    #[inline]
    fn face_corners(&self, face: FaceId) -> impl FaceCorners {
        (self, face)
    }

    #[inline]
    fn face_at_vertex(&self, _: VertexId, dir: DVec3) -> FaceId {
        FaceId::new(usize::from(self.normal.dot(dir) < 0.0))
    }

    #[inline]
    fn face_at_edge(&self, _: EdgeId, dir: DVec3) -> FaceId {
        self.face_at_vertex(VertexId::default(), dir)
    }

    #[inline]
    fn edge_between(&self, from: VertexId, to: VertexId) -> Option<EdgeId> {
        let (low, high) = (from.min(to).index(), from.max(to).index());
        (low < high && high < 3).then(|| EdgeId::new(low << 2 | high))
    }

    #[inline]
    fn edge_ends(&self, edge: EdgeId) -> Option<[VertexId; 2]> {
        let ends = [edge.index() >> 2, edge.index() & 3].map(VertexId::new);
        (self.edge_between(ends[0], ends[1]) == Some(edge)).then_some(ends)
    }
}
