//! The angle of a tool that a wrist turns along a line.

use cplan_model::Arm;
use cplan_model::space::JointRange;
use serde::{Deserialize, Serialize};

/// Tolerance of the tool's angle on lines that state none, radians: about half a degree.
pub const DEFAULT_WRIST_TOLERANCE: f64 = 0.01;

/// Least tolerance of the tool's angle, radians. The accuracy of robots is far below it.
pub const MIN_WRIST_TOLERANCE: f64 = 1e-6;

/// Greatest tolerance of the tool's angle, radians.
pub const MAX_WRIST_TOLERANCE: f64 = 1.0;

/// The required angle of the tool along a line.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ToolAngle {
    /// An angle for the whole line, radians from the x axis.
    Fixed(f64),
    /// The direction of the line plus this offset, radians.
    Tangent(f64),
}

/// A requirement on the angle of the tool along a line.
///
/// At all times, the angle must be within the tolerance of the one that is required where the tip is on the line. With
/// [`ToolAngle::Tangent`], the angle is free during travels, and while the arm rests at a corner where the line's direction jumps
/// by more than the tolerance. Before and after the line, it is always free.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WristGuide {
    /// The required angle.
    pub angle: ToolAngle,
    /// Greatest difference from it, radians.
    pub tolerance: f64,
}

impl WristGuide {
    /// Returns true if the angle is finite, and the tolerance from [`MIN_WRIST_TOLERANCE`] to [`MAX_WRIST_TOLERANCE`].
    pub fn is_valid(&self) -> bool {
        let (ToolAngle::Fixed(angle) | ToolAngle::Tangent(angle)) = self.angle;
        angle.is_finite() && (MIN_WRIST_TOLERANCE..=MAX_WRIST_TOLERANCE).contains(&self.tolerance)
    }
}

/// The joint of a wrist that turns the tool. The angle of the tool is `zero` plus the rotation of link 2 plus `sign` times the
/// joint's value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WristJoint {
    /// 1 if greater values turn the tool counter-clockwise; otherwise -1.
    pub sign: f64,
    /// Angle of the tool with all joints at zero, radians: the direction of the tip frame's x axis in the plane.
    pub zero: f64,
    /// Value of the joint at rest, radians.
    pub rest: f64,
    /// Range of the joint's values, radians.
    pub range: JointRange,
}

impl WristJoint {
    /// Returns the factors of both joints in the rotation of link 2: 1, -1, or 0 for a prismatic joint.
    pub fn weights(arm: &Arm) -> [f64; 2] {
        arm.joints.each_ref().map(|joint| joint.joint_type.turn())
    }

    /// Returns the rotation of link 2, radians; if `planned` has velocities, the rate of the rotation.
    pub fn link_2_angle(arm: &Arm, planned: [f64; 2]) -> f64 {
        let [first, second] = Self::weights(arm);
        first * planned[0] + second * planned[1]
    }

    /// Returns the angle of the tool, radians, for a value of the joint.
    pub fn tool_angle(&self, arm: &Arm, planned: [f64; 2], value: f64) -> f64 {
        self.zero + Self::link_2_angle(arm, planned) + self.sign * value
    }

    /// Returns the value of the joint, radians, for an angle of the tool.
    pub fn value(&self, arm: &Arm, planned: [f64; 2], angle: f64) -> f64 {
        self.sign * (angle - self.zero - Self::link_2_angle(arm, planned))
    }
}
