//! Motions that stop at every corner, against integration, closed forms and the path itself.

use super::sample::time_curve;
use super::{Limits, MAX_SAMPLES, MIN_INTERVAL, TimingError, Trajectory};
use cplan_geometry::Vector;
use cplan_model::space::{Configuration, JointRange, Path};
use cplan_model::{Joint, JointType};
use proptest::prelude::*;

fn joint(revolute: bool, velocity: f64, acceleration: f64) -> Joint {
    let motion =
        if revolute { JointType::Revolute { sign: 1.0 } } else { JointType::Prismatic { direction: Vector::x() } };
    Joint { name: "j".into(), joint_type: motion, range: JointRange::Circle, velocity, acceleration, jerk: None }
}

fn path(waypoints: &[[f64; 2]]) -> Path {
    Path::new(waypoints.iter().map(|&[a, b]| Configuration::new(a, b)).collect())
}

/// Returns the motion along the path without blends, which stops at every corner.
fn time_path(path: &Path, joints: &[Joint; 2], period: f64) -> Result<Trajectory, TimingError> {
    time_curve(&path.clone().into(), &Limits::from(joints), period).map(|(_, trajectory)| trajectory)
}

fn as_vector(row: [f64; 2]) -> Configuration {
    Configuration::new(row[0], row[1])
}

/// Returns the distance of `p` from the segment, by projection.
fn distance_to_segment(p: Configuration, a: Configuration, b: Configuration) -> f64 {
    let along = b - a;
    let part = ((p - a).dot(&along) / along.dot(&along)).clamp(0.0, 1.0);
    (p - (a + along * part)).norm()
}

/// Asserts the properties of every trajectory. `tolerance` is for positions and velocities, relative to their size.
fn check(path: &Path, joints: &[Joint; 2], trajectory: &Trajectory, tolerance: f64) {
    let n = trajectory.time.len();
    assert!(n >= 1 && [trajectory.position.len(), trajectory.velocity.len(), trajectory.acceleration.len()] == [n; 3]);
    assert_eq!(trajectory.time[0], 0.0);
    assert_eq!(as_vector(trajectory.position[0]), path.start());
    assert_eq!(as_vector(trajectory.position[n - 1]), path.goal());
    assert_eq!([trajectory.velocity[0], trajectory.velocity[n - 1], trajectory.acceleration[n - 1]], [[0.0; 2]; 3]);

    // Integration of the acceleration alone, from rest at the start.
    let size = path.waypoints().iter().map(|q| q.amax()).fold(0.0, f64::max);
    let (mut position, mut velocity) = (path.start(), Configuration::zeros());
    for k in 0..n - 1 {
        let dt = trajectory.time[k + 1] - trajectory.time[k];
        assert!(dt >= 0.998 * MIN_INTERVAL, "sample {k} lasts {dt} s");
        let acceleration = as_vector(trajectory.acceleration[k]);
        position += velocity * dt + acceleration * (0.5 * dt * dt);
        velocity += acceleration * dt;
        for i in 0..2 {
            let top = joints[i].velocity.min(joints[i].acceleration * trajectory.duration());
            // Rounding of the times: each corner and each end of a ramp is off by half a unit in the last place of the
            // duration, and positions drift from there.
            let drift = joints[i].acceleration * f64::EPSILON * trajectory.duration() * path.waypoints().len() as f64;
            let far = (position[i] - trajectory.position[k + 1][i]).abs();
            assert!(far <= tolerance * size + drift * trajectory.duration(), "position {i} at {k}: {far}");
            let fast = (velocity[i] - trajectory.velocity[k + 1][i]).abs();
            assert!(fast <= tolerance * top + drift, "velocity {i} at {k}: {fast}");
        }
    }
    for k in 0..n {
        for (i, joint) in joints.iter().enumerate() {
            assert!(trajectory.velocity[k][i].abs() <= joint.velocity * (1.0 + 1e-12));
            assert!(trajectory.acceleration[k][i].abs() <= joint.acceleration * (1.0 + 1e-12));
        }
    }

    // On the path, piece after piece, at rest at each corner.
    let mut piece = 0;
    let segments: Vec<_> = path.segments().collect();
    for (k, &row) in trajectory.position.iter().enumerate() {
        let q = as_vector(row);
        let Some(&(a, b)) = segments.get(piece) else { continue };
        assert!(distance_to_segment(q, a, b) <= 1e-12 * (1.0 + size), "sample {k} leaves piece {piece}");
        assert!((0..2).all(|i| a[i].min(b[i]) <= q[i] && q[i] <= a[i].max(b[i])));
        if q == b && trajectory.velocity[k] == [0.0; 2] {
            piece += 1;
        }
    }
    assert_eq!(piece, segments.len(), "a corner without a sample at rest");
}

/// Returns the duration in closed form, as a sum over the pieces. On each piece, the joint that is slower for a limit
/// determines it.
fn shortest_duration(path: &Path, joints: &[Joint; 2]) -> f64 {
    let limit = |length: f64, d: Configuration, of: fn(&Joint) -> f64| {
        (0..2).filter(|&i| d[i] != 0.0).map(|i| length * of(&joints[i]) / d[i].abs()).fold(f64::INFINITY, f64::min)
    };
    path.segments()
        .map(|(a, b)| {
            let length = (b - a).norm();
            let (v, a) = (limit(length, b - a, |j| j.velocity), limit(length, b - a, |j| j.acceleration));
            if length * a <= v * v { 2.0 * (length / a).sqrt() } else { length / v + v / a }
        })
        .sum()
}

