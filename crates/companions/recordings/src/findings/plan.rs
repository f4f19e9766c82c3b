//! The distance of a recorded motion from a plan, as data.

use super::motion::{MomentFinding, moment};
use crate::plan_distance::{FarthestPlace, farthest_from_plan};
use cplan_handling::Recording;
use cplan_model::Arm;
use serde::Serialize;

/// The greatest distances of a recorded motion from a plan. The distance of a place of the motion is that to the
/// nearest place of the plan, at whatever time.
#[derive(Debug, Clone, Serialize)]
pub struct PlanFinding {
    /// The place farthest from the plan in joint space.
    pub joints: FarthestFinding,
    /// The place at which the tip is farthest from the path of the planned tip.
    pub tip: FarthestFinding,
}

/// A place of a motion, and its distance from a plan.
#[derive(Debug, Clone, Serialize)]
pub struct FarthestFinding {
    /// Distance from the nearest place of the plan. In joint space it is Euclidean: radians and metres are added as
    /// numbers. For the tip it is in metres.
    pub distance: f64,
    /// The place.
    #[serde(flatten)]
    pub moment: MomentFinding,
}

impl PlanFinding {
    /// Compares a recorded motion with a plan.
    pub fn new(arm: &Arm, recording: &Recording, plan: &Recording) -> Self {
        let is_timed = recording.times().is_some();
        let finding = |place: FarthestPlace| FarthestFinding {
            distance: place.distance,
            moment: moment(&place.moment, is_timed),
        };
        let [joints, tip] = farthest_from_plan(arm, recording, plan).map(finding);
        Self { joints, tip }
    }
}
