//! A capsule: a segment with a border.

use glam::DVec3;

use super::rolling::turns_about;
use crate::stats::Cost;
use crate::support::{
    EdgeId, FaceCorners, FaceId, Polytope, ShapeId, ShapeKind, Support, VertexId,
};

/// The core of a capsule: the segment along its axis. The radius is a border, which is subtracted from the
/// distance of the cores. The ends have the ids 0 and 1.
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    ends: [DVec3; 2],
    border_radius: f64,
}

impl Segment {
    /// A segment between two points, the core of a capsule whose radius is `border`.
    pub fn new(ends: [DVec3; 2], border_radius: f64) -> Self {
        Self {
            ends,
            border_radius,
        }
    }

    /// The width of the border around the core.
    pub fn border_radius(&self) -> f64 {
        self.border_radius
    }
}

/// The fraction of the way from `a` to `b` at which it is nearest to a point. Zero if it has no length.
pub(crate) fn nearest_share([a, b]: [DVec3; 2], p: DVec3) -> f64 {
    let along = b - a;
    let length_squared = along.length_squared();
    if length_squared > 0.0 {
        ((p - a).dot(along) / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// How far a line from `p` along the unit vector `dir` goes until it leaves the capsule around a segment; `None` if it
/// misses it, or is parallel to the segment.
pub(crate) fn exit_from_capsule(
    [a, b]: [DVec3; 2],
    radius: f64,
    p: DVec3,
    dir: DVec3,
) -> Option<f64> {
    let length = a.distance(b);
    let along = (b - a).normalize_or_zero();
    let across = |v: DVec3| v - along * v.dot(along);
    let t = exit_from_ball(across(dir), across(p - a), radius)?;
    let place = (p + dir * t - a).dot(along);
    if (0.0..=length).contains(&place) {
        return Some(t);
    }
    // Beyond the side, the line leaves through a round end.
    let end = if place < 0.0 { a } else { b };
    exit_from_ball(dir, p - end, radius)
}

/// The larger `t` at which `from + way * t` is at this distance from the origin.
pub(crate) fn exit_from_ball(way: DVec3, from: DVec3, radius: f64) -> Option<f64> {
    let (a, b) = (way.length_squared(), way.dot(from));
    let discriminant = b * b - a * (from.length_squared() - radius * radius);
    (a > 0.0 && discriminant >= 0.0).then(|| (discriminant.sqrt() - b) / a)
}

impl Support for Segment {
    #[inline]
    fn support(&self, dir: DVec3, start: VertexId, cost: &mut Cost) -> (DVec3, VertexId) {
        cost.supports += 1;
        let [a, b] = self.ends;
        let along = dir.dot(b - a);
        // If both ends tie, it stays: a resting capsule does not swap them.
        let end = match along {
            _ if along > 0.0 => VertexId::new(1),
            _ if along < 0.0 => VertexId::new(0),
            _ => start,
        };
        (self.ends[end.index()], end)
    }

    #[inline]
    fn clamp_vertex(&self, vertex: VertexId) -> VertexId {
        VertexId::new(vertex.index() & 1)
    }

    #[inline]
    fn center(&self) -> DVec3 {
        self.ends[0].midpoint(self.ends[1])
    }

    #[inline]
    fn rolls(&self, from: DVec3, to: DVec3) -> bool {
        turns_about(self.ends[1] - self.ends[0], from, to)
    }

    #[inline]
    fn id(&self) -> Option<ShapeId> {
        let [a, b] = self.ends;
        let numbers = [a.x, a.y, a.z, b.x, b.y, b.z, self.border_radius];
        Some(ShapeId::described_by(ShapeKind::Segment, numbers))
    }

    /// Includes the border: the core alone may be a point, which has no length.
    #[inline]
    fn radius(&self) -> f64 {
        0.5 * self.ends[0].distance(self.ends[1]) + self.border_radius
    }
}

/// The core: one edge, which is also a face without a plane.
impl Polytope for Segment {
    #[inline]
    fn vertex(&self, vertex: VertexId) -> DVec3 {
        self.ends[vertex.index()]
    }

    #[inline]
    fn neighbors(&self, vertex: VertexId) -> impl Iterator<Item = VertexId> {
        std::iter::once(VertexId::new(vertex.index() ^ 1))
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
        2
    }

    #[inline]
    fn face_vertex(&self, _: FaceId, i: usize) -> VertexId {
        VertexId::new(i)
    }

    fn height_of_border(&self, point: DVec3, dir: DVec3, width: f64) -> Option<f64> {
        exit_from_capsule(self.ends, width, point, dir)
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
    fn edge_between(&self, from: VertexId, to: VertexId) -> Option<EdgeId> {
        (from.max(to) == VertexId::new(1) && from != to).then(EdgeId::default)
    }

    #[inline]
    fn edge_ends(&self, edge: EdgeId) -> Option<[VertexId; 2]> {
        (edge == EdgeId::default()).then_some([VertexId::new(0), VertexId::new(1)])
    }
}
