//! Inverse kinematics of the tip, in closed form.

use super::{Arm, Elbow, JointType};
use crate::space::{Configuration, JointRange, Segment};
use cplan_geometry::{Point, Vector, cross};
use nalgebra::Rotation2;
use std::f64::consts::TAU;

/// Distances below this, metres, count as zero in two decisions: whether the tip can reach the target, and whether a
/// joint's value affects the tip. A nanometre is far above the rounding of coordinates of some metres and far below
/// any robot's accuracy.
const ZERO_DISTANCE: f64 = 1e-9;

/// Values beyond a limit by at most this (radians or metres) are set to the limit, because such an excess is
/// rounding.
const LIMIT_ROUNDING: f64 = 1e-9;

/// Solutions of the inverse kinematics, without regard to joint limits.
#[derive(Debug, Clone, PartialEq)]
pub struct Inverse {
    /// The solutions, at most two; empty if the tip cannot reach the target.
    pub branches: Vec<Configuration>,
    /// The freedom of the joints that leaves the tip at the target; `None` if the solutions are isolated. With a
    /// freedom there are infinitely many solutions. `branches` then has the one or two solutions with the preferred
    /// value of the free quantity.
    pub free: Option<Freedom>,
}

/// A freedom of the joints that does not affect the tip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Freedom {
    /// The value of the joint with this index, 0 or 1. Joint 2 (index 1) is free if the tip is on its axis. Joint 1
    /// (index 0) is free if the target is on its axis.
    Joint(usize),
    /// The split of one angle between two revolute joints on a common axis.
    Share,
    /// Both joint values: the tip is at the target in every configuration.
    Both,
}

/// Computes all configurations that put the arm's tip at `target`, without limits. Angles are up to whole turns.
///
/// RR: two elbow angles from the law of cosines. RP and PR: a quadratic equation. PP: a linear system. If infinitely
/// many configurations solve it (the tip is on an axis of rotation), returns those with the `preferred` value of the
/// free joint. Forward kinematics of each solution is within a few 1e-9 m of `target`. `O(1)`.
pub fn inverse(arm: &Arm, target: Point, preferred: Configuration) -> Inverse {
    let from_base = target - arm.base;
    let (o, t) = (arm.offset, arm.tip);
    let mut inverse = match (arm.joints[0].joint_type, arm.joints[1].joint_type) {
        (JointType::Revolute { sign: s1 }, JointType::Revolute { sign: s2 }) => {
            turn_turn(from_base, (s1, o), (s2, t), preferred)
        }
        (JointType::Revolute { sign }, JointType::Prismatic { direction }) => {
            turn_slide(from_base, sign, o + t, direction, preferred)
        }
        (JointType::Prismatic { direction }, JointType::Revolute { sign }) => {
            slide_turn(from_base - o, direction, (sign, t), preferred)
        }
        (JointType::Prismatic { direction: first }, JointType::Prismatic { direction: second }) => {
            let d = from_base - o - t;
            // The loader refuses parallel slides.
            let determinant = cross(first, second);
            let q = Configuration::new(cross(d, second) / determinant, cross(first, d) / determinant);
            Inverse { branches: vec![q], free: None }
        }
    };
    inverse.branches.retain(|q| q.iter().all(|v| v.is_finite()));
    inverse
}

fn angle(v: Vector) -> f64 {
    v.y.atan2(v.x)
}

/// Returns a value of a joint that turns the vector `arm` towards `d`, and whether the value is free. It is free if
/// both vectors vanish. Then the preferred value is returned.
fn turning(sign: f64, arm: Vector, d: Vector, preferred: f64) -> (f64, bool) {
    let free = arm.norm() <= ZERO_DISTANCE && d.norm() <= ZERO_DISTANCE;
    (if free { preferred } else { sign * (angle(d) - angle(arm)) }, free)
}

