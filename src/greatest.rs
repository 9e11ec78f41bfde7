//! The greatest of many values, found four at a time: there is no branch for each of them, since which
//! one is the greatest so far is not predictable.

use wide::{f64x2, f64x4, u64x4};

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
