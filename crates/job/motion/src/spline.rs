//! Motions with continuous acceleration: uniform cubic B-splines.
//!
//! Let `x_j` be the configurations of a motion at the multiples of a step `h`, and `y_j` the mean of `n` consecutive ones. The
//! smoothed motion is the uniform cubic B-spline with the control points `y_j`. Its derivatives are weighted means of the
//! motion's derivatives, with non-negative weights that add up to 1. So it is within all limits on speed and acceleration that
//! the motion satisfies, and at any time in the convex hull of `(n + 3) h` seconds of the motion.
//!
//! Over each step, its jerk is constant: `(a_j - a_(j - n)) / (n h)`, where `a` are the second differences of `x`, divided by
//! `h^2`. So a window of `n h` seconds is long enough if the greatest jerk could cause the change of acceleration within it. (Box
//! filters in series are a known method for such trajectories: Biagiotti, Melchiorri, *FIR filters for online trajectory planning
//! with time- and frequency-domain specifications*, 2012.)
//!
//! The motion takes `(n + 1) h` longer, starts and ends at rest with zero acceleration, and moves along straight lines on
//! straight pieces.

use super::clock::{nanoseconds, seconds};
use super::limits::{LimitedAxis, Limits};
use super::retime::{CONDITION_POSITIONS, Condition, Rate};
use super::sample::{MIN_INTERVAL, MIN_PERIODIC_INTERVAL, Trajectory};
use super::schedule::{TimedTrack, duration, places};
use super::torque::TorqueLimit;
use cplan_handling::Piece;
use cplan_model::space::Configuration;

/// Number of time steps in a smoothing window. The motion takes one step longer than the window, so more and shorter steps make
/// it faster.
const STEPS_PER_WINDOW: f64 = 32.0;

/// Least duration of a step, as a share of the period of the samples.
const MIN_STEP_SHARE: f64 = 1.0 / 8.0;

/// Greatest number of steps of a motion.
const MAX_STEPS: f64 = 1e5;

/// Least number of intervals of a retimed motion. A motion with fewer steps gets several intervals per step.
const MIN_INTERVALS: usize = 800;

/// Greatest number of intervals of a motion that is retimed. Longer motions gain less and less.
const MAX_INTERVALS: usize = 20_000;

/// Retiming begins with this fraction of the original speed, at which all limits are satisfied with some slack.
const INITIAL_SPEED_SHARE: f64 = 0.97;

/// Number of steps of a retimed motion, unless other reasons require shorter or longer steps. The motion takes two steps longer.
const RETIMED_STEPS: f64 = 800.0;

/// Fraction of the limits on torques and on the tip's speed that a retimed motion uses. The rest covers excesses between the
/// positions at which the limits are imposed.
const USED_LIMIT_SHARE: f64 = 0.995;

/// A knot needs no sample if the jerk changes there by less than this fraction of the greatest jerk.
const JERK_TOLERANCE: f64 = 1e-7;

/// A motion from rest to rest, as a spline with knots at equal intervals of time.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Spline {
    /// Duration of a step between two knots, nanoseconds.
    step: u64,
    /// Number of steps of the smoothing window.
    window: u64,
    /// Control points. The first three are the start, and the last three the goal.
    control: Vec<Configuration>,
}

impl Spline {
    /// Creates a curve that passes a knot per second, from the first point to the last one, with zero velocity and acceleration
    /// at both ends. The other points are control points.
    pub fn of_curve(points: &[Configuration]) -> Self {
        Self::between(
            nanoseconds(1.0),
            points[0],
            points[1..points.len() - 1].iter().copied(),
            points[points.len() - 1],
        )
    }

    fn between(
        step: u64,
        start: Configuration,
        inner: impl Iterator<Item = Configuration>,
        goal: Configuration,
    ) -> Self {
        Self { step, window: 1, control: [start; 3].into_iter().chain(inner).chain([goal; 3]).collect() }
    }

