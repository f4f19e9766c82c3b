//! The shapes and parts of obstacles to which evidence refers, and tests whether they overlap.

use crate::arm::Arm;
use crate::certificate::{Certificate, CollisionBox, PartName, ShapeName};
use crate::decimal::Decimal;
use crate::domain::{Range, Rectangle};
use crate::error::{CheckError, Input};
use crate::interval::Interval;
use crate::mover::{Cell, MovingBody};
use crate::overlap::Shape;
use crate::shapes::{Body, CollisionShape, Owner, named};
use crate::world::World;

mod own;

/// A part before it is grown by the clearance. The entries are its link if it belongs to the robot, its shape, and its heights.
type Evident = (Option<Owner>, Shape, Option<Range>);

/// Hint for parts whose name matches nothing, or several shapes.
const PART_HINT: &str = "a part needs \"obstacle\", or \"own\" (a link of the robot) with the number of a shape";

/// A part of an obstacle or of the robot to which evidence refers, grown by the clearance.
struct Part {
    /// The link, if the part belongs to the robot.
    link: Option<Owner>,
    shape: Shape,
    heights: Option<Range>,
}

/// A shape and a part that can collide.
pub struct Pair<'a> {
    /// The shape of the arm.
    pub body: &'a Body,
    /// The part, grown by the clearance.
    pub part: &'a Shape,
    /// The link, if the part belongs to the robot. The overlap is then tested in the box that [`Cell::for_link`] returns.
    pub beside: Option<&'a Owner>,
}

/// All shapes and parts to which a certificate refers.
pub struct Contacts<'a> {
    shapes: Vec<&'a CollisionShape>,
    parts: Vec<Part>,
}

impl<'a> Contacts<'a> {
    /// Finds all shapes and parts to which a certificate refers.
    ///
    /// # Errors
    /// The first reference that matches nothing.
    pub fn new(
        arm: &'a Arm,
        world: &World,
        certificate: &Certificate,
        clearance: &Decimal,
    ) -> Result<Self, CheckError> {
        let part = |(number, name): (usize, &PartName)| {
            let (link, shape, heights) = match name.obstacle {
                Some(obstacle) => part_of(world, number, obstacle, name)?,
                None => own::part(arm, name)?,
            };
            Ok(Part { link, shape: shape.grown(&Interval::from(clearance)), heights })
        };
        let shapes = certificate.shapes.iter().map(|name| shape(arm, name)).collect::<Result<_, _>>()?;
        let parts = certificate.parts.iter().enumerate().map(part).collect::<Result<_, _>>()?;
        Ok(Self { shapes, parts })
    }

    /// Checks for each box that the shape and the part collide, or violate the clearance, in all configurations of the box.
    ///
    /// # Errors
    /// The first box for which this is not shown.
    pub fn check_boxes(&self, arm: &Arm, stuck: &[CollisionBox], boxes: &[Rectangle]) -> Result<(), CheckError> {
        for (number, (stuck, ranges)) in stuck.iter().zip(boxes).enumerate() {
            let Pair { body, part, beside } = self.pair(stuck.shape, stuck.part, || format!("box {number}"))?;
            if !MovingBody::new(arm, body).overlaps(part, &Cell::from(ranges).for_link(beside)) {
                return CheckError::fails(format!(
                    "box {number}: the shape does not touch the part everywhere in the box"
                ));
            }
        }
        Ok(())
    }

    /// Finds a shape and a part that can collide. `who` names the box or wall in messages.
    ///
    /// # Errors
    /// If an index is too large, if the heights of shape and part do not overlap, or if the two are allowed to touch.
    pub fn pair(&self, shape: usize, part: usize, who: impl Fn() -> String) -> Result<Pair<'_>, CheckError> {
        let fails = |why: &str| CheckError::fails(format!("{}{why}", who()));
        let (Some(shape), Some(part)) = (self.shapes.get(shape), self.parts.get(part)) else {
            return fails(": the shape or the part does not exist");
        };
        let (body, beside) = (&shape.within, part.link.as_ref());
        let meets = match beside {
            Some(_) => body.overlaps_heights(part.heights.as_ref()),
            None => body.touches_heights(part.heights.as_ref()),
        };
        if !meets {
            return fails(": the shape passes over or under the obstacle");
        }
        match beside {
            Some(Owner { shape: other, .. }) if shape.ignored.contains(other) => {
                fails(&format!(": the shape is allowed to touch {other}"))
            }
            _ => Ok(Pair { body, part: &part.shape, beside }),
        }
    }
}

/// Finds a convex part of an obstacle of the world.
fn part_of(world: &World, number: usize, obstacle: usize, name: &PartName) -> Result<Evident, CheckError> {
    if name.own.is_some() || name.collision.is_some() || name.visual.is_some() || name.height.is_some() {
        return Err(CheckError::in_file(Input::Certificate, PART_HINT));
    }
    let Some(standing) = world.obstacles.get(obstacle) else {
        return CheckError::fails(format!("part {number}: obstacle {obstacle} does not exist"));
    };
    let shape = standing.part(name.corners.as_deref().unwrap_or_default()).map_err(|why| match why {
        CheckError::Fails(why) => CheckError::Fails(format!("part {number}, of obstacle {obstacle}: {why}")),
        input => input,
    })?;
    Ok((None, shape, standing.heights.clone()))
}

/// Finds a shape by the name that evidence uses for it.
fn shape<'a>(arm: &'a Arm, name: &ShapeName) -> Result<&'a CollisionShape, CheckError> {
    let (kind, number) = match (name.collision, name.visual, name.bar) {
        (Some(number), None, None) => ("collision", number),
        (None, Some(number), None) => ("visual", number),
        (None, None, Some(0)) => ("bar", 0),
        _ => return Err(CheckError::in_file(Input::Certificate, "a shape needs a link and one number (0 for a bar)")),
    };
    named(&arm.shapes, (&name.link, kind, number), name.height.as_ref())
}
