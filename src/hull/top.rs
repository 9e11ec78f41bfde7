//! The highest of many points in a direction, found four at a time.

use glam::{DVec3, Vec3};
use wide::{f64x4, u64x4};

use crate::greatest::{ArgMax, ArgMax4};

/// Points are looked at in fours.
pub(super) const LANES: usize = 4;

/// The highest point so far.
pub(super) struct ArgMaxDot {
    dir: [f64x4; 3],
    heights: ArgMax4,
}

impl ArgMaxDot {
    #[inline(always)]
    pub fn new(dir: DVec3) -> Self {
        Self {
            dir: dir.to_array().map(f64x4::splat),
            heights: ArgMax4::new(f64::NEG_INFINITY),
        }
    }

    /// Looks at four points, coordinate by coordinate, of which the first has this place.
    #[inline(always)]
    pub fn update(&mut self, place: usize, coordinates: [[f32; LANES]; 3]) {
        let [x, y, z] = coordinates;
        let [x, y, z] = [widened(x), widened(y), widened(z)];
        let heights = x * self.dir[0] + y * self.dir[1] + z * self.dir[2];
        let places = u64x4::splat(place as u64) + u64x4::new([0, 1, 2, 3]);
        self.heights.update(heights, places);
    }

    /// Its place among all that were looked at, and its height.
    #[inline(always)]
    pub fn finish(self) -> ArgMax {
        self.heights.finish()
    }
}

/// Four points, coordinate by coordinate.
#[inline(always)]
pub(super) fn coordinates([a, b, c, d]: [&Vec3; LANES]) -> [[f32; LANES]; 3] {
    [
        [a.x, b.x, c.x, d.x],
        [a.y, b.y, c.y, d.y],
        [a.z, b.z, c.z, d.z],
    ]
}

#[inline(always)]
fn widened([a, b, c, d]: [f32; LANES]) -> f64x4 {
    f64x4::new([a.into(), b.into(), c.into(), d.into()])
}
