//! Errors of a robot and its place that a motion must allow for.

use super::{Arm, Carrier, Contact, Growth, Joint, Obstacle, Pair, Part, Scene};
use crate::space::JointRange;
use cplan_geometry::Point;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Bounds on the differences between a robot and its description, each in any direction. Obstacles have their own
/// ([`super::Growth::error`]).
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// Displacement of joint 1, metres.
    pub base_shift: f64,
    /// Rotation of the whole robot about joint 1, radians.
    pub base_turn: f64,
    /// Error of each link's length, metres: the greatest displacement of joint 2 on link 1, and of each point of a link
    /// on the link.
    pub links: f64,
    /// Offset of the zero of a joint that turns, radians.
    pub zero_turn: f64,
    /// Offset of the zero of a joint that slides, metres.
    pub zero_slide: f64,
}

impl Calibration {
    /// Returns, for each link, a bound on the displacement of its points that errors of lengths and zeros cause,
    /// relative to the robot's base, metres.
    ///
    /// With `e` the error of lengths, `z1` and `z2` those of zeros, `r1` and `r2` the greatest distances of the links'
    /// points from their joints, and `d` that of joint 2 from joint 1:
    ///
    /// ```text
    /// link 1: e + z1 (r1 + e)
    /// link 2: 2 e + z1 (d + r2 + 2 e) + z2 (r2 + e)
    /// ```
    ///
    /// For a joint that slides, the factor is 1 instead of a length.
    pub fn displacements(&self, arm: &Arm) -> [f64; 2] {
        let reach = |link: usize| {
            let points = arm.links[link].parts.iter().map(|part| part.shape.reach_from(Point::zeros()));
            points.fold(0.0, f64::max)
        };
        let zero = |joint: &Joint, lever: f64| match joint.joint_type.is_revolute() {
            true => self.zero_turn * lever,
            false => self.zero_slide,
        };
        let ([first, second], e) = (&arm.joints, self.links);
        let (r1, r2) = (reach(0), reach(1));
        let between = arm.offset.norm() + slide(second);
        [e + zero(first, r1 + e), 2.0 * e + zero(first, between + r2 + 2.0 * e) + zero(second, r2 + e)]
    }
}

/// Returns the greatest distance by which a joint slides from its zero, metres; 0 for a joint that turns.
pub(super) fn slide(joint: &Joint) -> f64 {
    match (joint.joint_type.is_revolute(), joint.range) {
        (true, _) => 0.0,
        (false, JointRange::Interval { lower, upper }) => lower.abs().max(upper.abs()),
        (false, JointRange::Circle) => f64::INFINITY,
    }
}

impl Scene {
    /// Returns the scene for all robots within the errors: a motion that is free here is free for each of them.
    ///
    /// In [`Scene::inner`] only displacements of obstacles and of the base are left. A configuration that collides there
    /// collides for a displacement of the obstacle within the errors. So a proof that there is no motion shows that no
    /// motion is free for all of them.
    ///
    /// Obstacles are grown by the displacement of the base, and by its rotation times the distance from joint 1. Parts of
    /// the links are grown by [`Calibration::displacements`].
    #[must_use]
    pub fn within_errors(&self, errors: &Calibration) -> Self {
        let arm = self.arm();
        let displacements = errors.displacements(arm);
        let (base, clearance) = (arm.base, self.workspace().clearance);
        let reach = arm.reach() + arm.joints.iter().map(slide).sum::<f64>() + displacements[1] + errors.base_shift;
        let place = |obstacle: &mut Obstacle, farthest: f64| {
            // Only points that the robot can come near to matter.
            let lever = farthest.min(reach + clearance.max(obstacle.growth.clearance));
            obstacle.growth.error += errors.base_shift;
            obstacle.growth.padding += errors.base_turn * lever;
            obstacle.grow(clearance);
        };
        let changed = self.changed(|arm, workspace| {
            for (link, distance) in arm.links.iter_mut().zip(displacements) {
                link.parts.iter_mut().for_each(|part| part.pad(distance));
            }
            for own in arm.self_obstacles.iter_mut().filter(|own| own.carrier == Carrier::FirstJoint) {
                own.obstacle.growth.padding += errors.links;
                own.obstacle.grow(clearance);
            }
            for obstacle in &mut workspace.obstacles {
                let farthest = obstacle.pieces.iter().map(|piece| piece.reach_from(base)).fold(0.0, f64::max);
                place(obstacle, farthest);
            }
        });
        changed.with_loose(|obstacle| place(obstacle, f64::INFINITY))
    }

    /// Returns the scene without growth for errors and for obstacles' own clearances. Pairs keep their
    /// numbers.
    pub fn drawn(&self) -> Cow<'_, Self> {
        let is_padded = |link: usize| self.own_parts(link).iter().any(|part| part.padding > 0.0);
        let loose = self.loose_obstacles().iter().map(|loose| &loose.obstacle);
        let mut obstacles = self.workspace().obstacles.iter().chain(loose);
        if !(0..2).any(is_padded) && obstacles.all(|obstacle| obstacle.growth.is_none()) {
            return Cow::Borrowed(self);
        }
        let real = |obstacle: &mut Obstacle| {
            obstacle.growth = Growth { total: obstacle.growth.total, ..Growth::default() };
            obstacle.grow(0.0);
        };
        let drawn = self.changed(|arm, workspace| {
            arm.links.iter_mut().flat_map(|link| &mut link.parts).for_each(Part::unpad);
            let own = arm.self_obstacles.iter_mut().map(|own| &mut own.obstacle);
            workspace.obstacles.iter_mut().chain(own).for_each(real);
        });
        Cow::Owned(drawn.with_loose(real))
    }

    /// Returns the signed distance of a contact's real shapes, metres.
    pub fn real_distance(&self, contact: &Contact) -> f64 {
        contact.separation.distance + self.growth(contact.pair)
    }

    /// Returns the distance, metres, by which a pair's shapes have been grown beyond the real ones: for the obstacle's own
    /// clearance, and for errors.
    pub fn growth(&self, pair: Pair) -> f64 {
        self.link(pair).parts[pair.part].padding + self.obstacle(pair.obstacle).growth.total
    }

    /// Returns the least distance, metres, that a pair's real shapes must keep.
    pub fn required(&self, pair: Pair) -> f64 {
        self.workspace().clearance + self.growth(pair)
    }
}
