//! A tree of boxes that finds the boxes which meet a given box.

use super::Point;

/// A box parallel to the axes, as its least and its greatest coordinates.
pub type Bounds = [Point; 2];

/// Largest number of boxes in a leaf. So few boxes are tested fastest one by one.
const MAX_LEAF_BOXES: usize = 8;

/// A tree of boxes. Each node splits its boxes in two at the median centre, along the longer side of their common
/// bounds.
///
/// Construction takes `O(n log n)`. A query takes `O(log n)` plus time proportional to the number of boxes found.
#[derive(Debug, Clone, Default)]
pub struct BoxTree {
    boxes: Vec<Bounds>,
    /// Indices of the boxes. A node is a range of this list, and its children are the two halves of that range.
    order: Vec<u32>,
    /// For each node, in preorder: the bounds of its boxes, and the index of the next node outside its subtree.
    nodes: Vec<(Bounds, u32)>,
}

impl BoxTree {
    /// Builds the tree. A box's number is its index in the list.
    pub fn new(boxes: Vec<Bounds>) -> Self {
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut nodes = Vec::new();
        if !boxes.is_empty() {
            build(&boxes, &mut order, &mut nodes);
        }
        Self { boxes, order, nodes }
    }

    /// Appends to `found`, in ascending order, the numbers of the boxes that meet `bounds`. Touching counts.
    pub fn meeting(&self, bounds: &Bounds, found: &mut Vec<u32>) {
        let from = found.len();
        if !self.order.is_empty() {
            self.search(bounds, &self.order, 0, found);
        }
        found[from..].sort_unstable();
    }

    /// Searches the subtree of `node`, which has the boxes `order`.
    fn search(&self, bounds: &Bounds, order: &[u32], node: usize, found: &mut Vec<u32>) {
        if !meet(&self.nodes[node].0, bounds) {
            return;
        }
        if order.len() <= MAX_LEAF_BOXES {
            found.extend(order.iter().filter(|&&k| meet(&self.boxes[k as usize], bounds)));
            return;
        }
        let (first, second) = order.split_at(order.len() / 2);
        self.search(bounds, first, node + 1, found);
        self.search(bounds, second, self.nodes[node + 1].1 as usize, found);
    }
}

fn meet(a: &Bounds, b: &Bounds) -> bool {
    (0..2).all(|k| a[0][k] <= b[1][k] && b[0][k] <= a[1][k])
}

fn build(boxes: &[Bounds], order: &mut [u32], nodes: &mut Vec<(Bounds, u32)>) {
    let join = |a: Bounds, k: &u32| [a[0].inf(&boxes[*k as usize][0]), a[1].sup(&boxes[*k as usize][1])];
    let cover = order
        .iter()
        .fold([Point::new(f64::INFINITY, f64::INFINITY), Point::new(f64::NEG_INFINITY, f64::NEG_INFINITY)], join);
    let node = nodes.len();
    nodes.push((cover, 0));
    if order.len() > MAX_LEAF_BOXES {
        let size = cover[1] - cover[0];
        let axis = usize::from(size.y > size.x);
        let middle = |k: u32| boxes[k as usize][0][axis] + boxes[k as usize][1][axis];
        let half = order.len() / 2;
        order.select_nth_unstable_by(half, |&a, &b| middle(a).total_cmp(&middle(b)).then(a.cmp(&b)));
        let (first, second) = order.split_at_mut(half);
        build(boxes, first, nodes);
        build(boxes, second, nodes);
    }
    nodes[node].1 = nodes.len() as u32;
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        #[test]
        fn the_tree_agrees_with_brute_force(
            boxes in proptest::collection::vec((0..50i32, 0..50i32, 0..9i32, 0..9i32), 0..200),
            probe in (0..50i32, 0..50i32, 0..20i32, 0..20i32),
        ) {
            let bounds = |(x, y, w, h): (i32, i32, i32, i32)| -> Bounds {
                [Point::new(x.into(), y.into()), Point::new((x + w).into(), (y + h).into())]
            };
            let boxes: Vec<Bounds> = boxes.into_iter().map(bounds).collect();
            let probe = bounds(probe);
            let expected: Vec<u32> = (0..boxes.len() as u32).filter(|&k| meet(&boxes[k as usize], &probe)).collect();
            let mut found = Vec::new();
            BoxTree::new(boxes).meeting(&probe, &mut found);
            prop_assert_eq!(found, expected);
        }
    }
}
