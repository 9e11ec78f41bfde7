//! Support by looking at every vertex. On small hulls this is faster than a climb, which must finish each
//! step before it knows the next, and no branch depends on the data.
//!
//! Heights are compared in f32 first, with a known error. The vertices that may still be the highest, mostly
//! a single one, are compared in f64. So the answer is exact.

use std::array;
use std::ops::RangeInclusive;

use crate::at::At;
use crate::simd::{f32x4, f32x8};
use glam::{DVec3, Vec3};

use crate::support::VertexId;
use crate::tolerance::SCAN_ROUNDING;

/// Up to this many vertices, the number of bits of a mask, a scan is faster than a cold climb (with 64 by a
/// third) and no slower than a warm one. With 100 vertices, warm climbs are 2 % faster, and so are GJK's
/// climbs from iteration to iteration.
pub(super) const LARGEST: usize = 64;

/// Directions whose largest coordinate is in this range are converted to f32 as they are: nothing overflows,
/// and anything that underflows is far below the rounding.
const SIZES: RangeInclusive<f64> = 1e-18..=1e18;

/// How many vertices are compared at once.
const LANES: usize = 8;

/// The vertices of a small hull.
#[derive(Clone, Debug)]
pub(super) struct Scan {
    /// Eight vertices a row, coordinate by coordinate, relative to the centre and in units of the radius. The
    /// last row is filled up with its first vertex.
    // Plain arrays: allocating memory for aligned ones takes four times as long.
    rows: Box<[[[f32; LANES]; 3]]>,
    /// A bit for each vertex.
    all: u64,
}

impl Scan {
    /// `None` for a hull that is faster to climb.
    pub fn new(points: &[Vec3], center: DVec3, radius: f64) -> Option<Self> {
        if points.len() > LARGEST {
            return None;
        }
        let place = |p: &Vec3| ((p.as_dvec3() - center) / radius).as_vec3();
        let rows = points.chunks(LANES).map(|chunk| {
            let lanes: [Vec3; LANES] = array::from_fn(|i| place(chunk.get(i).unwrap_or(&chunk[0])));
            array::from_fn(|axis| lanes.map(|p| p[axis]))
        });
        Some(Self {
            rows: rows.collect(),
            all: u64::MAX >> (u64::BITS as usize - points.len()),
        })
    }

    /// The extreme vertex of `points` in direction `dir`. Among ties it is the preferred vertex, so that
    /// contacts stay where they are, or else the first.
    #[inline(always)]
    pub fn extreme_vertex(&self, points: &[Vec3], dir: DVec3, preferred: VertexId) -> VertexId {
        let scan = match self.rows.len() {
            1 => Self::extreme_vertex_of::<1>,
            2 => Self::extreme_vertex_of::<2>,
            3 => Self::extreme_vertex_of::<3>,
            4 => Self::extreme_vertex_of::<4>,
            5 => Self::extreme_vertex_of::<5>,
            6 => Self::extreme_vertex_of::<6>,
            7 => Self::extreme_vertex_of::<7>,
            _ => Self::extreme_vertex_of::<8>,
        };
        scan(self, points, dir.x, dir.y, dir.z, preferred)
    }

    /// The same of a hull with so many rows: their heights stay in registers. (Everything is inlined, and the
    /// coordinates are separate arguments: passing the direction through memory takes longer than the scan.)
    #[inline(never)]
    fn extreme_vertex_of<const ROWS: usize>(
        &self,
        points: &[Vec3],
        x: f64,
        y: f64,
        z: f64,
        preferred: VertexId,
    ) -> VertexId {
        let dir = DVec3::new(x, y, z);
        let mut candidates = self.candidates::<ROWS>(dir);
        let mut highest = candidates.trailing_zeros();
        if candidates.is_power_of_two() {
            return highest.into();
        }
        if candidates >> preferred.index() & 1 == 1 {
            highest = preferred.into();
        }
        candidates &= !(1 << highest);
        let height = |vertex: u32| dir.dot(points.at(vertex).as_dvec3());
        let mut most = height(highest);
        while candidates != 0 {
            let vertex = candidates.trailing_zeros();
            candidates &= candidates - 1;
            let other = height(vertex);
            if other > most {
                (highest, most) = (vertex, other);
            }
        }
        highest.into()
    }

