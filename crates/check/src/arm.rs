//! A planar arm, as read from a robot's file.

use crate::certificate::Certificate;
use crate::domain::{Axis, Domain, Range};
use crate::error::CheckError;
use crate::interval::Point;
use crate::mover::{Cell, MovingBody};
use crate::obstacle::Obstacle;
use crate::shapes::{Body, CollisionShape, Outline};

/// Planar motion that a joint gives to the links beyond it.
#[derive(Debug, Clone)]
pub enum Motion {
    /// Rotation by the joint's value, to the left (1) or to the right (-1).
    Turn(i32),
    /// Translation along a direction of unit length.
    Slide(Point),
}

/// One of the two joints.
pub struct Joint {
    /// Name in the robot's file.
    pub name: String,
    /// Motion that the joint gives to the links beyond it.
    pub motion: Motion,
    /// Set of all values of the joint.
    pub axis: Axis,
    /// Enclosure of the limits, if the joint has limits.
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
    /// All values of both joints.
    pub domain: Domain,
    /// Link whose origin is the tip.
    pub tip_link: String,
    /// The tip as a body without extent.
    pub tip: Body,
    /// All shapes that can collide.
    pub shapes: Vec<CollisionShape>,
    /// Shapes of the robot that its other links can hit: those of static links, and those that joint 1 carries. The
    /// latter are placed in the plane as with joint 1 at zero.
    pub bases: Vec<CollisionShape>,
    /// Obstacles made from these shapes.
    pub own: Vec<Obstacle>,
    /// Sentences for messages: assumptions that differ from the robot's file.
    pub notes: String,
}

impl Arm {
    /// Ignores contact between the pairs of links that the certificate lists.
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
                let heights = other.within.kept(Outline::Within);
                let mover = MovingBody::new(self, &own.within);
                let cell = cell.clone().map(|cell| cell.beside(Some(&other.owner())));
                own.within.is_at(heights.as_ref()) && cell.is_none_or(|cell| mover.overlaps(&other.within.shape, &cell))
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
