//! The shapes and the parts of obstacles that evidence names, and whether they overlap.

use crate::arm::{Cell, Mover};
use crate::certificate::{Certificate, PartName, ShapeName, StuckBox};
use crate::decimal::Decimal;
use crate::domain::{Range, Rectangle};
use crate::error::{CheckError, Input};
use crate::interval::Interval;
use crate::overlap::Shape;
use crate::robot::{Arm, Body, named as named_shape};
use crate::world::{Obstacle, Owner, World};
use carried::Hung;
use std::borrow::Cow;
use std::collections::BTreeSet;

mod carried;
mod own;

pub use carried::Carried;

/// What stands where, and what the arm carries.
pub struct Among<'a> {
    /// Obstacles and objects in their places; none of what is carried, or is not known where it lies.
    pub standing: Vec<Option<Cow<'a, Obstacle>>>,
    /// Obstacles that the second link is free to meet.
    pub allowed: Vec<usize>,
    pub carried: Option<Carried>,
    /// The joint that lowers the tool, and by how much, if all that it carries is at all heights of that.
    pub lowered: Option<(&'a str, Decimal)>,
}

impl<'a> Among<'a> {
    /// All as it is in the world file.
    pub fn all(world: &'a World) -> Self {
        Self {
            standing: world.obstacles.iter().map(|o| Some(Cow::Borrowed(o))).collect(),
            allowed: vec![],
            carried: None,
            lowered: None,
        }
    }

    /// Finds a convex part of an obstacle.
    fn part(&self, number: usize, obstacle: usize, name: &PartName) -> Result<Evident, CheckError> {
        let fails = |why: &str| CheckError::Fails(format!("part {number}, of obstacle {obstacle}: {why}"));
        if name.own.is_some() || name.collision.is_some() || name.visual.is_some() || name.height.is_some() {
            return Err(CheckError::in_file(Input::Certificate, PART));
        }
        let Some(standing) = self.standing.get(obstacle) else {
            return CheckError::fails(format!("part {number}: there is no obstacle {obstacle}"));
        };
        let Some(standing) = standing else { return Err(fails("it is carried, or not known to stand anywhere")) };
        let shape = standing.part(name.corners.as_deref().unwrap_or_default()).map_err(|why| match why {
            CheckError::Fails(why) => fails(&why),
            input => input,
        })?;
        Ok((Whole::Obstacle(obstacle), shape, standing.heights.clone()))
    }
}

/// The owner of a part, its shape and its heights.
type Evident = (Whole, Shape, Option<Range>);

/// Hint for parts that name nothing, or too much.
const PART: &str = "a part names an obstacle, or by \"own\" a link of the robot and one of its shapes";

/// A shape that evidence names.
enum Named {
    /// A shape of the arm, and the links that it may touch.
    Own(Body, BTreeSet<String>),
    Carried(Hung),
}

/// A part of an obstacle, or a link of the robot, that evidence names, grown by the clearance.
pub struct Part {
    of: Whole,
    shape: Shape,
    /// Its radius without the clearance.
    radius: Interval,
    heights: Option<Range>,
}

/// The owner of a part.
enum Whole {
    /// The obstacle with this number.
    Obstacle(usize),
    /// This link of the robot.
    Link(Owner),
}

/// A shape and a part that can meet.
pub struct Pair<'a> {
    pub body: Cow<'a, Body>,
    pub part: Cow<'a, Shape>,
    /// The link that the part is of, if it is of the robot: then [`Cell::beside`] is the box to look in.
    pub beside: Option<&'a Owner>,
}

/// All that evidence may name, or why it may not.
pub struct Contacts<'a> {
    among: &'a Among<'a>,
    shapes: Vec<Result<Named, CheckError>>,
    parts: Vec<Result<Part, CheckError>>,
}

impl<'a> Contacts<'a> {
    pub fn new(arm: &Arm, among: &'a Among, certificate: &Certificate, clearance: &Decimal) -> Self {
        let shapes = certificate.shapes.iter().map(|name| named(arm, among, name)).collect();
        let part = |(number, name): (usize, &PartName)| {
            let (of, Shape { points, radius }, heights) = match name.obstacle {
                Some(obstacle) => among.part(number, obstacle, name)?,
                None => own::part(arm, name)?,
            };
            let shape = Shape { points, radius: &radius + &Interval::from(clearance) };
            Ok(Part { of, shape, radius, heights })
        };
        Self { among, shapes, parts: certificate.parts.iter().enumerate().map(part).collect() }
    }

