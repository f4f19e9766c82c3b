//! Proves that a straight motion keeps a part of link 2 away from a piece of an obstacle.

use cplan_geometry::{Convex, Pose, Separation, Vector, separation};
use cplan_model::space::Configuration;
use cplan_model::{Arm, JointType};
use std::f64::consts::TAU;

/// A configuration of a pair of shapes, with the direction of greatest gap from the part to the piece.
#[derive(Debug, Clone, Copy)]
pub(super) struct Contact {
    /// Unwrapped joint values.
    pub q: Configuration,
    pose: Pose,
    direction: Vector,
}

impl Contact {
    /// Returns the same contact after whole turns of joint 2, which must be revolute.
    pub fn turned(&self, turns: f64) -> Self {
        Self { q: Configuration::new(self.q[0], self.q[1] + turns * TAU), ..*self }
    }
}

/// A part of link 2 and a piece of an obstacle. Their distance on straight motions has a lower bound.
///
/// [`PairMotion::least_distance`] computes the bound as follows. The distance of two convex sets is the greatest gap over all
/// directions, so the gap along any direction is a lower bound, and the direction may change along the motion. Let `m` and `n`
/// be the unit directions of the greatest gap at the two ends, and `c = m . n`. Between the ends take the normalised `(1-t) m +
/// t n`. For a corner `a` of the part and a corner `b` of the piece, the offset `y = b - a` is a smooth function of `t`. It is
/// at most `k t(1-t)/2` from the straight line between its values at the ends, where `k` bounds its second derivative. Let `G`
/// be the smaller gap at the ends, and `D = 2 G - (gap at start along n) - (gap at end along m)`. Then, at `x = t(1-t)`,
///
/// ```text
/// gap >= (G - x D) / sqrt(1 - 2x(1-c)) - x k/2  >=  (G - x D)(1 + x(1-c)) - x k/2.
/// ```
///
/// For `D >= 0` the right side is concave in `x`, so it is at least the lesser of its values at `x = 0` and
/// `x = 1/4`. The same holds with all vectors in the link's frame, where the corners of the piece move instead.
///
/// The bound in the plane is sharp for a corner of the link on a side of the obstacle (`m = n`, `D = 0`). The bound
/// in the link's frame is sharp for a corner of the obstacle on a side of the link. Both are sharp for two corners.
#[derive(Debug, Clone)]
pub(super) struct PairMotion<'a> {
    arm: &'a Arm,
    part: &'a Convex,
    piece: &'a Convex,
    /// Greatest distance of a corner of the part's core from the origin of link 2's frame, metres.
    part_reach: f64,
    /// Greatest distance of a corner of the piece's core from the base, metres.
    piece_reach: f64,
}

impl<'a> PairMotion<'a> {
    /// Creates the pair. `part` is in link 2's frame, `piece` in plane coordinates.
    pub fn new(arm: &'a Arm, part: &'a Convex, piece: &'a Convex) -> Self {
        let part_reach = part.core().iter().map(|a| a.norm()).fold(0.0, f64::max);
        let piece_reach = piece.core().iter().map(|b| (b - arm.base).norm()).fold(0.0, f64::max);
        Self { arm, part, piece, part_reach, piece_reach }
    }

    /// Returns a bound on the change of the pair's distance per unit of `q1`, with `q2` fixed.
    ///
    /// A revolute joint 1 turns part and piece relative to each other about the base. So the bound is a distance from
    /// the base: that of the piece's farthest corner. If joint 2 is revolute as well, the farthest distance of link 2
    /// is another bound, and the smaller of both counts.
    pub fn speed(&self) -> f64 {
        match (self.arm.joints[0].joint_type, self.arm.joints[1].joint_type) {
            (JointType::Prismatic { .. }, _) => 1.0,
            (JointType::Revolute { .. }, JointType::Prismatic { .. }) => self.piece_reach,
            (JointType::Revolute { .. }, JointType::Revolute { .. }) => {
                self.piece_reach.min(self.arm.offset.norm() + self.part_reach)
            }
        }
    }

    /// Returns the signed distance of the pair at `q`.
    pub fn separation(&self, q: Configuration) -> Separation {
        separation(&self.part.at(&self.arm.pose(1, q)), self.piece)
    }

