//! Grids from rows: no collision test a cell.

use super::rows::Rows;
use super::{Grid, Proves};
use crate::geometry::ROUNDING;
use crate::model::{Scene, on_axis};
use crate::space::Axis;
use std::f64::consts::TAU;
use std::ops::Range;

/// Arcs are widened by this before whole cells are judged, radians or metres: rounding in the division into cells is
/// some 1e-13 of a cell.
const WIDENING: f64 = 1e-9;

/// The grid whose cells are blocked where their *centre* comes within `clearance` of an obstacle. What a sampled grid
/// shows, up to centres within [`ROUNDING`] of contact, in `O(rows * contacts + cells)`.
#[must_use]
pub fn grid_from_rows(scene: &Scene, cells: [usize; 2], clearance: f64) -> Grid {
    let rows = Rows::new(scene);
    let mut grid = Grid { topology: scene.arm.topology(), proves: Proves::Sampled, cells, blocked: free(cells) };
    let columns = Cells::new(grid.topology.axes[1], cells[1]);
    let bands = rows.bands(clearance);
    let mut intervals = Vec::new();
    for i in 0..cells[0] {
        let q1 = grid.center(i * cells[1])[0];
        let row = &mut grid.blocked[i * cells[1]..(i + 1) * cells[1]];
        if bands.forbids(q1) {
            row.fill(true);
            continue;
        }
        let (elbow, heading) = rows.elbow(q1);
        for index in rows.second_link_pairs() {
            intervals.clear();
            let hits = rows.at_elbow(index, elbow, heading, clearance, &mut intervals);
            on_axis(&scene.arm.joints[1], hits, &intervals, |[start, end]| {
                row[columns.centers(start, end)].fill(true);
            });
        }
    }
    grid
}

/// A grid whose free cells are *wholly* free: each of their configurations keeps at least `clearance` (and more than 0)
/// from every obstacle.
///
/// A row stands for its slab `q1 +- h1 / 2`: every obstacle is grown by the farthest that a point of link 2 which
/// touches it can move while joint 1 does so (a chord about the base), and a cell is blocked when its closed range of
/// `q2` meets a forbidden interval. Each configuration of a blocked cell comes within `clearance + margin` of an
/// obstacle, `margin` being that of the grid's [`Proves::Outer`].
///
/// Obstacle by obstacle, only in the rows where link 2 reaches it at all: `O(reached rows * contacts + cells)`.
#[must_use]
pub fn outer_grid(scene: &Scene, cells: [usize; 2], clearance: f64) -> Grid {
    let rows = Rows::new(scene);
    let mut grid = Grid { topology: scene.arm.topology(), proves: Proves::Sampled, cells, blocked: free(cells) };
    let [h1, h2] = grid.step();
    let kept = clearance + 2.0 * ROUNDING;
    let motions: Vec<f64> = rows.second_link_pairs().map(|index| rows.motion(index, h1 / 2.0, kept)).collect();
    grid.proves = Proves::Outer { margin: margin(&rows, &motions, [h1, h2], clearance) };

    let bands = rows.bands(kept).merged;
    let [first, second] = grid.topology.axes;
    let turns: &[f64] = if first.is_circle() { &[-TAU, 0.0, TAU] } else { &[0.0] };
    let half = h1 / 2.0 + WIDENING;
    let values: Vec<f64> = (0..cells[0]).map(|i| grid.center(i * cells[1])[0]).collect();
    let elbows: Vec<_> = values
        .iter()
        .map(|&q1| {
            let banned =
                |band: &[f64; 2]| turns.iter().any(|turn| band[0] <= q1 + turn + half && band[1] >= q1 + turn - half);
            (!bands.iter().any(banned)).then(|| rows.elbow(q1))
        })
        .collect();
    let columns = Cells::new(second, cells[1]);
    let lines = Cells::new(first, cells[0]);
    for (row, elbow) in grid.blocked.chunks_exact_mut(cells[1]).zip(&elbows) {
        row.fill(elbow.is_none());
    }
    let (mut reached, mut intervals) = (Vec::new(), Vec::new());
    for (index, motion) in rows.second_link_pairs().zip(&motions) {
        // Only the rows where link 2 reaches the piece at all, and one more at either end for the rounding of that.
        reached.clear();
        let hits = rows.reach_range(index, kept + motion, &mut reached);
        on_axis(&scene.arm.joints[0], hits, &reached, |[start, end]| {
            let range = lines.touched(start - half, end + half);
            for (i, elbow) in elbows.iter().enumerate().take(range.end).skip(range.start) {
                let Some((elbow, heading)) = *elbow else { continue };
                let row = &mut grid.blocked[i * cells[1]..(i + 1) * cells[1]];
                intervals.clear();
                let hits = rows.at_elbow(index, elbow, heading, kept + motion, &mut intervals);
                intervals.iter_mut().for_each(|[start, end]| (*start, *end) = (*start - WIDENING, *end + WIDENING));
                on_axis(&scene.arm.joints[1], hits, &intervals, |[start, end]| {
                    row[columns.touched(start, end)].fill(true);
                });
            }
        });
    }
    grid
}

fn free(cells: [usize; 2]) -> Vec<bool> {
    vec![false; cells[0] * cells[1]]
}

/// What the two joints' motion over a cell adds to `clearance` at most.
fn margin(rows: &Rows<'_>, motions: &[f64], [h1, h2]: [f64; 2], clearance: f64) -> f64 {
    let first = (0..rows.second_link_pairs().start).map(|index| rows.motion(index, h1, clearance));
    let second = rows.second_link_pairs().zip(motions).map(|(index, motion)| 2.0 * motion + rows.lever(index) * h2);
    first.chain(second).fold(0.0, f64::max) + 4.0 * ROUNDING + WIDENING
}

/// The cells along an axis by value of its joint.
struct Cells {
    lower: f64,
    per_cell: f64,
    count: usize,
}

impl Cells {
    fn new(axis: Axis, count: usize) -> Self {
        Self { lower: axis.domain().0, per_cell: count as f64 / axis.extent(), count }
    }

    /// The cells whose centre lies in the closed interval.
    fn centers(&self, start: f64, end: f64) -> Range<usize> {
        let first = ((start - self.lower) * self.per_cell - 0.5).ceil();
        let last = ((end - self.lower) * self.per_cell - 0.5).floor();
        self.range(first, last)
    }

    /// The closed cells that meet the closed interval.
    fn touched(&self, start: f64, end: f64) -> Range<usize> {
        let first = ((start - self.lower) * self.per_cell).ceil() - 1.0;
        let last = ((end - self.lower) * self.per_cell).floor();
        self.range(first, last)
    }

    fn range(&self, first: f64, last: f64) -> Range<usize> {
        // Conversions saturate: what lies before the row becomes 0, and `last + 1` beyond it the count.
        let to = ((last + 1.0).max(0.0) as usize).min(self.count);
        (first.max(0.0) as usize).min(to)..to
    }
}
