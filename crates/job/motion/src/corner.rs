//! Speed around a blended corner.
//!
//! The parameter `s` of a blend of radius `r` between the directions `d1` and `d2` runs from 0 to `2 r`, with `q'(s) =
//! (1 - u) d1 + u d2`, `u = s / (2 r)`, and the constant `q'' = (d2 - d1) / (2 r)`. At both ends `|q'| = 1`, so on
//! entry and exit `s` is the distance along the legs. The blend is cut into spans of equal length, and on each the
//! second derivative of `s` by time is constant. So `z = (ds/dt)^2` is linear in `s`, and with the values `z0` and `z1`
//! at a span's ends (a point in the phase plane each):
//!
//! - A joint's acceleration `q'' z + q' z' / 2` is linear in `s`. It is within its limit if it is at both ends of the
//!   span.
//! - A joint's squared velocity `q'^2 z` is a cubic in `s`. It is within its limit if its Bernstein coefficients are.
//! - The tip's speed is within its limit if `z` is below a bound for the whole span. It is if it is at both ends.
//!
//! All these conditions are linear in `z0` and `z1`. On each span, `q(t)` is a polynomial of degree four.

use super::clock::reserve;
use super::limits::{Axes, LimitedAxis, Limits};
use super::profile::{Phase, State};
use super::sample::{MIN_INTERVAL, MIN_PERIODIC_INTERVAL};
use super::tip::{Part, TIP_SPEED_STEP};
use crate::BLEND_TOLERANCE;

/// Number of spans into which a blend is cut initially.
const INITIAL_SPANS: usize = 8;

/// Number of spans of a straight stretch that may begin or end at rest.
const INITIAL_LINE_SPANS: usize = 32;

/// Largest number of spans into which a blend is cut for accuracy.
const MAX_SPANS: usize = 256;

/// Number of parts into which each span is cut when more spans are tried for a faster motion.
const PARTS_PER_SPAN: usize = 4;

/// Largest number of spans when more spans are tried for a faster motion.
const MAX_TRIED_SPANS: usize = 1024;

/// Greatest change of a joint's acceleration over a span, as a share of its limit. If the change is greater, the span
/// is cut further. If the limit is reached at one end of a span, half of the change is lost.
const MAX_ACCELERATION_STEP: f64 = 0.1;

/// Greatest change of the speed over a span, as a share of the speed. If the change is greater, the span is cut
/// further. If acceleration turns into deceleration within a span, half of the change is lost.
const MAX_SPEED_STEP: f64 = 0.1;

/// Fraction of the limits that stays unused on a blend. Many controllers use cubics through the positions and
/// velocities of samples; because of this fraction, the cubics are also within the limits. [`reserve`] adds a little.
const LIMIT_RESERVE: f64 = 1e-3;

/// Greatest deviation of a wrist's joint from a blend's parabola, radians. It is far below the tolerance of a tool's angle.
const WRIST_TOLERANCE: f64 = 1e-6;

/// Largest number of spans if torques are limited.
const MAX_TORQUE_SPANS: usize = 1024;

/// A blend, cut into spans for its timing. A straight stretch along which limits vary is treated in the same manner, as
/// a blend whose two directions are equal.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Corner {
    /// The blend's beginning, corner and end.
    points: [Axes; 3],
    radius: f64,
    /// Derivatives by the parameter at both ends.
    directions: [Axes; 2],
    spans: usize,
    /// Upper bound on the speed of the parameter.
    fastest: f64,
    /// Speed at which the blend is passed, as a share of the speed that the limits allow.
    share: f64,
    /// Share of the tip's speed limit that applies.
    tip_share: f64,
}

/// Returns the least duration, seconds, of a blend that is cut into this many spans. Each span must last at least the
/// least interval between samples, although some spans are passed several times as fast as others.
fn shortest(spans: usize) -> f64 {
    8.0 * MIN_INTERVAL * spans as f64
}

