//! The frontier: the configurations from which something new would be seen.

use super::sight::Edges;
use super::survey::Survey;
use super::views::SensorPose;
use cplan_model::Arm;
use cplan_planners::cspace::Grid;
use cplan_world::Sensor;

/// The frontier configurations of a grid: those at which a reading would show something new.
///
/// Known cells stay known. So a configuration that leaves the frontier never returns to it, and the number of new cells
/// that are visible from a configuration never increases. Earlier counts are therefore upper bounds, and all queries
/// together cost little more than a few readings per configuration.
#[derive(Debug)]
pub struct Frontier {
    configurations: Vec<ExpectedReading>,
    /// Pose of the sensor at each configuration.
    sensor_poses: Vec<SensorPose>,
    /// The unknown cells next to free ones. A ray reaches one of these before any other unknown cell. `None` if
    /// something new has been seen since they were last computed.
    edges: Option<Edges>,
    /// Upper bound on the number of new cells that are visible from any configuration.
    max_gain_anywhere: u32,
    /// For each cell of the map, the value of the counter (`count`) when the cell was last counted.
    last_counts: Vec<u32>,
    count: u32,
    /// Index of the configuration that [`Frontier::evaluate_ahead`] examines next.
    ahead: usize,
    /// Number of configurations whose reading showed nothing new, although it was expected to.
    pub given_up: usize,
}

/// Number of configurations that are examined in advance per decision. This takes a fraction of a millisecond.
const CONFIGURATIONS_AHEAD: usize = 256;

/// Knowledge about a reading that has not been taken.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ExpectedReading {
    /// A cell of the map that the reading shows while the cell is unknown. `None` if no such cell has been computed.
    witness: Option<usize>,
    /// Upper bound on the number of new cells that the reading shows. Once it is 0, it stays 0.
    most: u32,
}

impl Frontier {
    /// Creates the frontier over the configurations of a grid. Initially, only the sensor's range bounds the number of
    /// visible cells.
    pub fn new(survey: &Survey, sensor: &Sensor, arm: &Arm, grid: &Grid) -> Self {
        let cells = survey.map().cells.len();
        // A cell that meets the disc of the sensor's range lies within a disc that is larger by the diagonal of a cell.
        let around = sensor.range / survey.map().resolution + std::f64::consts::SQRT_2;
        let most = (std::f64::consts::PI * around.powi(2)).min(cells as f64).ceil() as u32;
        let sensor_poses: Vec<SensorPose> =
            (0..grid.blocked.len()).map(|cell| sensor.pose(arm, grid.center(cell).into())).collect();
        Self {
            configurations: vec![ExpectedReading { witness: None, most }; sensor_poses.len()],
            sensor_poses,
            edges: None,
            max_gain_anywhere: most,
            last_counts: vec![0; cells],
            count: 0,
            ahead: 0,
            given_up: 0,
        }
    }

    /// Updates the unknown cells next to free ones from the current map.
    pub fn update(&mut self, survey: &Survey, sensor: &Sensor) {
        self.edges = Some(Edges::new(survey, sensor.range));
    }

    /// Discards the cells next to free ones, because something new was seen.
    pub fn forget_edges(&mut self) {
        self.edges = None;
    }

    /// Returns true if a reading at the centre of a cell of the grid would show something new.
    pub fn contains(&mut self, survey: &Survey, sensor: &Sensor, cell: usize) -> bool {
        let prospect = &mut self.configurations[cell];
        if prospect.most > 0 && !prospect.witness.is_some_and(|witness| survey.is_unknown(witness)) {
            // If no ray reaches an unknown cell now, none will later.
            prospect.witness = survey.reachable_unknown(sensor, self.sensor_poses[cell], self.edges.as_ref());
            if prospect.witness.is_none() {
                prospect.most = 0;
            }
        }
        prospect.most > 0
    }

    /// Examines some of the configurations that may be on the frontier, in turn, so that no decision has to examine all
    /// of them. If a reading would show nothing new, that result is permanent.
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
    pub fn sensor_pose(&self, cell: usize) -> SensorPose {
        self.sensor_poses[cell]
    }

    /// Returns an upper bound on the number of new cells visible from a cell of the grid.
    pub fn max_gain(&self, cell: usize) -> u32 {
        self.configurations[cell].most
    }

    /// Returns an upper bound on the number of new cells visible from any cell.
    pub fn max_gain_anywhere(&self) -> u32 {
        self.max_gain_anywhere
    }

    /// Returns the number of new cells visible from a cell of the grid if no unknown obstacle interferes.
    pub fn gain(&mut self, survey: &Survey, sensor: &Sensor, cell: usize) -> u32 {
        if self.configurations[cell].most > 0 {
            self.count += 1;
            let mut gain = 0;
            for seen in survey.visible_unknown(sensor, self.sensor_poses[cell]) {
                gain += u32::from(std::mem::replace(&mut self.last_counts[seen], self.count) != self.count);
            }
            self.configurations[cell].most = gain;
        }
        self.configurations[cell].most
    }

    /// Records that a reading at a cell of the grid showed nothing new, contrary to the expectation. Random errors of
    /// distances can be the cause. The cell then leaves the frontier.
    pub fn record_nothing_new(&mut self, cell: usize) {
        if self.configurations[cell].most > 0 {
            self.configurations[cell].most = 0;
            self.given_up += 1;
        }
    }
}
