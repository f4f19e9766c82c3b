//! The harmonic potential in windows, in order of falling values.
//!
//! What is known is a set of cells around the goals, at first the goals alone. A *window* is gathered from its border: the
//! unknown cells down to a guessed depth, with the known values around. Its equations are solved in doubles, scaled to the
//! greatest of these, as if the potential were 0 beyond it. Together with the values goes the probability that a walk
//! comes out where the window was cut off: as the potential there is bounded by the maximum principle, so is what that
//! adds to each value, and the values to which it adds nothing that a double could show are accepted. Errors do not grow
//! on the way, they add up: values are sums of known ones with positive weights.
//!
//! Every cell is in some two windows on average; the cost is linear in the cells, whatever the values. Where the way to the goal
//! is nowhere a long one, the first window is all there is, and mostly the last.

use super::extent::Bounds;
use super::front::Front;
use super::laplace::decay;
use super::network::{Network, SIDES};
use super::potential::Scaled;
use super::wide::Wide;
use super::{Component, Potential};
use cplan_interrupt::checkpoint;
use std::f64::consts::LN_2;

/// Stands for a cell that is in no window.
const NONE: u32 = u32::MAX;

/// Guessed depth of a window, nepers: the guessed fall of the potential, as a natural logarithm.
const DEPTH: f64 = 64.0;

/// A value is accepted if what the window leaves out adds at most this part to it.
const NEGLIGIBLE: f64 = f64::EPSILON / 4.0;

/// Values below this part of the greatest are left to a later window, where they are great: far above the least double.
const SMALLEST: f64 = 1e-200;

/// Where nowhere is more room than this a window is eliminated: mazes, ...
const NARROW: u32 = 3;
/// ... and up to this room if it is a corridor, not a hall: the factor fills with the square of the width, ...
const MEDIUM: u32 = 12;
/// ... which is told by the number of cells, at most this, ...
const SMALL: usize = 2000;
/// ... and so many times the room's square: the depth of a window is 41 times the room, its width twice.
const CORRIDOR: usize = 128;

/// Wide windows are refined down to this part of the greatest value, ...
const FLOOR: f64 = 1e-36;
/// ... which leaves values from here on precise.
const PRECISE: f64 = 1e-30;

/// The potential as far as it is known.
pub(super) struct Peeling<'a> {
    component: &'a Component,
    /// What a walk loses to death, beside the weight 1 of each neighbour.
    loss: f64,
    /// Guessed fall of the potential a cell, nepers, by the room around it.
    decay: Vec<f64>,
    /// Of each position; nothing until windows are gathered.
    room: Vec<u32>,
    pub potential: Potential,
    /// How many positions are not known.
    unknown: usize,
    /// Accepted positions that may have neighbours yet to be accepted, greatest first: by the binary logarithm, negative.
    front: Front,
    /// Number in the window of each position, or [`NONE`]; nothing until windows are gathered.
    number: Vec<u32>,
    depth: f64,
    pub windows: usize,
}

/// Unknown cells whose values are found together.
struct Window {
    /// The positions of its cells in the grid.
    cells: Vec<u32>,
    /// Positions of the accepted cells that it was gathered around.
    sources: Vec<u32>,
    /// Of the numbers in it.
    exponent: i32,
    /// Whether unknown cells were left out.
    cut: bool,
    /// Greatest accepted value that borders on unknown cells beyond the window.
    beside: f64,
    /// Greatest accepted value around.
    greatest: f64,
}

/// So many cells take less than a millisecond.
const CELLS_BETWEEN_CHECKPOINTS: usize = 4096;

impl<'a> Peeling<'a> {
    pub fn new(component: &'a Component, loss: f64) -> Self {
        let mut potential = Potential::zero(component.len());
        let mut front = Front::default();
        for goal in 0..component.goals {
            potential.set(goal, Scaled { mantissa: 1.0, exponent: 0 });
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
            depth: DEPTH,
            windows: 0,
        }
    }

