//! Least-time parametrisation of a curve under limits that include jerks (third-order time-optimal path parametrisation).
//!
//! A curve `q(s)` is passed at the rate `ds/dt = z(s)^(1/2)`. With derivatives by `s`, velocities are `q' z^(1/2)`, accelerations
//! `q'' z + q' z' / 2`, and jerks `(q''' z + 3 q'' z' / 2 + q' z'' / 2) z^(1/2)`; the time is the integral of `z^(-1/2)`. `z` is
//! a uniform quadratic B-spline. At the [`CONDITION_POSITIONS`] of each interval, the limits are [`Condition`]s on `z`.
//!
//! A barrier method finds the coefficients of `z`: Newton steps minimise the time minus the weighted logarithms of the slacks,
//! with a decreasing weight. The second derivatives contain only the terms from first derivatives of the slacks, which are never
//! negative, and dominate where a slack is small. (As functions of the squared rate, only limits on jerks are not convex:
//! Verscheure, Demeulenaere, Swevers, De Schutter, Diehl, *Time-optimal path tracking for robots: a convex optimization
//! approach*, 2009.)

use cplan_interrupt::checkpoint;

/// Positions in each interval at which conditions are imposed.
pub(super) const CONDITION_POSITIONS: [f64; 3] = [0.0, 0.5, 1.0];

/// Weights of these positions in an integral (Simpson's rule).
const SIMPSON_WEIGHTS: [f64; 3] = [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0];

/// Initial weight of all barriers together, as a share of the duration. A barrier is a term that grows without bound as a
/// condition becomes tight.
const FIRST_BARRIER_WEIGHT: f64 = 0.1;

/// Final weight of all barriers together, as a share of the duration.
const LAST_BARRIER_WEIGHT: f64 = 1e-3;

/// Divisor of the barriers' weight after each round.
const BARRIER_REDUCTION: f64 = 6.0;

/// Greatest number of Newton steps for one weight.
const MAX_NEWTON_STEPS: usize = 40;

/// A round ends when the predicted gain of a step is below this share of the duration.
const MIN_ROUND_GAIN: f64 = 1e-5;

/// A step is halved until it achieves this fraction of the predicted decrease.
const MIN_STEP_GAIN: f64 = 0.05;
const MAX_STEP_HALVINGS: u32 = 20;

/// A search without a known rate begins with this share of the greatest constant squared rate.
const INITIAL_RATE_SHARE: f64 = 0.9;

/// Durations with at least this ratio count as the same, so that the weights of the barriers need no change.
const SHARE_OF_SAME_DURATION: f64 = 0.8;

/// A product of slacks outside this range is replaced by its logarithm, so that doubles neither overflow nor underflow.
const PRODUCT_RANGE: std::ops::Range<f64> = 1e-150..1e150;

/// Positions and weights of Gauss's quadrature with five points on the interval from 0 to 1.
const GAUSS_POINTS: [[f64; 2]; 5] = [
    [0.046_910_077_030_668_0, 0.118_463_442_528_094_5],
    [0.230_765_344_947_158_5, 0.239_314_335_249_683_2],
    [0.5, 0.284_444_444_444_444_4],
    [0.769_234_655_052_841_5, 0.239_314_335_249_683_2],
    [0.953_089_922_969_332, 0.118_463_442_528_094_5],
];

/// Number of Newton steps in the search for the parameter at a given time.
const NEWTON_STEPS_TO_PLACE: usize = 4;

/// A condition on the squared rate `z` at a position of the curve: `a z + b z' + c z'' < 1`, or the same with the sum multiplied
/// by the root of `z`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Condition {
    pub factors: [f64; 3],
    pub has_root: bool,
}

/// The squared rate at which the parameter of a curve increases, as a function of the parameter.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Rate {
    /// Length of an interval of the parameter.
    step: f64,
    coefficients: Vec<f64>,
    /// Times at which the intervals begin, and the end of the last one.
    times: Vec<f64>,
}

impl Condition {
    /// Returns the least upper bound on the constant squared rates that satisfy the condition.
    fn greatest_constant(&self) -> f64 {
        let most = 1.0 / self.factors[0].max(0.0);
        if self.has_root { most.powf(2.0 / 3.0) } else { most }
    }