    /// Smooths a run from rest to rest as far as the limits on jerks require. `acceleration` has the acceleration limits of the
    /// run.
    pub fn smoothed(run: &[TimedTrack], acceleration: [f64; 2], limits: &Limits, period: f64) -> Self {
        let longest = 2.0 * Limits { acceleration, ..*limits }.longest_growth();
        let fine = (longest / STEPS_PER_WINDOW).max(MIN_STEP_SHARE * period).max(MIN_INTERVAL);
        let step = nanoseconds(fine.max(duration(run) / MAX_STEPS));
        let places = places(run, seconds(step));
        let window = window(&places, seconds(step), limits);
        let [start, goal] = [places[0], places[places.len() - 1]];
        let place = |j: usize| places[j.min(places.len() - 1)];
        let mean = |j: usize| {
            // Offsets from one configuration ensure that a joint at rest stays at rest.
            let here = place(j);
            let ahead = (0..window).map(|i| if i <= j { place(j - i) } else { start } - here);
            here + ahead.fold(Configuration::zeros(), |sum, offset| sum + offset) / window as f64
        };
        let control = [start; 3].into_iter().chain((1..places.len() + window - 2).map(mean)).chain([goal; 3]).collect();
        Self { step, window: window as u64, control }
    }

    /// Returns the fastest motion along the same curve, and a function that converts seconds of the slower motion to nanoseconds
    /// of the new one. `None` if the new motion is not known to be faster.
    pub fn retimed(&self, limits: &Limits, period: f64) -> Option<(Self, impl Fn(f64) -> u64 + use<>)> {
        let pieces = self.last() + 1;
        let parts = ((MIN_INTERVALS + pieces / 2) / pieces).max(1);
        if parts * pieces > MAX_INTERVALS {
            return None;
        }
        let interval = seconds(self.step) / parts as f64;
        let asked = self.conditions(limits, parts);
        let rate = Rate::fastest(&asked, interval, INITIAL_SPEED_SHARE * INITIAL_SPEED_SHARE)?;
        let shortest = (MIN_STEP_SHARE * period).max(MIN_INTERVAL);
        let step = nanoseconds((rate.duration() / RETIMED_STEPS).min(seconds(self.step)).max(shortest));
        let spline = self.passed(&rate, step);
        // Between the positions of the conditions, limits may be exceeded slightly.
        let (slower, spline) = spline.slowed(spline.excess(limits));
        (spline.duration() < self.duration()).then(|| {
            let delay = spline.delay();
            (spline, move |time: f64| delay + nanoseconds(slower * rate.time_at(time)))
        })
    }

    /// Returns the conditions that the limits impose on the rate along the curve, with several intervals per piece.
    pub fn conditions(&self, limits: &Limits, parts: usize) -> Vec<Vec<Condition>> {
        (0..parts * (self.last() + 1))
            .flat_map(|i| CONDITION_POSITIONS.map(|u| (i / parts, ((i % parts) as f64 + u) / parts as f64)))
            .map(|(piece, u)| conditions_at(self.derivatives_within(piece, u), limits))
            .collect()
    }

    /// Returns the motion along the curve at a rate, with knots at the multiples of a step in nanoseconds.
    pub fn passed(&self, rate: &Rate, step: u64) -> Self {
        let [start, goal] = [self.control[0], self.control[self.control.len() - 1]];
        let times = (1..).map(|k| seconds(k * step)).take_while(|time| *time < rate.duration());
        Self::between(step, start, times.map(|time| self.at_seconds(rate.at(time))[0]), goal)
    }

    /// Returns the motion slowed down by at least a factor, and the factor that is used.
    pub fn slowed(&self, factor: f64) -> (f64, Self) {
        let step = (self.step as f64 * factor).ceil() as u64;
        (step as f64 / self.step as f64, Self { step, ..self.clone() })
    }

    /// Returns the curve as one cubic per piece.
    pub fn pieces(&self) -> Vec<Piece> {
        let end = |k: usize| {
            let [position, velocity, ..] =
                self.derivatives_within(k.min(self.last()), if k > self.last() { 1.0 } else { 0.0 });
            [position, velocity]
        };
        let time = |k: usize| seconds(k as u64 * self.step);
        (0..=self.last()).map(|k| Piece::hermite(time(k), time(k + 1), end(k), end(k + 1))).collect()
    }

