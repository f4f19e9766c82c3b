//! The errors for which a motion is free, in the JSON of a result.

use crate::Plan;
use cplan_model::Status;
use cplan_world::AllowedErrors;
use serde::Serialize;

/// The errors for which a motion must be free, and the claims of the answer about them.
#[derive(Serialize)]
pub(super) struct ErrorsReport {
    base: ErrorReport,
    /// Error of each link's length, metres.
    links: f64,
    zeros: ErrorReport,
    /// Greatest displacement of an obstacle, metres.
    obstacles: f64,
    proves: Option<&'static str>,
    /// Status of the problem without errors. `None` if its start or all of its goals are not free.
    drawn: Option<Status>,
}

/// Errors of a length and of an angle.
#[derive(Serialize)]
struct ErrorReport {
    /// Metres.
    length: f64,
    /// Radians.
    angle: f64,
}

impl ErrorsReport {
    pub fn new(plan: &Plan, AllowedErrors { robot, obstacles, .. }: &AllowedErrors) -> Self {
        Self {
            base: ErrorReport { length: robot.base_shift, angle: robot.base_turn },
            links: robot.links,
            zeros: ErrorReport { length: robot.zero_slide, angle: robot.zero_turn },
            obstacles: *obstacles,
            proves: plan.claim_about_errors(),
            drawn: plan.status_as_drawn(),
        }
    }
}

impl Plan {
    /// Returns what is proven about the errors for which the motion must be free. `None` without errors, and for an unknown
    /// answer.
    pub fn claim_about_errors(&self) -> Option<&'static str> {
        self.problem().errors()?;
        match self.status() {
            Status::Found => Some("the motion is free for every robot and world within these errors"),
            Status::Infeasible => Some("no motion is free for all robots and worlds within these errors"),
            Status::Unknown => None,
        }
    }
}
