//! The configurations of a grid that are known to be free.

use super::reach::{BlockedMoves, straight_motions};
use super::survey::Survey;
use cplan_interrupt::checkpoint;
use cplan_model::{Arm, Scene};
use cplan_planners::cspace::{Grid, Proves};
use cplan_planners::waves::{FreeCells, Neighborhood};

/// A grid of configurations. A cell of the grid is blocked if the arm, at the centre of the cell, touches a map cell
/// that is not known to be free.
///
/// One such map cell is recorded as the witness of each blocked configuration. The configuration is examined again only
/// when its witness becomes known. So all updates of an exploration together take only a few examinations per
/// configuration, plus reading the map.
#[derive(Debug)]
pub struct KnownSpace {
    /// The grid; the centres of its cells are the configurations.
    pub grid: Grid,
    /// Steps between neighbouring free cells that are not free themselves.
    pub closed: BlockedMoves,
    /// For each map cell, the configurations of which it is the witness.
    by_witness: Vec<Vec<u32>>,
    clearance: f64,
}

impl KnownSpace {
    /// Creates the grid for the current map, with `cells` configurations along the two axes.
    pub fn new(survey: &Survey, arm: &Arm, cells: [usize; 2], clearance: f64) -> Self {
        let count = cells[0] * cells[1];
        let grid = Grid { topology: arm.topology(), proves: Proves::Sampled, cells, blocked: vec![true; count] };
        let by_witness = vec![Vec::new(); survey.map().cells.len()];
        let mut known = Self { grid, closed: BlockedMoves::new(), by_witness, clearance };
        known.reconsider(survey, arm, (0..count as u32).collect());
        known
    }

    /// Updates the grid with newly known map cells. Returns the configurations that become free, ascending.
    pub fn update(&mut self, survey: &Survey, arm: &Arm, new: &[usize]) -> Vec<usize> {
        // A closed step may be free now: fewer cells are solid, and obstacles may be lower than assumed before they were seen.
        if !new.is_empty() {
            self.closed.clear();
        }
        let by_witness: Vec<u32> = new.iter().flat_map(|&cell| std::mem::take(&mut self.by_witness[cell])).collect();
        self.reconsider(survey, arm, by_witness)
    }

    /// Closes a step that is not free, and the blocked steps connected to it. A passage that is too narrow for one step is
    /// usually too narrow for many others. If these stayed open, the arm would plan a path through each of them in turn.
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

    fn reconsider(&mut self, survey: &Survey, arm: &Arm, configurations: Vec<u32>) -> Vec<usize> {
        let mut opened = Vec::new();
        for q in configurations {
            checkpoint();
            match survey.obstruction(arm, self.grid.center(q as usize), self.clearance) {
                Some(witness) => self.by_witness[witness].push(q),
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
