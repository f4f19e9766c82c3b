//! Limits of a motion.

use super::sample::Trajectory;
use super::tip::TipSpeed;
use super::torque::TorqueLimit;
use cplan_model::space::Configuration;
use cplan_model::{Arm, Joint, Motors};
use nalgebra::Vector3;

/// Number of times that torque limits are reduced because torques exceed the efforts between the positions at which they are
/// limited.
pub(super) const MAX_TORQUE_ROUNDS: usize = 6;

/// Limits of a motion, in radians or metres and seconds. All are positive. Joints are ordered from base to tip.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Limits<'a> {
    /// Greatest speed of each joint.
    pub velocity: [f64; 2],
    /// Greatest acceleration of each joint.
    pub acceleration: [f64; 2],
    /// Greatest jerk of each joint; `None` for a joint without a limit.
    pub jerk: [Option<f64>; 2],
    /// Greatest speed of the tip; `None` for no limit.
    pub tip: Option<TipSpeed<'a>>,
    /// Greatest torques of the joints; `None` for no limits.
    pub torque: Option<TorqueLimit<'a>>,
    /// Limits of a wrist that turns along the path; `None` without one. Motions with limited jerks ignore them.
    pub wrist: Option<WristLimit<'a>>,
    /// Limits of a sum of both joint values; `None` for no limits.
    pub sum: Option<SumLimit>,
}

/// Limits of the sum `ratio q1 + q2`, the angle of an elbow's motor on the base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SumLimit {
    /// Factor of joint 1 in the sum.
    pub ratio: f64,
    /// Greatest speed of the sum; infinite for no limit.
    pub velocity: f64,
    /// Greatest acceleration of the sum; infinite for no limit.
    pub acceleration: f64,
    /// Greatest jerk of the sum; `None` for no limit.
    pub jerk: Option<f64>,
}

/// Values of both joints and of the wrist's joint, or their rates; 0 for the wrist's joint if the arm has none.
pub(super) type Axes = Vector3<f64>;

/// An axis of a motion: joint 1, joint 2, the wrist's joint, or the sum of both joint values.
#[derive(Debug, Clone, Copy)]
pub(super) struct LimitedAxis {
    /// Index of the joint, or for the sum the factor of joint 1 as the error.
    axis: Result<usize, f64>,
    pub velocity: f64,
    pub acceleration: f64,
    pub jerk: Option<f64>,
}

impl LimitedAxis {
    /// Returns the component of a vector along the axis.
    pub fn component(&self, vector: Axes) -> f64 {
        match self.axis {
            Ok(joint) => vector[joint],
            Err(ratio) => ratio * vector[0] + vector[1],
        }
    }

    /// Returns the greatest magnitude along the axis, given the magnitudes of the joints' components.
    pub fn greatest(&self, magnitudes: Axes) -> f64 {
        match self.axis {
            Ok(joint) => magnitudes[joint],
            Err(ratio) => ratio.abs() * magnitudes[0] + magnitudes[1],
        }
    }

    /// Returns the index of the joint; `None` for the sum.
    pub fn joint(&self) -> Option<usize> {
        self.axis.ok()
    }
}

/// A wrist that turns while the arm moves along a path, and its limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WristLimit<'a> {
    /// Value of the wrist's joint at each waypoint of the path, radians. It is linear along a straight leg, cubic along a curved
    /// one, and quadratic along a blend.
    pub values: &'a [f64],
    /// Derivatives of this value by the parameter at both ends of each leg. Those of straight legs are not used.
    pub slopes: &'a [[f64; 2]],
    /// Top speed, radians per second, positive.
    pub velocity: f64,
    /// Greatest acceleration, radians per second squared, positive.
    pub acceleration: f64,
}

impl From<&[Joint; 2]> for Limits<'_> {
    /// Takes the joints' own limits, without limits on the tip or on torques.
    fn from(joints: &[Joint; 2]) -> Self {
        Self {
            velocity: joints.each_ref().map(|joint| joint.velocity),
            acceleration: joints.each_ref().map(|joint| joint.acceleration),
            jerk: joints.each_ref().map(|joint| joint.jerk),
            ..Self::default()
        }
    }
}

