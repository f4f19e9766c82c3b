//! All movable joints of a robot, for formats that must list each of them.

use super::{Stroke, ToolJoint};
use serde::{Deserialize, Serialize};

/// The source of a joint's value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Driver {
    /// The planner: the joint is one of the two joints of the arm, 0 or 1.
    Planned(usize),
    /// Nothing: the joint stays at this value, radians or metres.
    Held(f64),
    /// The stroke, which lowers the tool at picks and places.
    Stroke,
    /// The wrist, which keeps or turns the load.
    Wrist,
}

/// A joint whose value is `factor * x + offset`, where `x` is the value of its driver: the joint itself, or the joint
/// that it mimics.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotJoint {
    /// Name in the URDF.
    pub name: String,
    /// Source of `x`.
    pub driver: Driver,
    /// For a mimic joint: the factor along the whole chain of joints that it follows. Otherwise 1.
    pub factor: f64,
    /// For a mimic joint: the offset along this chain. Otherwise 0.
    pub offset: f64,
}

/// The movable joints of a robot, in the order of the URDF.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotJoints {
    /// The joints, in the order of the URDF.
    pub joints: Vec<RobotJoint>,
    /// The stroke that lowers the tool at picks and places, if there is one.
    pub stroke: Option<Stroke>,
    /// The joint of the wrist, if there is one.
    pub wrist: Option<ToolJoint>,
}

/// The driving values of a robot's joints at a moment, or their rates.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Drives {
    /// The two planned joints, base to tip.
    pub planned: [f64; 2],
    /// The joint that executes strokes.
    pub stroke: f64,
    /// The wrist's joint.
    pub wrist: f64,
}

impl RobotJoints {
    /// Returns the two planned joints alone.
    #[must_use]
    pub fn planned(names: &[String; 2]) -> Self {
        let joint =
            |k: usize| RobotJoint { name: names[k].clone(), driver: Driver::Planned(k), factor: 1.0, offset: 0.0 };
        Self { joints: vec![joint(0), joint(1)], ..Self::default() }
    }

    /// Iterates over the joints' names, in the order of the URDF.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.joints.iter().map(|joint| joint.name.as_str())
    }

    /// Returns the driving values when only the planned joints move.
    #[must_use]
    pub fn at_rest(&self, planned: [f64; 2]) -> Drives {
        let rest = |joint: Option<&ToolJoint>| joint.map_or(0.0, |joint| joint.rest);
        Drives {
            planned,
            stroke: rest(self.stroke.as_ref().map(|stroke| &stroke.joint)),
            wrist: rest(self.wrist.as_ref()),
        }
    }

    /// Returns the joints' values, radians or metres.
    #[must_use]
    pub fn values(&self, drives: &Drives) -> Vec<f64> {
        let value = |joint: &RobotJoint| joint.factor * joint.driver.value(drives) + joint.offset;
        self.joints.iter().map(value).collect()
    }

    /// Returns the joints' rates of any order, given the rates of the driving values.
    #[must_use]
    pub fn rates(&self, drives: &Drives) -> Vec<f64> {
        let rate = |joint: &RobotJoint| match joint.driver {
            Driver::Held(_) => 0.0,
            // Adding 0 turns the minus zero of a joint at rest into zero.
            driver => joint.factor * driver.value(drives) + 0.0,
        };
        self.joints.iter().map(rate).collect()
    }
}

impl Driver {
    fn value(self, drives: &Drives) -> f64 {
        match self {
            Driver::Planned(k) => drives.planned[k],
            Driver::Held(value) => value,
            Driver::Stroke => drives.stroke,
            Driver::Wrist => drives.wrist,
        }
    }
}
