//! Obstacles: their convex parts, and the sides from which shapes must keep away.

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

/// An obstacle, as given in the file.
#[derive(Clone)]
pub struct Obstacle {
    /// Name of the obstacle, if the world gives one.
    pub name: Option<String>,
    /// The link that is the obstacle; `None` for an obstacle of the world.
    pub own: Option<Owner>,
    /// Region that the obstacle covers, in its frame.
    pub outline: Outline,
    /// Origin of its frame, in plane coordinates.
    pub at: Point,
    /// Sine and cosine of the frame's orientation.
    pub turn: Point,
    /// Extent along the plane's normal; `None` if unlimited.
    pub heights: Option<Range>,
    /// Motion of the obstacle's frame; `None` for a static obstacle. The motion replaces `at` and `turn`.
    pub trajectory: Option<Rc<dyn ObstacleTrajectory>>,
    /// Required distance and displacement in any direction, metres, that the world states for this obstacle.
    pub stated: [Option<Decimal>; 2],
    /// Distances by which the obstacle is grown: in proofs of a collision, and in proofs of its absence.
    pub grown: [Interval; 2],
}

/// The region that an obstacle covers.
#[derive(Clone)]
pub enum Outline {
    /// All points that the rings enclose an odd number of times.
    Polygon(Vec<Vec<Corner>>),
    /// Segments from each point to the next.
    Polyline(Vec<Corner>),
    /// A disc; a point if the radius is 0.
    Circle(Corner, Decimal),
    /// Squares of a picture, or the reason why they are not known.
    Squares(Result<Rc<dyn Squares>, CheckError>),
    /// The shape of a link of the robot.
    Own(Shape),
}

/// The motion of an obstacle's frame.
pub trait ObstacleTrajectory {
    /// Returns the frame's origin at a time, and the sine and cosine of its orientation.
    fn place(&self, time: &Decimal) -> [Point; 2];

    /// Returns a shape in plane coordinates that contains a shape of the frame at all times of a span.
    fn swept_shape(&self, shape: &Shape, span: [&Decimal; 2]) -> Shape;
}

/// The solid squares of a picture, in the frame of its obstacle. A picture is an occupancy map.
pub trait Squares {
    /// Returns the corners of a rectangle of solid squares. They are the corners of squares that are nearest to the
    /// four given points. Returns `None` if there is no such rectangle.
    fn part(&self, given: &[Point]) -> Option<Vec<Point>>;

    /// Returns the border between solid and free squares, as straight pieces.
    ///
    /// # Errors
    /// If there are more pieces than the checker can handle.
    fn border(&self) -> Result<Vec<[Point; 2]>, CheckError>;

    /// Returns true if a point is in a solid square. The point must not lie on the border.
    fn holds(&self, p: &Point) -> bool;
}

/// Returns an enclosure of a corner.
pub fn point(corner: &Corner) -> Point {
    corner.each_ref().map(Interval::from)
}

impl Obstacle {
    /// Makes an obstacle from a link of the robot.
    pub fn link(name: String, owner: Owner, shape: Shape, heights: Option<Range>) -> Self {
        let outline = Outline::Own(shape);
        Self { name: Some(name), own: Some(owner), heights, ..Self::new(outline) }
    }

    /// Makes a static obstacle whose frame is the plane's, at all heights.
    pub fn new(outline: Outline) -> Self {
        let [at, turn, grown] = [[0, 0], [0, 1], [0, 0]].map(|of| of.map(Interval::whole));
        let (name, own, heights, trajectory) = (None, None, None, None);
        Self { name, own, outline, at, turn, heights, trajectory, stated: [None, None], grown }
    }

    /// Returns true if the obstacle is a link that joint 1 carries.
    pub fn is_carried(&self) -> bool {
        self.own.as_ref().is_some_and(|own| own.is_carried)
    }

    /// Returns the obstacle's name for messages. `number` replaces a missing name.
    pub fn called(&self, number: usize) -> String {
        match (&self.own, &self.name) {
            (Some(_), Some(name)) => name.clone(),
            _ => format!("obstacle {number}"),
        }
    }

    /// Returns the same obstacle at another pose, as a static obstacle.
    pub fn moved(self, at: Point, turn: Point) -> Self {
        Self { at, turn, trajectory: None, ..self }
    }

