//! Report to the user on how the robot was read.

use crate::AssumedLimits;
use cplan_core::model::Arm;
use cplan_handling::{HeldJoint, RobotJoints};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The report on how the robot was read.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotReport {
    /// The resulting geometry: plane, tip, and outline of each link.
    pub geometry: Vec<String>,
    /// Assumptions: joints held still, defaults, outlines from other geometry, ignored elements.
    pub notes: Vec<String>,
    /// Warnings: links that cannot collide, meshes replaced by a bar.
    pub warnings: Vec<String>,
    /// Limits that are assumed because the files give none.
    pub assumed: AssumedLimits,
    /// Joints that could move but are held, and whose value matters to the arm: names and values, radians or metres.
    pub held: Vec<(String, f64)>,
    /// These joints with the effects of their motion.
    #[serde(default)]
    pub held_joints: Vec<HeldJoint>,
    /// All movable joints, for messages that name them.
    pub joints: RobotJoints,
    /// The reason why torques are unknown, if they are.
    #[serde(default)]
    pub no_dynamics: Option<String>,
    /// Paths of the files that were read: the URDF, the files of its xacro, and its meshes.
    #[serde(skip)]
    pub files: Vec<PathBuf>,
}

impl RobotReport {
    /// Returns warnings and assumptions for programs that print no summary: lines that begin with `warning:` or
    /// `note:`.
    #[must_use]
    pub fn remarks(&self, arm: &Arm) -> Vec<String> {
        let warnings = self.warnings.iter().map(|warning| format!("warning: {warning}"));
        warnings.chain(self.assumptions(arm).iter().map(|assumption| format!("note: {assumption}"))).collect()
    }

    /// Returns the assumed limits of an arm, in the same words everywhere.
    #[must_use]
    pub fn assumptions(&self, arm: &Arm) -> Vec<String> {
        self.assumed.notes(arm.joints.each_ref().map(|joint| (joint.name.as_str(), joint.unit())))
    }
}
