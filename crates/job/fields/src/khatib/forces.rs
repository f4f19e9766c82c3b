//! Attraction by the goal, and repulsion by the nearest obstacle (Khatib 1986) or by all obstacles (Faria 2006). The forces are
//! local and cheap to compute, but, in contrast to harmonic fields, have many local minima.

use super::charges::Charges;
use super::{Limits, nearest_obstacles};
use cplan_model::space::Configuration;
use cplan_planners::cspace::Grid;
use cplan_planners::planner::grid_path;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Law of the attraction by the nearest goal at the distance `d`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Attraction {
    /// Force `c` at any distance. The potential is `c d`, a cone.
    Constant(f64),
    /// Force `k d`. The potential is `k d^2 / 2`, a paraboloid.
    Linear(f64),
}

/// Law of the repulsion by obstacles at the distance `p`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Repulsion {
    /// Only the nearest obstacle repels: the potential is `k (1/p - 1/p0)^2 / 2` within the range `p0`, and 0 beyond
    /// it.
    Ranged {
        /// The factor `k` of the potential.
        gain: f64,
        /// The range `p0`, radians or metres.
        range: f64,
    },
    /// Only the nearest obstacle repels: the force is `Q / p^2` at any distance, the potential `Q / p`.
    InverseSquare(f64),
    /// Every obstacle cell repels with the force `Q / p^2`, where `p` is in cells.
    Sum(f64),
}

/// The laws of attraction and repulsion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Khatib {
    /// Attraction by the goal.
    pub attraction: Attraction,
    /// Repulsion by the obstacles.
    pub repulsion: Repulsion,
    /// True if each component of both forces is replaced by its tanh before the forces are added, so that none exceeds 1
    /// (Gonçalves da Silva). Such a force is not a gradient, so it has no potential.
    pub saturated: bool,
}

impl Attraction {
    /// Returns the potential at a distance.
    pub fn potential(self, d: f64) -> f64 {
        match self {
            Self::Constant(c) => c * d,
            Self::Linear(k) => 0.5 * k * d * d,
        }
    }

    /// Returns the force towards the goal at a distance; zero at the goal.
    pub fn force(self, d: f64) -> f64 {
        match self {
            Self::Constant(_) if d == 0.0 => 0.0,
            Self::Constant(c) => c,
            Self::Linear(k) => k * d,
        }
    }
}

impl Repulsion {
    /// Returns the potential at a distance, which may be infinite.
    pub fn potential(self, p: f64) -> f64 {
        match self {
            Self::Ranged { range, .. } if p >= range => 0.0,
            Self::Ranged { gain, range } => 0.5 * gain * (1.0 / p - 1.0 / range).powi(2),
            Self::InverseSquare(charge) | Self::Sum(charge) => charge / p,
        }
    }

    /// Returns the force away from the obstacle at a distance.
    pub fn force(self, p: f64) -> f64 {
        match self {
            Self::Ranged { range, .. } if p >= range => 0.0,
            Self::Ranged { gain, range } => gain * (1.0 / p - 1.0 / range) / (p * p),
            Self::InverseSquare(charge) | Self::Sum(charge) => charge / (p * p),
        }
    }
}

/// Writes the law in the words of the command line.
impl fmt::Display for Attraction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(c) => write!(f, "constant:{c}"),
            Self::Linear(k) => write!(f, "linear:{k}"),
        }
    }
}

/// Writes the law in the words of the command line.
impl fmt::Display for Repulsion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ranged { gain, range } => write!(f, "ranged:{gain},{range}"),
            Self::InverseSquare(charge) => write!(f, "inverse-square:{charge}"),
            Self::Sum(charge) => write!(f, "sum:{charge}"),
        }
    }
}

/// The forces at the centres of a grid's cells. Distances are Euclidean, in radians or metres.
#[derive(Debug, Clone)]
pub struct ForceField<'a> {
    grid: &'a Grid,
    laws: Khatib,
    goals: Vec<Configuration>,
    obstacles: Obstacles,
}

/// The obstacles that repel a cell.
#[derive(Debug, Clone)]
enum Obstacles {
    /// Only the nearest obstacle repels: displacements from all cells.
    Nearest(Vec<[f64; 2]>),
    /// All obstacle cells repel together.
    Sum(Charges),
}

/// A cell from which the forces do not lead on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trap {
    /// The cell that cannot be left.
    pub cell: usize,
    /// Potential of the cell. For saturated forces, which have no potential, the strength of the force.
    pub value: f64,
    /// True if the cell is a local minimum of the potential. False if the forces lead back to a visited cell.
    pub minimum: bool,
}

impl<'a> ForceField<'a> {
    /// Creates the field; there must be a goal. `O(n)` for `n` cells, or `O(n log n)` with [`Repulsion::Sum`].
    pub fn new(grid: &'a Grid, laws: Khatib, goals: &[Configuration], limits: Limits) -> Self {
        let obstacles = match laws.repulsion {
            Repulsion::Sum(_) => Obstacles::Sum(Charges::new(grid, limits)),
            Repulsion::Ranged { .. } | Repulsion::InverseSquare(_) => {
                Obstacles::Nearest(nearest_obstacles(grid, limits))
            }
        };
        Self { grid, laws, goals: goals.to_vec(), obstacles }
    }

