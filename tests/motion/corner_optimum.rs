//! Motions through corners with limits on jerks, compared with the least time along their curve. An interior-point
//! method on a fine grid computes that time. It shares nothing with the library's method.
//!
//! Let `q(s)` be the curve, with `s` the time of the motion. A second motion along the same curve is at `s(t)` after
//! `t` seconds. Let `z` be the square of the rate of `s`, and take derivatives by `s`. Then velocities are `q'
//! z^(1/2)`, accelerations `q'' z + q' z' / 2`, and jerks `z^(1/2) (q''' z + 3 q'' z' / 2 + q' z'' / 2)`; the time is
//! the integral of `z^(-1/2)`. The motion itself has `z = 1`. It begins and ends with a non-zero jerk only, so `z` need
//! not vanish there.

use crate::sampled::as_vector;
use crate::{certified, empty};
use cplan::model::Scene;
use cplan::motion::{Drive, Trajectory};
use cplan::space::Configuration;
use cplan_testkit::scenes::placed;

/// Limits of each joint: velocity, acceleration and jerk.
type Most = [[f64; 2]; 3];

fn room([velocity, acceleration, jerk]: Most) -> Scene {
    let (mut arm, workspace) = empty(velocity, acceleration).into_parts();
    arm.joints.iter_mut().zip(jerk).for_each(|(joint, jerk)| joint.jerk = Some(jerk));
    placed(arm, workspace)
}

/// Returns the motion along a path with blended corners, as a user of the library gets it.
fn driven(waypoints: &[[f64; 2]], most: Most) -> Trajectory {
    let scene = room(most);
    Drive::default().along(&scene, &certified(&scene, waypoints), 1.0).unwrap().trajectory
}

/// Returns the three derivatives of a motion with constant jerk between samples, at `steps` equal steps from its
/// beginning to its end.
fn derivatives(motion: &Trajectory, steps: usize) -> Vec<[Configuration; 3]> {
    let (times, mut k) = (&motion.time, 0);
    let at = |step: usize| {
        let time = motion.duration() * step as f64 / steps as f64;
        while k + 2 < times.len() && times[k + 1] <= time {
            k += 1;
        }
        let (since, long) = (time - times[k], times[k + 1] - times[k]);
        let [from, to] = [k, k + 1].map(|k| as_vector(motion.acceleration[k]));
        let third = (to - from) / long;
        let velocity = as_vector(motion.velocity[k]) + from * since + third * (since * since / 2.0);
        [velocity, from + third * since, third]
    };
    (0..=steps).map(at).collect()
}

/// A condition on the values `z` of three neighbouring nodes: `1 - root(z_i) (w . (z_(i-1), z_i, z_(i+1))) > 0`, or the
/// same without the root.
struct Condition {
    at: usize,
    weights: [f64; 3],
    has_root: bool,
}

impl Condition {
    /// Returns the slack of the condition, its gradient, and its second derivatives.
    fn slack(&self, z: &[f64]) -> (f64, [f64; 3], [[f64; 3]; 3]) {
        let i = self.at;
        let around = [z[i.saturating_sub(1)], z[i], z[(i + 1).min(z.len() - 1)]];
        let w = self.weights;
        let sum: f64 = (0..3).map(|k| w[k] * around[k]).sum();
        if !self.has_root {
            return (1.0 - sum, w.map(|w| -w), [[0.0; 3]; 3]);
        }
        let root = around[1].sqrt();
        let mut gradient = w.map(|w| -w * root);
        gradient[1] -= sum / (2.0 * root);
        let mut second = [[0.0; 3]; 3];
        for k in 0..3 {
            second[1][k] -= w[k] / (2.0 * root);
            second[k][1] -= w[k] / (2.0 * root);
        }
        second[1][1] += sum / (4.0 * root.powi(3));
        (1.0 - root * sum, gradient, second)
    }
}

/// Number of nodes near each end at which accelerations are bounded by the remaining time. Between nodes, no jerk is
/// checked.
const NEAR_ENDS: usize = 8;

