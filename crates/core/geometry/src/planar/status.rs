//! The status of a sweep line: the sides under it, in order, in a balanced tree.

use super::NO_ENTRY;

/// A sequence of sides from bottom to top, without repetitions.
///
/// A *treap* (Aragon, Seidel 1989): a search tree by position and a heap by priorities. Priorities are hashes of the
/// sides' numbers, so the same input gives the same tree. Insertion and search take expected logarithmic time, removal
/// and neighbours constant time.
///
/// Sides are located by number, never by comparison. If rounding of the input has made the order inconsistent, results
/// can be wrong, but every operation ends.
#[derive(Debug, Clone)]
pub struct Status {
    root: u32,
    first: u32,
    nodes: Vec<Node>,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    parent: u32,
    /// The children, below and above.
    children: [u32; 2],
    previous: u32,
    next: u32,
}

const SINGLE_NODE: Node = Node { parent: NO_ENTRY, children: [NO_ENTRY; 2], previous: NO_ENTRY, next: NO_ENTRY };

impl Status {
    /// Creates an empty sequence for up to `count` sides.
    pub fn new(count: usize) -> Self {
        Self { root: NO_ENTRY, first: NO_ENTRY, nodes: vec![SINGLE_NODE; count] }
    }

    /// Returns the side above `side`, or the lowest side if `side` is `None`.
    pub fn above(&self, side: Option<usize>) -> Option<usize> {
        index(side.map_or(self.first, |side| self.nodes[side].next))
    }

    /// Returns the side below `side`.
    pub fn below(&self, side: usize) -> Option<usize> {
        index(self.nodes[side].previous)
    }

    /// Returns the highest side for which `holds` is true. If it is true for a side, it must be true for all sides below.
    pub fn last_where(&self, mut holds: impl FnMut(usize) -> bool) -> Option<usize> {
        let (mut at, mut best) = (self.root, NO_ENTRY);
        while at != NO_ENTRY {
            let upwards = holds(at as usize);
            if upwards {
                best = at;
            }
            at = self.nodes[at as usize].children[usize::from(upwards)];
        }
        index(best)
    }

    /// Inserts a side above another, or below all if `below` is `None`.
    pub fn insert_above(&mut self, below: Option<usize>, side: usize) {
        let next = self.above(below);
        let number = side as u32;
        self.nodes[side] = Node { previous: number_of(below), next: number_of(next), ..SINGLE_NODE };
        match below {
            Some(below) => self.nodes[below].next = number,
            None => self.first = number,
        }
        if let Some(next) = next {
            self.nodes[next].previous = number;
        }
        // Of two neighbours, one is below the other in the tree, and has no child on that side.
        let (parent, child) = match (below, next) {
            (Some(below), _) if self.nodes[below].children[1] == NO_ENTRY => (below, 1),
            (_, Some(next)) => (next, 0),
            _ => {
                self.root = number;
                return;
            }
        };
        self.nodes[parent].children[child] = number;
        self.nodes[side].parent = parent as u32;
        while index(self.nodes[side].parent).is_some_and(|parent| priority(parent) < priority(side)) {
            self.rotate_up(side);
        }
    }

    /// Removes a side, which must be in the sequence.
    pub fn remove(&mut self, side: usize) {
        let Node { previous, next, .. } = self.nodes[side];
        match index(previous) {
            Some(previous) => self.nodes[previous].next = next,
            None => self.first = next,
        }
        if let Some(next) = index(next) {
            self.nodes[next].previous = previous;
        }
        while let [Some(below), Some(above)] = self.nodes[side].children.map(index) {
            self.rotate_up(if priority(below) > priority(above) { below } else { above });
        }
        let Node { parent, children: [below, above], .. } = self.nodes[side];
        let child = if below == NO_ENTRY { above } else { below };
        self.replace_child(parent, side as u32, child);
        self.nodes[side] = SINGLE_NODE;
    }

    /// Swaps a node with its parent.
    fn rotate_up(&mut self, side: usize) {
        let number = side as u32;
        let parent = self.nodes[side].parent;
        let Node { parent: grandparent, children, .. } = self.nodes[parent as usize];
        let place = usize::from(children[1] == number);
        let middle = self.nodes[side].children[1 - place];
        self.nodes[parent as usize].children[place] = middle;
        if let Some(middle) = index(middle) {
            self.nodes[middle].parent = parent;
        }
        self.nodes[side].children[1 - place] = parent;
        self.nodes[parent as usize].parent = number;
        self.replace_child(grandparent, parent, number);
    }

    fn replace_child(&mut self, parent: u32, old: u32, new: u32) {
        match index(parent) {
            Some(parent) => {
                let children = &mut self.nodes[parent].children;
                children[usize::from(children[1] == old)] = new;
            }
            None => self.root = new,
        }
        if let Some(new) = index(new) {
            self.nodes[new].parent = parent;
        }
    }
}

fn index(number: u32) -> Option<usize> {
    (number != NO_ENTRY).then_some(number as usize)
}

fn number_of(side: Option<usize>) -> u32 {
    side.map_or(NO_ENTRY, |side| side as u32)
}

/// Mixes the bits of a side's number (the finaliser of SplitMix64).
fn priority(side: usize) -> u64 {
    let z = (side as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        /// Compares with a sorted list, whose positions are known.
        #[test]
        fn the_status_keeps_the_order_of_a_sorted_list(steps in proptest::collection::vec((0usize..60, any::<bool>()), 0..300)) {
            let place = |side: usize| (side * 37) % 61;
            let mut status = Status::new(60);
            let mut list: Vec<usize> = Vec::new();
            for (side, insert) in steps {
                let at = list.partition_point(|&s| place(s) < place(side));
                let found = status.last_where(|s| place(s) < place(side));
                prop_assert_eq!(found, at.checked_sub(1).map(|k| list[k]));
                let present = list.get(at) == Some(&side);
                if insert && !present {
                    status.insert_above(found, side);
                    list.insert(at, side);
                } else if !insert && present {
                    status.remove(side);
                    list.remove(at);
                }
                let mut walked = Vec::new();
                let mut at = status.above(None);
                while let Some(side) = at {
                    prop_assert_eq!(status.below(side), walked.last().copied());
                    walked.push(side);
                    at = status.above(at);
                }
                prop_assert_eq!(&walked, &list);
            }
        }
    }
}
