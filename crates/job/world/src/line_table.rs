//! Lines for the tip: the table `follow` of a step, and files of lines in TOML.

use super::line_wrist::{self, WristValue};
use super::reader::Reader;
#[cfg(test)]
use super::schema::*;
use cplan_handling::{DEFAULT_TOLERANCE, FollowedLine, MIN_TOLERANCE};
use cplan_robot::{
    Diagnostic, InputError, Length, Lengths, Number, Position, Source, Spanned, Written, read_bytes, toml_table,
};
use cplan_toolpath::{Curve, Error, Format, Leg, Piece, Placement, Toolpath, Unit, arc_through, polyline, spline};
use std::ops::Range;
use std::sync::Arc;

toml_table! {
    /// A line for the tip: exactly one of file, points, arc and spline. It is scaled, then turned, then moved.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields, rename = "follow", extend(
        "oneOf" = [{ "required": ["file"] }, { "required": ["points"] }, { "required": ["arc"] }, { "required": ["spline"] }],
        "dependencies" = { "radius": ["points"], "unit": ["file"], "wrist_tolerance": ["wrist"] },
    )))]
    pub(super) struct LineTable {
        /// File with G-code (.gcode, .nc, .ngc, .tap) or a drawing (.svg). The name is relative to the world file.
        file: Option<Spanned<String>>,
        /// Points that are joined by straight lines, m.
        #[cfg_attr(test, schemars(with = "Option<Vec<LengthPair>>", length(min = 2)))]
        points: Option<Spanned<Vec<Lengths>>>,
        /// Radius of the arcs that replace the corners of `points`, m; by default 0.
        #[cfg_attr(test, schemars(with = "Option<NotNegativeLength>"))]
        radius: Option<Length>,
        /// An arc of a circle from the first point through the second to the third, m.
        #[cfg_attr(test, schemars(with = "Option<[LengthPair; 3]>"))]
        arc: Option<Spanned<Vec<Lengths>>>,
        /// Points that are joined by a cubic spline, m. The spline is closed if the last point equals the first.
        #[cfg_attr(test, schemars(with = "Option<Vec<LengthPair>>", length(min = 2)))]
        spline: Option<Spanned<Vec<Lengths>>>,
        /// Greatest speed of the tip, m/s; by default the speeds stated in the file. Without them, the tip moves as
        /// fast as the joints allow.
        #[cfg_attr(test, schemars(with = "Option<Positive>"))]
        speed: Option<Number>,
        /// Greatest distance of the tip from the line, m; by default 0.00001.
        #[cfg_attr(test, schemars(with = "Option<PositiveLength>"))]
        tolerance: Option<Length>,
        /// Unit of the file's numbers, such as "mm"; by default the unit that the file states.
        unit: Option<Spanned<String>>,
        /// Factor by which the line is scaled about its origin; by default 1.
        #[cfg_attr(test, schemars(with = "Option<Positive>"))]
        scale: Option<Number>,
        /// Angle by which the line is turned about its origin, rad; by default 0.
        turn: Option<Written>,
        /// Position of the line's origin, m; by default [0, 0].
        #[cfg_attr(test, schemars(with = "Option<LengthPair>"))]
        r#move: Option<Lengths>,
        /// Angle of the tool along the line.
        wrist: Option<Spanned<WristValue>>,
        /// Side of the elbow along the line, seen from joint 1 towards the tip; by default either.
        #[cfg_attr(test, schemars(with = "Option<ElbowSide>"))]
        elbow: Option<Spanned<String>>,
        /// Greatest deviation of the tool from the angle `wrist`, rad; by default 0.01. At corners where the line turns
        /// by more, the arm rests while the tool turns.
        wrist_tolerance: Option<Written>,
    }
}

/// A function that returns the curves through points.
type LegsThrough<'a> = &'a dyn Fn(&[[f64; 2]]) -> Result<Vec<Leg>, Error>;

/// Reads a file in TOML with the keys of a step's table `follow`.
///
/// # Errors
/// Malformed TOML, unknown keys, invalid values, and defects of the file that it names.
pub fn read_line(source: &Source) -> Result<FollowedLine, InputError> {
    let table: LineTable = source.toml(&|_, _| "points = [[x, y], [x, y]], with keys as in `follow` of a step")?;
    Ok(table.read(&Reader::new(source), 0..0)?)
}

