//! Grids from slices, without a collision test per cell.

use super::coarse::coarse;
use super::{Grid, Proves, Slice, gantry_cells, translation};
use cplan_geometry::ROUNDING;
use cplan_interrupt::checkpoint;
use cplan_model::space::Topology;
use cplan_model::{Contacts, Scene, on_axis};
use std::borrow::Cow;
use std::f64::consts::TAU;
use std::ops::Range;

/// Widening of intervals before cells are judged, radians or metres. The rounding error of the division into cells is
/// about 1e-13 of a cell.
const ARC_WIDENING: f64 = 1e-9;

/// Greatest simplification of shapes with many corners, as a fraction of the margin for the joints' motion within a cell.
const MAX_COARSENING: f64 = 1.0 / 16.0;

/// Computes the grid whose cells are blocked if the arm is within `clearance` of an obstacle at the cell's *centre*.
/// The result equals that of [`super::sampled_grid`], except for centres within [`ROUNDING`] of contact.
/// Each pair is examined only in the rows where link 2 can reach its piece: `O(reached slices * contacts + cells)`.
pub fn grid_from_slices(scene: &Scene, cells: [usize; 2], clearance: f64) -> Grid {
    let mut grid = Grid { topology: scene.arm().topology(), proves: Proves::Sampled, cells, blocked: free(cells) };
    block_centers(scene, cells, clearance, |row, columns| grid.blocked[row * cells[1]..][columns].fill(true));
    grid.block_sums();
    grid
}

/// Calls `block` with a row and some of its columns, for all cells whose centres are within `clearance` of an obstacle.
/// A cell may occur several times.
pub(super) fn block_centers(
    scene: &Scene,
    cells: [usize; 2],
    clearance: f64,
    mut block: impl FnMut(usize, Range<usize>),
) {
    let slices = Contacts::new(scene);
    let [rows, columns] = Columns::both(&scene.arm().topology(), cells);
    let bands = Slice::bands(&slices, clearance);
    let is_banned = |q1: f64| bands.forbids(q1);
    forbid_in_rows(&slices, &rows, is_banned, |_| clearance, 0.0, |row, range| block(row, columns.centers(range)));
}

/// Calls `forbid` with each row, and each range of joint 2 that is forbidden at the row's centre. Pair `index` is grown
/// by `grow(index)`, and each range is widened by `widening`. In a banned row, all values are forbidden.
///
/// Each pair is examined only in the rows where link 2 can reach its piece.
fn forbid_in_rows(
    slices: &Contacts,
    rows: &Columns,
    is_banned: impl Fn(f64) -> bool,
    grow: impl Fn(usize) -> f64,
    widening: f64,
    mut forbid: impl FnMut(usize, [f64; 2]),
) {
    let joints = &slices.scene().arm().joints;
    let centers = (0..rows.count).map(|row| rows.center(row));
    let elbows: Vec<_> = centers.map(|q1| (!is_banned(q1)).then(|| slices.elbow(q1))).collect();
    for (row, _) in elbows.iter().enumerate().filter(|(_, elbow)| elbow.is_none()) {
        forbid(row, [f64::NEG_INFINITY, f64::INFINITY]);
    }
    let (mut reached, mut intervals) = (Vec::new(), Vec::new());
    for index in slices.second_link_pairs() {
        let grow = grow(index);
        reached.clear();
        checkpoint();
        let hits = slices.reach_range(index, grow, &mut reached);
        on_axis(&joints[0], hits, &reached, |range| {
            // One more row at both ends covers the rounding of the range.
            let Range { start, end } = rows.centers(range);
            for (row, elbow) in elbows.iter().enumerate().take(end + 1).skip(start.saturating_sub(1)) {
                let &Some((elbow, heading)) = elbow else { continue };
                intervals.clear();
                let hits = slices.at_elbow(index, elbow, heading, grow, &mut intervals);
                intervals.iter_mut().for_each(|[start, end]| (*start, *end) = (*start - widening, *end + widening));
                on_axis(&joints[1], hits, &intervals, |range| forbid(row, range));
            }
        });
    }
}

