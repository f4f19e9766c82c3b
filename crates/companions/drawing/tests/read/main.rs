//! Tests of drawings against closed forms, results of other programs, and files that the tests write themselves.

mod cell;
mod dxf;
mod geojson;
mod hostile;
mod line;
mod svg;
mod written;

pub use cplan_cases::plane::distance;
use cplan_drawing::{Drawing, Format, Geometry, Point, Ring, Settings, Shape, read};

/// Reads a text with the default settings.
pub fn drawing(text: &str, format: Format) -> Drawing {
    read(text.as_bytes(), format, &Settings::default()).unwrap_or_else(|error| panic!("{error:?}"))
}

/// Returns the only shape.
pub fn only_shape(drawing: &Drawing) -> &Shape {
    let [shape] = &drawing.shapes[..] else { panic!("{drawing:?}") };
    shape
}

/// Returns the outer ring of a shape without holes.
pub fn ring(shape: &Shape) -> &Ring {
    match &shape.geometry {
        Geometry::Polygon { outer, holes } if holes.is_empty() => outer,
        other => panic!("{other:?}"),
    }
}

/// Returns the points of a wall.
pub fn wall(shape: &Shape) -> &[Point] {
    let Geometry::Polyline(points) = &shape.geometry else { panic!("{shape:?}") };
    points
}

/// Returns the area that a ring surrounds, positive if it is counter-clockwise.
pub fn area(ring: &[Point]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(p, q)| p[0] * q[1] - p[1] * q[0]).sum::<f64>() / 2.0
}

/// Returns the length of a polyline.
pub fn length(points: &[Point]) -> f64 {
    points.windows(2).map(|w| distance(w[0], w[1])).sum()
}

/// Asserts that a number equals another one within a tolerance.
#[track_caller]
pub fn near(a: f64, b: f64, within: f64) {
    assert!((a - b).abs() <= within, "{a} against {b}, within {within}");
}

/// Asserts that points are equal up to rounding.
#[track_caller]
pub fn assert_same_points(given: &[Point], expected: &[Point]) {
    assert_eq!(given.len(), expected.len(), "{given:?} against {expected:?}");
    for (p, q) in given.iter().zip(expected) {
        assert!(distance(*p, *q) < 1e-12, "{given:?} against {expected:?}");
    }
}

/// Returns the messages of all notes.
pub fn notes(drawing: &Drawing) -> Vec<String> {
    drawing.notes.all().iter().map(ToString::to_string).collect()
}