    /// Returns the factor by which the motion must be slowed down to satisfy the limits on velocities, accelerations and jerks; 1
    /// if it satisfies them.
    pub fn excess(&self, limits: &Limits) -> f64 {
        let h = seconds(self.step);
        let mut excess = 1.0_f64;
        for four in self.control.windows(4) {
            let [a, b, c, d] = [four[0], four[1], four[2], four[3]];
            let [first, second] = [(b - a) / h, (c - b * 2.0 + a) / (h * h)];
            let third = (d - c * 3.0 + b * 3.0 - a) / (h * h * h);
            for axis in limits.axes() {
                let [first, second, third] =
                    [first, second, third].map(|vector| axis.component(vector.push(0.0)).abs());
                let jerk = axis.jerk.map_or(0.0, |most| third / most);
                let acceleration = second / axis.acceleration;
                excess = excess.max(first / axis.velocity).max(acceleration.sqrt()).max(jerk.cbrt());
            }
        }
        excess
    }

    /// Returns the duration of the motion, nanoseconds.
    pub fn duration(&self) -> u64 {
        self.step * (self.control.len() - 3) as u64
    }

    /// Returns the nanoseconds by which the smoothed motion lags behind the original one, at times in the middle of the motion.
    pub fn delay(&self) -> u64 {
        self.step * (self.window + 1) / 2
    }

    /// Returns position, velocity, acceleration and jerk at the fraction `u` of a piece between knots.
    fn derivatives_within(&self, piece: usize, u: f64) -> [Configuration; 4] {
        let h = seconds(self.step);
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| self.control[piece + i]);
        let (ab, bc, cd, w) = (b - a, c - b, d - c, 1.0 - u);
        let middle = 1.0 + 3.0 * u * (1.0 + u * w);
        // A rounding error must not move the position out of the hull of the control points, which may lie on a joint limit.
        let (least, greatest) = (a.inf(&b).inf(&c).inf(&d), a.sup(&b).sup(&c).sup(&d));
        let position =
            (b + (bc * middle + (bc + cd) * (u * u * u) - ab * (w * w * w)) / 6.0).sup(&least).inf(&greatest);
        let velocity = (ab * (w * w) + bc * (1.0 + 2.0 * u * w) + cd * (u * u)) / (2.0 * h);
        let acceleration = ((bc - ab) * w + (cd - bc) * u) / (h * h);
        [position, velocity, acceleration, (cd - bc * 2.0 + ab) / (h * h * h)]
    }

    /// Returns the index of the last piece.
    fn last(&self) -> usize {
        self.control.len() - 4
    }

    /// Returns position, velocity and acceleration this many nanoseconds after the beginning.
    fn at(&self, time: u64) -> [Configuration; 3] {
        let piece = ((time / self.step) as usize).min(self.last());
        let [position, velocity, acceleration, _] =
            self.derivatives_within(piece, (time - piece as u64 * self.step) as f64 / self.step as f64);
        [position, velocity, acceleration]
    }

    /// Returns position, velocity, acceleration and jerk this many seconds after the beginning.
    pub fn at_seconds(&self, time: f64) -> [Configuration; 4] {
        let steps = time / seconds(self.step);
        let piece = (steps as usize).min(self.last());
        self.derivatives_within(piece, steps - piece as f64)
    }

    /// Returns the nanoseconds at which the jerk changes, including the beginning.
    fn knots(&self) -> Vec<u64> {
        let third = |piece: usize| {
            let [a, b, c, d] = [0, 1, 2, 3].map(|i| self.control[piece + i]);
            (d - c) - (c - b) * 2.0 + (b - a)
        };
        let thirds: Vec<Configuration> = (0..self.control.len() - 3).map(third).collect();
        let least = thirds.iter().fold(Configuration::zeros(), |most, third| most.sup(&third.abs())) * JERK_TOLERANCE;
        let mut last = Configuration::repeat(f64::INFINITY);
        let mut knots = Vec::new();
        for (piece, third) in thirds.into_iter().enumerate() {
            let change = (third - last).abs();
            if change[0] > least[0] || change[1] > least[1] {
                knots.push(piece as u64 * self.step);
                last = third;
            }
        }
        knots
    }

    /// Appends the spline's samples, except the last one, to a trajectory that ends where the spline begins. There are samples
    /// wherever the jerk changes, and at each multiple of the period that is not close to one of them.
    pub fn sample(&self, begin: u64, period: f64, trajectory: &mut Trajectory) {
        let near = nanoseconds((period / 2.0).clamp(MIN_INTERVAL, MIN_PERIODIC_INTERVAL));
        let mut knots = self.knots();
        knots.push(self.duration());
        for pair in knots.windows(2) {
            let [first, last] = [begin + pair[0], begin + pair[1]];
            trajectory.push(first, self.at(pair[0]));
            let count = (seconds(first) / period) as u64;
            let multiples = (count..).map(|k| nanoseconds(k as f64 * period)).skip_while(|&at| at < first + near);
            for at in multiples.take_while(|&at| at + near <= last) {
                trajectory.push(at, self.at(at - begin));
            }
        }
    }
}

