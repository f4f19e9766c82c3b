//! Decides whether start and goal are connected: a flood fill over cells that are surely free, surely blocked, or
//! neither.
//!
//! Cells are halved along both axes until the answer is certain or the limit is reached. If a large cell is surely free
//! or blocked, so are its parts. So the result is that of the finest lattice, at the cost of the undecided cells.

use cplan::space::Configuration;
use cplan_testkit::flood::Cells;
use cplan_testkit::oracle::{Meeting, Oracle};
use cplan_testkit::solid::V;
use std::f64::consts::TAU;

/// Verdict of the lattice about a path from the start to any goal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Truth {
    Connected,
    Disconnected,
    Undecided,
}

const FREE: u8 = 1;
const BLOCKED: u8 = 2;
const OPEN: u8 = 3;

/// Number of cells along an axis in the first lattice.
const COARSEST: usize = 32;

/// A cell that is neither free nor blocked yet, and the bodies that can meet in it.
struct Open {
    at: [usize; 2],
    meetings: std::ops::Range<usize>,
}

/// The lattice of `n x n` cells.
struct Lattice<'a> {
    oracle: &'a Oracle,
    n: usize,
    labels: Vec<u8>,
    open: Vec<Open>,
    meetings: Vec<Meeting>,
}

/// Decides whether a path leads from `start` to one of `goals`. Refines the lattice up to `finest x finest` cells.
pub fn connected(oracle: &Oracle, start: Configuration, goals: &[Configuration], finest: usize) -> Truth {
    let mut lattice = Lattice::coarsest(oracle);
    loop {
        let from = lattice.cell(start);
        let around = lattice.flood(&[from], |label| label != BLOCKED);
        if !goals.iter().any(|&g| around[lattice.cell(g)]) {
            return Truth::Disconnected;
        }
        let ways_in: Vec<usize> = goals.iter().flat_map(|&g| lattice.nearby_free_cells(g)).collect();
        let free = lattice.flood(&lattice.nearby_free_cells(start), |label| label == FREE);
        if ways_in.iter().any(|&cell| free[cell]) {
            return Truth::Connected;
        }
        if lattice.n >= finest {
            return Truth::Undecided;
        }
        lattice = lattice.with_half_cells(&around);
    }
}

impl<'a> Lattice<'a> {
    fn coarsest(oracle: &'a Oracle) -> Self {
        let all: Vec<Meeting> = oracle.meetings().collect();
        let n = COARSEST;
        let mut lattice = Self { oracle, n, labels: vec![BLOCKED; n * n], open: Vec::new(), meetings: Vec::new() };
        for cell in 0..n * n {
            lattice.judge([cell / n, cell % n], &all);
        }
        lattice
    }

    /// Returns the lattice with cells half as large. Only cells in `around` count; all others are out of reach.
    fn with_half_cells(self, around: &[bool]) -> Self {
        let (n, coarse) = (2 * self.n, self.n);
        let mut labels = vec![BLOCKED; n * n];
        for i in 0..n {
            for j in 0..n {
                let parent = i / 2 * coarse + j / 2;
                if around[parent] && self.labels[parent] == FREE {
                    labels[i * n + j] = FREE;
                }
            }
        }
        let mut lattice = Self { oracle: self.oracle, n, labels, open: Vec::new(), meetings: Vec::new() };
        for Open { at: [i, j], meetings } in self.open {
            if around[i * coarse + j] {
                for (di, dj) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    lattice.judge([2 * i + di, 2 * j + dj], &self.meetings[meetings.clone()]);
                }
            }
        }
        lattice
    }

    fn step(&self) -> V {
        self.oracle.axes.map(|(lower, upper, _)| (upper - lower) / self.n as f64)
    }

    /// Labels a cell in which only these pairs of bodies can meet.
    fn judge(&mut self, at: [usize; 2], candidates: &[Meeting]) {
        let step = self.step();
        let middle = [0, 1].map(|k| self.oracle.axes[k].0 + (at[k] as f64 + 0.5) * step[k]);
        // A little more than half, so that neighbours' cells overlap despite rounding.
        let half = step.map(|s| s / 2.0 * (1.0 + 1e-9) + 1e-12);
        let mut posture = self.oracle.posture(middle);
        let first = self.meetings.len();
        let mut label = FREE;
        for &meeting in candidates {
            let bounds = self.oracle.bounds(&mut posture, meeting, half);
            if bounds.most < -1e-12 {
                label = BLOCKED;
                break;
            }
            if bounds.least <= 1e-12 {
                label = OPEN;
                self.meetings.push(meeting);
            }
        }
        self.labels[at[0] * self.n + at[1]] = label;
        match label {
            OPEN => self.open.push(Open { at, meetings: first..self.meetings.len() }),
            _ => self.meetings.truncate(first),
        }
    }

    fn cells(&self) -> Cells {
        Cells { count: [self.n; 2], circles: self.oracle.axes.map(|axis| axis.2) }
    }

    fn cell(&self, q: Configuration) -> usize {
        self.cells().locate(self.oracle.axes.map(|(lower, upper, _)| [lower, upper]), q.into())
    }

    /// Returns free cells to which a straight motion leads from `q`: the cell that contains `q`, or cells around it if
    /// it is too tight for the lattice. Each step is at most as long as the room at its beginning.
    fn nearby_free_cells(&self, q: Configuration) -> Vec<usize> {
        let own = self.cell(q);
        if self.labels[own] == FREE {
            return vec![own];
        }
        let step = self.step();
        (0..32).filter_map(|k| self.free_cell_towards(q, TAU * f64::from(k) / 32.0, step)).collect()
    }

    fn free_cell_towards(&self, q: Configuration, angle: f64, step: V) -> Option<usize> {
        const CELLS: f64 = 8.0;
        let direction = Configuration::new(step[0] * angle.cos(), step[1] * angle.sin());
        let speed = self.oracle.speed(direction);
        let mut t = 0.0;
        for _ in 0..200 {
            let at = q + direction * t;
            let inside = |k: usize| {
                let (lower, upper, circle) = self.oracle.axes[k];
                circle || (lower..=upper).contains(&at[k])
            };
            let room = self.oracle.room(at);
            if t > CELLS || !inside(0) || !inside(1) || room < 1e-10 {
                return None;
            }
            let cell = self.cell(at);
            if self.labels[cell] == FREE {
                return Some(cell);
            }
            t += (0.9 * room / speed).min(0.5);
        }
        None
    }

    fn flood(&self, from: &[usize], passes: impl Fn(u8) -> bool) -> Vec<bool> {
        let from = from.iter().copied().filter(|&cell| passes(self.labels[cell]));
        self.cells().flood(from, |_, next| passes(self.labels[next]))
    }
}
