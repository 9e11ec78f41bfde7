//! The greatest of many values, found four at a time: there is no branch for each of them, since which
//! one is the greatest so far is not predictable.

use wide::{f64x2, f64x4, u64x4};

/// Keeps the greatest value of each lane, and chooses among them at the end.
pub(crate) struct Greatest {
    values: f64x4,
    /// What each value is of: bits of whole numbers, since lanes are selected together with those of the
    /// values.
    names: f64x4,
}

/// The greatest value, and what it is of.
pub(crate) struct Top {
    pub name: u64,
    pub value: f64,
}

impl Greatest {
    /// Of values above `least`. Where there are none it is this one, of the name 0.
    #[inline(always)]
    pub fn above(least: f64) -> Self {
        Self {
            values: f64x4::splat(least),
            names: f64x4::ZERO,
        }
    }

    #[inline(always)]
    pub fn look_at(&mut self, values: f64x4, names: u64x4) {
        let greater = values.simd_gt(self.values);
        self.values = greater.bitselect(values, self.values);
        self.names = greater.bitselect(bytemuck::cast(names), self.names);
    }

    /// The greatest value. Of lanes that tie, lane 0 wins, then 2, 1 and 3; within a lane, the first
    /// value offered. (The two halves are compared first, and then the lanes of the result: a shorter
    /// dependency chain than lane by lane.)
    #[inline(always)]
    pub fn top(self) -> Top {
        let [low, high]: [f64x2; 2] = bytemuck::cast(self.values);
        let [low_names, high_names]: [f64x2; 2] = bytemuck::cast(self.names);
        let greater = high.simd_gt(low);
        let values = greater.bitselect(high, low).to_array();
        let names = greater.bitselect(high_names, low_names).to_array();
        let second = values[1] > values[0];
        let name = if second { names[1] } else { names[0] };
        Top {
            name: name.to_bits(),
            value: if second { values[1] } else { values[0] },
        }
    }
}