    /// Prepares the configuration `q` as an end of a motion.
    pub fn contact(&self, q: Configuration) -> Contact {
        let pose = self.arm.pose(1, q);
        Contact { q, pose, direction: separation(&self.part.at(&pose), self.piece).direction }
    }

    /// Returns a lower bound on the signed distance of the pair on the straight motion from `from` to `to`. Returns
    /// minus infinity if the argument above gives no bound.
    pub fn least_distance(&self, from: &Contact, to: &Contact) -> f64 {
        let ends = [self.gap(&from.pose, from.direction), self.gap(&to.pose, to.direction)];
        let least = ends[0].min(ends[1]);
        let radii = self.part.radius() + self.piece.radius();
        let [world, link] = self.curvatures(from.q, to.q);

        let across = [self.gap(&from.pose, to.direction), self.gap(&to.pose, from.direction)];
        let seen_from_world = bound(least, across, from.direction.dot(&to.direction), world);

        // Rotate the directions with the link.
        let turn = to.pose.rotation * from.pose.rotation.inverse();
        let (carried_on, carried_back) = (turn * from.direction, turn.inverse() * to.direction);
        let across = [self.gap(&from.pose, carried_back), self.gap(&to.pose, carried_on)];
        let seen_from_link = bound(least, across, carried_on.dot(&to.direction), link);

        seen_from_world.max(seen_from_link) - radii
    }

    /// Returns the gap between the two cores along the unit direction `n`, from part to piece, with the link at
    /// `pose`.
    fn gap(&self, pose: &Pose, n: Vector) -> f64 {
        let in_link = pose.inverse_direction(n);
        let part = self.part.core().iter().map(|a| in_link.dot(a)).fold(f64::NEG_INFINITY, f64::max);
        let piece = self.piece.core().iter().map(|b| n.dot(b)).fold(f64::INFINITY, f64::min);
        piece - part - n.dot(&pose.translation)
    }

    /// Returns two bounds on second derivatives along the straight motion, which takes one unit of time: for corners of
    /// the part in the plane, and for corners of the piece in the link's frame.
    pub fn curvatures(&self, from: Configuration, to: Configuration) -> [f64; 2] {
        let d = to - from;
        let (offset, part, piece) = (self.arm.offset, self.part_reach, self.piece_reach);
        match (self.arm.joints[0].joint_type, self.arm.joints[1].joint_type) {
            (JointType::Revolute { sign: s1 }, JointType::Revolute { sign: s2 }) => {
                let turn2 = (s1 * d[0] + s2 * d[1]).powi(2);
                let offset = offset.norm();
                [offset * d[0] * d[0] + part * turn2, piece * turn2 + offset * d[1] * d[1]]
            }
            (JointType::Prismatic { direction }, JointType::Revolute { .. }) => {
                let elbow = |q1: f64| (offset + q1 * direction).norm();
                let arm = piece + elbow(from[0]).max(elbow(to[0]));
                [part * d[1] * d[1], arm * d[1] * d[1] + 2.0 * (d[0] * d[1]).abs()]
            }
            (JointType::Revolute { .. }, JointType::Prismatic { direction }) => {
                let origin = |q2: f64| (offset + q2 * direction).norm();
                let arm = part + origin(from[1]).max(origin(to[1]));
                [arm * d[0] * d[0] + 2.0 * (d[0] * d[1]).abs(), piece * d[0] * d[0]]
            }
            (JointType::Prismatic { .. }, JointType::Prismatic { .. }) => [0.0, 0.0],
        }
    }
}

/// Computes the bound that [`PairMotion`] explains. `least` is `G`, `cosine` is `c`, and `curvature` is `k`. `across`
/// has the gap at the start along the direction of the end, and the gap at the end along the direction of the start.
fn bound(least: f64, across: [f64; 2], cosine: f64, curvature: f64) -> f64 {
    // At each end, its own direction has the greatest gap. So only rounding can make this negative.
    let defect = (2.0 * least - across[0] - across[1]).max(0.0);
    let middle = least - defect / 4.0;
    if middle <= 0.0 || cosine <= 0.0 {
        return f64::NEG_INFINITY;
    }
    least.min(middle * (1.0 + (1.0 - cosine).max(0.0) / 4.0) - curvature / 8.0)
}
