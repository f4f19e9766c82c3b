//! Elements of a world that can block a motion.

use cplan_model::space::JointRange;
use cplan_model::{Arm, Scene};
use cplan_text::chosen_length;
use serde::Serialize;
use std::collections::BTreeSet;

/// An end of a joint's range: the least or the greatest value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// The lower end.
    Lower,
    /// The upper end.
    Upper,
}

/// Something that can block a motion: an obstacle, a link of the robot, a limit of a joint or a motor, or the required
/// clearance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum Element {
    /// An obstacle.
    Obstacle {
        /// Index into the workspace's obstacles.
        number: usize,
    },
    /// A static link of the robot.
    Link {
        /// Index of its first layer, as in [`cplan_model::Pair::obstacle`].
        number: usize,
    },
    /// One end of a joint's range. Even without limits, whole turns of a revolute joint stay different: a goal that is a whole
    /// turn away remains another goal.
    Limit {
        /// Index of the joint, 0 or 1.
        joint: usize,
        /// The end of the range.
        side: Side,
    },
    /// The range of the elbow's motor, if it limits the sum of both joint values.
    Motor,
    /// The required clearance.
    Clearance,
}

impl Element {
    /// Returns all elements of a scene: finite limits, the range of a motor, a clearance above 0, and the obstacles and links
    /// that the arm can hit, in the order of the files.
    pub fn all(scene: &Scene) -> Vec<Self> {
        let limits = (0..2).filter(|&joint| !scene.arm().joints[joint].range.is_circle());
        let mut all: Vec<Self> =
            limits.flat_map(|joint| [Side::Lower, Side::Upper].map(|side| Self::Limit { joint, side })).collect();
        all.extend(scene.arm().topology().sum.map(|_| Self::Motor));
        all.extend((scene.workspace().greatest_clearance() > 0.0).then_some(Self::Clearance));
        let met: BTreeSet<usize> = scene.pairs().iter().map(|pair| scene.first_layer(pair.obstacle)).collect();
        let links = scene.self_obstacles();
        let element = |number| if links.contains(&number) { Self::Link { number } } else { Self::Obstacle { number } };
        all.extend(met.into_iter().map(element));
        all
    }

    /// Returns the index of the obstacle or link; `None` for other elements.
    pub fn obstacle(self) -> Option<usize> {
        match self {
            Self::Obstacle { number } | Self::Link { number } => Some(number),
            Self::Limit { .. } | Self::Motor | Self::Clearance => None,
        }
    }

    /// Describes the element, for example as `obstacle "shelf"`.
    pub fn describe(self, scene: &Scene) -> String {
        match self {
            Self::Obstacle { number } | Self::Link { number } => scene.describe_obstacle(number),
            Self::Limit { joint, side } => {
                let which = if side == Side::Lower { "lower" } else { "upper" };
                format!("the {which} limit of joint \"{}\"", scene.arm().joints[joint].name)
            }
            Self::Motor => "the range of the elbow's motor".into(),
            Self::Clearance => format!("the clearance of {}", chosen_length(scene.workspace().greatest_clearance())),
        }
    }

    /// Returns the unit in which changes of the element are measured.
    pub fn unit(self, arm: &Arm) -> &'static str {
        match self {
            Self::Limit { joint, .. } => arm.joints[joint].unit(),
            Self::Motor => "rad",
            Self::Obstacle { .. } | Self::Link { .. } | Self::Clearance => "m",
        }
    }
}

/// Returns a range with one end moved outwards.
pub(crate) fn widened(range: JointRange, side: Side, by: f64) -> JointRange {
    match (range, side) {
        (JointRange::Circle, _) => range,
        (JointRange::Interval { lower, upper }, Side::Lower) => JointRange::Interval { lower: lower - by, upper },
        (JointRange::Interval { lower, upper }, Side::Upper) => JointRange::Interval { lower, upper: upper + by },
    }
}
