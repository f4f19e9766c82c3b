//! Bounds on the motion of the tip, and on the joint values that put the tip near a point.

use cplan_geometry::{Point, Vector, cross};
use cplan_model::space::Configuration;
use cplan_model::{Arm, JointType, inverse};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Joint values are widened by this, radians or metres, to allow for rounding in proofs.
const ROUNDING: f64 = 1e-11;

/// All configurations of one IK solution that put the tip near a point, as a box.
#[derive(Debug, Clone, Copy)]
pub struct SolutionBox {
    /// The middle of the box.
    pub middle: Configuration,
    /// Half of its size along both joints, radians or metres.
    pub half: [f64; 2],
}

/// An arm, and the lengths that determine its kinematics.
pub struct Kinematics<'a> {
    /// The arm.
    pub arm: &'a Arm,
    /// Length from joint 1 to joint 2, and from joint 2 to the tip, metres.
    lengths: [f64; 2],
}

/// Returns the direction of a vector, radians.
fn angle(v: Vector) -> f64 {
    v.y.atan2(v.x)
}

impl<'a> Kinematics<'a> {
    /// Measures an arm.
    pub fn new(arm: &'a Arm) -> Self {
        Self { arm, lengths: [arm.offset.norm(), arm.tip.norm()] }
    }

    fn kinds(&self) -> [JointType; 2] {
        self.arm.joints.each_ref().map(|joint| joint.joint_type)
    }

    /// Returns the radius of the tip's circle about joint 1 if joint 2 slides, at most `beside` metres from `q2`.
    fn radius(&self, direction: Vector, q2: f64, beside: f64) -> f64 {
        (self.arm.offset + direction * q2 + self.arm.tip).norm() + beside
    }

    /// Applies the second derivative of the tip's position to the displacements `a` and `b`, and returns a bound on the length of
    /// the result, metres. It is valid while the joint values are within `beside` of `q`.
    pub fn bend(&self, q: Configuration, beside: Configuration, a: Configuration, b: Configuration) -> f64 {
        use JointType::{Prismatic, Revolute};
        let [a1, a2, b1, b2] = [a[0].abs(), a[1].abs(), b[0].abs(), b[1].abs()];
        match self.kinds() {
            [Revolute { sign: s1 }, Revolute { sign: s2 }] => {
                let turn = |d: Configuration| (s1 * d[0] + s2 * d[1]).abs();
                self.lengths[0] * a1 * b1 + self.lengths[1] * turn(a) * turn(b)
            }
            [Revolute { .. }, Prismatic { direction }] => {
                self.radius(direction, q[1], beside[1].abs()) * a1 * b1 + a1 * b2 + a2 * b1
            }
            [Prismatic { .. }, Revolute { .. }] => self.lengths[1] * a2 * b2,
            [Prismatic { .. }, Prismatic { .. }] => 0.0,
        }
    }

    /// Does the same as [`Self::bend`] for displacements with known magnitudes in each joint, but unknown signs.
    pub fn bend_within(&self, q: Configuration, beside: Configuration, a: Configuration, b: Configuration) -> f64 {
        use JointType::Revolute;
        let [a, b] = [a.abs(), b.abs()];
        match self.kinds() {
            [Revolute { .. }, Revolute { .. }] => {
                self.lengths[0] * a[0] * b[0] + self.lengths[1] * (a[0] + a[1]) * (b[0] + b[1])
            }
            _ => self.bend(q, beside, a, b),
        }
    }

    /// Returns a bound on the displacement of the tip, to first order, if each joint moves by at most `d`. It is valid while the
    /// joint values are within `beside` of `q`.
    pub fn motion_within(&self, q: Configuration, beside: Configuration, d: Configuration) -> f64 {
        use JointType::{Prismatic, Revolute};
        let d = d.abs();
        match self.kinds() {
            [Revolute { .. }, Revolute { .. }] => self.lengths[0] * d[0] + self.lengths[1] * (d[0] + d[1]),
            [Revolute { .. }, Prismatic { direction }] => self.radius(direction, q[1], beside[1].abs()) * d[0] + d[1],
            [Prismatic { .. }, Revolute { .. }] => d[0] + self.lengths[1] * d[1],
            [Prismatic { .. }, Prismatic { .. }] => d[0] + d[1],
        }
    }

