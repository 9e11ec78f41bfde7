//! One of every type of shape, and poses to bring any two of them together.

use parry3d::math::{IVector, Pose, Real, Rotation, Vector};
use parry3d::shape::SharedShape;
use parry3d::utils::Array2;

use super::generate::{Rng, hull_of, prepared};

/// A shape about one unit across.
pub struct ShapeSample {
    pub name: &'static str,
    pub has_hull: bool,
    pub shape: SharedShape,
}

/// One of every type of shape, and hulls wherever a hull can be.
pub fn shape_samples() -> Vec<ShapeSample> {
    let [hull, other_hull] = [20, 40].map(|corners| Rng::new(11).hull(corners, 1.2).shape);
    let hull_points: Vec<Vector> = hull
        .as_convex_polyhedron()
        .expect("a convex polyhedron")
        .points()
        .iter()
        .map(|p| *p * 0.8)
        .collect();
    let round_hull = SharedShape::round_convex_hull(&hull_points, 0.1).expect("a solid");
    let aside = |x: Real| Pose::translation(x, 0.1, 0.0);
    let compound_of_hulls = SharedShape::compound(vec![
        (aside(-0.4), hull.clone()),
        (aside(0.4), other_hull.clone()),
        (aside(0.0), SharedShape::cuboid(0.2, 0.6, 0.2)),
    ]);
    let compound = SharedShape::compound(vec![
        (aside(-0.4), SharedShape::ball(0.3)),
        (aside(0.4), SharedShape::cuboid(0.3, 0.3, 0.3)),
    ]);
    let hull_shape = prepared(&hull);
    let (a, b, c) = (
        Vector::new(-0.5, -0.3, 0.0),
        Vector::new(0.5, -0.3, 0.1),
        Vector::new(0.0, 0.6, -0.1),
    );
    let with_hull = [
        ("hull", hull),
        ("box as hull", box_hull()),
        ("hull shape", hull_shape),
        ("round hull", round_hull),
        ("compound of hulls", compound_of_hulls),
    ];
    let without_hull = [
        ("ball", SharedShape::ball(0.5)),
        ("cuboid", SharedShape::cuboid(0.5, 0.5, 0.5)),
        ("capsule", SharedShape::capsule_y(0.3, 0.25)),
        ("segment", SharedShape::segment(a, b)),
        ("triangle", SharedShape::triangle(a, b, c)),
        ("cylinder", SharedShape::cylinder(0.5, 0.4)),
        ("cone", SharedShape::cone(0.5, 0.4)),
        (
            "round cuboid",
            SharedShape::round_cuboid(0.4, 0.4, 0.4, 0.1),
        ),
        ("round cylinder", SharedShape::round_cylinder(0.4, 0.3, 0.1)),
        ("round cone", SharedShape::round_cone(0.4, 0.3, 0.1)),
        ("round triangle", SharedShape::round_triangle(a, b, c, 0.1)),
        ("half-space", SharedShape::halfspace(Vector::Y)),
        ("trimesh", trimesh()),
        ("heightfield", heightfield()),
        ("compound", compound),
        ("voxels", voxels()),
        ("polyline", SharedShape::polyline(vec![a, b, c], None)),
    ];
    let samples = |has_hull: bool| {
        move |(name, shape)| ShapeSample {
            name,
            has_hull,
            shape,
        }
    };
    with_hull
        .into_iter()
        .map(samples(true))
        .chain(without_hull.into_iter().map(samples(false)))
        .collect()
}

fn box_hull() -> SharedShape {
    let corner = |i: u32| {
        let side = |bit: u32| if i & (1 << bit) == 0 { -0.5 } else { 0.5 };
        Vector::new(side(0), side(1), side(2))
    };
    let corners: Vec<Vector> = (0..8).map(corner).collect();
    hull_of(&corners).expect("a box is convex").shape
}

fn trimesh() -> SharedShape {
    let (points, triangles) = parry3d::shape::Cuboid::new(Vector::new(0.5, 0.4, 0.6)).to_trimesh();
    SharedShape::trimesh(points, triangles).expect("a mesh")
}

fn heightfield() -> SharedShape {
    let heights = (0..25).map(|i| 0.1 * (i % 4) as Real).collect();
    SharedShape::heightfield(Array2::new(5, 5, heights), Vector::new(2.0, 1.0, 2.0))
}

fn voxels() -> SharedShape {
    let cells: Vec<IVector> = (-1..1)
        .flat_map(|x| (-1..1).map(move |y| IVector::new(x, y, x + y)))
        .collect();
    SharedShape::voxels(Vector::splat(0.5), &cells)
}

/// Deep, touching, near and apart, from several sides, straight and tilted.
pub fn poses() -> Vec<Pose> {
    let rotations = [
        Rotation::IDENTITY,
        Rotation::from_scaled_axis(Vector::new(0.3, 0.2, -0.1)),
        Rotation::from_scaled_axis(Vector::new(-1.1, 0.7, 2.0)),
    ];
    let directions = [
        Vector::X,
        Vector::Y,
        -Vector::Y,
        Vector::new(0.48, 0.6, 0.64),
    ];
    let mut poses = Vec::new();
    for rotation in rotations {
        for direction in directions {
            for distance in [0.0, 0.2, 0.5, 0.7, 0.9, 1.0, 1.05, 1.3] {
                poses.push(Pose::from_parts(direction * distance, rotation));
            }
        }
    }
    poses
}
