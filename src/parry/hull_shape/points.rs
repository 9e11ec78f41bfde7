//! Support queries and point projections.

use glam::DVec3;
use parry3d::math::{Pose, Vector};
use parry3d::query::{PointProjection, PointQuery};
use parry3d::shape::{FeatureId, SupportMap};
use parry3d::utils::point_cloud_support_point;

use super::HullShape;
use crate::gjk::{self, Outcome};
use crate::hull::Hull;
use crate::pose::RelativePose;
use crate::primitive::Point;
use crate::simplex::Preferred;
use crate::stats::Cost;
use crate::support::{Cso, FaceId, Polytope, Support, VertexId};

/// Up to this many points, a scan in f32, as parry does it, is faster than a climb.
const SCAN_UP_TO: usize = 40;

impl Hull {
    /// The vertex that is extreme in direction `dir`, of any length.
    #[inline]
    pub(super) fn support_vertex(&self, dir: DVec3) -> VertexId {
        self.support(dir, self.start_vertex(dir), &mut Cost::default())
            .1
    }

    /// The position of the vertex that is extreme in direction `dir`.
    #[inline]
    pub(super) fn support_toward(&self, dir: Vector) -> Vector {
        if self.points().len() <= SCAN_UP_TO {
            return point_cloud_support_point(dir, self.points());
        }
        self.points()[self.support_vertex(dir.as_dvec3()).index()]
    }
}

impl HullShape {
    /// The face above whose plane a point is farthest, and how far.
    fn nearest_plane(&self, point: DVec3) -> (FaceId, f64) {
        let hull = self.hull();
        let height = |f| hull.face_normal(f).dot(point) - hull.face_offset(f);
        let none = (FaceId::default(), f64::NEG_INFINITY);
        hull.face_ids()
            .map(|f| (f, height(f)))
            .fold(
                none,
                |best, other| if other.1 > best.1 { other } else { best },
            )
    }

    /// The projection of a point to the boundary, or the point itself if it is inside a `solid` hull. Also
    /// the feature on which the projection lies, if it is on the boundary.
    fn project(&self, point: Vector, solid: bool) -> (PointProjection, FeatureId) {
        let Some(pose) = RelativePose::new(&Pose::from_translation(point)) else {
            return (PointProjection::new(false, point), FeatureId::Unknown);
        };
        let cso = Cso {
            shape_1: self.hull(),
            shape_2: &Point,
            pose: &pose,
        };
        let cost = &mut Cost::default();
        let toward = point.as_dvec3() - cso.shape_1.center();
        let first = cso.support(toward, cso.start_vertices(toward), cost);
        match gjk::distance::<Preferred, _, _>(&cso, &[first], f64::INFINITY, cost) {
            Outcome::Disjoint(closest) => (
                PointProjection::new(false, closest.on_1.as_vec3()),
                self.hull().feature_toward(closest.normal),
            ),
            Outcome::Overlapping(_) if solid => {
                (PointProjection::new(true, point), FeatureId::Unknown)
            }
            // It is never separated: no distance exceeds infinity.
            Outcome::Overlapping(_) | Outcome::Unsure(_) | Outcome::Separated(_) => {
                let (on_face, face) = self.project_to_face(point.as_dvec3());
                (on_face, FeatureId::Face(face.into()))
            }
        }
    }

    /// The projection of an inner point to the boundary: the nearest plane is that of the nearest face.
    fn project_to_face(&self, point: DVec3) -> (PointProjection, FaceId) {
        let (face, height) = self.nearest_plane(point);
        let on_face = point - height * self.hull().face_normal(face);
        (PointProjection::new(height <= 0.0, on_face.as_vec3()), face)
    }
}

impl SupportMap for Hull {
    #[inline]
    fn local_support_point(&self, dir: Vector) -> Vector {
        self.support_toward(dir)
    }
}

impl SupportMap for HullShape {
    #[inline]
    fn local_support_point(&self, dir: Vector) -> Vector {
        self.hull().support_toward(dir)
    }
}

impl PointQuery for HullShape {
    fn project_local_point(&self, point: Vector, solid: bool) -> PointProjection {
        self.project(point, solid).0
    }

    fn project_local_point_and_get_feature(&self, point: Vector) -> (PointProjection, FeatureId) {
        self.project(point, false)
    }
}
