//! Numbers with as many digits as can be seen.

use crate::geometry::Point;
use crate::model::Arm;
use crate::space::Configuration;

/// Digits of a length behind the first one of the arm's reach: a hundredth of a pixel at the size of a screen.
const DIGITS: i32 = 5;

/// What values are rounded to: powers of ten, given by how many of them make 1, so that rounding leaves short decimals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grain {
    lengths: f64,
    joints: [f64; 2],
}

/// A number rounded to `1 / grains`, without a negative zero.
fn rounded(value: f64, grains: f64) -> f64 {
    (value * grains).round() / grains + 0.0
}

/// Grains for values of this size.
fn grains(size: f64) -> f64 {
    10_f64.powi((DIGITS - size.log10().floor() as i32).clamp(-12, 15))
}

impl Grain {
    /// That of an arm: its reach for lengths, a radian or the stroke for joints.
    #[must_use]
    pub fn of(arm: &Arm) -> Self {
        let stroke = |k: usize| arm.joints[k].range.extent().max(f64::MIN_POSITIVE);
        let joints = [0, 1].map(|k| grains(if arm.joints[k].joint_type.is_revolute() { 1.0 } else { stroke(k) }));
        Self { lengths: grains(arm.reach()), joints }
    }

    /// A length or coordinate.
    #[must_use]
    pub fn length(self, value: f64) -> f64 {
        rounded(value, self.lengths)
    }

    /// A point of the plane.
    #[must_use]
    pub fn point(self, p: Point) -> [f64; 2] {
        [self.length(p.x), self.length(p.y)]
    }

    /// Points of the plane, one coordinate after the other.
    #[must_use]
    pub fn points(self, points: &[Point]) -> Vec<f64> {
        points.iter().flat_map(|&p| self.point(p)).collect()
    }

    /// An angle or another number of the order of 1.
    #[must_use]
    pub fn number(self, value: f64) -> f64 {
        rounded(value, grains(1.0))
    }

    /// The value of a joint, or of its speed and acceleration.
    #[must_use]
    pub fn joint(self, k: usize, value: f64) -> f64 {
        rounded(value, self.joints[k])
    }

    /// A configuration, rounded to what can be seen.
    #[must_use]
    pub fn configuration(self, q: Configuration) -> [f64; 2] {
        [self.joint(0, q[0]), self.joint(1, q[1])]
    }

    /// Configurations, one value after the other.
    #[must_use]
    pub fn configurations<'a>(self, all: impl IntoIterator<Item = &'a Configuration>) -> Vec<f64> {
        all.into_iter().flat_map(|&q| self.configuration(q)).collect()
    }
}
