//! The queue of positions from which the next window starts.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// Positions ordered by key, then by number, so that the order is deterministic.
#[derive(Debug, Clone, Default)]
pub(super) struct KeyQueue {
    heap: BinaryHeap<Reverse<(Key, u32)>>,
}

/// A double in the total order of IEEE 754.
#[derive(Debug, Clone, Copy)]
struct Key(f64);

impl Ord for Key {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl PartialOrd for Key {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Key {}

impl KeyQueue {
    /// Adds a position. `O(log n)`.
    pub fn push(&mut self, key: f64, position: u32) {
        self.heap.push(Reverse((Key(key), position)));
    }

    /// Removes the first position. `O(log n)`.
    pub fn pop(&mut self) {
        self.heap.pop();
    }

    /// Returns the first position and its key.
    pub fn peek(&self) -> Option<(f64, u32)> {
        self.heap.peek().map(|&Reverse((Key(key), position))| (key, position))
    }

    /// Removes all positions.
    pub fn clear(&mut self) {
        self.heap.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_key_comes_first_then_the_least_position() {
        let mut front = KeyQueue::default();
        [(2.0, 0), (1.0, 7), (f64::INFINITY, 1), (1.0, 3)].into_iter().for_each(|(key, at)| front.push(key, at));
        let order = std::iter::from_fn(|| front.peek().inspect(|_| front.pop())).collect::<Vec<_>>();
        assert_eq!(order, [(1.0, 3), (1.0, 7), (2.0, 0), (f64::INFINITY, 1)]);
    }
}