    /// Returns the slack of the condition, and its derivatives by `z`, `z'` and `z''`.
    fn slack(&self, [z, rising, bend]: [f64; 3]) -> (f64, [f64; 3]) {
        let [a, b, c] = self.factors;
        let sum = a * z + b * rising + c * bend;
        if !self.has_root {
            return (1.0 - sum, [-a, -b, -c]);
        }
        let root = z.sqrt();
        (1.0 - root * sum, [-a * root - sum / (2.0 * root), -b * root, -c * root])
    }
}

/// Returns `z` and its two derivatives within an interval, as linear functions of the coefficients.
fn basis(u: f64, step: f64) -> [[f64; 3]; 3] {
    let w = 1.0 - u;
    let square = step * step;
    [
        [w * w / 2.0, 0.5 + u * w, u * u / 2.0],
        [-w / step, (w - u) / step, u / step],
        [1.0 / square, -2.0 / square, 1.0 / square],
    ]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A position of the curve, with its conditions.
struct Place<'a> {
    /// Index of the first of the three coefficients that matter at this position. The next field has their weights.
    first: usize,
    basis: &'a [[f64; 3]; 3],
    /// `z` and its derivatives.
    values: [f64; 3],
    /// Contribution of this position to the duration, seconds.
    time: f64,
    conditions: &'a [Condition],
}

/// The conditions at all positions, in order, and the weights of the coefficients there.
struct Problem<'a> {
    conditions: &'a [Vec<Condition>],
    step: f64,
    basis: [[[f64; 3]; 3]; CONDITION_POSITIONS.len()],
}

impl<'c> Problem<'c> {
    fn new(conditions: &'c [Vec<Condition>], step: f64) -> Self {
        Self { conditions, step, basis: CONDITION_POSITIONS.map(|u| basis(u, step)) }
    }

    /// Returns the duration.
    fn time(&self, coefficients: &[f64]) -> f64 {
        self.places(coefficients).map(|place| place.time).sum()
    }

    /// Returns better coefficients, while the weight of the barriers decreases from the first of `weights` to the last. Weights
    /// are those of all barriers together, in seconds. A step that gains less than `least_gain` seconds ends a round. Returns
    /// `None` if the given coefficients violate a condition.
    fn descended(&self, mut coefficients: Vec<f64>, weights: [f64; 2], least_gain: f64) -> Option<Vec<f64>> {
        let count: usize = self.conditions.iter().map(Vec::len).sum();
        let [mut height, last] = weights.map(|weight| weight / count as f64);
        if !self.merit(&coefficients, height).is_finite() {
            return None;
        }
        loop {
            let mut now = self.merit(&coefficients, height);
            for _ in 0..MAX_NEWTON_STEPS {
                checkpoint();
                let Some((step, promised)) = self.newton(&coefficients, height) else { break };
                if promised < least_gain {
                    break;
                }
                let mut shares = (0..MAX_STEP_HALVINGS).map(|n| 0.5_f64.powi(n as i32));
                let better = shares.find_map(|share| {
                    let moved: Vec<f64> = coefficients.iter().zip(&step).map(|(c, step)| c + share * step).collect();
                    let merit = self.merit(&moved, height);
                    (merit <= now - MIN_STEP_GAIN * share * promised).then_some((moved, merit))
                });
                let Some(better) = better else { break };
                (coefficients, now) = better;
            }
            if height <= last {
                return Some(coefficients);
            }
            height = (height / BARRIER_REDUCTION).max(last);
        }
    }

