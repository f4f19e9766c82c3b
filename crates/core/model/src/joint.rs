//! One joint of the planar arm.

use crate::space::JointRange;
use cplan_geometry::Vector;
use cplan_text::format_distinct;
use serde::{Deserialize, Serialize};

/// Top speed of a revolute joint if none is given, rad/s.
pub const DEFAULT_TURNING_SPEED: f64 = 1.0;

/// Top speed of a prismatic joint if none is given, m/s.
pub const DEFAULT_SLIDING_SPEED: f64 = 0.25;

/// Time in which a joint reaches its top speed if no acceleration is given, seconds. The assumed acceleration follows
/// from it.
pub const DEFAULT_TIME_TO_TOP_SPEED: f64 = 0.25;

/// Returns the acceleration assumed for a joint without a limit on it. It reaches `velocity`, the joint's top speed,
/// in [`DEFAULT_TIME_TO_TOP_SPEED`].
pub fn assumed_acceleration(velocity: f64) -> f64 {
    (velocity / DEFAULT_TIME_TO_TOP_SPEED).min(f64::MAX)
}

/// A joint's kind of motion in the plane.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum JointType {
    /// Rotation about an axis normal to the plane.
    Revolute {
        /// +1 if positive joint values turn counter-clockwise in plane coordinates, otherwise -1.
        sign: f64,
    },
    /// Translation.
    Prismatic {
        /// Direction in plane coordinates at the zero configuration, of unit length.
        direction: Vector,
    },
}

impl JointType {
    /// Returns true if the joint is revolute.
    pub fn is_revolute(self) -> bool {
        matches!(self, JointType::Revolute { .. })
    }

    /// Returns the angle by which the link turns in the plane per unit of the joint: 1, -1, or 0 for a prismatic joint.
    pub fn turn(self) -> f64 {
        match self {
            JointType::Revolute { sign } => sign,
            JointType::Prismatic { .. } => 0.0,
        }
    }

    /// Returns an upper bound on the motion, per unit of the joint, of a shape that is within `reach` of its axis: metres
    /// per radian or metre.
    pub fn lever(self, reach: f64) -> f64 {
        if self.is_revolute() { reach } else { 1.0 }
    }
}

/// A joint: its motion, range and limits. Values are in radians for a revolute joint and metres for a prismatic one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Joint {
    /// Name in the URDF.
    pub name: String,
    /// The kind of motion.
    pub joint_type: JointType,
    /// The values that the joint can take.
    pub range: JointRange,
    /// Top speed, rad/s or m/s; positive.
    pub velocity: f64,
    /// Greatest acceleration, rad/s2 or m/s2; positive.
    pub acceleration: f64,
    /// Greatest jerk, rad/s3 or m/s3; positive. `None` if the acceleration may jump.
    pub jerk: Option<f64>,
}

impl Joint {
    /// Creates a revolute joint that turns counter-clockwise from `lower` to `upper`, radians, at 1 rad/s.
    /// [`Joint::at_most`] changes the speed.
    pub fn turning(name: &str, lower: f64, upper: f64) -> Self {
        Self::moving(
            name,
            JointType::Revolute { sign: 1.0 },
            JointRange::Interval { lower, upper },
            DEFAULT_TURNING_SPEED,
        )
    }

    /// Creates a revolute joint without limits, which turns counter-clockwise at 1 rad/s.
    pub fn continuous(name: &str) -> Self {
        Self::moving(name, JointType::Revolute { sign: 1.0 }, JointRange::Circle, DEFAULT_TURNING_SPEED)
    }

    /// Creates a prismatic joint from `lower` to `upper`, metres, along a direction of length 1, at 0.25 m/s.
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

    /// Replaces the jerk limits of both joints; changes nothing if `jerks` is `None`.
    pub fn override_jerks(joints: &mut [Joint; 2], jerks: Option<[Option<f64>; 2]>) {
        for (joint, jerk) in joints.iter_mut().zip(jerks.into_iter().flatten()) {
            joint.jerk = jerk;
        }
    }

    /// Returns the unit of the joint's value: `rad` or `m`.
    pub fn unit(&self) -> &'static str {
        if self.joint_type.is_revolute() { "rad" } else { "m" }
    }

    /// Returns the unit of the joint's effort: `N m` or `N`.
    pub fn effort_unit(&self) -> &'static str {
        if self.joint_type.is_revolute() { "N m" } else { "N" }
    }

    /// Returns a value with its unit, angles in degrees and radians: `20.00 deg (0.3491 rad)`.
    pub fn format_value(&self, value: f64) -> String {
        let [shown] = self.format_distinct([value]);
        shown
    }

    /// States that a value is outside the range: `joint "elbow" would be at 20.00 deg (0.3491 rad), outside its limits`, with
    /// these limits.
    pub fn explain_outside(&self, value: f64) -> String {
        let limits = match self.range {
            JointRange::Circle => String::new(),
            JointRange::Interval { lower, upper } => {
                format!(" from {} to {}", self.format_value(lower), self.format_value(upper))
            }
        };
        format!("joint \"{}\" would be at {}, outside its limits{limits}", self.name, self.format_value(value))
    }

    /// Returns several values with their units, with enough digits that different values look different.
    pub fn format_distinct<const N: usize>(&self, values: [f64; N]) -> [String; N] {
        let mut texts = format_distinct(values, 4);
        if self.joint_type.is_revolute() {
            let degrees = format_distinct(values.map(f64::to_degrees), 2);
            texts.iter_mut().zip(degrees).for_each(|(text, degrees)| *text = format!("{degrees} deg ({text} rad)"));
        } else {
            texts.iter_mut().for_each(|text| *text += " m");
        }
        texts
    }
}
