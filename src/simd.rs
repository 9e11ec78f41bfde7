//! Four values at once: vectors coordinate by coordinate, and masks of lanes.

use std::ops::{Add, Mul, Sub};

use glam::{DVec3, Vec3};
pub(crate) use wide::{f32x4, f32x8, f64x2, f64x4, u32x4, u64x4};

/// How many values are processed together. Most faces have no more corners than this.
pub(crate) const LANES: usize = 4;

/// The bits of all lanes.
pub(crate) const ALL: u32 = (1 << LANES) - 1;

/// Four vectors.
#[derive(Clone, Copy)]
pub(crate) struct DVec3x4(pub [f64x4; 3]);

impl DVec3x4 {
    /// The positions of four items.
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

    /// The products lane by lane.
    #[inline(always)]
    pub fn dot_each(self, other: Self) -> f64x4 {
        let ([x, y, z], [a, b, c]) = (self.0, other.0);
        x * a + y * b + z * c
    }

    #[inline]
    pub fn cross(self, other: Self) -> Self {
        let ([x, y, z], [a, b, c]) = (self.0, other.0);
        Self([y * c - b * z, z * a - c * x, x * b - a * y])
    }

    #[inline(always)]
    pub fn length_squared(self) -> f64x4 {
        let [x, y, z] = self.0;
        x * x + y * y + z * z
    }

    /// All four together.
    #[inline(always)]
    pub fn sum(self) -> DVec3 {
        DVec3::from(self.0.map(sum))
    }

    #[inline(always)]
    pub fn to_f32x4(self) -> [f32x4; 3] {
        let [x, y, z] = self.0;
        [to_f32x4(x), to_f32x4(y), to_f32x4(z)]
    }
}

impl Mul<f64x4> for DVec3x4 {
    type Output = Self;

    #[inline(always)]
    fn mul(self, by: f64x4) -> Self {
        Self(self.0.map(|row| row * by))
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

/// In the same order on every machine.
#[inline(always)]
pub(crate) fn sum(four: f64x4) -> f64 {
    let [a, b, c, d] = four.to_array();
    (a + b) + (c + d)
}

#[inline(always)]
pub(crate) fn to_f32x4(four: f64x4) -> f32x4 {
    let [a, b, c, d] = four.to_array();
    f32x4::new([a as f32, b as f32, c as f32, d as f32])
}

/// The bits of the first `count` lanes, or of all.
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
pub(crate) fn widened([a, b, c, d]: [f32; LANES]) -> f64x4 {
    f64x4::new([a.into(), b.into(), c.into(), d.into()])
}
