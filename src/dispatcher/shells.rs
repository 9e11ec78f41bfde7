//! The shells of pairs that overlap deeply: proofs only, so that it does not matter which pair finds
//! whose.

use crate::epa::Shell;

/// A thread keeps so many, found by where the pair's manifold is.
const SLOTS: usize = 1 << SLOT_BITS;
const SLOT_BITS: u32 = 9;

/// The shells of a thread.
pub(super) struct ShellTable(Box<[Shell]>);

impl Default for ShellTable {
    fn default() -> Self {
        Self(vec![Shell::default(); SLOTS].into())
    }
}

impl ShellTable {
    /// The one for the pair with this manifold.
    #[inline]
    pub fn of<T>(&mut self, manifold: &T) -> &mut Shell {
        // Fibonacci hashing: the highest bits depend on all bits of the address.
        let address = (&raw const *manifold).addr() as u64;
        let slot = address.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (u64::BITS - SLOT_BITS);
        &mut self.0[slot as usize]
    }
}
