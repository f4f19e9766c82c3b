//! The Manhattan wavefront: breadth-first labels from the goal, and the way down them.

use super::attach::Joined;
use super::{Outcome, Planner, Query, Run, Size, Trace, grid_path};
use crate::cspace::Grid;
use crate::field::{Lattice, UNREACHED};

/// Labels the goal's whole component with the number of steps to the nearest goal (0 there), level by level over cells
/// that share a side, then goes from the start to the smallest neighbour until a goal is reached: a path of cells that is
/// shortest in the `L1` metric (Latombe 1991, the navigation function in that metric).
///
/// Linear in the number of cells. Complete on the grid: no path is found only if there is none between the cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wavefront {
    /// Whether corners that the grid allows to cut are cut.
    pub shortcut: bool,
}

impl Default for Wavefront {
    fn default() -> Self {
        Self { shortcut: true }
    }
}

impl Planner for Wavefront {
    const NAME: &'static str = "wavefront";
    type Space = Grid;
    type Map = Lattice;

    fn build(&self, space: &Grid) -> Lattice {
        Lattice::new(space)
    }

    fn query(&self, space: &Grid, map: &Lattice, query: &Query) -> Run {
        let joined = match Joined::new(space, query) {
            Ok(joined) => joined,
            Err(reason) => {
                let labels = vec![UNREACHED; space.blocked.len()];
                return Run {
                    outcome: Outcome::GaveUp(reason),
                    trace: Trace::Wavefront { cells: space.cells, labels },
                    size: Size::Grid { cells: 0, sweeps: 0 },
                    note: None,
                };
            }
        };
        let wave = map.wave(&joined.sources());
        // The nearest cell of the start that the wave came to.
        let cells = joined.start.cells.iter().find_map(|&cell| wave.descend(map, cell));
        let path = cells.and_then(|cells| grid_path::path(space, query, &joined, &cells, self.shortcut));
        Run {
            outcome: path.map_or(Outcome::NoPath, Outcome::Found),
            trace: Trace::Wavefront { cells: space.cells, labels: wave.labels(map) },
            size: Size::Grid { cells: wave.reached(), sweeps: wave.levels },
            note: None,
        }
    }
}
