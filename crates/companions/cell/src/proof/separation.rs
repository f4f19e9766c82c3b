//! Decides whether boxes separate the starts from all goals.
//!
//! The fill goes from cell to cell through faces. A point where cells meet only at an edge or a corner is in all cells
//! around it: if one of them is in a box of collisions, the point is one as well.

use super::grid::ArmCells;
use super::{ContactBox, Grid};
use cplan_interrupt::checkpoint;

/// Returns true if no cell with both goals is connected with the cells that contain the starts, outside the boxes. The grid has
/// at most [`super::MAX_CELLS`] cells.
pub(super) fn separates(grid: &Grid, boxes: &[ContactBox], starts: &[ArmCells; 2], goals: &[ArmCells; 2]) -> bool {
    let [_, n1, n2, n3] = grid.cells;
    // The distance of neighbours along each axis, in the list of all cells.
    let strides = [n1 * n2 * n3, n2 * n3, n3, 1];
    let number =
        |[a, b]: [usize; 2], [c, d]: [usize; 2]| [a, b, c, d].iter().zip(strides).map(|(k, stride)| k * stride).sum();
    let mut is_closed = vec![false; strides[0] * grid.cells[0]];
    for ContactBox { cells: [a, b, c, d], .. } in boxes {
        checkpoint();
        for (i, j) in (a[0]..a[1]).flat_map(|i| (b[0]..b[1]).map(move |j| (i, j))) {
            for k in c[0]..c[1] {
                let row: usize = number([i, j], [k, 0]);
                is_closed[row + d[0]..row + d[1]].fill(true);
            }
        }
    }
    let mut open: Vec<usize> = Vec::new();
    for (one, two) in starts[0].iter().flat_map(|one| starts[1].iter().map(move |two| (one, two))) {
        open.push(number(*one, *two));
    }
    open.retain(|cell| !std::mem::replace(&mut is_closed[*cell], true));
    while let Some(cell) = open.pop() {
        checkpoint();
        let at = [0, 1, 2, 3].map(|axis| cell / strides[axis] % grid.cells[axis]);
        if goals[0].contains(&[at[0], at[1]]) && goals[1].contains(&[at[2], at[3]]) {
            return false;
        }
        for axis in 0..4 {
            let (stride, last) = (strides[axis], grid.cells[axis] - 1);
            let up = if at[axis] < last {
                Some(cell + stride)
            } else {
                Some(cell - last * stride).filter(|_| grid.is_circle[axis])
            };
            let down = if at[axis] > 0 {
                Some(cell - stride)
            } else {
                Some(cell + last * stride).filter(|_| grid.is_circle[axis])
            };
            open.extend(
                [up, down].into_iter().flatten().filter(|next| !std::mem::replace(&mut is_closed[*next], true)),
            );
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Tests a wall along one axis. It separates the sides, except around the seam of a joint that turns without end.
    #[test]
    fn a_wall_separates_unless_the_joint_turns_without_end() {
        for axis in 0..4 {
            for is_circle in [false, true] {
                let mut grid = Grid { ranges: [[-PI, PI]; 4], is_circle: [false; 4], cells: [3, 2, 4, 1] };
                (grid.is_circle[axis], grid.cells[axis]) = (is_circle, 8);
                let mut wall = grid.cells.map(|cells| [0, cells]);
                wall[axis] = [3, 5];
                let walls = [ContactBox { contact: 0, cells: wall }];
                let place = |k: usize| {
                    let mut at = [0; 4];
                    at[axis] = k;
                    [[at[0], at[1]], [at[2], at[3]]].map(|cells| ArmCells::from([cells]))
                };
                assert_eq!(separates(&grid, &walls, &place(1), &place(6)), !is_circle, "{axis}");
                assert!(!separates(&grid, &walls, &place(1), &place(2)), "{axis}");
                assert!(separates(&grid, &walls, &place(4), &place(6)), "a start in a wall is not free");
            }
        }
    }

    /// Tests boxes with a gap that only a diagonal step passes.
    #[test]
    fn cells_that_meet_at_a_corner_are_not_connected() {
        let grid = Grid { ranges: [[0.0, 1.0]; 4], is_circle: [false; 4], cells: [2, 1, 2, 1] };
        let closed = |i: usize, k: usize| ContactBox { contact: 0, cells: [[i, i + 1], [0, 1], [k, k + 1], [0, 1]] };
        let place = |i: usize, k: usize| [ArmCells::from([[i, 0]]), ArmCells::from([[k, 0]])];
        let boxes = [closed(0, 1), closed(1, 0)];
        assert!(separates(&grid, &boxes, &place(0, 0), &place(1, 1)));
        assert!(!separates(&grid, &boxes[..1], &place(0, 0), &place(1, 1)));
    }
}
