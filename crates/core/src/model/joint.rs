//! One joint of the planar arm.

use crate::space::JointRange;
use cplan_geometry::Vector;
use cplan_text::format_distinct;
use serde::{Deserialize, Serialize};

/// Default top speed of a revolute joint, rad/s.
pub const DEFAULT_TURNING_SPEED: f64 = 1.0;

/// Default top speed of a prismatic joint, m/s.
pub const DEFAULT_SLIDING_SPEED: f64 = 0.25;

/// Default time to top speed, seconds, for a joint without a limit on the acceleration.
pub const DEFAULT_TIME_TO_TOP_SPEED: f64 = 0.25;

/// Returns the assumed greatest acceleration of a joint without one, from its top speed.
#[must_use]
pub fn assumed_acceleration(velocity: f64) -> f64 {
    (velocity / DEFAULT_TIME_TO_TOP_SPEED).min(f64::MAX)
}

/// A joint's kind of motion in the plane.
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
        /// Direction, of unit length.
        direction: Vector,
    },
}

impl JointType {
    /// Returns true if the joint turns.
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
    /// The kind of motion.
    pub joint_type: JointType,
    /// The values it can take.
    pub range: JointRange,
    /// Top speed, per second; positive.
    pub velocity: f64,
    /// Greatest acceleration, per second squared; positive.
    pub acceleration: f64,
    /// Greatest jerk, per second cubed; positive. `None` if the acceleration may jump.
    pub jerk: Option<f64>,
}

impl Joint {
    /// Creates a revolute joint that turns counter-clockwise from `lower` to `upper`, radians, at 1 rad/s.
    /// [`Joint::at_most`] changes the speed.
    #[must_use]
    pub fn turning(name: &str, lower: f64, upper: f64) -> Self {
        Self::moving(
            name,
            JointType::Revolute { sign: 1.0 },
            JointRange::Interval { lower, upper },
            DEFAULT_TURNING_SPEED,
        )
    }

    /// Returns a joint that turns counter-clockwise without end.
    #[must_use]
    pub fn continuous(name: &str) -> Self {
        Self::moving(name, JointType::Revolute { sign: 1.0 }, JointRange::Circle, DEFAULT_TURNING_SPEED)
    }

    /// Creates a prismatic joint along a direction of length 1, from `lower` to `upper`, metres, at 0.25 m/s.
    #[must_use]
    pub fn sliding(name: &str, direction: Vector, lower: f64, upper: f64) -> Self {
        Self::moving(
            name,
            JointType::Prismatic { direction },
            JointRange::Interval { lower, upper },
            DEFAULT_SLIDING_SPEED,
        )
    }

    fn moving(name: &str, joint_type: JointType, range: JointRange, velocity: f64) -> Self {
        let acceleration = assumed_acceleration(velocity);
        Self { name: name.into(), joint_type, range, velocity, acceleration, jerk: None }
    }

    /// Returns the same joint with this top speed and greatest acceleration, in radians or metres and seconds.
    #[must_use]
    pub fn at_most(self, velocity: f64, acceleration: f64) -> Self {
        Self { velocity, acceleration, ..self }
    }

    /// Sets other jerk limits of joints, if any are given.
    pub fn override_jerks(joints: &mut [Joint; 2], jerks: Option<[Option<f64>; 2]>) {
        for (joint, jerk) in joints.iter_mut().zip(jerks.into_iter().flatten()) {
            joint.jerk = jerk;
        }
    }

    /// Returns the unit of the joint's value: `rad` or `m`.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        if self.joint_type.is_revolute() { "rad" } else { "m" }
    }

    /// Returns the unit of the joint's effort: `N m` or `N`.
    #[must_use]
    pub fn effort_unit(&self) -> &'static str {
        if self.joint_type.is_revolute() { "N m" } else { "N" }
    }

    /// Returns a value with its unit, angles in both units: `0.3491 rad (20.00 deg)`.
    #[must_use]
    pub fn shown(&self, value: f64) -> String {
        let [shown] = self.format_distinct([value]);
        shown
    }

    /// Returns several values with their units, with enough digits that different values look different.
    #[must_use]
    pub fn format_distinct<const N: usize>(&self, values: [f64; N]) -> [String; N] {
        let mut texts = format_distinct(values, 4);
        if self.joint_type.is_revolute() {
            let degrees = format_distinct(values.map(f64::to_degrees), 2);
            texts.iter_mut().zip(degrees).for_each(|(text, degrees)| *text += &format!(" rad ({degrees} deg)"));
        } else {
            texts.iter_mut().for_each(|text| *text += " m");
        }
        texts
    }
}