impl LineTable {
    /// Returns the line. `at` is the position of the table in the file.
    pub fn read(&self, reader: &Reader, at: Range<usize>) -> Result<FollowedLine, Diagnostic> {
        let source = reader.source;
        let placement = self.placement(reader)?;
        let refuse_key = |given: Option<Range<usize>>, message: &str| match given {
            Some(at) => Err(source.diagnostic_at(at, message).help("remove the key")),
            None => Ok(()),
        };
        if self.points.is_none() {
            refuse_key(self.radius.as_ref().map(Spanned::span), "only a line with `points` has a `radius`")?;
        }
        if self.file.is_none() {
            refuse_key(self.unit.as_ref().map(Spanned::span), "only a line with a `file` has a `unit`")?;
        }
        let path = match (&self.file, &self.points, &self.arc, &self.spline) {
            (Some(file), None, None, None) => read_file(reader, file, &placement)?,
            (None, Some(points), None, None) => {
                let radius = self.radius.as_ref().map_or(Ok(0.0), |radius| reader.not_negative(radius, "radius"))?;
                let legs = |points: &[_]| polyline(points, radius);
                self.through(reader, points, &placement, &legs)?
            }
            (None, None, Some(points), None) => {
                let legs = |points: &[[f64; 2]]| match *points {
                    [from, through, to] => Ok(vec![arc_through([from, through, to])?]),
                    _ => {
                        let message = format!("an arc needs three points, not {}", points.len());
                        Err(Error::new(None, None, message, "arc = [[x, y], [x, y], [x, y]]: from, through and to"))
                    }
                };
                self.through(reader, points, &placement, &legs)?
            }
            (None, None, None, Some(points)) => self.through(reader, points, &placement, &spline)?,
            (file, points, arc, spline) => {
                let given = [file.is_some(), points.is_some(), arc.is_some(), spline.is_some()];
                let count = given.iter().filter(|given| **given).count();
                let message =
                    format!("a line needs exactly one of `file`, `points`, `arc` and `spline`, but has {count}");
                return Err(source.diagnostic_at(at, message).help("follow = { points = [[x, y], [x, y]] }"));
            }
        };
        let speed = self.speed.as_ref().map(|speed| positive(reader, speed, "speed")).transpose()?;
        let tolerance = self.tolerance.as_ref().map(|t| positive(reader, t, "tolerance")).transpose()?;
        let wrist = line_wrist::read(reader, self.wrist.as_ref(), self.wrist_tolerance.as_ref())?;
        let elbow = reader.elbow(self.elbow.as_ref())?;
        let tolerance = tolerance.unwrap_or(DEFAULT_TOLERANCE);
        let line = FollowedLine { path: Arc::new(path), tolerance, speed, wrist, elbow };
        match &self.tolerance {
            Some(number) if line.tolerance < MIN_TOLERANCE => {
                let message = format!("the tolerance is {} m, less than {MIN_TOLERANCE} m", line.tolerance);
                Err(source
                    .diagnostic_at(number.span(), message)
                    .help("use a greater tolerance; no robot is so accurate"))
            }
            _ => Ok(line),
        }
    }

    fn placement(&self, reader: &Reader) -> Result<Placement, Diagnostic> {
        let unit = self.unit.as_ref().map(|unit| {
            let unknown = |message: String| reader.source.diagnostic_at(unit.span(), message).help("unit = \"mm\"");
            unit.get_ref().parse::<Unit>().map_err(|error| unknown(error.to_string()))
        });
        let scale = self.scale.as_ref().map(|scale| positive(reader, scale, "scale")).transpose()?;
        let turn = self.turn.as_ref().map(|turn| reader.quantity(turn, "turn")).transpose()?;
        let shift = self.r#move.as_ref().map(|shift| reader.number_pair(shift, "move")).transpose()?;
        Ok(Placement {
            unit: unit.transpose()?,
            scale: scale.unwrap_or(1.0),
            turn: turn.unwrap_or(0.0),
            shift: shift.unwrap_or_default(),
        })
    }

    fn through(
        &self,
        reader: &Reader,
        points: &Spanned<Vec<Lengths>>,
        placement: &Placement,
        legs: LegsThrough,
    ) -> Result<Toolpath, Diagnostic> {
        let list = points.get_ref();
        let values = list.iter().map(|point| reader.number_pair(point, "a point")).collect::<Result<Vec<_>, _>>()?;
        let mut cursor = reader.source.cursor();
        let lines: Vec<usize> = list.iter().map(|point| cursor.position(point.span().start).line).collect();
        let piece = |(curve, to): (Curve, usize)| {
            let source = cplan_toolpath::Source::of_line(lines[to]);
            Piece { curve: placement.place(&curve), speed: None, is_travel: false, dwell: None, source }
        };
        let path = legs(&values).and_then(|legs| Toolpath::new(legs.into_iter().map(piece).collect()));
        path.map_err(|error| reader.source.diagnostic_at(points.span(), error.message).help(error.hint))
    }
}

/// Returns the line of a file that a table names. Defects of that file are reported with its name.
fn read_file(reader: &Reader, file: &Spanned<String>, placement: &Placement) -> Result<Toolpath, Diagnostic> {
    let path = reader.path_of_named_file(file, "follow")?;
    let wrong = |message: String, help: &str| reader.source.diagnostic_at(file.span(), message).help(help);
    let format = Format::from_path(&path).ok_or_else(|| {
        wrong("the format of the line's file is unknown".into(), "the name must end in .gcode, .nc, .ngc, .tap or .svg")
    })?;
    let bytes = read_bytes(&path).map_err(|error| wrong(error.to_string(), "check the file"))?;
    cplan_toolpath::read(&bytes, format, placement).map_err(|error| line_diagnostic(path.display().to_string(), error))
}

/// Returns the diagnostic for a defect of a line's file, with its name and the place in it.
pub fn line_diagnostic(file: String, error: Error) -> Diagnostic {
    let position = error.line.map(|line| Position { line, column: error.column.unwrap_or(1) });
    Diagnostic { position, ..Diagnostic::new(file, error.message).help(error.hint) }
}

fn positive<T: Copy + Into<f64>>(reader: &Reader, number: &Spanned<T>, what: &str) -> Result<f64, Diagnostic> {
    let value = reader.source.finite(number, what)?;
    if value > 0.0 {
        return Ok(value);
    }
    Err(reader
        .source
        .diagnostic_at(number.span(), format!("{what} must be positive, is {value}"))
        .help("write a number above 0"))
}
