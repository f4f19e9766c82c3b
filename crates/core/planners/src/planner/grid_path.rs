//! Converts cells of a grid to a path.
//!
//! The path of a field follows the curve along the field, to within 0.05 cells (`simplify`). It ends at the goal
//! itself rather than at the centre of the goal's cell, and is certified without further changes. If the certificate
//! fails, the solver plans again on a finer grid.

use super::attach::{Attachment, JoinedQuery};
use super::follow::{Guide, Place, follow};
use super::simplify::simplified;
use super::{PathKind, Query, shortcut};
use crate::cspace::Grid;
use cplan_model::space::{Configuration, Measure, Metric, Path};

/// Returns the row or column with number `at` on an axis whose numbers continue across a seam; `None` beyond a
/// limit.
pub fn place(grid: &Grid, axis: usize, at: i64) -> Option<usize> {
    let n = grid.cells[axis] as i64;
    let at = if grid.topology.ranges[axis].is_circle() { at.rem_euclid(n) } else { at };
    (0..n).contains(&at).then_some(at as usize)
}

/// Returns the cell at a place given by row and column numbers that continue across seams; `None` beyond a limit.
pub fn cell(grid: &Grid, [i, j]: Place) -> Option<usize> {
    Some(place(grid, 0, i)? * grid.cells[1] + place(grid, 1, j)?)
}

/// A polyline in lattice units, unwrapped. Cell `(i, j)` covers `[i, i + 1] x [j, j + 1]`.
pub type Line = Vec<[f64; 2]>;

/// Converts an unwrapped configuration to lattice units.
pub fn to_lattice(grid: &Grid, q: Configuration) -> [f64; 2] {
    let step = grid.step();
    [0, 1].map(|k| (q[k] - grid.topology.ranges[k].domain().0) / step[k])
}

/// Returns the unwrapped configuration at a point in lattice units.
fn from_lattice(grid: &Grid, at: [f64; 2]) -> Configuration {
    let step = grid.step();
    let [a, b] = [0, 1].map(|k| grid.topology.ranges[k].domain().0 + at[k] * step[k]);
    Configuration::new(a, b)
}

/// Returns the centres of neighbouring `cells`, unwrapped. The first is the copy nearest to `near`. Each following
/// one is one cell away from the one before, also across a seam.
pub fn unwrap(grid: &Grid, cells: &[usize], near: Configuration) -> Line {
    let columns = grid.cells[1];
    let near = to_lattice(grid, near);
    let split = |cell: usize| [cell / columns, cell % columns];
    let mut line = Line::with_capacity(cells.len() + 2);
    let Some(&first) = cells.first() else { return line };
    let mut last = split(first);
    let mut at = [0, 1].map(|k| {
        let (center, n) = (last[k] as f64 + 0.5, grid.cells[k] as f64);
        if grid.topology.ranges[k].is_circle() { center + n * ((near[k] - center) / n).round() } else { center }
    });
    line.push(at);
    for &cell in &cells[1..] {
        let next = split(cell);
        for k in [0, 1] {
            // The difference is at most one cell, or, across a seam, the number of cells less one.
            at[k] += match next[k] as i64 - last[k] as i64 {
                step @ -1..=1 => step as f64,
                step => -step.signum() as f64,
            };
        }
        last = next;
        line.push(at);
    }
    line
}

/// Returns the goal for a path that ends at `cell`, and the goal's cells. It chooses among the goals joined to this
/// cell: the one nearest to `near`, the unwrapped centre of the cell. It returns the copy of that goal nearest to
/// `near`. Of goals along a segment, only the part in the cell is considered.
fn goal_at<'a>(
    grid: &Grid,
    joined: &'a JoinedQuery,
    cell: usize,
    near: Configuration,
) -> Option<(Configuration, &'a Attachment)> {
    let (center, step) = (grid.center(cell), grid.step());
    let [lower, upper] = [-0.5, 0.5].map(|half| [0, 1].map(|k| center[k] + half * step[k]));
    let here =
        joined.goals.iter().filter(|(_, attachment)| attachment.cells.contains(&cell)).map(|(piece, attachment)| {
            let within = if piece.is_point() { None } else { piece.within(lower, upper) };
            let goal = within.unwrap_or(*piece).nearest(Measure::from(Metric::Euclidean), center);
            (grid.topology.lift(goal, near), attachment)
        });
    here.min_by(|a, b| (a.0 - near).norm().total_cmp(&(b.0 - near).norm()))
}

/// Returns the path from the exact start through the centres of `cells` to the exact goal, pulled taut for
/// [`PathKind::Taut`].
///
/// Consecutive cells must be neighbours. The first must be joined to the start and the last to a goal; otherwise the
/// result is `None`. A configuration may be joined to a cell that does not contain it. The grid proves nothing about
/// the segment between the two.
pub fn path(grid: &Grid, query: &Query, joined: &JoinedQuery, cells: &[usize], kind: PathKind) -> Option<Path> {
    let line = unwrap(grid, cells, query.start);
    let goal = goal_at(grid, joined, *cells.last()?, from_lattice(grid, *line.last()?))?;
    let line = with_exact_ends(grid, query, joined, line, goal);
    let line = if kind == PathKind::Taut { shortcut::shortcut(grid, &line) } else { line };
    Some(path_between(grid, query.start, &line, goal.0))
}

