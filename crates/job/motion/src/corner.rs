//! Speed around a blended corner and along a curved leg.
//!
//! The parameter `s` of a blend of radius `r` between the directions `d1` and `d2` runs from 0 to `2 r`. With `u = s / (2 r)`,
//! `q'(s) = (1 - u) d1 + u d2`, and `q'' = (d2 - d1) / (2 r)` is constant. At both ends `|q'| = 1`, so `s` measures the distance
//! along the legs there. The blend is cut into spans of equal length. On each span, the second derivative of `s` by time is
//! constant, so `z = (ds/dt)^2` is linear in `s`, with the values `z0` and `z1` at the ends of the span. The limits then become:
//!
//! - A joint's acceleration `q'' z + q' z' / 2` is linear in `s`. It is within its limit if it is at both ends of the span.
//! - A joint's squared velocity `q'^2 z` is a cubic in `s`. It is within its limit if its Bernstein coefficients are.
//! - The tip's speed is within its limit if `z` is below a bound for the whole span, that is, at both ends.
//!
//! All these conditions are linear in `z0` and `z1`. On each span, `q(t)` is a polynomial of degree four.
//!
//! A curved leg is a cubic in `s`, with unit derivatives at both ends. There, a joint's acceleration is quadratic in `s`, and its
//! squared velocity has degree five, with more Bernstein coefficients. The bound on the tip's speed differs between the ends of a
//! span, so that `z` follows it without steps (`TipSpeed::rates`). On each span, `q(t)` is a polynomial of degree six. Samples
//! are so dense that cubics through them are within the limits and near the curve.

use super::bounds::Bounds;
use super::clock::reserve;
use super::limits::{Axes, LimitedAxis, Limits};
use super::profile::{Phase, State};
use super::sample::{MIN_INTERVAL, MIN_PERIODIC_INTERVAL};
use super::tip::{Part, TIP_SPEED_STEP};
use crate::BLEND_TOLERANCE;

/// Number of spans into which a blend is cut initially.
const INITIAL_SPANS: usize = 8;

/// Initial number of spans of a curved leg. A span bends by a few thousandths of a radian, so that constant second derivatives of
/// the parameter suit the geometry.
const INITIAL_LEG_SPANS: usize = 4;

/// Number of spans of a straight stretch that may begin or end at rest.
const INITIAL_LINE_SPANS: usize = 32;

/// Largest number of spans into which a blend is cut for accuracy.
const MAX_SPANS: usize = 256;

/// Number of parts into which each span is cut when more spans are tried for a faster motion.
const PARTS_PER_SPAN: usize = 4;

/// Largest number of spans when more spans are tried for a faster motion.
const MAX_TRIED_SPANS: usize = 1024;

/// Greatest change of a joint's acceleration over a span, as a share of its limit; spans with a greater change are cut. Where the
/// limit is reached at one end of a span, half of the change is lost.
const MAX_ACCELERATION_STEP: f64 = 0.1;

/// Greatest relative change of the speed over a span; spans with a greater change are cut. Where acceleration turns into
/// deceleration within a span, half of the change is lost.
const MAX_SPEED_STEP: f64 = 0.1;

/// Fraction of the limits that stays unused on a blend. With it, the cubics through positions and velocities of samples, which
/// many controllers use, are also within the limits. [`reserve`] adds a little.
const LIMIT_RESERVE: f64 = 1e-3;

/// Greatest deviation of a wrist's joint from a blend's parabola, radians. It is far below the tolerance of a tool's angle.
const WRIST_TOLERANCE: f64 = 1e-6;

/// Largest number of spans if torques are limited.
const MAX_TORQUE_SPANS: usize = 1024;

/// The control points of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape {
    /// A blend's beginning, corner and end.
    Blend([Axes; 3]),
    /// A curved leg.
    Leg([Axes; 4]),
}

