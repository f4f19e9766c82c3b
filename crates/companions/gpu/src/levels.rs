//! A hierarchy of coarser grids with their equations.

use super::GridEquations;
use cplan_fields::Boundary;

/// Factor by which the diffusion between blocks of 2 x 2 cells is reduced. In open space, 2 would be exact, because the
/// centres of blocks are twice as far apart as those of cells. A slightly smaller value keeps corrections small where
/// blocks meet walls, so that cycles converge (tested on random walls of up to 1024 x 1024 cells).
const DIFFUSION_REDUCTION: f64 = 1.7;

/// Least number of rows or columns of a grid that has a coarser level.
const MIN_COARSENED_SIDE: usize = 8;

/// Equations on a grid, row by row: `own * x - sum of side * neighbour = right`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Level {
    pub cells: [usize; 2],
    pub boundaries: [Boundary; 2],
    /// Diagonal coefficients; 0 for cells that are not unknowns.
    pub own: Vec<f64>,
    /// Couplings to the neighbours; 0 for neighbours that are not unknowns.
    pub sides: Vec<[f64; 4]>,
}

/// For each side of a cell, the side of the neighbour that faces it.
const OPPOSITE_SIDE: [usize; 4] = [1, 0, 3, 2];

impl Level {
    /// Returns the finest level, with the problem's weights. If a cell is its own neighbour on a side, its diagonal
    /// coefficient is reduced by the weight of that side.
    pub fn finest(problem: &GridEquations, weights: impl Fn(usize) -> [f64; 4]) -> Self {
        let count = problem.values.len();
        let mut level = Self {
            cells: problem.cells,
            boundaries: problem.boundaries,
            own: vec![0.0; count],
            sides: vec![[0.0; 4]; count],
        };
        for cell in (0..count).filter(|&cell| problem.unknown[cell]) {
            level.own[cell] = 1.0;
            let weights = weights(cell);
            for (side, weight) in weights.into_iter().enumerate() {
                match level.neighbor(cell, side) {
                    Some(next) if next == cell => level.own[cell] -= weight,
                    Some(next) if problem.unknown[next] => level.sides[cell][side] = weight,
                    None if problem.boundaries[side / 2] == Boundary::Reflecting => level.own[cell] -= weight,
                    _ => {}
                }
            }
        }
        level
    }

    /// Returns the neighbour on a side, or `None` beyond walls and mirrors.
    pub fn neighbor(&self, cell: usize, side: usize) -> Option<usize> {
        let [rows, columns] = self.cells;
        let (i, j) = (cell / columns, cell % columns);
        let step = |at: usize, n: usize, boundary: Boundary| match side % 2 {
            0 if at > 0 => Some(at - 1),
            1 if at + 1 < n => Some(at + 1),
            _ if boundary == Boundary::Periodic => Some(n - 1 - at),
            _ => None,
        };
        match side / 2 {
            0 => step(i, rows, self.boundaries[0]).map(|i| i * columns + j),
            _ => step(j, columns, self.boundaries[1]).map(|j| i * columns + j),
        }
    }

    /// Returns true if there is no coarser level.
    fn is_coarsest(&self) -> bool {
        self.cells.iter().all(|&n| n <= MIN_COARSENED_SIDE)
    }

    /// Returns the level of blocks of 2 x 2 cells. Its couplings are the flows through common sides, with diffusion
    /// divided by [`DIFFUSION_REDUCTION`]. Where drift exceeds diffusion, differences are upwind, so that coefficients
    /// keep their signs on every level. Takes `O(cells)`.
    fn coarser(&self) -> Self {
        let cells = self.cells.map(|n| n.div_ceil(2));
        let count = cells[0] * cells[1];
        let block = |cell: usize| cell / self.cells[1] / 2 * cells[1] + cell % self.cells[1] / 2;
        // For each block and side: outflow, inflow, and loss to walls.
        let (mut there, mut back, mut lost) = (vec![[0.0; 4]; count], vec![[0.0; 4]; count], vec![0.0; count]);
        for cell in (0..self.own.len()).filter(|&cell| self.own[cell] > 0.0) {
            let here = block(cell);
            let mut rest = self.own[cell];
            for side in 0..4 {
                let weight = self.sides[cell][side];
                rest -= weight;
                if let Some(next) = self.neighbor(cell, side).filter(|&next| self.own[next] > 0.0)
                    && block(next) != here
                {
                    there[here][side] += weight;
                    back[here][side] += self.sides[next][OPPOSITE_SIDE[side]];
                }
            }
            lost[here] += rest;
        }
        let mut coarse =
            Self { cells, boundaries: self.boundaries, own: vec![0.0; count], sides: vec![[0.0; 4]; count] };
        for here in 0..count {
            for side in 0..4 {
                let (diffusion, drift) =
                    (0.5 * (there[here][side] + back[here][side]), 0.5 * (there[here][side] - back[here][side]));
                coarse.sides[here][side] = (diffusion / DIFFUSION_REDUCTION).max(drift.abs()) + drift;
            }
            let own = coarse.sides[here].iter().sum::<f64>() + lost[here].max(0.0) / DIFFUSION_REDUCTION;
            coarse.own[here] = own;
        }
        coarse
    }

    /// Returns all levels, the finest first.
    pub fn hierarchy(finest: Self) -> Vec<Self> {
        let mut levels = vec![finest];
        while let Some(last) = levels.last().filter(|last| !last.is_coarsest()) {
            let next = last.coarser();
            levels.push(next);
        }
        levels
    }

    /// Returns the coefficients in single precision as five consecutive lists, in the order of the kernels.
    pub fn planes(&self) -> Vec<f32> {
        let sides = (0..4).flat_map(|side| self.sides.iter().map(move |sides| sides[side] as f32));
        sides.chain(self.own.iter().map(|&own| own as f32)).collect()
    }
}
