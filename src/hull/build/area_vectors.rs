//! The area vectors of the triangles of a surface, and the volume inside it.

use glam::{DVec3, Vec3};

use crate::at::At;
use crate::simd::{DVec3x4, LANES, f32x4, f64x4, widened};
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

    /// Adds the first `count` of four triangles: a corner of each, the sides that leave it, and their cross products.
    #[inline]
    fn add(&mut self, a: DVec3x4, sides: [DVec3x4; 2], vectors: DVec3x4, count: usize) {
        let [ab, ac] = sides;
        let from_origin = a - self.origin;
        let inside = vectors.dot_each(from_origin);
        let moment = (from_origin * f64x4::splat(3.0) + (ab + ac)) * inside;
        let inside = inside.to_array();
        let [x, y, z] = moment.0.map(f64x4::to_array);
        // One after the other: what the sum rounds to must not depend on the lane of a triangle.
        for lane in 0..count.min(LANES) {
            self.volume += inside[lane];
            self.moment += DVec3::new(x[lane], y[lane], z[lane]);
        }
    }
}

/// The area vectors of four triangles.
pub(super) struct FourAreaVectors {
    pub vectors: DVec3x4,
    pub areas: f64x4,
    pub normals: [f32x4; 3],
    pub highest: f64x4,
    pub lowest: f64x4,
}

impl FourAreaVectors {
    /// Of up to four triangles, which are added to the volume. Other lanes repeat the first one.
    #[inline]
    pub fn measure(
        triangles: &[[u32; 3]],
        place: impl Fn(u32) -> DVec3,
        inside: &mut Volume,
    ) -> Self {
        let corners = |corner: usize| {
            let vertex = |lane: usize| triangles.get(lane).unwrap_or(&triangles[0])[corner];
            DVec3x4::gather([0, 1, 2, 3].map(vertex), &place)
        };
        let a = corners(0);
        let sides = [corners(1) - a, corners(2) - a];
        let four = Self::new(a, sides);
        inside.add(a, sides, four.vectors, triangles.len());
        four
    }

    /// From a corner of each, and the sides that leave it.
    #[inline]
    fn new(a: DVec3x4, [ab, ac]: [DVec3x4; 2]) -> Self {
        let vectors = ab.cross(ac);
        let areas = vectors.length_squared().sqrt();
        let normals = (vectors * (f64x4::splat(1.0) / areas)).to_f32x4();
        let rounded = DVec3x4(normals.map(|row| widened(row.to_array())));
        let at_a = rounded.dot_each(a);
        let [at_b, at_c] = [ab, ac].map(|side| rounded.dot_each(side));
        let zero = f64x4::ZERO;
        Self {
            vectors,
            areas,
            normals,
            highest: at_a + zero.fast_max(at_b).fast_max(at_c),
            lowest: at_a + zero.fast_min(at_b).fast_min(at_c),
        }
    }

    /// One after the other.
    fn each(&self) -> impl Iterator<Item = AreaVector> {
        let [x, y, z] = self.vectors.0.map(f64x4::to_array);
        let [nx, ny, nz] = self.normals.map(f32x4::to_array);
        let [areas, highest, lowest] = [self.areas, self.highest, self.lowest].map(f64x4::to_array);
        (0..LANES).map(move |lane| AreaVector {
            vector: DVec3::new(x[lane], y[lane], z[lane]),
            area: areas[lane],
            normal: Vec3::new(nx[lane], ny[lane], nz[lane]),
            highest: highest[lane],
            lowest: lowest[lane],
        })
    }
}

impl AreaVectors {
    pub fn new(points: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let mut inside = Volume::new(points[0]);
        let mut measured = Vec::with_capacity(triangles.len());
        for four in triangles.chunks(LANES) {
            let areas = FourAreaVectors::measure(four, |v| points.at(v), &mut inside);
            measured.extend(areas.each().take(four.len()));
        }
        Self {
            triangles: measured,
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
