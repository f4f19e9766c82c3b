//! What became of an exploration.

use super::settings::Strategy;
use super::survey::Survey;
use cplan_core::space::Configuration;
use cplan_motion::CertifiedCurve;
use cplan_motion::Trajectory;
use std::time::Duration;

/// How an exploration ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Ending {
    /// The arm is at a goal.
    Reached,
    /// From no configuration of the grid that can be reached would a reading show anything new.
    Explored {
        /// How many configurations these are.
        configurations: usize,
        /// How many of them were given up after a reading that showed nothing, though it promised something, as errors may make it;
        /// none without errors.
        given_up: usize,
    },
    /// There is no way to the goal in what is known, where cells that hold anything are solid as a whole: proven, and why.
    Unreachable(String),
    /// None of these: why.
    Unknown(String),
}

impl Ending {
    /// In a word.
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
pub struct Reading {
    /// Where the arm was.
    pub at: Configuration,
    /// Length of the way until then, in joint space.
    pub length: f64,
    /// The cells of the map that were new, in the order in which they were seen.
    pub new: Vec<usize>,
}

/// A motion from rest to rest, certified in what was known when it began.
#[derive(Debug, Clone)]
pub struct Leg {
    /// What the motion follows.
    pub curve: CertifiedCurve,
    /// How many readings had been taken when it began.
    pub readings: usize,
}

/// An exploration from its beginning to its end.
#[derive(Debug, Clone)]
pub struct Exploration {
    /// Where it went next.
    pub strategy: Strategy,
    /// How it ended.
    pub ending: Ending,
    /// The map in the end.
    pub survey: Survey,
    /// What was known at first, without a reading: cells of the map that the arm stood among, or that were known already.
    pub surroundings: Vec<usize>,
    /// All readings, in order.
    pub readings: Vec<Reading>,
    /// Cells of the grid that were free for the first time at the beginning and at each decision, with the number of readings that had
    /// been taken.
    pub opened: Vec<(usize, Vec<usize>)>,
    /// All motions, in order.
    pub legs: Vec<Leg>,
    /// The whole motion; none if the arm never moved.
    pub trajectory: Option<Trajectory>,
    /// Length of the way, in joint space.
    pub length: f64,
    /// Length of the shortest motion to the goal that was found in the world itself, in joint space: what an arm that knew it would go. None
    /// unless the goal was reached.
    pub known_length: Option<f64>,
    /// Time of each decision.
    pub decisions: Vec<Duration>,
    /// Cells of the grid along both axes.
    pub cells: [usize; 2],
}
