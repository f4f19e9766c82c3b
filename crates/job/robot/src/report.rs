//! The report to the user on how the robot was read.

use crate::AssumedLimits;
use cplan_handling::{HeldJoint, RobotJoints};
use cplan_model::Arm;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The report on how the robot was read.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotReport {
    /// Descriptions of the resulting geometry: plane, tip, and outline of each link.
    pub geometry: Vec<String>,
    /// Assumptions: constant values of joints, default values, outlines from other geometry, ignored elements.
    pub notes: Vec<String>,
    /// Warnings, for example about links that cannot collide, or meshes that a bar replaces.
    pub warnings: Vec<String>,
    /// Limits that are assumed because the files state none.
    pub assumed: AssumedLimits,
    /// Names and values (radians or metres) of the movable joints that are kept fixed and whose values matter to the arm.
    pub held: Vec<(String, f64)>,
    /// The joints in `held`, with the effects of their motion.
    #[serde(default)]
    pub held_joints: Vec<HeldJoint>,
    /// All movable joints, for messages that name them.
    pub joints: RobotJoints,
    /// The reason why torques cannot be computed. `None` if they can.
    #[serde(default)]
    pub no_dynamics: Option<String>,
    /// Paths of the files that were read: the URDF, the files of its xacro, and its meshes.
    #[serde(skip)]
    pub files: Vec<PathBuf>,
}

impl RobotReport {
    /// Returns warnings and assumptions, for programs that print no summary, as lines that begin with `warning:` or `note:`.
    pub fn remarks(&self, arm: &Arm) -> Vec<String> {
        let warnings = self.warnings.iter().map(|warning| format!("warning: {warning}"));
        warnings.chain(self.assumptions(arm).iter().map(|assumption| format!("note: {assumption}"))).collect()
    }

    /// Describes the assumed limits of an arm.
    pub fn assumptions(&self, arm: &Arm) -> Vec<String> {
        self.assumed.notes(arm.joints.each_ref().map(|joint| (joint.name.as_str(), joint.unit())))
    }
}
