//! Which way up a hull can stand in a tower.

use std::f32::consts::TAU;

use rapier3d::prelude::*;

/// Points nearer to the lowest or highest one than this share of the radius are on a flat side.
const LEVEL: Real = 5e-3;
/// A flat side is a base if it goes on around the centre of mass by this share of the radius.
const MARGIN: Real = 0.25;
/// The number of directions in which this is checked.
const DIRECTIONS: u32 = 16;

/// The hull turned to where it is flat below and above, its centre of mass on the y axis and half
/// of its height above the origin; `None` if it cannot stand so.
pub fn upright(shape: &SharedShape) -> Option<SharedShape> {
    let hull = shape.as_convex_polyhedron()?;
    let centre = hull.mass_properties(1.0).local_com;
    let points: Vec<_> = hull.points().iter().map(|p| *p - centre).collect();
    let radius = points.iter().map(|p| p.length()).fold(0.0, Real::max);
    let normals = hull.faces().iter().map(|face| face.normal);
    let (width, down) = normals
        .map(|normal| (base_width(&points, normal, LEVEL * radius), normal))
        .max_by(|a, b| a.0.total_cmp(&b.0))?;
    if width < MARGIN * radius {
        return None;
    }
    let turn = Rotation::from_rotation_arc(down, -Vector::Y);
    let turned = points.iter().map(|p| turn * *p);
    let middle = Vector::Y * Aabb::from_points(turned.clone()).center().y;
    let raised: Vec<_> = turned.map(|p| p - middle).collect();
    SharedShape::convex_hull(&raised)
}

/// How far the flat sides at both ends along `axis` go on around the centre at least.
fn base_width(points: &[Vector], axis: Vector, level: Real) -> Real {
    let (u, v) = axis.any_orthonormal_pair();
    let width = |axis: Vector| {
        let end = points.iter().map(|p| p.dot(axis)).fold(0.0, Real::max);
        let side = points.iter().filter(|p| p.dot(axis) > end - level);
        let reach = |i: u32| {
            let (sin, cos) = (TAU * i as Real / DIRECTIONS as Real).sin_cos();
            let heights = side.clone().map(|p| p.dot(u * cos + v * sin));
            heights.fold(Real::NEG_INFINITY, Real::max)
        };
        (0..DIRECTIONS).map(reach).fold(Real::INFINITY, Real::min)
    };
    width(axis).min(width(-axis))
}