/// Computes a grid whose free cells are *entirely* free: each of their configurations keeps a positive distance of at
/// least `clearance` from every obstacle.
///
/// A slice represents the slab `q1 +- h1 / 2`. Obstacles are grown by the greatest motion of a touching point of link 2
/// while joint 1 crosses half of the slab. A cell is blocked if its closed range of `q2` meets a forbidden interval.
/// Each configuration of a blocked cell is within `clearance + margin` of an obstacle, where `margin` is that of the
/// grid's [`Proves::Outer`].
///
/// Each obstacle is examined only in the rows where link 2 can reach it: `O(reached slices * contacts + cells)`.
///
/// The cells of a gantry are exact: a cell is blocked only if a C-obstacle reaches into it, not if one only touches its
/// side (see `gantry_cells`).
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

    let [rows, columns] = Columns::both(&grid.topology, cells);
    let bands = Slice::bands(&slices, kept);
    let axis = grid.topology.ranges[0];
    let turns: &[f64] = if axis.is_circle() { &[-TAU, 0.0, TAU] } else { &[0.0] };
    let half = steps[0] / 2.0 + ARC_WIDENING;
    let banned = |q1: f64, band: &[f64; 2], turn: f64| band[0] <= q1 + turn + half && band[1] >= q1 + turn - half;
    let is_banned = |q1: f64| bands.merged.iter().any(|band| turns.iter().any(|&turn| banned(q1, band, turn)));
    let grow = |index: usize| kept + motions[index - slices.second_link_pairs().start];
    forbid_in_rows(&slices, &rows, is_banned, grow, ARC_WIDENING, |row, range| {
        grid.blocked[row * cells[1]..][columns.touched(range)].fill(true);
    });
    grid.block_sums();
    grid
}

fn free(cells: [usize; 2]) -> Vec<bool> {
    vec![false; cells[0] * cells[1]]
}

/// Returns the greatest additional distance, metres, that the motion of both joints within a cell causes.
fn margin(slices: &Contacts<'_>, motions: &[f64], [h1, h2]: [f64; 2], clearance: f64) -> f64 {
    let first = (0..slices.second_link_pairs().start).map(|index| slices.motion(index, h1, clearance));
    let second = slices.second_link_pairs().zip(motions).map(|(index, motion)| 2.0 * motion + slices.lever(index) * h2);
    first.chain(second).fold(0.0, f64::max) + 4.0 * ROUNDING + ARC_WIDENING
}

/// The cells along one axis, in ascending order: the rows (axis 0), or the columns of a row (axis 1).
pub(super) struct Columns {
    lower: f64,
    step: f64,
    per_cell: f64,
    count: usize,
}

impl Columns {
    /// Returns the rows and the columns of a grid.
    pub(super) fn both(topology: &Topology, cells: [usize; 2]) -> [Self; 2] {
        [0, 1].map(|axis| {
            let (range, count) = (topology.ranges[axis], cells[axis]);
            let step = range.extent() / count as f64;
            Self { lower: range.domain().0, step, per_cell: 1.0 / step, count }
        })
    }

    /// Returns the centre of a cell.
    fn center(&self, number: usize) -> f64 {
        self.lower + (number as f64 + 0.5) * self.step
    }

    /// Returns the numbers of the cells whose centres lie in the closed interval.
    fn centers(&self, [start, end]: [f64; 2]) -> Range<usize> {
        let at = |value: f64| (value - self.lower) * self.per_cell - 0.5;
        self.within(at(start), at(end))
    }

    /// Returns the numbers of the closed cells that meet the closed interval.
    pub(super) fn touched(&self, [start, end]: [f64; 2]) -> Range<usize> {
        let at = |value: f64| (value - self.lower) * self.per_cell;
        self.within(at(start) - 1.0, at(end))
    }

    /// Returns the whole numbers of cells from `first` to `last`, both included.
    fn within(&self, first: f64, last: f64) -> Range<usize> {
        // Conversions truncate and saturate. Without SSE 4.1, this is cheaper than rounding up or down. Positions
        // before the first cell become 0, and positions beyond the last one are clamped.
        let from = first as usize + usize::from(first > (first as usize) as f64);
        let to = if last >= 0.0 { (last as usize).saturating_add(1).min(self.count) } else { 0 };
        from.min(to)..to
    }
}
