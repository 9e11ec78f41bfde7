//! Small bodies as they lie in heaps. Each is about a metre across here and is scaled later.

use std::f32::consts::TAU;

use oorandom::Rand32;
use rapier3d::prelude::*;

use super::hulls::{self, RADIUS};

/// Thickness of plates and needles over their length.
const THIN: Real = 0.01;
/// Length of pencils over their width.
const LONG: Real = 4.0;
/// How wide and high a ring's material is, in radii of the ring.
const MATERIAL: Real = 0.25;

/// Hulls of 8 to 20 points on a sphere.
pub fn rocks(count: u32, random: &mut Rand32) -> Result<Vec<SharedShape>, String> {
    let rock = |_| {
        let vertices = random.rand_range(8..21);
        let points = hulls::sphere_points(vertices, RADIUS, random);
        hulls::hull(&points, "the points of a rock")
    };
    (0..count).map(rock).collect()
}

/// Hulls of 8 to 21 points: flattened spheres, and some frustums with a large flat face.
pub fn stones(count: u32, random: &mut Rand32) -> Result<Vec<SharedShape>, String> {
    let stone = |_| {
        let vertices = random.rand_range(8..22);
        let mut flattening = || 0.4 + 0.6 * random.rand_float();
        let radii = Vector::new(flattening(), flattening(), 1.0);
        let points = if vertices.is_multiple_of(2) && random.rand_float() < 0.3 {
            frustum(vertices / 2, 0.5 + 0.45 * random.rand_float())
        } else {
            hulls::sphere_points(vertices, RADIUS, random)
        };
        let points: Vec<_> = points.into_iter().map(|p| p * radii).collect();
        hulls::hull(&points, "the points of a stone")
    };
    (0..count).map(stone).collect()
}

fn frustum(sides: u32, taper: Real) -> Vec<Vector> {
    let corner = |side: u32, radius: Real, z: Real| {
        let (sin, cos) = (TAU * side as Real / sides as Real).sin_cos();
        Vector::new(radius * cos, radius * sin, z)
    };
    (0..sides)
        .flat_map(|side| {
            [
                corner(side, RADIUS, -RADIUS / 2.0),
                corner(side, taper * RADIUS, RADIUS / 2.0),
            ]
        })
        .collect()
}

/// Dice of 4, 6, 8, 10, 12 and 20 sides.
pub fn dice() -> Result<Vec<SharedShape>, String> {
    const GOLDEN: Real = 1.618_034;
    let signs = [-1.0, 1.0];
    let cube = || signs.into_iter().flat_map(move |x| signs.map(|y| (x, y)));
    let cube = cube().flat_map(|(x, y)| signs.map(|z| Vector::new(x, y, z)));
    // The corners (0, ±a, ±b), and those with their coordinates in the two other orders.
    let rectangles = |a: Real, b: Real| {
        signs.into_iter().flat_map(move |s| {
            signs.into_iter().flat_map(move |t| {
                let (a, b) = (s * a, t * b);
                [
                    Vector::new(0.0, a, b),
                    Vector::new(a, b, 0.0),
                    Vector::new(b, 0.0, a),
                ]
            })
        })
    };
    let octahedron = Vector::AXES.into_iter().flat_map(|axis| [axis, -axis]);
    // Two pyramids turned against each other: kites if the zigzag has this height.
    let zigzag = (1.0 - (TAU / 10.0).cos()) / (1.0 + (TAU / 10.0).cos());
    let trapezohedron = (0..10).map(|i: u32| {
        let (sin, cos) = (TAU * i as Real / 10.0).sin_cos();
        let side = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        Vector::new(cos, side * zigzag, sin)
    });
    let solids: [Vec<Vector>; 6] = [
        cube.clone().filter(|p| p.x * p.y * p.z > 0.0).collect(),
        cube.clone().collect(),
        octahedron.collect(),
        trapezohedron.chain([Vector::Y, -Vector::Y]).collect(),
        cube.chain(rectangles(1.0 / GOLDEN, GOLDEN)).collect(),
        rectangles(1.0, GOLDEN).collect(),
    ];
    solids
        .into_iter()
        .map(|points| {
            let radius = points.iter().map(|p| p.length()).fold(0.0, Real::max);
            let points: Vec<_> = points.iter().map(|p| p * (RADIUS / radius)).collect();
            hulls::hull(&points, "the corners of a die")
        })
        .collect()
}

/// A cube.
pub fn cube() -> Result<SharedShape, String> {
    hulls::cuboid(Vector::splat(RADIUS))
}

/// A square plate.
pub fn plate() -> Result<SharedShape, String> {
    hulls::cuboid(RADIUS * Vector::new(1.0, THIN, 1.0))
}

/// A square rod.
pub fn needle() -> Result<SharedShape, String> {
    hulls::cuboid(RADIUS * Vector::new(1.0, THIN, THIN))
}

/// A prism that is long and thin.
pub fn pencil(sides: u32) -> Result<SharedShape, String> {
    hulls::prism(sides, RADIUS / LONG, RADIUS)
}

/// A ring with its axis along y, one wedge for each side.
pub fn ring(sides: u32) -> Result<SharedShape, String> {
    let half_height = 0.5 * MATERIAL * RADIUS;
    let wedge = |side: u32| {
        let corners = [side, side + 1].into_iter().flat_map(|corner| {
            let (sin, cos) = (TAU * corner as Real / sides as Real).sin_cos();
            [RADIUS, RADIUS * (1.0 - MATERIAL)]
                .into_iter()
                .flat_map(move |radius| {
                    [-half_height, half_height].map(|y| Vector::new(radius * cos, y, radius * sin))
                })
        });
        let wedge = hulls::hull(&corners.collect::<Vec<_>>(), "a wedge of a ring")?;
        Ok((Pose::IDENTITY, wedge))
    };
    let wedges: Result<Vec<_>, String> = (0..sides).map(wedge).collect();
    Ok(SharedShape::compound(wedges?))
}
