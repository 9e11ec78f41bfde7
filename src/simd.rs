//! Four values at once: vectors coordinate by coordinate, masks of lanes, and the greatest of many.
//!
//! There is no branch for each value, since which one is the greatest so far is not predictable.

use std::ops::{Add, Sub};

use glam::{DVec3, Vec3};
use wide::f64x2;
pub(crate) use wide::{f32x4, f32x8, f64x4, u32x4, u64x4};

/// How many values are looked at together: most faces have no more corners.
pub(crate) const LANES: usize = 4;

/// The bits of all lanes.
pub(crate) const ALL: u32 = (1 << LANES) - 1;

/// Four vectors.
#[derive(Clone, Copy)]
pub(crate) struct DVec3x4(pub [f64x4; 3]);

impl DVec3x4 {
    /// The places of four things.
    #[inline(always)]
    pub fn gather<T>([a, b, c, d]: [T; 4], place: impl Fn(T) -> DVec3) -> Self {
        let [a, b, c, d] = [place(a), place(b), place(c), place(d)];
        Self([
            f64x4::new([a.x, b.x, c.x, d.x]),
            f64x4::new([a.y, b.y, c.y, d.y]),
            f64x4::new([a.z, b.z, c.z, d.z]),
        ])
    }

    /// Multiples of one vector.
    #[inline(always)]
    pub fn scaled(dir: DVec3, lengths: f64x4) -> Self {
        Self([lengths * dir.x, lengths * dir.y, lengths * dir.z])
    }

    #[inline(always)]
    pub fn dot(self, dir: DVec3) -> f64x4 {
        let [x, y, z] = self.0;
        x * dir.x + y * dir.y + z * dir.z
    }

    #[inline(always)]
    pub fn length_squared(self) -> f64x4 {
        let [x, y, z] = self.0;
        x * x + y * y + z * z
    }

    #[inline(always)]
    pub fn to_f32x4(self) -> [f32x4; 3] {
        let [x, y, z] = self.0;
        [to_f32x4(x), to_f32x4(y), to_f32x4(z)]
    }
}

impl Sub for DVec3x4 {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let ([x, y, z], [a, b, c]) = (self.0, other.0);
        Self([x - a, y - b, z - c])
    }
}

impl Add for DVec3x4 {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let ([x, y, z], [a, b, c]) = (self.0, other.0);
        Self([x + a, y + b, z + c])
    }
}

impl Sub<DVec3> for DVec3x4 {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: DVec3) -> Self {
        let [x, y, z] = self.0;
        Self([x - other.x, y - other.y, z - other.z])
    }
}

#[inline(always)]
pub(crate) fn to_f32x4(four: f64x4) -> f32x4 {
    let [a, b, c, d] = four.to_array();
    f32x4::new([a as f32, b as f32, c as f32, d as f32])
}

/// The bits of the first lanes: so many, or all.
#[inline(always)]
pub(crate) fn first_lanes(count: usize) -> u32 {
    ALL >> LANES.saturating_sub(count)
}

/// A mask of the lanes whose bits are set.
#[inline(always)]
pub(crate) fn lane_mask(bits: u32) -> f32x4 {
    const MASKS: [[u32; LANES]; 1 << LANES] = {
        let mut masks = [[0; LANES]; 1 << LANES];
        let mut i = 0;
        while i < masks.len() * LANES {
            let (bits, lane) = (i / LANES, i % LANES);
            masks[bits][lane] = if bits >> lane & 1 == 1 { u32::MAX } else { 0 };
            i += 1;
        }
        masks
    };
    bytemuck::cast(MASKS[(bits & ALL) as usize])
}

/// Keeps the greatest value of each lane, and chooses among them at the end.
pub(crate) struct ArgMax4 {
    values: f64x4,
    /// What each value is of: bits of whole numbers, since lanes are selected together with those of the
    /// values.
    ids: f64x4,
}

/// The greatest value, and what it is of.
pub(crate) struct ArgMax {
    pub id: u64,
    pub value: f64,
}

impl ArgMax4 {
    /// Of values above `least`. Where there are none it is this one, with the id 0.
    #[inline(always)]
    pub fn new(least: f64) -> Self {
        Self {
            values: f64x4::splat(least),
            ids: f64x4::ZERO,
        }
    }

    #[inline(always)]
    pub fn update(&mut self, values: f64x4, ids: u64x4) {
        let greater = values.simd_gt(self.values);
        self.values = greater.bitselect(values, self.values);
        self.ids = greater.bitselect(bytemuck::cast(ids), self.ids);
    }

    /// The greatest value. Of lanes that tie, lane 0 wins, then 2, 1 and 3; within a lane, the first
    /// value offered. (The two halves are compared first, and then the lanes of the result: a shorter
    /// dependency chain than lane by lane.)
    #[inline(always)]
    pub fn finish(self) -> ArgMax {
        let [low, high]: [f64x2; 2] = bytemuck::cast(self.values);
        let [low_ids, high_ids]: [f64x2; 2] = bytemuck::cast(self.ids);
        let greater = high.simd_gt(low);
        let values = greater.bitselect(high, low).to_array();
        let ids = greater.bitselect(high_ids, low_ids).to_array();
        let second = values[1] > values[0];
        let id = if second { ids[1] } else { ids[0] };
        ArgMax {
            id: id.to_bits(),
            value: if second { values[1] } else { values[0] },
        }
    }
}

/// The highest point so far.
pub(crate) struct ArgMaxDot {
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
pub(crate) fn coordinates([a, b, c, d]: [&Vec3; LANES]) -> [[f32; LANES]; 3] {
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
