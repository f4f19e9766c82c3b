//! The content of a drawing.

use crate::Notes;

/// A point in the plane: its coordinates, metres.
pub type Point = [f64; 2];

/// Corners of a ring in order. The first corner is not repeated; a side joins the last corner to the first.
pub type Ring = Vec<Point>;

/// The content of a file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Drawing {
    /// Shapes in the order of the file. A joined shape has the position of its first piece.
    pub shapes: Vec<Shape>,
    /// Notes about content that was omitted or changed.
    pub notes: Notes,
}

/// A shape of the drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// Name of the shape: the name of a GeoJSON feature, the id of an SVG element or of a group around it, or the name
    /// of the DXF block that contains it.
    pub name: Option<String>,
    /// The layer of the shape.
    pub layer: Option<String>,
    /// The geometry.
    pub geometry: Geometry,
    /// Lower and upper end along the plane's normal, metres; `None` if not stated.
    pub height: Option<[f64; 2]>,
    /// The layer that hides the shape: its own layer if it is off or frozen, or the frozen layer of an insertion.
    pub hidden_by: Option<String>,
    /// Kind of the shape, in the words of the file's format.
    pub kind: String,
    /// Line number at which the shape begins, in formats that have lines.
    pub line: Option<usize>,
    /// Frame of the outermost block that contains the shape; `None` without a block.
    pub frame: Option<Frame>,
}

impl Shape {
    /// Returns all names by which a user may select the shape: its layer, its name, and the layer that hides it.
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
    /// Converts a point from the frame's coordinates to those of the drawing.
    pub fn placed(&self, [x, y]: Point) -> Point {
        let (sin, cos) = self.angle.sin_cos();
        [cos * x - sin * y + self.at[0], sin * x + cos * y + self.at[1]]
    }

    /// Converts a point from the drawing's coordinates to those of the frame.
    pub fn local(&self, p: Point) -> Point {
        let (sin, cos) = self.angle.sin_cos();
        let [x, y] = [p[0] - self.at[0], p[1] - self.at[1]];
        [cos * x + sin * y, cos * y - sin * x]
    }
}

/// The geometry of a shape.
#[derive(Debug, Clone, PartialEq)]
pub enum Geometry {
    /// The region inside the outer ring and outside the holes. The directions of the rings do not matter.
    Polygon {
        /// The outer ring as drawn. It may cross itself.
        outer: Ring,
        /// Rings around free space.
        holes: Vec<Ring>,
    },
    /// A line without area, with at least two points. Consecutive points differ.
    Polyline(Vec<Point>),
    /// A disc.
    Circle {
        /// The centre.
        center: Point,
        /// The radius, metres, positive.
        radius: f64,
    },
}
