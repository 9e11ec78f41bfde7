//! The area vectors of the triangles of a surface, and the volume inside it.

use glam::{DVec3, Vec3};

use crate::at::At;
use crate::tolerance::MIN_TRIANGLE_HEIGHT;

/// The area vectors of all triangles, and the volume inside the surface.
pub(super) struct AreaVectors {
    pub triangles: Vec<AreaVector>,
    pub inside: Volume,
}

/// The area vector of a triangle, and the heights of the corners along its normal.
#[derive(Clone, Copy, Default)]
pub(super) struct AreaVector {
    /// Twice the area vector.
    pub vector: DVec3,
    /// The length of that vector.
    pub area: f64,
    /// The unit normal, rounded. It may be NaN if there is no area.
    pub normal: Vec3,
    /// The heights of the outermost and the innermost corner along the rounded normal.
    pub highest: f64,
    pub lowest: f64,
}

/// The volume inside a surface, triangle by triangle.
#[derive(Clone, Copy)]
pub(super) struct Volume {
    /// A point of the surface.
    pub origin: DVec3,
    /// Six times the volume.
    pub volume: f64,
    /// 24 times the first moment: the volume times the centroid, relative to `origin`.
    pub moment: DVec3,
}

impl Volume {
    pub fn new(origin: DVec3) -> Self {
        Self {
            origin,
            volume: 0.0,
            moment: DVec3::ZERO,
        }
    }

    /// Adds a triangle: a corner, the sides that leave it, and their cross product.
    #[inline]
    pub fn add(&mut self, a: DVec3, [ab, ac]: [DVec3; 2], vector: DVec3) {
        let from_origin = a - self.origin;
        let inside = vector.dot(from_origin);
        self.volume += inside;
        self.moment += (from_origin * 3.0 + (ab + ac)) * inside;
    }
}

impl AreaVectors {
    pub fn new(points: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let mut inside = Volume::new(points[0]);
        let measured = triangles.iter().map(|&[a, b, c]| {
            let a = points.at(a);
            let sides = [points.at(b) - a, points.at(c) - a];
            let triangle = AreaVector::new(a, sides);
            inside.add(a, sides, triangle.vector);
            triangle
        });
        Self {
            triangles: measured.collect(),
            inside,
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
    /// From a corner, and the sides that leave it.
    #[inline]
    pub fn new(a: DVec3, [ab, ac]: [DVec3; 2]) -> Self {
        let vector = ab.cross(ac);
        let area = vector.length();
        let normal = (vector * (1.0 / area)).as_vec3();
        let rounded = normal.as_dvec3();
        let at_a = rounded.dot(a);
        // No value is NaN where it matters, so the NaN checks of `f64::max` and `f64::min` are not needed.
        let (mut highest, mut lowest) = (0.0, 0.0);
        for height in [rounded.dot(ab), rounded.dot(ac)] {
            highest = if height > highest { height } else { highest };
            lowest = if height < lowest { height } else { lowest };
        }
        Self {
            vector,
            area,
            normal,
            highest: at_a + highest,
            lowest: at_a + lowest,
        }
    }

    /// Whether the angle between the triangles is at most the one with this cosine.
    #[inline]
    pub fn is_within(&self, cosine: f64, other: &Self) -> bool {
        self.vector.dot(other.vector) >= cosine * self.area * other.area
    }
}

pub(super) fn longest_side(points: &[DVec3], triangle: [u32; 3]) -> f64 {
    let [a, b, c] = triangle.map(|v| points.at(v));
    let squares = [a - b, b - c, c - a].map(DVec3::length_squared);
    squares[0].max(squares[1]).max(squares[2]).sqrt()
}
