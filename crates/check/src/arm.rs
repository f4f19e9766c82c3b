//! A planar arm of two joints, as a robot's file describes it.

use crate::certificate::Certificate;
use crate::domain::{Axis, Domain, Range};
use crate::error::CheckError;
use crate::interval::Point;
use crate::mover::{Cell, MovingBody};
use crate::obstacle::Obstacle;
use crate::shapes::{Body, CollisionShape, Outline};

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
    /// A range of values that certainly lies within the limits. `None` if the joint has no limits.
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
    /// The configuration space.
    pub domain: Domain,
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
    /// Sentences for messages. They state assumptions that differ from the robot's file.
    pub notes: String,
}

impl Arm {
    /// Ignores contact between the pairs of links that the certificate lists. Such links overlap in every
    /// configuration.
    ///
    /// # Errors
    /// If a pair does not overlap where the motion begins.
    pub fn ignore(&mut self, certificate: &Certificate) -> Result<(), CheckError> {
        let first = certificate.motion.as_ref().and_then(|motion| motion.knots.first()?.get(1..3));
        let cell = first.map(|q| Cell::from(&[0, 1].map(|k| [q[k].clone(), q[k].clone()])));
        for [a, b] in &certificate.ignored {
            let is_pair = |own: &CollisionShape, other: &CollisionShape| {
                [a, b] == [&own.link, &other.link] || [b, a] == [&own.link, &other.link]
            };
            let meet = |own: &CollisionShape, other: &CollisionShape| {
                let heights = other.within.inset_heights(Outline::Within);
                let mover = MovingBody::new(self, &own.within);
                let cell = cell.clone().map(|cell| cell.for_link(Some(&other.owner())));
                own.within.overlaps_heights(heights.as_ref())
                    && cell.is_none_or(|cell| mover.overlaps(&other.within.shape, &cell))
            };
            let pairs = self.shapes.iter().flat_map(|own| self.bases.iter().map(move |other| (own, other)));
            if !pairs.filter(|(own, other)| is_pair(own, other)).any(|(own, other)| meet(own, other)) {
                let why = format!(
                    "links \"{a}\" and \"{b}\" do not overlap where the motion begins, so their contact counts"
                );
                return CheckError::fails(why);
            }
            for own in &mut self.shapes {
                let other = [(a, b), (b, a)].into_iter().find(|(link, _)| own.link == **link);
                own.ignored.extend(other.map(|(_, other)| other.clone()));
            }
            self.notes += &format!(
                "; contact of links \"{a}\" and \"{b}\" is ignored, as the certificate says that they always overlap"
            );
        }
        Ok(())
    }
}
