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
    /// Assumptions: joints that are held, default values, outlines from other geometry, ignored elements.
    pub notes: Vec<String>,
    /// Warnings, for example about links that cannot collide, or meshes that are replaced by a bar.
    pub warnings: Vec<String>,
    /// Limits that are assumed because the files state none.
    pub assumed: AssumedLimits,
    /// Names and values (radians or metres) of the movable joints that are held and whose value matters to the arm.
    pub held: Vec<(String, f64)>,
    /// The joints in `held`, with the effects of their motion.
    #[serde(default)]
    pub held_joints: Vec<HeldJoint>,
    /// All movable joints, for messages that name them.
    pub joints: RobotJoints,
    /// The reason why torques are unknown. `None` if they are known.
    #[serde(default)]
    pub no_dynamics: Option<String>,
    /// Paths of the files that were read: the URDF, the files of its xacro, and its meshes.
    #[serde(skip)]
    pub files: Vec<PathBuf>,
}

impl RobotReport {
    /// Returns warnings and assumptions as lines that begin with `warning:` or `note:`. They are for programs that
    /// print no summary.
    pub fn remarks(&self, arm: &Arm) -> Vec<String> {
        let warnings = self.warnings.iter().map(|warning| format!("warning: {warning}"));
        warnings.chain(self.assumptions(arm).iter().map(|assumption| format!("note: {assumption}"))).collect()
    }

    /// Describes the limits of an arm that are assumed.
    pub fn assumptions(&self, arm: &Arm) -> Vec<String> {
        self.assumed.notes(arm.joints.each_ref().map(|joint| (joint.name.as_str(), joint.unit())))
    }
}
