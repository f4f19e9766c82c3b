//! Numbers rounded to visible precision, and their form in documents, where a list of places is a flat list of coordinates.

use crate::Object;
use cplan_geometry::{Convex, Point};
use cplan_model::space::Configuration;
use cplan_model::{Arm, Shape};
use serde::{Serialize, Serializer};

/// Number of decimal digits of lengths, counted from the first digit of the arm's reach. In a picture as wide as a screen, the
/// last digit is a hundredth of a pixel.
const LENGTH_DIGITS: i32 = 5;

/// Numbers of rounding steps per unit, for lengths and for joint values. They are powers of ten, so that rounded numbers have few
/// decimals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoundingSteps {
    lengths: f64,
    joints: [f64; 2],
}

/// Rounds a number to a multiple of `1 / grains`. The result is never negative zero.
fn rounded(value: f64, grains: f64) -> f64 {
    (value * grains).round() / grains + 0.0
}

/// Returns the number of rounding steps per unit for values up to `size`.
fn grains(size: f64) -> f64 {
    10_f64.powi((LENGTH_DIGITS - size.log10().floor() as i32).clamp(-12, 15))
}

/// Rounds an angle, or another number near 1.
pub fn number(value: f64) -> f64 {
    rounded(value, grains(1.0))
}

impl RoundingSteps {
    /// Returns the rounding steps of an arm. For lengths, they follow from its reach; for a revolute joint, from a radian; for a
    /// prismatic joint, from its stroke.
    pub fn of(arm: &Arm) -> Self {
        let stroke = |k: usize| arm.joints[k].range.extent().max(f64::MIN_POSITIVE);
        let joints = [0, 1].map(|k| grains(if arm.joints[k].joint_type.is_revolute() { 1.0 } else { stroke(k) }));
        Self { lengths: grains(arm.reach()), joints }
    }

    /// Returns the rounding steps for content in a box of this size, for pictures without an arm.
    pub fn within(size: f64) -> Self {
        Self { lengths: grains(size), joints: [grains(1.0); 2] }
    }

    /// Makes the rounding steps of joint values finer: at most `step` radians or metres.
    #[must_use]
    pub fn finer(self, step: f64) -> Self {
        let least = 10_f64.powi((-step.log10()).ceil().clamp(0.0, 12.0) as i32);
        Self { joints: self.joints.map(|grains| grains.max(least)), ..self }
    }

    /// Rounds a length or coordinate.
    pub fn length(self, value: f64) -> f64 {
        rounded(value, self.lengths)
    }

    /// Rounds a point of the plane.
    pub fn point(self, p: Point) -> Point {
        p.map(|x| self.length(x))
    }

    /// Rounds points of the plane.
    pub fn points(self, points: &[Point]) -> Vec<Point> {
        points.iter().map(|&p| self.point(p)).collect()
    }

    /// Rounds a rounded convex polygon.
    pub fn shape(self, shape: &Convex) -> ShapeView {
        ShapeView(shape.mapped(|corner| self.point(corner), self.length(shape.radius())))
    }

    /// Rounds the coordinates of a shape of the world file.
    pub fn outline(self, shape: &Shape) -> Shape {
        match shape {
            Shape::Polygon(corners) => Shape::Polygon(self.points(corners)),
            Shape::Circle { center, radius } => {
                Shape::Circle { center: self.point(*center), radius: self.length(*radius) }
            }
            Shape::Polyline(points) => Shape::Polyline(self.points(points)),
            Shape::Pieces => Shape::Pieces,
        }
    }

    /// Rounds a configuration, or speeds or accelerations of both joints.
    pub fn configuration(self, q: Configuration) -> [f64; 2] {
        [rounded(q[0], self.joints[0]), rounded(q[1], self.joints[1])]
    }

    /// Rounds several configurations.
    pub fn configurations<'a>(self, all: impl IntoIterator<Item = &'a Configuration>) -> Chain {
        Chain(all.into_iter().map(|&q| self.configuration(q).into()).collect())
    }
}

/// Configurations, or places in the plane, that form a line, a polygon, or pairs.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Chain(pub Vec<Configuration>);

impl Chain {
    /// Returns true if the chain is empty.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the items in pairs: boxes, or ends of lines.
    pub fn pairs(&self) -> impl Iterator<Item = [Configuration; 2]> + '_ {
        self.0.chunks_exact(2).map(|pair| [pair[0], pair[1]])
    }
}

impl Serialize for Chain {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.iter().flat_map(|q| [q[0], q[1]]))
    }
}

/// A rounded convex polygon: corners of the core, and the radius.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapeView(pub Convex);

impl Serialize for ShapeView {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        with_shape(Object::default(), &self.0).serialize(serializer)
    }
}

/// Returns an object with a shape.
pub fn with_shape(object: Object, shape: &Convex) -> Object {
    object.with("core", &flat(shape.core())).with("radius", &shape.radius())
}

/// Serialises a shape of the world file with its kind. A shape that is the union of its pieces becomes a single word.
pub fn outline<S: Serializer>(shape: &Shape, serializer: S) -> Result<S::Ok, S::Error> {
    const NAME: &str = "Outline";
    match shape {
        Shape::Polygon(corners) => serializer.serialize_newtype_variant(NAME, 0, "polygon", &flat(corners)),
        Shape::Circle { center, radius } => {
            serializer.serialize_newtype_variant(NAME, 1, "circle", &[center.x, center.y, *radius])
        }
        Shape::Polyline(points) => serializer.serialize_newtype_variant(NAME, 2, "polyline", &flat(points)),
        Shape::Pieces => serializer.serialize_unit_variant(NAME, 3, "pieces"),
    }
}

fn flat(points: &[Point]) -> Vec<f64> {
    points.iter().flat_map(|p| [p.x, p.y]).collect()
}
