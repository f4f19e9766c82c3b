//! Obstacles: convex parts of them, and what a shape has to stay off.

use crate::decimal::Decimal;
use crate::domain::Range;
use crate::error::{CheckError, Input};
use crate::interval::{BITS, Interval, Point, minus, sum, turned};
use crate::overlap::{Shape, hull};
use crate::polygon::{self, Corner, edges, surrounds};
use crate::shapes::Owner;
use num_bigint::{BigInt, Sign};
use std::borrow::Cow;
use std::rc::Rc;

/// An obstacle, as it stands in the file.
#[derive(Clone)]
pub struct Obstacle {
    /// Its name, if it has one.
    pub name: Option<String>,
    /// The link, if it is part of the robot.
    pub own: Option<Owner>,
    /// Its outline, in its frame.
    pub outline: Outline,
    /// Where its frame's origin lies, ...
    pub at: Point,
    /// ... and sine and cosine of how the frame is turned.
    pub turn: Point,
    /// Its extent along the plane's normal; none: everywhere.
    pub heights: Option<Range>,
    /// How its frame moves, if it does: then the place is that where it would stand if its motion did not say.
    pub course: Option<Rc<dyn Course>>,
}

/// What an obstacle covers.
#[derive(Clone)]
pub enum Outline {
    /// What its rings surround an odd number of times.
    Polygon(Vec<Vec<Corner>>),
    /// Segments from each point to the next.
    Polyline(Vec<Corner>),
    /// A disc; of radius 0 a point.
    Circle(Corner, Decimal),
    /// Squares of a picture, or why they are not known.
    Squares(Result<Rc<dyn Squares>, CheckError>),
    /// A link of the robot.
    Own(Shape),
}

/// How the frame of an obstacle moves.
pub trait Course {
    /// Returns where the frame's origin is at a time, and sine and cosine of how the frame is turned.
    fn place(&self, time: &Decimal) -> [Point; 2];

    /// Returns what holds a shape of the frame all over a span of time.
    fn during(&self, shape: &Shape, span: [&Decimal; 2]) -> Shape;
}

/// Squares of a picture, in the frame of its obstacle.
pub trait Squares {
    /// Returns the corners of the rectangle of solid squares that are nearest to four points; none if there is no such rectangle.
    fn part(&self, given: &[Point]) -> Option<Vec<Point>>;

    /// Returns the border between what is solid and what is not, in straight pieces.
    ///
    /// # Errors
    /// More pieces than can be looked at.
    fn border(&self) -> Result<Vec<[Point; 2]>, CheckError>;

    /// Whether a point that is off the border is in something solid.
    fn holds(&self, p: &Point) -> bool;
}

/// Encloses a corner.
pub fn point(corner: &Corner) -> Point {
    corner.each_ref().map(Interval::from)
}

impl Obstacle {
    /// Makes an obstacle of a link.
    pub fn link(name: String, owner: Owner, shape: Shape, heights: Option<Range>) -> Self {
        let [at, turn] = [[0, 0], [0, 1]].map(|of| of.map(Interval::whole));
        Self { name: Some(name), own: Some(owner), outline: Outline::Own(shape), at, turn, heights, course: None }
    }

    /// Whether joint 1 carries it.
    pub fn is_carried(&self) -> bool {
        self.own.as_ref().is_some_and(|own| own.is_carried)
    }

    /// Returns its name for messages.
    pub fn called(&self, number: usize) -> String {
        match (&self.own, &self.name) {
            (Some(_), Some(name)) => name.clone(),
            _ => format!("obstacle {number}"),
        }
    }

    /// The same elsewhere, where it stands.
    pub fn moved(self, at: Point, turn: Point) -> Self {
        Self { at, turn, course: None, ..self }
    }

