//! Approximates curves by chords. Corners lie on the curve, and no point of the curve is farther from its chord than a
//! tolerance.
//!
//! If the second derivative of a curve with respect to its parameter is at most `bend`, a chord over a step `s` of the
//! parameter is at most `bend s^2 / 8` away from the curve.

use crate::Point;
use crate::map::Map;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Greatest number of chords of a curve. A tolerance that needs more must be a mistake.
const MAX_CHORDS: f64 = 1e5;

/// A curve would need too many chords.
#[derive(Debug)]
pub(crate) struct TooFineCurve;

/// Returns the number of chords for a step of `range` of the parameter. `bend` is an upper bound of the curve's second
/// derivative.
fn chords(bend: f64, range: f64, tolerance: f64) -> Result<usize, TooFineCurve> {
    let count = (range * (bend / (8.0 * tolerance)).sqrt()).ceil().max(1.0);
    if count <= MAX_CHORDS { Ok(count as usize) } else { Err(TooFineCurve) }
}

/// Returns points of a curve at `count` equal steps of the parameter from 0 to 1, without the first point.
fn points_along(count: usize, at: impl Fn(f64) -> Point) -> impl Iterator<Item = Point> {
    (1..=count).map(move |k| at(k as f64 / count as f64))
}

/// The ellipse of points `center + u cos t + v sin t`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ellipse {
    pub center: Point,
    pub u: Point,
    pub v: Point,
}

impl Ellipse {
    pub fn circle(center: Point, radius: f64) -> Self {
        Self { center, u: [radius, 0.0], v: [0.0, radius] }
    }

    pub fn mapped(self, map: &Map) -> Self {
        Self { center: map.point(self.center), u: map.vector(self.u), v: map.vector(self.v) }
    }

    pub fn at(self, t: f64) -> Point {
        let (sin, cos) = t.sin_cos();
        [0, 1].map(|k| self.center[k] + self.u[k] * cos + self.v[k] * sin)
    }

    fn longest(self) -> f64 {
        // The half axes are the singular values of the matrix with the columns `u` and `v`.
        let square: f64 = [self.u, self.v].iter().flatten().map(|x| x * x).sum();
        let cross = self.u[0] * self.v[1] - self.u[1] * self.v[0];
        (square / 2.0 + ((square * square / 4.0 - cross * cross).max(0.0)).sqrt()).sqrt()
    }

    /// Returns points of the arc that begins at parameter `from` and covers the range `by`, without the first point.
    pub fn arc(self, from: f64, by: f64, tolerance: f64) -> Result<impl Iterator<Item = Point>, TooFineCurve> {
        let count = chords(self.longest(), by.abs(), tolerance)?.max((by.abs() / FRAC_PI_2).ceil() as usize);
        Ok(points_along(count, move |part| self.at(from + by * part)))
    }

    pub fn ring(self, tolerance: f64) -> Result<Vec<Point>, TooFineCurve> {
        Ok(self.arc(0.0, TAU, tolerance)?.collect())
    }
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct CircularArc {
    pub center: Point,
    pub radius: f64,
    pub from: f64,
    /// Angle by which the arc turns, radians, positive to the left.
    pub by: f64,
}

impl CircularArc {
    /// Creates the arc from `a` to `b` that turns by four times the arc tangent of `bulge`. Returns `None` if it is
    /// straight.
    pub fn new(a: Point, b: Point, bulge: f64) -> Option<Self> {
        let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
        let middle = [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0];
        // Distance from the middle of the chord to the centre, as a multiple of the chord, to the left.
        let aside = (1.0 - bulge * bulge) / (4.0 * bulge);
        let center = [middle[0] - dy * aside, middle[1] + dx * aside];
        let is_bent = bulge != 0.0 && a != b && center.iter().all(|x| x.is_finite());
        is_bent.then(|| Self {
            center,
            radius: (a[0] - center[0]).hypot(a[1] - center[1]),
            from: (a[1] - center[1]).atan2(a[0] - center[0]),
            by: 4.0 * bulge.atan(),
        })
    }

