//! Computes the harmonic potential in windows, in order of falling values.
//!
//! Initially, only the goals are known. A *window* has the unknown cells next to known ones, down to an estimated depth. Its
//! equations are solved in doubles, scaled to the greatest known value around it, as if the potential were 0 beyond it.
//!
//! For each cell, the solver also computes the probability that a walk leaves the window where it was cut off. The maximum
//! principle bounds the potential there, and thus the missing part of each value. Values whose missing part is below the
//! precision of a double are accepted. Errors add up but are not magnified, because each value is a sum of known values with
//! positive weights.
//!
//! On average, every cell is in about two windows, so the cost is linear in the number of cells, whatever the values. If no path
//! is long, the first window covers all cells and is usually the only one.

use super::extent::Bounds;
use super::laplace::decay;
use super::network::{Network, RIGHT_SIDES};
use super::potential::ScaledNumber;
use super::wide::WideSystem;
use super::{Component, Potential};
use cplan_geometry::OpenList;
use cplan_interrupt::checkpoint;
use std::f64::consts::LN_2;

/// Value of [`Peeling::number`] for a cell that is in no window.
const NO_WINDOW: u32 = u32::MAX;

/// Estimated depth of a window: the fall of the potential inside it, in nepers (natural logarithm).
const WINDOW_DEPTH: f64 = 64.0;

/// A value is accepted if cells beyond the window, which are missing in the window's equations, contribute at most this fraction
/// of it.
const NEGLIGIBLE_SHARE: f64 = f64::EPSILON / 4.0;

/// Least accepted value of a window, as a fraction of the greatest value next to the window. Smaller values wait for a later
/// window, in which they are relatively large. The limit is far above the least double.
const MIN_VALUE_SHARE: f64 = 1e-200;

/// Greatest room (`Room::widest`) of a window that counts as a maze, which is solved by elimination.
const MAX_MAZE_ROOM: u32 = 3;
/// Greatest room of a window that counts as a corridor, which is solved by elimination if it has few cells. The cost of
/// elimination grows with the square of the width.
const MAX_CORRIDOR_ROOM: u32 = 12;
/// A window with at most this number of cells is always solved by elimination.
const SMALL_WINDOW_CELLS: usize = 2000;
/// Largest number of further cells of a corridor, as a multiple of its squared room. A corridor is twice as wide as its room, and
/// its window is 41 times as long as the room.
const CORRIDOR_CELLS_PER_ROOM: usize = 128;

/// Least value of a wide window that is refined, as a fraction of the greatest value next to the window.
const REFINEMENT_FLOOR: f64 = 1e-36;
/// Least value of a wide window that is accepted after refinement, as a fraction of the greatest value next to the window.
const PRECISE_SHARE: f64 = 1e-30;

/// The part of the potential that is known so far.
pub(super) struct Peeling<'a> {
    component: &'a Component,
    /// Weight with which a walk ends at each step; each neighbour has the weight 1.
    loss: f64,
    /// Estimated fall of the potential per cell, in nepers, for each room around the cell.
    decay: Vec<f64>,
    /// Room of each position. Empty until the first window is gathered.
    room: Vec<u32>,
    pub potential: Potential,
    /// Number of unknown positions.
    unknown: usize,
    /// Accepted positions that may have unknown neighbours, those with the greatest values first. Keys are negated binary
    /// logarithms of the values.
    front: OpenList<u32>,
    /// Number of each position within the window, or [`NO_WINDOW`]. Empty until the first window is gathered.
    number: Vec<u32>,
    depth: f64,
    pub windows: usize,
}

/// Unknown cells whose values are computed together.
struct Window {
    /// Positions of the window's cells.
    cells: Vec<u32>,
    /// Positions of the accepted cells around which the window was gathered.
    sources: Vec<u32>,
    /// Common exponent of the numbers in the window's equations.
    exponent: i32,
    /// True if unknown cells next to the window do not belong to it.
    cut: bool,
    /// Greatest accepted value next to unknown cells beyond the window.
    beside: f64,
    /// Greatest accepted value next to the window.
    greatest: f64,
}

/// Number of cells between two checkpoints. They take less than a millisecond.
const CELLS_BETWEEN_CHECKPOINTS: usize = 4096;

