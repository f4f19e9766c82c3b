//! Joints other than the two planned ones, and recorded motions of them.

use super::Recording;
use cplan_geometry::Point;
use serde::{Deserialize, Serialize};

/// The effect that a motion of a held joint would have on the arm.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HeldEffect {
    /// Lifts everything it carries along the plane's normal.
    Lifts {
        /// 1 if greater values are along the normal, else -1.
        sign: f64,
    },
    /// Turns everything it carries, which is all of link 2, about an axis along the plane's normal.
    Turns {
        /// Position of the axis, in the frame of link 2.
        axis: Point,
    },
    /// Something that is not judged.
    Unjudged {
        /// The reason: a clause whose subject is the joint.
        why: String,
    },
}

/// A joint that the planner holds still.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeldJoint {
    /// Name in the URDF.
    pub name: String,
    /// Value at which it is held, radians or metres.
    pub value: f64,
    /// Effect of its motion.
    pub effect: HeldEffect,
    /// The URDF links that it moves.
    pub bodies: Vec<String>,
}

/// A motion of a joint that the planner holds still.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldMotion {
    /// The joint.
    pub joint: HeldJoint,
    /// Its values as the first coordinate, at the samples of the arm's motion.
    pub values: Recording,
}
