//! Iterative deepening (Korf 1985): depth-first search within a limit, repeated with greater limits.
//!
//! The textbook search has no table, and expands a cell once for each path to it. On a grid, this takes exponential time. Here,
//! each round expands a cell at most once, at its least number of moves, which is known from previous rounds.

use super::search::{CELLS_BETWEEN_CHECKPOINTS, Cost, Search};
use super::{FreeCells, Neighborhood, UNREACHED};
use cplan_interrupt::checkpoint;
use std::collections::BTreeSet;

/// Searches from `sources`, which are already labelled, in rounds with increasing limits of moves, until a round
/// expands a target or labels no new cell. A round expands each cell within its limit once. All rounds together take
/// time proportional to the number of cells times the number of moves to the target.
pub(super) fn deepen(
    search: &mut Search,
    free: &FreeCells,
    neighborhood: Neighborhood,
    sources: &[usize],
    targets: &BTreeSet<usize>,
) {
    // For each cell, one plus the limit of the last round that put it on the stack.
    let mut seen = vec![0_u32; search.parents.len()];
    let mut stack: Vec<usize> = Vec::new();
    for limit in 0.. {
        search.rounds = limit as usize + 1;
        let labeled = search.labeled;
        stack.extend(sources.iter().rev());
        sources.iter().for_each(|&source| seen[source] = limit + 1);
        while let Some(cell) = stack.pop() {
            search.expansions += 1;
            if search.expansions.is_multiple_of(CELLS_BETWEEN_CHECKPOINTS) {
                checkpoint();
            }
            let depth = search.costs[cell].moves();
            // Cells at the limit are expanded for the first time. Nearer ones were expanded in the previous round.
            if depth == limit {
                search.expanded.push(cell as u32);
            }
            if targets.contains(&cell) {
                search.met = Some(cell);
                return;
            }
            if depth == limit {
                continue;
            }
            for next in free.moves(cell, neighborhood) {
                let is_new = search.parents[next.to] == UNREACHED;
                if is_new {
                    let (straight, diagonal) = (u32::from(!next.is_diagonal), u32::from(next.is_diagonal));
                    search.labeled += 1;
                    search.parents[next.to] = cell as u32;
                    search.costs[next.to] = search.costs[cell].and(Cost { straight, diagonal });
                }
                if seen[next.to] <= limit && search.costs[next.to].moves() == depth + 1 {
                    seen[next.to] = limit + 1;
                    stack.push(next.to);
                }
            }
        }
        if search.labeled == labeled && limit > 0 {
            return;
        }
    }
}
