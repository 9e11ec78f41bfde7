//! Converts parry's shapes other than hulls for the kernels. `None` for shapes without extent, or that are
//! not finite.

use glam::DVec3;
use parry3d::math::Real;
use parry3d::shape::{
    Ball as ParryBall, Capsule as ParryCapsule, Cone as ParryCone, Cuboid,
    Cylinder as ParryCylinder, HalfSpace as ParryHalfSpace, Segment as ParrySegment, Shape,
    ShapeType, Triangle, TypedShape,
};

use crate::parry::custom::CustomShape;
use crate::pose::unit_scale;
use crate::primitive::{Ball, Cone, CuboidPolytope, Cylinder, Segment, TrianglePolytope};
use crate::support::{ShapeId, ShapeKind};
use crate::tolerance::{MIN_BOX_THICKNESS, MIN_EXTENT};

/// The half-space beneath the plane through its origin with this normal.
pub(crate) struct HalfSpace {
    pub normal: DVec3,
}

impl HalfSpace {
    #[inline]
    pub fn id(&self) -> ShapeId {
        ShapeId::described_by(ShapeKind::HalfSpace, self.normal.to_array())
    }
}

pub(crate) fn half_space(half_space: &ParryHalfSpace) -> Option<HalfSpace> {
    let normal = half_space.normal.as_dvec3();
    let squared = normal.length_squared();
    (squared > 0.0 && squared.is_finite()).then(|| HalfSpace {
        normal: normal * unit_scale(squared),
    })
}

/// A convex shape other than a hull, without its border.
pub(crate) enum Core<'a> {
    Ball(Ball),
    Segment(Segment),
    Triangle(TrianglePolytope),
    Cuboid(CuboidPolytope),
    Cylinder(Cylinder),
    Cone(Cone),
    Custom(CustomShape<'a>),
}

impl<'a> Core<'a> {
    /// The core of a shape, and the radius of its border.
    #[inline]
    pub fn of(shape: &'a dyn Shape) -> Option<(Self, Real)> {
        // The typed shape of a user's own shape may only be similar.
        match shape.shape_type() {
            ShapeType::Custom => Self::of_custom(shape),
            _ => Self::of_typed(shape.as_typed_shape()),
        }
    }

    #[cold]
    fn of_custom(shape: &'a dyn Shape) -> Option<(Self, Real)> {
        let (core, border) = CustomShape::of(shape)?;
        Some((Self::Custom(core), border))
    }

    /// Like [`of`](Self::of), for a shape of parry's own.
    #[inline]
    pub fn of_typed(shape: TypedShape<'_>) -> Option<(Self, Real)> {
        // Each core is written once, into the answer: copies of merged branches cost as much as a support.
        match shape {
            TypedShape::Ball(shape) => Some((Self::Ball(ball(shape)?), shape.radius)),
            TypedShape::Segment(shape) => Some((Self::Segment(segment(shape, 0.0)?), 0.0)),
            TypedShape::Capsule(ParryCapsule {
                segment: axis,
                radius,
            }) => Some((Self::Segment(segment(axis, *radius)?), *radius)),
            TypedShape::Triangle(shape) => Some((Self::Triangle(triangle(shape)?), 0.0)),
            TypedShape::RoundTriangle(round) => {
                let core = triangle(&round.inner_shape)?;
                Some((Self::Triangle(core), round.border_radius))
            }
            TypedShape::Cuboid(shape) => Some((Self::Cuboid(cuboid(shape)?), 0.0)),
            TypedShape::RoundCuboid(round) => {
                let core = cuboid(&round.inner_shape)?;
                Some((Self::Cuboid(core), round.border_radius))
            }
            TypedShape::Cylinder(shape) => Some((Self::Cylinder(cylinder(shape)?), 0.0)),
            TypedShape::RoundCylinder(round) => {
                let core = cylinder(&round.inner_shape)?;
                Some((Self::Cylinder(core), round.border_radius))
            }
            TypedShape::Cone(shape) => Some((Self::Cone(cone(shape)?), 0.0)),
            TypedShape::RoundCone(round) => {
                let core = cone(&round.inner_shape)?;
                Some((Self::Cone(core), round.border_radius))
            }
            _ => None,
        }
    }

    /// Whether the surface may be curved, so that the core is no polytope.
    pub fn is_curved(&self) -> bool {
        matches!(self, Self::Cylinder(_) | Self::Cone(_) | Self::Custom(_))
    }
}

fn ball(ball: &ParryBall) -> Option<Ball> {
    positive(ball.radius).map(Ball::new)
}

#[inline]
fn segment(segment: &ParrySegment, border_radius: Real) -> Option<Segment> {
    positive(segment.length() + border_radius)?;
    let ends = [segment.a, segment.b].map(|p| p.as_dvec3());
    Some(Segment::new(ends, border_radius.into()))
}

#[inline]
fn triangle(triangle: &Triangle) -> Option<TrianglePolytope> {
    let corners = [triangle.a, triangle.b, triangle.c].map(|p| p.as_dvec3());
    TrianglePolytope::new(corners)
}

/// `None` for a box that is only a segment or a point: none of its faces has a plane.
#[inline]
fn cuboid(cuboid: &Cuboid) -> Option<CuboidPolytope> {
    let half_extents = cuboid.half_extents.as_dvec3();
    let longest = DVec3::splat(half_extents.max_element());
    let thin = half_extents.cmple(longest * MIN_EXTENT);
    let with_thickness = half_extents.max(longest * MIN_BOX_THICKNESS);
    (thin.bitmask().count_ones() < 2).then(|| CuboidPolytope::new(with_thickness))
}

fn cylinder(cylinder: &ParryCylinder) -> Option<Cylinder> {
    let (half_height, radius) = (positive(cylinder.half_height)?, positive(cylinder.radius)?);
    Some(Cylinder::new(half_height, radius))
}

fn cone(cone: &ParryCone) -> Option<Cone> {
    let (half_height, radius) = (positive(cone.half_height)?, positive(cone.radius)?);
    Some(Cone::new(half_height, radius))
}

/// A length to which tolerances can be relative.
fn positive(length: Real) -> Option<f64> {
    (0.0 < length && length < Real::INFINITY).then(|| length.into())
}
