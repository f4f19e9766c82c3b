//! Motors of the joints.

use crate::space::{Configuration, JointSumRange};
use serde::{Deserialize, Serialize};

/// The motors of an arm whose two joints turn. With joint values `q1` and `q2`, the shaft angles are
///
/// ```text
/// gear[0] q1 + zero[0]
/// gear[1] (ratio q1 + q2) + zero[1]
/// ```
///
/// `ratio` is 0 if the elbow's motor is mounted on link 1. It is 1 if the motor is mounted on the base and a belt between
/// equal pulleys leads to the elbow: the motor's angle then is that of link 2 against the base. The sum
/// `ratio q1 + q2` is the *joint sum*.
///
/// For the torques `tau1` and `tau2` of the joints, the shafts need the torques `(tau1 - ratio tau2) / gear[0]` and
/// `tau2 / gear[1]`.
///
/// Some limits of motors are stored as limits of joints, and not repeated here: those of the first motor's motion, that
/// of the second motor's torque, and all limits if `ratio` is 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Motors {
    /// Turns of the elbow's motor, without its gear, for each turn of joint 1.
    pub ratio: f64,
    /// Turns of each motor's shaft per turn of its output. Negative if the two turn in opposite directions.
    pub gear: [f64; 2],
    /// Angles of both shafts at joint values of zero, radians.
    pub zero: [f64; 2],
    /// Range of the joint sum, radians; `None` without such a limit.
    pub range: Option<[f64; 2]>,
    /// Greatest speed of the joint sum, rad/s; `None` without such a limit.
    pub velocity: Option<f64>,
    /// Greatest acceleration of the joint sum, rad/s2; `None` without such a limit.
    pub acceleration: Option<f64>,
    /// Greatest jerk of the joint sum, rad/s3; `None` without such a limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub jerk: Option<f64>,
    /// Greatest magnitude of `tau1 - ratio tau2`, the torque of the first motor without its gear, N m; `None` without such
    /// a limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub effort: Option<f64>,
}

impl Motors {
    /// Returns motors without limits, gears and zeros.
    pub fn with_ratio(ratio: f64) -> Self {
        let (gear, zero) = ([1.0; 2], [0.0; 2]);
        Self { ratio, gear, zero, range: None, velocity: None, acceleration: None, jerk: None, effort: None }
    }

    /// Returns the angles of both shafts, radians.
    pub fn angles(&self, q: Configuration) -> [f64; 2] {
        let turned = self.rates(q);
        [0, 1].map(|k| turned[k] + self.zero[k])
    }

    /// Returns the derivatives of the shafts' angles, given those of the joint values.
    pub fn rates(&self, rates: Configuration) -> [f64; 2] {
        [self.gear[0] * rates[0], self.gear[1] * self.joint_sum(rates)]
    }

    /// Returns `ratio q1 + q2`, of joint values or of their derivatives.
    pub fn joint_sum(&self, q: Configuration) -> f64 {
        self.ratio * q[0] + q[1]
    }

    /// Returns the range of the joint sum.
    pub(crate) fn sum_range(&self) -> Option<JointSumRange> {
        self.range.map(|[lower, upper]| JointSumRange { ratio: self.ratio, lower, upper })
    }
}
