//! Where a field equation is to be solved: cells, what they are, and what lies beyond the limits.

use cplan_core::cspace::Grid;
use cplan_harmonic::Place;
use serde::{Deserialize, Serialize};

/// What a cell is to a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Cell {
    /// Its value is sought.
    Free,
    /// Its value is [`Levels::obstacle`].
    Obstacle,
    /// Its value is [`Levels::goal`].
    Goal,
}

/// What lies beyond the first and the last cell of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Boundary {
    /// The cells of the other end: a circle.
    Periodic,
    /// As high as obstacles (Dirichlet).
    High,
    /// The mirror image: no flow through the limit (Neumann). A cell at the limit has itself as its neighbour there.
    Reflecting,
}

/// The limits of intervals; circles have none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Limits {
    /// As high as obstacles: [`Boundary::High`].
    #[default]
    High,
    /// Mirrors: [`Boundary::Reflecting`].
    Reflecting,
}

/// The fixed values, and that which free cells start from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Levels {
    /// The value that obstacles keep.
    pub obstacle: f64,
    /// The value that goals keep.
    pub goal: f64,
    /// Of free cells before the first sweep.
    pub free: f64,
}

impl Levels {
    /// As the literature has it: obstacles 1, goals 0, free cells start at 0; paths descend.
    pub const PUBLISHED: Self = Self { obstacle: 1.0, goal: 0.0, free: 0.0 };

    /// The complement: the probability that a random walk comes to a goal before it comes to an obstacle. Paths ascend. It
    /// is small far from the goal, where doubles keep their relative precision; the complement of a small number would be
    /// 1. All free cells start as low as obstacles, so that without over-relaxation values only rise.
    pub const PROBABILITY: Self = Self { obstacle: 0.0, goal: 1.0, free: 0.0 };

    /// 1 where obstacles are high, -1 where they are low: what turns a difference of values into the published one.
    pub(super) fn orientation(self) -> f64 {
        if self.obstacle < self.goal { -1.0 } else { 1.0 }
    }
}

/// The neighbour of a cell in some direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Neighbor {
    /// Another cell, by its number.
    Cell(usize),
    /// Beyond a high limit: has the value of obstacles.
    Limit,
    /// The cell itself: beyond a reflecting limit, and round a circle of one cell.
    Mirror,
}

/// Whether an equation sees that cells are not square.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stencil {
    /// All four neighbours weigh the same, whatever the sides of a cell.
    #[default]
    Square,
    /// The neighbours along axis 2 weigh `beta^2` as much as those along axis 1, `beta` the width of a cell along axis 1 over that
    /// along axis 2: Laplace's equation in the lengths of joint space.
    Anisotropic,
}

impl Stencil {
    /// Whether cells count as square.
    #[must_use]
    pub fn is_square(&self) -> bool {
        *self == Self::Square
    }

    /// `beta` on the cells of a grid.
    #[must_use]
    pub fn beta(self, grid: &Grid) -> f64 {
        let [dx, dy] = grid.step();
        if self.is_square() { 1.0 } else { dx / dy }
    }
}

/// A rectangle of cells, row by row (index `i * cells[1] + j`), with values given on obstacles and goals. Lengths are
/// measured in cells: a cell is 1 wide along axis 1 and `1 / beta` along axis 2, `beta` being 1 unless
/// [`Domain::with_beta`] says otherwise.
#[derive(Debug, Clone, PartialEq)]
pub struct Domain {
    cells: [usize; 2],
    kinds: Vec<Cell>,
    boundaries: [Boundary; 2],
    levels: Levels,
    beta: f64,
}

impl Domain {
    /// Of `cells[0]` rows and `cells[1]` columns; `boundaries[0]` is beyond the first and the last row.
    ///
    /// # Panics
    /// If there is not one kind a cell, or there are `2^32` cells or more.
    #[must_use]
    pub fn new(cells: [usize; 2], kinds: Vec<Cell>, boundaries: [Boundary; 2], levels: Levels) -> Self {
        assert_eq!(cells[0].checked_mul(cells[1]), Some(kinds.len()), "one kind a cell");
        assert!(u32::try_from(kinds.len()).is_ok_and(|n| n < u32::MAX), "positions are counted in 32 bits");
        Self { cells, kinds, boundaries, levels, beta: 1.0 }
    }

