//! Support by looking at every vertex. On small hulls that takes less time than a climb, which has
//! to wait for each step to know the next, and no branch in it depends on the data.
//!
//! In f32 first, with known error; of the vertices that may be highest after that, of which there
//! is mostly one, the highest in f64. So the answer is exact.

use std::array;

use glam::{DVec3, Vec3};
use wide::f32x4;

use crate::support::VertexId;

/// Up to so many vertices a scan is quicker than a climb.
const LARGEST: usize = 64;

const LANES: usize = 4;

/// How far two heights in f32 may be in the wrong order, for points in the unit ball and a direction
/// whose largest coordinate is 1: coordinates, direction, products and two sums are rounded, each by
/// at most the sum of their products, which is below √3; so both heights together by 10 √3 units.
const ROUNDING: f32 = 18.0 / (1 << 24) as f32;

/// The vertices of a small hull.
#[derive(Clone, Debug)]
pub(super) struct Scan {
    /// Coordinate by coordinate in fours, from the centre, in radii.
    fours: Box<[[f32x4; 3]]>,
    /// A bit for each vertex.
    all: u64,
}

impl Scan {
    /// `None` for a hull that is quicker to climb.
    pub fn new(points: &[Vec3], center: DVec3, radius: f64) -> Option<Self> {
        if points.len() > LARGEST {
            return None;
        }
        let place = |p: &Vec3| ((p.as_dvec3() - center) / radius).as_vec3();
        let fours = points.chunks(LANES).map(|chunk| {
            let lanes: [Vec3; LANES] = array::from_fn(|i| chunk.get(i).map_or(Vec3::ZERO, place));
            let coordinate = |k| f32x4::new(lanes.map(|p: Vec3| p[k]));
            [coordinate(0), coordinate(1), coordinate(2)]
        });
        Some(Self {
            fours: fours.collect(),
            all: u64::MAX >> (u64::BITS as usize - points.len()),
        })
    }

    /// The extreme vertex of `points` in direction `dir`, of those that tie the first.
    #[inline]
    pub fn highest(&self, points: &[Vec3], dir: DVec3) -> VertexId {
        let mut candidates = self.candidates(dir);
        let mut highest = candidates.trailing_zeros();
        candidates &= candidates.wrapping_sub(1);
        if candidates != 0 {
            let height = |vertex: u32| dir.dot(points[vertex as usize].as_dvec3());
            let mut most = height(highest);
            while candidates != 0 {
                let vertex = candidates.trailing_zeros();
                candidates &= candidates - 1;
                let other = height(vertex);
                if other > most {
                    (highest, most) = (vertex, other);
                }
            }
        }
        highest
    }

    /// A bit for each vertex that may be the highest; there is one at least.
    #[inline]
    fn candidates(&self, dir: DVec3) -> u64 {
        let size = dir.abs().max_element();
        let unit = (dir / size).as_vec3().to_array().map(f32x4::splat);
        let mut heights = [f32x4::ZERO; LARGEST / LANES];
        let mut highest = f32x4::splat(f32::NEG_INFINITY);
        for (height, [x, y, z]) in heights.iter_mut().zip(&self.fours) {
            *height = *x * unit[0] + *y * unit[1] + *z * unit[2];
            highest = highest.fast_max(*height);
        }
        let [a, b, c, d] = highest.to_array();
        let least = f32x4::splat(greater(greater(a, b), greater(c, d)) - ROUNDING);
        let mut candidates = 0;
        for (number, height) in heights[..self.fours.len()].iter().enumerate() {
            let bits = height.simd_ge(least).to_bitmask();
            candidates |= u64::from(bits) << (LANES * number);
        }
        candidates &= self.all;
        // A direction that is zero or no number has none.
        if candidates == 0 { 1 } else { candidates }
    }

    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.fours)
    }
}

/// The greater of two numbers, none of which is missing: what `max` would have to look into.
fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