impl<'a> Peeling<'a> {
    pub fn new(component: &'a Component, loss: f64) -> Self {
        let mut potential = Potential::zero(component.len());
        let mut front = OpenList::default();
        for goal in 0..component.goals {
            potential.set(goal, ScaledNumber { mantissa: 1.0, exponent: 0 });
            front.push(0.0, goal as u32);
        }
        Self {
            component,
            loss,
            decay: Vec::new(),
            room: Vec::new(),
            potential,
            unknown: component.len() - component.goals,
            front,
            number: Vec::new(),
            depth: WINDOW_DEPTH,
            windows: 0,
        }
    }

    /// Computes all values.
    pub fn run(self) -> Self {
        self.run_until(None)
    }

    /// Computes at least those values that steepest ascent from a position reads.
    pub fn run_to(self, position: usize) -> Self {
        if self.is_known(position) { self } else { self.run_until(Some(position)) }
    }

    fn run_until(mut self, last: Option<usize>) -> Self {
        // Mazes and spirals are better solved in several windows.
        let [rows, columns] = self.component.shape;
        if self.unknown > SMALL_WINDOW_CELLS && self.component.levels <= rows + columns {
            self.windows += 1;
            self.solve_whole(last);
            if last.is_some_and(|last| self.is_known(last)) {
                return self;
            }
        }
        if self.unknown > 0 {
            self.number = vec![NO_WINDOW; self.component.len()];
            self.room = self.component.room().widest;
            let widest = self.room.iter().copied().max().unwrap_or(0);
            self.decay = (0..=widest).map(decay).collect();
        }
        while !last.is_some_and(|last| self.can_ascend(last))
            && let Some(window) = self.gather()
        {
            checkpoint();
            self.windows += 1;
            let widest = window.cells.iter().map(|&cell| self.room[cell as usize]).max().unwrap_or(0);
            let corridor =
                SMALL_WINDOW_CELLS + CORRIDOR_CELLS_PER_ROOM * (widest.min(MAX_CORRIDOR_ROOM) as usize).pow(2);
            let small = if widest <= MAX_CORRIDOR_ROOM { corridor } else { SMALL_WINDOW_CELLS };
            let direct = widest <= MAX_MAZE_ROOM || window.cells.len() <= small;
            let wide = if direct { None } else { self.wide_system(&window) };
            let solved =
                wide.and_then(|wide| wide.solve(REFINEMENT_FLOOR * window.greatest, None).map(|values| (wide, values)));
            let accepted = if let Some((wide, values)) = solved {
                let component = self.component;
                let at = |i: usize| wide.extent.at(component.place(window.cells[i] as usize));
                self.accept(&window, |i| wide.at(&values, at(i)), PRECISE_SHARE)
            } else {
                let solution = self.network(&window).solve();
                self.accept(&window, |i| solution[i], MIN_VALUE_SHARE)
            };
            if 4 * accepted < window.cells.len() {
                self.depth *= 1.5;
            }
        }
        self
    }

    /// Returns true if steepest ascent from a position to a goal reads only known values.
    fn can_ascend(&self, from: usize) -> bool {
        let path = if self.is_known(from) { self.potential.ascend(self.component, from) } else { None };
        path.is_some_and(|path| path.iter().all(|&at| at < self.component.goals || !self.is_front(at)))
    }