/// Returns the conditions that the limits impose on retiming, at a point of a motion with these derivatives.
fn conditions_at([position, velocity, acceleration, jerk]: [Configuration; 4], limits: &Limits) -> Vec<Condition> {
    let mut asked = Vec::new();
    let mut ask = |factors: [f64; 3], has_root: bool| {
        if factors != [0.0; 3] {
            asked.push(Condition { factors, has_root });
        }
    };
    for axis in limits.axes() {
        let [first, second, third] = [velocity, acceleration, jerk].map(|vector| axis.component(vector.push(0.0)));
        ask([(first / axis.velocity).powi(2), 0.0, 0.0], false);
        for sign in [1.0, -1.0] {
            ask([second, first / 2.0, 0.0].map(|factor| sign * factor / axis.acceleration), false);
            if let Some(most) = axis.jerk {
                ask([third, 1.5 * second, first / 2.0].map(|factor| sign * factor / most), true);
            }
        }
    }
    if let Some(tip) = limits.tip {
        let [first, second] = tip.arm.jacobian(1, tip.arm.tip, position);
        let speed = (first * velocity[0] + second * velocity[1]).norm();
        ask([(speed / (USED_LIMIT_SHARE * tip.speed)).powi(2), 0.0, 0.0], false);
    }
    if let Some(TorqueLimit { torques, share }) = limits.torque {
        let here = torques.at(position);
        let (inertial, bent) = (here.inertial(velocity), here.inertial(acceleration) + here.centrifugal(velocity));
        let holding = here.holding();
        for limited in torques.limited_torques() {
            let [inertial, bent, holding] = [inertial, bent, holding].map(|torques| limited.of(torques));
            for sign in [1.0, -1.0] {
                let room = share * (USED_LIMIT_SHARE * limited.effort - sign * holding);
                ask([bent, inertial / 2.0, 0.0].map(|factor| sign * factor / room), false);
            }
        }
    }
    asked
}

