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
//! # What becomes what
//!
//! What is closed is solid, with holes where the format has them: rings of GeoJSON, rules of filling in SVG. What is open is a
//! [`Polyline`](Geometry::Polyline). In DXF, lines, arcs and open polylines of one layer whose ends meet, two at a time, are one. An
//! outline that lies inside another is solid, too; it is no hole of that.
//!
//! # What holds
//!
//! Corners lie on the curves that they stand for, and no point of a curve is farther than [`Settings::tolerance`] from its chord: an
//! outline that bulges outwards loses up to that, one that bulges inwards gains it. Circles stay circles as long as nothing
//! stretches them. Ends that are nearer than the tolerance meet. Nothing is dropped silently: what is not taken is in [`Drawing::notes`].
//! An outline may cross itself; [`filled`] says what it surrounds.
//!
//! What a file may make of itself, by blocks in blocks or by curves of a million chords, is bounded: it is refused beyond
//! [`MOST_POINTS`].
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

/// How a file is read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Greatest distance of a curve from its chords, and of ends that meet, metres; at least [`FINEST`].
    pub tolerance: f64,
    /// The unit of the file's numbers; by default what the file says.
    pub unit: Option<Unit>,
    /// What everything is scaled by besides, about the drawing's origin; above 0.
    pub scale: f64,
}

impl Default for Settings {
    /// A tenth of a millimetre, and what the file says.
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
    /// The format that a file's extension stands for: `.dxf`, `.svg`, `.geojson` or `.json`.
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
    /// From 1, in formats that have lines.
    pub line: Option<usize>,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
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
