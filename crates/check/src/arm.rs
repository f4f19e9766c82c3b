//! A planar arm of two joints, as a robot's file describes it.

use crate::domain::{Axis, Domain, Range};
use crate::interval::Point;
use crate::joint_sum::JointSum;
use crate::obstacle::Obstacle;
use crate::shapes::{Body, CollisionShape};

/// Planar motion that a joint gives to the links that it carries.
#[derive(Debug, Clone)]
pub enum Motion {
    /// Rotation by the joint's value. The sign is 1 if positive values turn to the left, and -1 if to the right.
    Turn(i32),
    /// Translation by the joint's value along a direction of unit length.
    Slide(Point),
}

/// One of the two joints.
pub struct Joint {
    /// Name in the robot's file.
    pub name: String,
    /// Motion that the joint gives to the links that it carries.
    pub motion: Motion,
    /// Set of the joint's values: an interval or a circle.
    pub axis: Axis,
    /// A range of values that certainly satisfy the limits. `None` if the joint has no limits.
    pub within: Option<Range>,
}

/// A planar arm. All positions are given with both joints at 0.
pub struct Arm {
    /// The two joints. The first carries the second.
    pub joints: [Joint; 2],
    /// Origin of the first joint, in plane coordinates.
    pub base: Point,
    /// Origin of the second joint, in the frame of the first.
    pub offset: Point,
    /// The configuration space, without the limits of [`Self::sum`].
    pub domain: Domain,
    /// Limits of a sum of both joint values, if there are any.
    pub sum: Option<JointSum>,
    /// Name of the link whose origin is the tip.
    pub tip_link: String,
    /// The tip as a body without extent.
    pub tip: Body,
    /// All shapes that can collide.
    pub shapes: Vec<CollisionShape>,
    /// Shapes that other links of the robot can hit: shapes of static links, and shapes that joint 1 carries. The
    /// latter are in plane coordinates, with joint 1 at zero.
    pub bases: Vec<CollisionShape>,
    /// Obstacles made from [`Self::bases`], in the same order.
    pub own: Vec<Obstacle>,
    /// Sentences for messages, about assumptions that differ from the robot's file.
    pub notes: String,
}