impl From<&Arm> for Limits<'_> {
    /// Takes the limits of the joints and of their motors, without limits on the tip or on torques.
    fn from(arm: &Arm) -> Self {
        let is_limited =
            |motors: &Motors| motors.velocity.is_some() || motors.acceleration.is_some() || motors.jerk.is_some();
        let sum = arm.motors.filter(is_limited).map(|motors| SumLimit {
            ratio: motors.ratio,
            velocity: motors.velocity.unwrap_or(f64::INFINITY),
            acceleration: motors.acceleration.unwrap_or(f64::INFINITY),
            jerk: motors.jerk,
        });
        Self { sum, ..Self::from(&arm.joints) }
    }
}

impl Limits<'_> {
    /// Returns limits for motions at a share of the full speed. A motion within the full limits that is slowed down to this share
    /// is within them. Torques keep their full limits, because gravity does not change.
    #[must_use]
    pub fn scaled(self, share: f64) -> Self {
        Self {
            velocity: self.velocity.map(|v| v * share),
            acceleration: self.acceleration.map(|a| a * share * share),
            jerk: self.jerk.map(|jerk| jerk.map(|j| j * share * share * share)),
            tip: self.tip.map(|tip| TipSpeed { speed: tip.speed * share, ..tip }),
            torque: self.torque,
            wrist: self.wrist.map(|wrist| WristLimit {
                velocity: wrist.velocity * share,
                acceleration: wrist.acceleration * share * share,
                ..wrist
            }),
            sum: self.sum.map(|sum| SumLimit {
                velocity: sum.velocity * share,
                acceleration: sum.acceleration * share * share,
                jerk: sum.jerk.map(|jerk| jerk * share * share * share),
                ..sum
            }),
        }
    }

    /// Iterates over the joints, and the sum of their values if it is limited.
    pub(super) fn axes(&self) -> impl Iterator<Item = LimitedAxis> + use<> {
        let Self { velocity, acceleration, jerk, sum, wrist, .. } = *self;
        let joint = move |k: usize| LimitedAxis {
            axis: Ok(k),
            velocity: velocity[k],
            acceleration: acceleration[k],
            jerk: jerk[k],
        };
        let of_sum = |sum: SumLimit| LimitedAxis {
            axis: Err(sum.ratio),
            velocity: sum.velocity,
            acceleration: sum.acceleration,
            jerk: sum.jerk,
        };
        let of_wrist = |WristLimit { velocity, acceleration, .. }: WristLimit| LimitedAxis {
            axis: Ok(2),
            velocity,
            acceleration,
            jerk: None,
        };
        (0..2).map(joint).chain(sum.map(of_sum)).chain(wrist.map(of_wrist))
    }

    /// Returns the values of all axes at a waypoint with these joint values.
    pub(super) fn axes_at(&self, waypoint: usize, q: Configuration) -> Axes {
        q.push(self.wrist.map_or(0.0, |wrist| wrist.values[waypoint]))
    }

    /// Returns the derivatives of all axes by the parameter at both ends of a curved leg.
    pub(super) fn leg_directions(&self, leg: usize, tangents: [Configuration; 2]) -> [Axes; 2] {
        [0, 1].map(|end| tangents[end].push(self.wrist.map_or(0.0, |wrist| wrist.slopes[leg][end])))
    }

    /// Returns the value of the wrist's joint at a distance, in joint space, from waypoint `from` towards a neighbouring one,
    /// which is `length` away; 0 without a wrist.
    pub(super) fn wrist_at(&self, from: usize, toward: usize, distance: f64, length: f64) -> f64 {
        self.wrist.map_or(0.0, |wrist| {
            let [a, b] = [wrist.values[from], wrist.values[toward]];
            a + (b - a) * (distance / length)
        })
    }

    /// Returns a trajectory whose torques are within the efforts. `drive` computes trajectories within limits. As long as torques
    /// between two samples exceed the efforts, it is called again with reduced efforts.
    pub(super) fn within_torque(&self, drive: impl Fn(&Self) -> Option<Trajectory>) -> Option<Trajectory> {
        let mut used = *self;
        for _ in 0..MAX_TORQUE_ROUNDS {
            let trajectory = drive(&used)?;
            match (self.torque.and_then(|limit| limit.excess(&trajectory.pieces())), &mut used.torque) {
                (Some(excess), Some(used)) => used.share /= excess,
                _ => return Some(trajectory),
            }
        }
        None
    }

    /// Returns the limits with a share of the tip's speed.
    pub(super) fn with_tip_share(self, share: f64) -> Self {
        Self { tip: self.tip.map(|tip| TipSpeed { speed: tip.speed * share, ..tip }), ..self }
    }

    /// Returns the share of the tip's speed that a leg of the path allows.
    pub(super) fn tip_share(&self, leg: usize) -> f64 {
        self.tip.map_or(1.0, |tip| tip.share_of_leg(leg))
    }

    /// Returns the limits without those on jerks.
    pub(super) fn without_jerks(self) -> Self {
        Self { jerk: [None; 2], sum: self.sum.map(|sum| SumLimit { jerk: None, ..sum }), ..self }
    }

    /// Iterates over the times in which a limited jerk builds up the full acceleration: one for each joint with such a limit, and
    /// one for the sum if it has one.
    pub(super) fn growths(&self) -> impl Iterator<Item = f64> + use<> {
        let of_joints = self.sum.map_or(0.0, |sum| sum.ratio.abs() * self.acceleration[0] + self.acceleration[1]);
        self.axes().filter_map(move |axis| {
            let acceleration =
                if axis.joint().is_some() { axis.acceleration } else { axis.acceleration.min(of_joints) };
            Some(acceleration / axis.jerk?)
        })
    }

    /// Returns the greatest time in which a limited jerk builds up the full acceleration; 0 without limits on jerks.
    pub(super) fn longest_growth(&self) -> f64 {
        self.growths().fold(0.0, f64::max)
    }

    /// Returns the greatest distance, of both joints, that a joint moves at top speed while its jerk builds up the full
    /// acceleration.
    pub(super) fn reversal(&self) -> f64 {
        let of_joint = |k: usize| self.jerk[k].map_or(0.0, |j| self.acceleration[k] / j * self.velocity[k]);
        let is_limited = self.sum.is_some_and(|sum| sum.jerk.is_some());
        let of_sum = if is_limited { self.longest_growth() * self.velocity[0].max(self.velocity[1]) } else { 0.0 };
        of_joint(0).max(of_joint(1)).max(of_sum)
    }

    /// Returns the greatest distance, of both joints, that a joint moves until it reaches its top speed.
    pub(super) fn ramp(&self) -> f64 {
        let torque = self.torque.map_or([f64::INFINITY; 2], |torque| torque.accelerations());
        let acceleration = |k: usize| self.acceleration[k].min(torque[k]);
        (0..2).map(|k| self.velocity[k] * self.velocity[k] / (2.0 * acceleration(k))).fold(0.0, f64::max)
    }

    /// Returns the greatest speed along a unit direction. A joint that does not move sets no limit.
    pub(super) fn speed_along(&self, direction: Axes) -> f64 {
        self.limit_along(direction, |axis| axis.velocity)
    }

    /// Returns the greatest acceleration along a unit direction.
    pub(super) fn acceleration_along(&self, direction: Axes) -> f64 {
        self.limit_along(direction, |axis| axis.acceleration)
    }

    /// Returns the greatest jerk along a unit direction; infinite if no moving joint has a limit.
    pub(super) fn jerk_along(&self, direction: Axes) -> f64 {
        self.limit_along(direction, |axis| axis.jerk.unwrap_or(f64::INFINITY))
    }

    fn limit_along(&self, direction: Axes, limit: impl Fn(&LimitedAxis) -> f64) -> f64 {
        self.axes().map(|axis| limit(&axis) / axis.component(direction).abs()).fold(f64::INFINITY, f64::min)
    }

    /// Returns true if a motion must stop at every corner, because a jerk of a joint or of the sum is limited: at the start of a
    /// blend, the acceleration would jump.
    pub fn stops_at_corners(&self) -> bool {
        self.jerk.iter().any(Option::is_some) || self.sum.is_some_and(|sum| sum.jerk.is_some())
    }
}