    /// Where all that is named can be there.
    ///
    /// # Errors
    /// The first that is not.
    pub fn complete(self) -> Result<Self, CheckError> {
        let errors = self.shapes.iter().filter_map(|shape| shape.as_ref().err());
        let first = errors.chain(self.parts.iter().filter_map(|part| part.as_ref().err())).next().cloned();
        first.map_or(Ok(self), Err)
    }

    /// That in all of each box the shape is too near the part.
    pub fn hold(&self, arm: &Arm, stuck: &[StuckBox], boxes: &[Rectangle]) -> Result<(), CheckError> {
        for (number, (stuck, ranges)) in stuck.iter().zip(boxes).enumerate() {
            let Pair { body, part, beside } = self.pair(stuck.shape, stuck.part, || format!("box {number}"))?;
            if !Mover::new(arm, &body).overlaps(&part, &Cell::from(ranges).beside(beside)) {
                return CheckError::fails(format!("box {number}: within it the shape can come off the part"));
            }
        }
        Ok(())
    }

    /// Finds a shape and a part that can meet.
    pub fn pair(&self, shape: usize, part: usize, who: impl Fn() -> String) -> Result<Pair<'_>, CheckError> {
        let fails = |why: &str| CheckError::fails(format!("{}{why}", who()));
        let (Some(shape), Some(part)) = (self.shapes.get(shape), self.parts.get(part)) else {
            return fails(" names a shape or a part that is not there");
        };
        let (shape, part) = (shape.as_ref().map_err(Clone::clone)?, part.as_ref().map_err(Clone::clone)?);
        let (Named::Own(body, _) | Named::Carried(Hung { body, .. })) = shape;
        if !body.is_at(part.heights.as_ref()) {
            return fails(": the shape passes over or under the obstacle");
        }
        if matches!(shape, Named::Carried(_)) && !body.is_below_top(part.heights.as_ref()) {
            return fails(": the shape rests on the obstacle");
        }
        let is_among = |all: &[usize]| matches!(part.of, Whole::Obstacle(number) if all.contains(&number));
        let beside = match &part.of {
            Whole::Link(link) => Some(link),
            Whole::Obstacle(_) => None,
        };
        match (shape, beside) {
            (Named::Own(_, ignored), Some(Owner { link, .. })) if ignored.contains(link) => {
                fails(&format!(": the shape may meet link \"{link}\""))
            }
            (Named::Own(body, _), _) if body.link == 1 && is_among(&self.among.allowed) => {
                fails(": the shape may meet the obstacle")
            }
            (Named::Own(body, _), _) => {
                Ok(Pair { body: Cow::Borrowed(body), part: Cow::Borrowed(&part.shape), beside })
            }
            (Named::Carried(Hung { about_tip: Some(_), .. }), Some(Owner { link, is_carried: true })) => {
                fails(&format!(": what is carried turns beside link \"{link}\""))
            }
            (Named::Carried(hung), _) => {
                let supports = self.among.carried.as_ref().map(|carried| &carried.supports);
                let (body, part) = hung.against(part, supports.is_some_and(|supports| is_among(supports)))?;
                Ok(Pair { body, part, beside })
            }
        }
    }
}

/// Finds a shape by the name that evidence gives it.
fn named(arm: &Arm, among: &Among, name: &ShapeName) -> Result<Named, CheckError> {
    let own = |link: &str, kind: &str, number: usize| {
        let shape = named_shape(&arm.shapes, (link, kind, number), name.height.as_ref())?;
        let body = match &among.lowered {
            Some((joint, by)) if arm.lowers(joint, shape)? => shape.within.lowered(by),
            _ => shape.within.clone(),
        };
        Ok(Named::Own(body, shape.ignored.clone()))
    };
    match (&name.link, name.collision, name.visual, name.bar, &name.carried) {
        (Some(link), Some(number), None, None, None) => own(link, "collision", number),
        (Some(link), None, Some(number), None, None) => own(link, "visual", number),
        (Some(link), None, None, Some(0), None) => own(link, "bar", 0),
        (None, None, None, None, Some(corners)) => {
            let Some(carried) = &among.carried else { return CheckError::fails("a shape is carried where nothing is") };
            carried.hung(arm, corners).map(Named::Carried)
        }
        _ => {
            Err(CheckError::in_file(Input::Certificate, "a shape has a link and one number, of a bar 0, or is carried"))
        }
    }
}