    /// Returns the product of the tip's Jacobian and a displacement.
    pub fn velocity(&self, q: Configuration, d: Configuration) -> Vector {
        let [first, second] = self.arm.jacobian(1, self.arm.tip, q);
        first * d[0] + second * d[1]
    }

    /// Returns the least and the greatest distance of the tip from joint 1, if joint 1 turns, without regard to limits.
    fn annulus(&self) -> Option<[f64; 2]> {
        match self.kinds() {
            [JointType::Revolute { .. }, JointType::Revolute { .. }] => {
                let [first, second] = self.lengths;
                Some([(first - second).abs(), first + second])
            }
            [JointType::Revolute { .. }, JointType::Prismatic { direction }] => {
                Some([cross(self.arm.offset + self.arm.tip, direction).abs(), f64::INFINITY])
            }
            _ => None,
        }
    }

    /// Returns a lower bound on the distance of a point from all places that the tip can reach, metres; 0 for a point within
    /// reach. Ignores joint limits.
    pub fn distance_out_of_reach(&self, point: Point) -> f64 {
        let away = point - self.arm.base;
        if let Some([least, most]) = self.annulus() {
            return (away.norm() - most).max(least - away.norm()).max(0.0);
        }
        match self.kinds() {
            [JointType::Prismatic { direction }, JointType::Revolute { .. }] => {
                (cross(away - self.arm.offset, direction).abs() - self.lengths[1]).max(0.0)
            }
            _ => 0.0,
        }
    }

    /// Returns a lower bound on the distance of a part of a curve from all singular places, where both IK solutions coincide,
    /// metres. The part is within `off` of the straight line between two points.
    pub fn distance_from_singular(&self, [a, b]: [Point; 2], off: f64) -> f64 {
        let base = self.arm.base;
        if let Some([least, most]) = self.annulus() {
            let chord = b - a;
            let square = chord.norm_squared();
            let share = if square > 0.0 { ((base - a).dot(&chord) / square).clamp(0.0, 1.0) } else { 0.0 };
            let nearest = (a + chord * share - base).norm();
            let farthest = (a - base).norm().max((b - base).norm());
            return (nearest - least).min(most - farthest) - off;
        }
        match self.kinds() {
            [JointType::Prismatic { direction }, JointType::Revolute { .. }] => {
                let aside = |p: Point| cross(p - base - self.arm.offset, direction).abs();
                self.lengths[1] - aside(a).max(aside(b)) - off
            }
            _ => f64::INFINITY,
        }
    }

    /// Returns the point within the tip's reach that is nearest to `point`, without regard to limits. `None` if it is farther
    /// than `slack`, metres.
    pub fn reachable(&self, point: Point, slack: f64) -> Option<Point> {
        let off = self.distance_out_of_reach(point);
        if off == 0.0 {
            return Some(point);
        }
        if off > slack {
            return None;
        }
        let away = point - self.arm.base;
        if let Some([least, most]) = self.annulus() {
            let distance = away.norm();
            return (distance > 0.0).then(|| self.arm.base + away * (distance.clamp(least, most) / distance));
        }
        let JointType::Prismatic { direction } = self.kinds()[0] else { return None };
        let aside = Vector::new(direction.y, -direction.x);
        // The sign of `cross(away, direction)` is that of the component along `aside`.
        let side = cross(away - self.arm.offset, direction);
        Some(point - aside * (side.signum() * (side.abs() - self.lengths[1])))
    }

    /// Returns both IK solutions for a point within the tip's reach, in a fixed order, without whole turns. At a singular place,
    /// they are equal. `None` if a joint is free there.
    pub fn solutions(&self, point: Point) -> Option<[Configuration; 2]> {
        let found = inverse(self.arm, point, Configuration::zeros());
        let first = *found.branches.first().filter(|_| found.free.is_none())?;
        Some([first, found.branches.get(1).copied().unwrap_or(first)])
    }