    /// The same with cells that are not square: 1 wide along axis 1, `1 / beta` along axis 2 (`beta = dx / dy`).
    ///
    /// # Panics
    /// If `beta` is not a positive finite number.
    #[must_use]
    pub fn with_beta(self, beta: f64) -> Self {
        assert!(beta > 0.0 && beta.is_finite(), "cells have positive sides");
        Self { beta, ..self }
    }

    /// Width of a cell along axis 1 over that along axis 2; 1 where cells count as square.
    #[must_use]
    pub fn beta(&self) -> f64 {
        self.beta
    }

    /// A grid with goals (indices of cells). Free cells without a chain of free neighbours to a goal count as obstacles:
    /// nobody asks for values there, and with reflecting limits they would not be determined.
    ///
    /// # Panics
    /// If a goal is no cell, or there are `2^32` cells or more.
    #[must_use]
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

    /// Rows and columns.
    #[must_use]
    pub fn cells(&self) -> [usize; 2] {
        self.cells
    }

    /// What each cell is.
    #[must_use]
    pub fn kinds(&self) -> &[Cell] {
        &self.kinds
    }

    /// What lies beyond each axis.
    #[must_use]
    pub fn boundaries(&self) -> [Boundary; 2] {
        self.boundaries
    }

    /// The fixed values.
    #[must_use]
    pub fn levels(&self) -> Levels {
        self.levels
    }

    /// The neighbours of a cell, in the order `-q1, +q1, -q2, +q2`.
    #[must_use]
    pub fn neighbors(&self, cell: usize) -> [Neighbor; 4] {
        let [rows, columns] = self.cells;
        let (i, j) = (cell / columns, cell % columns);
        let row = |i: Step| i.of(cell, |i| i * columns + j);
        let column = |j: Step| j.of(cell, |j| i * columns + j);
        let [first, second] = self.boundaries;
        [
            row(Step::down(i, rows, first)),
            row(Step::up(i, rows, first)),
            column(Step::down(j, columns, second)),
            column(Step::up(j, columns, second)),
        ]
    }

    /// Whether a cell's value is to be found. A free cell that has no neighbour but itself keeps that which it has.
    pub(super) fn is_sought(&self, cell: usize) -> bool {
        let has_neighbors = self.kinds.len() > 1 || self.boundaries.contains(&Boundary::High);
        self.kinds[cell] == Cell::Free && has_neighbors
    }

    /// The cell at a place of the unbounded lattice; none beyond the ends of an interval.
    #[must_use]
    pub fn cell_at(&self, place: Place) -> Option<usize> {
        let index = |axis: usize| {
            let (at, n) = (place[axis], self.cells[axis] as i64);
            let at = if self.boundaries[axis] == Boundary::Periodic { at.rem_euclid(n.max(1)) } else { at };
            (0..n).contains(&at).then_some(at as usize)
        };
        Some(index(0)? * self.cells[1] + index(1)?)
    }

    /// The values before the first sweep.
    #[must_use]
    pub fn start(&self) -> Vec<f64> {
        self.kinds.iter().map(|&kind| self.fixed(kind).unwrap_or(self.levels.free)).collect()
    }

    /// The value of a cell that is not free.
    pub(super) fn fixed(&self, kind: Cell) -> Option<f64> {
        match kind {
            Cell::Free => None,
            Cell::Obstacle => Some(self.levels.obstacle),
            Cell::Goal => Some(self.levels.goal),
        }
    }
}

/// Where a step along one axis leads.
enum Step {
    To(usize),
    Beyond(Boundary),
}

impl Step {
    fn down(at: usize, n: usize, boundary: Boundary) -> Self {
        match boundary {
            _ if at > 0 => Self::To(at - 1),
            Boundary::Periodic => Self::To(n - 1),
            boundary => Self::Beyond(boundary),
        }
    }

    fn up(at: usize, n: usize, boundary: Boundary) -> Self {
        match boundary {
            _ if at + 1 < n => Self::To(at + 1),
            Boundary::Periodic => Self::To(0),
            boundary => Self::Beyond(boundary),
        }
    }

    fn of(self, cell: usize, index: impl Fn(usize) -> usize) -> Neighbor {
        match self {
            Self::To(at) if index(at) == cell => Neighbor::Mirror,
            Self::To(at) => Neighbor::Cell(index(at)),
            Self::Beyond(Boundary::High) => Neighbor::Limit,
            Self::Beyond(_) => Neighbor::Mirror,
        }
    }
}
