//! Directions of curves as angles.

use crate::curve::{Curve, Point, minus, norm};
use std::f64::consts::{FRAC_PI_2, TAU};

/// The headings on a part of a curve, as angles from the x axis. All differ by at most `half` from `middle`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Headings {
    /// The heading in the middle, radians.
    pub middle: f64,
    /// Greatest difference from `middle`, radians, not negative.
    pub half: f64,
}

/// Adds the whole turns that bring an angle nearest to zero, radians.
pub fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

impl Curve {
    /// Returns the direction of travel at a parameter as an angle from the x axis, radians. Returns `None` if the curve has
    /// no length, or reverses there.
    pub fn heading(&self, u: f64) -> Option<f64> {
        let [x, y] = match *self {
            Curve::Arc { radius, from, by, growth, .. } => {
                return (by != 0.0).then_some(from + by * u + slant(radius + growth * u, by, growth));
            }
            Curve::Cubic(_) if u == 0.0 || u == 1.0 => self.direction(u)?,
            _ => self.derivative(u),
        };
        (x != 0.0 || y != 0.0).then(|| y.atan2(x))
    }

    /// Returns bounds on the headings between two parameters. They are exact for lines and circles. Returns `None` if the
    /// headings may differ by half a turn or more, or if the curve has no length.
    pub fn headings(&self, [from, to]: [f64; 2]) -> Option<Headings> {
        match *self {
            Curve::Line { .. } => Some(Headings { middle: self.heading(0.0)?, half: 0.0 }),
            Curve::Arc { radius, by, growth, .. } => {
                let middle = (from + to) / 2.0;
                // The angle between the heading and the direction from the centre is monotone.
                let [a, b, c] = [from, middle, to].map(|u| slant(radius + growth * u, by, growth));
                let half = (by * (to - from)).abs() / 2.0 + (a - b).abs().max((c - b).abs());
                Some(Headings { middle: self.heading(middle)?, half })
            }
            Curve::Cubic(points) => {
                let [a, b, c] = [0, 1, 2].map(|k| minus(points[k + 1], points[k]));
                let at = |s: f64, t: f64| mixed(mixed(a, b, s), mixed(b, c, s), t);
                // Control points of the derivative on this part. One of zero length has no direction.
                let control = [at(from, from), at(from, to), at(to, to)];
                let units = control.into_iter().filter(|v| norm(*v) > 0.0).map(|v| v.map(|x| x / norm(v)));
                let units: Vec<Point> = units.collect();
                let [x, y] = units.iter().fold([0.0; 2], |sum, v| [sum[0] + v[0], sum[1] + v[1]]);
                let middle = (x != 0.0 || y != 0.0).then(|| y.atan2(x))?;
                let half = units.iter().map(|v| wrapped(v[1].atan2(v[0]) - middle).abs()).fold(0.0, f64::max);
                (half < FRAC_PI_2).then_some(Headings { middle, half })
            }
        }
    }
}

/// Returns the angle from the direction away from an arc's centre to the heading, radians.
fn slant(radius: f64, by: f64, growth: f64) -> f64 {
    if growth == 0.0 { by.signum() * FRAC_PI_2 } else { (radius * by).atan2(growth) }
}

/// Interpolates between two points.
pub(crate) fn mixed(a: Point, b: Point, u: f64) -> Point {
    [0, 1].map(|k| a[k] * (1.0 - u) + b[k] * u)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        /// Compares the bounds with directions of short chords.
        #[test]
        fn headings_cover_the_directions_of_chords(
            points in prop::array::uniform8(-1.0..1.0_f64), part in (0.0..1.0_f64, 0.0..1.0_f64), share in 0.0..1.0_f64,
        ) {
            let point = |k: usize| [points[2 * k], points[2 * k + 1]];
            let arc = Curve::Arc { center: point(0), radius: 0.1 + points[2].abs(), from: 3.0 * points[3], by: 6.0 * points[4], growth: 0.09 * points[5] };
            let line = Curve::Line { from: point(0), to: point(1) };
            let [from, to] = [part.0.min(part.1), part.0.max(part.1)];
            for curve in [line, arc, Curve::Cubic([0, 1, 2, 3].map(point))] {
                let Some(Headings { middle, half }) = curve.headings([from, to]) else { continue };
                let u = from + (to - from) * share;
                let [a, b] = [(u - 1e-6).max(0.0), (u + 1e-6).min(1.0)].map(|u| curve.at(u));
                let chord = minus(b, a);
                prop_assume!(norm(chord) > 1e-7);
                let heading = chord[1].atan2(chord[0]);
                prop_assert!(wrapped(heading - middle).abs() <= half + 1e-4, "{curve:?}");
                prop_assert!(wrapped(heading - curve.heading(u).unwrap()).abs() <= 1e-3);
            }
        }
    }

    #[test]
    fn a_curve_without_a_direction_has_no_heading() {
        let point = Curve::Line { from: [1.0, 2.0], to: [1.0, 2.0] };
        assert_eq!((point.heading(0.5), point.headings([0.0, 1.0])), (None, None));
        // The first two control points coincide, so the third one gives the direction.
        let cubic = Curve::Cubic([[0.0, 0.0], [0.0, 0.0], [0.0, 1.0], [1.0, 1.0]]);
        assert_eq!(cubic.heading(0.0), Some(FRAC_PI_2));
        // This curve reverses.
        let back = Curve::Cubic([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.0]]);
        assert_eq!(back.headings([0.0, 1.0]), None);
    }
}
