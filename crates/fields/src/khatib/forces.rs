//! Attraction by the goal and repulsion by the nearest obstacle (Khatib 1986) or by all of them (Faria 2006): local, cheap,
//! and full of local minima. The counter-example that harmonic fields cure.

use super::charges::Charges;
use super::{Limits, nearest_obstacles};
use cplan_core::cspace::Grid;
use cplan_core::space::Configuration;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Law of attraction by the nearest goal, at a distance `d`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Attraction {
    /// Force `c` at any distance; potential `c d`, a cone.
    Constant(f64),
    /// Force `k d`; potential `k d^2 / 2`, a paraboloid.
    Linear(f64),
}

/// Law of repulsion by an obstacle, at a distance `p`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Repulsion {
    /// The nearest obstacle: potential `k (1/p - 1/p0)^2 / 2` within the range `p0`, nothing beyond.
    Ranged {
        /// The factor `k` of the potential.
        gain: f64,
        /// `p0`, in the units of the joints.
        range: f64,
    },
    /// The nearest obstacle: force `Q / p^2` at any distance; potential `Q / p`.
    InverseSquare(f64),
    /// Every obstacle cell: force `Q / p^2`, `p` in cells.
    Sum(f64),
}

/// The two laws.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Khatib {
    /// Attraction of the goal.
    pub attraction: Attraction,
    /// Repulsion of the obstacles.
    pub repulsion: Repulsion,
    /// If true, each component of either force is passed through tanh before they are added, so that none exceeds 1
    /// (Gonçalves da Silva). Such a force is not a gradient: it has no potential.
    pub saturated: bool,
}

impl Attraction {
    /// Returns the potential at a distance.
    #[must_use]
    pub fn potential(self, d: f64) -> f64 {
        match self {
            Self::Constant(c) => c * d,
            Self::Linear(k) => 0.5 * k * d * d,
        }
    }

    /// Returns the force towards the goal at a distance; zero at the goal.
    #[must_use]
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
    #[must_use]
    pub fn potential(self, p: f64) -> f64 {
        match self {
            Self::Ranged { range, .. } if p >= range => 0.0,
            Self::Ranged { gain, range } => 0.5 * gain * (1.0 / p - 1.0 / range).powi(2),
            Self::InverseSquare(charge) | Self::Sum(charge) => charge / p,
        }
    }

    /// Returns the force away from the obstacle at a distance.
    #[must_use]
    pub fn force(self, p: f64) -> f64 {
        match self {
            Self::Ranged { range, .. } if p >= range => 0.0,
            Self::Ranged { gain, range } => gain * (1.0 / p - 1.0 / range) / (p * p),
            Self::InverseSquare(charge) | Self::Sum(charge) => charge / (p * p),
        }
    }
}

/// The words of the command line.
impl fmt::Display for Attraction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(c) => write!(f, "constant:{c}"),
            Self::Linear(k) => write!(f, "linear:{k}"),
        }
    }
}

/// The words of the command line.
impl fmt::Display for Repulsion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ranged { gain, range } => write!(f, "ranged:{gain},{range}"),
            Self::InverseSquare(charge) => write!(f, "inverse-square:{charge}"),
            Self::Sum(charge) => write!(f, "sum:{charge}"),
        }
    }
}

/// The laws on a grid, for the centres of its cells. Distances are Euclidean, in the units of the joints.
#[derive(Debug, Clone)]
pub struct ForceField<'a> {
    grid: &'a Grid,
    laws: Khatib,
    goals: Vec<Configuration>,
    obstacles: Obstacles,
}

/// The repelling obstacles of every cell.
#[derive(Debug, Clone)]
enum Obstacles {
    /// Displacements to the nearest.
    Nearest(Vec<[f64; 2]>),
    /// All obstacle cells repel together.
    Sum(Charges),
}

/// A cell all of whose neighbours are worse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trap {
    /// The cell that cannot be left.
    pub cell: usize,
    /// Its potential; for saturated forces, which have none, the strength of the force.
    pub value: f64,
    /// True if it is a local minimum of the potential. Otherwise the forces led back to a visited cell.
    pub minimum: bool,
}

impl<'a> ForceField<'a> {
    /// Builds the field. Linear in the number of cells, times a logarithm for [`Repulsion::Sum`]. There must be a goal.
    #[must_use]
    pub fn new(grid: &'a Grid, laws: Khatib, goals: &[Configuration], limits: Limits) -> Self {
        let obstacles = match laws.repulsion {
            Repulsion::Sum(_) => Obstacles::Sum(Charges::new(grid, limits)),
            Repulsion::Ranged { .. } | Repulsion::InverseSquare(_) => {
                Obstacles::Nearest(nearest_obstacles(grid, limits))
            }
        };
        Self { grid, laws, goals: goals.to_vec(), obstacles }
    }

    /// Returns the potential in a free cell. For saturated forces, returns that of the unsaturated ones.
    #[must_use]
    pub fn potential(&self, cell: usize) -> f64 {
        let Khatib { attraction, repulsion, .. } = self.laws;
        let push = match &self.obstacles {
            Obstacles::Nearest(nearest) => repulsion.potential(nearest[cell][0].hypot(nearest[cell][1])),
            // Its slope is the force, which counts distances in cells.
            Obstacles::Sum(charges) => repulsion.potential(1.0) * charges.potential[cell] * self.side(),
        };
        attraction.potential(self.to_goal(cell).norm()) + push
    }

    /// Returns the force in a free cell.
    #[must_use]
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

    /// Returns the side of a square of a cell's area.
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

    /// Goes from cell to cell until it is in one of `targets`: to the neighbour with the lowest potential among eight,
    /// or with saturated forces to the one that lies most in the direction of the force. Corners of obstacles are not
    /// cut. At most one step a cell.
    ///
    /// # Errors
    /// [`Trap`] where no neighbour has a lower potential, or no force leads to a cell that the way has not been in.
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

    /// Returns the next cell from a cell. With saturated forces it must not have been visited.
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

    /// Iterates over the free neighbours that share a side or a corner, with their displacements. A corner counts only
    /// between two free cells.
    pub(super) fn neighbors(&self, at: usize) -> impl Iterator<Item = (usize, [f64; 2])> + '_ {
        const NEIGHBOR_OFFSETS: [[i64; 2]; 8] = [[-1, 0], [1, 0], [0, -1], [0, 1], [-1, -1], [-1, 1], [1, -1], [1, 1]];
        let step = self.grid.step();
        NEIGHBOR_OFFSETS.into_iter().filter_map(move |[i, j]| {
            let next = self.free(at, [i, j])?;
            let passable = i == 0 || j == 0 || (self.free(at, [i, 0]).is_some() && self.free(at, [0, j]).is_some());
            (passable && next != at).then_some((next, [i as f64 * step[0], j as f64 * step[1]]))
        })
    }

    /// Returns the cell this many rows and columns away, if it exists and is free.
    fn free(&self, from: usize, by: [i64; 2]) -> Option<usize> {
        let [rows, columns] = self.grid.cells;
        let place = |k: usize, at: usize, n: usize| {
            let at = at as i64 + by[k];
            let at = if self.grid.topology.ranges[k].is_circle() { at.rem_euclid(n as i64) } else { at };
            usize::try_from(at).ok().filter(|&at| at < n)
        };
        let cell = place(0, from / columns, rows)? * columns + place(1, from % columns, columns)?;
        (!self.grid.blocked[cell]).then_some(cell)
    }
}
