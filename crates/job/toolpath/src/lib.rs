//! Lines that the tip of a robot follows: straight lines, circular arcs and cubic Bézier curves, read from G-code, or through
//! given points.
//!
//! ```
//! use cplan_toolpath::{Curve, Format, Placement, read};
//!
//! let text = "G21 G90 F1200\nG0 X100 Y50\nG1 X120\nG3 X120 Y70 J10\nM2\n";
//! let path = read(text.as_bytes(), Format::GCode, &Placement::default())?;
//! let [line, arc] = path.pieces() else { panic!("two pieces") };
//! assert_eq!((line.source.line, line.speed), (3, Some(0.02)));
//! // A half circle with a radius of 10 mm.
//! let Curve::Arc { radius, by, .. } = arc.curve else { panic!("an arc") };
//! assert!((radius - 0.01).abs() < 1e-12 && (by - std::f64::consts::PI).abs() < 1e-12);
//! assert!((path.length() - 0.0514159265).abs() < 1e-9);
//! # Ok::<(), cplan_toolpath::Error>(())
//! ```
//!
//! # G-code
//!
//! The reader follows straight lines and arcs, relative coordinates, units, shifted origins (G92) and dwells (G4). Words that
//! only command the machine have no effect on the line, and a note lists them. If other words would change the line, one error
//! lists all of them: a machine that deviates from its file is worse than one that stops.
//!
//! The line begins at the first point of the file. A later G0 is a straight move of the tip, and a piece with
//! [`Piece::is_travel`].
//!
//! Files round their numbers, so both ends of an arc are rarely equally far from its centre. The radius of such an arc changes
//! linearly from one end to the other.
//!
//! # SVG
//!
//! The program has to provide the reader of drawings: see [`read_svg_by`].
#![forbid(unsafe_code)]

mod arc;
mod curve;
mod cusps;
mod error;
mod gcode;
mod heading;
mod path;
mod placement;
mod shapes;

pub use cplan_text::Unit;
pub use curve::{Curve, Point};
pub use error::Error;
pub use gcode::{Modes, Program, ProgramMove};
pub use heading::{Headings, wrapped};
pub use path::{MAX_PIECES, Piece, Source, Toolpath};
pub use placement::Placement;
pub use shapes::{Leg, arc_through, polyline, spline};

use std::path::Path;
use std::sync::OnceLock;

/// A format of line files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Programs of machine tools (ISO 6983), as LinuxCNC reads them.
    GCode,
    /// Scalable vector graphics.
    Svg,
}

impl Format {
    /// Returns the format for a file extension: `.gcode`, `.nc`, `.ngc` or `.tap`; `.svg`.
    pub fn from_path(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "gcode" | "nc" | "ngc" | "tap" => Some(Self::GCode),
            "svg" => Some(Self::Svg),
            _ => None,
        }
    }
}

/// Reads a line and moves it to its place.
///
/// # Errors
/// A damaged file, words that cannot be followed, and a file without a line.
pub fn read(bytes: &[u8], format: Format, placement: &Placement) -> Result<Toolpath, Error> {
    match format {
        Format::GCode => gcode::read(text(bytes)?, placement),
        Format::Svg => match SVG_READER.get() {
            Some(read) => read(bytes, placement),
            None => Err(Error::new(None, None, "this program was built without SVG", "use G-code, or list the points")),
        },
    }
}

/// Reads a line and moves it to its place.
pub type LineReader = fn(&[u8], &Placement) -> Result<Toolpath, Error>;

static SVG_READER: OnceLock<LineReader> = OnceLock::new();

/// Sets the reader of [`Format::Svg`] for the whole process. Only the first call has an effect. Without a reader, [`read`]
/// refuses drawings.
pub fn read_svg_by(reader: LineReader) {
    SVG_READER.get_or_init(|| reader);
}

/// Reads the single moves of a G-code program, for a machine with its own kinematics. The program may contain moves to positions
/// of the machine (G28). At the beginning and after such a move, the tip is at `home`, metres; if `home` is `None`, its position
/// is unknown.
///
/// # Errors
/// A damaged file, words that cannot be followed, and a file without a move.
pub fn read_program(bytes: &[u8], home: Option<Point>) -> Result<Program, Error> {
    gcode::program(text(bytes)?, home)
}

/// Returns bytes as UTF-8, without a byte order mark.
fn text(bytes: &[u8]) -> Result<&str, Error> {
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let line = bytes[..error.valid_up_to()].iter().filter(|&&byte| byte == b'\n').count() + 1;
        Error::new(line, None, "this is not UTF-8 text", "save the file as text in UTF-8")
    })?;
    Ok(text.trim_start_matches('\u{feff}'))
}