/// Returns the least number of consecutive positions whose means have jerks within their limits.
fn window(places: &[Configuration], step: f64, limits: &Limits) -> usize {
    let place = |j: isize| places[j.clamp(0, places.len() as isize - 1) as usize];
    let seconds: Vec<Configuration> =
        (0..places.len() as isize).map(|j| place(j + 1) - place(j) * 2.0 + place(j - 1)).collect();
    let along = |axis: &LimitedAxis, second: Configuration| axis.component(second.push(0.0)).abs();
    let limited = |axis: LimitedAxis| axis.jerk.map(|jerk| (axis, jerk * step * step * step));
    let thirds: Vec<(LimitedAxis, f64)> = limits.axes().filter_map(limited).collect();
    let enough = |(axis, third): &(LimitedAxis, f64)| {
        let most = seconds.iter().map(|second| along(axis, *second)).fold(0.0, f64::max);
        (2.0 * most / third).ceil()
    };
    let enough = thirds.iter().map(enough).fold(1.0, f64::max) as usize;
    let second = |j: usize| seconds.get(j).copied().unwrap_or_else(Configuration::zeros);
    let keeps = |n: &usize| {
        (0..seconds.len() + n).all(|j| {
            let change = second(j) - if j >= *n { second(j - n) } else { Configuration::zeros() };
            thirds.iter().all(|(axis, third)| along(axis, change) <= *n as f64 * third)
        })
    };
    (1..enough).find(keeps).unwrap_or(enough)
}

#[cfg(test)]
mod tests {
    use super::super::profile::rest_to_rest;
    use super::super::schedule::schedule;
    use super::*;
    use crate::BlendedPath;
    use cplan_model::space::Path;
    use proptest::prelude::*;

