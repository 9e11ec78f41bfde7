//! Shapes that dispatchers of this crate know, beside what the oracle knows of them.

use glam::DVec3;
use parry3d::math::{Real, Vector};
use parry3d::shape::{Cuboid, SharedShape};

use super::generate::Rng;
use super::oracle::Solid;

/// A core with a border around it.
pub struct Rounded {
    pub name: &'static str,
    pub core: Solid,
    pub border: f64,
    pub shape: SharedShape,
}

/// Hulls, cuboids, triangles, balls, capsules and segments of about this size, rounded and not.
pub fn all(rng: &mut Rng, size: Real) -> Vec<Rounded> {
    let border = 0.1 * size;
    let hull = rng.hull(14, size.into());
    let points: Vec<Vector> = hull.solid.points.iter().map(|p| p.as_vec3()).collect();
    let round_hull = SharedShape::round_convex_hull(&points, border).expect("a solid");
    let half = Vector::new(0.3, 0.5, 0.2) * size;
    let corners = [
        Vector::new(-0.5, -0.3, 0.0) * size,
        Vector::new(0.5, -0.3, 0.1) * size,
        Vector::new(0.0, 0.6, -0.1) * size,
    ];
    let [a, b, c] = corners;
    let core = |name: &str| match name {
        "hull" => Solid::new(hull.solid.points.clone(), hull.solid.faces()),
        "cuboid" => cuboid(half),
        "triangle" => Solid::triangle(corners.map(|p| p.as_dvec3())),
        "segment" => Solid::segment([a, c].map(|p| p.as_dvec3())),
        _ => Solid::point(DVec3::ZERO),
    };
    let rounded = |name, kind, border: Real, shape| Rounded {
        name,
        core: core(kind),
        border: border.into(),
        shape,
    };
    let [x, y, z] = half.to_array();
    vec![
        rounded("hull", "hull", 0.0, hull.shape.clone()),
        rounded("round hull", "hull", border, round_hull),
        rounded("cuboid", "cuboid", 0.0, SharedShape::cuboid(x, y, z)),
        rounded(
            "round cuboid",
            "cuboid",
            border,
            SharedShape::round_cuboid(x, y, z, border),
        ),
        rounded("triangle", "triangle", 0.0, SharedShape::triangle(a, b, c)),
        rounded(
            "round triangle",
            "triangle",
            border,
            SharedShape::round_triangle(a, b, c, border),
        ),
        rounded(
            "ball",
            "ball",
            3.0 * border,
            SharedShape::ball(3.0 * border),
        ),
        rounded(
            "capsule",
            "segment",
            border,
            SharedShape::capsule(a, c, border),
        ),
        rounded("segment", "segment", 0.0, SharedShape::segment(a, c)),
    ]
}

fn cuboid(half: Vector) -> Solid {
    let (points, faces) = Cuboid::new(half).to_trimesh();
    Solid::new(points.iter().map(|p| p.as_dvec3()).collect(), &faces)
}