impl Corner {
    /// Prepares a blend. Returns `None` if it is so small that it would be passed in little more than the interval
    /// between samples.
    pub(super) fn new(points: [Axes; 3], limits: &Limits, share: f64) -> Option<Self> {
        let limits = &limits.scaled(share);
        let legs = [points[1] - points[0], points[2] - points[1]];
        let radius = legs[0].xy().norm();
        let directions = legs.map(|leg| (leg.xy() / leg[0].hypot(leg[1])).push(leg[2] / radius));
        let (spans, fastest) = (INITIAL_SPANS, f64::INFINITY);
        let corner = Self { points, radius, directions, spans, fastest, share, tip_share: 1.0 };
        let turning = limits.acceleration_along(corner.second_derivative()).sqrt();
        let fastest = directions.map(|d| limits.speed_along(d)).into_iter().fold(turning, f64::min);
        (corner.length() / fastest >= shortest(INITIAL_SPANS)).then_some(Self { fastest, ..corner })
    }

    /// Prepares a straight stretch. Returns `None` if it is too small.
    pub(super) fn straight(from: Axes, to: Axes, limits: &Limits) -> Option<Self> {
        let (points, offset) = ([from, (from + to) / 2.0, to], to - from);
        let length = offset[0].hypot(offset[1]);
        let directions = [offset / length; 2];
        let fastest = limits.speed_along(directions[0]);
        let (radius, spans) = (length / 2.0, INITIAL_LINE_SPANS);
        let corner = Self { points, radius, directions, spans, fastest, share: 1.0, tip_share: 1.0 };
        (length / fastest >= shortest(INITIAL_LINE_SPANS)).then_some(corner)
    }

    /// Returns the corner with a share of the tip's speed limit.
    pub(super) fn with_tip_share(self, tip_share: f64) -> Self {
        Self { tip_share, ..self }
    }

    /// Returns the share of the limits that stays unused.
    fn reserve(&self) -> f64 {
        let span = self.length() / self.spans as f64 / self.fastest;
        LIMIT_RESERVE + reserve(span.clamp(MIN_INTERVAL, MIN_PERIODIC_INTERVAL))
    }

    /// Returns the corner with twice as many spans. Returns `None` if its spans are fine enough for these squared
    /// speeds at their ends, or cannot be cut.
    pub(super) fn finer(&self, squared_speeds: &[f64], limits: &Limits) -> Option<Self> {
        let (bend, limits) = (self.second_derivative(), &limits.with_tip_share(self.tip_share));
        let coarse = squared_speeds.windows(2).enumerate().any(|(i, z)| {
            let step = (z[1] - z[0]).abs();
            // With a constant second derivative of the parameter, q'' z + q' z' / 2 changes by three halves of q''
            // times the change of z.
            let changes = |axis: LimitedAxis| 1.5 * axis.component(bend).abs() * step;
            limits.axes().any(|axis| changes(axis) > MAX_ACCELERATION_STEP * axis.acceleration)
                || (!self.is_straight() && step > 2.0 * MAX_SPEED_STEP * z[0].max(z[1]))
                || limits
                    .tip
                    .is_some_and(|tip| tip.slack(&self.part(i)) * z[0].max(z[1]).sqrt() > TIP_SPEED_STEP * tip.speed)
                || limits.torque.is_some_and(|torque| torque.is_coarse(&self.part(i), [z[0], z[1]]))
        });
        let most = if limits.torque.is_some() { MAX_TORQUE_SPANS } else { MAX_SPANS };
        if coarse { self.cut(2, most, squared_speeds) } else { None }
    }

    /// Returns the corner with several times as many spans, even if its spans are fine enough. Returns `None` if they
    /// cannot be cut.
    pub(super) fn much_finer(&self, squared_speeds: &[f64]) -> Option<Self> {
        self.cut(PARTS_PER_SPAN, MAX_TRIED_SPANS, squared_speeds)
    }

