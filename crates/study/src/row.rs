//! What became of a layout.

use cplan_core::model::Status;
use serde::{Deserialize, Serialize};

/// A layout's row of the table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Its number, from 0.
    pub layout: usize,
    /// What each parameter was.
    pub values: Vec<f64>,
    /// What came of it.
    pub ending: Ending,
    /// Why there is no motion, where there is none: as it begins, on a line.
    pub reason: Option<String>,
    /// What was measured, in the order of the study's measures; what there is none of stays open.
    pub measured: Vec<Option<f64>>,
    /// Whether there is a motion and all conditions are met.
    pub fits: bool,
}

/// How planning in a layout ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// A motion is certified.
    Found,
    /// It is proven that there is none.
    Infeasible,
    /// Neither is known.
    Unknown,
    /// There is nothing to plan: start or goal is not free or out of reach, or a value makes no sense.
    Refused,
}

impl Ending {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Found, Self::Infeasible, Self::Unknown, Self::Refused];

    /// Its word in tables.
    #[must_use]
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
