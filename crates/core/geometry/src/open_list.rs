//! The open list of a best-first search.

use super::OrderedF64;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Entries ordered by key, and by value if keys are equal, so that the order is deterministic.
#[derive(Debug, Clone)]
pub struct OpenList<T> {
    heap: BinaryHeap<Reverse<(OrderedF64, T)>>,
}

impl<T: Ord> Default for OpenList<T> {
    fn default() -> Self {
        Self { heap: BinaryHeap::new() }
    }
}

impl<T: Ord> OpenList<T> {
    /// Adds an entry. `O(log n)`.
    pub fn push(&mut self, key: f64, entry: T) {
        self.heap.push(Reverse((OrderedF64(key), entry)));
    }

    /// Removes and returns the entry with the least key. `O(log n)`.
    pub fn pop(&mut self) -> Option<(f64, T)> {
        self.heap.pop().map(|Reverse((OrderedF64(key), entry))| (key, entry))
    }

    /// Returns the entry with the least key.
    pub fn peek(&self) -> Option<(f64, &T)> {
        self.heap.peek().map(|Reverse((OrderedF64(key), entry))| (*key, entry))
    }

    /// Removes all entries.
    pub fn clear(&mut self) {
        self.heap.clear();
    }

    /// Removes and returns all entries in arbitrary order.
    pub fn drain(&mut self) -> Vec<T> {
        self.heap.drain().map(|Reverse((_, entry))| entry).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_key_comes_first_then_the_least_entry() {
        let mut open = OpenList::default();
        [(2.0, 0), (1.0, 7), (f64::INFINITY, 1), (1.0, 3)].into_iter().for_each(|(key, entry)| open.push(key, entry));
        assert_eq!(open.peek(), Some((1.0, &3)));
        let order: Vec<(f64, i32)> = std::iter::from_fn(|| open.pop()).collect();
        assert_eq!(order, [(1.0, 3), (1.0, 7), (2.0, 0), (f64::INFINITY, 1)]);
    }
}
