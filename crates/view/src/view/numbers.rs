//! Numbers with as many digits as can be seen, and how they stand in a document: lists of places as one coordinate after the
//! other.

use crate::color::Rgb;
use cplan_core::model::{Arm, Shape};
use cplan_core::space::Configuration;
use cplan_geometry::{Convex, Point};
use serde::ser::SerializeStruct;
use serde::{Serialize, Serializer};

/// Digits of a length behind the first one of the arm's reach: a hundredth of a pixel at the size of a screen.
const DIGITS: i32 = 5;

/// What values are rounded to: powers of ten, given by how many of them make 1, so that rounding leaves short decimals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grain {
    lengths: f64,
    joints: [f64; 2],
}

/// A number rounded to `1 / grains`, without a negative zero.
fn rounded(value: f64, grains: f64) -> f64 {
    (value * grains).round() / grains + 0.0
}

/// Grains for values of this size.
fn grains(size: f64) -> f64 {
    10_f64.powi((DIGITS - size.log10().floor() as i32).clamp(-12, 15))
}

/// An angle or another number of the order of 1.
#[must_use]
pub fn number(value: f64) -> f64 {
    rounded(value, grains(1.0))
}

impl Grain {
    /// That of an arm: its reach for lengths, a radian or the stroke for joints.
    #[must_use]
    pub fn of(arm: &Arm) -> Self {
        let stroke = |k: usize| arm.joints[k].range.extent().max(f64::MIN_POSITIVE);
        let joints = [0, 1].map(|k| grains(if arm.joints[k].joint_type.is_revolute() { 1.0 } else { stroke(k) }));
        Self { lengths: grains(arm.reach()), joints }
    }

    /// That of what lies within a box of this size, where there is no arm.
    #[must_use]
    pub fn within(size: f64) -> Self {
        Self { lengths: grains(size), joints: [grains(1.0); 2] }
    }

    /// A length or coordinate.
    #[must_use]
    pub fn length(self, value: f64) -> f64 {
        rounded(value, self.lengths)
    }

    /// A point of the plane.
    #[must_use]
    pub fn point(self, p: Point) -> Point {
        p.map(|x| self.length(x))
    }

    /// Points of the plane.
    #[must_use]
    pub fn points(self, points: &[Point]) -> Vec<Point> {
        points.iter().map(|&p| self.point(p)).collect()
    }

    /// A rounded convex polygon.
    #[must_use]
    pub fn shape(self, shape: &Convex) -> ShapeView {
        ShapeView(shape.mapped(|corner| self.point(corner), self.length(shape.radius())))
    }

    /// A shape as the user gave it.
    #[must_use]
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

    /// A configuration, or speeds or accelerations of both joints.
    #[must_use]
    pub fn configuration(self, q: Configuration) -> [f64; 2] {
        [rounded(q[0], self.joints[0]), rounded(q[1], self.joints[1])]
    }

    /// Several of them.
    #[must_use]
    pub fn configurations<'a>(self, all: impl IntoIterator<Item = &'a Configuration>) -> Chain {
        Chain(all.into_iter().map(|&q| self.configuration(q).into()).collect())
    }
}

/// Configurations or places, which make a line, a polygon, or pairs.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Chain(pub Vec<Configuration>);

impl Chain {
    /// Whether there is nothing in it.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Two by two: boxes, or ends of lines.
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
        let mut shape = serializer.serialize_struct("Shape", 2)?;
        shape.serialize_field("core", &flat(self.0.core()))?;
        shape.serialize_field("radius", &self.0.radius())?;
        shape.end()
    }
}

/// The shape that the user gave, by its kind; the union of the pieces is a word.
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

impl Serialize for Rgb {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

fn flat(points: &[Point]) -> Vec<f64> {
    points.iter().flat_map(|p| [p.x, p.y]).collect()
}
