//! Samples, compared with the curve, with the limits, and with each other. They are joined by the interpolation that
//! the result states.

use crate::{curve, empty, limits, waypoints};
use cplan::check::{CertifiedCurve, limit_violations};
use cplan::model::Joint;
use cplan::motion::{Limits, MIN_INTERVAL, TimedMotion, Trajectory, time};
use cplan::space::{BLEND_TOLERANCE, Configuration, Recording};
use cplan_testkit::moving::state_between;
use cplan_testkit::scenes::q;
use proptest::prelude::*;

/// Largest difference between the time of a sample and the beginning of its phase, in seconds. Samples lie at whole
/// nanoseconds.
const HALF_A_NANOSECOND: f64 = 0.5e-9;

pub fn as_vector(row: [f64; 2]) -> Configuration {
    q(row[0], row[1])
}

/// Returns the samples as a recording, which any program could have written.
pub fn recording(trajectory: &Trajectory) -> Recording {
    let rows = |rows: &[[f64; 2]]| rows.iter().copied().map(as_vector).collect::<Vec<_>>();
    let velocity = rows(&trajectory.velocity);
    Recording::new(rows(&trajectory.position), Some(trajectory.time.clone()), Some(velocity)).unwrap()
}

/// Returns the distance between a configuration and a curve, in units of joint space, by Newton's method on every
/// segment and blend.
fn distance_to_curve(curve: &CertifiedCurve, at: Configuration) -> f64 {
    let (points, radii) = (curve.curve().path().waypoints(), curve.curve().radii());
    let mut least = (at - points[0]).norm();
    for i in 1..points.len() {
        let (a, b) = (points[i - 1], points[i]);
        let share = ((at - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
        least = least.min((at - a - (b - a) * share).norm());
        if radii[i] > 0.0 {
            let toward = |end: Configuration| b + (end - b) * (radii[i] / (end - b).norm());
            let (from, to) = (toward(a), toward(points[i + 1]));
            let on = |u: f64| from * ((1.0 - u) * (1.0 - u)) + b * (2.0 * u * (1.0 - u)) + to * (u * u);
            for start in [0.0, 0.25, 0.5, 0.75, 1.0] {
                let mut u: f64 = start;
                for _ in 0..30 {
                    let (slope, bend) =
                        ((b - from) * (2.0 * (1.0 - u)) + (to - b) * (2.0 * u), (from - b * 2.0 + to) * 2.0);
                    let (gap, rate) = ((on(u) - at).dot(&slope), slope.norm_squared() + (on(u) - at).dot(&bend));
                    let next = u - gap / rate;
                    u = if next.is_finite() { next.clamp(0.0, 1.0) } else { u };
                }
                least = least.min((on(u) - at).norm());
            }
        }
    }
    least
}

/// Checks all properties that every motion must have.
fn check(joints: &[Joint; 2], timed: &TimedMotion, period: f64) {
    let TimedMotion { curve, trajectory } = timed;
    let n = trajectory.time.len();
    let path = curve.curve().path();
    assert_eq!([as_vector(trajectory.position[0]), as_vector(trajectory.position[n - 1])], [path.start(), path.goal()]);
    assert_eq!([trajectory.velocity[0], trajectory.velocity[n - 1], trajectory.acceleration[n - 1]], [[0.0; 2]; 3]);
    let size = path.waypoints().iter().map(|q| q.amax()).fold(1.0, f64::max);
    let (mut position, mut velocity) = (path.start(), Configuration::zeros());
    let mut step = 0;
    for k in 0..n - 1 {
        let h = trajectory.time[k + 1] - trajectory.time[k];
        // A multiple of the period that is near another sample is skipped.
        assert!((0.998 * MIN_INTERVAL..=period + 2e-4).contains(&h), "sample {k} lasts {h} s");
        // Integrates only the stated acceleration, from rest at the start. Gauss's rule with three points is exact up
        // to the fifth degree.
        let nodes = [0.5 - 0.15f64.sqrt(), 0.5, 0.5 + 0.15f64.sqrt()];
        let weights = [5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0];
        position += velocity * h;
        for (node, weight) in nodes.into_iter().zip(weights) {
            let acceleration = state_between(trajectory, k, node * h)[2];
            velocity += acceleration * (weight * h);
            position += acceleration * (weight * h * h * (1.0 - node));
        }
        for i in 0..2 {
            // At each sample, the time is rounded to half a unit in the last place of the duration, so that errors
            // accumulate.
            let drift = joints[i].acceleration * f64::EPSILON * trajectory.duration() * (k + 1) as f64;
            let speed = joints[i].velocity.min(joints[i].acceleration * trajectory.duration());
            let fast = (velocity[i] - trajectory.velocity[k + 1][i]).abs();
            assert!(fast <= 1e-9 * speed + drift, "velocity {i} at {k}: {fast}");
            let far = (position[i] - trajectory.position[k + 1][i]).abs();
            assert!(far <= 1e-9 * size + drift * trajectory.duration(), "position {i} at {k}: {far}");
        }
        // The motion is on the curve and within the limits, between samples as well. In the shortest intervals, the
        // rounding of positions hides the accelerations.
        step += 1;
        // The acceleration at a sample is that of the interval that begins within half a nanosecond.
        let late = HALF_A_NANOSECOND * joints[0].acceleration.max(joints[1].acceleration) * h;
        for share in [0.0, 0.3, 0.7, 1.0] {
            let [at, speed, pull] = state_between(trajectory, k, share * h);
            if step % 5 == 0 {
                assert!(
                    distance_to_curve(curve, at) <= 1e-10 * size + late,
                    "{} off at {k} + {share}",
                    distance_to_curve(curve, at)
                );
            }
            let rounding = 16.0 * f64::EPSILON * size;
            for i in 0..2 {
                assert!(speed[i].abs() <= joints[i].velocity * (1.0 + 1e-12) + 16.0 * rounding / h);
                let most = joints[i].acceleration * (1.0 + 1e-12) + 32.0 * rounding / (h * h);
                assert!(pull[i].abs() <= most, "acceleration {i} at {k} + {share}: {}", pull[i]);
            }
        }
    }
    // The cubic through positions and velocities is also on the curve and within the limits, and its distance from the
    // curve is within the tolerance.
    let recording = recording(trajectory);
    assert_eq!(limit_violations(joints, &recording), []);
    let largest = curve.curve().radii().iter().copied().fold(0.0, f64::max);
    for (k, piece) in recording.pieces().iter().enumerate() {
        // The tolerance for each joint.
        let hair = 1.5 * BLEND_TOLERANCE * largest + 1e-13 * size;
        let (there, h) = (state_between(trajectory, k, (piece.to - piece.from) / 2.0)[0], piece.to - piece.from);
        let late = HALF_A_NANOSECOND * joints[0].acceleration.max(joints[1].acceleration) * h;
        let (apart, aside) = ((piece.at(0.5) - there).amax(), distance_to_curve(curve, piece.at(0.5)));
        assert!(apart <= hair + late && aside <= hair, "{apart}, {aside} aside at {k}");
    }
}

#[test]
fn motions_around_a_right_angle_keep_the_limits() {
    let scene = empty([2.0, 3.0], [8.0, 12.0]);
    let limits = Limits::from(&scene.arm().joints);
    let timed = time(curve(&scene, &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], 0.3), &limits, 0.01).unwrap();
    check(&scene.arm().joints, &timed, 0.01);
    // The motion is never at rest between its ends.
    let moving = |k: usize| as_vector(timed.trajectory.velocity[k]).norm() > 0.1;
    let n = timed.trajectory.time.len();
    assert!((n / 10..n * 9 / 10).all(moving));
    assert!(n < 200, "{n} samples");
    // At a fraction of the speed, the motion takes longer by that factor, and keeps limits that are scaled by that
    // fraction.
    let slow = limits.scaled(0.5);
    let half = time(timed.curve.clone(), &slow, 0.01).unwrap().trajectory;
    assert!((half.duration() - 2.0 * timed.trajectory.duration()).abs() < 1e-4);
}

proptest! {
    #![proptest_config(cplan_cases::cases(96))]

    #[test]
    fn motions_along_random_paths_keep_the_limits(
        waypoints in waypoints(), [velocity, acceleration] in limits(), radius in -3.0..0.5_f64,
        period in prop_oneof![Just(0.01), 0.003..1.0_f64],
    ) {
        let scene = empty(velocity, acceleration);
        let timed = time(curve(&scene, &waypoints, 10f64.powf(radius)), &Limits::from(&scene.arm().joints), period);
        check(&scene.arm().joints, &timed.unwrap(), period);
    }
}