    /// Solves all unknown cells as one window without a cut. If `last` is given, values below that at `last` need not be precise.
    /// Works row by row in the order of the grid, without a list of cells.
    fn solve_whole(&mut self, last: Option<usize>) {
        let component = self.component;
        let cells = component.goals as u32..component.len() as u32;
        let is_unknown = |position: &u32| cells.contains(position);
        let mut bounds = Bounds::new();
        for (i, row) in (0..component.shape[0]).map(|i| (i, component.row(i))) {
            let ends = [row.iter().position(is_unknown), row.iter().rposition(is_unknown)];
            ends.into_iter().flatten().for_each(|j| bounds.include([i, j]));
            let seam = |k: usize, position: &u32| {
                is_unknown(position) && is_unknown(&(component.neighbors(*position as usize)[2 * k] as u32))
            };
            bounds.join(0, i == 0 && row.iter().any(|position| seam(0, position)));
            bounds.join(1, seam(1, &row[0]));
        }
        let Some(extent) = bounds.extent(component.shape) else { return };
        let rows = extent.first[0]..extent.first[0] + extent.cells[0];
        let row = |i: usize| &component.row(i)[extent.first[1]..extent.first[1] + extent.cells[1]];
        let mut wide = WideSystem::new(extent, self.loss);
        for i in rows.clone() {
            let flags = wide.row_mut(i).iter_mut().zip(row(i));
            flags.for_each(|(free, position)| *free = is_unknown(position));
        }
        for goal in 0..component.goals {
            for n in self.free_neighbors(goal).filter(|&n| n >= component.goals) {
                wide.add(extent.at(component.place(n)), [1.0, 0.0]);
            }
        }
        let last = last.map(|last| extent.at(component.place(last)));
        let Some(values) = wide.solve(REFINEMENT_FLOOR, last) else { return };
        for i in rows {
            let first = extent.at([i, extent.first[1]]);
            for (&position, at) in row(i).iter().zip(first..).filter(|(position, _)| is_unknown(position)) {
                let [u, _] = wide.at(&values, at);
                if u >= PRECISE_SHARE {
                    self.potential.set(position as usize, ScaledNumber { mantissa: u, exponent: 0 }.normalized());
                    self.unknown -= 1;
                }
            }
        }
        self.front.clear();
        if self.unknown > 0 {
            (0..component.len() as u32).for_each(|position| self.push_front(position));
        }
    }

    fn is_known(&self, position: usize) -> bool {
        self.potential.mantissa[position] > 0.0
    }