    /// Returns the curve whose distance from the arc changes linearly from `first` to `last`. Positive distances are outwards.
    /// Negative ones are inwards, and at most the radius. The chords are within the tolerance after `map` is applied.
    pub fn spiral(self, first: f64, last: f64, map: &Map, tolerance: f64) -> Result<Vec<Point>, TooFineCurve> {
        let Self { center, radius, from, by } = self;
        let bend = radius + first.abs().max(last.abs()) + 2.0 * (last - first).abs() / by.abs();
        let stretch = Ellipse::circle(center, 1.0).mapped(map).longest();
        let count = chords(bend * stretch, by.abs(), tolerance)?.max((by.abs() / FRAC_PI_2).ceil() as usize);
        let at = |k: usize| {
            let part = k as f64 / count as f64;
            let radius = (radius + first + (last - first) * part).max(0.0);
            Ellipse::circle(center, radius).at(from + by * part)
        };
        Ok((0..=count).map(at).collect())
    }
}

/// Returns an arc from `a` to `b`, without `a`, that turns by four times the arc tangent of `bulge`, positive to the
/// left.
pub(crate) fn bulge(a: Point, b: Point, bulge: f64, map: &Map, tolerance: f64) -> Result<Vec<Point>, TooFineCurve> {
    let end = map.point(b);
    let Some(CircularArc { center, radius, from, by }) = CircularArc::new(a, b, bulge) else { return Ok(vec![end]) };
    let arc = Ellipse::circle(center, radius).mapped(map).arc(from, by, tolerance)?;
    let mut points: Vec<Point> = arc.collect();
    if let Some(last) = points.last_mut() {
        *last = end;
    }
    Ok(points)
}

/// Returns a cubic Bézier curve without its first point.
pub(crate) fn cubic([a, b, c, d]: [Point; 4], tolerance: f64) -> Result<impl Iterator<Item = Point>, TooFineCurve> {
    let second = |p: Point, q: Point, r: Point| (p[0] - 2.0 * q[0] + r[0]).hypot(p[1] - 2.0 * q[1] + r[1]);
    let count = chords(6.0 * second(a, b, c).max(second(b, c, d)), 1.0, tolerance)?;
    Ok(points_along(count, move |t| {
        let s = 1.0 - t;
        let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
        [0, 1].map(|k| weights[0] * a[k] + weights[1] * b[k] + weights[2] * c[k] + weights[3] * d[k])
    }))
}

/// A spline: degree, knots, control points and their weights.
#[derive(Debug)]
pub(crate) struct Spline {
    pub degree: usize,
    pub knots: Vec<f64>,
    pub control: Vec<Point>,
    pub weights: Vec<f64>,
}

/// Greatest number of halvings of a span before the spline is refused.
const MAX_HALVINGS: u32 = 14;

impl Spline {
    /// Returns true if degree, knots, control points and weights are consistent.
    pub fn is_sound(&self) -> bool {
        let Self { degree, knots, control, weights } = self;
        (1..=16).contains(degree)
            && control.len() > *degree
            && knots.len() == control.len() + degree + 1
            && knots.is_sorted()
            && knots[*degree] < knots[control.len()]
            && weights.len() == control.len()
            && weights.iter().all(|&w| w > 0.0)
    }

    /// Returns points of the spline. Halves each span until the middle of each chord is within half of the tolerance.
    pub fn points(&self, tolerance: f64) -> Result<Vec<Point>, TooFineCurve> {
        let (first, last) = (self.degree, self.control.len());
        let mut points = vec![self.at(first, self.knots[first])];
        for span in (first..last).filter(|&i| self.knots[i] < self.knots[i + 1]) {
            let (from, to) = (self.knots[span], self.knots[span + 1]);
            let at = |part: f64| self.at(span, from + (to - from) * part);
            let fits = |count: &usize| {
                let step = 1.0 / *count as f64;
                (0..*count).all(|k| {
                    let [a, m, b] = [0.0, 0.5, 1.0].map(|part| at((k as f64 + part) * step));
                    distance(m, a, b) <= tolerance / 2.0
                })
            };
            // With fewer than four chords, a curve that is symmetric about its middle could look straight.
            let count = (2..MAX_HALVINGS).map(|k| 1_usize << k).find(fits).ok_or(TooFineCurve)?;
            points.extend(points_along(count, at));
        }
        Ok(points)
    }

    /// Evaluates the spline by De Boor's algorithm, in projective coordinates.
    fn at(&self, span: usize, t: f64) -> Point {
        let Self { degree: p, knots, control, weights } = self;
        let mut rows: Vec<[f64; 3]> =
            (span - p..=span).map(|i| [control[i][0] * weights[i], control[i][1] * weights[i], weights[i]]).collect();
        for level in 1..=*p {
            for j in (level..=*p).rev() {
                let (left, right) = (knots[j + span - p], knots[j + 1 + span - level]);
                let part = if right > left { (t - left) / (right - left) } else { 0.0 };
                rows[j] = [0, 1, 2].map(|k| rows[j - 1][k] * (1.0 - part) + rows[j][k] * part);
            }
        }
        let [x, y, w] = rows[*p];
        [x / w, y / w]
    }
}

fn distance(p: Point, a: Point, b: Point) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    let part = ((p[0] - a[0]) * along[0] + (p[1] - a[1]) * along[1]) / square;
    let part = if square > 0.0 { part.clamp(0.0, 1.0) } else { 0.0 };
    (p[0] - a[0] - along[0] * part).hypot(p[1] - a[1] - along[1] * part)
}
