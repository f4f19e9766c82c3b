//! Inverse kinematics of the tip, in closed form.

use super::{Arm, Motion};
use crate::geometry::{Point, Vector, cross};
use crate::space::{Axis, Configuration};
use nalgebra::Rotation2;
use std::f64::consts::TAU;

/// Distances below this, metres, count as none: whether the tip can be reached, and whether a joint's value matters.
/// A nanometre, far above the rounding of coordinates of some metres and far below any robot's accuracy.
const REACHED: f64 = 1e-9;

/// Values beyond a limit by no more than this (radians or metres) are taken as the limit: they are rounding.
const LIMIT_ROUNDING: f64 = 1e-9;

/// Solutions of the inverse kinematics, limits not regarded.
#[derive(Debug, Clone, PartialEq)]
pub struct Inverse {
    /// At most two; none when the tip is out of reach.
    pub branches: Vec<Configuration>,
    /// A joint whose value does not matter for the tip there (0 or 1), so that `branches` are only two of infinitely
    /// many: those with the preferred value of that joint.
    pub free: Option<usize>,
}

/// All configurations that put the arm's tip at `target`, limits not regarded, angles up to whole turns.
///
/// RR: two elbow angles from the law of cosines; RP and PR: a quadratic; PP: a linear system. Where infinitely many
/// solve it (the tip on an axis of rotation), those with the `preferred` value of the free joint. Forward kinematics
/// gives `target` back to within a few 1e-9 m. `O(1)`.
#[must_use]
pub fn inverse(arm: &Arm, target: Point, preferred: Configuration) -> Inverse {
    let from_base = target - arm.base;
    let (o, t) = (arm.offset, arm.tip.coords);
    let mut inverse = match (arm.joints[0].motion, arm.joints[1].motion) {
        (Motion::Revolute { sign: s1 }, Motion::Revolute { sign: s2 }) => {
            turn_turn(from_base, (s1, o), (s2, t), preferred)
        }
        (Motion::Revolute { sign }, Motion::Prismatic { direction }) => {
            turn_slide(from_base, sign, o + t, direction, preferred)
        }
        (Motion::Prismatic { direction }, Motion::Revolute { sign }) => {
            slide_turn(from_base - o, direction, (sign, t), preferred)
        }
        (Motion::Prismatic { direction: first }, Motion::Prismatic { direction: second }) => {
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

/// The angle of a vector.
fn angle(v: Vector) -> f64 {
    v.y.atan2(v.x)
}

/// `q1` such that `R(s1 q1)` turns `arm` towards `d`; the preferred value where both vanish.
fn turning(sign: f64, arm: Vector, d: Vector, preferred: f64) -> (f64, bool) {
    let free = arm.norm() <= REACHED && d.norm() <= REACHED;
    (if free { preferred } else { sign * (angle(d) - angle(arm)) }, free)
}

fn turn_turn(d: Vector, (s1, o): (f64, Vector), (s2, t): (f64, Vector), preferred: Configuration) -> Inverse {
    let (upper, lower, reach) = (o.norm(), t.norm(), d.norm());
    let none = Inverse { branches: Vec::new(), free: None };
    if reach > upper + lower + REACHED || reach < (upper - lower).abs() - REACHED {
        return none;
    }
    if upper.min(lower) <= REACHED {
        // The elbow does not change the reach: joint 2 (tip on its axis), or the split between the two, is free.
        let elbow = o + Rotation2::new(s2 * preferred[1]) * t;
        let (q1, _) = turning(s1, elbow, d, preferred[0]);
        return Inverse { branches: vec![Configuration::new(q1, preferred[1])], free: Some(1) };
    }
    let cosine = ((reach * reach - upper * upper - lower * lower) / (2.0 * upper * lower)).clamp(-1.0, 1.0);
    let bend = cosine.acos();
    let mut branches = Vec::new();
    let mut free = None;
    for bend in [bend, -bend] {
        let phi = angle(o) - angle(t) + bend;
        let (q1, any) = turning(s1, o + Rotation2::new(phi) * t, d, preferred[0]);
        if any {
            free = Some(0);
        }
        let q = Configuration::new(q1, s2 * phi);
        // Stretched or folded, both branches are one.
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
    // |m + q2 w| = |d|: the tip runs on a line at distance |m x w| from joint 1.
    let aside = cross(m, direction);
    let Some(root) = half_chord(d.norm(), aside.abs()) else {
        return Inverse { branches: Vec::new(), free: None };
    };
    let middle = -m.dot(&direction);
    let mut inverse = Inverse { branches: Vec::new(), free: None };
    for q2 in both(middle, root) {
        let (q1, free) = turning(sign, m + direction * q2, d, preferred[0]);
        inverse.branches.push(Configuration::new(q1, q2));
        if free {
            inverse.free = Some(0);
        }
    }
    inverse
}

fn slide_turn(d: Vector, direction: Vector, (sign, t): (f64, Vector), preferred: Configuration) -> Inverse {
    // |d - q1 w| = |t|: joint 2 runs on a line at distance |d x w| from the target.
    let Some(root) = half_chord(t.norm(), cross(d, direction).abs()) else {
        return Inverse { branches: Vec::new(), free: None };
    };
    let mut inverse = Inverse { branches: Vec::new(), free: None };
    for q1 in both(d.dot(&direction), root) {
        let (q2, free) = turning(sign, t, d - direction * q1, preferred[1]);
        inverse.branches.push(Configuration::new(q1, q2));
        if free {
            inverse.free = Some(1);
        }
    }
    inverse
}

/// Half the chord that a line at `distance` from the centre cuts off a circle of `radius`; none if they do not meet.
fn half_chord(radius: f64, distance: f64) -> Option<f64> {
    if distance > radius + REACHED {
        return None;
    }
    Some(((radius - distance) * (radius + distance)).max(0.0).sqrt())
}

fn both(middle: f64, root: f64) -> Vec<f64> {
    if root > 0.0 { vec![middle + root, middle - root] } else { vec![middle] }
}

/// The values that stand for `value` on an axis: every copy by whole turns of a revolute joint that is within the
/// limits, on a circle the one in `[-pi, pi)`. Values that rounding put beyond a limit count as the limit.
#[must_use]
pub fn within(axis: Axis, revolute: bool, value: f64) -> Vec<f64> {
    let Axis::Interval { lower, upper } = axis else { return vec![axis.wrap(value)] };
    if !revolute {
        let inside = lower - LIMIT_ROUNDING <= value && value <= upper + LIMIT_ROUNDING;
        return if inside { vec![value.clamp(lower, upper)] } else { Vec::new() };
    }
    let first = ((lower - LIMIT_ROUNDING - value) / TAU).ceil();
    let last = ((upper + LIMIT_ROUNDING - value) / TAU).floor();
    // The loader bounds the range, so there are few turns.
    (first as i64..=last as i64).map(|k| (value + k as f64 * TAU).clamp(lower, upper)).collect()
}
