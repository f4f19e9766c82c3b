//! Converts SVG path data to curves, and curves to chords.

use crate::Point;
use crate::curve::{Ellipse, TooFineCurve, cubic};
use crate::map::Map;
use std::f64::consts::TAU;
use svgtypes::{PathParser, PathSegment};

/// A connected part of a path, with its exact curves. Each begins where the previous one ends.
#[derive(Debug, Clone)]
pub(super) struct Outline {
    pub start: Point,
    pub curves: Vec<OutlineCurve>,
    pub is_closed: bool,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum OutlineCurve {
    /// A straight line to this point.
    Line(Point),
    /// A cubic Bézier curve: its two inner control points and its end.
    Cubic([Point; 3]),
    /// An arc of an ellipse from a parameter over a range.
    Arc { ellipse: Ellipse, from: f64, by: f64, end: Point },
}

impl Outline {
    /// Returns the outline as chords that are within `tolerance` of its curves.
    pub fn stretch(&self, tolerance: f64) -> Result<Stretch, TooFineCurve> {
        let mut points = vec![self.start];
        let mut at = self.start;
        for curve in &self.curves {
            match *curve {
                OutlineCurve::Line(end) => points.push(end),
                OutlineCurve::Cubic([b, c, d]) => points.extend(cubic([at, b, c, d], tolerance)?),
                OutlineCurve::Arc { ellipse, from, by, end } => {
                    points.extend(ellipse.arc(from, by, tolerance)?);
                    points.pop();
                    points.push(end);
                }
            }
            at = curve.end();
        }
        Ok(Stretch { points, is_closed: self.is_closed })
    }
}

impl OutlineCurve {
    pub fn end(&self) -> Point {
        match *self {
            Self::Line(end) | Self::Cubic([_, _, end]) | Self::Arc { end, .. } => end,
        }
    }
}

/// The points of a connected part of a path.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Stretch {
    pub points: Vec<Point>,
    pub is_closed: bool,
}

/// The state of the pen, in coordinates before the map.
struct Pen<'m> {
    map: &'m Map,
    at: Point,
    begin: Point,
    /// The last control points of a cubic and of a quadratic curve, which smooth curves mirror.
    control: [Option<Point>; 2],
    outlines: Vec<Outline>,
    /// True if the next segment starts a new outline.
    starts_outline: bool,
}

/// Returns the connected outlines of a path.
///
/// # Errors
/// If the data are not well-formed, with the reason.
pub(super) fn outlines(data: &str, map: &Map) -> Result<Vec<Outline>, String> {
    let (at, begin) = ([0.0; 2], [0.0; 2]);
    let mut pen = Pen { map, at, begin, control: [None; 2], outlines: Vec::new(), starts_outline: true };
    for segment in PathParser::from(data) {
        pen.draw(segment.map_err(|error| error.to_string())?);
    }
    Ok(pen.outlines)
}

