//! Slots of direct-mapped caches.

use crate::mix::mix;

/// The slot of a key among `1 << bits`.
#[inline]
pub fn slot(key: u64, bits: u32) -> usize {
    (mix(key) >> (u64::BITS - bits)) as usize
}
