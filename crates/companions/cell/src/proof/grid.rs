//! The grid of a proof: equal cells of the ranges of all four joints.

use cplan_model::space::{JointRange, Segment};
use cplan_model::{MotionProblem, Scene};
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Greatest number of cells of a grid: the flood fill needs one byte per cell.
pub(crate) const MAX_CELLS: usize = 1 << 26;

/// Rounding error of a value of a joint, as a share of it.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// The number of a cell along each of the four joints.
pub(crate) type Index = [usize; 4];

/// Cells of the two joints of an arm.
pub(crate) type ArmCells = BTreeSet<[usize; 2]>;

/// A grid in the space of all four joints: those of the first arm, then those of the second.
#[derive(Debug, Clone)]
pub(crate) struct Grid {
    /// Least and greatest value of each joint.
    pub ranges: [[f64; 2]; 4],
    /// True for each joint that turns without end.
    pub is_circle: [bool; 4],
    /// Number of cells along each joint.
    pub cells: Index,
}

impl Grid {
    /// Creates a grid with one cell.
    pub fn new(scenes: [&Scene; 2]) -> Self {
        let joints = [0, 1, 2, 3].map(|k| scenes[k / 2].arm().topology().ranges[k % 2]);
        let ranges = joints.map(|joint| <[f64; 2]>::from(joint.domain()));
        Self { ranges, is_circle: joints.map(JointRange::is_circle), cells: [1; 4] }
    }

    /// Returns the number of cells. `None` if there are more than [`MAX_CELLS`].
    pub fn count(&self) -> Option<usize> {
        let count = self.cells.iter().try_fold(1_usize, |count, cells| count.checked_mul(*cells))?;
        (count <= MAX_CELLS).then_some(count)
    }

    /// Returns the interval of cells along an axis: from the first one to the one before `end`.
    pub fn interval(&self, axis: usize, [first, end]: [usize; 2]) -> [f64; 2] {
        let [lower, upper] = self.ranges[axis];
        let at = |k: usize| {
            if k == self.cells[axis] { upper } else { lower + (upper - lower) * (k as f64 / self.cells[axis] as f64) }
        };
        [at(first), at(end)]
    }

    /// Returns the neighbours of a cell: those that have a face in common with it.
    pub fn neighbors(&self, index: Index) -> impl Iterator<Item = Index> {
        (0..4).flat_map(move |axis| [(axis, 1), (axis, self.cells[axis] - 1)]).filter_map(move |(axis, step)| {
            let mut next = index;
            next[axis] = (next[axis] + step) % self.cells[axis];
            let crosses_end = next[axis].abs_diff(index[axis]) > 1 || self.cells[axis] == 1;
            (!crosses_end || self.is_circle[axis]).then_some(next)
        })
    }

    /// Returns the cells of an arm's joints that may contain a point of a segment, with their sides.
    fn arm_cells(&self, arm: usize, piece: &Segment) -> ArmCells {
        let [a, b] = piece.ends();
        let along = |joint: usize| {
            let axis = 2 * arm + joint;
            let (least, greatest) = (a[joint].min(b[joint]), a[joint].max(b[joint]));
            let near = ROUNDING * (1.0 + least.abs().max(greatest.abs()));
            let turns: &[f64] = if self.is_circle[axis] { &[-1.0, 0.0, 1.0] } else { &[0.0] };
            let meets = move |cell: &usize| {
                let [from, to] = self.interval(axis, [*cell, cell + 1]);
                turns.iter().any(|turn| from - near <= greatest + turn * TAU && least + turn * TAU <= to + near)
            };
            (0..self.cells[axis]).filter(meets).collect::<Vec<_>>()
        };
        let (first, second) = (along(0), along(1));
        first.iter().flat_map(|one| second.iter().map(|two| [*one, *two])).collect()
    }

    /// Returns the cells of an arm's joints that may contain its start.
    pub fn start_cells(&self, arm: usize, problem: &MotionProblem) -> ArmCells {
        self.cells_of(arm, problem, &[Segment::point(problem.start())])
    }

    /// Returns the cells of an arm's joints that may contain one of its goals.
    pub fn goal_cells(&self, arm: usize, problem: &MotionProblem) -> ArmCells {
        self.cells_of(arm, problem, problem.goals().pieces())
    }

    fn cells_of(&self, arm: usize, problem: &MotionProblem, pieces: &[Segment]) -> ArmCells {
        let topology = problem.scene().arm().topology();
        let wrapped = pieces.iter().flat_map(|piece| piece.wrapped(&topology));
        wrapped.flat_map(|piece| self.arm_cells(arm, &piece)).collect()
    }
}