impl Pen<'_> {
    fn draw(&mut self, segment: PathSegment) {
        let here = self.at;
        let to = |abs: bool, x: f64, y: f64| if abs { [x, y] } else { [here[0] + x, here[1] + y] };
        let reflected = |control: Option<Point>| control.map_or(here, |c| [0, 1].map(|k| 2.0 * here[k] - c[k]));
        let controls = std::mem::take(&mut self.control);
        match segment {
            PathSegment::MoveTo { abs, x, y } => {
                self.at = to(abs, x, y);
                self.begin = self.at;
                self.starts_outline = true;
            }
            PathSegment::LineTo { abs, x, y } => self.line(to(abs, x, y)),
            PathSegment::HorizontalLineTo { abs, x } => self.line([to(abs, x, 0.0)[0], here[1]]),
            PathSegment::VerticalLineTo { abs, y } => self.line([here[0], to(abs, 0.0, y)[1]]),
            PathSegment::CurveTo { abs, x1, y1, x2, y2, x, y } => {
                self.curve(to(abs, x1, y1), to(abs, x2, y2), to(abs, x, y));
            }
            PathSegment::SmoothCurveTo { abs, x2, y2, x, y } => {
                self.curve(reflected(controls[0]), to(abs, x2, y2), to(abs, x, y));
            }
            PathSegment::Quadratic { abs, x1, y1, x, y } => self.quadratic(to(abs, x1, y1), to(abs, x, y)),
            PathSegment::SmoothQuadratic { abs, x, y } => self.quadratic(reflected(controls[1]), to(abs, x, y)),
            PathSegment::EllipticalArc { abs, rx, ry, x_axis_rotation, large_arc, sweep, x, y } => {
                let end = to(abs, x, y);
                match arc(here, end, [rx, ry], x_axis_rotation.to_radians(), large_arc, sweep) {
                    Some((ellipse, from, by)) => {
                        let (ellipse, mapped) = (ellipse.mapped(self.map), self.map.point(end));
                        self.begin_outline().curves.push(OutlineCurve::Arc { ellipse, from, by, end: mapped });
                        self.at = end;
                    }
                    None => self.line(end),
                }
            }
            PathSegment::ClosePath { .. } => {
                if !self.starts_outline {
                    self.begin_outline().is_closed = true;
                }
                self.at = self.begin;
                self.starts_outline = true;
            }
        }
    }

    /// Returns the current outline. Starts a new one if the last has ended.
    fn begin_outline(&mut self) -> &mut Outline {
        if std::mem::take(&mut self.starts_outline) {
            self.begin = self.at;
            self.outlines.push(Outline { start: self.map.point(self.at), curves: Vec::new(), is_closed: false });
        }
        self.outlines.last_mut().expect("one was begun")
    }

    fn line(&mut self, end: Point) {
        let point = self.map.point(end);
        self.begin_outline().curves.push(OutlineCurve::Line(point));
        self.at = end;
    }

    fn curve(&mut self, b: Point, c: Point, d: Point) {
        let points = [b, c, d].map(|p| self.map.point(p));
        self.begin_outline().curves.push(OutlineCurve::Cubic(points));
        self.at = d;
        self.control[0] = Some(c);
    }

    /// Draws a quadratic curve as a cubic one.
    fn quadratic(&mut self, b: Point, c: Point) {
        let towards = |p: Point| [0, 1].map(|k| p[k] + (b[k] - p[k]) * 2.0 / 3.0);
        self.curve(towards(self.at), towards(c), c);
        self.control = [None, Some(b)];
    }
}

/// Returns the ellipse of an arc, with the arc's first parameter and its range. `None` if the arc is a straight line.
/// (SVG 2, implementation notes, B.2.4.)
fn arc(a: Point, b: Point, radii: [f64; 2], turn: f64, large: bool, sweep: bool) -> Option<(Ellipse, f64, f64)> {
    let [mut rx, mut ry] = radii.map(f64::abs);
    if rx == 0.0 || ry == 0.0 || a == b {
        return None;
    }
    let (sin, cos) = turn.sin_cos();
    let half = [(a[0] - b[0]) / 2.0, (a[1] - b[1]) / 2.0];
    let [x, y] = [cos * half[0] + sin * half[1], cos * half[1] - sin * half[0]];
    // If the radii are too small for the arc to reach both ends, scale them up.
    let reach = (x / rx).powi(2) + (y / ry).powi(2);
    if reach > 1.0 {
        rx *= reach.sqrt();
        ry *= reach.sqrt();
    }
    let square = (x / rx).powi(2) + (y / ry).powi(2);
    let aside = (1.0 / square - 1.0).max(0.0).sqrt() * if large == sweep { -1.0 } else { 1.0 };
    let [cx, cy] = [aside * rx * y / ry, -aside * ry * x / rx];
    let center = [cos * cx - sin * cy + (a[0] + b[0]) / 2.0, sin * cx + cos * cy + (a[1] + b[1]) / 2.0];
    let from = ((y - cy) / ry).atan2((x - cx) / rx);
    let to = ((-y - cy) / ry).atan2((-x - cx) / rx);
    let by = (to - from).rem_euclid(TAU) - if sweep { 0.0 } else { TAU };
    Some((Ellipse { center, u: [rx * cos, rx * sin], v: [-ry * sin, ry * cos] }, from, by))
}
