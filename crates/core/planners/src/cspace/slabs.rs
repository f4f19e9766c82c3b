//! Grids made of slices, without a collision test per cell.

use super::coarse::coarse;
use super::{Grid, Proves, Slice, gantry_cells, translation};
use cplan_geometry::ROUNDING;
use cplan_interrupt::checkpoint;
use cplan_model::{Contacts, Scene, on_axis};
use std::borrow::Cow;
use std::f64::consts::TAU;
use std::ops::Range;

/// Length by which intervals are widened before whole cells are judged, radians or metres. The rounding error of the
/// division into cells is about 1e-13 of a cell.
const ARC_WIDENING: f64 = 1e-9;

/// Largest simplification of shapes with many corners, as a fraction of the margin that covers the joints' motion
/// within a cell.
const MAX_COARSENING: f64 = 1.0 / 16.0;

/// Computes the grid whose cells are blocked if the arm is within `clearance` of an obstacle at the cell's *centre*.
/// The result equals that of [`super::sampled_grid`], except for centres within [`ROUNDING`] of contact.
/// `O(slices * contacts + cells)`.
pub fn grid_from_slices(scene: &Scene, cells: [usize; 2], clearance: f64) -> Grid {
    let slices = Contacts::new(scene);
    let mut grid = Grid { topology: scene.arm().topology(), proves: Proves::Sampled, cells, blocked: free(cells) };
    let columns = Columns::new(&grid, 1);
    let bands = Slice::bands(&slices, clearance);
    let mut intervals = Vec::new();
    for i in 0..cells[0] {
        let q1 = grid.center(i * cells[1])[0];
        let row = &mut grid.blocked[i * cells[1]..(i + 1) * cells[1]];
        if bands.forbids(q1) {
            row.fill(true);
            continue;
        }
        let (elbow, heading) = slices.elbow(q1);
        for index in slices.second_link_pairs() {
            intervals.clear();
            let hits = slices.at_elbow(index, elbow, heading, clearance, &mut intervals);
            on_axis(&scene.arm().joints[1], hits, &intervals, |[start, end]| columns.block_centers(row, start, end));
        }
    }
    grid.block_sums();
    grid
}

/// Computes a grid whose free cells are *entirely* free: each of their configurations keeps at least `clearance`,
/// and more than 0, from every obstacle.
///
/// One slice stands for its slab `q1 +- h1 / 2`. Every obstacle is grown by the greatest motion of a touching point
/// of link 2 while joint 1 crosses half of the slab. A cell is blocked if its closed range of `q2` meets a forbidden
/// interval. Each configuration of a blocked cell is within `clearance + margin` of an obstacle, where `margin` is
/// that of the grid's [`Proves::Outer`].
///
/// Each obstacle is examined only in the rows where link 2 can reach it: `O(reached slices * contacts + cells)`.
///
/// The cells of a gantry are exact: a cell is blocked only if a C-obstacle reaches into it. One that touches its side
/// leaves it free, see `gantry_cells`.
pub fn outer_grid(scene: &Scene, cells: [usize; 2], clearance: f64) -> Grid {
    let mut grid = Grid { topology: scene.arm().topology(), proves: Proves::Sampled, cells, blocked: free(cells) };
    if let Some(map) = translation::joint_map(scene.arm()) {
        gantry_cells::block(&mut grid, scene, &map, clearance);
        return grid;
    }
    let steps = grid.step();
    let kept = clearance + 2.0 * ROUNDING;
    let motions = |slices: &Contacts| -> Vec<f64> {
        slices.second_link_pairs().map(|index| slices.motion(index, steps[0] / 2.0, kept)).collect()
    };
    let fine = Contacts::new(scene);
    let within = MAX_COARSENING * margin(&fine, &motions(&fine), steps, clearance);
    let scene = coarse(scene, within, f64::INFINITY);
    let slices = if let Cow::Owned(scene) = &scene { Contacts::new(scene) } else { fine };
    let within = if matches!(scene, Cow::Owned(_)) { within } else { 0.0 };
    let motions = motions(&slices);
    grid.proves = Proves::Outer { margin: margin(&slices, &motions, steps, clearance) + within };

    let columns = Columns::new(&grid, 1);
    let bands = Slice::bands(&slices, kept);
    let axis = grid.topology.ranges[0];
    let turns: &[f64] = if axis.is_circle() { &[-TAU, 0.0, TAU] } else { &[0.0] };
    let centers: Vec<f64> = (0..cells[0]).map(|i| grid.center(i * cells[1])[0]).collect();
    let half = steps[0] / 2.0 + ARC_WIDENING;
    let banned = |q1: f64, band: &[f64; 2], turn: f64| band[0] <= q1 + turn + half && band[1] >= q1 + turn - half;
    let is_banned = |q1: f64| bands.merged.iter().any(|band| turns.iter().any(|&turn| banned(q1, band, turn)));
    let elbows: Vec<_> = centers.iter().map(|&q1| (!is_banned(q1)).then(|| slices.elbow(q1))).collect();
    for (row, _) in grid.blocked.chunks_mut(cells[1]).zip(&elbows).filter(|(_, elbow)| elbow.is_none()) {
        row.fill(true);
    }
    let (mut reached, mut intervals) = (Vec::new(), Vec::new());
    for (index, motion) in slices.second_link_pairs().zip(&motions) {
        let grow = kept + motion;
        reached.clear();
        checkpoint();
        let hits = slices.reach_range(index, grow, &mut reached);
        on_axis(&scene.arm().joints[0], hits, &reached, |[start, end]| {
            // Add a row at either end, for the rounding of the range.
            let first = centers.partition_point(|&q1| q1 < start).saturating_sub(1);
            let last = (centers.partition_point(|&q1| q1 <= end) + 1).min(cells[0]);
            let rows_within = grid.blocked.chunks_mut(cells[1]).zip(&elbows).take(last).skip(first);
            for (row, elbow) in rows_within {
                let &Some((elbow, heading)) = elbow else { continue };
                intervals.clear();
                let hits = slices.at_elbow(index, elbow, heading, grow, &mut intervals);
                intervals
                    .iter_mut()
                    .for_each(|[start, end]| (*start, *end) = (*start - ARC_WIDENING, *end + ARC_WIDENING));
                on_axis(&scene.arm().joints[1], hits, &intervals, |[start, end]| {
                    columns.block_touched(row, start, end)
                });
            }
        });
    }
    grid.block_sums();
    grid
}