    /// All values.
    pub fn run(self) -> Self {
        self.run_until(None)
    }

    /// Those that steepest ascent from a position looks at.
    pub fn run_to(self, position: usize) -> Self {
        if self.is_known(position) { self } else { self.run_until(Some(position)) }
    }

    fn run_until(mut self, last: Option<usize>) -> Self {
        // A maze or a spiral is better taken apart.
        let [rows, columns] = self.component.shape;
        if self.unknown > SMALL && self.component.levels <= rows + columns {
            self.windows += 1;
            self.solve_whole(last);
            if last.is_some_and(|last| self.is_known(last)) {
                return self;
            }
        }
        if self.unknown > 0 {
            self.number = vec![NONE; self.component.len()];
            self.room = self.component.room().widest;
            let widest = self.room.iter().copied().max().unwrap_or(0);
            self.decay = (0..=widest).map(decay).collect();
        }
        while !last.is_some_and(|last| self.leads_on(last))
            && let Some(window) = self.gather()
        {
            checkpoint();
            self.windows += 1;
            let widest = window.cells.iter().map(|&cell| self.room[cell as usize]).max().unwrap_or(0);
            let corridor = SMALL + CORRIDOR * (widest.min(MEDIUM) as usize).pow(2);
            let small = if widest <= MEDIUM { corridor } else { SMALL };
            let direct = widest <= NARROW || window.cells.len() <= small;
            let wide = if direct { None } else { self.wide(&window) };
            let solved = wide.and_then(|wide| wide.solve(FLOOR * window.greatest, None).map(|values| (wide, values)));
            let accepted = if let Some((wide, values)) = solved {
                let component = self.component;
                let at = |i: usize| wide.extent.at(component.place(window.cells[i] as usize));
                self.accept(&window, |i| wide.at(&values, at(i)), PRECISE)
            } else {
                let solution = self.network(&window).solve();
                self.accept(&window, |i| solution[i], SMALLEST)
            };
            if 4 * accepted < window.cells.len() {
                self.depth *= 1.5;
            }
        }
        self
    }

    /// Whether steepest ascent from a position to a goal looks at nothing that is unknown.
    fn leads_on(&self, from: usize) -> bool {
        let way = if self.is_known(from) { self.potential.ascend(self.component, from) } else { None };
        way.is_some_and(|way| way.iter().all(|&at| at < self.component.goals || !self.is_front(at)))
    }