    /// The same where it is at a time.
    pub fn at_time(&self, time: &Decimal) -> Cow<'_, Self> {
        self.course.as_ref().map_or(Cow::Borrowed(self), |course| {
            let [at, turn] = course.place(time);
            Cow::Owned(self.clone().moved(at, turn))
        })
    }

    /// A point of its frame in its place.
    pub fn placed(&self, p: &Point) -> Point {
        sum(&self.at, &turned(p, &self.turn))
    }

    /// A point of the plane in its frame.
    fn own(&self, p: &Point) -> Point {
        let [sine, cosine] = &self.turn;
        turned(&minus(p, &self.at), &[-sine, cosine.clone()])
    }

    /// A convex part of it, in its place: a disc all of it, of a polyline two points that follow one another, of a polygon
    /// a convex polygon within, of a picture a rectangle of solid squares. Its corners are the obstacle's that are nearest to the given points.
    ///
    /// # Errors
    /// Why it is no such part; as [`CheckError::Input`] if the obstacle is not known.
    pub fn part(&self, given: &[Corner]) -> Result<Shape, CheckError> {
        if self.course.is_some() {
            return CheckError::fails("it moves, and is not always there");
        }
        let placed = |p: &Point| self.placed(p);
        let named = |corners: &[&Corner]| {
            let places: Vec<Point> = corners.iter().map(|corner| placed(&point(corner))).collect();
            given.iter().filter_map(|at| Some(corners[nearest(&places, &point(at))?].clone())).collect::<Vec<Corner>>()
        };
        let shape = |corners: &[Corner], radius: Interval| Shape {
            points: corners.iter().map(|corner| placed(&point(corner))).collect(),
            radius,
        };
        let thin = Interval::whole(0);
        match &self.outline {
            Outline::Circle(_, radius) if radius.sign() == Sign::Minus => CheckError::fails("its radius is negative"),
            Outline::Circle(center, radius) => Ok(shape(std::slice::from_ref(center), Interval::from(radius))),
            Outline::Polyline(points) => {
                let part = named(&points.iter().collect::<Vec<_>>());
                let is_side = |side: &[Corner]| part == side || part.iter().rev().eq(side);
                match points.windows(2).any(is_side) {
                    true => Ok(shape(&part, thin)),
                    false => {
                        CheckError::fails("its corners are not two points that follow one another in the polyline")
                    }
                }
            }
            Outline::Polygon(rings) => {
                // Corners between others on a line say nothing.
                let part = hull(named(&rings.iter().flatten().collect::<Vec<_>>()));
                match polygon::holds(rings, &part) {
                    true => Ok(shape(&part, thin)),
                    false => CheckError::fails("its corners are not those of a convex polygon within the obstacle"),
                }
            }
            Outline::Own(_) => CheckError::fails("it is a link of the robot"),
            Outline::Squares(cells) => {
                let cells = cells.as_ref().map_err(Clone::clone)?;
                let given: Vec<Point> = given.iter().map(|p| self.own(&point(p))).collect();
                match cells.part(&given) {
                    Some(corners) => Ok(Shape { points: corners.iter().map(placed).collect(), radius: thin }),
                    None => CheckError::fails("its corners are not those of a rectangle of solid squares"),
                }
            }
        }
    }

    /// The segments of its border, or its disc, or a link's shape, in their places; of what moves in its own frame. What is connected, touches none of them and is not inside is off
    /// the obstacle.
    ///
    /// # Errors
    /// An obstacle that the checker does not know, or that is none.
    pub fn sides(&self) -> Result<Vec<Shape>, CheckError> {
        let placed = |p: &Point| if self.course.is_some() { p.clone() } else { self.placed(p) };
        let side = |points: &[Point], radius: Interval| Shape { points: points.iter().map(placed).collect(), radius };
        let thin = |a: &Corner, b: &Corner| side(&[point(a), point(b)], Interval::whole(0));
        match &self.outline {
            Outline::Polygon(rings) if rings.iter().all(|ring| ring.len() > 2) => {
                Ok(rings.iter().flat_map(|ring| edges(ring)).map(|(a, b)| thin(a, b)).collect())
            }
            Outline::Polyline(points) if points.len() > 1 => {
                Ok(points.windows(2).map(|ends| thin(&ends[0], &ends[1])).collect())
            }
            Outline::Circle(center, radius) if radius.sign() != Sign::Minus => {
                Ok(vec![side(&[point(center)], Interval::from(radius))])
            }
            Outline::Squares(cells) => {
                let cells = cells.as_ref().map_err(Clone::clone)?;
                Ok(cells.border()?.iter().map(|ends| side(ends, Interval::whole(0))).collect())
            }
            Outline::Own(shape) => Ok(vec![shape.clone()]),
            _ => Err(CheckError::in_file(Input::World, "an obstacle has too few points, or no radius")),
        }
    }

    /// Whether a point is inside that is farther than this from all of its border. None if the point is not known well enough
    /// to say.
    pub fn surrounds(&self, at: &Point, farther: &BigInt) -> Option<bool> {
        let own = self.own(at).map(|c| c.middle());
        // What stands in for the point is nearer to it than any ring.
        let is_near = own.iter().map(|(_, radius)| radius).sum::<BigInt>() < *farther;
        let own = own.map(|(middle, _)| middle);
        is_near.then(|| match &self.outline {
            Outline::Polygon(rings) => surrounds(rings, &own.map(|middle| Decimal::dyadic(&middle, BITS))),
            Outline::Squares(Ok(cells)) => cells.holds(&own.map(Interval::exactly)),
            Outline::Squares(Err(_)) | Outline::Polyline(_) | Outline::Circle(..) | Outline::Own(_) => false,
        })
    }
}

/// Which of the places is nearest, as the middles of their enclosures have it.
fn nearest(places: &[Point], to: &Point) -> Option<usize> {
    let distance = |place: &Point| {
        let [x, y] = [0, 1].map(|k| (&place[k] - &to[k]).middle().0);
        &x * &x + &y * &y
    };
    (0..places.len()).min_by_key(|i| distance(&places[*i]))
}