/// Returns the conditions that the joints' limits impose on `z` at each node. The nodes at both ends have only one
/// neighbour, and need no conditions, because the arm is at rest there.
fn conditions(nodes: &[[Configuration; 3]], step: f64, [v, a, j]: Most) -> Vec<Condition> {
    let mut all = Vec::new();
    for (at, [first, second, third]) in nodes.iter().enumerate() {
        let is_end = at == 0 || at + 1 == nodes.len();
        for k in 0..2 {
            let (slope, bend) = if is_end { (0.0, 0.0) } else { (1.0 / (2.0 * step), 1.0 / (step * step)) };
            let (p, pp, ppp) = (first[k], second[k], third[k]);
            let pull = [-0.5 * p * slope, pp, 0.5 * p * slope];
            let jerk = [-1.5 * pp * slope + 0.5 * p * bend, ppp - p * bend, 1.5 * pp * slope + 0.5 * p * bend];
            all.push(Condition { at, weights: [0.0, p * p / (v[k] * v[k]), 0.0], has_root: false });
            for sign in [-1.0, 1.0] {
                all.push(Condition { at, weights: pull.map(|w| sign * w / a[k]), has_root: false });
                all.push(Condition { at, weights: jerk.map(|w| sign * w / j[k]), has_root: true });
                // The acceleration must build up after the beginning, and vanish before the end.
                let steps = at.min(nodes.len() - 1 - at);
                if (1..=NEAR_ENDS).contains(&steps) {
                    let most = j[k] * steps as f64 * step;
                    all.push(Condition { at, weights: pull.map(|w| sign * w / most), has_root: true });
                }
            }
        }
    }
    all
}

/// Solves `A x = b` for a symmetric matrix `A` with five diagonals: `middle`, and in `beside` the two diagonals above
/// it. Returns `None` if `A` is not positive definite.
fn solve_pentadiagonal(middle: &[f64], beside: [&[f64]; 2], b: &[f64]) -> Option<Vec<f64>> {
    let n = middle.len();
    let (mut d, mut l, mut x) = (vec![0.0; n], [vec![0.0; n], vec![0.0; n]], b.to_vec());
    for i in 0..n {
        // `l[k][i]` is the entry of the unit lower triangle in row `i`, `k + 1` columns to the left of the diagonal.
        if i >= 2 {
            l[1][i] = beside[1][i - 2] / d[i - 2];
        }
        if i >= 1 {
            let both = if i >= 2 { l[1][i] * d[i - 2] * l[0][i - 1] } else { 0.0 };
            l[0][i] = (beside[0][i - 1] - both) / d[i - 1];
        }
        d[i] = middle[i];
        for k in 0..2.min(i) {
            d[i] -= l[k][i] * l[k][i] * d[i - 1 - k];
            x[i] -= l[k][i] * x[i - 1 - k];
        }
        if d[i].is_nan() || d[i] <= 0.0 {
            return None;
        }
    }
    for i in (0..n).rev() {
        x[i] /= d[i];
        for k in 0..2.min(n - 1 - i) {
            x[i] -= l[k][i + 1 + k] * x[i + 1 + k];
        }
    }
    Some(x)
}

/// Returns the duration of the motion, by the trapezoidal rule.
fn time(z: &[f64], step: f64) -> f64 {
    let half = |i: usize| if i == 0 || i + 1 == z.len() { 0.5 } else { 1.0 };
    z.iter().enumerate().map(|(i, z)| half(i) * step / z.sqrt()).sum()
}

/// Returns the duration plus a barrier that grows towards the limits. `height` is the barrier's factor. Returns
/// infinity if a limit is violated.
fn merit(z: &[f64], step: f64, conditions: &[Condition], height: f64) -> f64 {
    if z.iter().any(|&z| z.is_nan() || z <= 0.0) {
        return f64::INFINITY;
    }
    let barrier = conditions.iter().map(|condition| {
        let (slack, ..) = condition.slack(z);
        if slack > 0.0 { -slack.ln() } else { f64::INFINITY }
    });
    time(z, step) + height * barrier.sum::<f64>()
}