    /// Returns the corner with each span cut into `parts`. Returns `None` if there would be too many spans, or some
    /// would be too short.
    fn cut(&self, parts: usize, most: usize, squared_speeds: &[f64]) -> Option<Self> {
        let lasts: f64 = self.phases(squared_speeds).iter().map(|phase| phase.duration).sum();
        let finer = Self { spans: parts * self.spans, ..self.clone() };
        (finer.spans <= most && lasts >= shortest(finer.spans)).then_some(finer)
    }

    /// Returns true for a straight stretch.
    pub(super) fn is_straight(&self) -> bool {
        self.directions[0].xy() == self.directions[1].xy()
    }

    /// Returns the range of the parameter.
    pub(super) fn length(&self) -> f64 {
        2.0 * self.radius
    }

    fn second_derivative(&self) -> Axes {
        (self.directions[1] - self.directions[0]) / self.length()
    }

    fn first_derivative(&self, u: f64) -> Axes {
        self.directions[0] * (1.0 - u) + self.directions[1] * u
    }

    fn position(&self, u: f64) -> Axes {
        let mix = |a: Axes, b: Axes| a * (1.0 - u) + b * u;
        let [from, corner, to] = self.points;
        mix(mix(from, corner), mix(corner, to))
    }

    /// Returns a span as a part of a curve, for the limits on the tip and on torques.
    fn part(&self, span: usize) -> Part {
        let middle = (span as f64 + 0.5) / self.spans as f64;
        Part {
            middle: self.position(middle).xy(),
            slope: self.first_derivative(middle).xy(),
            bend: self.second_derivative().xy(),
            half: self.radius / self.spans as f64,
        }
    }

    /// Returns the conditions on the squared speeds at the ends of each span, in order.
    pub(super) fn bounds(&self, limits: &Limits) -> Vec<Bounds> {
        let limits = &limits.scaled(self.share).with_tip_share(self.tip_share);
        let step = self.length() / self.spans as f64;
        let (bend, share) = (self.second_derivative(), |i: usize| i as f64 / self.spans as f64);
        let left = 1.0 - self.reserve();
        let span = |i: usize| {
            let ends = [share(i), share(i + 1)].map(|u| self.first_derivative(u));
            let mut bounds = Bounds::default();
            for axis in limits.axes() {
                let ([p, q], bend) = (ends.map(|end| axis.component(end)), axis.component(bend));
                let (acceleration, velocity) = (left * axis.acceleration, (left * axis.velocity).powi(2));
                // q'' z + q' (z1 - z0) / (2 step) at the first end and at the second, in both directions.
                let [at_first, at_second] = [p, q].map(|slope| slope / (2.0 * step));
                for row in [[bend - at_first, at_first], [-at_second, bend + at_second]] {
                    let row = row.map(|c| c / acceleration);
                    bounds.extend([row, row.map(|c| -c)]);
                }
                let bernstein =
                    [[p * p, 0.0], [2.0 * p * q / 3.0, p * p / 3.0], [q * q / 3.0, 2.0 * p * q / 3.0], [0.0, q * q]];
                bounds.extend(bernstein.map(|row| row.map(|c| c / velocity)));
            }
            if let Some(tip) = limits.tip {
                let squared = (left * tip.speed_within_limit(&self.part(i))).powi(2);
                bounds.extend([[1.0 / squared, 0.0], [0.0, 1.0 / squared]]);
            }
            if let Some(torque) = limits.torque {
                bounds.extend(torque.rows(&self.part(i), left - LIMIT_RESERVE));
            }
            bounds
        };
        (0..self.spans).map(span).collect()
    }

    /// Returns the phases for squared speeds at the ends of all spans.
    pub(super) fn phases(&self, squared_speeds: &[f64]) -> Vec<Phase> {
        let position = |i: usize| self.length() * (i as f64 / self.spans as f64);
        let phase =
            |(i, z): (usize, &[f64])| Phase::between([position(i), position(i + 1)], [z[0].sqrt(), z[1].sqrt()]);
        squared_speeds.windows(2).enumerate().map(phase).collect()
    }

