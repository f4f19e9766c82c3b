//! The controller by harmonic and oriented fields of S. F. dos Reis Alves, *Trabalho 2 - Campos potenciais*, algorithm 15.

use super::forces::{Ending, approach};
use super::occupancy::{CELLS, Occupancy, cell};
use super::robot::{Robot, wrapped};
use cplan::Point;

/// Returns true if a field treats a cell as solid: it is not known to be free.
pub fn is_solid(map: &Occupancy, k: usize) -> bool {
    map.at([k / CELLS[1], k % CELLS[1]]) > 0.0
}

/// Descends a field, given row by row, until the robot is within 0.5 m of a target.
pub fn drive(robot: &mut Robot, field: &[f64], target: Point) -> Ending {
    let (speed_gain, turn_gain, stop) = (5.0, 0.5, 0.5);
    approach(robot, target, stop, |robot, distance| {
        let [row, column] = cell(robot.pose.at);
        let value = |row: usize, column: usize| field[row.min(CELLS[0] - 1) * CELLS[1] + column.min(CELLS[1] - 1)];
        let (above, below) = (value(row.saturating_sub(1), column), value(row + 1, column));
        let (left, right) = (value(row, column.saturating_sub(1)), value(row, column + 1));
        let error = wrapped((below - above).atan2(left - right) - robot.pose.heading);
        Ok([(speed_gain * distance).clamp(0.2, 1.0), turn_gain * error])
    })
}
