//! Flood fills over the cells of a grid.

use crate::solid::V;

/// A grid of cells. On a circle, the last cell adjoins the first. The cell `[i, j]` has the number `i * count[1] + j`.
#[derive(Debug, Clone, Copy)]
pub struct Cells {
    /// Number of cells along each axis.
    pub count: [usize; 2],
    /// True for each axis that is a circle.
    pub circles: [bool; 2],
}

impl Cells {
    /// Returns the adjoining cell along an axis, in the direction of greater values if `is_next`, otherwise of lower ones.
    fn beside(&self, cell: usize, axis: usize, is_next: bool) -> Option<usize> {
        let (mut at, n) = ([cell / self.count[1], cell % self.count[1]], self.count[axis]);
        let is_last = at[axis] == if is_next { n - 1 } else { 0 };
        at[axis] = (at[axis] + if is_next { 1 } else { n - 1 }) % n;
        (!is_last || self.circles[axis]).then_some(at[0] * self.count[1] + at[1])
    }

    /// Marks the given cells and all that can be reached from them. `passes` decides about a step from a cell to an adjoining
    /// one.
    pub fn flood(
        &self,
        from: impl IntoIterator<Item = usize>,
        mut passes: impl FnMut(usize, usize) -> bool,
    ) -> Vec<bool> {
        let mut seen = vec![false; self.count[0] * self.count[1]];
        let mut waiting: Vec<usize> = from.into_iter().collect();
        waiting.iter().for_each(|&cell| seen[cell] = true);
        while let Some(cell) = waiting.pop() {
            for (axis, is_next) in [(0, false), (0, true), (1, false), (1, true)] {
                if let Some(next) = self.beside(cell, axis, is_next).filter(|&next| !seen[next])
                    && passes(cell, next)
                {
                    seen[next] = true;
                    waiting.push(next);
                }
            }
        }
        seen
    }

    /// Returns the cell that contains a configuration, if all cells have equal sizes.
    pub fn locate(&self, domain: [V; 2], q: V) -> usize {
        let [i, j] = [0, 1].map(|k| {
            let share = (q[k] - domain[k][0]) / (domain[k][1] - domain[k][0]);
            let share = if self.circles[k] { share.rem_euclid(1.0) } else { share };
            ((share * self.count[k] as f64) as usize).min(self.count[k] - 1)
        });
        i * self.count[1] + j
    }

    /// Returns the middle of a cell, if all cells have equal sizes.
    pub fn middle(&self, domain: [V; 2], cell: usize) -> V {
        let at = [cell / self.count[1], cell % self.count[1]];
        [0, 1].map(|k| domain[k][0] + (domain[k][1] - domain[k][0]) * (at[k] as f64 + 0.5) / self.count[k] as f64)
    }
}
