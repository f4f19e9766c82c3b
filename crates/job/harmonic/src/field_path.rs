//! The path along a field.
//!
//! The path stays within 0.05 cells of the curve along the field (`simplify`). It ends at the goal itself, not at the centre of
//! the goal's cell, and is certified without further changes. If the certificate fails, the solver plans again on a finer grid.

use crate::follow::{Guide, follow};
use crate::simplify::simplified;
use cplan_model::space::Path;
use cplan_planners::cspace::Grid;
use cplan_planners::planner::attach::JoinedQuery;
use cplan_planners::planner::grid_path::{Line, Place, cell, exact_path, goal_at, to_lattice, unwrap};
use cplan_planners::planner::shortcut::{is_clear, shortcut};
use cplan_planners::planner::{PathKind, Query};

/// Greatest distance of a path from the curve along the field, in cells. If the curve's radius is `r` cells, straight pieces are
/// about `sqrt(r / 2.5)` cells long, and their direction deviates from the curve's by at most `1 / sqrt(10 r)`.
const MAX_CURVE_DISTANCE: f64 = 0.05;

/// Length, in cells, of the stretch before the goal on which the path leaves the curve. The curve leads to the centre of the
/// goal's cell. On this stretch, the path gradually changes to one that ends at the goal itself, and arrives in the curve's
/// direction.
const BLENDED_CELLS: f64 = 12.0;

/// Returns the path along a field ([`follow`]) from the exact start to the exact goal. For [`PathKind::Taut`], it is pulled taut.
/// Otherwise it stays within `MAX_CURVE_DISTANCE` of the curve, except in the last `BLENDED_CELLS`. It stays in free cells,
/// except for the segment between an end of the path and the cell to which the end is joined, if it is not in that cell. `home`
/// is the cell joined to the start.
///
/// # Errors
/// If the field does not lead to a goal.
pub fn path_along_field<G: Guide>(
    grid: &Grid,
    query: &Query,
    joined: &JoinedQuery,
    guide: &mut G,
    home: usize,
    kind: PathKind,
) -> Result<Path, G::DeadEnd> {
    let center = unwrap(grid, &[home], query.start)[0];
    let from = if joined.start.contained { within_cell(center, to_lattice(grid, query.start)) } else { center };
    // Coordinates are relative to the corners of cells here, but to their centres in `follow`.
    let streamline = follow(guide, grid.step(), from.map(|x| x - 0.5))?;
    let mut line: Line = streamline.points.into_iter().map(|point| point.map(|x| x + 0.5)).collect();
    let end = streamline.place.map(|x| x as f64 + 0.5);
    let is_goal = |place: Place| cell(grid, place).filter(|_| guide.is_goal(place));
    let at = is_goal(streamline.place).unwrap_or_else(|| unreachable!("a streamline ends in a goal's cell"));
    let goal = goal_at(grid, joined, at, end).unwrap_or_else(|| unreachable!("each goal's cell is joined to a goal"));
    let is_far = line.len() > 1;
    if (is_far || !goal.1.contained) && line[line.len() - 1] != end {
        line.push(end);
    }
    if is_far && goal.1.contained {
        line = with_end_at_goal(grid, line, to_lattice(grid, goal.0));
    }
    Ok(exact_path(grid, query, joined, line, goal, |line| match kind {
        PathKind::Own | PathKind::Middles => simplified(grid, &line, MAX_CURVE_DISTANCE),
        PathKind::Taut => shortcut(grid, &line),
    }))
}

/// Returns the point nearest to `at` in the closed cell about `center`, but not on a side: sides also belong to neighbouring
/// cells, which may be blocked or beyond a limit.
fn within_cell(center: [f64; 2], at: [f64; 2]) -> [f64; 2] {
    const HALF_CELL: f64 = 0.5 - 1e-9;
    [0, 1].map(|k| at[k].clamp(center[k] - HALF_CELL, center[k] + HALF_CELL))
}

/// Returns the line with its end moved to `goal`. The points before the end move by an amount that falls with their distance from
/// it. If the moved line would leave the free cells, returns the line unchanged.
fn with_end_at_goal(grid: &Grid, line: Line, goal: [f64; 2]) -> Line {
    let end = line[line.len() - 1];
    let by = [0, 1].map(|k| goal[k] - end[k]);
    let mut left = vec![0.0; line.len()];
    for k in (1..line.len()).rev() {
        left[k - 1] = left[k] + (line[k][0] - line[k - 1][0]).hypot(line[k][1] - line[k - 1][1]);
    }
    let range = left[0].min(BLENDED_CELLS);
    let share = |left: f64| {
        let x = (1.0 - left / range).max(0.0);
        x * x * (3.0 - 2.0 * x)
    };
    let moved = line.iter().zip(&left).map(|(point, &left)| [0, 1].map(|k| point[k] + share(left) * by[k]));
    let moved: Line = moved.collect();
    let is_clear = |pieces: &[[f64; 2]]| pieces.windows(2).all(|w| is_clear(grid, w[0], w[1]));
    let first = left.partition_point(|&left| left >= range).saturating_sub(1);
    if range > 0.0 && is_clear(&moved[first..]) { moved } else { line }
}
