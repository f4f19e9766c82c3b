//! The domain of a field equation: cells, their kinds, and boundary conditions.

use cplan_planners::cspace::Grid;
use cplan_planners::planner::grid_path::Place;
use serde::{Deserialize, Serialize};

/// The kind of a cell in a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Cell {
    /// A cell whose value is an unknown.
    Free,
    /// A cell with the value [`Levels::obstacle`].
    Obstacle,
    /// A cell with the value [`Levels::goal`].
    Goal,
}

/// Boundary condition at the first and the last cell of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Boundary {
    /// The axis is a circle, so cells at the other end are neighbours.
    Periodic,
    /// Cells beyond the limit have the value of obstacles (Dirichlet).
    High,
    /// Values beyond the limit are a mirror image, so nothing flows across the limit (Neumann). A cell at the limit is its own
    /// neighbour.
    Reflecting,
}

/// Boundary condition at the limits of joints; continuous joints have none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Limits {
    /// Limits have the value of obstacles: [`Boundary::High`].
    #[default]
    High,
    /// Limits reflect: [`Boundary::Reflecting`].
    Reflecting,
}

/// The fixed values of obstacles and goals, and the initial value of free cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Levels {
    /// The value that obstacles keep.
    pub obstacle: f64,
    /// The value that goals keep.
    pub goal: f64,
    /// Initial value of free cells.
    pub free: f64,
}

impl Levels {
    /// The levels of the literature: obstacles have 1, goals 0, and free cells start at 0. Paths descend.
    pub const PUBLISHED: Self = Self { obstacle: 1.0, goal: 0.0, free: 0.0 };

    /// One minus the levels of the literature: a value is the probability that a random walk reaches a goal before an obstacle.
    /// Paths ascend. Values far from the goal are small, and doubles represent them with full relative precision. Free cells
    /// start at the level of obstacles, so that without over-relaxation values only rise.
    pub const PROBABILITY: Self = Self { obstacle: 0.0, goal: 1.0, free: 0.0 };

    /// Returns 1 if obstacles are high, and -1 if they are low. Multiplied by this, differences of values have the sign that they
    /// have in the literature.
    pub(super) fn orientation(self) -> f64 {
        if self.obstacle < self.goal { -1.0 } else { 1.0 }
    }
}

/// Initial value of free cells. As in the literature, obstacles are called high and goals low.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Initial {
    /// The value of obstacles: [`Levels::obstacle`].
    #[default]
    High,
    /// The value of goals: [`Levels::goal`]. The literature's counts of sweeps begin there.
    Low,
}

impl Initial {
    /// Returns true if free cells start at the value of obstacles.
    pub fn is_high(&self) -> bool {
        *self == Self::High
    }
}

/// The neighbour of a cell in one of four directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Neighbor {
    /// Another cell, by its number.
    Cell(usize),
    /// A place beyond a limit that has the value of obstacles.
    Limit,
    /// The cell itself: beyond a reflecting limit, and on a circle of one cell.
    Mirror,
}

/// Whether an equation takes the shape of cells into account.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stencil {
    /// All four neighbours have the same weight, whatever the shape of cells.
    #[default]
    Square,
    /// Neighbours along axis 2 have `beta^2` times the weight of neighbours along axis 1, where `beta` is the width of a cell
    /// along axis 1 divided by that along axis 2. This gives Laplace's equation in the lengths of joint space.
    Anisotropic,
}

impl Stencil {
    /// Returns true if cells count as square.
    pub fn is_square(&self) -> bool {
        *self == Self::Square
    }

    /// Returns `beta` for the cells of a grid.
    pub fn beta(self, grid: &Grid) -> f64 {
        let [dx, dy] = grid.step();
        if self.is_square() { 1.0 } else { dx / dy }
    }
}

/// A rectangle of cells, row by row (index `i * cells[1] + j`), with fixed values on obstacles and goals. The unit of length is
/// the width of a cell along axis 1. Its width along axis 2 is `1 / beta`, where `beta` is 1 unless [`Domain::with_beta`] changes
/// it.
#[derive(Debug, Clone, PartialEq)]
pub struct Domain {
    cells: [usize; 2],
    kinds: Vec<Cell>,
    boundaries: [Boundary; 2],
    levels: Levels,
    beta: f64,
}

impl Domain {
    /// Creates a domain of `cells[0]` rows and `cells[1]` columns. `boundaries[0]` applies beyond the first and the
    /// last row.
    ///
    /// # Panics
    /// If there is not one kind per cell, or there are `2^32` cells or more.
    pub fn new(cells: [usize; 2], kinds: Vec<Cell>, boundaries: [Boundary; 2], levels: Levels) -> Self {
        assert_eq!(cells[0].checked_mul(cells[1]), Some(kinds.len()), "one kind a cell");
        assert!(u32::try_from(kinds.len()).is_ok_and(|n| n < u32::MAX), "positions are counted in 32 bits");
        Self { cells, kinds, boundaries, levels, beta: 1.0 }
    }

