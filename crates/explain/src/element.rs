//! What can stand in a motion's way.

use cplan_core::model::{Arm, Scene};
use cplan_core::space::JointRange;
use serde::Serialize;
use std::collections::BTreeSet;

/// An end of a joint's range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// The least value.
    Lower,
    /// The greatest value.
    Upper,
}

/// What can stand in a motion's way: an obstacle, a link of the robot, a joint's limit, or the clearance to keep.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum Element {
    /// An obstacle.
    Obstacle {
        /// Into the workspace's obstacles.
        number: usize,
    },
    /// A link of the robot that stands still.
    Link {
        /// That of its first layer, as in [`cplan_core::model::Pair::obstacle`].
        number: usize,
    },
    /// One end of a joint's range. Without it joint values stay what they are: a goal a whole turn off is another one.
    Limit {
        /// 0 or 1.
        joint: usize,
        /// Which end.
        side: Side,
    },
    /// The distance to keep.
    Clearance,
}

impl Element {
    /// All that a scene has: finite limits, a clearance above 0, and obstacles and links that something can meet, in the order of the files.
    #[must_use]
    pub fn all(scene: &Scene) -> Vec<Self> {
        let limits = (0..2).filter(|&joint| !scene.arm().joints[joint].range.is_circle());
        let mut all: Vec<Self> =
            limits.flat_map(|joint| [Side::Lower, Side::Upper].map(|side| Self::Limit { joint, side })).collect();
        all.extend((scene.workspace().clearance > 0.0).then_some(Self::Clearance));
        let met: BTreeSet<usize> = scene.pairs().iter().map(|pair| scene.first_layer(pair.obstacle)).collect();
        let links = scene.self_obstacles();
        let element = |number| if links.contains(&number) { Self::Link { number } } else { Self::Obstacle { number } };
        all.extend(met.into_iter().map(element));
        all
    }

    /// The number of the obstacle or link, if it is one.
    #[must_use]
    pub fn obstacle(self) -> Option<usize> {
        match self {
            Self::Obstacle { number } | Self::Link { number } => Some(number),
            Self::Limit { .. } | Self::Clearance => None,
        }
    }

    /// It in words: `obstacle "shelf"`.
    #[must_use]
    pub fn describe(self, scene: &Scene) -> String {
        match self {
            Self::Obstacle { number } | Self::Link { number } => scene.describe_obstacle(number),
            Self::Limit { joint, side } => {
                let which = if side == Side::Lower { "lower" } else { "upper" };
                format!("the {which} limit of joint \"{}\"", scene.arm().joints[joint].name)
            }
            Self::Clearance => format!("the clearance of {} m", scene.workspace().clearance),
        }
    }

    /// The unit of what it is changed by.
    #[must_use]
    pub fn unit(self, arm: &Arm) -> &'static str {
        if let Self::Limit { joint, .. } = self { arm.joints[joint].unit() } else { "m" }
    }
}

/// A range with one end moved outwards.
pub(super) fn widened(range: JointRange, side: Side, by: f64) -> JointRange {
    match (range, side) {
        (JointRange::Circle, _) => range,
        (JointRange::Interval { lower, upper }, Side::Lower) => JointRange::Interval { lower: lower - by, upper },
        (JointRange::Interval { lower, upper }, Side::Upper) => JointRange::Interval { lower, upper: upper + by },
    }
}
