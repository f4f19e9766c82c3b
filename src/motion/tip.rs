//! A top speed of the tip.

use crate::model::{Arm, JointType};
use crate::space::Configuration;

/// Share of its limit that the tip's speed may lose, because it is bounded part by part: curves are cut so finely.
pub(super) const TIP_STEP: f64 = 0.01;

/// Greatest speed of an arm's tip over the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipSpeed<'a> {
    /// The arm whose tip it is.
    pub arm: &'a Arm,
    /// Metres a second, positive.
    pub speed: f64,
}

/// A part of a curve `q(s)` with a constant second derivative: all of it that is no farther than `half` from `middle`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Part {
    /// The configuration in the middle.
    pub(super) middle: Configuration,
    /// First derivative by the parameter there.
    pub(super) slope: Configuration,
    /// Second derivative by the parameter.
    pub(super) bend: Configuration,
    /// Half the range of the parameter.
    pub(super) half: f64,
}

impl TipSpeed<'_> {
    /// By how much the magnitude of the tip's derivative may be overestimated on a part, metres by the parameter.
    pub(super) fn slack(&self, part: &Part) -> f64 {
        self.change(part) * part.half
    }

    /// A speed of the parameter at which the tip keeps its limit all over the part. The tip's way by the parameter has the
    /// derivative `J q'`, which changes no faster than [`TipSpeed::change`].
    pub(super) fn allowed(&self, part: &Part) -> f64 {
        let [first, second] = self.arm.jacobian(1, self.arm.tip, part.middle);
        let way = (first * part.slope[0] + second * part.slope[1]).norm();
        self.speed / (way + self.slack(part))
    }

    /// Greatest magnitude of the second derivative of the tip's place by the parameter.
    fn change(&self, part: &Part) -> f64 {
        use JointType::{Prismatic, Revolute};
        let arm = self.arm;
        let [w1, w2] = [0, 1].map(|k| part.slope[k].abs() + part.bend[k].abs() * part.half);
        let [b1, b2] = [part.bend[0].abs(), part.bend[1].abs()];
        let tip = arm.tip.coords;
        match (arm.joints[0].joint_type, arm.joints[1].joint_type) {
            (Revolute { sign: s1 }, Revolute { sign: s2 }) => {
                // What link 2 turns by.
                let turn = |rate: Configuration| (s1 * rate[0] + s2 * rate[1]).abs();
                let w = turn(part.slope) + turn(part.bend) * part.half;
                arm.offset.norm() * (w1 * w1 + b1) + tip.norm() * (w * w + turn(part.bend))
            }
            (Revolute { .. }, Prismatic { direction }) => {
                let radius = (arm.offset + direction * part.middle[1] + tip).norm() + w2 * part.half;
                radius * (w1 * w1 + b1) + 2.0 * w1 * w2 + b2
            }
            (Prismatic { .. }, Revolute { .. }) => b1 + tip.norm() * (w2 * w2 + b2),
            (Prismatic { .. }, Prismatic { .. }) => b1 + b2,
        }
    }
}
