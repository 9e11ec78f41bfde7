//! Direct-mapped caches.

use crate::mix::mix;

/// `1 << BITS` slots, allocated when something is first stored. A key gives the slot, which it shares with other keys:
/// what is found there must tell whether it is meant.
#[derive(Clone, Debug)]
pub(crate) struct Slots<T, const BITS: u32>(Box<[T]>);

impl<T, const BITS: u32> Default for Slots<T, BITS> {
    fn default() -> Self {
        Self(Box::default())
    }
}

impl<T: Clone + Default, const BITS: u32> Slots<T, BITS> {
    /// The slot of a key. `None` if nothing was ever stored.
    #[inline]
    pub fn get(&self, key: u64) -> Option<&T> {
        self.0.get(Self::index(key))
    }

    /// Like [`get`](Self::get), to be changed in place.
    #[inline]
    pub fn get_mut(&mut self, key: u64) -> Option<&mut T> {
        self.0.get_mut(Self::index(key))
    }

    /// The slot of a key, to store something in it.
    #[inline]
    pub fn get_or_allocate(&mut self, key: u64) -> &mut T {
        if self.0.is_empty() {
            self.0 = vec![T::default(); 1 << BITS].into();
        }
        &mut self.0[Self::index(key)]
    }

    #[inline]
    fn index(key: u64) -> usize {
        (mix(key) >> (u64::BITS - BITS)) as usize
    }
}
