//! Shapes as triangles.

use rapier3d::prelude::{Pose, Shape, TypedShape, Vector};

/// The number of sides of round shapes.
const ROUND: u32 = 24;

/// The surface of a shape, three corners for each triangle, in the shape's frame; empty for shapes
/// that no scene has.
pub fn triangles(shape: &dyn Shape) -> Vec<Vector> {
    let (points, triangles) = match shape.as_typed_shape() {
        TypedShape::ConvexPolyhedron(hull) => hull.to_trimesh(),
        TypedShape::Cuboid(cuboid) => cuboid.to_trimesh(),
        TypedShape::Ball(ball) => ball.to_trimesh(ROUND, ROUND / 2),
        TypedShape::Capsule(capsule) => capsule.to_trimesh(ROUND, ROUND / 2),
        TypedShape::Cylinder(cylinder) => cylinder.to_trimesh(ROUND),
        TypedShape::Cone(cone) => cone.to_trimesh(ROUND),
        TypedShape::TriMesh(mesh) => (mesh.vertices().to_vec(), mesh.indices().to_vec()),
        TypedShape::Compound(compound) => return parts(compound.shapes()),
        _ => return Vec::new(),
    };
    let corners = triangles.iter().flatten();
    corners.map(|corner| points[*corner as usize]).collect()
}

fn parts(parts: &[(Pose, rapier3d::prelude::SharedShape)]) -> Vec<Vector> {
    let moved = parts.iter().flat_map(|(pose, part)| {
        let corners = triangles(&**part).into_iter();
        corners.map(|corner| pose.transform_point(corner))
    });
    moved.collect()
}