/// Greatest distance of a path from the curve along the field, in cells. Where the curve's radius is `r` cells,
/// straight pieces are then about `sqrt(r / 2.5)` cells long. Their direction deviates from the curve's by at most
/// `1 / sqrt(10 r)`.
const MAX_CURVE_DISTANCE: f64 = 0.05;

/// Length before the goal, in cells, over which the path leaves the curve. The curve leads to the centre of the
/// goal's cell. The path changes gradually from the curve to one that ends at the goal itself, and arrives in the
/// curve's direction.
const BLENDED_CELLS: f64 = 12.0;

/// Returns the path from the exact start to the exact goal, between which it goes along a field ([`follow`]). For
/// [`PathKind::Taut`] the path is pulled taut. Otherwise it stays within `MAX_CURVE_DISTANCE` of the curve, except in
/// the last `BLENDED_CELLS`. The path stays in free cells, except at an end that is not in the cell to which it is
/// joined: the segment between the two may leave the free cells. `home` is the cell joined to the start.
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
    // Coordinates here are relative to the corners of cells, in `follow` to their centres.
    let streamline = follow(guide, grid.step(), from.map(|x| x - 0.5))?;
    let mut line: Line = streamline.points.into_iter().map(|point| point.map(|x| x + 0.5)).collect();
    let end = streamline.place.map(|x| x as f64 + 0.5);
    let is_goal = |place: Place| cell(grid, place).filter(|_| guide.is_goal(place));
    let at = is_goal(streamline.place).unwrap_or_else(|| unreachable!("a streamline ends in a goal's cell"));
    let goal = goal_at(grid, joined, at, from_lattice(grid, end))
        .unwrap_or_else(|| unreachable!("each goal's cell is joined to a goal"));
    let is_far = line.len() > 1;
    if (is_far || !goal.1.contained) && line[line.len() - 1] != end {
        line.push(end);
    }
    if is_far && goal.1.contained {
        line = with_end_at_goal(grid, line, to_lattice(grid, goal.0));
    }
    let line = with_exact_ends(grid, query, joined, line, goal);
    let line = match kind {
        PathKind::Own | PathKind::Middles => simplified(grid, &line, MAX_CURVE_DISTANCE),
        PathKind::Taut => shortcut::shortcut(grid, &line),
    };
    Ok(path_between(grid, query.start, &line, goal.0))
}

/// Returns the point of the closed cell about `center` nearest to `at`, kept off the sides of the cell. The sides
/// belong also to neighbouring cells, which may be blocked or beyond a limit.
fn within_cell(center: [f64; 2], at: [f64; 2]) -> [f64; 2] {
    const HALF_CELL: f64 = 0.5 - 1e-9;
    [0, 1].map(|k| at[k].clamp(center[k] - HALF_CELL, center[k] + HALF_CELL))
}

/// Returns the line with its end moved to `goal`. The points before the end move as well, less and less with their
/// distance from it. If the moved line would leave the free cells, returns the line unchanged.
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
    let is_clear = |pieces: &[[f64; 2]]| pieces.windows(2).all(|w| shortcut::is_clear(grid, w[0], w[1]));
    let first = left.partition_point(|&left| left >= range).saturating_sub(1);
    if range > 0.0 && is_clear(&moved[first..]) { moved } else { line }
}

/// Returns the line with the exact start and the exact goal as its ends.
fn with_exact_ends(
    grid: &Grid,
    query: &Query,
    joined: &JoinedQuery,
    mut line: Line,
    (goal, attachment): (Configuration, &Attachment),
) -> Line {
    // If an end of the line equals the configuration up to rounding, the configuration replaces it.
    let (from, to) = (to_lattice(grid, query.start), to_lattice(grid, goal));
    if line.len() == 1 && joined.start.contained && attachment.contained {
        return vec![from, to];
    }
    let apart = |a: &[f64; 2], b: [f64; 2]| (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) > shortcut::TOUCH_DISTANCE;
    let ends = line.len() - 1;
    let mut at = 0..;
    line.retain(|point| {
        let k = at.next();
        (k != Some(0) || apart(point, from)) && (k != Some(ends) || apart(point, to))
    });
    line.insert(0, from);
    line.push(to);
    line
}

/// Converts a line to a path between two configurations, which replace the line's ends.
fn path_between(grid: &Grid, start: Configuration, line: &[[f64; 2]], goal: Configuration) -> Path {
    let inner = line[1..line.len() - 1].iter().map(|&at| from_lattice(grid, at));
    Path::new(std::iter::once(start).chain(inner).chain([goal]).collect())
}