/// Returns a step of Newton's method. Its matrix is made positive definite by the smallest change that suffices.
fn newton(z: &[f64], step: f64, conditions: &[Condition], height: f64) -> (Vec<f64>, f64) {
    let n = z.len();
    let (mut gradient, mut middle, mut one, mut two) = (vec![0.0; n], vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    for i in 0..n {
        let half = if i == 0 || i + 1 == n { 0.5 } else { 1.0 };
        gradient[i] -= half * step * 0.5 * z[i].powf(-1.5);
        middle[i] += half * step * 0.75 * z[i].powf(-2.5);
    }
    for condition in conditions {
        let (slack, first, second) = condition.slack(z);
        let index = |k: usize| (condition.at + k).wrapping_sub(1);
        for k in (0..3).filter(|&k| index(k) < n) {
            gradient[index(k)] -= height * first[k] / slack;
            for m in (k..3).filter(|&m| index(m) < n) {
                let entry = height * (first[k] * first[m] / slack - second[k][m]) / slack;
                [&mut middle, &mut one, &mut two][m - k][index(k)] += entry;
            }
        }
    }
    let minus: Vec<f64> = gradient.iter().map(|g| -g).collect();
    let mut more = 0.0;
    loop {
        let lifted: Vec<f64> = middle.iter().zip(z).map(|(m, z)| m + more * step * z.powf(-2.5)).collect();
        if let Some(direction) = solve_pentadiagonal(&lifted, [&one, &two], &minus) {
            let decrease = -gradient.iter().zip(&direction).map(|(g, d)| g * d).sum::<f64>();
            return (direction, decrease);
        }
        more = if more == 0.0 { 1e-3 } else { 4.0 * more };
    }
}

/// Returns the least time along the curve of a motion. `steps` is the number of steps, and `from` the fraction of the
/// motion's speed with which the search begins.
fn optimum(motion: &Trajectory, most: Most, steps: usize, from: f64) -> f64 {
    let step = motion.duration() / steps as f64;
    let conditions = conditions(&derivatives(motion, steps), step, most);
    let mut z = vec![from * from; steps + 1];
    let mut height = 0.1 * motion.duration() / conditions.len() as f64;
    while height * conditions.len() as f64 > 2e-4 * motion.duration() {
        for _ in 0..60 {
            let now = merit(&z, step, &conditions, height);
            assert!(now.is_finite());
            let (direction, decrease) = newton(&z, step, &conditions, height);
            if decrease < 1e-7 * motion.duration() {
                break;
            }
            let moved = |share: f64| -> Vec<f64> { z.iter().zip(&direction).map(|(z, d)| z + share * d).collect() };
            let mut share = 1.0;
            while share > 1e-9 && merit(&moved(share), step, &conditions, height) > now - 1e-3 * share * decrease {
                share /= 2.0;
            }
            z = if share > 1e-9 { moved(share) } else { break };
        }
        height /= 4.0;
    }
    time(&z, step)
}

/// Waypoints, and limits of the joints.
type Case = (&'static [[f64; 2]], Most);

/// Largest fraction by which a motion may take longer than the least time along its curve.
const LONGER: f64 = 0.01;

/// Paths with right angles, gentle turns, hairpins, and short segments between long ones. In some, one joint is far
/// slower than the other.
const PATHS: [Case; 12] = [
    (&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], [[2.0, 3.0], [8.0, 12.0], [200.0, 300.0]]),
    (&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], [[2.0, 3.0], [8.0, 12.0], [80.0, 60.0]]),
    (&[[0.0, 0.0], [1.0, 0.2], [2.0, 0.0], [3.0, 0.3]], [[2.0, 3.0], [8.0, 12.0], [200.0, 300.0]]),
    (&[[0.0, 0.0], [1.0, 0.0], [0.0, 0.1]], [[1.0, 1.0], [4.0, 4.0], [100.0, 100.0]]),
    (&[[0.0, 0.0], [1.0, 0.0], [0.5, 0.5]], [[1.0, 1.0], [4.0, 4.0], [40.0, 40.0]]),
    (&[[0.0, 0.0], [1.0, 0.0], [1.05, 0.05], [1.05, 1.0]], [[2.0, 2.0], [5.0, 5.0], [125.0, 125.0]]),
    (&[[0.0, 0.0], [1.0, 0.7], [0.2, 1.5], [-1.0, 1.0], [-1.5, -0.5]], [[0.5, 3.0], [1.0, 20.0], [25.0, 500.0]]),
    (
        &[[0.0, 0.0], [0.3, 0.0], [0.5, 0.2], [0.55, 0.5], [0.4, 0.8], [0.0, 0.9]],
        [[2.0, 2.0], [9.0, 6.0], [225.0, 150.0]],
    ),
    (&[[0.0, 0.0], [2.0, 1.0], [2.5, -1.0], [-1.0, 0.5]], [[10.0, 10.0], [3.0, 2.0], [75.0, 50.0]]),
    (&[[0.0, 0.0], [0.02, 0.0], [0.02, 3.0], [0.0, 3.0]], [[1.0, 2.0], [2.0, 30.0], [50.0, 750.0]]),
    (
        &[[0.0, 0.0], [1.0, 1.0], [2.0, 1.0], [3.0, 0.0], [4.0, 0.0], [4.0, 2.0]],
        [[1.5, 1.5], [40.0, 40.0], [1000.0, 1000.0]],
    ),
    (
        &[[0.5, 0.5], [0.4, 1.4], [0.45, 1.5], [1.3, 1.6], [1.4, 1.5], [1.5, 0.3]],
        [[2.0, 3.0], [8.0, 12.0], [200.0, 300.0]],
    ),
];