    /// Iterates over the neighbours of a cell that are not walls.
    fn free_neighbors(&self, position: usize) -> impl Iterator<Item = usize> + use<'a> {
        let wall = self.component.wall();
        self.component.neighbors(position).into_iter().filter(move |&n| n != wall)
    }

    fn is_front(&self, position: usize) -> bool {
        self.free_neighbors(position).any(|n| !self.is_known(n))
    }

    /// Gathers the unknown cells around the greatest accepted values. `None` if no cells remain.
    fn gather(&mut self) -> Option<Window> {
        while self.front.peek().is_some_and(|(_, &position)| !self.is_front(position as usize)) {
            self.front.pop();
        }
        let (top, &position) = self.front.peek()?;
        let exponent = self.potential.at(position as usize).exponent;
        let greatest = self.potential.at(position as usize).mantissa;
        let mut sources = Vec::new();
        let mut cells: Vec<u32> = Vec::new();
        let (mut beside, mut cut) = (0.0_f64, false);
        // Cells from which to continue, by depth in whole nepers.
        let mut waiting: Vec<Vec<(f64, u32)>> = vec![Vec::new(); self.depth.ceil() as usize + 1];
        while let Some((below, &position)) = self.front.peek() {
            let depth = (below - top) * LN_2;
            let is_front = self.is_front(position as usize);
            if is_front && depth > self.depth {
                (beside, cut) = (self.potential.at(position as usize).mantissa_at(exponent), true);
                break;
            }
            self.front.pop();
            if !is_front {
                continue;
            }
            sources.push(position);
            waiting[depth as usize].push((depth, position));
        }
        for level in 0..waiting.len() {
            let mut at = 0;
            while at < waiting[level].len() {
                if at.is_multiple_of(CELLS_BETWEEN_CHECKPOINTS) {
                    checkpoint();
                }
                let (depth, from) = waiting[level][at];
                at += 1;
                let mut cut_here = false;
                for next in self.free_neighbors(from as usize) {
                    if self.is_known(next) || self.number[next] != NO_WINDOW {
                        continue;
                    }
                    let depth = depth + self.decay[self.room[next] as usize];
                    if depth > self.depth {
                        cut_here = true;
                        continue;
                    }
                    self.number[next] = cells.len() as u32;
                    cells.push(next as u32);
                    waiting[depth as usize].push((depth, next as u32));
                }
                cut |= cut_here;
                if cut_here && self.is_known(from as usize) {
                    beside = beside.max(self.potential.at(from as usize).mantissa_at(exponent));
                }
            }
        }
        Some(Window { cells, sources, exponent, cut, beside, greatest })
    }

    /// Builds the window's equations. The first right-hand side has the known values around the window, and the second
    /// has 1 at the cells where the window was cut off.
    fn network(&self, window: &Window) -> Network {
        let mut network = Network::new(window.cells.len());
        for (i, &position) in window.cells.iter().enumerate() {
            network.ground(i, self.loss, [0.0; 2]);
            for n in self.component.neighbors(position as usize) {
                if n == self.component.wall() {
                    network.ground(i, 1.0, [0.0; 2]);
                } else if self.is_known(n) {
                    network.ground(i, 1.0, [self.potential.at(n).mantissa_at(window.exponent), 0.0]);
                } else if self.number[n] == NO_WINDOW {
                    network.ground(i, 1.0, [0.0, 1.0]);
                } else if n != position as usize {
                    network.join(i, self.number[n] as usize, 1.0);
                }
            }
        }
        network
    }

    /// Builds the same equations as [`Self::network`], on the smallest box around the cells.
    fn wide_system(&self, window: &Window) -> Option<WideSystem> {
        let mut bounds = Bounds::new();
        for &position in &window.cells {
            let place = self.component.place(position as usize);
            bounds.include(place);
            for k in [0, 1].into_iter().filter(|&k| place[k] == 0) {
                let before = self.component.neighbors(position as usize)[2 * k];
                bounds.join(k, before != self.component.wall() && self.number[before] != NO_WINDOW);
            }
        }
        let extent = bounds.extent(self.component.shape)?;
        let mut wide = WideSystem::new(extent, self.loss);
        for &position in &window.cells {
            let mut source = [0.0; RIGHT_SIDES];
            for n in self.free_neighbors(position as usize) {
                if self.is_known(n) {
                    source[0] += self.potential.at(n).mantissa_at(window.exponent);
                } else if self.number[n] == NO_WINDOW {
                    source[1] += 1.0;
                }
            }
            let at = extent.at(self.component.place(position as usize));
            wide.free(at);
            wide.add(at, source);
        }
        Some(wide)
    }

    /// Accepts the values that do not depend noticeably on cells beyond the window, and returns their number.
    fn accept(&mut self, window: &Window, solution: impl Fn(usize) -> [f64; RIGHT_SIDES], least: f64) -> usize {
        // Values beyond the window are at most the greatest of those next to them. These are known values, or values of the
        // window, which are at most their value here plus their share of the values beyond.
        let mut beyond = window.beside;
        let (mut value, mut share) = (0.0_f64, 0.0_f64);
        let at_risk = if window.cut { &window.cells[..] } else { &[] };
        for (i, &position) in at_risk.iter().enumerate() {
            let [u, e] = solution(i);
            if self.free_neighbors(position as usize).any(|n| !self.is_known(n) && self.number[n] == NO_WINDOW) {
                value = value.max(u);
                share = share.max(e);
            }
        }
        if value > 0.0 {
            beyond = if share < 1.0 { beyond.max(value / (1.0 - share)).min(window.greatest) } else { window.greatest };
        }
        let mut taken = 0;
        for (i, &position) in window.cells.iter().enumerate() {
            let [u, e] = solution(i);
            self.number[position as usize] = NO_WINDOW;
            if e * beyond <= NEGLIGIBLE_SHARE * u && u >= least * window.greatest {
                self.potential
                    .set(position as usize, ScaledNumber { mantissa: u, exponent: window.exponent }.normalized());
                taken += 1;
            }
        }
        self.unknown -= taken;
        if self.unknown == 0 {
            self.front.clear();
            return taken;
        }
        window.sources.iter().chain(&window.cells).for_each(|&position| self.push_front(position));
        taken
    }

    /// Queues a position if the next window may start there: its value is known, and that of a neighbour is not.
    fn push_front(&mut self, position: u32) {
        if self.is_known(position as usize) && self.is_front(position as usize) {
            let log2 = self.potential.at(position as usize).log2();
            // Subtracting from 0 keeps the sign of zero.
            self.front.push(0.0 - log2, position);
        }
    }
}
