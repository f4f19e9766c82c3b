//! Shortens a path of cells by cutting its corners.

use super::grid_path::{Line, place};
use crate::cspace::Grid;
use cplan_interrupt::checkpoint;

/// Distance, in cells, within which a segment counts as passing through a cell. So a segment through a common corner of
/// cells also passes the two cells beside it. The value is far greater than the rounding of lattice coordinates (1e-11
/// for a hundred thousand cells), and far smaller than any detail of a path.
pub(super) const TOUCH_DISTANCE: f64 = 1e-9;

/// Greatest number of rounds in which a path is shortened.
const MAX_ROUNDS: usize = 8;
/// Least gain of a round, as a fraction of the path's length. If a round gains less, it is the last.
const MIN_GAIN: f64 = 1e-3;

/// Returns a shorter polyline with the same ends and few corners. Each segment either passes through free cells only,
/// counting cells that it touches, or is a segment of the given line. The result is never longer, in any norm. A line
/// of `n` cells takes about `n log n` checks of cells.
pub fn shortcut(grid: &Grid, line: &[[f64; 2]]) -> Line {
    let mut best = farthest(grid, line);
    for _ in 0..MAX_ROUNDS {
        // Go backwards, also through points between the corners, which pulls the corners towards the obstacles.
        let mut fine = refine(grid, &best);
        fine.reverse();
        let mut next = farthest(grid, &fine);
        next.reverse();
        let (before, after) = (length(grid, &best), length(grid, &next));
        if after < before {
            best = next;
        }
        if after > before * (1.0 - MIN_GAIN) {
            break;
        }
    }
    best
}

/// Returns the Euclidean length in joint space.
fn length(grid: &Grid, line: &[[f64; 2]]) -> f64 {
    let step = grid.step();
    line.windows(2).map(|w| ((w[1][0] - w[0][0]) * step[0]).hypot((w[1][1] - w[0][1]) * step[1])).sum()
}

/// Returns a line whose corners are some of the given ones, joined by segments through free cells only.
fn farthest(grid: &Grid, line: &[[f64; 2]]) -> Line {
    fewer_points(line, |from, to| is_clear(grid, line[from], line[to]))
}

/// Returns a line through some of the given points, including its ends. From each point, it continues to a distant
/// point to which a segment `fits`. The search doubles the distance along the line while the segment fits, and then
/// bisects. The next point always counts as fitting.
pub fn fewer_points(line: &[[f64; 2]], fits: impl Fn(usize, usize) -> bool) -> Line {
    let mut kept = vec![line[0]];
    let mut at = 0;
    while at + 1 < line.len() {
        checkpoint();
        let (mut good, mut bad) = (at + 1, line.len());
        while good + 1 < bad {
            let ahead = (at + 2 * (good - at)).min(line.len() - 1);
            let probe = if bad == line.len() { ahead } else { usize::midpoint(good, bad) };
            if fits(at, probe) { good = probe } else { bad = probe }
        }
        kept.push(line[good]);
        at = good;
    }
    kept
}

/// Returns the line with additional points on its clear segments. They are at most a cell apart.
fn refine(grid: &Grid, line: &[[f64; 2]]) -> Line {
    let mut points = vec![line[0]];
    for w in line.windows(2) {
        let d = [w[1][0] - w[0][0], w[1][1] - w[0][1]];
        let pieces = d[0].abs().max(d[1].abs()).ceil();
        if pieces > 1.0 && is_clear(grid, w[0], w[1]) {
            let between = (1..pieces as usize).map(|k| k as f64 / pieces);
            points.extend(between.map(|t| [w[0][0] + t * d[0], w[0][1] + t * d[1]]));
        }
        points.push(w[1]);
    }
    points
}

/// Returns true if all cells that the segment passes through or touches are free.
pub fn is_clear(grid: &Grid, a: [f64; 2], b: [f64; 2]) -> bool {
    let d = [b[0] - a[0], b[1] - a[1]];
    let rows = touched_lines(grid, 0, a[0], b[0]);
    rows.into_iter().all(|i| {
        // The ends of the segment's part in row i, with some tolerance.
        let at = |edge: f64| a[1] + ((edge - a[0]) / d[0]).clamp(0.0, 1.0) * d[1];
        let (from, to) = if d[0].abs() <= TOUCH_DISTANCE {
            (a[1], b[1])
        } else {
            (at(i as f64 - TOUCH_DISTANCE), at((i + 1) as f64 + TOUCH_DISTANCE))
        };
        let Some(row) = place(grid, 0, i) else { return false };
        touched_lines(grid, 1, from, to)
            .all(|j| place(grid, 1, j).is_some_and(|column| !grid.blocked[row * grid.cells[1] + column]))
    })
}

/// Returns the rows or columns between two coordinates, including those that are only touched. All are within the
/// limits, because the ends are.
fn touched_lines(grid: &Grid, axis: usize, from: f64, to: f64) -> std::ops::RangeInclusive<i64> {
    let (first, last) =
        ((from.min(to) - TOUCH_DISTANCE).floor() as i64, (from.max(to) + TOUCH_DISTANCE).floor() as i64);
    if grid.topology.ranges[axis].is_circle() {
        first..=last
    } else {
        first.max(0)..=last.min(grid.cells[axis] as i64 - 1)
    }
}
