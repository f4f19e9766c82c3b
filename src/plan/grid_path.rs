//! From cells to a path.

use super::attach::{Attachment, Joined};
use super::{Query, shortcut};
use crate::cspace::Grid;
use crate::field::{Component, Interpolated, Place, Potential};
use crate::space::{Configuration, Measure, Metric, Path};

/// Number `at` of the unbounded lattice along an axis as a row or column of the grid; nothing beyond a limit.
pub(super) fn place(grid: &Grid, axis: usize, at: i64) -> Option<usize> {
    let n = grid.cells[axis] as i64;
    let at = if grid.topology.axes[axis].is_circle() { at.rem_euclid(n) } else { at };
    (0..n).contains(&at).then_some(at as usize)
}

/// A polyline in lattice units: unwrapped, cell `(i, j)` covers `[i, i + 1] x [j, j + 1]`.
pub(super) type Line = Vec<[f64; 2]>;

/// Lattice units of an unwrapped configuration.
pub(super) fn to_lattice(grid: &Grid, q: Configuration) -> [f64; 2] {
    let step = grid.step();
    [0, 1].map(|k| (q[k] - grid.topology.axes[k].domain().0) / step[k])
}

/// The unwrapped configuration at a point in lattice units.
fn from_lattice(grid: &Grid, at: [f64; 2]) -> Configuration {
    let step = grid.step();
    let [a, b] = [0, 1].map(|k| grid.topology.axes[k].domain().0 + at[k] * step[k]);
    Configuration::new(a, b)
}

/// The centres of neighbouring `cells`, unwrapped: the first is the copy nearest to `near`, and each next one lies one
/// cell away, across a seam too.
pub(super) fn unwrap(grid: &Grid, cells: &[usize], near: Configuration) -> Line {
    let columns = grid.cells[1];
    let near = to_lattice(grid, near);
    let split = |cell: usize| [cell / columns, cell % columns];
    let mut line = Line::with_capacity(cells.len() + 2);
    let Some(&first) = cells.first() else { return line };
    let mut last = split(first);
    let mut at = [0, 1].map(|k| {
        let (center, n) = (last[k] as f64 + 0.5, grid.cells[k] as f64);
        if grid.topology.axes[k].is_circle() { center + n * ((near[k] - center) / n).round() } else { center }
    });
    line.push(at);
    for &cell in &cells[1..] {
        let next = split(cell);
        for k in [0, 1] {
            // One step, or all the way round to the other side of a seam: which is one step too.
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

/// The goal that a path ending at `cell` goes to: of those joined there, and in the cell if they are along a segment, the
/// nearest to `near` (the unwrapped centre of the cell), as its nearest copy.
fn goal_at<'a>(
    grid: &Grid,
    query: &Query,
    joined: &'a Joined,
    cell: usize,
    near: Configuration,
) -> Option<(Configuration, &'a Attachment)> {
    let (center, step) = (grid.center(cell), grid.step());
    let [lower, upper] = [-0.5, 0.5].map(|half| [0, 1].map(|k| center[k] + half * step[k]));
    let here = query.goals.pieces().iter().zip(&joined.goals).filter_map(|(piece, attachment)| {
        let attachment = attachment.as_ref().filter(|attachment| attachment.cells.contains(&cell))?;
        let within = if piece.is_point() { None } else { piece.within(lower, upper) };
        let goal = within.unwrap_or(*piece).nearest(Measure::from(Metric::Euclidean), center);
        Some((grid.topology.lift(goal, near), attachment))
    });
    here.min_by(|a, b| (a.0 - near).norm().total_cmp(&(b.0 - near).norm()))
}

/// The path from the exact start through the centres of `cells` (neighbours, the first joined to the start, the last to
/// a goal) to the exact goal; shortened if wanted. The pieces between a configuration and a cell that does not contain
/// it are not proven by the grid. Nothing if the cells are not such a chain.
pub(super) fn path(grid: &Grid, query: &Query, joined: &Joined, cells: &[usize], shorten: bool) -> Option<Path> {
    let line = unwrap(grid, cells, query.start);
    let goal = goal_at(grid, query, joined, *cells.last()?, from_lattice(grid, *line.last()?))?;
    Some(complete(grid, query, joined, line, goal, shorten))
}

/// The path from the exact start up the potential, interpolated between cells ([`Interpolated::ascend`]), to the exact
/// goal; shortened if wanted. It stays in free cells, but for the pieces between a configuration and a cell that does not
/// contain it. `start` is the position of a cell joined to the start. Nothing if the potential does not lead to a goal.
pub(super) fn ascent(
    grid: &Grid,
    query: &Query,
    joined: &Joined,
    (component, potential): (&Component, &Potential),
    start: usize,
    shorten: bool,
) -> Option<Path> {
    let home = component.cells[start] as usize;
    if start < component.goals {
        return path(grid, query, joined, &[home], shorten);
    }
    let columns = grid.cells[1];
    let position = |[i, j]: Place| component.position_of(place(grid, 0, i)? * columns + place(grid, 1, j)?);
    let center = unwrap(grid, &[home], query.start);
    let from = if joined.start.contained { to_lattice(grid, query.start) } else { center[0] };
    // Cells are counted from their corners here, from their centres there.
    let streamline = Interpolated::new(component, potential, position).ascend(from.map(|x| x - 0.5))?;
    let mut line: Line = streamline.points.into_iter().map(|point| point.map(|x| x + 0.5)).collect();
    let end = streamline.place.map(|x| x as f64 + 0.5);
    let cell = component.cells[streamline.goal] as usize;
    let goal = goal_at(grid, query, joined, cell, from_lattice(grid, end))?;
    if !goal.1.contained {
        line.push(end);
    }
    Some(complete(grid, query, joined, line, goal, shorten))
}

/// A line completed to a path from the exact start to the exact goal, shortened if wanted.
fn complete(
    grid: &Grid,
    query: &Query,
    joined: &Joined,
    mut line: Line,
    (goal, attachment): (Configuration, &Attachment),
    shorten: bool,
) -> Path {
    if line.len() == 1 && joined.start.contained && attachment.contained {
        return Path::new(vec![query.start, goal]);
    }
    // A configuration that is at an end of the line, up to rounding, takes its place.
    let (from, to) = (to_lattice(grid, query.start), to_lattice(grid, goal));
    let apart = |a: &[f64; 2], b: [f64; 2]| (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) > shortcut::TOUCH;
    let ends = line.len() - 1;
    let mut at = 0..;
    line.retain(|point| {
        let k = at.next();
        (k != Some(0) || apart(point, from)) && (k != Some(ends) || apart(point, to))
    });
    line.insert(0, from);
    line.push(to);
    if shorten {
        line = shortcut::shortcut(grid, &line);
    }
    let inner = line[1..line.len() - 1].iter().map(|&at| from_lattice(grid, at));
    Path::new(std::iter::once(query.start).chain(inner).chain([goal]).collect())
}