/// A blend or a curved leg, cut into spans for its timing. A straight stretch with varying limits is treated like a blend with
/// two equal directions.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Corner {
    shape: Shape,
    /// Half the range of the parameter.
    radius: f64,
    /// Derivatives by the parameter at both ends.
    directions: [Axes; 2],
    /// On curved legs, four times the difference in the middle between the derivative and the mean of those at both ends; 0 on
    /// blends.
    swell: Axes,
    /// Number of spans of a blend, which are equally long.
    spans: usize,
    /// Shares of the range at the ends of the spans of a curved leg; empty on blends.
    places: Vec<f64>,
    /// Upper bound on the speed of the parameter.
    fastest: f64,
    /// Speed at which the blend is passed, as a share of the greatest possible speed.
    share: f64,
    /// Share of the tip's speed limit that applies.
    tip_share: f64,
}

/// Returns the least duration, seconds, of a blend with this number of spans. Each span must last at least the least interval
/// between samples, although the arm passes some spans several times as fast as others.
fn shortest(spans: usize) -> f64 {
    8.0 * MIN_INTERVAL * spans as f64
}

impl Corner {
    /// Prepares a blend. `None` if it is so small that passing it would take little more than the interval between samples.
    pub(super) fn new(points: [Axes; 3], limits: &Limits, share: f64) -> Option<Self> {
        let limits = &limits.scaled(share);
        let legs = [points[1] - points[0], points[2] - points[1]];
        let radius = legs[0].xy().norm();
        let directions = legs.map(|leg| (leg.xy() / leg[0].hypot(leg[1])).push(leg[2] / radius));
        let (spans, fastest, shape, swell) = (INITIAL_SPANS, f64::INFINITY, Shape::Blend(points), Axes::zeros());
        let places = Vec::new();
        let corner = Self { shape, radius, directions, swell, spans, places, fastest, share, tip_share: 1.0 };
        let turning = limits.acceleration_along(corner.second_derivative(0.5)).sqrt();
        let fastest = directions.map(|d| limits.speed_along(d)).into_iter().fold(turning, f64::min);
        (corner.length() / fastest >= shortest(INITIAL_SPANS)).then_some(Self { fastest, ..corner })
    }

    /// Prepares a straight stretch. `None` if it is too small.
    pub(super) fn straight(from: Axes, to: Axes, limits: &Limits) -> Option<Self> {
        let (points, offset) = ([from, (from + to) / 2.0, to], to - from);
        let length = offset[0].hypot(offset[1]);
        let directions = [offset / length; 2];
        let fastest = limits.speed_along(directions[0]);
        let (radius, spans, shape, swell) = (length / 2.0, INITIAL_LINE_SPANS, Shape::Blend(points), Axes::zeros());
        let places = Vec::new();
        let corner = Self { shape, radius, directions, swell, spans, places, fastest, share: 1.0, tip_share: 1.0 };
        (length / fastest >= shortest(INITIAL_LINE_SPANS)).then_some(corner)
    }