fn turn_turn(d: Vector, (s1, o): (f64, Vector), (s2, t): (f64, Vector), preferred: Configuration) -> Inverse {
    let (upper, lower, reach) = (o.norm(), t.norm(), d.norm());
    let none = Inverse { branches: Vec::new(), free: None };
    if reach > upper + lower + ZERO_DISTANCE || reach < (upper - lower).abs() - ZERO_DISTANCE {
        return none;
    }
    if upper.min(lower) <= ZERO_DISTANCE {
        // The elbow does not change the reach. If the tip is on joint 2's axis, joint 2 is free; otherwise the split
        // of the angle between the joints.
        let elbow = o + Rotation2::new(s2 * preferred[1]) * t;
        let (q1, any) = turning(s1, elbow, d, preferred[0]);
        let free = match (any, lower <= ZERO_DISTANCE) {
            (true, _) => Freedom::Both,
            (false, true) => Freedom::Joint(1),
            (false, false) => Freedom::Share,
        };
        return Inverse { branches: vec![Configuration::new(q1, preferred[1])], free: Some(free) };
    }
    let cosine = ((reach * reach - upper * upper - lower * lower) / (2.0 * upper * lower)).clamp(-1.0, 1.0);
    let bend = cosine.acos();
    let mut branches = Vec::new();
    let mut free = None;
    for bend in [bend, -bend] {
        let phi = angle(o) - angle(t) + bend;
        let (q1, any) = turning(s1, o + Rotation2::new(phi) * t, d, preferred[0]);
        if any {
            free = Some(Freedom::Joint(0));
        }
        let q = Configuration::new(q1, s2 * phi);
        // For a stretched or folded arm, both branches are the same.
        if branches.is_empty() || cosine.abs() < 1.0 {
            branches.push(q);
        }
    }
    if free.is_some() {
        branches.truncate(1);
    }
    Inverse { branches, free }
}

fn turn_slide(d: Vector, sign: f64, m: Vector, direction: Vector, preferred: Configuration) -> Inverse {
    // The equation is |m + q2 w| = |d|, where w is the direction of joint 2. The tip moves on a line at distance |m
    // x w| from joint 1.
    let aside = cross(m, direction);
    let Some(root) = half_chord(d.norm(), aside.abs()) else {
        return Inverse { branches: Vec::new(), free: None };
    };
    let middle = -m.dot(&direction);
    let mut inverse = Inverse { branches: Vec::new(), free: None };
    for q2 in symmetric_values(middle, root) {
        let (q1, free) = turning(sign, m + direction * q2, d, preferred[0]);
        inverse.branches.push(Configuration::new(q1, q2));
        if free {
            return Inverse { branches: vec![Configuration::new(q1, middle)], free: Some(Freedom::Joint(0)) };
        }
    }
    inverse
}

fn slide_turn(d: Vector, direction: Vector, (sign, t): (f64, Vector), preferred: Configuration) -> Inverse {
    // The equation is |d - q1 w| = |t|, where w is the direction of joint 1. Joint 2 moves on a line at distance |d
    // x w| from the target.
    let Some(root) = half_chord(t.norm(), cross(d, direction).abs()) else {
        return Inverse { branches: Vec::new(), free: None };
    };
    let mut inverse = Inverse { branches: Vec::new(), free: None };
    let middle = d.dot(&direction);
    for q1 in symmetric_values(middle, root) {
        let (q2, free) = turning(sign, t, d - direction * q1, preferred[1]);
        inverse.branches.push(Configuration::new(q1, q2));
        if free {
            return Inverse { branches: vec![Configuration::new(middle, q2)], free: Some(Freedom::Joint(1)) };
        }
    }
    inverse
}

/// Returns half the chord that a line at `distance` from the centre cuts off a circle of `radius`; `None` if they do
/// not meet.
fn half_chord(radius: f64, distance: f64) -> Option<f64> {
    if distance > radius + ZERO_DISTANCE {
        return None;
    }
    Some(((radius - distance) * (radius + distance)).max(0.0).sqrt())
}

fn symmetric_values(middle: f64, root: f64) -> Vec<f64> {
    if root > 0.0 { vec![middle + root, middle - root] } else { vec![middle] }
}