    /// Returns the longest interval between samples in a phase for which cubics are good enough. The cubic through
    /// positions and velocities must be within the limits, and within [`BLEND_TOLERANCE`] of the blend.
    ///
    /// For a motion with a constant fourth derivative `d`, the error of the cubic is at most `d h^4 / 384` in position,
    /// `d h^3 / (72 sqrt 3)` in velocity and `d h^2 / 12` in acceleration. If `a` is the second derivative of the
    /// parameter, `d = 3 q'' a^2`.
    pub(super) fn interval(&self, phase: &Phase, limits: &Limits) -> f64 {
        let bend = self.second_derivative();
        let torque = limits.torque.map_or([f64::INFINITY; 2], |torque| torque.accelerations());
        let longest = |axis: LimitedAxis| {
            let is_wrist = axis.joint() == Some(2);
            let off = if is_wrist { WRIST_TOLERANCE } else { BLEND_TOLERANCE * self.radius };
            let torque = axis.joint().and_then(|k| torque.get(k)).copied().unwrap_or(f64::INFINITY);
            let fourth = 3.0 * axis.component(bend).abs() * phase.acceleration * phase.acceleration;
            let acceleration = (12.0 * LIMIT_RESERVE * axis.acceleration.min(torque) / fourth).sqrt();
            let velocity = (72.0 * 3f64.sqrt() * LIMIT_RESERVE * axis.velocity / fourth).cbrt();
            let position = (384.0 * off / fourth).sqrt().sqrt();
            acceleration.min(velocity).min(position)
        };
        limits.axes().map(longest).fold(f64::INFINITY, f64::min).max(2.0 * MIN_INTERVAL)
    }

    /// Returns position, velocity and acceleration of all axes in a state.
    pub(super) fn at(&self, state: State) -> [Axes; 3] {
        let State { distance, speed, acceleration } = state;
        let u = (distance / self.length()).clamp(0.0, 1.0);
        let along = self.first_derivative(u);
        let [from, corner, to] = self.points;
        // Rounding must not carry a sample beyond the corner, which may lie on a joint limit.
        let position = self.position(u).zip_zip_map(
            &from.inf(&corner).inf(&to),
            &from.sup(&corner).sup(&to),
            |value, least, greatest| value.clamp(least, greatest),
        );
        [position, along * speed, self.second_derivative() * (speed * speed) + along * acceleration]
    }
}

/// The feasible squared speeds `z0` and `z1` at the ends of a span: neither is negative, and `a z0 + b z1 <= 1` for
/// each row `[a, b]`. This set is convex. It contains all small `z0` and `z1`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Bounds {
    /// Greatest `z0` that the rows without a `z1` allow.
    most: f64,
    /// Upper bounds on `z1`, one for each row that gives one: intercept and slope of `z1` over `z0`.
    above: Vec<[f64; 2]>,
    /// Lower bounds on `z1`, one for each row that gives one: intercept and slope of `z1` over `z0`.
    below: Vec<[f64; 2]>,
}

/// Relative rounding error that is assumed for coefficients and squared speeds. It is far greater than that of doubles,
/// and far less than [`LIMIT_RESERVE`].
const ROUNDING: f64 = 1e-12;

impl Default for Bounds {
    fn default() -> Self {
        // Number of rows of a span without torques.
        let [above, below] = [0, 1].map(|_| Vec::with_capacity(8));
        Self { most: f64::MAX, above, below }
    }
}

impl Extend<[f64; 2]> for Bounds {
    fn extend<T: IntoIterator<Item = [f64; 2]>>(&mut self, rows: T) {
        for [a, b] in rows {
            let line = [1.0 / b, -a / b];
            // If the second coefficient is only rounding, ignore it: dividing by it would give a meaningless result.
            if b.abs() <= ROUNDING * a.abs() {
                self.most = if a > 0.0 { self.most.min(1.0 / a) } else { self.most };
            } else if b > 0.0 {
                self.above.push(line);
            } else {
                self.below.push(line);
            }
        }
    }
}

