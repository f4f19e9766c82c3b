//! Reads plane drawings (DXF, SVG and GeoJSON) as polygons, polylines and circles, with their names and layers.
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
//! Corners lie on the curves that they approximate, and no point of a curve is farther than [`Settings::tolerance`] from its
//! chord. So an outline is at most that much too small where it is convex, and too large where it is concave. Circles remain
//! circles unless they are stretched. Ends closer than the tolerance are joined. Nothing is dropped silently: [`Drawing::notes`]
//! lists all ignored and changed elements. An outline may cross itself. [`filled`] returns the region that it encloses.
//!
//! The size of the result is bounded, even with nested blocks or curves of a million chords: a drawing of more than
//! [`MAX_POINTS`] points is refused.
#![forbid(unsafe_code)]

mod curve;
mod dxf;
mod error;
mod fill;
mod geojson;
mod interpolation;
mod join;
mod line;
mod map;
mod notes;
mod settings;
mod shapes;
mod sheet;
mod stroke;
mod strokes;
mod svg;

pub use cplan_text::{Unit, UnknownUnit};
pub use error::Error;
pub use fill::{FillRule, filled};
pub use line::read_line;
pub use notes::{Note, Notes};
pub use settings::{MIN_TOLERANCE, Settings};
pub use shapes::{Drawing, Frame, Geometry, Point, Ring, Shape};
pub use sheet::MAX_POINTS;
pub use strokes::{Stroke, StrokeCurve, Strokes, strokes};

use std::path::Path;

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
    pub fn from_path(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "dxf" => Some(Self::Dxf),
            "svg" => Some(Self::Svg),
            "geojson" | "json" => Some(Self::GeoJson),
            _ => None,
        }
    }
}

/// Reads a drawing.
///
/// # Errors
/// If the file is defective, or does not have that format.
pub fn read(bytes: &[u8], format: Format, settings: &Settings) -> Result<Drawing, Error> {
    let settings = &Settings { tolerance: settings.tolerance.max(MIN_TOLERANCE), ..*settings };
    match format {
        Format::Dxf => dxf::read(bytes, settings),
        Format::Svg => svg::read(text(bytes)?, settings),
        Format::GeoJson => geojson::read(text(bytes)?, settings),
    }
}

/// Returns bytes as UTF-8, without a byte order mark.
fn text(bytes: &[u8]) -> Result<&str, Error> {
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let line = bytes[..error.valid_up_to()].iter().filter(|&&byte| byte == b'\n').count() + 1;
        Error::new(line, "this is not UTF-8 text", "save the drawing as text in UTF-8")
    })?;
    Ok(text.trim_start_matches('\u{feff}'))
}