    /// All unknown cells as one window, that nothing is cut off from; of those whose values are less than that of the `last` no more than that
    /// they are less. Row by row, as they lie in the grid: no window's list of cells and no numbers.
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
        let mut wide = Wide::new(extent, self.loss);
        for i in rows.clone() {
            let flags = wide.row_mut(i).iter_mut().zip(row(i));
            flags.for_each(|(free, position)| *free = is_unknown(position));
        }
        for goal in 0..component.goals {
            for n in self.around(goal).filter(|&n| n >= component.goals) {
                wide.add(extent.at(component.place(n)), [1.0, 0.0]);
            }
        }
        let last = last.map(|last| extent.at(component.place(last)));
        let Some(values) = wide.solve(FLOOR, last) else { return };
        for i in rows {
            let first = extent.at([i, extent.first[1]]);
            for (&position, at) in row(i).iter().zip(first..).filter(|(position, _)| is_unknown(position)) {
                let [u, _] = wide.at(&values, at);
                if u >= PRECISE {
                    self.potential.set(position as usize, Scaled { mantissa: u, exponent: 0 }.normalized());
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

    /// The neighbours of a cell that are cells.
    fn around(&self, position: usize) -> impl Iterator<Item = usize> + use<'a> {
        let wall = self.component.wall();
        self.component.neighbors(position).into_iter().filter(move |&n| n != wall)
    }

    fn is_front(&self, position: usize) -> bool {
        self.around(position).any(|n| !self.is_known(n))
    }

    /// The unknown cells around the greatest accepted values; nothing if there are none.
    fn gather(&mut self) -> Option<Window> {
        while self.front.peek().is_some_and(|(_, position)| !self.is_front(position as usize)) {
            self.front.pop();
        }
        let (top, position) = self.front.peek()?;
        let exponent = self.potential.at(position as usize).exponent;
        let greatest = self.potential.at(position as usize).mantissa;
        let mut sources = Vec::new();
        let mut cells: Vec<u32> = Vec::new();
        let (mut beside, mut cut) = (0.0_f64, false);
        // Cells to go on from, by depth in whole nepers.
        let mut waiting: Vec<Vec<(f64, u32)>> = vec![Vec::new(); self.depth.ceil() as usize + 1];
        while let Some((below, position)) = self.front.peek() {
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
                for next in self.around(from as usize) {
                    if self.is_known(next) || self.number[next] != NONE {
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

    /// The window's equations: the first side for the known values around, the second for 1 at the unknown cells beyond.
    fn network(&self, window: &Window) -> Network {
        let mut network = Network::new(window.cells.len());
        for (i, &position) in window.cells.iter().enumerate() {
            network.ground(i, self.loss, [0.0; 2]);
            for n in self.component.neighbors(position as usize) {
                if n == self.component.wall() {
                    network.ground(i, 1.0, [0.0; 2]);
                } else if self.is_known(n) {
                    network.ground(i, 1.0, [self.potential.at(n).mantissa_at(window.exponent), 0.0]);
                } else if self.number[n] == NONE {
                    network.ground(i, 1.0, [0.0, 1.0]);
                } else if n != position as usize {
                    network.join(i, self.number[n] as usize, 1.0);
                }
            }
        }
        network
    }

    /// The same equations on the smallest box of cells around them.
    fn wide(&self, window: &Window) -> Option<Wide> {
        let mut bounds = Bounds::new();
        for &position in &window.cells {
            let place = self.component.place(position as usize);
            bounds.include(place);
            for k in [0, 1].into_iter().filter(|&k| place[k] == 0) {
                let before = self.component.neighbors(position as usize)[2 * k];
                bounds.join(k, before != self.component.wall() && self.number[before] != NONE);
            }
        }
        let extent = bounds.extent(self.component.shape)?;
        let mut wide = Wide::new(extent, self.loss);
        for &position in &window.cells {
            let mut source = [0.0; SIDES];
            for n in self.around(position as usize) {
                if self.is_known(n) {
                    source[0] += self.potential.at(n).mantissa_at(window.exponent);
                } else if self.number[n] == NONE {
                    source[1] += 1.0;
                }
            }
            let at = extent.at(self.component.place(position as usize));
            wide.free(at);
            wide.add(at, source);
        }
        Some(wide)
    }

    /// Takes over the values that what is beyond the window has no part in; how many.
    fn accept(&mut self, window: &Window, solution: impl Fn(usize) -> [f64; SIDES], least: f64) -> usize {
        // Values beyond are at most the greatest of those next to them: of known cells, or of the window's own, which
        // are at most their value here and their share of what is beyond.
        let mut beyond = window.beside;
        let (mut value, mut share) = (0.0_f64, 0.0_f64);
        let at_risk = if window.cut { &window.cells[..] } else { &[] };
        for (i, &position) in at_risk.iter().enumerate() {
            let [u, e] = solution(i);
            if self.around(position as usize).any(|n| !self.is_known(n) && self.number[n] == NONE) {
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
            self.number[position as usize] = NONE;
            if e * beyond <= NEGLIGIBLE * u && u >= least * window.greatest {
                self.potential.set(position as usize, Scaled { mantissa: u, exponent: window.exponent }.normalized());
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

    /// Goes on from a position later, if it is known and a neighbour is not.
    fn push_front(&mut self, position: u32) {
        if self.is_known(position as usize) && self.is_front(position as usize) {
            let log2 = self.potential.at(position as usize).log2();
            // Zero keeps its sign.
            self.front.push(0.0 - log2, position);
        }
    }
}
