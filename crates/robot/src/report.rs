//! How a robot was read, for the user.

use crate::AssumedLimits;
use cplan_core::model::Arm;
use cplan_handling::{HeldJoint, RobotJoints};
use serde::{Deserialize, Serialize};

/// What the user should know of how the robot was read.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotReport {
    /// What is made of the robot: the plane, the tip, the outline of each link.
    pub geometry: Vec<String>,
    /// What was taken for granted: joints held still, defaults, outlines of what is not meant for it, things ignored.
    pub notes: Vec<String>,
    /// What may surprise: links that cannot collide, meshes that a bar stands in for.
    pub warnings: Vec<String>,
    /// Limits that nobody gives.
    pub assumed: AssumedLimits,
    /// Joints that could move but are held, and whose value matters to the arm: names and values, radians or metres.
    pub held: Vec<(String, f64)>,
    /// The same joints with what they would do if they moved.
    #[serde(default)]
    pub held_joints: Vec<HeldJoint>,
    /// All joints that can move, for messages that name them.
    pub joints: RobotJoints,
    /// Why torques are not known, unless they are.
    #[serde(default)]
    pub no_dynamics: Option<String>,
}

impl RobotReport {
    /// What may surprise and what is assumed, for programs that print no summary: lines that begin with `warning:` or `note:`.
    #[must_use]
    pub fn remarks(&self, arm: &Arm) -> Vec<String> {
        let warnings = self.warnings.iter().map(|warning| format!("warning: {warning}"));
        warnings.chain(self.assumptions(arm).iter().map(|assumption| format!("note: {assumption}"))).collect()
    }

    /// Limits of an arm that nobody gives, in words: the same wherever they matter.
    #[must_use]
    pub fn assumptions(&self, arm: &Arm) -> Vec<String> {
        self.assumed.notes(arm.joints.each_ref().map(|joint| (joint.name.as_str(), joint.unit())))
    }
}
