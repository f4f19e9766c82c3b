//! Polygons and polylines of the world file, as people and exporters write them.

use super::reader::Reader;
use cplan_geometry::{Convex, Point, Polygon, Pose, RingError, SimplePolygon};
use cplan_model::Shape;
use cplan_robot::{Diagnostic, FromToml, Number, Spanned, TomlError, TomlValue, length};

/// A number or a list of coordinates: together a point, a ring, or GeoJSON's list of rings.
pub(super) enum Coordinates {
    Number(f64),
    List(Vec<Spanned<Coordinates>>),
}

/// Coordinates with their position in the file.
pub(super) type Ring = Spanned<Coordinates>;

impl FromToml for Coordinates {
    fn read(value: &TomlValue) -> Result<Self, TomlError> {
        match value.get_ref().as_array() {
            Some(_) => FromToml::read(value).map(Self::List),
            None => length(value, "a list of points: [[x, y], ...]").map(Self::Number),
        }
    }
}

/// Note about a closed ring.
const CLOSED_RING_NOTE: &str = "the last point of a ring repeats the first; it counts once";
const REPEATED_POINTS_NOTE: &str = "points that repeat the previous point count once";
/// Note about a polygon whose boundary touches itself but whose inside is well defined.
const TOUCHING_BOUNDARY_NOTE: &str = "the boundary touches itself in single points; the enclosed area is solid";

impl Coordinates {
    fn list(&self) -> &[Spanned<Coordinates>] {
        match self {
            Self::Number(_) => &[],
            Self::List(items) => items,
        }
    }

    /// Returns true for a list of rings, as in GeoJSON, and false for a single ring.
    fn is_nested(&self) -> bool {
        let first_point = self.list().first().map(Spanned::get_ref);
        let first_coordinate = first_point.and_then(|point| point.list().first()).map(Spanned::get_ref);
        matches!(first_coordinate, Some(Self::List(_)))
    }
}

/// Returns a polygon at its place.
///
/// # Errors
/// A polygon that crosses itself; `help` is the hint of this error.
pub(super) fn polygon(
    reader: &Reader,
    given: &Ring,
    holes: Option<&Spanned<Vec<Ring>>>,
    place: Option<&Pose>,
    what: &str,
    help: &str,
) -> Result<(Shape, Vec<Convex>), Diagnostic> {
    let rings: Vec<&Ring> =
        if given.get_ref().is_nested() { given.get_ref().list().iter().collect() } else { vec![given] };
    let rings: Vec<&Ring> = rings.into_iter().chain(holes.iter().flat_map(|holes| holes.get_ref())).collect();
    let name = |k: usize| if k == 0 { what.to_owned() } else { format!("{what}, hole {k}") };
    let mut corners: Vec<Vec<Point>> = Vec::with_capacity(rings.len());
    for (k, ring) in rings.iter().enumerate() {
        corners.push(moved(ring_of(reader, ring, &name(k))?, place));
    }
    let outer = corners.remove(0);
    let has_holes = !corners.is_empty();
    let polygon = Polygon::new(outer, corners).map_err(|error| {
        let place = match error {
            RingError::Hole { hole, .. } | RingError::Misplaced { hole } => rings[hole.min(rings.len() - 1)].span(),
            RingError::Cross { second, .. } | RingError::Overlap { second, .. } => rings[second.ring].span(),
            RingError::Outer(_) | RingError::CrossesAt { .. } => rings[0].span(),
        };
        let kind = if has_holes { "not a polygon with holes" } else { "not a simple polygon" };
        reader.source.diagnostic_at(place, format!("{what} is {kind}: {error}")).help(help)
    })?;
    match polygon.parts() {
        [simple] if !has_holes => Ok((Shape::Polygon(simple.corners().to_vec()), polygon.convex_pieces())),
        _ => {
            if !has_holes {
                reader.taken.note(what, TOUCHING_BOUNDARY_NOTE);
            }
            Ok((Shape::Pieces, polygon.convex_pieces()))
        }
    }
}

/// Returns a polygon whose boundary does not touch itself.
///
/// # Errors
/// A boundary that touches or crosses itself; `help` is the hint of this error.
pub(super) fn simple_polygon(
    reader: &Reader,
    given: &Ring,
    what: &str,
    help: &str,
) -> Result<SimplePolygon, Diagnostic> {
    SimplePolygon::new(ring_of(reader, given, what)?).map_err(|error| {
        reader.source.diagnostic_at(given.span(), format!("{what} is not a simple polygon: {error}")).help(help)
    })
}

/// Returns a thin wall at its place.
pub(super) fn polyline(
    reader: &Reader,
    given: &Ring,
    place: Option<&Pose>,
    what: &str,
) -> Result<(Shape, Vec<Convex>), Diagnostic> {
    let points = moved(without_repeats(reader, points(reader, given, what)?, what), place);
    if points.len() < 2 {
        let message =
            format!("{what}: a polyline needs at least two points in different places, it has {}", points.len());
        return Err(reader.source.diagnostic_at(given.span(), message).help("polyline = [[x, y], [x, y], ...]"));
    }
    let pieces = points.windows(2).map(|w| Convex::between(w[0], w[1])).collect();
    Ok((Shape::Polyline(points), pieces))
}

fn moved(mut points: Vec<Point>, place: Option<&Pose>) -> Vec<Point> {
    if let Some(place) = place {
        points.iter_mut().for_each(|point| *point = place.point(*point));
    }
    points
}

/// Returns the corners of a ring without repeated points.
fn ring_of(reader: &Reader, given: &Ring, what: &str) -> Result<Vec<Point>, Diagnostic> {
    let mut corners = without_repeats(reader, points(reader, given, what)?, what);
    if corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
        reader.taken.note(what, CLOSED_RING_NOTE);
    }
    Ok(corners)
}

fn without_repeats(reader: &Reader, mut points: Vec<Point>, what: &str) -> Vec<Point> {
    let given = points.len();
    points.dedup();
    if points.len() < given {
        reader.taken.note(what, REPEATED_POINTS_NOTE);
    }
    points
}

fn points(reader: &Reader, given: &Ring, what: &str) -> Result<Vec<Point>, Diagnostic> {
    let Coordinates::List(items) = given.get_ref() else {
        let message = format!("{what}: expected a list of points, found a number");
        return Err(reader.source.diagnostic_at(given.span(), message).help("write points as [[x, y], [x, y], ...]"));
    };
    items.iter().enumerate().map(|(i, item)| point(reader, item, &format!("{what}, point {}", i + 1))).collect()
}

fn point(reader: &Reader, given: &Ring, what: &str) -> Result<Point, Diagnostic> {
    let wrong = |found: String| {
        let message = format!("{what}: expected two numbers, found {found}");
        reader.source.diagnostic_at(given.span(), message).help("write a point as [x, y], metres")
    };
    let number = |coordinate: &Ring| match coordinate.get_ref() {
        Coordinates::Number(value) => reader.source.finite(&Number::new(coordinate.span(), *value), what),
        Coordinates::List(_) => Err(wrong("a list".into())),
    };
    match given.get_ref() {
        Coordinates::List(pair) => match &pair[..] {
            [x, y] => Ok(Point::new(number(x)?, number(y)?)),
            other => Err(wrong(other.len().to_string())),
        },
        Coordinates::Number(_) => Err(wrong("one".into())),
    }
}
