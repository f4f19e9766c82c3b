//! The side of the elbow.

use super::Arm;
use crate::space::Configuration;
use cplan_geometry::{Pose, cross};
use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// Sine of the angle between both links up to which an arm counts as straight or folded, so that its elbow is on both
/// sides. It covers rounding of joint values.
const STRAIGHT_SINE: f64 = 1e-9;

/// The side of an arm's elbow. A straight or folded arm is on both sides.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Elbow {
    /// The elbow is to the left of the straight line from joint 1 to the tip.
    Left,
    /// The elbow is to the right of that line.
    Right,
}

impl Elbow {
    /// Both sides.
    pub const ALL: [Self; 2] = [Self::Left, Self::Right];

    /// Returns the name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Elbow::Left => "left",
            Elbow::Right => "right",
        }
    }

    /// Describes a required side after the words for a place of the tip: ` with the elbow on the left`. Empty without a
    /// side.
    pub fn describe(elbow: Option<Self>) -> String {
        elbow.map_or_else(String::new, |elbow| format!(" with the elbow on the {}", elbow.name()))
    }

    /// Returns the other side.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Elbow::Left => Elbow::Right,
            Elbow::Right => Elbow::Left,
        }
    }

    /// Returns the index of the solution on this side among the two of [`super::inverse`].
    pub fn solution(self) -> usize {
        match self {
            Elbow::Right => 0,
            Elbow::Left => 1,
        }
    }

    /// Returns true if the elbow is on this side. All configurations of arms without an elbow are on both sides.
    pub fn allows(self, arm: &Arm, q: Configuration) -> bool {
        self.excess(arm, q) <= STRAIGHT_SINE
    }

    /// Returns the sine of the angle by which the arm is bent to the other side. Negative or 0 if the elbow is on this side,
    /// or if the arm has no elbow.
    pub fn excess(self, arm: &Arm, q: Configuration) -> f64 {
        let tip = Pose::rotation(arm.joints[1].joint_type.turn() * q[1]).direction(arm.tip);
        let lengths = arm.offset.norm() * tip.norm();
        if !arm.only_turns() || lengths == 0.0 {
            return 0.0;
        }
        // The elbow is on the left if link 2 points to the right of link 1.
        let sine = cross(arm.offset, tip) / lengths;
        match self {
            Elbow::Left => sine,
            Elbow::Right => -sine,
        }
    }
}

impl FromStr for Elbow {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let named = Self::ALL.into_iter().find(|elbow| elbow.name() == text);
        named.ok_or_else(|| format!("\"{text}\" is no side of the elbow; write left or right"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Joint, JointType, Link, inverse};
    use cplan_geometry::{Point, Vector};

    /// Compares the sides of random IK solutions with the definition, computed from the positions of elbow and tip.
    #[test]
    fn sides_are_those_of_the_elbow_from_the_line_to_the_tip() {
        let links = [Link::bar("a", 1.0, 0.05).unwrap(), Link::bar("b", 0.8, 0.05).unwrap()];
        let mut count = [0; 2];
        for k in 0..400 {
            let [a, b, c, d] = [1.1, 2.3, 3.7, 0.9].map(|step: f64| (step * f64::from(k)).sin());
            let joint =
                |name: &str, sign: f64| Joint { joint_type: JointType::Revolute { sign }, ..Joint::continuous(name) };
            let mut arm = Arm::new([joint("a", a.signum()), joint("b", b.signum())], links.clone(), [1.0, 0.8]);
            (arm.offset, arm.tip) = (Vector::new(c, 0.7), Point::new(0.5, d));
            arm.base = Point::new(b, c);
            let target = arm.base + Vector::new(a, d);
            let solved = inverse(&arm, target, Configuration::zeros());
            for (number, q) in solved.branches.iter().enumerate() {
                let [elbow, tip] = [arm.elbow_at(q[0]) - arm.base, arm.tip_at(*q) - arm.base];
                let is_left = tip.x * elbow.y - tip.y * elbow.x > 0.0;
                assert_eq!([Elbow::Left.allows(&arm, *q), Elbow::Right.allows(&arm, *q)], [is_left, !is_left]);
                let side = if is_left { Elbow::Left } else { Elbow::Right };
                assert_eq!(side.solution(), number);
                count[usize::from(is_left)] += 1;
            }
        }
        assert!(count.iter().all(|count| *count > 100), "{count:?}");
        let straight = Arm::rr([1.0, 0.8], 0.06).unwrap();
        for q in [Configuration::zeros(), Configuration::new(0.3, std::f64::consts::PI)] {
            assert!(Elbow::ALL.iter().all(|elbow| elbow.allows(&straight, q)));
        }
    }
}
