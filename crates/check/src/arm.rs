//! An arm in the plane, as it is read from a robot's file.

use crate::certificate::Certificate;
use crate::domain::{Axis, Domain, Range};
use crate::error::CheckError;
use crate::interval::Point;
use crate::mover::{Cell, Mover};
use crate::obstacle::Obstacle;
use crate::shapes::{Body, Counted, Outline};

/// How a joint moves what it carries, in the plane.
#[derive(Debug, Clone)]
pub enum Motion {
    /// By its value, left (1) or right (-1).
    Turn(i32),
    /// Along a direction of unit length.
    Slide(Point),
}

/// One of the two joints.
pub struct Joint {
    /// Its name in the robot's file.
    pub name: String,
    /// How it moves what it carries.
    pub motion: Motion,
    /// What holds all its values, ...
    pub axis: Axis,
    /// ... and what they are known to be within, if they have limits.
    pub within: Option<Range>,
}

/// An arm in the plane. Where its parts are is said for both joints at 0.
pub struct Arm {
    /// The two joints. The first carries the second.
    pub joints: [Joint; 2],
    /// Origin of the first joint.
    pub base: Point,
    /// Origin of the second joint as seen from the first.
    pub offset: Point,
    /// All values of both joints.
    pub domain: Domain,
    /// The link whose origin is the tip, ...
    pub tip_link: String,
    /// ... and the tip as a body without extent.
    pub tip: Body,
    /// All that can collide, ...
    pub shapes: Vec<Counted>,
    /// ... shapes of the robot that others of its links can hit: of links that stand still, and of those that joint 1 carries, in the plane where they
    /// are with joint 1 at zero, ...
    pub bases: Vec<Counted>,
    /// ... and the obstacles that they make.
    pub own: Vec<Obstacle>,
    /// What is taken to be otherwise than the robot's file has it, in words.
    pub notes: String,
}

impl Arm {
    /// Lets the pairs of links collide that the certificate ignores.
    ///
    /// # Errors
    /// When a pair does not overlap where the motion begins.
    pub fn ignore(&mut self, certificate: &Certificate) -> Result<(), CheckError> {
        let first = certificate.motion.as_ref().and_then(|motion| motion.knots.first()?.get(1..3));
        let cell = first.map(|q| Cell::from(&[0, 1].map(|k| [q[k].clone(), q[k].clone()])));
        for [a, b] in &certificate.ignored {
            let is_pair = |own: &Counted, other: &Counted| {
                [a, b] == [&own.link, &other.link] || [b, a] == [&own.link, &other.link]
            };
            let meet = |own: &Counted, other: &Counted| {
                let heights = other.within.kept(Outline::Within);
                let mover = Mover::new(self, &own.within);
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
