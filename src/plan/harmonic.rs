//! The harmonic field planner.

use super::attach::Joined;
use super::{Note, Outcome, Planner, Query, Run, Size, Trace, grid_path};
use crate::cspace::Grid;
use crate::field::{Component, Lattice, Potential, Progress, harmonic, rough_harmonic};

/// Solves Laplace's equation on the goal's component (1 at the goals, 0 on obstacles and beyond limits, periodic on
/// circles) and climbs it by the greatest neighbour (Connolly, Grupen 1993).
///
/// Complete on the grid: whatever the length of a corridor, the field has no local maximum but the goals (see
/// [`crate::field::harmonic`]), so no path is found only if there is none between the cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Harmonic {
    /// Over-relaxation, at least 1 and less than 2; 1 is Gauss-Seidel. None: a good one for the widest room.
    pub factor: Option<f64>,
    /// The field is relaxed until no value changes by more than this part of itself in a sweep.
    pub tolerance: f64,
    /// At most so many sweeps.
    pub max_sweeps: usize,
    /// Whether corners that the grid allows to cut are cut.
    pub shortcut: bool,
}

impl Default for Harmonic {
    /// A tolerance of 1e-6 leaves directions of ascent as they are, but for cells where two are practically equal. 500
    /// sweeps meet it on some 256 x 256 cells; a 1024 x 1024 grid with wide rooms stops before, with a field that
    /// navigates all the same.
    fn default() -> Self {
        Self { factor: None, tolerance: 1e-6, max_sweeps: 500, shortcut: true }
    }
}

impl Planner for Harmonic {
    const NAME: &'static str = "harmonic";
    type Space = Grid;
    type Map = Lattice;

    fn build(&self, space: &Grid) -> Lattice {
        Lattice::new(space)
    }

    fn query(&self, space: &Grid, map: &Lattice, query: &Query) -> Run {
        let gave_up = |reason: String| Run {
            outcome: Outcome::GaveUp(reason),
            trace: Trace::Field { cells: space.cells, potential: vec![f64::NEG_INFINITY; space.blocked.len()] },
            size: Size::Grid { cells: 0, sweeps: 0 },
            note: None,
        };
        if !self.factor.is_none_or(|factor| (1.0..2.0).contains(&factor)) {
            return gave_up("the relaxation factor must be at least 1 and less than 2".into());
        }
        let joined = match Joined::new(space, query) {
            Ok(joined) => joined,
            Err(reason) => return gave_up(reason),
        };
        let wave = map.wave(&joined.sources());
        let component = Component::new(map, &wave);
        // The nearest cell of the start that the wave came to.
        let Some(start) = joined.start.cells.iter().find_map(|&cell| component.position_of(cell)) else {
            return Run {
                outcome: Outcome::NoPath,
                trace: trace(space, &component, &rough_harmonic(&component)),
                size: Size::Grid { cells: component.len(), sweeps: 0 },
                note: None,
            };
        };
        let field = harmonic(&component, self.factor, self.tolerance, self.max_sweeps);
        let Progress { sweeps, change, converged } = field.progress;
        let size = Size::Grid { cells: component.len(), sweeps };
        let note = (!converged).then_some(Note::Unconverged { sweeps, change });
        let trace = trace(space, &component, &field.potential);
        let path = field.potential.ascend(&component, start).and_then(|positions| {
            let cells: Vec<usize> = positions.into_iter().map(|at| component.cells[at] as usize).collect();
            grid_path::path(space, query, &joined, &cells, self.shortcut)
        });
        let outcome = path.map_or_else(|| Outcome::GaveUp("the field has a local maximum".into()), Outcome::Found);
        Run { outcome, trace, size, note }
    }
}

/// The logarithms as a grid.
fn trace(space: &Grid, component: &Component, potential: &Potential) -> Trace {
    let mut ln = vec![f64::NEG_INFINITY; space.blocked.len()];
    for (at, &cell) in component.cells.iter().enumerate() {
        ln[cell as usize] = potential.ln(at);
    }
    Trace::Field { cells: space.cells, potential: ln }
}
