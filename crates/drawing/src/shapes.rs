//! What a drawing shows.

use crate::Notes;

/// Coordinates, metres.
pub type Point = [f64; 2];

/// Corners in order, each once: the last is joined to the first.
pub type Ring = Vec<Point>;

/// What a file shows.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Drawing {
    /// In the order of the file; what was joined stands where its first piece does.
    pub shapes: Vec<Shape>,
    /// What was not taken, or not as it is written.
    pub notes: Notes,
}

/// Something drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// The feature's name, the id of the element or of what it is in, or the block that it comes in with.
    pub name: Option<String>,
    /// The layer that it lies on.
    pub layer: Option<String>,
    /// Where it is.
    pub geometry: Geometry,
    /// Its extent across the plane, metres.
    pub height: Option<[f64; 2]>,
    /// The layer that hides it: its own, if that is off or frozen, or a frozen one that it is inserted on.
    pub hidden_by: Option<String>,
    /// What it is in the file's own words.
    pub kind: String,
    /// Where it begins, in formats that have lines.
    pub line: Option<usize>,
    /// Where it is inserted, if it comes in with a block.
    pub frame: Option<Frame>,
}

impl Shape {
    /// All that it may be asked for by: its layer, its name, what hides it.
    #[must_use]
    pub fn called(&self) -> Vec<String> {
        [&self.layer, &self.name, &self.hidden_by].into_iter().flatten().cloned().collect()
    }
}

/// Where the outermost block that a shape comes in with is inserted, and how it is turned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// The insertion point.
    pub at: Point,
    /// Counter-clockwise, radians.
    pub angle: f64,
}

impl Frame {
    /// Where a point of the frame lies.
    #[must_use]
    pub fn placed(&self, [x, y]: Point) -> Point {
        let (sin, cos) = self.angle.sin_cos();
        [cos * x - sin * y + self.at[0], sin * x + cos * y + self.at[1]]
    }

    /// A point as seen from the frame.
    #[must_use]
    pub fn local(&self, p: Point) -> Point {
        let (sin, cos) = self.angle.sin_cos();
        let [x, y] = [p[0] - self.at[0], p[1] - self.at[1]];
        [cos * x + sin * y, cos * y - sin * x]
    }
}

/// Where a shape is.
#[derive(Debug, Clone, PartialEq)]
pub enum Geometry {
    /// What is inside the outer ring and in no hole; directions mean nothing.
    Polygon {
        /// As it is drawn; it may cross itself.
        outer: Ring,
        /// What they surround is free.
        holes: Vec<Ring>,
    },
    /// No area: at least two points, neighbours in different places.
    Polyline(Vec<Point>),
    /// A disc.
    Circle {
        /// Its centre.
        center: Point,
        /// Above 0.
        radius: f64,
    },
}
