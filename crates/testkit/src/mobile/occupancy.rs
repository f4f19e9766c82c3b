//! The occupancy grid of S. F. dos Reis Alves, *Trabalho 2 - Campos potenciais* (algorithms 1 to 3), as printed.

use super::floor::Floor;
use super::robot::Pose;
use cplan::Point;

/// Numbers of rows, from the north, and of columns, from the west.
pub const CELLS: [usize; 2] = [40, 80];

/// Side of a cell, metres.
pub const SIDE: f64 = 0.5;

/// Range of the scanner, metres.
const RANGE: f64 = 8.0;

/// Values of the cells: 1 if occupied, 0 if free, 0.5 if unknown.
#[derive(Debug, Clone, PartialEq)]
pub struct Occupancy {
    cells: Vec<f64>,
}

/// Converts a position to row and column, with fractions (algorithm 2).
pub fn place(at: Point) -> [f64; 2] {
    let [rows, columns] = CELLS.map(|n| n as f64);
    let within = |k: f64, n: f64| match k {
        k if k <= -1.0 => 0.0,
        k if k >= n => n - 1.0,
        k => k,
    };
    [within(rows - (at.y / SIDE + rows / 2.0), rows), within(at.x / SIDE + columns / 2.0, columns)]
}

/// Returns the cell of a position. Fractions are truncated towards zero.
pub fn cell(at: Point) -> [usize; 2] {
    place(at).map(|k| k as usize)
}

impl Occupancy {
    /// Returns a grid whose cells are all unknown.
    pub fn unknown() -> Self {
        Self { cells: vec![0.5; CELLS[0] * CELLS[1]] }
    }

    /// Returns the value of a cell.
    pub fn at(&self, [row, column]: [usize; 2]) -> f64 {
        self.cells[row * CELLS[1] + column]
    }

    /// Sets the value of a cell.
    pub fn set(&mut self, [row, column]: [usize; 2], value: f64) {
        self.cells[row * CELLS[1] + column] = value;
    }

    /// Iterates over the cells that count as obstacles for forces, by row and column.
    pub fn occupied(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let is_occupied = |&(_, &value): &(usize, &f64)| value > 0.9;
        self.cells.iter().enumerate().filter(is_occupied).map(|(k, _)| [k / CELLS[1], k % CELLS[1]])
    }

    /// Returns the numbers of free, occupied and unknown cells.
    pub fn counts(&self) -> [usize; 3] {
        [0.0, 1.0, 0.5].map(|value| self.cells.iter().filter(|&&cell| cell == value).count())
    }

    /// Records a scan of 180 rays, a degree apart, from right to left (algorithm 3). The cell at the end of a ray becomes
    /// occupied, or free if the ray met nothing. Unknown cells before it become free. (According to the indentation in the
    /// source, the last step is done for one ray only; according to its text and figures, for all rays.)
    pub fn scan(&mut self, floor: &Floor, pose: Pose) {
        for ray in 0..180 {
            let angle = pose.heading + f64::from(ray - 90).to_radians();
            let range = floor.range(pose.at, angle, RANGE);
            let end = pose.at + range * cplan::nalgebra::Vector2::new(angle.cos(), angle.sin());
            self.set(cell(end), if range == RANGE { 0.0 } else { 1.0 });
            self.clear_line(cell(pose.at), cell(end));
        }
    }

    /// Marks the unknown cells between two cells as free (Bresenham 1965; as printed, the end with the greater index is omitted).
    fn clear_line(&mut self, from: [usize; 2], to: [usize; 2]) {
        let is_steep = to[0].abs_diff(from[0]) > to[1].abs_diff(from[1]);
        // The second index is that along the longer direction.
        let turned = |[row, column]: [usize; 2]| if is_steep { [column, row] } else { [row, column] };
        let (mut from, mut to) = (turned(from), turned(to));
        if from[1] > to[1] {
            std::mem::swap(&mut from, &mut to);
        }
        let [dy, dx] = [0, 1].map(|k| to[k].abs_diff(from[k]) as i64);
        let (mut error, mut y) = (dx / 2, from[0]);
        for x in from[1]..to[1] {
            let cell = turned([y, x]);
            if self.at(cell) == 0.5 {
                self.set(cell, 0.0);
            }
            error -= dy;
            if error < 0 {
                y = if from[0] < to[0] { y + 1 } else { y - 1 };
                error += dx;
            }
        }
    }
}
