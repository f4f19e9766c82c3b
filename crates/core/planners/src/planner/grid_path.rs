//! Converts cells of a grid to a path.

use super::attach::{Attachment, JoinedQuery};
use super::{PathKind, Query, shortcut};
use crate::cspace::Grid;
use cplan_model::space::{Configuration, Measure, Metric, Path};

/// Row and column of a cell on the unbounded lattice. On a circle, numbers continue past the seam.
pub type Place = [i64; 2];

/// Returns the row or column with number `at`, which may continue past a seam. `None` beyond a limit.
pub fn place(grid: &Grid, axis: usize, at: i64) -> Option<usize> {
    let n = grid.cells[axis] as i64;
    let at = if grid.topology.ranges[axis].is_circle() { at.rem_euclid(n) } else { at };
    (0..n).contains(&at).then_some(at as usize)
}

/// Returns the cell at a place, which may lie past seams. `None` beyond a limit.
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

/// Returns the centres of neighbouring `cells`, unwrapped. The first is the copy nearest to `near`. Each further centre
/// is one cell away from the previous one, also across a seam.
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
            // Neighbouring numbers differ by one, or across a seam by the number of cells minus one.
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

/// Returns the goal of a path that ends at `cell`, and the goal's cells. Of the goals joined to this cell, it is the one nearest
/// to `end`, the unwrapped centre of the cell, in its nearest copy. Of goals along a segment, only the part in the cell counts.
pub fn goal_at<'a>(
    grid: &Grid,
    joined: &'a JoinedQuery,
    cell: usize,
    end: [f64; 2],
) -> Option<(Configuration, &'a Attachment)> {
    let near = from_lattice(grid, end);
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
/// Consecutive cells must be neighbours. The result is `None` unless the first cell is joined to the start, and the
/// last one to a goal. A configuration may be joined to a cell that does not contain it. The grid proves nothing about
/// the segment between them.
pub fn path(grid: &Grid, query: &Query, joined: &JoinedQuery, cells: &[usize], kind: PathKind) -> Option<Path> {
    let line = unwrap(grid, cells, query.start);
    let goal = goal_at(grid, joined, *cells.last()?, *line.last()?)?;
    Some(exact_path(grid, query, joined, line, goal, |line| match kind {
        PathKind::Taut => shortcut::shortcut(grid, &line),
        _ => line,
    }))
}

/// Returns the path from the exact start along a line to the exact goal. `shape` receives the line with these ends, and
/// must keep them.
pub fn exact_path(
    grid: &Grid,
    query: &Query,
    joined: &JoinedQuery,
    line: Line,
    goal: (Configuration, &Attachment),
    shape: impl FnOnce(Line) -> Line,
) -> Path {
    let line = shape(with_exact_ends(grid, query, joined, line, goal));
    let inner = line[1..line.len() - 1].iter().map(|&at| from_lattice(grid, at));
    Path::new(std::iter::once(query.start).chain(inner).chain([goal.0]).collect())
}

fn with_exact_ends(
    grid: &Grid,
    query: &Query,
    joined: &JoinedQuery,
    mut line: Line,
    (goal, attachment): (Configuration, &Attachment),
) -> Line {
    // A configuration that equals an end of the line, up to rounding, replaces that end.
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