#[test]
fn path_without_motion_is_one_sample() {
    let path = path(&[[0.4, -0.2], [0.4, -0.2]]);
    let trajectory = time_path(&path, &[joint(true, 1.0, 1.0), joint(true, 1.0, 1.0)], 0.01).unwrap();
    let zero = vec![[0.0; 2]];
    assert_eq!((&trajectory.time, &trajectory.position), (&vec![0.0], &vec![[0.4, -0.2]]));
    assert_eq!((&trajectory.velocity, &trajectory.acceleration), (&zero, &zero));
    assert_eq!(trajectory.duration(), 0.0);
}

#[test]
fn useless_periods_and_endless_motions_are_errors() {
    let path = path(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]);
    let joints = [joint(true, 1.0, 1.0), joint(true, 1.0, 1.0)];
    for period in [0.0, -0.01, f64::NAN, f64::INFINITY, 1e-9] {
        assert!(matches!(time_path(&path, &joints, period), Err(TimingError::Period(_))), "{period}");
    }
    let many = time_path(&path, &joints, MIN_INTERVAL).map(|t| t.time.len());
    assert!(many.is_ok_and(|n| (3_999_000..=4_000_001).contains(&n)));
    let slow = [joint(true, 1.0, 1.0), joint(true, 1e-2, 1.0)];
    let error = time_path(&path, &slow, MIN_INTERVAL).unwrap_err();
    assert!(matches!(error, TimingError::TooManySamples { .. }));
    assert!(error.to_string().contains(&MAX_SAMPLES.to_string()), "{error}");
    let stuck = [joint(true, 1.0, 1.0), joint(true, 1e-9, 1.0)];
    assert!(matches!(time_path(&path, &stuck, 0.01), Err(TimingError::TooLong(_))));
}

/// Tests a case that random tests found: when distances counted from the segment's beginning, rounding made the
/// deceleration inaccurate.
#[test]
fn short_ramps_after_a_long_cruise_keep_the_limits() {
    let (path, joints) = (path(&[[0.0, 0.0], [100.0, 30.0]]), [joint(true, 0.01, 100.0), joint(true, 1.0, 100.0)]);
    let trajectory = time_path(&path, &joints, 100.0).unwrap();
    check(&path, &joints, &trajectory, 1e-9);
    let before_last = trajectory.velocity[trajectory.velocity.len() - 2];
    assert!((before_last[0] - 0.01).abs() < 1e-15, "{before_last:?}");
}

fn joints() -> impl Strategy<Value = [Joint; 2]> {
    let one =
        || (any::<bool>(), -2.0..2.0f64, -1.0..3.0f64).prop_map(|(r, v, a)| joint(r, 10f64.powf(v), 10f64.powf(a)));
    (one(), one()).prop_map(|(a, b)| [a, b])
}

proptest! {
    #![proptest_config(cplan_cases::cases(256))]

    #[test]
    fn motions_along_random_paths_keep_the_limits(
        waypoints in prop::collection::vec(prop::array::uniform2(-7.0..7.0f64), 1..6),
        joints in joints(),
        period in prop_oneof![Just(0.01), 0.003..3.0f64],
    ) {
        let path = path(&waypoints);
        let trajectory = time_path(&path, &joints, period).unwrap();
        check(&path, &joints, &trajectory, 1e-9);
        let shortest = shortest_duration(&path, &joints);
        prop_assert!((trajectory.duration() - shortest).abs() <= 4e-6 * waypoints.len() as f64 + 1e-12 * shortest);
        // Neither more nor fewer samples than the period and the phases ask for.
        let pieces = path.segments().count();
        let full = trajectory.duration() / period;
        prop_assert!(trajectory.time.len() as f64 <= full + 3.0 * pieces as f64 + 2.0);
        prop_assert!(trajectory.time.windows(2).all(|w| w[1] - w[0] <= period + 2e-4));
    }

    /// Tests segments far shorter and far longer than those of arms, along and across the axes.
    #[test]
    fn motions_along_tiny_and_huge_segments_keep_the_limits(
        steps in prop::collection::vec((-15.0..3.0f64, 0..8u32, any::<bool>()), 1..6),
        joints in joints(),
    ) {
        let mut waypoints = vec![[0.0, 0.0]];
        for (exponent, eighth, equal) in steps {
            let angle = if equal { 0.0 } else { 1e-9 } + f64::from(eighth) * std::f64::consts::FRAC_PI_4;
            let [x, y] = waypoints[waypoints.len() - 1];
            let length = 10f64.powf(exponent);
            waypoints.push([x + length * angle.cos(), y + length * angle.sin()]);
        }
        let path = path(&waypoints);
        // Some hundred samples, however long it takes.
        let period = (shortest_duration(&path, &joints) / 100.0).max(1e-5);
        let trajectory = time_path(&path, &joints, period).unwrap();
        check(&path, &joints, &trajectory, 1e-9);
        let shortest = shortest_duration(&path, &joints);
        prop_assert!((trajectory.duration() - shortest).abs() <= 4e-6 * waypoints.len() as f64 + 1e-12 * shortest);
    }
}
