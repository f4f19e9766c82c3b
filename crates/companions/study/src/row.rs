//! The result of a layout.

use cplan_model::Status;
use serde::{Deserialize, Serialize};

/// A layout's row of the table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Number of the layout, from 0.
    pub layout: usize,
    /// Value of each parameter.
    pub values: Vec<f64>,
    /// Ending of planning.
    pub ending: Ending,
    /// Beginning of the reason why there is no motion, on one line. `None` if there is a motion.
    pub reason: Option<String>,
    /// Measured values, in the order of the study's measures. `None` for a missing value.
    pub measured: Vec<Option<f64>>,
    /// True if there is a motion and all conditions hold.
    pub fits: bool,
}

/// Ending of planning in a layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// A motion is certified.
    Found,
    /// It is proven that no motion exists.
    Infeasible,
    /// It is not known whether a motion exists.
    Unknown,
    /// There is nothing to plan: start or goal is blocked or out of reach, or a value is invalid.
    Refused,
}

impl Ending {
    /// All endings.
    pub const ALL: [Self; 4] = [Self::Found, Self::Infeasible, Self::Unknown, Self::Refused];

    /// Returns the word for the ending in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Found => Status::Found.name(),
            Self::Infeasible => Status::Infeasible.name(),
            Self::Unknown => Status::Unknown.name(),
            Self::Refused => "refused",
        }
    }
}

impl From<Status> for Ending {
    fn from(status: Status) -> Self {
        match status {
            Status::Found => Self::Found,
            Status::Infeasible => Self::Infeasible,
            Status::Unknown => Self::Unknown,
        }
    }
}
