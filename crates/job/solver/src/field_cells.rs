//! The cells of a field, before its equation is solved.

use super::admission::Ends;
use super::rungs::zoned_cells;
use super::{CellCounts, GridSpace};
use cplan_fields::{Cell, Domain, Limits, field_domain};
use cplan_model::MotionProblem;
use cplan_planners::cspace::ZonedGrid;

/// Returns the cells of a problem's first level, each marked as free, obstacle or goal, with the world's preferences. The planner
/// `harmonic` relaxes an equation on such cells. `cells` is the value of the planner's `--cells`.
///
/// # Errors
/// The reason, in words: no free cell near the start or the goal, or no free cell from which the goal can be reached.
pub fn field_on_cells(
    problem: &MotionProblem,
    cells: CellCounts,
    limits: Limits,
) -> Result<(ZonedGrid, Domain), String> {
    let space = zoned_cells(problem, GridSpace::Rows, Some(cells), 0);
    let CellCounts([rows, columns]) = cells;
    let space = space.ok_or_else(|| format!("a grid of {rows} x {columns} cells is not possible"))?;
    let domain = field_domain(&space.grid, &Ends::new(problem, &space).query, limits)?;
    if !domain.kinds().contains(&Cell::Free) {
        return Err(format!("on the grid of {rows} x {columns} cells, no free cell is connected with the goal"));
    }
    Ok((space, domain))
}
