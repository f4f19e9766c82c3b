//! The result of an exploration.

use super::settings::Strategy;
use super::survey::Survey;
use cplan_core::space::Configuration;
use cplan_motion::CertifiedCurve;
use cplan_motion::Trajectory;
use std::time::Duration;

/// Reasons why an exploration ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Ending {
    /// The arm is at a goal.
    Reached,
    /// No reading at any reachable configuration of the grid would show anything new.
    Explored {
        /// Number of these configurations.
        configurations: usize,
        /// Number of configurations given up after a reading that showed nothing although it promised something, which
        /// distance errors can cause; 0 without errors.
        given_up: usize,
    },
    /// No path leads to the goal in the known space, where occupied cells are solid as a whole: proven, with the
    /// reason.
    Unreachable(String),
    /// No other ending applies, with the reason.
    Unknown(String),
}

impl Ending {
    /// Returns the ending as one word.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Reached => "reached",
            Self::Explored { .. } => "explored",
            Self::Unreachable(_) => "unreachable",
            Self::Unknown(_) => "unknown",
        }
    }
}

/// A look at the world.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorReading {
    /// Configuration of the arm.
    pub at: Configuration,
    /// Length of the way until then, in joint space.
    pub length: f64,
    /// The cells of the map that were new, in the order in which they were seen.
    pub new: Vec<usize>,
}

/// A motion from rest to rest, certified in the space known at its start.
#[derive(Debug, Clone)]
pub struct Leg {
    /// The curve that the motion follows.
    pub curve: CertifiedCurve,
    /// Number of readings at its start.
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
    /// Cells known initially, without a reading: those around the arm, and those of a known map.
    pub surroundings: Vec<usize>,
    /// All readings, in order.
    pub readings: Vec<SensorReading>,
    /// Cells of the grid that were free for the first time at the beginning and at each decision, with the number of readings that had
    /// been taken.
    pub opened: Vec<(usize, Vec<usize>)>,
    /// All motions, in order.
    pub legs: Vec<Leg>,
    /// The whole motion; `None` if the arm never moved.
    pub trajectory: Option<Trajectory>,
    /// Length of the way, in joint space.
    pub length: f64,
    /// Length in joint space of the shortest motion to the goal found in the true world: what an informed arm would
    /// travel. `None` unless the goal was reached.
    pub known_length: Option<f64>,
    /// Time of each decision.
    pub decisions: Vec<Duration>,
    /// Cells of the grid along both axes.
    pub cells: [usize; 2],
}
