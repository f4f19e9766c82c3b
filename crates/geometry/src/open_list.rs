//! The list of what a search looks at next.

use super::Ordered;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// What waits to be looked at: least key first, of equal keys the least entry, so that nothing is left to chance.
#[derive(Debug, Clone)]
pub struct OpenList<T> {
    heap: BinaryHeap<Reverse<(Ordered, T)>>,
}

impl<T: Ord> Default for OpenList<T> {
    fn default() -> Self {
        Self { heap: BinaryHeap::new() }
    }
}

impl<T: Ord> OpenList<T> {
    /// Adds an entry. `O(log n)`.
    pub fn push(&mut self, key: f64, entry: T) {
        self.heap.push(Reverse((Ordered(key), entry)));
    }

    /// Takes the next entry. `O(log n)`.
    pub fn pop(&mut self) -> Option<(f64, T)> {
        self.heap.pop().map(|Reverse((Ordered(key), entry))| (key, entry))
    }

    /// The next entry.
    #[must_use]
    pub fn peek(&self) -> Option<(f64, &T)> {
        self.heap.peek().map(|Reverse((Ordered(key), entry))| (*key, entry))
    }

    /// Takes all entries away.
    pub fn clear(&mut self) {
        self.heap.clear();
    }

    /// Takes all entries, in no order.
    pub fn drain(&mut self) -> Vec<T> {
        self.heap.drain().map(|Reverse((_, entry))| entry).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn least_first_then_the_least_entry() {
        let mut open = OpenList::default();
        [(2.0, 0), (1.0, 7), (f64::INFINITY, 1), (1.0, 3)].into_iter().for_each(|(key, entry)| open.push(key, entry));
        assert_eq!(open.peek(), Some((1.0, &3)));
        let order: Vec<(f64, i32)> = std::iter::from_fn(|| open.pop()).collect();
        assert_eq!(order, [(1.0, 3), (1.0, 7), (2.0, 0), (f64::INFINITY, 1)]);
    }
}
