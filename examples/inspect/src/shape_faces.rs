//! The surfaces of shapes as polygons.

use glam::{DVec3, Vec3};
use isa_gjk::Hull;
use isa_gjk::internals::support::Polytope;
use parry3d::shape::{Shape, TypedShape};

/// Sides of what is round.
const ROUND: u32 = 24;

/// The faces of a shape without its border, in its own frame.
pub fn faces(shape: &dyn Shape) -> Vec<Vec<DVec3>> {
    around(&corners(shape))
}

/// The direction in which a face faces; its length means nothing.
pub fn outward(face: &[DVec3]) -> DVec3 {
    let [a, b, c, ..] = face else {
        return DVec3::ZERO;
    };
    (*b - a).cross(*c - a)
}

/// The polygons around points: those of their hull, or the points themselves if they are flat.
fn around(corners: &[Vec3]) -> Vec<Vec<DVec3>> {
    let Ok(hull) = Hull::from_points(corners) else {
        return vec![corners.iter().map(|p| p.as_dvec3()).collect()];
    };
    let face = |face| hull.face_points(face).collect();
    hull.face_ids().map(face).collect()
}

/// The corners of a shape without its border; of a round one as many as make it look round.
fn corners(shape: &dyn Shape) -> Vec<Vec3> {
    match shape.as_typed_shape() {
        TypedShape::ConvexPolyhedron(hull) => hull.points().to_vec(),
        TypedShape::RoundConvexPolyhedron(round) => round.inner_shape.points().to_vec(),
        TypedShape::Cuboid(cuboid) => cuboid.to_trimesh().0,
        TypedShape::RoundCuboid(round) => round.inner_shape.to_trimesh().0,
        TypedShape::Ball(ball) => ball.to_trimesh(ROUND, ROUND / 2).0,
        TypedShape::Capsule(capsule) => capsule.to_trimesh(ROUND, ROUND / 2).0,
        TypedShape::Cylinder(cylinder) => cylinder.to_trimesh(ROUND).0,
        TypedShape::RoundCylinder(round) => round.inner_shape.to_trimesh(ROUND).0,
        TypedShape::Cone(cone) => cone.to_trimesh(ROUND).0,
        TypedShape::RoundCone(round) => round.inner_shape.to_trimesh(ROUND).0,
        TypedShape::Triangle(triangle) => triangle.vertices().to_vec(),
        TypedShape::RoundTriangle(round) => round.inner_shape.vertices().to_vec(),
        TypedShape::Segment(segment) => vec![segment.a, segment.b],
        _ => Vec::new(),
    }
}
