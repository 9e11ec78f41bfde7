//! The contact plane in the frame of each shape, and the heights of faces over it.

use crate::simd::f32x4;
use glam::{DVec3, Vec2, Vec3};

use crate::map_pair::map_pair;
use crate::pose::{RelativePose, is_unit};
use crate::simd::LANES;
use crate::support::{FaceId, Polytope};
use crate::tuning::EDGE_ON;

/// The contact plane in the frame of a shape. Its origin is the witness point of shape 1.
pub(super) struct ContactFrame {
    origin: DVec3,
    pub normal: DVec3,
    axes: [DVec3; 2],
}

impl ContactFrame {
    #[inline(always)]
    pub fn new(origin: DVec3, normal: DVec3) -> Self {
        debug_assert!(is_unit(normal), "no unit vector: {normal}");
        let u = normal.any_orthonormal_vector();
        Self {
            origin,
            normal,
            axes: [u, normal.cross(u)],
        }
    }

    /// The same plane in the frame of shape 2.
    #[inline(always)]
    pub fn in_frame_2(&self, pose: &RelativePose) -> Self {
        Self {
            origin: pose.point_to_2(self.origin),
            normal: pose.direction_to_2(self.normal),
            axes: map_pair(self.axes, |axis| pose.direction_to_2(axis)),
        }
    }

    /// The plane of a face whose outward normal is along the contact normal times `sign`. `None` if the face
    /// is seen from behind or edge-on.
    #[inline(always)]
    pub fn plane(&self, shape: &impl Polytope, face: FaceId, sign: f32) -> Option<FaceHeight> {
        let (outward, offset) = self.plane_beyond_origin(shape, face, sign)?;
        let along = outward.dot(self.normal);
        let slope = |axis| (-outward.dot(axis) / along) as f32;
        (along * f64::from(sign) > EDGE_ON).then(|| FaceHeight {
            face,
            base: (offset / along) as f32,
            slope: Vec2::from(map_pair(self.axes, slope)),
        })
    }

    /// The outward normal of a face, and how far beyond the origin its plane is.
    #[inline(always)]
    fn plane_beyond_origin(
        &self,
        shape: &impl Polytope,
        face: FaceId,
        sign: f32,
    ) -> Option<(DVec3, f64)> {
        let outward = shape.face_normal(face);
        if outward == DVec3::ZERO {
            return self.plane_at_segment(shape, face, sign);
        }
        Some((outward, shape.face_offset(face) - outward.dot(self.origin)))
    }

    /// The same for a segment: the plane that leans least against the contact normal. A point has none, nor has a
    /// sliver.
    #[inline(never)]
    fn plane_at_segment(
        &self,
        shape: &impl Polytope,
        face: FaceId,
        sign: f32,
    ) -> Option<(DVec3, f64)> {
        if shape.face_len(face) != 2 {
            return None;
        }
        let [from, to] = map_pair([0, 1], |i| shape.vertex(shape.face_vertex(face, i)));
        let along = (to - from).try_normalize()?;
        let across = self.normal - along * along.dot(self.normal);
        let outward = (across * f64::from(sign)).try_normalize()?;
        Some((outward, outward.dot(from - self.origin)))
    }

    #[inline(always)]
    pub fn projection(&self) -> PlaneProjection {
        let origin = self.origin.as_vec3();
        PlaneProjection {
            origin,
            rest: (self.origin - origin.as_dvec3()).as_vec3(),
            normal: self.normal.as_vec3(),
            axes: map_pair(self.axes, |axis| axis.as_vec3()),
        }
    }
}

/// Maps between a shape's frame and the contact plane, in f32. Near the witness, coordinates are small, and
/// errors are no larger than those of f32 vertices.
pub(super) struct PlaneProjection {
    /// The plane's origin in two parts: rounded to f32, and the rest. So nearby points lose no digits even if
    /// the shape is large.
    origin: Vec3,
    rest: Vec3,
    normal: Vec3,
    axes: [Vec3; 2],
}

impl PlaneProjection {
    /// Projects four points into the plane, coordinate by coordinate.
    #[inline(always)]
    pub fn flatten(&self, points: [Vec3; LANES]) -> [f32x4; 2] {
        let [a, b, c, d] = points;
        let from_origin = |p: [f32; LANES], origin: f32, rest: f32| f32x4::new(p) - origin - rest;
        let x = from_origin([a.x, b.x, c.x, d.x], self.origin.x, self.rest.x);
        let y = from_origin([a.y, b.y, c.y, d.y], self.origin.y, self.rest.y);
        let z = from_origin([a.z, b.z, c.z, d.z], self.origin.z, self.rest.z);
        map_pair(self.axes, |axis| x * axis.x + y * axis.y + z * axis.z)
    }

    /// The points at some heights over positions in the plane.
    #[inline(always)]
    pub fn points(&self, x: f32x4, y: f32x4, height: f32x4) -> [f32x4; 3] {
        let [u, v] = self.axes;
        let coordinate = |axis: usize| {
            let from_origin = x * u[axis] + y * v[axis] + height * self.normal[axis];
            from_origin + self.rest[axis] + self.origin[axis]
        };
        [coordinate(0), coordinate(1), coordinate(2)]
    }
}

/// The plane of a face over the contact plane: `height(x) = base + slope · x` along the normal.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceHeight {
    pub face: FaceId,
    base: f32,
    slope: Vec2,
}

impl FaceHeight {
    #[inline(always)]
    pub fn heights(&self, x: f32x4, y: f32x4) -> f32x4 {
        x * self.slope.x + y * self.slope.y + self.base
    }

    #[inline(always)]
    pub fn height(&self, at: Vec2) -> f32 {
        at.x * self.slope.x + at.y * self.slope.y + self.base
    }

    /// The squared tangent of the angle to the contact plane.
    #[inline(always)]
    pub fn slope_squared(&self) -> f32 {
        self.slope.length_squared()
    }
}