/// Largest relative difference that is accepted between the result with one number of steps and that with twice as
/// many. Limits hold at the steps but may be exceeded in between, so the steps are halved until the difference is less.
const OFF: f64 = 5e-3;

/// Largest number of steps.
const MAX_STEPS: usize = 20_000;

#[test]
fn motions_are_near_the_least_time_along_the_same_curve() {
    for (i, &(waypoints, most)) in PATHS.iter().enumerate() {
        let motion = driven(waypoints, most);
        let (mut steps, mut fine) = (2400, optimum(&motion, most, 1200, 0.97));
        loop {
            let coarse = std::mem::replace(&mut fine, optimum(&motion, most, steps, 0.97));
            if (coarse - fine).abs() <= OFF * fine {
                break;
            }
            steps *= 2;
            assert!(steps <= MAX_STEPS, "path {i}: the oracle itself is off: {coarse} {fine}");
        }
        let took = motion.duration();
        println!("path {i}: {took:.4} s, least {fine:.4} s ({steps} steps), {:.2} % more", 100.0 * (took / fine - 1.0));
        assert!(took >= fine * (1.0 - OFF) && took <= fine * (1.0 + LONGER), "path {i}: {took} s, at least {fine} s");
    }
}

/// Checks that the result does not depend on where the search begins, although limits on jerks do not make a convex
/// problem.
#[test]
fn the_least_time_is_the_same_from_anywhere() {
    for &(waypoints, most) in [PATHS[1], PATHS[4], PATHS[7]].iter() {
        let motion = driven(waypoints, most);
        let [one, other] = [0.97, 0.2].map(|from| optimum(&motion, most, 600, from));
        assert!((one - other).abs() <= 1e-3 * one, "{one} {other}");
    }
}

/// Checks long segments, for which the least time is known: `L / v + v / a + a / j`, with top speed between complete
/// ramps. The motions of the library are gentler.
#[test]
fn along_straight_lines_the_least_time_is_known() {
    let motion = driven(&[[0.0, 0.0], [1.0, 0.5]], [[0.7, 0.7], [3.0, 3.0], [20.0, 20.0]]);
    for from in [0.9, 0.3] {
        let found = optimum(&motion, [[1.0, 2.0], [4.0, 9.0], [40.0, 90.0]], 1500, from);
        assert!((found - 1.35).abs() < 1e-3, "{found}");
    }
}
