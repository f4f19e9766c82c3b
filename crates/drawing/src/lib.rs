//! Plane drawings as plain shapes: DXF, SVG and GeoJSON to polygons, polylines and circles, with their names and layers.
//!
//! ```
//! use cplan_drawing::{Format, Geometry, Settings, read};
//!
//! let svg = r#"<svg width="200mm" height="100mm" viewBox="0 0 200 100">
//!     <rect id="tray" x="20" y="70" width="50" height="30"/>
//! </svg>"#;
//! let drawing = read(svg.as_bytes(), Format::Svg, &Settings::default()).unwrap();
//! let [tray] = &drawing.shapes[..] else { panic!("one shape") };
//! assert_eq!(tray.name.as_deref(), Some("tray"));
//! // Metres, and y upwards from the lower edge of the page.
//! let Geometry::Polygon { outer, .. } = &tray.geometry else { panic!("a polygon") };
//! let rounded: Vec<_> = outer.iter().map(|p| p.map(|x| (x * 1e9).round() / 1e9)).collect();
//! assert_eq!(rounded, [[0.02, 0.03], [0.07, 0.03], [0.07, 0.0], [0.02, 0.0]]);
//! ```
//!
//! # Results
//!
//! Closed outlines are solid, with holes where the format has them: inner rings in GeoJSON, fill rules in SVG. Open
//! outlines are [`Polyline`](Geometry::Polyline)s. In DXF, lines, arcs and open polylines of one layer are joined where
//! exactly two ends meet. An outline inside another is also solid, not a hole.
//!
//! # Guarantees
//!
//! Corners lie on the curves that they approximate, and no point of a curve is farther than [`Settings::tolerance`]
//! from its chord. So an outline loses at most that much where it is convex, and gains at most that much where it is
//! concave. Circles stay circles as long as the map does not stretch them. Ends closer than the tolerance are joined.
//! Nothing is dropped silently: [`Drawing::notes`] lists all ignored and changed elements. An outline may cross itself;
//! [`filled`] returns the region that it surrounds.
//!
//! The size of the result is bounded, even with nested blocks or curves of a million chords: a drawing of more than
//! [`MOST_POINTS`] points is refused.
#![forbid(unsafe_code)]

mod curve;
mod dxf;
mod fill;
mod geojson;
mod interpolation;
mod join;
mod map;
mod notes;
mod sheet;
mod stroke;
mod svg;
mod unit;

pub use fill::{FillRule, filled};
pub use notes::{Note, Notes};
pub use sheet::MOST_POINTS;
pub use unit::{Unit, UnknownUnit};

use std::path::Path;

/// Coordinates, metres.
pub type Point = [f64; 2];

/// Corners in order, each once: the last is joined to the first.
pub type Ring = Vec<Point>;

/// The contents of a file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Drawing {
    /// Shapes in the order of the file. A joined shape has the place of its first piece.
    pub shapes: Vec<Shape>,
    /// Elements that were left out or changed.
    pub notes: Notes,
}

/// Something drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// Name of the feature, id of the element or of its parent, or name of the block that contains it.
    pub name: Option<String>,
    /// The layer that it lies on.
    pub layer: Option<String>,
    /// Its geometry.
    pub geometry: Geometry,
    /// Its extent perpendicular to the plane, metres.
    pub height: Option<[f64; 2]>,
    /// The layer that hides it: its own, if that is off or frozen, or a frozen one that it is inserted on.
    pub hidden_by: Option<String>,
    /// Its kind in the words of the file format.
    pub kind: String,
    /// Line on which it starts, in formats that have lines.
    pub line: Option<usize>,
    /// Frame of the insertion, if it comes from a block.
    pub frame: Option<Frame>,
}

impl Shape {
    /// Returns all words that select it: its layer, its name, and the layer that hides it.
    #[must_use]
    pub fn called(&self) -> Vec<String> {
        [&self.layer, &self.name, &self.hidden_by].into_iter().flatten().cloned().collect()
    }
}

/// Position and orientation of the outermost block that contains a shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// The insertion point.
    pub at: Point,
    /// Counter-clockwise, radians.
    pub angle: f64,
}

impl Frame {
    /// Maps a point of the frame to the drawing.
    #[must_use]
    pub fn placed(&self, [x, y]: Point) -> Point {
        let (sin, cos) = self.angle.sin_cos();
        [cos * x - sin * y + self.at[0], sin * x + cos * y + self.at[1]]
    }

    /// Maps a point of the drawing to the frame.
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
    /// The area inside the outer ring and outside all holes. Directions of rings have no meaning.
    Polygon {
        /// The outer ring as drawn. It may cross itself.
        outer: Ring,
        /// The holes, whose insides are free.
        holes: Vec<Ring>,
    },
    /// No area: at least two points, neighbours in different places.
    Polyline(Vec<Point>),
    /// A disc.
    Circle {
        /// The centre.
        center: Point,
        /// Above 0.
        radius: f64,
    },
}

/// Options for reading a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Greatest distance of a curve from its chords, and of ends that meet, metres; at least [`FINEST`].
    pub tolerance: f64,
    /// Unit of the file's numbers. By default the unit that the file states.
    pub unit: Option<Unit>,
    /// Additional scale factor about the drawing's origin; above 0.
    pub scale: f64,
}

impl Default for Settings {
    /// A tolerance of a tenth of a millimetre, and the unit of the file.
    fn default() -> Self {
        Self { tolerance: 1e-4, unit: None, scale: 1.0 }
    }
}

/// Tolerances are not finer than this, metres: a micrometre.
pub const FINEST: f64 = 1e-6;

/// A format of drawings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// AutoCAD's exchange format, as text.
    Dxf,
    /// Scalable vector graphics.
    Svg,
    /// Features in JSON.
    GeoJson,
}

impl Format {
    /// Returns the format for a file extension: `.dxf`, `.svg`, `.geojson` or `.json`.
    #[must_use]
    pub fn from_path(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "dxf" => Some(Self::Dxf),
            "svg" => Some(Self::Svg),
            "geojson" | "json" => Some(Self::GeoJson),
            _ => None,
        }
    }
}

/// Why a file is no drawing.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct Error {
    /// Line number from 1, in formats that have lines.
    pub line: Option<usize>,
    /// Description of the defect.
    pub message: String,
    /// Hint for the user.
    pub cure: String,
}

impl Error {
    fn new(line: impl Into<Option<usize>>, message: impl Into<String>, cure: impl Into<String>) -> Self {
        Self { line: line.into(), message: message.into(), cure: cure.into() }
    }
}

/// Reads a drawing.
///
/// # Errors
/// A file that is broken, or not of that format.
pub fn read(bytes: &[u8], format: Format, settings: &Settings) -> Result<Drawing, Error> {
    let settings = &Settings { tolerance: settings.tolerance.max(FINEST), ..*settings };
    match format {
        Format::Dxf => dxf::read(bytes, settings),
        Format::Svg => svg::read(text(bytes)?, settings),
        Format::GeoJson => geojson::read(text(bytes)?, settings),
    }
}

/// Bytes as UTF-8, without a byte order mark.
fn text(bytes: &[u8]) -> Result<&str, Error> {
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let line = bytes[..error.valid_up_to()].iter().filter(|&&byte| byte == b'\n').count() + 1;
        Error::new(line, "this is no UTF-8 text", "save the drawing as text in UTF-8")
    })?;
    Ok(text.trim_start_matches('\u{feff}'))
}