impl Inverse {
    /// Returns the solutions with the elbow on a side; all if there is no side.
    #[must_use]
    pub fn with_elbow(mut self, arm: &Arm, elbow: Option<Elbow>) -> Self {
        self.branches.retain(|q| elbow.is_none_or(|elbow| elbow.allows(arm, *q)));
        self
    }

    /// Returns all solutions within the limits. A branch has one solution per whole turn that the limits allow; a
    /// free joint gives a segment over its whole range. On circles each solution appears once. If both joints are
    /// free, all configurations are solutions, and the preferred one represents them.
    pub fn solutions(&self, arm: &Arm) -> Vec<Segment> {
        let joints = &arm.joints;
        let copies =
            |k: usize, value: f64| equivalent_values(joints[k].range, joints[k].joint_type.is_revolute(), value);
        let of_branch = |q: &Configuration| -> Vec<Segment> {
            let [first, second] = match self.free {
                Some(Freedom::Share) => return shares(arm, *q),
                Some(Freedom::Joint(free)) => [0, 1].map(|k| match joints[k].range.domain() {
                    domain if k == free => vec![domain],
                    _ => copies(k, q[k]).into_iter().map(|value| (value, value)).collect(),
                }),
                None | Some(Freedom::Both) => {
                    [0, 1].map(|k| copies(k, q[k]).into_iter().map(|value| (value, value)).collect())
                }
            };
            let pairs = first.iter().flat_map(|a| second.iter().map(move |b| (a, b)));
            pairs.map(|(a, b)| Segment::new(Configuration::new(a.0, b.0), Configuration::new(a.1, b.1))).collect()
        };
        let topology = arm.topology();
        self.branches.iter().flat_map(of_branch).filter_map(|solution| topology.within_sum(solution)).collect()
    }
}

/// Returns all segments within the limits on which two revolute joints on one axis share the total angle of `q`.
fn shares(arm: &Arm, q: Configuration) -> Vec<Segment> {
    let [s1, s2] = arm.joints.each_ref().map(|joint| joint.joint_type.turn());
    let [first, second] = arm.joints.each_ref().map(|joint| joint.range.domain());
    let sum = s1 * q[0] + s2 * q[1];
    let sums = [first.0, first.1].map(|q1| [second.0, second.1].map(|q2| s1 * q1 + s2 * q2)).concat();
    let (least, greatest) = sums.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, g), &x| (l.min(x), g.max(x)));
    let turns = ((least - sum) / TAU).ceil() as i64..=((greatest - sum) / TAU).floor() as i64;
    let clamped = |q: Configuration| Configuration::new(q[0].clamp(first.0, first.1), q[1].clamp(second.0, second.1));
    let line = |turn: i64| {
        let at = |q1: f64| Configuration::new(q1, s2 * (sum + turn as f64 * TAU - s1 * q1));
        let whole = Segment::new(at(first.0), at(first.1));
        let [from, to] = whole.within([first.0, second.0], [first.1, second.1])?.ends().map(clamped);
        Some(Segment::new(from, to))
    };
    turns.filter_map(line).collect()
}

/// Returns all values within the limits that are equivalent to `value`. For a revolute joint these are its copies by
/// whole turns; on a circle, the copy in `[-pi, pi)`. Values that rounding put beyond a limit are set to the limit.
pub fn equivalent_values(range: JointRange, revolute: bool, value: f64) -> Vec<f64> {
    let JointRange::Interval { lower, upper } = range else { return vec![range.wrap(value)] };
    if !revolute {
        let inside = lower - LIMIT_ROUNDING <= value && value <= upper + LIMIT_ROUNDING;
        return if inside { vec![value.clamp(lower, upper)] } else { Vec::new() };
    }
    let first = ((lower - LIMIT_ROUNDING - value) / TAU).ceil();
    let last = ((upper + LIMIT_ROUNDING - value) / TAU).floor();
    // The loader bounds the range, so there are few turns.
    (first as i64..=last as i64).map(|k| (value + k as f64 * TAU).clamp(lower, upper)).collect()
}
