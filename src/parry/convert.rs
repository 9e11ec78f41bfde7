//! Converts parry's shapes other than hulls for the kernels. `None` for shapes without extent, or that are
//! not finite.

use glam::DVec3;
use parry3d::math::Real;
use parry3d::shape::{
    Cone as ParryCone, Cuboid, Cylinder as ParryCylinder, HalfSpace as ParryHalfSpace,
    Segment as ParrySegment, Triangle,
};

use crate::curved::Body;
use crate::pose::unit_scale;
use crate::primitive::{Cone, CuboidPolytope, Cylinder, Segment, TrianglePolytope};
use crate::tolerance::{MIN_BOX_THICKNESS, MIN_EXTENT};

/// The half-space beneath the plane through its origin with this normal.
pub(crate) struct HalfSpace {
    pub normal: DVec3,
}

pub(crate) fn half_space(half_space: &ParryHalfSpace) -> Option<HalfSpace> {
    let normal = half_space.normal.as_dvec3();
    let squared = normal.length_squared();
    (squared > 0.0 && squared.is_finite()).then(|| HalfSpace {
        normal: normal * unit_scale(squared),
    })
}

/// A shape of parry with a curved surface.
pub(crate) trait CurvedShape {
    /// The shape for the kernels; `None` if it has no volume.
    fn kernel(&self) -> Option<impl Body>;
}

impl CurvedShape for ParryCylinder {
    fn kernel(&self) -> Option<impl Body> {
        let (half_height, radius) = (positive(self.half_height)?, positive(self.radius)?);
        Some(Cylinder::new(half_height, radius))
    }
}

impl CurvedShape for ParryCone {
    fn kernel(&self) -> Option<impl Body> {
        let (half_height, radius) = (positive(self.half_height)?, positive(self.radius)?);
        Some(Cone::new(half_height, radius))
    }
}

/// `None` for a box that is only a segment or a point: none of its faces has a plane.
#[inline]
pub(crate) fn cuboid(cuboid: &Cuboid) -> Option<CuboidPolytope> {
    let half_extents = cuboid.half_extents.as_dvec3();
    let longest = DVec3::splat(half_extents.max_element());
    let thin = half_extents.cmple(longest * MIN_EXTENT);
    let with_thickness = half_extents.max(longest * MIN_BOX_THICKNESS);
    (thin.bitmask().count_ones() < 2).then(|| CuboidPolytope::new(with_thickness))
}

/// A length to which tolerances can be relative.
pub(crate) fn positive(length: Real) -> Option<f64> {
    (length > 0.0 && length.is_finite()).then(|| length.into())
}

#[inline]
pub(crate) fn segment(segment: &ParrySegment, border_radius: Real) -> Option<Segment> {
    positive(segment.length() + border_radius)?;
    let ends = [segment.a, segment.b].map(|p| p.as_dvec3());
    Some(Segment::new(ends, border_radius.into()))
}

#[inline]
pub(crate) fn triangle(triangle: &Triangle) -> Option<TrianglePolytope> {
    let corners = [triangle.a, triangle.b, triangle.c].map(|p| p.as_dvec3());
    TrianglePolytope::new(corners)
}