    /// Prepares a curved leg between two values of all axes, with these derivatives by the parameter at its ends. `None` if it is
    /// too small.
    pub(super) fn leg([from, to]: [Axes; 2], directions: [Axes; 2], length: f64, limits: &Limits) -> Option<Self> {
        let third = length / 3.0;
        let [second, last] = [from + directions[0] * third, to - directions[1] * third];
        let swell = (last - second) * (2.0 / third) - directions[0] - directions[1];
        let fastest = directions.map(|d| limits.speed_along(d)).into_iter().fold(f64::INFINITY, f64::min);
        let (radius, spans, shape) = (length / 2.0, INITIAL_LEG_SPANS, Shape::Leg([from, second, last, to]));
        let places = (0..=spans).map(|k| k as f64 / spans as f64).collect();
        let leg = Self { shape, radius, directions, swell, spans, places, fastest, share: 1.0, tip_share: 1.0 };
        (length / fastest >= shortest(INITIAL_LEG_SPANS)).then_some(leg)
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

    /// Doubles the number of spans, or, on a curved leg, halves the spans that are too coarse. Returns `None` if the spans are
    /// fine enough for these squared speeds at their ends, or cannot be cut.
    pub(super) fn finer(&self, squared_speeds: &[f64], limits: &Limits) -> Option<Self> {
        let limits = &limits.with_tip_share(self.tip_share);
        let is_coarse = |i: usize| {
            let z = [squared_speeds[i], squared_speeds[i + 1]];
            let (step, bends) = ((z[1] - z[0]).abs(), [i, i + 1].map(|k| self.second_derivative(self.share(k))));
            // If the second derivative of the parameter is constant, the change of q'' z + q' z' / 2 is the change of q'' z plus
            // half of q'' times the change of z.
            let changes = |axis: LimitedAxis| {
                let [first, last] = bends.map(|bend| axis.component(bend));
                (last * z[1] - first * z[0]).abs() + 0.5 * first.abs().max(last.abs()) * step
            };
            limits.axes().any(|axis| changes(axis) > MAX_ACCELERATION_STEP * axis.acceleration)
                || (step > 2.0 * MAX_SPEED_STEP * z[0].max(z[1])
                    && (self.is_blend() || (self.is_leg() && self.is_idle(i, z, limits))))
                || limits.tip.is_some_and(|tip| {
                    let part = self.part(i);
                    let slack = if self.is_leg() { tip.slack_of_rates(&part) } else { tip.slack(&part) };
                    slack * z[0].max(z[1]).sqrt() > TIP_SPEED_STEP * tip.speed
                })
                || limits.torque.is_some_and(|torque| torque.is_coarse(&self.part(i), [z[0], z[1]]))
        };
        let most = if limits.torque.is_some() { MAX_TORQUE_SPANS } else { MAX_SPANS };
        if !self.is_leg() {
            let is_any = (1..squared_speeds.len()).any(|end| is_coarse(end - 1));
            return is_any.then(|| self.cut(2, most, squared_speeds)).flatten();
        }
        let mut places = vec![0.0];
        for (i, phase) in self.phases(squared_speeds).iter().enumerate() {
            if phase.duration >= shortest(2) && is_coarse(i) {
                places.push((self.places[i] + self.places[i + 1]) / 2.0);
            }
            places.push(self.places[i + 1]);
        }
        (self.places.len() < places.len() && places.len() <= most).then(|| Self { places, ..self.clone() })
    }

    /// Returns true if no joint reaches almost its greatest acceleration at the ends of a span.
    fn is_idle(&self, span: usize, z: [f64; 2], limits: &Limits) -> bool {
        let rising = (z[1] - z[0]) / (2.0 * self.step(span));
        (0..2).all(|end| {
            let u = self.share(span + end);
            let acceleration = self.second_derivative(u) * z[end] + self.first_derivative(u) * rising;
            limits
                .axes()
                .all(|axis| axis.component(acceleration).abs() < (1.0 - MAX_ACCELERATION_STEP) * axis.acceleration)
        })
    }

    /// Cuts each span into several, even if spans are fine enough. `None` if they cannot be cut.
    pub(super) fn much_finer(&self, squared_speeds: &[f64]) -> Option<Self> {
        self.cut(PARTS_PER_SPAN, MAX_TRIED_SPANS, squared_speeds)
    }

    /// Cuts each span into `parts`. `None` if there would be too many spans, or if some would be too short.
    fn cut(&self, parts: usize, most: usize, squared_speeds: &[f64]) -> Option<Self> {
        let lasts: f64 = self.phases(squared_speeds).iter().map(|phase| phase.duration).sum();
        let finer = Self { spans: parts * self.spans, ..self.clone() };
        (finer.spans <= most && lasts >= shortest(finer.spans)).then_some(finer)
    }

    /// Returns true for a curved leg.
    pub(super) fn is_leg(&self) -> bool {
        matches!(self.shape, Shape::Leg(_))
    }

    /// Returns true for a blend at a waypoint.
    pub(super) fn is_blend(&self) -> bool {
        !self.is_leg() && self.directions[0].xy() != self.directions[1].xy()
    }

    /// Returns the range of the parameter.
    pub(super) fn length(&self) -> f64 {
        2.0 * self.radius
    }

    /// Returns the number of spans.
    fn count(&self) -> usize {
        if self.is_leg() { self.places.len() - 1 } else { self.spans }
    }

    /// Returns the share of the range before a span.
    fn share(&self, span: usize) -> f64 {
        if self.is_leg() { self.places[span] } else { span as f64 / self.spans as f64 }
    }

    /// Returns the range of the parameter on a span.
    fn step(&self, span: usize) -> f64 {
        if self.is_leg() {
            self.length() * (self.places[span + 1] - self.places[span])
        } else {
            self.length() / self.spans as f64
        }
    }

    fn third_derivative(&self) -> Axes {
        self.swell * (-2.0 / (self.length() * self.length()))
    }

    fn second_derivative(&self, u: f64) -> Axes {
        let change = self.directions[1] - self.directions[0];
        (if self.is_leg() { change + self.swell * (1.0 - 2.0 * u) } else { change }) / self.length()
    }

    fn first_derivative(&self, u: f64) -> Axes {
        let between = self.directions[0] * (1.0 - u) + self.directions[1] * u;
        if self.is_leg() { between + self.swell * (u * (1.0 - u)) } else { between }
    }

    fn position(&self, u: f64) -> Axes {
        let mix = |a: Axes, b: Axes| a * (1.0 - u) + b * u;
        let parabola = |[a, b, c]: [Axes; 3]| mix(mix(a, b), mix(b, c));
        match self.shape {
            Shape::Blend(points) => parabola(points),
            Shape::Leg([a, b, c, d]) => mix(parabola([a, b, c]), parabola([b, c, d])),
        }
    }

    /// Returns a span as a part of a curve, for the limits on the tip and on torques.
    fn part(&self, span: usize) -> Part {
        let middle = match self.shape {
            Shape::Blend(_) => (span as f64 + 0.5) / self.spans as f64,
            Shape::Leg(_) => (self.places[span] + self.places[span + 1]) / 2.0,
        };
        Part {
            middle: self.position(middle).xy(),
            slope: self.first_derivative(middle).xy(),
            bend: self.second_derivative(middle).xy(),
            third: self.third_derivative().xy(),
            half: self.step(span) / 2.0,
        }
    }

    /// Returns the conditions on the squared speeds at the ends of each span, in order.
    pub(super) fn bounds(&self, limits: &Limits) -> Vec<Bounds> {
        let limits = &limits.scaled(self.share).with_tip_share(self.tip_share);
        let left = 1.0 - self.reserve();
        let span = |i: usize| {
            let step = self.step(i);
            let shares = [i, i + 1].map(|k| self.share(k));
            let (ends, bends) = (shares.map(|u| self.first_derivative(u)), shares.map(|u| self.second_derivative(u)));
            let mut bounds = Bounds::default();
            for axis in limits.axes() {
                let ([p, q], [first, last]) =
                    (ends.map(|end| axis.component(end)), bends.map(|bend| axis.component(bend)));
                let (acceleration, velocity) = (left * axis.acceleration, (left * axis.velocity).powi(2));
                // q'' z + q' (z1 - z0) / (2 step) at both ends, in both directions.
                let [at_first, at_second] = [p, q].map(|slope| slope / (2.0 * step));
                let mut limit = |row: [f64; 2]| {
                    let row = row.map(|c| c / acceleration);
                    bounds.extend([row, row.map(|c| -c)]);
                };
                limit([first - at_first, at_first]);
                limit([-at_second, last + at_second]);
                if self.is_leg() {
                    // The middle Bernstein coefficient of q'.
                    let middle = p + first * step / 2.0;
                    let at_middle = middle / (2.0 * step);
                    limit([last / 2.0 - at_middle, first / 2.0 + at_middle]);
                    let squares = [p * p, p * middle, (2.0 * middle * middle + p * q) / 3.0, middle * q, q * q];
                    let square = |k: usize| squares.get(k).map_or(0.0, |square| square / (5.0 * velocity));
                    bounds.extend(
                        (0..6).map(|k: usize| {
                            [(5 - k) as f64 * square(k), k as f64 * k.checked_sub(1).map_or(0.0, square)]
                        }),
                    );
                    continue;
                }
                let bernstein =
                    [[p * p, 0.0], [2.0 * p * q / 3.0, p * p / 3.0], [q * q / 3.0, 2.0 * p * q / 3.0], [0.0, q * q]];
                bounds.extend(bernstein.map(|row| row.map(|c| c / velocity)));
            }
            if let Some(tip) = limits.tip {
                let squared = if self.is_leg() {
                    tip.rates(&self.part(i)).map(|rate| (left * tip.speed / rate).powi(2))
                } else {
                    [(left * tip.speed_within_limit(&self.part(i))).powi(2); 2]
                };
                bounds.extend([[1.0 / squared[0], 0.0], [0.0, 1.0 / squared[1]]]);
            }
            if let Some(torque) = limits.torque {
                bounds.extend(torque.rows(&self.part(i), left - LIMIT_RESERVE));
            }
            bounds
        };
        (0..self.count()).map(span).collect()
    }

    /// Returns the phases for squared speeds at the ends of all spans.
    pub(super) fn phases(&self, squared_speeds: &[f64]) -> Vec<Phase> {
        let position = |i: usize| self.length() * self.share(i);
        let phase =
            |(i, z): (usize, &[f64])| Phase::between([position(i), position(i + 1)], [z[0].sqrt(), z[1].sqrt()]);
        squared_speeds.windows(2).enumerate().map(phase).collect()
    }

    /// Returns the longest interval between samples in a phase for which the cubics through positions and velocities are within
    /// the limits, and within [`BLEND_TOLERANCE`] of the blend.
    ///
    /// For a motion with a constant fourth derivative `d`, the error of the cubic is at most `d h^4 / 384` in position,
    /// `d h^3 / (72 sqrt 3)` in velocity and `d h^2 / 12` in acceleration. If `v` and `a` are the first two derivatives of the
    /// parameter by time, `d = 3 q'' a^2 + 6 q^(3) v^2 a`.
    pub(super) fn interval(&self, phase: &Phase, limits: &Limits) -> f64 {
        let bend = self.second_derivative(0.0).abs().sup(&self.second_derivative(1.0).abs());
        let third = self.third_derivative().abs() * phase.enter.max(phase.leave).powi(2);
        let torque = limits.torque.map_or([f64::INFINITY; 2], |torque| torque.accelerations());
        let longest = |axis: LimitedAxis| {
            let is_wrist = axis.joint() == Some(2);
            let off = if is_wrist { WRIST_TOLERANCE } else { BLEND_TOLERANCE * self.radius };
            let torque = axis.joint().and_then(|k| torque.get(k)).copied().unwrap_or(f64::INFINITY);
            let of_third = axis.greatest(third) * phase.acceleration.abs();
            let fourth = 3.0 * axis.greatest(bend) * phase.acceleration * phase.acceleration + 6.0 * of_third;
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
        let points: &[Axes] = match &self.shape {
            Shape::Blend(points) => points,
            Shape::Leg(points) => points,
        };
        // A rounding error must not move a sample beyond the control points, which may lie on a joint limit.
        let (least, greatest) =
            points.iter().fold([points[0]; 2], |[least, greatest], p| [least.inf(p), greatest.sup(p)]).into();
        let position =
            self.position(u).zip_zip_map(&least, &greatest, |value, least, greatest| value.clamp(least, greatest));
        [position, along * speed, self.second_derivative(u) * (speed * speed) + along * acceleration]
    }
}
