//! Joints beside the two that are planned, and somebody's motion of them.

use super::Recording;
use cplan_geometry::Point;
use serde::{Deserialize, Serialize};

/// What a motion of a joint that is held still would do to the arm.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HeldEffect {
    /// Lifts what it carries along the plane's normal.
    Lifts {
        /// 1 if greater values are along the normal, else -1.
        sign: f64,
    },
    /// Turns what it carries, all of link 2, about an axis along the plane's normal.
    Turns {
        /// Where the axis is, in the frame of link 2.
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
    /// Where it is held, radians or metres.
    pub value: f64,
    /// What its motion would do.
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
