//! Joints that the planner keeps fixed, and recorded motions of such joints.

use super::Recording;
use cplan_geometry::Point;
use serde::{Deserialize, Serialize};

/// The effect that a motion of a fixed joint would have.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HeldEffect {
    /// The joint lifts everything that it carries along the plane's normal.
    Lifts {
        /// 1 if increasing values of the joint lift along the plane's normal, and -1 if they lower.
        sign: f64,
    },
    /// The joint turns everything that it carries, including all of link 2, about an axis along the plane's normal.
    Turns {
        /// Position of the axis, in the frame of link 2.
        axis: Point,
        /// 1 if increasing values of the joint turn counter-clockwise in the plane, and -1 if they turn clockwise.
        sign: f64,
    },
    /// Another effect, which cplan cannot check.
    Unjudged {
        /// The reason, as a clause whose subject is the joint.
        why: String,
    },
}

/// A joint that the planner keeps fixed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeldJoint {
    /// Name in the URDF.
    pub name: String,
    /// Its fixed value, radians or metres.
    pub value: f64,
    /// Effect of its motion.
    pub effect: HeldEffect,
    /// Names of the URDF links that the joint moves.
    pub bodies: Vec<String>,
}

/// A motion of a joint that the planner keeps fixed.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldMotion {
    /// The joint that moves.
    pub joint: HeldJoint,
    /// Values of the joint at the samples of the arm's motion, as first coordinates.
    pub values: Recording,
    /// True if the joint also lifts the carried object.
    pub lifts_payload: bool,
}
