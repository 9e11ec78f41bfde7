//! The triangles of a surface as vectors, with the volume inside it.

use glam::{DVec3, Vec3};

use crate::at::At;
use crate::simd::{DVec3x4, LANES, f64x4, sum, widened};
use crate::tolerance::MIN_TRIANGLE_HEIGHT;

/// The triangles of a surface as vectors.
pub(super) struct AreaVectors {
    pub triangles: Vec<AreaVector>,
    /// Six times the volume inside.
    pub volume: f64,
    /// Its centre from the first point, times four times that.
    pub moment: DVec3,
}

/// A triangle as a vector, and how its corners lie along it.
#[derive(Clone, Copy)]
pub(super) struct AreaVector {
    /// Twice the area vector.
    pub vector: DVec3,
    /// The length of that vector.
    pub area: f64,
    /// The unit normal, rounded. It may be NaN if there is no area.
    pub normal: Vec3,
    /// The heights of the outermost corner along the rounded normal, and of the innermost one.
    pub highest: f64,
    pub lowest: f64,
}

impl AreaVectors {
    pub fn new(points: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let mut vectors = Vec::with_capacity(triangles.len());
        let origin = points[0];
        let (mut volume, mut moment) = (f64x4::ZERO, DVec3x4([f64x4::ZERO; 3]));
        let mut add = |[one, two, three, four]: [&[u32; 3]; LANES], count: usize| {
            let corner = |k: usize| {
                let four = [one[k], two[k], three[k], four[k]];
                DVec3x4::gather(four, |v| points.at(v))
            };
            let (a, b, c) = (corner(0), corner(1), corner(2));
            let vector = push_four(&mut vectors, [a, b, c], count);
            // Triangles that only fill up the last four span no volume.
            let (a, b, c) = (a - origin, b - origin, c - origin);
            let inside = vector.dot_each(a) * f64x4::new(COUNTED[count]);
            volume += inside;
            moment = moment + (a + b + c) * inside;
        };
        let (fours, rest) = triangles.as_chunks::<LANES>();
        for [one, two, three, four] in fours {
            add([one, two, three, four], LANES);
        }
        if let [first, others @ ..] = rest {
            let [second, third] = [0, 1].map(|i| others.get(i).unwrap_or(first));
            add([first, second, third, first], rest.len());
        }
        Self {
            triangles: vectors,
            volume: sum(volume),
            moment: moment.sum(),
        }
    }

    /// Whether the normal of a triangle depends on how its corners are rounded.
    pub fn is_sliver(
        &self,
        points: &[DVec3],
        triangles: &[[u32; 3]],
        t: usize,
        radius: f64,
    ) -> bool {
        let height = MIN_TRIANGLE_HEIGHT * radius;
        let area = self.triangles[t].area;
        // No side is longer than the hull.
        area <= 2.0 * radius * height && area <= height * longest_side(points, triangles[t])
    }
}

impl AreaVector {
    /// Whether the angle between the triangles is at most the one with this cosine.
    #[inline]
    pub fn is_within(&self, cosine: f64, other: &Self) -> bool {
        self.vector.dot(other.vector) >= cosine * self.area * other.area
    }
}

/// Adds the first `count` of four triangles with these corners, and returns twice the area vectors of all.
#[inline]
fn push_four(vectors: &mut Vec<AreaVector>, [a, b, c]: [DVec3x4; 3], count: usize) -> DVec3x4 {
    let vector = (b - a).cross(c - a);
    let area = vector.length_squared().sqrt();
    let rounded = (vector * (f64x4::ONE / area)).to_f32x4();
    let normal = DVec3x4(rounded.map(|row| widened(row.to_array())));
    let (at_a, at_b, at_c) = (normal.dot_each(a), normal.dot_each(b), normal.dot_each(c));
    let highest = at_a.fast_max(at_b).fast_max(at_c).to_array();
    let lowest = at_a.fast_min(at_b).fast_min(at_c).to_array();
    let [u, v, w] = vector.0.map(f64x4::to_array);
    let [x, y, z] = rounded.map(|row| row.to_array());
    let areas = area.to_array();
    for lane in 0..count {
        vectors.push(AreaVector {
            vector: DVec3::new(u[lane], v[lane], w[lane]),
            area: areas[lane],
            normal: Vec3::new(x[lane], y[lane], z[lane]),
            highest: highest[lane],
            lowest: lowest[lane],
        });
    }
    vector
}

/// One in so many lanes, zero in the others.
const COUNTED: [[f64; LANES]; LANES + 1] = [
    [0.0, 0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0],
    [1.0, 1.0, 1.0, 0.0],
    [1.0, 1.0, 1.0, 1.0],
];

pub(super) fn longest_side(points: &[DVec3], triangle: [u32; 3]) -> f64 {
    let [a, b, c] = triangle.map(|v| points.at(v));
    let squares = [a - b, b - c, c - a].map(DVec3::length_squared);
    squares[0].max(squares[1]).max(squares[2]).sqrt()
}
