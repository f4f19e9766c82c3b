//! Rotations by quaternions.

use super::pose::Pose;
use super::tree::{ReadResult, Tree};
use cplan_check::interval::{Interval, double};
use num_bigint::Sign;
use roxmltree::Node;

impl<'a> Tree<'a> {
    /// Returns the rotation that an `<origin>` states by its `quat_xyzw`.
    pub(super) fn quaternion(&self, origin: Node<'a, 'a>) -> ReadResult<Pose> {
        let numbers = self.numbers::<4>(origin, "quat_xyzw")?.each_ref().map(Interval::from);
        Pose::of_quaternion(&numbers).map_or_else(|| self.error(origin, "the quaternion is too short"), Ok)
    }
}

impl Pose {
    /// Makes a rotation from a quaternion x, y, z, w of any length. Returns `None` if the length is not certainly
    /// greater than 0.
    fn of_quaternion(q: &[Interval; 4]) -> Option<Self> {
        let product = |i: usize, j: usize| &q[i] * &q[j];
        let square = (0..4).fold(Interval::whole(0), |sum, k| &sum + &product(k, k));
        if square.lower.sign() != Sign::Plus {
            return None;
        }
        let entry = |i: usize, j: usize| {
            let turn = match (3 + j - i) % 3 {
                0 => {
                    let [a, b] = [(i + 1) % 3, (i + 2) % 3];
                    return &Interval::whole(1) - &double(&(&product(a, a) + &product(b, b))).divided(&square);
                }
                1 => &product(i, j) - &product(3 - i - j, 3),
                _ => &product(i, j) + &product(3 - i - j, 3),
            };
            double(&turn).divided(&square)
        };
        let rows = [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)));
        Some(Self { rows, at: [0, 0, 0].map(Interval::whole) })
    }
}
