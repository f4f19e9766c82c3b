//! The result of an exploration.

use super::settings::Strategy;
use super::survey::Survey;
use cplan_model::space::Configuration;
use cplan_motion::{CertifiedCurve, Trajectory};
use cplan_text::counted;
use std::time::Duration;

/// Reason for which an exploration ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Ending {
    /// The arm is at a goal.
    Reached,
    /// No reading at any reachable configuration of the grid would show anything new.
    Explored {
        /// Number of reachable configurations of the grid.
        configurations: usize,
        /// Number of configurations whose readings showed nothing new, although they were expected to. It is 0 unless
        /// distances have errors.
        given_up: usize,
    },
    /// It is proven that no path leads to the goal in the known space, in which an occupied cell is solid as a whole.
    /// Contains the reason.
    Unreachable(String),
    /// No other ending applies. Contains the reason.
    Unknown(String),
}

impl Ending {
    /// Returns the ending as one word.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Reached => "reached",
            Self::Explored { .. } => "explored",
            Self::Unreachable(_) => "unreachable",
            Self::Unknown(_) => "unknown",
        }
    }
}

impl Exploration {
    /// Returns the outcome in one sentence.
    pub fn headline(&self) -> String {
        let readings = counted(self.readings.len(), "reading");
        match &self.ending {
            Ending::Reached => {
                let ratio = self.known_length.filter(|&known| known > 0.0).map(|known| self.length / known);
                let longer = ratio.map(|ratio| format!(", {ratio:.2} times as far as in a known world"));
                format!("The arm reached its goal after {readings}{}", longer.unwrap_or_default())
            }
            Ending::Explored { .. } => {
                let [free, occupied, unknown] = self.survey.counts();
                let seen = 100.0 * (free + occupied) as f64 / (free + occupied + unknown) as f64;
                format!("The arm has seen {seen:.1} % of the map, all that it can see, after {readings}")
            }
            Ending::Unreachable(_) => format!("No path leads to the goal, proven after {readings}"),
            Ending::Unknown(why) => format!("Not known after {readings}: {why}"),
        }
    }
}

/// A reading of the sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorReading {
    /// Configuration of the arm.
    pub at: Configuration,
    /// Length of the path up to the reading, in joint space.
    pub length: f64,
    /// The cells of the map that became known, in the order in which they were seen.
    pub new: Vec<usize>,
}

/// A motion from rest to rest. It is certified in the space that was known when it began.
#[derive(Debug, Clone)]
pub struct Leg {
    /// The curve that the motion follows.
    pub curve: CertifiedCurve,
    /// Number of readings that had been taken when the motion began.
    pub readings: usize,
}

/// An exploration from its beginning to its end.
#[derive(Debug, Clone)]
pub struct Exploration {
    /// The strategy.
    pub strategy: Strategy,
    /// The ending.
    pub ending: Ending,
    /// The final map.
    pub survey: Survey,
    /// Cells of the map that were known without a reading: those around the arm, and those of a known map.
    pub surroundings: Vec<usize>,
    /// All readings, in order.
    pub readings: Vec<SensorReading>,
    /// Cells of the grid that became free, at the beginning and at each decision. Each entry begins with the number of
    /// readings that had been taken.
    pub opened: Vec<(usize, Vec<usize>)>,
    /// All motions, in order.
    pub legs: Vec<Leg>,
    /// The whole motion; `None` if the arm never moved.
    pub trajectory: Option<Trajectory>,
    /// Length of the whole path, in joint space.
    pub length: f64,
    /// Length, in joint space, of the shortest path to the goal that is found with knowledge of the true world. `None`
    /// unless the goal was reached.
    pub known_length: Option<f64>,
    /// Computing time of each decision.
    pub decisions: Vec<Duration>,
    /// Number of cells of the grid along each axis.
    pub cells: [usize; 2],
}
