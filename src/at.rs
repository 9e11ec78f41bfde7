//! Slices with indices of type u32, as hulls store them: they are half as long as `usize`.

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
        debug_assert!(u32::try_from(self.len()).is_ok());
        self.len() as u32
    }
}
