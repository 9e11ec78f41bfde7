//! Lists of lists, and lists by size.

use std::cmp::Reverse;

use crate::at::At;

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
    /// With room for so many lists, and so many items in all of them.
    pub fn with_capacity(lists: usize, items: usize) -> Self {
        Self {
            items: Vec::with_capacity(items),
            ends: Vec::with_capacity(lists),
        }
    }

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

    pub fn rows(&self) -> impl Iterator<Item = &[T]> {
        (0..self.len()).map(|row| self.row(row))
    }

    /// Sorts items into `count` lists by their keys, each list in the given order (a counting sort). `None` if a
    /// key is too large.
    pub fn by_key(count: usize, items: impl Iterator<Item = (u32, T)> + Clone) -> Option<Self>
    where
        T: Copy + Default,
    {
        let mut places = vec![0; count + 1];
        for (key, _) in items.clone() {
            *places.get_mut(key as usize + 1)? += 1;
        }
        for key in 1..places.len() {
            places[key] += places[key - 1];
        }
        let mut sorted = vec![T::default(); places[count]];
        // This moves each place from where a list begins to where it ends.
        for (key, item) in items {
            let place = places.at_mut(key);
            sorted[*place] = item;
            *place += 1;
        }
        places.pop();
        Some(Self {
            items: sorted,
            ends: places,
        })
    }

    /// Calls `f` for each list.
    pub fn each_mut(&mut self, mut f: impl FnMut(&mut [T])) {
        let mut first = 0;
        for &end in &self.ends {
            f(&mut self.items[first..end]);
            first = end;
        }
    }

    /// All lists in one.
    pub fn into_items(self) -> Vec<T> {
        self.items
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