    /// An upper bound of the heights along about a unit vector, over the centre and in units of the radius.
    #[inline]
    pub fn greatest_height(&self, dir: DVec3) -> f64 {
        let dir = dir.as_vec3().to_array().map(f32x8::splat);
        let mut highest = f32x8::splat(f32::NEG_INFINITY);
        for row in &self.rows {
            let [x, y, z] = row.map(f32x8::new);
            highest = highest.fast_max(x * dir[0] + y * dir[1] + z * dir[2]);
        }
        f64::from(greatest(highest) + SCAN_ROUNDING)
    }

    /// A bit for each vertex that may be the highest. At least one is set.
    #[inline(always)]
    fn candidates<const ROWS: usize>(&self, dir: DVec3) -> u64 {
        let Some(rows) = self.rows.first_chunk::<ROWS>() else {
            return 1;
        };
        let size = dir.abs().max_element();
        // A division takes a quarter of the time of a scan, and most directions are unit vectors.
        let (dir, size) = if SIZES.contains(&size) {
            (dir, size)
        } else {
            (dir / size, 1.0)
        };
        let dir = dir.as_vec3().to_array().map(f32x8::splat);
        let heights = rows.each_ref().map(|row| {
            let [x, y, z] = row.map(f32x8::new);
            x * dir[0] + y * dir[1] + z * dir[2]
        });
        let highest = heights.into_iter().reduce(f32x8::fast_max);
        let highest = highest.unwrap_or(f32x8::ZERO);
        let least = f32x8::splat(greatest(highest) - SCAN_ROUNDING * size as f32);
        let mut candidates = 0;
        for (number, height) in heights.iter().enumerate() {
            let bits = height.simd_ge(least).to_bitmask();
            candidates |= u64::from(bits) << (LANES * number);
        }
        candidates &= self.all;
        // No bit is set for a direction that is zero or NaN.
        if candidates == 0 { 1 } else { candidates }
    }

    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.rows)
    }
}

#[inline]
fn greatest(values: f32x8) -> f32 {
    let [low, high]: [f32x4; 2] = bytemuck::cast(values);
    let [a, b, c, d] = low.fast_max(high).to_array();
    max_no_nan(max_no_nan(a, b), max_no_nan(c, d))
}

/// The greater of two numbers. Neither is NaN, so the check for it in `f32::max` is not needed.
fn max_no_nan(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn extreme_vertex(scan: &Scan, points: &[Vec3], dir: DVec3) -> usize {
        let vertex = scan.extreme_vertex(points, dir, VertexId::default());
        vertex.index()
    }

    fn vector(rng: &mut oorandom::Rand64) -> DVec3 {
        DVec3::from([(); 3].map(|()| 2.0 * rng.rand_float() - 1.0))
    }

    /// For any number, size and place of points and any length of the direction, even if points nearly tie.
    #[test]
    fn the_highest_in_f64_is_found() {
        let mut rng = oorandom::Rand64::new(3);
        for round in 0..20_000 {
            let size = 10_f64.powi(round % 13 - 6);
            let flatness = [1.0, 1e-3, 1e-6, 0.0][round as usize / 13 % 4];
            let center = vector(&mut rng) * size * [0.0, 1.0, 1e3][round as usize % 3];
            let normal = vector(&mut rng).normalize();
            let count = 4 + round as usize % (LARGEST - 3);
            let points: Vec<Vec3> = (0..count)
                .map(|_| {
                    let p = vector(&mut rng);
                    let flat = p - normal * normal.dot(p) * (1.0 - flatness);
                    (center + flat * size).as_vec3()
                })
                .collect();
            let away = |p: &Vec3| p.as_dvec3().distance(center);
            let radius = points.iter().map(away).fold(0.0, f64::max);
            let scan = Scan::new(&points, center, radius).expect("few points");
            for toward in [normal, vector(&mut rng), DVec3::X] {
                let dir = toward * 10_f64.powi(round % 81 - 40);
                let height = |p: &Vec3| dir.dot(p.as_dvec3());
                let most = points.iter().map(height).fold(f64::NEG_INFINITY, f64::max);
                let first = points.iter().position(|p| height(p) == most);
                assert_eq!(first, Some(extreme_vertex(&scan, &points, dir)));
            }
        }
    }

    #[test]
    fn nonsense_has_some_vertex() {
        let points = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_ONE, Vec3::ONE];
        let scan = Scan::new(&points, DVec3::ZERO, 2.0).expect("few points");
        for dir in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY, DVec3::MIN] {
            assert!(extreme_vertex(&scan, &points, dir) < points.len());
        }
    }
}
