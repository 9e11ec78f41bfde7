//! The greatest of many values, four at a time.
//!
//! There is no branch per value, since it is not predictable which value is the greatest so far.

use std::ops::BitAnd;

use glam::DVec3;

use crate::simd::{LANES, f32x4, f64x2, f64x4, u32x4, u64x4, widened};

/// Four numbers that can be compared: `f32x4` or `f64x4`.
pub(crate) trait Lanes: Copy + Default + BitAnd<Output = Self> {
    type Value;
    /// Whole numbers as wide as the values, so that one mask selects both.
    type Ids;

    fn splat(value: Self::Value) -> Self;
    fn from_bits(ids: Self::Ids) -> Self;
    /// A mask of the lanes in which these values are greater.
    fn greater_than(self, others: Self) -> Self;
    /// Lanes of `yes` where this mask is set, else of `no`.
    fn select(self, yes: Self, no: Self) -> Self;
    /// The greatest of the values, and the id in its lane. In a tie the lowest lane wins.
    fn greatest(self, ids: Self) -> ArgMax<Self::Value>;
}

/// What is the same for both types.
macro_rules! same_lanes {
    ($value:ty, $ids:ty) => {
        type Value = $value;
        type Ids = $ids;

        #[inline(always)]
        fn splat(value: $value) -> Self {
            Self::splat(value)
        }

        #[inline(always)]
        fn from_bits(ids: $ids) -> Self {
            bytemuck::cast(ids)
        }

        #[inline(always)]
        fn greater_than(self, others: Self) -> Self {
            self.simd_gt(others)
        }

        #[inline(always)]
        fn select(self, yes: Self, no: Self) -> Self {
            self.bitselect(yes, no)
        }
    };
}

impl Lanes for f64x4 {
    same_lanes!(f64, u64x4);

    /// Compares lanes 0 and 2 with 1 and 3, and then the two winners: this dependency chain is shorter than
    /// lane by lane.
    #[inline(always)]
    fn greatest(self, ids: Self) -> ArgMax<f64> {
        let halves = |four: Self| {
            let [a, b, c, d] = four.to_array();
            (f64x2::new([a, c]), f64x2::new([b, d]))
        };
        let ((even, odd), (even_ids, odd_ids)) = (halves(self), halves(ids));
        let greater = odd.simd_gt(even);
        let [low, high] = greater.bitselect(odd, even).to_array();
        let [low_id, high_id] = greater.bitselect(odd_ids, even_ids).to_array();
        let (value, id) = if high > low {
            (high, high_id)
        } else {
            (low, low_id)
        };
        let id = id.to_bits() as usize;
        ArgMax { id, value }
    }
}

impl Lanes for f32x4 {
    same_lanes!(f32, u32x4);

    #[inline(always)]
    fn greatest(self, ids: Self) -> ArgMax<f32> {
        let [a, b, c, d] = self.to_array();
        let greater = |a: f32, b: f32| if a > b { a } else { b };
        let value = greater(greater(a, b), greater(c, d));
        let lane = self
            .simd_eq(Self::splat(value))
            .to_bitmask()
            .trailing_zeros() as usize;
        ArgMax {
            id: ids.to_array()[lane % LANES].to_bits() as usize,
            value,
        }
    }
}

/// Keeps the greatest value of each lane, and chooses among these at the end. In a tie the lowest lane wins,
/// and within a lane the first value.
pub(crate) struct ArgMax4<V> {
    values: V,
    /// The id of each value.
    ids: V,
}

/// The greatest value, and its id.
pub(crate) struct ArgMax<T> {
    pub id: usize,
    pub value: T,
}

impl<V: Lanes> ArgMax4<V> {
    /// Only values above `least` count. If there are none, the result is `least` with the id 0.
    #[inline(always)]
    pub fn new(least: V::Value) -> Self {
        Self {
            values: V::splat(least),
            ids: V::default(),
        }
    }

    #[inline(always)]
    pub fn update(&mut self, values: V, ids: V::Ids) {
        self.replace(values.greater_than(self.values), values, ids);
    }

    /// Only the values in these lanes count.
    #[inline(always)]
    pub fn update_where(&mut self, lanes: V, values: V, ids: V::Ids) {
        self.replace(values.greater_than(self.values) & lanes, values, ids);
    }

    #[inline(always)]
    fn replace(&mut self, lanes: V, values: V, ids: V::Ids) {
        self.values = lanes.select(values, self.values);
        self.ids = lanes.select(V::from_bits(ids), self.ids);
    }

    #[inline(always)]
    pub fn finish(self) -> ArgMax<V::Value> {
        self.values.greatest(self.ids)
    }
}

/// The highest point so far.
pub(crate) struct ArgMaxDot {
    dir: [f64x4; 3],
    heights: ArgMax4<f64x4>,
}

impl ArgMaxDot {
    #[inline(always)]
    pub fn new(dir: DVec3) -> Self {
        Self {
            dir: dir.to_array().map(f64x4::splat),
            heights: ArgMax4::new(f64::NEG_INFINITY),
        }
    }

    /// Compares four points, given coordinate by coordinate. The first of them has this index.
    #[inline(always)]
    pub fn update(&mut self, place: usize, coordinates: [[f32; LANES]; 3]) {
        let [x, y, z] = coordinates;
        let [x, y, z] = [widened(x), widened(y), widened(z)];
        let heights = x * self.dir[0] + y * self.dir[1] + z * self.dir[2];
        let places = u64x4::splat(place as u64) + u64x4::new([0, 1, 2, 3]);
        self.heights.update(heights, places);
    }

    /// The index of the highest point, and its height.
    #[inline(always)]
    pub fn finish(self) -> ArgMax<f64> {
        self.heights.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::lane_mask;

    /// In all subsets of lanes.
    #[test]
    fn the_lowest_lane_wins_ties() {
        for ties in 1_u32..1 << LANES {
            let values = [0, 1, 2, 3].map(|lane| f64::from(ties >> lane & 1));
            let mut doubles = ArgMax4::<f64x4>::new(-1.0);
            doubles.update(f64x4::new(values), u64x4::new([0, 1, 2, 3]));
            let mut singles = ArgMax4::<f32x4>::new(-1.0);
            let values = f32x4::new(values.map(|value| value as f32));
            singles.update(values, u32x4::new([0, 1, 2, 3]));
            let (double, single) = (doubles.finish(), singles.finish());
            assert_eq!((double.value, single.value), (1.0, 1.0));
            let lowest = ties.trailing_zeros() as usize;
            assert_eq!([double.id, single.id], [lowest; 2], "of {ties:04b}");
        }
    }

    #[test]
    fn the_first_of_a_lane_wins_ties() {
        let mut greatest = ArgMax4::<f64x4>::new(-1.0);
        for round in 0..3 {
            let ids = u64x4::splat(10 * round) + u64x4::new([0, 1, 2, 3]);
            greatest.update(f64x4::new([-1.0, 0.0, -2.0, 0.0]), ids);
        }
        assert_eq!(greatest.finish().id, 1);
    }

    #[test]
    fn only_wanted_lanes_count() {
        let mut greatest = ArgMax4::<f32x4>::new(0.0);
        let (values, ids) = (f32x4::new([1.0, 9.0, 2.0, 8.0]), u32x4::new([1, 2, 3, 4]));
        greatest.update_where(lane_mask(0b0101), values, ids);
        assert_eq!(greatest.finish().id, 3);
        let nothing = ArgMax4::<f32x4>::new(0.0).finish();
        assert_eq!((nothing.id, nothing.value), (0, 0.0));
    }
}
