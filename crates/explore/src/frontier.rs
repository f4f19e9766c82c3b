//! The configurations from which something new would be seen.

use super::sight::Edges;
use super::survey::Survey;
use super::views::SensorPose;
use cplan_core::cspace::Grid;
use cplan_core::model::Arm;
use cplan_world::Sensor;

/// The frontier configurations of a grid: those at whose centres a reading would show something new.
///
/// Knowledge only grows: a configuration leaves the frontier permanently, and the number of cells visible from it only
/// decreases. So earlier counts are upper bounds, and all queries together cost little more than a few readings at each
/// cell.
#[derive(Debug)]
pub struct Frontier {
    configurations: Vec<ExpectedReading>,
    /// Sensor pose at each configuration.
    stands: Vec<SensorPose>,
    /// The unknown cells of the map beside free ones: what rays come to first is one of them.
    ///
    /// None while something new has been seen since they were looked for.
    edges: Option<Edges>,
    /// No more cells than these can be seen from anywhere.
    max_gain_anywhere: u32,
    /// When each cell of the map was counted last.
    counted: Vec<u32>,
    count: u32,
    /// The configuration that is asked ahead next.
    ahead: usize,
    /// Number of configurations that were given up although they promised new cells.
    pub given_up: usize,
}

/// Configurations that are asked ahead at each decision: a fraction of a millisecond.
const CONFIGURATIONS_AHEAD: usize = 256;

/// Knowledge about a reading.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ExpectedReading {
    /// A cell of the map that it comes to as long as nothing is known of that.
    witness: Option<usize>,
    /// It shows no more cells than these; 0 if nothing new, for ever.
    most: u32,
}

impl Frontier {
    /// Creates the frontier over the configurations of a grid, bounded only by the range of the sensor.
    #[must_use]
    pub fn new(survey: &Survey, sensor: &Sensor, arm: &Arm, grid: &Grid) -> Self {
        let cells = survey.map().cells.len();
        // Cells that meet a disc lie within one that is broader by their diagonal.
        let around = sensor.range / survey.map().resolution + std::f64::consts::SQRT_2;
        let most = (std::f64::consts::PI * around.powi(2)).min(cells as f64).ceil() as u32;
        let stands: Vec<SensorPose> =
            (0..grid.blocked.len()).map(|cell| sensor.pose(arm, grid.center(cell).into())).collect();
        Self {
            configurations: vec![ExpectedReading { witness: None, most }; stands.len()],
            stands,
            edges: None,
            max_gain_anywhere: most,
            counted: vec![0; cells],
            count: 0,
            ahead: 0,
            given_up: 0,
        }
    }

    /// Updates it with the current map.
    pub fn update(&mut self, survey: &Survey, sensor: &Sensor) {
        self.edges = Some(Edges::new(survey, sensor.range));
    }

    /// Records that something new was seen, so edges may have changed.
    pub fn forget_edges(&mut self) {
        self.edges = None;
    }

    /// Returns true if a reading at the centre of a cell of the grid would show something new.
    pub fn contains(&mut self, survey: &Survey, sensor: &Sensor, cell: usize) -> bool {
        let prospect = &mut self.configurations[cell];
        if prospect.most > 0 && !prospect.witness.is_some_and(|witness| survey.is_unknown(witness)) {
            // Rays that come to nothing new now never will.
            prospect.witness = survey.reachable_unknown(sensor, self.stands[cell], self.edges.as_ref());
            if prospect.witness.is_none() {
                prospect.most = 0;
            }
        }
        prospect.most > 0
    }

    /// Asks some configurations whose answer is open, in turn, so that no decision has to ask them all: what shows nothing new never will.
    pub fn evaluate_ahead(&mut self, survey: &Survey, sensor: &Sensor, grid: &Grid) {
        let mut asked = 0;
        for _ in 0..self.configurations.len() {
            let cell = self.ahead;
            self.ahead = (cell + 1) % self.configurations.len();
            let ExpectedReading { witness, most } = self.configurations[cell];
            if !grid.blocked[cell] && most > 0 && !witness.is_some_and(|witness| survey.is_unknown(witness)) {
                self.contains(survey, sensor, cell);
                asked += 1;
                if asked == CONFIGURATIONS_AHEAD {
                    break;
                }
            }
        }
    }

    /// Returns the sensor pose for a reading at the centre of a cell of the grid.
    #[must_use]
    pub fn sensor_pose(&self, cell: usize) -> SensorPose {
        self.stands[cell]
    }

    /// Returns an upper bound on the number of new cells visible from a cell of the grid.
    #[must_use]
    pub fn max_gain(&self, cell: usize) -> u32 {
        self.configurations[cell].most
    }

    /// Returns an upper bound on the number of new cells visible from any cell.
    #[must_use]
    pub fn max_gain_anywhere(&self) -> u32 {
        self.max_gain_anywhere
    }

    /// Returns the number of new cells visible from a cell of the grid if no unknown obstacle interferes.
    pub fn gain(&mut self, survey: &Survey, sensor: &Sensor, cell: usize) -> u32 {
        if self.configurations[cell].most > 0 {
            self.count += 1;
            let mut gain = 0;
            for seen in survey.visible_unknown(sensor, self.stands[cell]) {
                gain += u32::from(std::mem::replace(&mut self.counted[seen], self.count) != self.count);
            }
            self.configurations[cell].most = gain;
        }
        self.configurations[cell].most
    }

    /// Takes note that a reading was taken there and showed nothing: where distances are wrong by chance more may seem to be seen than
    /// is, and the configuration is not asked again.
    pub fn record_nothing_new(&mut self, cell: usize) {
        if self.configurations[cell].most > 0 {
            self.configurations[cell].most = 0;
            self.given_up += 1;
        }
    }
}