    fn limits(velocity: f64, acceleration: f64, jerk: [Option<f64>; 2]) -> Limits<'static> {
        Limits {
            velocity: [velocity; 2],
            acceleration: [acceleration; 2],
            jerk,
            tip: None,
            torque: None,
            wrist: None,
            sum: None,
        }
    }

    /// Returns the motion along a path with a blend at each corner, timed without limits on jerks and then smoothed.
    fn smoothed(corners: &[[f64; 2]], radius: f64, limits: &Limits) -> (f64, Spline) {
        let path = Path::new(corners.iter().map(|&q| q.into()).collect());
        let count = path.waypoints().len();
        let curve = (1..count - 1).fold(BlendedPath::from(path), |curve, w| curve.with(w, radius));
        let without = Limits { jerk: [None; 2], ..*limits };
        let (_, runs) = schedule(&curve, &without, &vec![1.0; count], 0.0);
        assert_eq!(runs.len(), 1, "it stops nowhere");
        (duration(&runs[0]), Spline::smoothed(&runs[0], limits.acceleration, limits, 0.01))
    }

    /// Smooths a motion from rest to rest along one joint, with a window long enough for its reversal. The result takes a window
    /// and a step longer.
    #[test]
    fn smoothing_takes_a_window_and_a_step_longer() {
        let limits = limits(2.0, 8.0, [Some(200.0), None]);
        let (base, spline) = smoothed(&[[0.0, 0.0], [0.3, 0.0], [0.7, 0.0]], 0.1, &limits);
        let expected: f64 = rest_to_rest(0.7, 2.0, 8.0, 1e-6).iter().map(|phase| phase.duration).sum();
        assert!((base - expected).abs() < 1e-2 * expected, "{base} {expected}");
        let longer = seconds(spline.duration()) - base;
        let (window, step) = (seconds(spline.window * spline.step), seconds(spline.step));
        assert!((window + step..window + 2.0 * step + 1e-9).contains(&longer), "{longer} {window} {step}");
        assert!(window <= 2.0 * 8.0 / 200.0 + 1e-9);
    }

    /// Smooths a long distance at top speed between full ramps. The least time is `L / v + v / a + a / j` in closed form,
    /// although the initial motion is slower by a window.
    #[test]
    fn the_least_time_along_a_line() {
        let limits = limits(1.0, 4.0, [Some(20.0), None]);
        let (_, slow) = smoothed(&[[0.0, 0.0], [0.5, 0.0], [1.0, 0.0]], 0.2, &limits);
        let (fast, _) = slow.retimed(&limits, 0.01).unwrap();
        let [least, took, before] = [1.0 + 1.0 / 4.0 + 4.0 / 20.0, seconds(fast.duration()), seconds(slow.duration())];
        assert!(least < took && took < 1.01 * least && 1.02 * least < before, "{least} {took} {before}");
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(64))]

        /// Checks smoothed motions by differences of their own samples: limits, rest at both ends, and joints that must not move.
        #[test]
        fn motions_from_rest_to_rest_satisfy_the_limits(
            turns in prop::collection::vec((0.4..1.5_f64, -2.5..2.5_f64), 2..6), velocity in 0.3..3.0_f64, acceleration in 1.0..20.0_f64,
            jerk in (20.0..2000.0_f64, prop::option::of(20.0..2000.0_f64)), second in any::<bool>(),
        ) {
            let mut corners = vec![[0.5, -0.25]];
            let mut heading = 0.3_f64;
            for (length, turn) in turns {
                let [x, y] = corners[corners.len() - 1];
                corners.push([x + length * heading.cos(), if second { y + length * heading.sin() } else { y }]);
                heading += if second { turn } else { 0.2 };
            }
            let limits = limits(velocity, acceleration, [Some(jerk.0), jerk.1]);
            let (base, slow) = smoothed(&corners, 0.1, &limits);
            prop_assert!(seconds(slow.duration()) > base);
            let fast = slow.retimed(&limits, 0.01);
            let [start, goal] = [corners[0], corners[corners.len() - 1]].map(Configuration::from);
            for spline in fast.iter().map(|(spline, _)| spline).chain([&slow]) {
                prop_assert_eq!(spline.at(0), [start, Configuration::zeros(), Configuration::zeros()]);
                // Where the run ends, up to rounding.
                let [end, rates @ ..] = spline.at(spline.duration());
                prop_assert!((end - goal).amax() < 1e-14 && rates == [Configuration::zeros(); 2], "{:?}", end);
                let h = seconds(spline.step);
                let mut before = spline.at(0);
                for knot in 1..=spline.duration() / spline.step {
                    let here = spline.at(knot * spline.step);
                    for k in 0..2 {
                        // Positions, velocities and accelerations are integrals of each other, and within their limits.
                        let rate = (here[2][k] - before[2][k]) / h;
                        prop_assert!(limits.jerk[k].is_none_or(|most| rate.abs() <= most * (1.0 + 1e-6)), "jerk {}", rate);
                        prop_assert!(here[2][k].abs() <= acceleration * (1.0 + 1e-9), "acceleration {}", here[2][k]);
                        prop_assert!(here[1][k].abs() <= velocity * (1.0 + 1e-9), "velocity {}", here[1][k]);
                        let speed = before[1][k] + h * (before[2][k] + here[2][k]) / 2.0;
                        prop_assert!((here[1][k] - speed).abs() < 1e-9);
                        let place = before[0][k] + h * (before[1][k] + h * (2.0 * before[2][k] + here[2][k]) / 6.0);
                        prop_assert!((here[0][k] - place).abs() < 1e-12);
                        if !second && k == 1 {
                            prop_assert_eq!([here[0][k], here[1][k], here[2][k]], [corners[0][1], 0.0, 0.0]);
                        }
                    }
                    before = here;
                }
            }
            // The faster motion takes the same route, and its conversion of times is correct.
            if let Some((fast, when)) = &fast {
                prop_assert!(fast.duration() < slow.duration());
                let [step, most] = [seconds(fast.step), velocity * 2.0];
                for k in 0..=50 {
                    let time = slow.duration() * k / 50;
                    let then = when(seconds(time)).min(fast.duration());
                    prop_assert!((fast.at(then)[0] - slow.at(time)[0]).amax() < 2.0 * step * most, "{}", seconds(time));
                }
            }
            let spline = fast.map_or(slow, |(spline, _)| spline);
            // The samples are the spline: cubics through them equal it everywhere.
            let mut trajectory = Trajectory::default();
            spline.sample(0, 0.01, &mut trajectory);
            trajectory.push(spline.duration(), [goal, Configuration::zeros(), Configuration::zeros()]);
            for piece in trajectory.pieces() {
                for u in [0.3, 0.5, 0.9] {
                    let [place, ..] = spline.at(nanoseconds(piece.time(u)));
                    prop_assert!((piece.at(u) - place).amax() < 1e-8);
                }
            }
        }
    }
}
