//! All movable joints of a robot, for file formats that must list every joint.

use super::{Stroke, ToolJoint};
use serde::{Deserialize, Serialize};

/// The source that determines a joint's value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Driver {
    /// The planner. The joint is one of the two planned joints, with the index 0 or 1.
    Planned(usize),
    /// Nothing. The joint stays at this value, radians or metres.
    Held(f64),
    /// The stroke. The joint lowers the tool at picks and places.
    Stroke,
    /// The wrist. The joint keeps the load's orientation, or turns the load.
    Wrist,
}

/// A movable joint. Its value is `factor * x + offset`, where `x` is the value of its driver. A mimic joint has the driver of the
/// joint that it follows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotJoint {
    /// Name in the URDF.
    pub name: String,
    /// Source of the value `x`.
    pub driver: Driver,
    /// Factor: for a mimic joint, the one that results from the chain of joints that it follows; otherwise 1.
    pub factor: f64,
    /// Offset, radians or metres: for a mimic joint, the one that results from the chain of joints that it follows; otherwise 0.
    pub offset: f64,
    /// True if the joint slides, so that its values are metres.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub slides: bool,
}

impl RobotJoint {
    /// Returns a joint that turns and has the value of its driver.
    pub fn driven(name: String, driver: Driver) -> Self {
        Self { name, driver, factor: 1.0, offset: 0.0, slides: false }
    }
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

/// Values of the drivers of a robot's joints at a time, or the rates of these values.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Drives {
    /// Values of the two planned joints, base to tip.
    pub planned: [f64; 2],
    /// Value of the joint that executes strokes.
    pub stroke: f64,
    /// Value of the wrist's joint.
    pub wrist: f64,
}

impl RobotJoints {
    /// Returns the joints of a robot that has only the two planned joints, with these names.
    pub fn only_planned(names: &[String; 2]) -> Self {
        let joint = |k: usize| RobotJoint::driven(names[k].clone(), Driver::Planned(k));
        Self { joints: vec![joint(0), joint(1)], ..Self::default() }
    }

    /// Iterates over the joints' names, in the order of the URDF.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.joints.iter().map(|joint| joint.name.as_str())
    }

    /// Returns the values of the drivers with the stroke and the wrist at rest.
    pub fn at_rest(&self, planned: [f64; 2]) -> Drives {
        let rest = |joint: Option<&ToolJoint>| joint.map_or(0.0, |joint| joint.rest);
        Drives {
            planned,
            stroke: rest(self.stroke.as_ref().map(|stroke| &stroke.joint)),
            wrist: rest(self.wrist.as_ref()),
        }
    }

    /// Returns the values of all joints, radians or metres.
    pub fn values(&self, drives: &Drives) -> Vec<f64> {
        let value = |joint: &RobotJoint| joint.factor * joint.driver.value(drives) + joint.offset;
        self.joints.iter().map(value).collect()
    }

    /// Returns the time derivatives of all joints' values, given those of the drivers' values, for derivatives of any order.
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
