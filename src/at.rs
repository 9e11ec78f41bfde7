//! Short indices, as hulls store them: they take half or a quarter of the bytes of a `usize`.

/// Access to elements by short indices.
pub(crate) trait At<T> {
    /// The element at an index.
    ///
    /// # Panics
    /// If there is none.
    fn at(&self, index: u32) -> T
    where
        T: Copy;

    /// A reference to the element at an index.
    ///
    /// # Panics
    /// If there is none.
    fn at_ref(&self, index: u32) -> &T;

    /// The place of the element at an index.
    ///
    /// # Panics
    /// If there is none.
    fn at_mut(&mut self, index: u32) -> &mut T;

    /// A reference to the element at an index, if there is one.
    fn try_at(&self, index: u32) -> Option<&T>;

    /// The place of the element at an index, if there is one.
    fn try_at_mut(&mut self, index: u32) -> Option<&mut T>;

    /// The number of elements, which short indices reach.
    fn short_len(&self) -> u32;
}

impl<T> At<T> for [T] {
    #[inline]
    fn at(&self, index: u32) -> T
    where
        T: Copy,
    {
        *self.at_ref(index)
    }

    #[inline]
    fn at_ref(&self, index: u32) -> &T {
        &self[index as usize]
    }

    #[inline]
    fn at_mut(&mut self, index: u32) -> &mut T {
        &mut self[index as usize]
    }

    #[inline]
    fn try_at(&self, index: u32) -> Option<&T> {
        self.get(index as usize)
    }

    #[inline]
    fn try_at_mut(&mut self, index: u32) -> Option<&mut T> {
        self.get_mut(index as usize)
    }

    #[inline]
    fn short_len(&self) -> u32 {
        to_u32(self.len())
    }
}

/// An index that is known to fit into 32 bits.
#[inline]
pub(crate) const fn to_u32(index: usize) -> u32 {
    debug_assert!(index.leading_zeros() >= usize::BITS - u32::BITS);
    index as u32
}

/// An index that is known to fit into 16 bits.
#[inline]
pub(crate) const fn to_u16(index: usize) -> u16 {
    debug_assert!(index.leading_zeros() >= usize::BITS - u16::BITS);
    index as u16
}