fn free(cells: [usize; 2]) -> Vec<bool> {
    vec![false; cells[0] * cells[1]]
}

/// Returns the greatest distance, metres, that the motion of both joints within a cell adds to `clearance`.
fn margin(slices: &Contacts<'_>, motions: &[f64], [h1, h2]: [f64; 2], clearance: f64) -> f64 {
    let first = (0..slices.second_link_pairs().start).map(|index| slices.motion(index, h1, clearance));
    let second = slices.second_link_pairs().zip(motions).map(|(index, motion)| 2.0 * motion + slices.lever(index) * h2);
    first.chain(second).fold(0.0, f64::max) + 4.0 * ROUNDING + ARC_WIDENING
}

/// The cells along one axis, in ascending order: the rows (axis 0), or the columns of a row (axis 1).
pub(super) struct Columns {
    lower: f64,
    per_cell: f64,
    count: usize,
}

impl Columns {
    pub(super) fn new(grid: &Grid, axis: usize) -> Self {
        let lower = grid.topology.ranges[axis].domain().0;
        Self { lower, per_cell: 1.0 / grid.step()[axis], count: grid.cells[axis] }
    }

    /// Blocks the cells whose centres lie in the closed interval.
    fn block_centers(&self, row: &mut [bool], start: f64, end: f64) {
        let first = ((start - self.lower) * self.per_cell - 0.5).ceil();
        let last = ((end - self.lower) * self.per_cell - 0.5).floor();
        row[self.within(first, last)].fill(true);
    }

    /// Blocks the closed cells that meet the closed interval.
    pub(super) fn block_touched(&self, row: &mut [bool], start: f64, end: f64) {
        row[self.touched(start, end)].fill(true);
    }

    /// Returns the numbers of the closed cells that meet the closed interval.
    pub(super) fn touched(&self, start: f64, end: f64) -> Range<usize> {
        let first = ((start - self.lower) * self.per_cell).ceil() - 1.0;
        let last = ((end - self.lower) * self.per_cell).floor();
        self.within(first, last)
    }

    /// Returns the numbers of cells from `first` to `last`, both included.
    fn within(&self, first: f64, last: f64) -> Range<usize> {
        // Conversions saturate: positions before the first cell become 0. Positions beyond the last one are cut off.
        let (from, to) = (first.max(0.0) as usize, (last + 1.0).max(0.0) as usize);
        let to = to.min(self.count);
        from.min(to)..to
    }
}
