//! The highest of many points in a direction, found four at a time.

use glam::{DVec3, Vec3};
use wide::f64x4;

/// Points are looked at in fours, so that there is no branch for each.
pub(super) const LANES: usize = 4;

/// Keeps the highest point of each lane, and chooses among them at the end.
pub(super) struct Highest {
    dir: [f64x4; 3],
    heights: f64x4,
    /// The number of the four that each comes from: bits of a whole number, since lanes are selected
    /// together with those of the heights.
    fours: f64x4,
}

/// The highest point: the number of its four, its lane there, and its height.
pub(super) struct Top {
    pub four: usize,
    pub lane: usize,
    pub height: f64,
}

impl Highest {
    #[inline(always)]
    pub fn new(dir: DVec3) -> Self {
        Self {
            dir: dir.to_array().map(f64x4::splat),
            heights: f64x4::splat(f64::NEG_INFINITY),
            fours: f64x4::ZERO,
        }
    }

    /// Looks at four points, coordinate by coordinate.
    #[inline(always)]
    pub fn look_at(&mut self, number: usize, coordinates: [[f32; LANES]; 3]) {
        let [x, y, z] = coordinates.map(|lanes| f64x4::new(lanes.map(f64::from)));
        let heights = x * self.dir[0] + y * self.dir[1] + z * self.dir[2];
        let higher = heights.simd_gt(self.heights);
        let number = f64x4::splat(f64::from_bits(number as u64));
        self.heights = higher.bitselect(heights, self.heights);
        self.fours = higher.bitselect(number, self.fours);
    }

    /// Of points that tie in different lanes the one in the lower lane.
    #[inline(always)]
    pub fn top(self) -> Top {
        let (heights, fours) = (self.heights.to_array(), self.fours.to_array());
        let higher = |i: usize, j: usize| if heights[j] > heights[i] { j } else { i };
        let lane = higher(higher(0, 1), higher(2, 3));
        Top {
            four: fours[lane].to_bits() as usize,
            lane,
            height: heights[lane],
        }
    }
}

/// Four points, coordinate by coordinate.
#[inline(always)]
pub(super) fn coordinates(points: [Vec3; LANES]) -> [[f32; LANES]; 3] {
    [
        points.map(|p| p.x),
        points.map(|p| p.y),
        points.map(|p| p.z),
    ]
}
