//! The highest of many points in a direction, found four at a time.

use glam::{DVec3, Vec3};
use wide::{f64x2, f64x4, u64x4};

/// Points are looked at in fours, so that there is no branch for each.
pub(super) const LANES: usize = 4;

/// Keeps the highest point of each lane, and chooses among them at the end.
pub(super) struct Highest {
    dir: [f64x4; 3],
    heights: f64x4,
    /// Which point each height is of: bits of whole numbers, since lanes are selected together with
    /// those of the heights.
    places: f64x4,
}

/// The highest point: its place among all that were looked at, and its height.
pub(super) struct Top {
    pub place: usize,
    pub height: f64,
}

impl Highest {
    #[inline(always)]
    pub fn new(dir: DVec3) -> Self {
        Self {
            dir: dir.to_array().map(f64x4::splat),
            heights: f64x4::splat(f64::NEG_INFINITY),
            places: f64x4::ZERO,
        }
    }

    /// Looks at four points, coordinate by coordinate, of which the first has this place.
    #[inline(always)]
    pub fn look_at(&mut self, place: usize, coordinates: [[f32; LANES]; 3]) {
        let [x, y, z] = coordinates;
        let [x, y, z] = [widened(x), widened(y), widened(z)];
        let heights = x * self.dir[0] + y * self.dir[1] + z * self.dir[2];
        let higher = heights.simd_gt(self.heights);
        let places = u64x4::splat(place as u64) + u64x4::new([0, 1, 2, 3]);
        self.heights = higher.bitselect(heights, self.heights);
        self.places = higher.bitselect(bytemuck::cast(places), self.places);
    }

    /// Of points that tie one in the lowest lane, if any of them is there. (Halves against each other
    /// and then their lanes: fewer steps that wait for each other than lane by lane.)
    #[inline(always)]
    pub fn top(self) -> Top {
        let [low, high]: [f64x2; 2] = bytemuck::cast(self.heights);
        let [low_places, high_places]: [f64x2; 2] = bytemuck::cast(self.places);
        let higher = high.simd_gt(low);
        let heights = higher.bitselect(high, low).to_array();
        let places = higher.bitselect(high_places, low_places).to_array();
        let second = heights[1] > heights[0];
        let place = if second { places[1] } else { places[0] };
        Top {
            place: place.to_bits() as usize,
            height: if second { heights[1] } else { heights[0] },
        }
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