    /// Returns the same obstacle at its pose at a time.
    pub fn at_time(&self, time: &Decimal) -> Cow<'_, Self> {
        self.trajectory.as_ref().map_or(Cow::Borrowed(self), |trajectory| {
            let [at, turn] = trajectory.place(time);
            Cow::Owned(self.clone().moved(at, turn))
        })
    }

    /// Converts a point of the obstacle's frame to plane coordinates.
    pub fn placed(&self, p: &Point) -> Point {
        sum(&self.at, &turned(p, &self.turn))
    }

    /// Converts a point of the plane to coordinates of the obstacle's frame.
    fn own(&self, p: &Point) -> Point {
        let [sine, cosine] = &self.turn;
        turned(&minus(p, &self.at), &[-sine, cosine.clone()])
    }

    /// Returns a convex part of the obstacle, in plane coordinates:
    /// - of a circle, the whole disc,
    /// - of a polyline, one of its segments,
    /// - of a polygon, a convex polygon within it,
    /// - of a picture, a rectangle of solid squares.
    ///
    /// The part's corners are the corners of the obstacle that are nearest to the given points.
    ///
    /// # Errors
    /// If there is no such part, with the reason. [`CheckError::Input`] if the obstacle could not be read.
    pub fn part(&self, given: &[Corner]) -> Result<Shape, CheckError> {
        if self.trajectory.is_some() {
            return CheckError::fails("the obstacle moves, so it does not block all the time");
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
        let part = match &self.outline {
            Outline::Circle(_, radius) if radius.sign() == Sign::Minus => CheckError::fails("its radius is negative"),
            Outline::Circle(center, radius) => Ok(shape(std::slice::from_ref(center), Interval::from(radius))),
            Outline::Polyline(points) => {
                let part = named(&points.iter().collect::<Vec<_>>());
                let is_side = |side: &[Corner]| part == side || part.iter().rev().eq(side);
                match points.windows(2).any(is_side) {
                    true => Ok(shape(&part, thin)),
                    false => CheckError::fails("the corners are not two consecutive points of the polyline"),
                }
            }
            Outline::Polygon(rings) => {
                // Ignore corners that lie on a line between others.
                let part = hull(named(&rings.iter().flatten().collect::<Vec<_>>()));
                match polygon::holds(rings, &part) {
                    true => Ok(shape(&part, thin)),
                    false => CheckError::fails("the corners do not form a convex polygon within the obstacle"),
                }
            }
            Outline::Own(_) => CheckError::fails("this is a link of the robot, not an obstacle"),
            Outline::Squares(cells) => {
                let cells = cells.as_ref().map_err(Clone::clone)?;
                let given: Vec<Point> = given.iter().map(|p| self.own(&point(p))).collect();
                match cells.part(&given) {
                    Some(corners) => Ok(Shape { points: corners.iter().map(placed).collect(), radius: thin }),
                    None => CheckError::fails("the corners do not form a rectangle of solid squares"),
                }
            }
        };
        part.map(|part| part.grown(&self.grown[0]))
    }

    /// Returns the sides from which shapes must keep away: the segments of the obstacle's border, its disc, or the
    /// link's shape. They are in plane coordinates for a static obstacle, and in its own frame for a moving one.
    ///
    /// The sides suffice, because a connected set that does not touch them is either completely inside the obstacle or
    /// completely outside.
    ///
    /// # Errors
    /// If the obstacle could not be read, or if it has too few points.
    pub fn sides(&self) -> Result<Vec<Shape>, CheckError> {
        let placed = |p: &Point| if self.trajectory.is_some() { p.clone() } else { self.placed(p) };
        let side = |points: &[Point], radius: Interval| {
            Shape { points: points.iter().map(placed).collect(), radius }.grown(&self.grown[1])
        };
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
            Outline::Own(shape) => Ok(vec![shape.clone().grown(&self.grown[1])]),
            _ => Err(CheckError::in_file(Input::World, "an obstacle has too few points, or no radius")),
        }
    }

    /// Returns true if a point is inside the obstacle. Its distance from the border must exceed `farther` units.
    /// Returns `None` if the enclosure of the point is too wide to decide.
    pub fn surrounds(&self, at: &Point, farther: &BigInt) -> Option<bool> {
        let own = self.own(at).map(|c| c.middle());
        // Test the middle of the enclosure. No border lies between it and the point.
        let is_near = own.iter().map(|(_, radius)| radius).sum::<BigInt>() < *farther;
        let own = own.map(|(middle, _)| middle);
        is_near.then(|| match &self.outline {
            Outline::Polygon(rings) => surrounds(rings, &own.map(|middle| Decimal::dyadic(&middle, BITS))),
            Outline::Squares(Ok(cells)) => cells.holds(&own.map(Interval::exact)),
            Outline::Squares(Err(_)) | Outline::Polyline(_) | Outline::Circle(..) | Outline::Own(_) => false,
        })
    }
}

/// Returns the index of the place nearest to `to`. Distances are between middles of enclosures.
fn nearest(places: &[Point], to: &Point) -> Option<usize> {
    let distance = |place: &Point| {
        let [x, y] = [0, 1].map(|k| (&place[k] - &to[k]).middle().0);
        &x * &x + &y * &y
    };
    (0..places.len()).min_by_key(|i| distance(&places[*i]))
}
