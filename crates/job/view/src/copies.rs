//! Copies of shapes and paths by whole turns, cut to the visible part of joint space.

use super::axes::{Range, span};
use cplan_model::space::Configuration;
use std::f64::consts::TAU;

/// Largest number of copies. With more, a turn would be narrower than half a pixel of a panel, which is some 500 pixels wide.
const MAX_COPIES: f64 = 1000.0;

/// The visible part of joint space. Along some axes, the drawing repeats with each turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Lower and upper value of each axis.
    pub ranges: [Range; 2],
    /// For each axis, true if values that differ by whole turns look alike.
    pub repeats: [bool; 2],
}

impl Window {
    /// Returns all shifts by whole turns after which the box around `points` overlaps the window.
    pub fn shifts(&self, points: &[Configuration]) -> Vec<Configuration> {
        let [first, second] = [0, 1].map(|k| self.shifts_along(k, span(points.iter().map(|p| p[k]))));
        first.iter().flat_map(|&a| second.iter().map(move |&b| Configuration::new(a, b))).collect()
    }

    fn shifts_along(&self, axis: usize, (lower, upper): Range) -> Vec<f64> {
        let window = self.ranges[axis];
        if !(lower.is_finite() && upper.is_finite()) {
            return Vec::new();
        }
        if !self.repeats[axis] {
            return if lower <= window.1 && window.0 <= upper { vec![0.0] } else { Vec::new() };
        }
        let first = ((window.0 - upper) / TAU).ceil();
        let last = ((window.1 - lower) / TAU).floor();
        let count = (last - first).clamp(-1.0, MAX_COPIES) as i64;
        (0..=count).map(|k| (first + k as f64) * TAU).collect()
    }

    /// Returns the polyline and its copies, cut at the sides of the window. `O(copies * corners)`.
    pub fn pieces(&self, polyline: &[Configuration]) -> Vec<Vec<Configuration>> {
        let mut all = Vec::new();
        for shift in self.shifts(polyline) {
            let mut piece: Vec<Configuration> = Vec::new();
            for pair in polyline.windows(2) {
                let (a, b) = (pair[0] + shift, pair[1] + shift);
                let Some((from, to)) = self.parameters_within(a, b) else {
                    finish(&mut piece, &mut all);
                    continue;
                };
                if from > 0.0 {
                    finish(&mut piece, &mut all);
                }
                if piece.is_empty() {
                    piece.push(self.clamp(a + (b - a) * from));
                }
                piece.push(self.clamp(a + (b - a) * to));
                if to < 1.0 {
                    finish(&mut piece, &mut all);
                }
            }
            finish(&mut piece, &mut all);
        }
        all
    }

    /// Returns the parameters between which the segment lies within the window (Liang and Barsky 1984).
    fn parameters_within(&self, a: Configuration, b: Configuration) -> Option<(f64, f64)> {
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for k in 0..2 {
            let (lower, upper) = self.ranges[k];
            let along = b[k] - a[k];
            if along == 0.0 {
                if a[k] < lower || a[k] > upper {
                    return None;
                }
                continue;
            }
            let (s, t) = ((lower - a[k]) / along, (upper - a[k]) / along);
            from = from.max(s.min(t));
            to = to.min(s.max(t));
        }
        (from <= to).then_some((from, to))
    }

    /// Moves a configuration into the window if rounding left it slightly outside.
    fn clamp(&self, q: Configuration) -> Configuration {
        let [x, y] = self.ranges;
        Configuration::new(q[0].max(x.0).min(x.1), q[1].max(y.0).min(y.1))
    }
}

