//! The content of a drawing.

use crate::Notes;

/// Coordinates, metres.
pub type Point = [f64; 2];

/// Corners in order, each once: a side joins the last corner to the first.
pub type Ring = Vec<Point>;

/// The content of a file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Drawing {
    /// Shapes in the order of the file; joined shapes have the position of their first piece.
    pub shapes: Vec<Shape>,
    /// Content that was left out or changed.
    pub notes: Notes,
}

/// A shape of the drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// The feature's name, the id of the element or of a group around it, or the name of the block that contains it.
    pub name: Option<String>,
    /// The layer of the shape.
    pub layer: Option<String>,
    /// The geometry.
    pub geometry: Geometry,
    /// Extent across the plane, metres.
    pub height: Option<[f64; 2]>,
    /// The layer that hides it: its own, if that is off or frozen, or a frozen one of an insertion.
    pub hidden_by: Option<String>,
    /// The kind of shape, in the file's own words.
    pub kind: String,
    /// The line of its beginning, in formats that have lines.
    pub line: Option<usize>,
    /// The frame of its block, if it is part of one.
    pub frame: Option<Frame>,
}

impl Shape {
    /// Returns all names by which a user may select it: its layer, its name, and the layer or group that hides it.
    #[must_use]
    pub fn called(&self) -> Vec<String> {
        [&self.layer, &self.name, &self.hidden_by].into_iter().flatten().cloned().collect()
    }
}

/// The place and orientation at which a shape's outermost block is inserted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// The insertion point.
    pub at: Point,
    /// Angle, counter-clockwise, radians.
    pub angle: f64,
}

impl Frame {
    /// Returns the drawing's coordinates of a point in the frame.
    #[must_use]
    pub fn placed(&self, [x, y]: Point) -> Point {
        let (sin, cos) = self.angle.sin_cos();
        [cos * x - sin * y + self.at[0], sin * x + cos * y + self.at[1]]
    }

    /// Returns a point as seen from the frame.
    #[must_use]
    pub fn local(&self, p: Point) -> Point {
        let (sin, cos) = self.angle.sin_cos();
        let [x, y] = [p[0] - self.at[0], p[1] - self.at[1]];
        [cos * x + sin * y, cos * y - sin * x]
    }
}

/// The geometry of a shape.
#[derive(Debug, Clone, PartialEq)]
pub enum Geometry {
    /// The region inside the outer ring and outside the holes; directions do not matter.
    Polygon {
        /// The ring as drawn; it may cross itself.
        outer: Ring,
        /// Rings around free space.
        holes: Vec<Ring>,
    },
    /// A line without area: at least two points, neighbours in different places.
    Polyline(Vec<Point>),
    /// A disc.
    Circle {
        /// The centre.
        center: Point,
        /// The radius; above 0.
        radius: f64,
    },
}
