//! Escapes from local minima of attraction and repulsion, which forces alone never leave.
//!
//! Both methods are from Barraquand and Latombe (*Robot motion planning: a distributed representation approach*, 1991): random
//! walks, and a search that fills the basin of the minimum.

use super::ForceField;
use cplan_geometry::OpenList;
use cplan_interrupt::checkpoint;
use cplan_model::space::SplitMix64;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// Escape from a local minimum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Escape {
    /// Random walks from the minimum, each followed by a descent, until a walk reaches a lower cell. This may fail.
    Walk {
        /// Seed of the random numbers: the same seed gives the same walks.
        seed: u64,
    },
    /// A search that fills the basin of the minimum: it repeatedly adds the lowest cell at the edge of the filled part, until it
    /// reaches a cell lower than the minimum. It succeeds if free cells connect the minimum with a goal.
    Wave,
}

impl Escape {
    /// Returns a description of the method, in words.
    pub fn description(self) -> &'static str {
        match self {
            Self::Walk { .. } => "by random walks",
            Self::Wave => "by a wave through the minimum's basin",
        }
    }
}

/// Writes the method in the words of the command line.
impl fmt::Display for Escape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Walk { seed } => write!(f, "walk:{seed}"),
            Self::Wave => f.write_str("wave"),
        }
    }
}

/// Largest number of random walks from one minimum before the search gives up.
const MAX_WALKS: usize = 256;

/// Number of steps of the first walk. Each further walk has this many more steps than the previous one.
const FIRST_WALK_STEPS: usize = 16;

impl ForceField<'_> {
    /// Returns the cells from a local minimum to a lower cell or a goal. The minimum comes first, and consecutive cells are
    /// neighbours. `number` counts the minima of a path, so that each has different random walks. `None` if no lower cell is
    /// found.
    pub(super) fn escape(
        &self,
        minimum: usize,
        by: Escape,
        number: u64,
        is_goal: impl Fn(usize) -> bool,
    ) -> Option<Vec<usize>> {
        let bottom = self.potential(minimum);
        let is_out = |cell: usize| is_goal(cell) || self.potential(cell) < bottom;
        match by {
            Escape::Wave => self.fill(minimum, is_out),
            Escape::Walk { seed } => {
                let mut draws = SplitMix64::nth(seed, number);
                (1..=MAX_WALKS).find_map(|walk| self.walk(minimum, FIRST_WALK_STEPS * walk, &mut draws, is_out))
            }
        }
    }

    /// Fills the basin around a cell until a cell satisfies `is_out`. Returns the cells from the first cell to that one.
    /// `O(n log n)` for `n` filled cells.
    fn fill(&self, from: usize, is_out: impl Fn(usize) -> bool) -> Option<Vec<usize>> {
        let mut parents = BTreeMap::from([(from, from)]);
        let mut edge = OpenList::default();
        edge.push(self.potential(from), from);
        while let Some((_, cell)) = edge.pop() {
            checkpoint();
            if is_out(cell) {
                let back = std::iter::successors(Some(cell), |at| parents.get(at).copied().filter(|next| next != at));
                let mut path: Vec<usize> = back.collect();
                path.reverse();
                return Some(path);
            }
            for (next, _) in self.neighbors(cell) {
                parents.entry(next).or_insert_with(|| {
                    edge.push(self.potential(next), next);
                    cell
                });
            }
        }
        None
    }

    /// Walks at random for this many steps, and then descends. Returns the cells of the walk without its loops. `None` if it does
    /// not leave the basin.
    fn walk(
        &self,
        from: usize,
        steps: usize,
        draws: &mut SplitMix64,
        is_out: impl Fn(usize) -> bool,
    ) -> Option<Vec<usize>> {
        checkpoint();
        let (mut path, mut at) = (vec![from], from);
        for _ in 0..steps {
            let around: Vec<usize> = self.neighbors(at).map(|(next, _)| next).collect();
            at = *around.get((draws.unit() * around.len() as f64) as usize)?;
            path.push(at);
            if is_out(at) {
                return Some(without_loops(path));
            }
        }
        while let Ok(next) = self.next(at, |_| false) {
            at = next;
            path.push(at);
            if is_out(at) {
                return Some(without_loops(path));
            }
        }
        None
    }
}

/// Removes the loops of a walk, so that it visits no cell twice.
fn without_loops(path: Vec<usize>) -> Vec<usize> {
    let mut kept: Vec<usize> = Vec::new();
    let mut places: BTreeMap<usize, usize> = BTreeMap::new();
    for cell in path {
        if let Some(&place) = places.get(&cell) {
            kept.drain(place + 1..).for_each(|left_out| {
                places.remove(&left_out);
            });
        } else {
            places.insert(cell, kept.len());
            kept.push(cell);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::without_loops;

    #[test]
    fn loops_are_left_out() {
        assert_eq!(without_loops(vec![1, 2, 3, 2, 4, 1, 5]), [1, 5]);
        assert_eq!(without_loops(vec![1, 2, 3, 2, 4]), [1, 2, 4]);
        assert_eq!(without_loops(vec![7]), [7]);
    }
}