    /// Iterates over all positions, in order, for the given coefficients.
    fn places(&self, coefficients: &[f64]) -> impl Iterator<Item = Place<'_>> {
        self.conditions.iter().enumerate().map(move |(place, conditions)| {
            let (first, place) = (place / CONDITION_POSITIONS.len(), place % CONDITION_POSITIONS.len());
            let basis = &self.basis[place];
            let own = [0, 1, 2].map(|k| coefficients[first + k]);
            let values = basis.map(|row| dot(row, own));
            Place { first, basis, values, time: self.step * SIMPSON_WEIGHTS[place] / values[0].sqrt(), conditions }
        })
    }

    /// Returns the duration plus barriers of a given weight; infinite if a condition is violated.
    fn merit(&self, coefficients: &[f64], height: f64) -> f64 {
        // The logarithm of a product is faster than many logarithms.
        let (mut merit, mut product) = (0.0, 1.0_f64);
        for Place { values, time, conditions, .. } in self.places(coefficients) {
            if values[0].is_nan() || values[0] <= 0.0 {
                return f64::INFINITY;
            }
            merit += time;
            if !PRODUCT_RANGE.contains(&product) {
                (merit, product) = (merit - height * product.ln(), 1.0);
            }
            for condition in conditions {
                let (left, _) = condition.slack(values);
                if left.is_nan() || left <= 0.0 {
                    return f64::INFINITY;
                }
                product *= left;
            }
        }
        merit - height * product.ln()
    }

    /// Returns Newton's step and the predicted decrease.
    fn newton(&self, coefficients: &[f64], height: f64) -> Option<(Vec<f64>, f64)> {
        let count = coefficients.len();
        let (mut slope, mut bands) = (vec![0.0; count], vec![[0.0; 3]; count]);
        for Place { first, basis, values, time, conditions } in self.places(coefficients) {
            let z = values[0];
            let (mut gradient, mut second) = ([-time / (2.0 * z), 0.0, 0.0], [[0.0; 3]; 3]);
            second[0][0] = 0.75 * time / (z * z);
            for condition in conditions {
                let (left, change) = condition.slack(values);
                for r in 0..3 {
                    gradient[r] -= height * change[r] / left;
                    for s in 0..=r {
                        second[r][s] += height * (change[r] / left) * (change[s] / left);
                    }
                }
            }
            (second[0][1], second[0][2], second[1][2]) = (second[1][0], second[2][0], second[2][1]);
            let column = |k: usize| basis.map(|row| row[k]);
            for k in 0..3 {
                slope[first + k] += dot(gradient, column(k));
                let moved = second.map(|row| dot(row, column(k)));
                for m in k..3 {
                    bands[first + k][m - k] += dot(moved, column(m));
                }
            }
        }
        let step = solve_banded(bands, slope.iter().map(|slope| -slope).collect())?;
        let promised = -slope.iter().zip(&step).map(|(slope, step)| slope * step).sum::<f64>();
        Some((step, promised))
    }
}

/// Solves `A x = b` for a symmetric, positive definite `A` by a root-free Cholesky decomposition. `bands` has the entries of each
/// row from the diagonal on. Returns `None` if `A` is not positive definite.
fn solve_banded(mut bands: Vec<[f64; 3]>, mut x: Vec<f64>) -> Option<Vec<f64>> {
    let count = x.len();
    for i in 0..count {
        let [middle, one, two] = bands[i];
        if middle.is_nan() || middle <= 0.0 {
            return None;
        }
        let factors = [one / middle, two / middle];
        if i + 1 < count {
            bands[i + 1][0] -= factors[0] * one;
            bands[i + 1][1] -= factors[0] * two;
            x[i + 1] -= factors[0] * x[i];
        }
        if i + 2 < count {
            bands[i + 2][0] -= factors[1] * two;
            x[i + 2] -= factors[1] * x[i];
        }
        bands[i] = [middle, factors[0], factors[1]];
    }
    for i in (0..count).rev() {
        let [middle, one, two] = bands[i];
        let ahead = |k: usize| x.get(i + k).copied().unwrap_or(0.0);
        x[i] = x[i] / middle - one * ahead(1) - two * ahead(2);
    }
    Some(x)
}

impl Rate {
    /// Returns the rate with the shortest duration over intervals of this length, which satisfies the conditions at all
    /// positions. `begin` is a constant squared rate that satisfies them with some slack; otherwise returns `None`.
    pub fn fastest(conditions: &[Vec<Condition>], step: f64, begin: f64) -> Option<Self> {
        let problem = Problem::new(conditions, step);
        let coefficients = vec![begin; conditions.len() / CONDITION_POSITIONS.len() + 2];
        let time = problem.time(&coefficients);
        let weights = [FIRST_BARRIER_WEIGHT, LAST_BARRIER_WEIGHT].map(|share| share * time);
        Self::of_coefficients(step, problem.descended(coefficients, weights, MIN_ROUND_GAIN * time)?)
    }

