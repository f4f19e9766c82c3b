//! The hierarchy of levels and one V-cycle through it: the preconditioner.

use super::envelope::Envelope;
use super::frame::Frame;
use super::galerkin::coarsen;
use super::machine::{LANES, Machine};
use super::smooth::Vectors;
use super::stencil::{FivePoint, Line, Operator, Stencil};
use super::transfer::{Corners, Rows, Transfer};
use cplan_interrupt::checkpoint;

/// Largest number of cells of a level that is solved directly.
const MAX_DIRECT_CELLS: usize = 40;

/// The levels below the finest one. They depend only on the operator.
#[derive(Debug, Clone)]
pub(super) struct Hierarchy {
    /// Transfer from the finest level to the first of `levels`.
    pub corners: Corners,
    /// Transfers from each level to the next.
    transfers: Vec<Transfer>,
    levels: Vec<Stencil>,
    bottom: Envelope,
}

/// The vectors of all levels except the finest.
#[derive(Debug, Clone, Default)]
pub(super) struct Stack {
    pub levels: Vec<Vectors>,
    rows: Rows,
    bottom: Vec<f64>,
}

impl Hierarchy {
    /// Builds the hierarchy. Linear in the number of cells.
    pub fn new<M: Machine>(m: M, finest: &FivePoint) -> Self {
        let (transfer, first) = coarsen(m, finest);
        let (mut transfers, mut levels) = (Vec::new(), vec![first]);
        while let Some(level) = levels.last()
            && level.frame.rows * level.frame.columns > MAX_DIRECT_CELLS
        {
            checkpoint();
            let (transfer, next) = coarsen(m, level);
            transfers.push(transfer);
            levels.push(next);
        }
        let bottom = envelope(m, &levels[levels.len() - 1]);
        Self { corners: Corners::of(transfer), transfers, levels, bottom }
    }

    /// Allocates the vectors for cycles.
    pub fn stack(&self) -> Stack {
        let bottom = self.levels[self.levels.len() - 1].frame;
        Stack {
            levels: self.levels.iter().map(|level| Vectors::new(level.frame)).collect(),
            rows: Rows::new(self.levels[0].frame.width),
            bottom: vec![0.0; bottom.rows * bottom.columns],
        }
    }

    /// Runs one V-cycle through the levels below the finest, starting from zero, for the right-hand side of the first of these
    /// levels.
    pub fn cycle<M: Machine>(&self, m: M, stack: &mut Stack) {
        let Stack { levels: vectors, rows, bottom } = stack;
        let last = self.transfers.len();
        for (k, transfer) in self.transfers.iter().enumerate() {
            let (upper, lower) = vectors.split_at_mut(k + 1);
            self.levels[k].begin(m, &mut upper[k]);
            transfer.restrict(m, &self.levels[k], &upper[k], rows, &mut lower[0].right);
        }
        let frame = self.levels[last].frame;
        for (i, bottom) in bottom.chunks_exact_mut(frame.columns).enumerate() {
            bottom.iter_mut().zip(&vectors[last].right[frame.row(i)]).for_each(|(to, &from)| *to = f64::from(from));
        }
        self.bottom.solve(bottom);
        for (i, bottom) in bottom.chunks_exact(frame.columns).enumerate() {
            let row = &mut vectors[last].solution[frame.row(i)];
            row.iter_mut().zip(bottom).for_each(|(to, &from)| *to = from as f32);
        }
        frame.finish(&mut vectors[last].solution);
        for (k, transfer) in self.transfers.iter().enumerate().rev() {
            let (upper, lower) = vectors.split_at_mut(k + 1);
            transfer.prolong(m, &lower[0].solution, rows, &mut upper[k].solution);
            self.levels[k].go_on(m, &mut upper[k]);
        }
    }
}

/// Factorises the operator of the coarsest level.
fn envelope<M: Machine>(m: M, operator: &Stencil) -> Envelope {
    let Frame { rows, columns, width, .. } = operator.frame;
    let mut entries = Vec::with_capacity(5 * rows * columns);
    let mut line = Line::new(width + 2 + LANES);
    for i in 0..rows {
        operator.line(m, i, &mut line);
        for j in 0..columns {
            let here = i * columns + j;
            entries.push((here, here, f64::from(line.diagonal[j + 1])));
            let (below, right, left) = ((i + 1) % rows, (j + 1) % columns, (j + columns - 1) % columns);
            for (coupling, row, column) in [
                (line.east[j + 1], i, right),
                (line.south[j + 1], below, j),
                (line.south_east[j + 1], below, right),
                (line.south_west[j + 1], below, left),
            ] {
                if coupling != 0.0 {
                    let there = row * columns + column;
                    // On a tiny circle, a cell is its own neighbour on both sides.
                    let twice = if there == here { 2.0 } else { 1.0 };
                    entries.push((here.max(there), here.min(there), -twice * f64::from(coupling)));
                }
            }
        }
    }
    Envelope::new(rows * columns, &entries)
}
