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

    /// The place of the element at an index.
    ///
    /// # Panics
    /// If there is none.
    fn at_mut(&mut self, index: u32) -> &mut T;
}

impl<T> At<T> for [T] {
    #[inline]
    fn at(&self, index: u32) -> T
    where
        T: Copy,
    {
        self[index as usize]
    }

    #[inline]
    fn at_mut(&mut self, index: u32) -> &mut T {
        &mut self[index as usize]
    }
}