/// Adds a piece to `all`, unless it only touches the window in a point.
fn finish(piece: &mut Vec<Configuration>, all: &mut Vec<Vec<Configuration>>) {
    let piece = std::mem::take(piece);
    if piece.iter().any(|q| *q != piece[0]) {
        all.push(piece);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    const TORUS: Window = Window { ranges: [(-PI, PI); 2], repeats: [true; 2] };

    fn distance_to(piece: &[Configuration], q: Configuration) -> f64 {
        let one = |w: &[Configuration]| {
            let along = w[1] - w[0];
            let t = ((q - w[0]).dot(&along) / along.norm_squared().max(1e-300)).clamp(0.0, 1.0);
            (q - w[0] - along * t).norm()
        };
        piece.windows(2).map(one).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn a_path_around_the_torus_is_cut_at_both_seams() {
        let path = [Configuration::new(3.0, 3.0), Configuration::new(3.5, 3.4)];
        let pieces = TORUS.pieces(&path);
        assert_eq!(pieces.len(), 3, "{pieces:?}");
    }

    #[test]
    fn an_interval_of_three_turns_shows_three_copies() {
        let window = Window { ranges: [(-3.0 * PI, 3.0 * PI), (0.0, 1.0)], repeats: [true, false] };
        let inside = [Configuration::new(0.1, 0.2), Configuration::new(0.5, 0.8)];
        assert_eq!(window.shifts(&inside).len(), 3);
        let above = [Configuration::new(0.1, 1.2), Configuration::new(0.5, 1.8)];
        assert!(window.shifts(&above).is_empty());
    }

    #[test]
    fn points_and_touches_leave_no_piece() {
        assert!(TORUS.pieces(&[Configuration::new(1.0, 1.0)]).is_empty());
        let window = Window { ranges: [(0.0, 1.0); 2], repeats: [false; 2] };
        let corner = [Configuration::new(-1.0, 1.0), Configuration::new(1.0, -1.0)];
        assert!(window.pieces(&corner).is_empty());
        assert!(window.pieces(&[]).is_empty());
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(200))]

        /// Checks that the pieces form the wrapped path: walks along the path, wraps every point, and seeks it in the pieces. The
        /// lengths are equal as well, so the pieces contain nothing else.
        #[test]
        fn pieces_are_the_wrapped_path(
            corners in prop::collection::vec((-12.0..12.0f64, -12.0..12.0f64), 2..8),
            repeats in any::<(bool, bool)>(),
        ) {
            let window = Window { repeats: [repeats.0, repeats.1], ..TORUS };
            let path: Vec<Configuration> = corners.iter().map(|c| Configuration::new(c.0, c.1)).collect();
            let pieces = window.pieces(&path);
            for q in pieces.iter().flatten() {
                prop_assert!((0..2).all(|k| (-PI..=PI).contains(&q[k])), "{q:?} lies outside");
            }
            let (mut length, n) = (0.0, 400);
            for w in path.windows(2) {
                for i in 0..n {
                    let q = w[0] + (w[1] - w[0]) * ((f64::from(i) + 0.5) / f64::from(n));
                    let q = Configuration::from_fn(|k, _| {
                        if window.repeats[k] { (q[k] + PI).rem_euclid(TAU) - PI } else { q[k] }
                    });
                    if (0..2).all(|k| (-PI..=PI).contains(&q[k])) {
                        length += (w[1] - w[0]).norm() / f64::from(n);
                        let nearest = pieces.iter().map(|p| distance_to(p, q)).fold(f64::INFINITY, f64::min);
                        prop_assert!(nearest < 1e-9, "{q:?} is missing by {nearest}");
                    }
                }
            }
            let drawn: f64 = pieces.iter().flat_map(|p| p.windows(2)).map(|w| (w[1] - w[0]).norm()).sum();
            let step: f64 = path.windows(2).map(|w| (w[1] - w[0]).norm() / f64::from(n)).fold(0.0, f64::max);
            // At each of the few crossings of a side, sampling is wrong by at most one step.
            prop_assert!((drawn - length).abs() <= 16.0 * path.len() as f64 * step, "{drawn} drawn of {length}");
        }
    }
}