    /// Adds whole turns of revolute joints to a configuration so that it is as near as possible to another one.
    pub fn near(&self, q: Configuration, near: Configuration) -> Configuration {
        Configuration::from_fn(|k, _| match self.arm.joints[k].joint_type.is_revolute() {
            true => q[k] + ((near[k] - q[k]) / TAU).round() * TAU,
            false => q[k],
        })
    }

    /// Returns true if the arm has two IK solutions at most places.
    pub fn has_two_solutions(&self) -> bool {
        !self.arm.is_gantry()
    }

    /// Returns a box that contains, up to whole turns, all configurations of one IK solution that put the tip within `near` of a
    /// point. `None` if no such box is known.
    pub fn solution_box(&self, point: Point, solution: usize, near: f64) -> Option<SolutionBox> {
        use JointType::{Prismatic, Revolute};
        let side = if solution == 0 { 1.0 } else { -1.0 };
        let away = point - self.arm.base;
        let distance = away.norm();
        let [least, most] = [distance - near, distance + near];
        let (offset, tip) = (self.arm.offset, self.arm.tip);
        let (middle, half) = match self.kinds() {
            [Revolute { sign: s1 }, Revolute { sign: s2 }] => {
                let [first, second] = self.lengths;
                if least <= 0.0 || first.min(second) <= 0.0 {
                    return None;
                }
                let bend = |r: f64| {
                    ((r * r - first * first - second * second) / (2.0 * first * second)).clamp(-1.0, 1.0).acos()
                };
                let [low, high] = [bend(most), bend(least)];
                let (bent, half) = ((low + high) / 2.0, (high - low) / 2.0);
                let phi = angle(offset) - angle(tip) + side * bent;
                let elbow = offset + cplan_geometry::Pose::rotation(phi).direction(tip);
                // The direction of the tip, seen from joint 1, turns by at most this per radian of joint 2.
                let turns = second / (first - second).abs().max(least);
                let q = Configuration::new(s1 * (angle(away) - angle(elbow)), s2 * phi);
                (q, [(near / distance).asin() + turns * half, half])
            }
            [Revolute { sign }, Prismatic { direction }] => {
                let from_joint = offset + tip;
                let aside = cross(from_joint, direction).abs();
                if least <= 0.0 {
                    return None;
                }
                let root = |r: f64| (r * r - aside * aside).max(0.0).sqrt();
                let [low, high] = [root(least), root(most)];
                let q2 = side * (low + high) / 2.0 - from_joint.dot(&direction);
                let q1 = sign * (angle(away) - angle(from_joint + direction * q2));
                let half = (high - low) / 2.0;
                let turns = aside / aside.max(least).powi(2);
                (Configuration::new(q1, q2), [(near / distance).asin() + turns * half, half])
            }
            [Prismatic { direction }, Revolute { sign }] => {
                let from_zero = away - offset;
                let aside = cross(from_zero, direction).abs();
                let reach = self.lengths[1];
                if reach <= near {
                    return None;
                }
                let root = |aside: f64| (reach * reach - aside * aside).max(0.0).sqrt();
                let [low, high] = [root(aside + near), root((aside - near).max(0.0))];
                let q1 = from_zero.dot(&direction) + side * (low + high) / 2.0;
                let half = near + (high - low) / 2.0;
                let lever = from_zero - direction * q1;
                // The chord of the tip about joint 2 is at most this long.
                let turn = (half + near + (lever.norm() - reach).abs()) / reach * FRAC_PI_2;
                (Configuration::new(q1, sign * (angle(lever) - angle(tip))), [half, turn.min(PI)])
            }
            [Prismatic { direction: first }, Prismatic { direction: second }] => {
                let d = away - offset - tip;
                let determinant = cross(first, second);
                let q = Configuration::new(cross(d, second) / determinant, cross(first, d) / determinant);
                (q, [near / determinant.abs(); 2])
            }
        };
        let is_finite = middle.iter().chain(&half).all(|x| x.is_finite());
        is_finite.then(|| SolutionBox { middle, half: half.map(|h| h * (1.0 + ROUNDING) + ROUNDING) })
    }
}
