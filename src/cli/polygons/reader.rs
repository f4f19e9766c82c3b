//! Polygons from files, and from points on the command line.

use crate::geometry::{Point, PolygonError, SimplePolygon};
use crate::input::{Diagnostic, InputError, Source};
use cplan_robot::{Number, Numbers};
use serde::Deserialize;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A polygon from the user.
pub struct GivenPolygon {
    pub polygon: SimplePolygon,
    /// Notes about corrections of the input.
    pub notes: Vec<String>,
    /// The file with the polygon. `None` if its corners are on the command line.
    pub file: Option<PathBuf>,
}

/// A point, and its place in the text.
type PlacedPoint = (Point, Range<usize>);

/// The content of a TOML file with a polygon.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PolygonFile {
    polygon: Vec<Numbers>,
}

/// Hint for text that is not a list of points.
const POINTS_HELP: &str = "write each point as x,y, and a blank or a new line between points, such as \"0,0 1,0 1,1\"";
/// Characters between the numbers of a text.
const SEPARATORS: [char; 10] = [' ', '\t', '\r', '\n', ',', ';', '(', ')', '[', ']'];

/// Reads a polygon from a file, or from the word itself if it is a list of points. `name` is the polygon's name in messages.
///
/// # Errors
/// A file that cannot be read, text that is no list of points, and points that do not form a simple polygon.
pub fn read(word: &str, name: &str) -> Result<GivenPolygon, InputError> {
    let path = Path::new(word);
    let begins_with_number = word.trim_start().starts_with(|c: char| c.is_ascii_digit() || "+-.([".contains(c));
    if !path.exists() {
        if begins_with_number || word.trim().is_empty() {
            let source = Source::in_memory(format!("polygon {name}"), word);
            return Ok(polygon(&source, text_points(&source)?, name, None)?);
        }
        let help = format!("name a file, or write the corners of {name}, such as \"0,0 1,0 1,1\"");
        return Err(Diagnostic::new(word, "there is no such file").help(help).into());
    }
    let source = Source::read(path)?;
    let is_toml = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"));
    let points = if is_toml { toml_points(&source)? } else { text_points(&source)? };
    Ok(polygon(&source, points, name, Some(path.to_owned()))?)
}

impl GivenPolygon {
    /// Returns the polygon, turned about the origin by an angle in radians.
    ///
    /// # Errors
    /// A polygon with such small details that its boundary touches itself after the rounding of the turn.
    pub fn turned(self, angle: f64) -> Result<Self, InputError> {
        let (sin, cos) = angle.sin_cos();
        let turn = |p: &Point| Point::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y);
        let polygon = SimplePolygon::new(self.polygon.corners().iter().map(turn).collect()).map_err(|error| {
            Diagnostic::new("--turn", format!("the turned polygon A is not simple: {error}")).help("turn it less")
        })?;
        Ok(Self { polygon, ..self })
    }
}

/// Returns the points of a text, with two numbers each. Skips a first line of letters, as in the header of a table.
fn text_points(source: &Source) -> Result<Vec<PlacedPoint>, Diagnostic> {
    let (mut points, mut from, mut is_first) = (Vec::new(), 0, true);
    for line in source.text().split_inclusive('\n') {
        let words = words(line.split('#').next().unwrap_or_default(), from);
        from += line.len();
        let is_header = is_first && words.iter().all(|(word, _)| word.chars().all(char::is_alphabetic));
        is_first &= words.is_empty();
        if is_header {
            continue;
        }
        let mut numbers = Vec::with_capacity(words.len());
        for (word, range) in words {
            let value = word.parse::<f64>().map_err(|_| {
                source.diagnostic_at(range.clone(), format!("\"{word}\" is not a number")).help(POINTS_HELP)
            })?;
            numbers.push((source.finite(&Number::new(range.clone(), value), "a coordinate")?, range));
        }
        if numbers.len() % 2 == 1 {
            let range = numbers[0].1.start..numbers[numbers.len() - 1].1.end;
            let message = format!("a point needs two numbers, but here are {}", numbers.len());
            return Err(source.diagnostic_at(range, message).help(POINTS_HELP));
        }
        let point = |pair: &[(f64, Range<usize>)]| (Point::new(pair[0].0, pair[1].0), pair[0].1.start..pair[1].1.end);
        points.extend(numbers.chunks_exact(2).map(point));
    }
    Ok(points)
}

/// Returns the words of a line that begins at `from` in the text, with their places in the text.
fn words(line: &str, from: usize) -> Vec<(&str, Range<usize>)> {
    let place = |word: &str| {
        let start = from + (word.as_ptr() as usize - line.as_ptr() as usize);
        start..start + word.len()
    };
    line.split(SEPARATORS).filter(|word| !word.is_empty()).map(|word| (word, place(word))).collect()
}

fn toml_points(source: &Source) -> Result<Vec<PlacedPoint>, Diagnostic> {
    const HELP: &str = "write the corners as polygon = [[x, y], [x, y], ...]";
    let file: PolygonFile = toml::from_str(source.text()).map_err(|error| {
        source.diagnostic_at(error.span().unwrap_or_default(), error.message().to_owned()).help(HELP)
    })?;
    let point = |numbers: &Numbers| match numbers.get_ref().as_slice() {
        [x, y] => {
            let at = Point::new(source.finite(x, "a coordinate")?, source.finite(y, "a coordinate")?);
            Ok((at, numbers.span()))
        }
        other => {
            let message = format!("a point needs two numbers, but here are {}", other.len());
            Err(source.diagnostic_at(numbers.span(), message).help(HELP))
        }
    };
    file.polygon.iter().map(point).collect()
}

/// Makes a polygon from points. Drops repeated neighbours, and a last point that repeats the first.
fn polygon(
    source: &Source,
    mut points: Vec<PlacedPoint>,
    name: &str,
    file: Option<PathBuf>,
) -> Result<GivenPolygon, Diagnostic> {
    let mut notes = Vec::new();
    let given = points.len();
    points.dedup_by(|a, b| a.0 == b.0);
    if points.len() > 1 && points[0].0 == points[points.len() - 1].0 {
        points.pop();
    }
    if points.len() < given {
        notes.push(format!("{name}: points that repeat the previous point, or at the end the first one, count once"));
    }
    let corners: Vec<Point> = points.iter().map(|(at, _)| *at).collect();
    let polygon = SimplePolygon::new(corners.clone()).map_err(|error| {
        let (corner, help) = place_and_help(error);
        let range = corner.and_then(|corner| points.get(corner)).map_or(0..source.text().len(), |p| p.1.clone());
        source.diagnostic_at(range, format!("{name} is not a simple polygon: {error}")).help(help)
    })?;
    if polygon.corners() != corners {
        notes.push(format!("{name} is listed clockwise; this report numbers its corners counter-clockwise"));
    }
    Ok(GivenPolygon { polygon, notes, file })
}

/// Returns the corner at which a list of corners is defective, if it is a single one, and a hint.
fn place_and_help(error: PolygonError) -> (Option<usize>, &'static str) {
    match error {
        PolygonError::TooFewCorners { .. } => (None, POINTS_HELP),
        PolygonError::NotFinite { corner } => (Some(corner), POINTS_HELP),
        PolygonError::RepeatedCorner { second, .. } => (Some(second), "remove or move one of the two corners"),
        PolygonError::NoArea => (None, "move a corner off the line"),
        PolygonError::Spike { corner } => (Some(corner), "remove this corner"),
        PolygonError::SidesCross { second, .. } | PolygonError::SidesTouch { second, .. } => {
            (Some(second), "list the corners in order along the boundary")
        }
    }
}
