//! One joint of the planar arm.

use crate::space::JointRange;
use cplan_geometry::Vector;
use cplan_text::told_apart;
use serde::{Deserialize, Serialize};

/// Top speed of a joint that turns, without one of its own; rad/s.
pub const TURNING_SPEED: f64 = 1.0;

/// The same of one that slides; m/s.
pub const SLIDING_SPEED: f64 = 0.25;

/// Seconds to top speed, without a limit on the acceleration.
pub const TIME_TO_TOP_SPEED: f64 = 0.25;

/// Greatest acceleration of a joint that has none, by its top speed.
#[must_use]
pub fn assumed_acceleration(velocity: f64) -> f64 {
    (velocity / TIME_TO_TOP_SPEED).min(f64::MAX)
}

/// How a joint moves its link in the plane.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum JointType {
    /// Turns. `sign` is +1 when positive joint values turn counter-clockwise in plane coordinates, else -1.
    Revolute {
        /// +1 or -1.
        sign: f64,
    },
    /// Slides along this unit direction, given in plane coordinates at the zero configuration.
    Prismatic {
        /// Of unit length.
        direction: Vector,
    },
}

impl JointType {
    /// Whether the joint turns.
    #[must_use]
    pub fn is_revolute(self) -> bool {
        matches!(self, JointType::Revolute { .. })
    }
}

/// One joint: its motion, range and limits. Radians or metres, and seconds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Joint {
    /// Name in the URDF.
    pub name: String,
    /// How it moves.
    pub joint_type: JointType,
    /// The values it can take.
    pub range: JointRange,
    /// Top speed, per second; positive.
    pub velocity: f64,
    /// Greatest acceleration, per second squared; positive.
    pub acceleration: f64,
    /// Greatest jerk, per second cubed; positive. None: the acceleration may jump.
    pub jerk: Option<f64>,
}

impl Joint {
    /// A joint that turns counter-clockwise from `lower` to `upper`, radians; at 1 rad/s, which [`Joint::at_most`] changes.
    #[must_use]
    pub fn turning(name: &str, lower: f64, upper: f64) -> Self {
        Self::moving(name, JointType::Revolute { sign: 1.0 }, JointRange::Interval { lower, upper }, TURNING_SPEED)
    }

    /// A joint that turns counter-clockwise without end.
    #[must_use]
    pub fn continuous(name: &str) -> Self {
        Self::moving(name, JointType::Revolute { sign: 1.0 }, JointRange::Circle, TURNING_SPEED)
    }

    /// A joint that slides along a direction of length 1, from `lower` to `upper`, metres; at 0.25 m/s.
    #[must_use]
    pub fn sliding(name: &str, direction: Vector, lower: f64, upper: f64) -> Self {
        Self::moving(name, JointType::Prismatic { direction }, JointRange::Interval { lower, upper }, SLIDING_SPEED)
    }

    fn moving(name: &str, joint_type: JointType, range: JointRange, velocity: f64) -> Self {
        let acceleration = assumed_acceleration(velocity);
        Self { name: name.into(), joint_type, range, velocity, acceleration, jerk: None }
    }

    /// The same joint with this top speed and greatest acceleration, radians or metres and seconds.
    #[must_use]
    pub fn at_most(self, velocity: f64, acceleration: f64) -> Self {
        Self { velocity, acceleration, ..self }
    }

    /// Gives joints other limits on their jerk, if any are given.
    pub fn override_jerks(joints: &mut [Joint; 2], jerks: Option<[Option<f64>; 2]>) {
        for (joint, jerk) in joints.iter_mut().zip(jerks.into_iter().flatten()) {
            joint.jerk = jerk;
        }
    }

    /// Unit of the joint's value: `rad` or `m`.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        if self.joint_type.is_revolute() { "rad" } else { "m" }
    }

    /// Unit of what moves it: `N m` or `N`.
    #[must_use]
    pub fn effort_unit(&self) -> &'static str {
        if self.joint_type.is_revolute() { "N m" } else { "N" }
    }

    /// A value with its unit, angles in both units: `0.3491 rad (20.00 deg)`.
    #[must_use]
    pub fn shown(&self, value: f64) -> String {
        let [shown] = self.told_apart([value]);
        shown
    }

    /// The same of several values: those that differ look different.
    #[must_use]
    pub fn told_apart<const N: usize>(&self, values: [f64; N]) -> [String; N] {
        let mut texts = told_apart(values, 4);
        if self.joint_type.is_revolute() {
            let degrees = told_apart(values.map(f64::to_degrees), 2);
            texts.iter_mut().zip(degrees).for_each(|(text, degrees)| *text += &format!(" rad ({degrees} deg)"));
        } else {
            texts.iter_mut().for_each(|text| *text += " m");
        }
        texts
    }
}
