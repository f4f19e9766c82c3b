//! Strokes and turns that overlap with motions of the arm. The height of the tool, or the angle of the carried object,
//! is a function of time.

use crate::robot::tool::LiftAxis;
use cplan_check::CheckError;
use cplan_check::decimal::Decimal;
use cplan_check::interval::Interval;
use num_bigint::{BigInt, Sign};

/// Number of decimals of the tolerance of heights in strokes and of angles in turns: `10^-9` m or radians, for rounding in
/// certificates.
const HEIGHT_TOLERANCE_DECIMALS: u32 = 9;

/// Number of decimals of the greatest distance that a stroke may reverse: `10^-12` m or radians, for rounding in
/// certificates. With constant jerk from rest, the control point in the middle of the velocity is 0.
const ROUNDING_DECIMALS: u32 = 12;

/// A stroke: the tool's height as cubic curves that never reverse. Heights are relative to the raised tool. In a turn,
/// angles replace heights.
pub(super) struct StrokeCurve {
    /// Times of the knots, seconds after the start of the motion.
    times: Vec<Decimal>,
    heights: Vec<Interval>,
    /// Velocities along the plane's normal, or angular velocities.
    rates: Vec<Interval>,
}

fn tolerance() -> BigInt {
    Interval::from(&Decimal::power_of_ten(HEIGHT_TOLERANCE_DECIMALS)).lower
}

/// Returns true if two heights differ by no more than the tolerance.
fn are_equal(a: &Interval, b: &Interval) -> bool {
    (a - b).magnitude() <= tolerance()
}

impl StrokeCurve {
    /// Makes a stroke from its knots. At the start of the motion, their clock shows `start`. `ends` are the heights at
    /// which the stroke must begin and end.
    ///
    /// # Errors
    /// If times do not increase, if the stroke reverses by more than rounding or moves at an end, or if an end has the
    /// wrong height.
    pub(super) fn new(
        knots: &[[Decimal; 3]],
        start: &Decimal,
        axis: &LiftAxis,
        ends: [&Interval; 2],
    ) -> Result<Self, CheckError> {
        let curve = Self::of_knots(knots, start, |value| axis.height(value), |rate| axis.upward(rate))?;
        let [first, last] = ends;
        if !are_equal(&curve.heights[0], first) || !are_equal(&curve.heights[knots.len() - 1], last) {
            return CheckError::fails("the stroke does not lead from the raised to the lowered height, or back");
        }
        Ok(curve)
    }

    /// Makes a turn from its knots. At the start of the motion, their clock shows `start`. Angles are relative to the
    /// beginning of the turn, which must end at the angle `by`.
    ///
    /// # Errors
    /// Same as for [`StrokeCurve::new`].
    pub(super) fn turn(knots: &[[Decimal; 3]], start: &Decimal, by: &Decimal) -> Result<Self, CheckError> {
        let curve = Self::of_knots(knots, start, |angle| Interval::from(angle), |rate| rate.clone())?;
        let ends = [Interval::whole(0), Interval::from(by)];
        if !are_equal(&curve.heights[0], &ends[0]) || !are_equal(&curve.heights[knots.len() - 1], &ends[1]) {
            return CheckError::fails("the knots do not lead from 0 to the angle of the turn");
        }
        Ok(curve)
    }

    fn of_knots(
        knots: &[[Decimal; 3]],
        start: &Decimal,
        height: impl Fn(&Decimal) -> Interval,
        upward: impl Fn(&Interval) -> Interval,
    ) -> Result<Self, CheckError> {
        let [[_, first, v], .., [_, last, w]] = knots else {
            return CheckError::fails("there are fewer than two knots");
        };
        let along = last - first;
        if [v, w].iter().any(|rate| rate.sign() != Sign::NoSign) || along.sign() == Sign::NoSign {
            return CheckError::fails("the knots do not begin and end at rest, or both ends have the same value");
        }
        let goes_back = |rate: &Decimal| (rate * &along).sign() == Sign::Minus;
        let rounding = Decimal::power_of_ten(ROUNDING_DECIMALS);
        for (k, pair) in knots.windows(2).enumerate() {
            let [[from, p, v], [to, q, w]] = [&pair[0], &pair[1]];
            let span = to - from;
            if span.sign() != Sign::Plus {
                return CheckError::fails(format!("the time of knot {} is not after that of the previous knot", k + 1));
            }
            // Control points of the cubic's derivative, times a positive number.
            let middle = &(&(q - p) * &Decimal::whole(3)) - &(&span * &(v + w));
            let is_rounding = middle < rounding && -&middle < rounding;
            if [v, w].into_iter().any(goes_back) || (goes_back(&middle) && !is_rounding) {
                return CheckError::fails(format!("the values turn back after knot {k}"));
            }
        }
        Ok(Self {
            times: knots.iter().map(|[time, ..]| time - start).collect(),
            heights: knots.iter().map(|[_, value, _]| height(value)).collect(),
            rates: knots.iter().map(|[.., rate]| upward(&Interval::from(rate))).collect(),
        })
    }

    pub(super) fn begin(&self) -> &Decimal {
        &self.times[0]
    }

    pub(super) fn end(&self) -> &Decimal {
        &self.times[self.times.len() - 1]
    }

    /// Returns the height at a time. Before and after the stroke, this is the height at its beginning and its end.
    fn height_at(&self, time: &Decimal) -> Interval {
        let next = self.times.partition_point(|knot| knot <= time);
        if next == 0 || next == self.times.len() {
            return self.heights[next.saturating_sub(1)].clone();
        }
        let [p, q] = [next - 1, next].map(|k| self.heights[k].clone());
        let span = Interval::from(&(&self.times[next] - &self.times[next - 1]));
        if span.lower.sign() != Sign::Plus {
            return Interval { lower: p.lower.min(q.lower), upper: p.upper.max(q.upper) };
        }
        let share = Interval::from(&(time - &self.times[next - 1])).divided(&span);
        let third = |k: usize| (&self.rates[k] * &span).over(3);
        let mut points = vec![p.clone(), &p + &third(next - 1), &q - &third(next), q];
        while points.len() > 1 {
            points = points.windows(2).map(|pair| &pair[0] + &(&(&pair[1] - &pair[0]) * &share)).collect();
        }
        points.remove(0)
    }

    /// Returns true if the tool is raised all the time from one time to another.
    pub(super) fn is_raised_during(&self, [from, to]: [&Decimal; 2]) -> bool {
        let [first, last] = [0, self.heights.len() - 1].map(|k| self.heights[k].magnitude());
        if first < last { to <= self.begin() } else { self.end() <= from }
    }

    /// Returns true if the height at a time is `height`, within the tolerance.
    pub(super) fn is_at(&self, time: &Decimal, height: &Interval) -> bool {
        are_equal(&self.height_at(time), height)
    }

    /// Returns true if the tool is at least `distance` from `height` at a time, within the tolerance.
    pub(super) fn is_away(&self, time: &Decimal, height: &Interval, distance: &Decimal) -> bool {
        (&self.height_at(time) - height).magnitude() + tolerance() >= Interval::from(distance).lower
    }

    /// Returns the least and the greatest height between two times. The stroke never reverses, so these are the heights
    /// at both times.
    pub(super) fn range(&self, times: [&Decimal; 2]) -> [Decimal; 2] {
        let [a, b] = times.map(|time| self.height_at(time));
        Interval { lower: a.lower.min(b.lower), upper: a.upper.max(b.upper) }.ends()
    }
}
