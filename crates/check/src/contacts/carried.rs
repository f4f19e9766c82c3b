//! What hangs on the arm, as evidence names it.

use super::Part;
use crate::error::CheckError;
use crate::interval::{Interval, Point};
use crate::overlap::Shape;
use crate::polygon::Corner;
use crate::robot::{Arm, Body};
use crate::world::Obstacle;
use std::borrow::Cow;

/// What hangs on the arm.
pub struct Carried {
    /// As it lies to the second link; or else, if a wrist keeps it level, to the tip.
    pub hanging: Obstacle,
    pub is_level: bool,
    pub heights: Option<[Interval; 2]>,
    /// What it may touch.
    pub supports: Vec<usize>,
    /// What of it stays off these, if it has any.
    pub pressed: Option<Result<Obstacle, CheckError>>,
}

/// A convex part of it.
pub struct Hung {
    /// Of what is kept level it is the tip.
    pub body: Body,
    /// What is kept level, as seen from the tip.
    pub about_tip: Option<Shape>,
    /// What of it stays off its supports.
    pressed: Option<Result<Shape, CheckError>>,
}

impl Carried {
    /// A convex part of it.
    ///
    /// # Errors
    /// Why it is none.
    pub fn hung(&self, arm: &Arm, corners: &[Corner]) -> Result<Hung, CheckError> {
        let (shape, heights) = (part(&self.hanging, corners)?, self.heights.clone());
        let pressed = self.pressed.as_ref();
        let named = |own: &Obstacle| part(own, &self.hanging.moved_corners(own, corners));
        let pressed = pressed.map(|own| own.as_ref().map_err(Clone::clone).and_then(named));
        let (body, about_tip) = match self.is_level {
            false => (Body { link: 1, shape, heights }, None),
            true => (Body { heights, ..arm.tip.clone() }, Some(shape)),
        };
        Ok(Hung { body, about_tip, pressed })
    }
}

/// A convex part of what hangs that is named by its corners in its own frame, as it hangs.
fn part(hanging: &Obstacle, corners: &[Corner]) -> Result<Shape, CheckError> {
    let own = hanging.clone().moved([0, 0].map(Interval::whole), [0, 1].map(Interval::whole));
    let Shape { points, radius } = own.part(corners)?;
    Ok(Shape { points: points.iter().map(|p| hanging.placed(p)).collect(), radius })
}

impl Hung {
    /// A body and a shape that meet exactly where it, or what of it stays off supports, is too near the part.
    ///
    /// # Errors
    /// Why it is not known what stays off.
    pub fn against<'a>(&'a self, part: &'a Part, rests: bool) -> Result<(Cow<'a, Body>, Cow<'a, Shape>), CheckError> {
        let (mut body, mut about_tip) = (Cow::Borrowed(&self.body), self.about_tip.as_ref().map(Cow::Borrowed));
        let mut shape = Cow::Borrowed(&part.shape);
        if let Some(pressed) = self.pressed.as_ref().filter(|_| rests) {
            let pressed = pressed.clone()?;
            match &mut about_tip {
                Some(shape) => *shape = Cow::Owned(pressed),
                None => body.to_mut().shape = pressed,
            }
            shape.to_mut().radius = part.radius.clone();
        }
        let Some(about_tip) = about_tip else { return Ok((body, shape)) };
        let Shape { points, radius } = &*about_tip;
        // It meets the part exactly where the tip is at a difference of a point of the part and one of it.
        let from = |p: &Point| points.iter().map(|c| [&p[0] - &c[0], &p[1] - &c[1]]).collect::<Vec<Point>>();
        let points = shape.points.iter().flat_map(from).collect();
        Ok((body, Cow::Owned(Shape { points, radius: &shape.radius + radius })))
    }
}
