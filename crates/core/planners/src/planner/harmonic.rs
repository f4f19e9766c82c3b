//! The harmonic field planner.

use super::attach::JoinedQuery;
use super::{PathKind, Planner, Proposal, Query, Run, Size, Trace, grid_path};
use crate::cspace::Grid;
use cplan_harmonic::{Component, Field, Lattice, Place, PotentialGuide, harmonic};
use cplan_interrupt::checkpoint;

/// Solves Laplace's equation on the cells connected with the goal, and follows the solution's gradient upwards, as
/// interpolated between the cells (Connolly, Grupen 1993; [`follow`]). The value is 1 at the goals and 0 on
/// obstacles and beyond limits; on circles it is periodic.
///
/// [`follow`]: cplan_harmonic::follow()
///
/// Complete on the grid: the only local maxima of the field are the goals, even in long corridors (see
/// [`cplan_harmonic::harmonic`]). So if no path is found, no path exists between the cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Harmonic {
    /// The kind of path. [`PathKind::Own`] is the curve along the gradient.
    pub path: PathKind,
}

impl Default for Harmonic {
    fn default() -> Self {
        Self { path: PathKind::Own }
    }
}

impl Planner for Harmonic {
    const NAME: &'static str = "harmonic";
    type Space = Grid;
    type Map = Lattice;

    fn build(&self, space: &Grid) -> Lattice {
        Lattice::from(space)
    }

    fn query(&self, space: &Grid, map: &Lattice, query: &Query) -> Run {
        let gave_up = |reason: String| Run {
            outcome: Proposal::GaveUp(reason),
            trace: Trace::Field { cells: space.cells, potential: vec![f64::NEG_INFINITY; space.blocked.len()] },
            size: Size::Windows { cells: 0, windows: 0 },
            note: None,
        };
        let joined = match JoinedQuery::new(space, query) {
            Ok(joined) => joined,
            Err(reason) => return gave_up(reason),
        };
        checkpoint();
        let wave = map.wave(&joined.sources());
        checkpoint();
        let component = Component::new(map, wave);
        let size = |windows: usize| Size::Windows { cells: component.len(), windows };
        // The cell of the start that is nearest to it among those that the wave reached.
        let Some(start) = joined.start.cells.iter().find_map(|&cell| component.position_of(cell)) else {
            let size = size(0);
            return Run {
                outcome: Proposal::NoPath,
                trace: Trace::Harmonic { component, potential: None },
                size,
                note: None,
            };
        };
        let Field { potential, windows } = harmonic(&component);
        let at = |place: Place| component.position_of(grid_path::cell(space, place)?);
        let mut guide = PotentialGuide::new(&component, &potential, at);
        let outcome =
            match grid_path::path_along_field(space, query, &joined, &mut guide, component.cell(start), self.path) {
                Ok(path) => Proposal::Found(path),
                Err(_) => Proposal::GaveUp("the field has a local maximum".into()),
            };
        let size = size(windows);
        Run { outcome, trace: Trace::Harmonic { component, potential: Some(potential) }, size, note: None }
    }
}
