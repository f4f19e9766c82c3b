//! From where something new would be seen.

use super::survey::Survey;
use crate::cspace::Grid;
use crate::model::{Arm, Sensor};

/// What readings at the middles of a grid's cells would show. Each ray is followed once as long as what stops it is unknown, so all
/// questions together cost little more than one look from everywhere.
#[derive(Debug)]
pub struct Outlook {
    cells: Vec<Prospect>,
    /// How many were given up, though they promised something.
    pub given_up: usize,
}

/// What is known of a reading.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Prospect {
    NotAsked,
    /// It would come to this cell of the map, as long as that is unknown.
    News(usize),
    /// It would show nothing new, nor ever will: what is known stays so.
    Nothing,
}

impl Outlook {
    /// Over so many configurations.
    pub fn new(count: usize) -> Self {
        Self { cells: vec![Prospect::NotAsked; count], given_up: 0 }
    }

    /// Whether a reading at the middle of a cell would show something new.
    pub fn promises(&mut self, survey: &Survey, sensor: &Sensor, arm: &Arm, grid: &Grid, cell: usize) -> bool {
        let known = match self.cells[cell] {
            Prospect::Nothing => return false,
            Prospect::News(unknown) => survey.is_unknown(unknown),
            Prospect::NotAsked => false,
        };
        if !known {
            let promise = survey.promise(sensor, arm, grid.center(cell));
            self.cells[cell] = promise.map_or(Prospect::Nothing, Prospect::News);
        }
        self.cells[cell] != Prospect::Nothing
    }

    /// Takes note that a reading was taken there and showed nothing: where distances are wrong by chance it may promise more than it
    /// holds, and is not asked again.
    pub fn disappointed(&mut self, cell: usize) {
        if self.cells[cell] != Prospect::Nothing {
            self.cells[cell] = Prospect::Nothing;
            self.given_up += 1;
        }
    }
}