    /// Sets the shape of the cells: 1 wide along axis 1, `1 / beta` along axis 2 (`beta = dx / dy`).
    ///
    /// # Panics
    /// If `beta` is not a positive finite number.
    #[must_use]
    pub fn with_beta(self, beta: f64) -> Self {
        assert!(beta > 0.0 && beta.is_finite(), "cells have positive sides");
        Self { beta, ..self }
    }

    /// Sets the value of free cells before the first sweep.
    #[must_use]
    pub fn with_initial(self, initial: Initial) -> Self {
        let free = if initial.is_high() { self.levels.obstacle } else { self.levels.goal };
        Self { levels: Levels { free, ..self.levels }, ..self }
    }

    /// Returns the width of a cell along axis 1 divided by its width along axis 2; 1 if cells count as square.
    pub fn beta(&self) -> f64 {
        self.beta
    }

    /// Creates the domain of a grid with goals (indices of cells). Free cells that are not connected with a goal count as
    /// obstacles: their values are not needed, and would be undetermined with reflecting limits.
    ///
    /// # Panics
    /// If a goal is not a cell, or there are `2^32` cells or more.
    pub fn of_grid(grid: &Grid, goals: &[usize], limits: Limits, levels: Levels) -> Self {
        let mut kinds = vec![Cell::Obstacle; grid.blocked.len()];
        let mut queue = Vec::new();
        for &goal in goals {
            if !grid.blocked[goal] && kinds[goal] != Cell::Goal {
                kinds[goal] = Cell::Goal;
                queue.push(goal);
            }
        }
        while let Some(cell) = queue.pop() {
            for next in grid.neighbors(cell) {
                if !grid.blocked[next] && kinds[next] == Cell::Obstacle {
                    kinds[next] = Cell::Free;
                    queue.push(next);
                }
            }
        }
        let boundaries = grid.topology.ranges.map(|axis| match limits {
            _ if axis.is_circle() => Boundary::Periodic,
            Limits::High => Boundary::High,
            Limits::Reflecting => Boundary::Reflecting,
        });
        Self::new(grid.cells, kinds, boundaries, levels)
    }

    /// Returns the numbers of rows and columns.
    pub fn cells(&self) -> [usize; 2] {
        self.cells
    }

    /// Returns the kind of each cell.
    pub fn kinds(&self) -> &[Cell] {
        &self.kinds
    }

    /// Returns the boundary condition of each axis.
    pub fn boundaries(&self) -> [Boundary; 2] {
        self.boundaries
    }

    /// Returns the fixed values.
    pub fn levels(&self) -> Levels {
        self.levels
    }

    /// Returns the neighbours of a cell, in the order `-q1, +q1, -q2, +q2`.
    pub fn neighbors(&self, cell: usize) -> [Neighbor; 4] {
        let columns = self.cells[1];
        let place = [cell / columns, cell % columns];
        [(0, false), (0, true), (1, false), (1, true)].map(|(axis, ahead)| self.neighbor(place, axis, ahead))
    }

    /// Returns the neighbour of the cell at a place, in one direction along an axis.
    fn neighbor(&self, mut place: [usize; 2], axis: usize, ahead: bool) -> Neighbor {
        let (at, last) = (place[axis], self.cells[axis] - 1);
        place[axis] = match self.boundaries[axis] {
            _ if ahead && at < last => at + 1,
            _ if !ahead && at > 0 => at - 1,
            Boundary::High => return Neighbor::Limit,
            Boundary::Periodic if last > 0 => last - at,
            Boundary::Periodic | Boundary::Reflecting => return Neighbor::Mirror,
        };
        Neighbor::Cell(place[0] * self.cells[1] + place[1])
    }

    /// Returns true if the value of a cell is an unknown: the cell is free, and has a neighbour other than itself. Other free
    /// cells keep their values.
    pub(super) fn is_unknown(&self, cell: usize) -> bool {
        let has_neighbors = self.kinds.len() > 1 || self.boundaries.contains(&Boundary::High);
        self.kinds[cell] == Cell::Free && has_neighbors
    }

    /// Returns the cell at a place of the unbounded lattice. `None` beyond the ends of an interval.
    pub fn cell_at(&self, place: Place) -> Option<usize> {
        let index = |axis: usize| {
            let (at, n) = (place[axis], self.cells[axis] as i64);
            let at = if self.boundaries[axis] == Boundary::Periodic { at.rem_euclid(n.max(1)) } else { at };
            (0..n).contains(&at).then_some(at as usize)
        };
        Some(index(0)? * self.cells[1] + index(1)?)
    }

    /// Returns the values before the first sweep.
    pub fn start(&self) -> Vec<f64> {
        self.kinds.iter().map(|&kind| self.fixed(kind).unwrap_or(self.levels.free)).collect()
    }

    /// Returns the value of a cell that is not free.
    pub(super) fn fixed(&self, kind: Cell) -> Option<f64> {
        match kind {
            Cell::Free => None,
            Cell::Obstacle => Some(self.levels.obstacle),
            Cell::Goal => Some(self.levels.goal),
        }
    }
}
