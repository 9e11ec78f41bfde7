//! Hashing of integers by multiplication.

/// 2^64 divided by the golden ratio, rounded to an odd number. Each bit of a factor changes about half of the higher
/// bits of the product.
pub(crate) const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// The hash of a list with one more word.
#[inline]
pub(crate) fn extended(hash: u64, word: u64) -> u64 {
    let product = u128::from(hash ^ word) * u128::from(GOLDEN);
    (product >> 64) as u64 ^ product as u64
}

/// Spreads an integer over 64 bits (Fibonacci hashing). The highest bits depend on all of the integer, and no two
/// integers give the same.
#[inline]
pub(crate) fn mix(word: u64) -> u64 {
    let product = word.wrapping_mul(GOLDEN);
    product ^ product >> 32
}