impl Bounds {
    /// Returns the greatest `z1` up to `most` for a feasible `z0`.
    pub(super) fn greatest_end(&self, z0: f64, most: f64) -> f64 {
        self.upper(z0, most).0.max(0.0)
    }

    /// Returns the greatest `z0` for which a `z1` up to `most` exists.
    ///
    /// The difference between the greatest and the least `z1` is a concave, piecewise linear function of `z0`, and not
    /// negative at 0. Newton's method from above ends at the root of this function, after at most as many steps as
    /// there are pairs of rows. The result is lowered by more than the rounding, so that [`Bounds::greatest_end`] finds a
    /// feasible
    /// `z1`.
    pub(super) fn greatest_start(&self, most: f64) -> f64 {
        let mut z0 = self.most;
        for _ in 0..=(self.above.len() + 1) * (self.below.len() + 1) {
            let (upper, lower) = (self.upper(z0, most), self.lower(z0));
            let (room, slope) = (upper.0 - lower.0, upper.1 - lower.1);
            let next = z0 - room / slope;
            // Rounding also ends the iteration.
            if room >= 0.0 || next.is_nan() || next >= z0 {
                break;
            }
            z0 = next.max(0.0);
        }
        z0 * (1.0 - ROUNDING)
    }

    /// Returns the greatest `z1` for a `z0`, and its slope.
    fn upper(&self, z0: f64, most: f64) -> (f64, f64) {
        let lines = self.above.iter().map(|[at_zero, slope]| (at_zero + slope * z0, *slope));
        lines.fold((most, 0.0), |best, line| if line.0 < best.0 { line } else { best })
    }

    /// Returns the least `z1` for a `z0`, and its slope.
    fn lower(&self, z0: f64) -> (f64, f64) {
        let lines = self.below.iter().map(|[at_zero, slope]| (at_zero + slope * z0, *slope));
        lines.fold((0.0, 0.0), |best, line| if line.0 > best.0 { line } else { best })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        /// Compares the bounds with the vertices of the polygon, found by brute force.
        #[test]
        fn bounds_of_a_corner_agree_with_the_feasible_polygon(
            rows in prop::collection::vec(prop::array::uniform2(prop_oneof![Just(0.0), -3.0..3.0_f64]), 1..9),
            caps in (0.1..5.0_f64, 0.1..5.0_f64), most in 0.0..4.0_f64, share in 0.0..1.0_f64,
        ) {
            let mut rows = rows;
            rows.extend([[1.0 / caps.0, 0.0], [0.0, 1.0 / caps.1]]);
            let mut bounds = Bounds::default();
            bounds.extend(rows.iter().copied());
            // All lines as a z0 + b z1 = c.
            let mut lines: Vec<[f64; 3]> = rows.iter().map(|[a, b]| [*a, *b, 1.0]).collect();
            lines.extend([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, most]]);
            let inside = |z0: f64, z1: f64| {
                z0 >= -1e-9 && (-1e-9..=most + 1e-9).contains(&z1)
                    && rows.iter().all(|[a, b]| a * z0 + b * z1 <= 1.0 + 1e-9)
            };
            let mut greatest = 0.0_f64;
            for (i, [a, b, c]) in lines.iter().enumerate() {
                for [d, e, f] in &lines[..i] {
                    let determinant = a * e - b * d;
                    let (z0, z1) = ((c * e - b * f) / determinant, (a * f - c * d) / determinant);
                    if determinant.abs() > 1e-12 && inside(z0, z1) {
                        greatest = greatest.max(z0);
                    }
                }
            }
            let back = bounds.greatest_start(most);
            prop_assert!((back - greatest).abs() < 1e-6 * (1.0 + greatest), "{back} {greatest}");
            let z0 = back * share;
            let z1 = bounds.greatest_end(z0, most);
            prop_assert!(inside(z0, z1) && (z1 + 1e-6 > most || !inside(z0, z1 + 1e-6)), "{z0} {z1}");
        }
    }
}