    /// Does the same as [`Rate::fastest`] without a known rate to begin with. Begins with the greatest constant rate, which may
    /// be slower by orders of magnitude.
    pub fn fastest_of_all(conditions: &[Vec<Condition>], step: f64) -> Option<Self> {
        let problem = Problem::new(conditions, step);
        let greatest = conditions.iter().flatten().map(Condition::greatest_constant).fold(f64::INFINITY, f64::min);
        let begin = INITIAL_RATE_SHARE * greatest;
        let mut coefficients = vec![begin; conditions.len() / CONDITION_POSITIONS.len() + 2];
        let mut time = problem.time(&coefficients);
        if !(time.is_finite() && time > 0.0) {
            return None;
        }
        // The weights are shares of the duration, which is known only at the end.
        let mut first = FIRST_BARRIER_WEIGHT * time;
        loop {
            let weights = [first, LAST_BARRIER_WEIGHT * time];
            coefficients = problem.descended(coefficients, weights, MIN_ROUND_GAIN * time)?;
            let shorter = problem.time(&coefficients);
            if shorter > SHARE_OF_SAME_DURATION * time {
                return Self::of_coefficients(step, coefficients);
            }
            (first, time) = (weights[1] / BARRIER_REDUCTION, shorter);
        }
    }

    fn of_coefficients(step: f64, coefficients: Vec<f64>) -> Option<Self> {
        let mut rate = Self { step, coefficients, times: vec![0.0] };
        for interval in 0..rate.coefficients.len() - 2 {
            let until = rate.times[interval] + rate.time_within_interval(interval, 1.0);
            rate.times.push(until);
        }
        rate.duration().is_finite().then_some(rate)
    }

    /// Returns the duration of the whole curve.
    pub fn duration(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    fn squared(&self, interval: usize, u: f64) -> f64 {
        dot(basis(u, self.step)[0], [0, 1, 2].map(|k| self.coefficients[interval + k]))
    }

    /// Returns the time from the beginning of an interval to a position in it.
    fn time_within_interval(&self, interval: usize, u: f64) -> f64 {
        let inverse = GAUSS_POINTS.map(|[place, weight]| weight / self.squared(interval, u * place).sqrt());
        self.step * u * inverse.iter().sum::<f64>()
    }

    /// Returns the time at which a parameter is passed.
    pub fn time_at(&self, parameter: f64) -> f64 {
        let intervals = parameter / self.step;
        let interval = (intervals as usize).min(self.times.len() - 2);
        self.times[interval] + self.time_within_interval(interval, (intervals - interval as f64).min(1.0))
    }

    /// Returns the parameter at a time.
    pub fn at(&self, time: f64) -> f64 {
        let last = self.times.len() - 2;
        let interval = self.times.partition_point(|begin| *begin <= time).saturating_sub(1).min(last);
        let since = time - self.times[interval];
        let mut u = since / (self.times[interval + 1] - self.times[interval]);
        for _ in 0..NEWTON_STEPS_TO_PLACE {
            u -= (self.time_within_interval(interval, u) - since) * self.squared(interval, u).sqrt() / self.step;
        }
        (interval as f64 + u.clamp(0.0, 1.0)) * self.step
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gravity leaves more slack in one direction than in the other. The product of all slacks may exceed 1, and the range of
    /// doubles.
    #[test]
    fn the_product_of_slacks_may_exceed_the_range_of_doubles() {
        let conditions = [[0.25, 0.0, 0.0], [-10.0, 0.0, 0.0]].map(|factors| Condition { factors, has_root: false });
        let all = vec![conditions.to_vec(); 1000 * CONDITION_POSITIONS.len()];
        // The squared rate is below 4, so a parameter of 10 takes at least 5 s.
        let rate = Rate::fastest(&all, 0.01, 0.5).unwrap();
        assert!((5.0..5.05).contains(&rate.duration()), "{}", rate.duration());
        for time in [0.0, 1.3, 4.9] {
            assert!((rate.time_at(rate.at(time)) - time).abs() < 1e-12);
        }
    }
}
