//! Slots of direct-mapped caches.

/// The slot of a key among `1 << bits`, by Fibonacci hashing: the highest bits depend on all bits of the key.
#[inline]
pub fn slot(key: u64, bits: u32) -> usize {
    (key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (u64::BITS - bits)) as usize
}
