//! The configurations of a grid that are known to be free.

use super::reach::{BlockedMoves, straight_motions};
use super::survey::Survey;
use cplan_core::cspace::{Grid, Proves};
use cplan_core::model::{Arm, Scene};
use cplan_core::waves::{FreeCells, Neighborhood};
use cplan_interrupt::checkpoint;

/// A grid of configurations, blocked where the arm touches a map cell that is not known to be free.
///
/// Each blocked configuration has such a cell as its witness, and is examined again only when that cell changes. So all
/// updates of an exploration together cost a few examinations per configuration, plus reading the map.
#[derive(Debug)]
pub struct KnownSpace {
    /// The middles of its cells are the configurations.
    pub grid: Grid,
    /// Steps between free middles that are not free themselves.
    pub closed: BlockedMoves,
    /// The configurations for which each map cell is the witness.
    waiting: Vec<Vec<u32>>,
    clearance: f64,
}

impl KnownSpace {
    /// Creates the grid for the current map, with `cells` configurations along the two axes.
    #[must_use]
    pub fn new(survey: &Survey, arm: &Arm, cells: [usize; 2], clearance: f64) -> Self {
        let count = cells[0] * cells[1];
        let grid = Grid { topology: arm.topology(), proves: Proves::Sampled, cells, blocked: vec![true; count] };
        let waiting = vec![Vec::new(); survey.map().cells.len()];
        let mut known = Self { grid, closed: BlockedMoves::new(), waiting, clearance };
        known.look_at(survey, arm, (0..count as u32).collect());
        known
    }

    /// Updates the grid with newly known map cells. Returns the configurations that become free, ascending.
    pub fn update(&mut self, survey: &Survey, arm: &Arm, new: &[usize]) -> Vec<usize> {
        // A step may become free when less is solid, and seen obstacles may be lower than assumed.
        if !new.is_empty() {
            self.closed.clear();
        }
        let waiting: Vec<u32> = new.iter().flat_map(|&cell| std::mem::take(&mut self.waiting[cell])).collect();
        self.look_at(survey, arm, waiting)
    }

    /// Closes a step that is not free, and blocked steps around it. A passage that is too narrow for one step is too
    /// narrow for many, and each would cost a path that ends there.
    pub fn close(&mut self, solid: &Scene, step: [usize; 2]) {
        let (free, motions) = (FreeCells::new(&self.grid), straight_motions(solid));
        let mut found = vec![step];
        while let Some([a, b]) = found.pop() {
            checkpoint();
            let is_new = self.closed.insert([a, b]) | self.closed.insert([b, a]);
            for cell in [a, b].into_iter().filter(|_| is_new) {
                let q = self.grid.center(cell);
                let is_shut = |to: &usize| {
                    let is_closed = self.closed.contains(&[cell, *to]);
                    !is_closed && !motions.is_free(q, self.grid.topology.lift(self.grid.center(*to), q))
                };
                let around = free.moves(cell, Neighborhood::Eight).map(|step| step.to);
                found.extend(around.filter(is_shut).map(|to| [cell, to]));
            }
        }
    }

    fn look_at(&mut self, survey: &Survey, arm: &Arm, configurations: Vec<u32>) -> Vec<usize> {
        let mut opened = Vec::new();
        for q in configurations {
            checkpoint();
            match survey.obstruction(arm, self.grid.center(q as usize), self.clearance) {
                Some(witness) => self.waiting[witness].push(q),
                None => {
                    self.grid.blocked[q as usize] = false;
                    opened.push(q as usize);
                }
            }
        }
        opened.sort_unstable();
        opened
    }
}
