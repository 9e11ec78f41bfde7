//! Lists of lists, and lists by size.

use std::cmp::Reverse;

/// Lists, one after the other.
#[derive(Clone, Debug)]
pub(super) struct Rows<T> {
    items: Vec<T>,
    ends: Vec<usize>,
}

impl<T> Default for Rows<T> {
    fn default() -> Self {
        Self {
            items: Vec::new(),
            ends: Vec::new(),
        }
    }
}

impl<T> Rows<T> {
    pub fn push(&mut self, items: impl IntoIterator<Item = T>) {
        self.items.extend(items);
        self.ends.push(self.items.len());
    }

    /// The number of lists.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    pub fn row(&self, row: usize) -> &[T] {
        let first = row.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.items[first..self.ends[row]]
    }

    pub fn heap_bytes(&self) -> usize {
        self.items.capacity() * size_of::<T>() + self.ends.capacity() * size_of::<usize>()
    }
}

/// Items of these sizes, which are not negative, from the largest to the smallest.
pub(super) fn largest_first<T: Copy + Ord>(
    items: impl Iterator<Item = T>,
    size: impl Fn(T) -> f64,
) -> impl Iterator<Item = T> {
    // The bits of non-negative numbers sort as the numbers do.
    let mut items: Vec<_> = items
        .map(|item| (Reverse(size(item).to_bits()), item))
        .collect();
    items.sort_unstable();
    items.into_iter().map(|(_, item)| item)
}
