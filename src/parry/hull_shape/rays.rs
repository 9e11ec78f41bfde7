//! Ray casts.

use parry3d::math::{Real, Vector};
use parry3d::query::{Ray, RayCast, RayIntersection};
use parry3d::shape::FeatureId;

use super::HullShape;
use crate::support::{FaceId, Polytope};

impl RayCast for HullShape {
    /// Intersects the ray with the planes of all faces. From inside a hull that is not `solid`, the normal
    /// points inwards, as for other shapes.
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
        // A time beyond the range of f32 is no hit.
        (time.is_finite() && time <= max_time_of_impact)
            .then(|| RayIntersection::new(time, normal, FeatureId::Face(crossing.face.into())))
    }
}

/// Where a ray crosses the plane of a face, in multiples of its direction.
#[derive(Clone, Copy)]
struct Crossing {
    time: f64,
    face: FaceId,
}

impl HullShape {
    /// Where the line of a ray enters and leaves the hull; `None` if it misses the hull, or the hull is
    /// behind.
    fn cut(&self, ray: &Ray) -> Option<(Crossing, Crossing)> {
        let hull = self.hull();
        let (origin, dir) = (ray.origin.as_dvec3(), ray.dir.as_dvec3());
        let at = |time| Crossing {
            time,
            face: FaceId::default(),
        };
        let (mut entry, mut exit) = (at(f64::NEG_INFINITY), at(f64::INFINITY));
        for face in hull.face_ids() {
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
        // A ray whose direction is zero or NaN leaves through no face.
        (entry.time <= exit.time && (0.0..f64::INFINITY).contains(&exit.time))
            .then_some((entry, exit))
    }
}