    /// Returns the potential in a free cell. For saturated forces, returns that of the forces before saturation.
    pub fn potential(&self, cell: usize) -> f64 {
        let Khatib { attraction, repulsion, .. } = self.laws;
        let push = match &self.obstacles {
            Obstacles::Nearest(nearest) => repulsion.potential(nearest[cell][0].hypot(nearest[cell][1])),
            // The force, for which distances are in cells, is the slope of this potential.
            Obstacles::Sum(charges) => repulsion.potential(1.0) * charges.potential[cell] * self.side(),
        };
        attraction.potential(self.to_goal(cell).norm()) + push
    }

    /// Returns the force in a free cell.
    pub fn force(&self, cell: usize) -> [f64; 2] {
        let Khatib { attraction, repulsion, saturated } = self.laws;
        let saturate = |force: f64| if saturated { force.tanh() } else { force };
        let to_goal = self.to_goal(cell);
        let d = to_goal.norm();
        let pull = if d > 0.0 { attraction.force(d) / d } else { 0.0 };
        let push = match &self.obstacles {
            Obstacles::Nearest(nearest) => {
                let p = nearest[cell][0].hypot(nearest[cell][1]);
                nearest[cell].map(|x| if p.is_finite() { -x * repulsion.force(p) / p } else { 0.0 })
            }
            Obstacles::Sum(charges) => charges.force[cell].map(|x| repulsion.force(1.0) * x),
        };
        [0, 1].map(|k| saturate(pull * to_goal[k]) + saturate(push[k]))
    }

    /// Returns the side of a square with the area of a cell.
    fn side(&self) -> f64 {
        let [a, b] = self.grid.step();
        (a * b).sqrt()
    }

    /// Returns the side lengths of a cell.
    pub(super) fn step(&self) -> [f64; 2] {
        self.grid.step()
    }

    /// Returns true if the forces have no potential.
    pub(super) fn is_saturated(&self) -> bool {
        self.laws.saturated
    }

    /// Moves from cell to cell until it reaches one of `targets`, and returns the cells. Each move leads to the one of the eight
    /// neighbours with the lowest potential, or, with saturated forces, to the one nearest to the direction of the force. Moves
    /// do not cut corners of obstacles. There is at most one move per cell.
    ///
    /// # Errors
    /// [`Trap`] if no neighbour has a lower potential, or if saturated forces do not lead to a new cell.
    pub fn descend(&self, from: usize, targets: &[usize]) -> Result<Vec<usize>, Trap> {
        let mut visited = vec![false; if self.laws.saturated { self.grid.blocked.len() } else { 0 }];
        let mut cells = vec![from];
        let mut at = from;
        while !targets.contains(&at) {
            if self.laws.saturated {
                visited[at] = true;
            }
            at = self.next(at, |cell| visited[cell])?;
            cells.push(at);
        }
        Ok(cells)
    }

    /// Returns the cell after `at`. With saturated forces, it must not have been visited.
    pub(super) fn next(&self, at: usize, visited: impl Fn(usize) -> bool) -> Result<usize, Trap> {
        if self.laws.saturated { self.along_force(at, visited) } else { self.lower(at) }
    }

    fn lower(&self, at: usize) -> Result<usize, Trap> {
        let value = self.potential(at);
        let best = self
            .neighbors(at)
            .map(|(next, _)| (self.potential(next), next))
            .fold((value, at), |best, next| if next.0 < best.0 { next } else { best });
        if best.1 == at { Err(Trap { cell: at, value, minimum: true }) } else { Ok(best.1) }
    }

    fn along_force(&self, at: usize, visited: impl Fn(usize) -> bool) -> Result<usize, Trap> {
        let force = self.force(at);
        let part = |d: [f64; 2]| (force[0] * d[0] + force[1] * d[1]) / d[0].hypot(d[1]);
        let best = self
            .neighbors(at)
            .map(|(next, d)| (part(d), next))
            .fold((0.0, at), |best, next| if next.0 > best.0 { next } else { best });
        let trap = Trap { cell: at, value: force[0].hypot(force[1]), minimum: false };
        if best.1 == at || visited(best.1) { Err(trap) } else { Ok(best.1) }
    }

    /// Returns the shortest displacement to a goal.
    fn to_goal(&self, cell: usize) -> Configuration {
        let center = self.grid.center(cell);
        let displacements = self.goals.iter().map(|&goal| self.grid.topology.displacement(center, goal));
        displacements.min_by(|a, b| a.norm().total_cmp(&b.norm())).unwrap_or_else(Configuration::zeros)
    }

    /// Iterates over the free neighbours with a common side or corner, and their displacements. A neighbour across a corner
    /// counts only if both cells beside the corner are free.
    pub(super) fn neighbors(&self, at: usize) -> impl Iterator<Item = (usize, [f64; 2])> + '_ {
        const NEIGHBOR_OFFSETS: [[i64; 2]; 8] = [[-1, 0], [1, 0], [0, -1], [0, 1], [-1, -1], [-1, 1], [1, -1], [1, 1]];
        let step = self.grid.step();
        NEIGHBOR_OFFSETS.into_iter().filter_map(move |[i, j]| {
            let next = self.free(at, [i, j])?;
            let passable = i == 0 || j == 0 || (self.free(at, [i, 0]).is_some() && self.free(at, [0, j]).is_some());
            (passable && next != at).then_some((next, [i as f64 * step[0], j as f64 * step[1]]))
        })
    }

    /// Returns the cell that is this many rows and columns away. `None` if there is none, or if it is not free.
    fn free(&self, from: usize, by: [i64; 2]) -> Option<usize> {
        let columns = self.grid.cells[1];
        let place = [(from / columns) as i64 + by[0], (from % columns) as i64 + by[1]];
        grid_path::cell(self.grid, place).filter(|&cell| !self.grid.blocked[cell])
    }
}
