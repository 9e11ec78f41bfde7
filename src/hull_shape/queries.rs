//! Support queries, ray casts and point projections.

use glam::DVec3;
use parry3d::math::{Real, Vector};
use parry3d::query::details::local_point_projection_on_support_map;
use parry3d::query::gjk::VoronoiSimplex;
use parry3d::query::{PointProjection, PointQuery, Ray, RayCast, RayIntersection};
use parry3d::shape::{FeatureId, SupportMap};

use super::HullShape;
use crate::stats::Cost;
use crate::support::{FaceId, Polytope, Support, VertexId};

impl HullShape {
    /// The vertex that is extreme in direction `dir`, of any length.
    #[inline]
    pub(super) fn support_vertex(&self, dir: DVec3) -> VertexId {
        let hull = self.hull();
        hull.support(dir, hull.start(dir), &mut Cost::default()).1
    }

    /// The position of the vertex that is extreme in direction `dir`.
    #[inline]
    pub(super) fn support_toward(&self, dir: Vector) -> Vector {
        self.hull().points()[self.support_vertex(dir.as_dvec3()) as usize]
    }

    /// The face whose plane a point is the farthest above, and how far.
    fn nearest_plane(&self, point: DVec3) -> (FaceId, f64) {
        let hull = self.hull();
        let height = |f| hull.face_normal(f).dot(point) - hull.face_offset(f);
        (0..hull.face_count() as FaceId)
            .map(|f| (f, height(f)))
            .fold((0, f64::NEG_INFINITY), |best, other| {
                if other.1 > best.1 { other } else { best }
            })
    }

    /// A point's projection on the boundary, and the face that it lies on if that is known.
    fn project(&self, point: Vector, solid: bool) -> (PointProjection, Option<FaceId>) {
        let outside =
            local_point_projection_on_support_map(self, &mut VoronoiSimplex::new(), point, true);
        if solid || !outside.is_inside {
            return (outside, None);
        }
        // Inside, the nearest plane is that of the nearest face.
        let (face, height) = self.nearest_plane(point.as_dvec3());
        let lift = -height * self.hull().face_normal(face);
        let on_face = (point.as_dvec3() + lift).as_vec3();
        (PointProjection::new(true, on_face), Some(face))
    }
}

impl SupportMap for HullShape {
    #[inline]
    fn local_support_point(&self, dir: Vector) -> Vector {
        self.support_toward(dir)
    }
}

impl PointQuery for HullShape {
    fn project_local_point(&self, point: Vector, solid: bool) -> PointProjection {
        self.project(point, solid).0
    }

    fn project_local_point_and_get_feature(&self, point: Vector) -> (PointProjection, FeatureId) {
        let (projection, face) = self.project(point, false);
        let feature = match (face, (point - projection.point).try_normalize()) {
            (Some(face), _) => FeatureId::Face(face),
            (None, Some(dir)) => self.feature_toward(dir.as_dvec3()),
            (None, None) => FeatureId::Unknown,
        };
        (projection, feature)
    }
}

impl RayCast for HullShape {
    /// Cuts the ray by the planes of all faces. From inside of a hull that is not `solid`, the
    /// normal points inwards, as for other shapes.
    fn cast_local_ray_and_get_normal(
        &self,
        ray: &Ray,
        max_time_of_impact: Real,
        solid: bool,
    ) -> Option<RayIntersection> {
        let (entry, exit) = self.cut(ray)?;
        let starts_inside = entry.time <= 0.0;
        if starts_inside && solid {
            return Some(RayIntersection::new(0.0, Vector::ZERO, FeatureId::Unknown));
        }
        let (crossing, side) = if starts_inside {
            (exit, -1.0)
        } else {
            (entry, 1.0)
        };
        let time = crossing.time as Real;
        let normal = (side * self.hull().face_normal(crossing.face)).as_vec3();
        (time <= max_time_of_impact)
            .then(|| RayIntersection::new(time, normal, FeatureId::Face(crossing.face)))
    }
}

/// Where a ray crosses the plane of a face, in multiples of its direction.
#[derive(Clone, Copy)]
struct Crossing {
    time: f64,
    face: FaceId,
}

impl HullShape {
    /// Where a ray's line enters and leaves the hull; `None` if it misses it or lies behind.
    fn cut(&self, ray: &Ray) -> Option<(Crossing, Crossing)> {
        let hull = self.hull();
        let (origin, dir) = (ray.origin.as_dvec3(), ray.dir.as_dvec3());
        let at = |time| Crossing { time, face: 0 };
        let (mut entry, mut exit) = (at(f64::NEG_INFINITY), at(f64::INFINITY));
        for face in 0..hull.face_count() as FaceId {
            let normal = hull.face_normal(face);
            let depth = hull.face_offset(face) - normal.dot(origin);
            let speed = normal.dot(dir);
            let time = depth / speed;
            if speed < 0.0 && time > entry.time {
                entry = Crossing { time, face };
            } else if speed > 0.0 && time < exit.time {
                exit = Crossing { time, face };
            } else if speed == 0.0 && depth < 0.0 {
                return None;
            }
        }
        (entry.time <= exit.time && exit.time >= 0.0).then_some((entry, exit))
    }
}
