//! The harmonic field planner.

use super::{Component, Field, Lattice, Potential, PotentialGuide, estimated_harmonic, harmonic, path_along_field};
use cplan_interrupt::checkpoint;
use cplan_planners::cspace::Grid;
use cplan_planners::planner::attach::JoinedQuery;
use cplan_planners::planner::grid_path::{Place, cell};
use cplan_planners::planner::{FieldQuantity, FieldValues, PathKind, Planner, Proposal, Query, Run, Size, Trace};

/// Solves Laplace's equation on the cells connected with the goal, and follows the solution's gradient upwards, as interpolated
/// between the cells (Connolly, Grupen 1993; [`follow`]). The value is 1 at the goals and 0 on obstacles and beyond limits; on
/// circles it is periodic.
///
/// [`follow`]: crate::follow::follow()
///
/// Complete on the grid: the only local maxima of the field are the goals, even in long corridors (see [`harmonic()`]). So if it
/// finds no path, there is none between free cells.
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
        let ended = |outcome, (quantity, values), cells, windows| {
            Run::new(outcome, Trace::field(space.cells, quantity, values), Size::Windows { cells, windows })
        };
        let joined = match JoinedQuery::new(space, query) {
            Ok(joined) => joined,
            Err(reason) => {
                let nothing = vec![f64::NEG_INFINITY; space.blocked.len()];
                return ended(Proposal::GaveUp(reason), (FieldQuantity::Logarithm, FieldValues::from(nothing)), 0, 0);
            }
        };
        checkpoint();
        let wave = map.wave(&joined.sources());
        checkpoint();
        let component = Component::new(map, wave);
        let cells = component.len();
        // Of the cells that the wave reached, the one nearest to the start.
        let Some(start) = joined.start.cells.iter().find_map(|&cell| component.position_of(cell)) else {
            let values = FieldValues::computed_by(move || logarithms(&component, &estimated_harmonic(&component)));
            return ended(Proposal::NoPath, (FieldQuantity::EstimatedLogarithm, values), cells, 0);
        };
        let Field { potential, windows } = harmonic(&component);
        let at = |place: Place| component.position_of(cell(space, place)?);
        let mut guide = PotentialGuide::new(&component, &potential, at);
        let path = path_along_field(space, query, &joined, &mut guide, component.cell(start), self.path);
        let failed = |_| Proposal::GaveUp("the field has a local maximum".into());
        let outcome = path.map_or_else(failed, Proposal::Found);
        let values = FieldValues::computed_by(move || logarithms(&component, &potential));
        ended(outcome, (FieldQuantity::Logarithm, values), cells, windows)
    }
}

/// Returns the natural logarithm of the potential for each cell of the grid.
fn logarithms(component: &Component, potential: &Potential) -> Vec<f64> {
    let mut logarithms = vec![f64::NEG_INFINITY; component.shape[0] * component.shape[1]];
    (0..component.len()).for_each(|at| logarithms[component.cell(at)] = potential.ln(at));
    logarithms
}
