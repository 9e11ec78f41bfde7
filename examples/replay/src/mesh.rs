//! Shapes as triangles.

use rapier3d::prelude::{Pose, Real, Shape, Triangle, TypedShape, Vector};

/// The number of sides of round shapes.
const ROUND: u32 = 24;

/// Half the side of the square that stands for a half-space.
const GROUND: Real = 2.0;

/// The surface of a shape without its border, three corners for each triangle, in the shape's frame; empty
/// for shapes that no scene and no recording has, and for segments.
pub fn triangles(shape: &dyn Shape) -> Vec<Vector> {
    let (points, triangles) = match shape.as_typed_shape() {
        TypedShape::ConvexPolyhedron(hull) => hull.to_trimesh(),
        TypedShape::Cuboid(cuboid) => cuboid.to_trimesh(),
        TypedShape::Ball(ball) => ball.to_trimesh(ROUND, ROUND / 2),
        TypedShape::Capsule(capsule) => capsule.to_trimesh(ROUND, ROUND / 2),
        TypedShape::Cylinder(cylinder) => cylinder.to_trimesh(ROUND),
        TypedShape::Cone(cone) => cone.to_trimesh(ROUND),
        TypedShape::RoundConvexPolyhedron(round) => round.inner_shape.to_trimesh(),
        TypedShape::RoundCuboid(round) => round.inner_shape.to_trimesh(),
        TypedShape::RoundCylinder(round) => round.inner_shape.to_trimesh(ROUND),
        TypedShape::RoundCone(round) => round.inner_shape.to_trimesh(ROUND),
        TypedShape::Triangle(triangle) => return both_sides(triangle),
        TypedShape::RoundTriangle(round) => return both_sides(&round.inner_shape),
        TypedShape::HalfSpace(half_space) => return ground(half_space.normal),
        TypedShape::TriMesh(mesh) => (mesh.vertices().to_vec(), mesh.indices().to_vec()),
        TypedShape::Compound(compound) => return parts(compound.shapes()),
        _ => return Vec::new(),
    };
    let corners = triangles.iter().flatten();
    corners.map(|corner| points[*corner as usize]).collect()
}

fn both_sides(triangle: &Triangle) -> Vec<Vector> {
    let Triangle { a, b, c } = *triangle;
    vec![a, b, c, a, c, b]
}

fn ground(normal: Vector) -> Vec<Vector> {
    let (u, v) = normal.normalize().any_orthonormal_pair();
    let [a, b, c, d] = [u + v, v - u, -u - v, u - v].map(|corner| GROUND * corner);
    [Triangle::new(a, b, c), Triangle::new(a, c, d)]
        .iter()
        .flat_map(both_sides)
        .collect()
}

fn parts(parts: &[(Pose, rapier3d::prelude::SharedShape)]) -> Vec<Vector> {
    let moved = parts.iter().flat_map(|(pose, part)| {
        let corners = triangles(&**part).into_iter();
        corners.map(|corner| pose.transform_point(corner))
    });
    moved.collect()
}
