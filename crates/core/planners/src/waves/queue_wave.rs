//! The wave over eight neighbours, which proceeds cell by cell.

use super::{FreeCells, Neighborhood, UNREACHED};
use cplan_interrupt::checkpoint;

/// Labels every cell that a wave from `sources` (free cells) reaches with the number of moves to it, and all others
/// with [`UNREACHED`]. Moves lead to cells that share a side or a corner.
///
/// Bits mark the cells that are not reached yet, and each label is written once. Visiting a neighbour needs no branch:
/// it is always written to the end of the next front, but the front grows only if the cell was not reached before.
pub(super) fn queue_wave_of_eight(free: &FreeCells, sources: &[usize]) -> Vec<u32> {
    let [rows, columns] = free.cells();
    let mut labels = vec![UNREACHED; rows * columns];
    let mut waiting = free.bits().to_vec();
    let mut front = Vec::new();
    for &source in sources {
        let (i, j) = (source / columns, source % columns);
        let bit = 1 << (j % 64);
        let word = &mut waiting[i * free.words() + j / 64];
        if *word & bit != 0 {
            *word ^= bit;
            front.push([i as u32, j as u32]);
        }
    }
    let mut next = Vec::new();
    let mut level = 0;
    while !front.is_empty() {
        checkpoint();
        next.resize(8 * front.len(), [0; 2]);
        let reached = advance(free, &front, level, &mut waiting, &mut labels, &mut next);
        next.truncate(reached);
        std::mem::swap(&mut front, &mut next);
        level += 1;
    }
    labels
}

/// Labels the cells of `front`, given by row and column. Writes the cells that they reach to `next`, which must have
/// room for all neighbours. Returns the number of cells reached.
fn advance(
    free: &FreeCells,
    front: &[[u32; 2]],
    level: u32,
    waiting: &mut [u64],
    labels: &mut [u32],
    next: &mut [[u32; 2]],
) -> usize {
    let ([rows, columns], words) = (free.cells(), free.words());
    let mut reached = 0;
    // Writes a cell if `allowed` is 1 and the cell is not reached yet. `allowed` is 0 or 1.
    let mut reach = |i: usize, j: usize, allowed: u64| {
        let word = &mut waiting[i * words + j / 64];
        let is_new = *word >> (j % 64) & allowed;
        *word ^= is_new << (j % 64);
        next[reached] = [i as u32, j as u32];
        reached += is_new as usize;
    };
    for &[i, j] in front {
        let (i, j) = (i as usize, j as usize);
        labels[i * columns + j] = level;
        if i == 0 || i + 1 == rows || j == 0 || j + 1 == columns {
            let moves = free.moves(i * columns + j, Neighborhood::Eight);
            moves.for_each(|to| reach(to.to / columns, to.to % columns, 1));
            continue;
        }
        let sides = [[i - 1, j], [i + 1, j], [i, j - 1], [i, j + 1]];
        sides.into_iter().for_each(|[i, j]| reach(i, j, 1));
        let [before, after, left, right] = sides.map(|[i, j]| free.bits()[i * words + j / 64] >> (j % 64) & 1);
        reach(i - 1, j - 1, before & left);
        reach(i - 1, j + 1, before & right);
        reach(i + 1, j - 1, after & left);
        reach(i + 1, j + 1, after & right);
    }
    reached
}
