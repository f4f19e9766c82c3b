//! All joints of a robot that can move, for those who have to name each of them.

use super::{Stroke, ToolJoint};
use serde::{Deserialize, Serialize};

/// What sets a joint's value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Driver {
    /// The planner: it is one of the two joints of the arm, 0 or 1.
    Planned(usize),
    /// Nobody: it stays at this value, radians or metres.
    Held(f64),
    /// The stroke that lowers the tool at picks and places.
    Stroke,
    /// The wrist that keeps or turns what is carried.
    Wrist,
}

/// A joint whose value is `factor * x + offset`, where `x` is what its driver says: itself, or the joint that it mimics.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotJoint {
    /// Name in the URDF.
    pub name: String,
    /// What sets `x`.
    pub driver: Driver,
    /// Of a mimic joint, along the whole chain of those that it follows; else 1.
    pub factor: f64,
    /// Likewise; else 0.
    pub offset: f64,
}

/// The joints of a robot that can move, in the order of the URDF.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotJoints {
    /// The joints, in the order of the URDF.
    pub joints: Vec<RobotJoint>,
    /// How the tool is lowered at picks and places.
    pub stroke: Option<Stroke>,
    /// The joint of the wrist.
    pub wrist: Option<ToolJoint>,
}

/// What drives the joints of a robot at a moment; or the rates of it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Drives {
    /// The two planned joints, base to tip.
    pub planned: [f64; 2],
    /// The joint that makes strokes.
    pub stroke: f64,
    /// The wrist's joint.
    pub wrist: f64,
}

impl RobotJoints {
    /// The two planned joints and no other.
    #[must_use]
    pub fn planned(names: &[String; 2]) -> Self {
        let joint =
            |k: usize| RobotJoint { name: names[k].clone(), driver: Driver::Planned(k), factor: 1.0, offset: 0.0 };
        Self { joints: vec![joint(0), joint(1)], ..Self::default() }
    }

    /// The joints' names, in the order of the URDF.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.joints.iter().map(|joint| joint.name.as_str())
    }

    /// What drives them where only the planned joints move.
    #[must_use]
    pub fn at_rest(&self, planned: [f64; 2]) -> Drives {
        let rest = |joint: Option<&ToolJoint>| joint.map_or(0.0, |joint| joint.rest);
        Drives {
            planned,
            stroke: rest(self.stroke.as_ref().map(|stroke| &stroke.joint)),
            wrist: rest(self.wrist.as_ref()),
        }
    }

    /// Their values, radians or metres.
    #[must_use]
    pub fn values(&self, drives: &Drives) -> Vec<f64> {
        let value = |joint: &RobotJoint| joint.factor * joint.driver.value(drives) + joint.offset;
        self.joints.iter().map(value).collect()
    }

    /// Their rates, or those of their rates, from those of what drives them.
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
