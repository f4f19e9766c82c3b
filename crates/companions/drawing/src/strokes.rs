//! Outlines of drawings as exact curves, for tools that follow them.

use crate::{Error, Notes, Point, Settings, svg, text};

/// A connected outline.
#[derive(Debug, Clone, PartialEq)]
pub struct Stroke {
    /// Name of the element, if it has one.
    pub name: Option<String>,
    /// Number of the element's line in the file, from 1.
    pub line: usize,
    /// The point where the outline begins, metres.
    pub start: Point,
    /// The curves in order. Each begins where the previous one ends. A closed outline ends where it begins.
    pub curves: Vec<StrokeCurve>,
}

/// A curve of an outline. It begins where the previous one ends. Lengths are in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StrokeCurve {
    /// A straight line to this point.
    Line(Point),
    /// A cubic Bézier curve: its two inner control points and its end.
    Cubic([Point; 3]),
    /// An arc of a circle.
    Arc {
        /// The circle's centre.
        center: Point,
        /// The circle's radius.
        radius: f64,
        /// Direction from the centre to the first end, radians from the x axis.
        from: f64,
        /// Angle about the centre, radians; positive counter-clockwise.
        by: f64,
    },
}

/// The outlines of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct Strokes {
    /// The outlines, in the order of the file.
    pub strokes: Vec<Stroke>,
    /// Remarks about elements that were omitted or changed.
    pub notes: Notes,
}

/// Reads the outlines of all visible elements of an SVG, filled or not. The origin is the lower left corner of the
/// page, and y points upwards, as for [`crate::read`].
///
/// Curves are exact, except for arcs of ellipses. These become cubic curves that deviate by less than a millionth of
/// the ellipse's size. [`Settings::tolerance`] has no effect.
///
/// # Errors
/// If the file is defective, is not SVG, or has more than [`crate::MAX_POINTS`] curves.
pub fn strokes(bytes: &[u8], settings: &Settings) -> Result<Strokes, Error> {
    svg::read_strokes(text(bytes)?, settings)
}
