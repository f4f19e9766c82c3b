//! Motions with a limit on the jerk, compared with closed forms, integrated, and judged by `verify`.

use crate::sampled::{as_vector, recording};
use crate::{curve, empty, waypoints};
use cplan::check::{Limit, limit_violations};
use cplan::model::{Joint, Scene};
use cplan::motion::{Limits, MIN_INTERVAL, TimedMotion, TipSpeed, time};
use cplan::space::Configuration;
use cplan_testkit::moving::state_between;
use cplan_testkit::scenes::{placed, q};
use proptest::prelude::*;

fn room(velocity: [f64; 2], acceleration: [f64; 2], jerk: [Option<f64>; 2]) -> Scene {
    let (mut arm, workspace) = empty(velocity, acceleration).into_parts();
    arm.joints.iter_mut().zip(jerk).for_each(|(joint, jerk)| joint.jerk = jerk);
    placed(arm, workspace)
}

/// Returns two durations in closed form: that of the shortest motion from rest to rest, by the limits that are reached
/// (Biagiotti, Melchiorri, *Trajectory planning for automatic machines and robots*, 2008, section 3.4), and that of its
/// shortest phase.
fn closed_form(length: f64, v: f64, a: f64, j: f64) -> (f64, f64) {
    let ramp = if v * j >= a * a { v / a + a / j } else { 2.0 * (v / j).sqrt() };
    if v * ramp <= length {
        let grow = (a / j).min((v / j).sqrt());
        let hold = if v * j > a * a { ramp - 2.0 * grow } else { f64::INFINITY };
        return (length / v + ramp, grow.min(hold).min(length / v - ramp));
    }
    if length >= 2.0 * a * a * a / (j * j) {
        let whole = a / j + (a * a / (j * j) + 4.0 * length / a).sqrt();
        return (whole, (a / j).min(whole / 2.0 - 2.0 * a / j));
    }
    let whole = 4.0 * (length / (2.0 * j)).cbrt();
    (whole, whole / 4.0)
}

/// Returns the shortest duration of a motion that stops at each corner. Also returns by how much the least interval
/// between samples may lengthen this duration.
fn shortest(points: &[Configuration], joints: &[Joint; 2]) -> (f64, f64) {
    let (mut sum, mut floor) = (0.0, 0.0);
    for leg in points.windows(2).map(|pair| pair[1] - pair[0]).filter(|leg| leg.norm() > 0.0) {
        let least = |of: &dyn Fn(&Joint) -> f64| {
            let along = (0..2).map(|k| of(&joints[k]) * leg.norm() / leg[k].abs());
            along.fold(f64::INFINITY, f64::min)
        };
        let (v, a) = (least(&|joint| joint.velocity), least(&|joint| joint.acceleration));
        let j = least(&|joint| joint.jerk.unwrap_or(f64::INFINITY));
        // The formulas also hold if there is no limit on the jerk.
        let (whole, phase) = closed_form(leg.norm(), v, a, j);
        sum += whole;
        // The seven phases last whole nanoseconds.
        floor += if phase >= MIN_INTERVAL { 7e-9 } else { 12.0 * MIN_INTERVAL };
    }
    (sum, floor)
}

/// Integrates the jerk alone, from rest at the start. The integrals must equal the accelerations, velocities and
/// positions of all samples, and the last sample must be at rest. Also checks the limits, between samples as well.
fn check(joints: &[Joint; 2], timed: &TimedMotion) {
    let trajectory = &timed.trajectory;
    let path = timed.curve.curve().path();
    let n = trajectory.time.len();
    assert!(timed.curve.curve().radii().iter().all(|radius| *radius == 0.0));
    assert_eq!([as_vector(trajectory.position[0]), as_vector(trajectory.position[n - 1])], [path.start(), path.goal()]);
    let ends = [trajectory.velocity[0], trajectory.velocity[n - 1], trajectory.acceleration[n - 1]];
    assert_eq!(ends, [[0.0; 2]; 3]);
    let size = path.waypoints().iter().map(|q| q.amax()).fold(1.0, f64::max);
    // The rounding of a position, and its effect on derivatives over an interval.
    let rounding = 32.0 * f64::EPSILON * size;
    for (k, joint) in joints.iter().enumerate() {
        let Some(jerk) = joint.jerk else { continue };
        let top = joint.acceleration.min(jerk * trajectory.duration());
        let (mut position, mut velocity, mut acceleration) = (trajectory.position[0][k], 0.0, 0.0);
        assert_eq!(trajectory.acceleration[0][k], 0.0);
        for i in 0..n - 1 {
            let h = trajectory.time[i + 1] - trajectory.time[i];
            let at = |t: f64| state_between(trajectory, i, t).map(|row| row[k]);
            // The stated acceleration is linear in time, and continuous.
            let [first, middle, last] = [0.0, h / 2.0, h].map(|t| at(t)[2]);
            let noise = 64.0 * rounding / (h * h);
            assert!((first + last - 2.0 * middle).abs() <= 1e-9 * top + noise, "jerk of {k} changes at {i}");
            let next = trajectory.acceleration[i + 1][k];
            assert!((last - next).abs() <= 1e-9 * top + noise, "acceleration of {k} jumps at {i}: {last} {next}");
            let rate = (next - first) / h;
            assert!(rate.abs() <= jerk * (1.0 + 1e-9) + 4.0 * f64::EPSILON * trajectory.duration() * jerk / h);
            position += h * (velocity + h * (acceleration / 2.0 + h * rate / 6.0));
            velocity += h * (acceleration + h * rate / 2.0);
            acceleration += h * rate;
            // At each sample, the time is rounded to half a unit in the last place of the duration, so that errors
            // accumulate.
            let drift = f64::EPSILON * trajectory.duration() * (i + 1) as f64;
            let speed = joint.velocity.min(top * trajectory.duration());
            assert!((acceleration - next).abs() <= 1e-9 * top + jerk * drift, "acceleration {k} at {i}");
            assert!(
                (velocity - trajectory.velocity[i + 1][k]).abs() <= 1e-9 * speed + top * drift,
                "velocity {k} at {i}"
            );
            let far = (position - trajectory.position[i + 1][k]).abs();
            assert!(far <= 1e-9 * size + top * drift * trajectory.duration(), "position {k} at {i}: {far}");
            for share in [0.2, 0.5, 0.8] {
                let [_, speed, pull] = at(share * h);
                assert!(speed.abs() <= joint.velocity * (1.0 + 1e-12) + rounding / h, "velocity {k} at {i}");
                assert!(pull.abs() <= joint.acceleration * (1.0 + 1e-12) + noise, "acceleration {k} at {i}");
            }
        }
    }
    assert_eq!(limit_violations(joints, &recording(trajectory)), []);
}

#[test]
fn seven_phases_on_each_leg_of_a_right_angle() {
    let scene = room([1.0, 1.0], [4.0, 4.0], [Some(40.0), Some(20.0)]);
    let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]];
    let timed = time(curve(&scene, &points, 0.3), &Limits::from(&scene.arm().joints), 1.0).unwrap();
    check(&scene.arm().joints, &timed);
    // Twice L / v + v / a + a / j. Samples lie at the ends of the phases, and at 1 s because of the period.
    let trajectory = &timed.trajectory;
    assert!((trajectory.duration() - (1.0 + 0.25 + 0.1) - (1.0 + 0.25 + 0.2)).abs() < 1e-8);
    let expected = [0.0, 0.1, 0.25, 0.35, 1.0, 1.1, 1.25, 1.35, 1.55, 1.6, 1.8, 2.0, 2.35, 2.55, 2.6, 2.8];
    assert_eq!(trajectory.time.len(), expected.len(), "{:?}", trajectory.time);
    assert!(trajectory.time.iter().zip(expected).all(|(t, e)| (t - e).abs() < 1e-8), "{:?}", trajectory.time);
}

#[test]
fn a_joint_without_a_limit_may_jump_where_it_moves_alone() {
    let scene = room([1.0, 1.0], [4.0, 4.0], [None, Some(20.0)]);
    let along = |points: &[[f64; 2]]| {
        let timed = time(curve(&scene, points, 0.3), &Limits::from(&scene.arm().joints), 0.01).unwrap();
        check(&scene.arm().joints, &timed);
        timed.trajectory
    };
    let alone = along(&[[0.0, 0.0], [1.0, 0.0]]);
    assert_eq!((alone.acceleration[0], alone.duration()), ([4.0, 0.0], 1.25));
    // Both joints move together, so the acceleration grows as slowly as that of the joint with a limit.
    let both = along(&[[0.0, 0.0], [1.0, 1.0]]);
    assert!((both.duration() - 1.45).abs() < 1e-8 && both.acceleration[0] == [0.0; 2]);
}

#[test]
fn less_speed_takes_that_much_longer() {
    let scene = room([1.0, 2.0], [4.0, 7.0], [Some(40.0), Some(20.0)]);
    let limits = Limits::from(&scene.arm().joints);
    let [fast, slow] = [limits, limits.scaled(0.25)].map(|limits| {
        time(curve(&scene, &[[0.0, 0.0], [1.0, 0.4], [0.7, 1.0]], 0.3), &limits, 0.01).unwrap().trajectory
    });
    assert!((slow.duration() - 4.0 * fast.duration()).abs() < 1e-7);
}

#[test]
fn a_jump_of_the_acceleration_is_a_broken_limit() {
    // The motion is timed without the limit, and verified with it.
    let scene = room([1.0, 1.0], [4.0, 4.0], [None, None]);
    let timed = time(curve(&scene, &[[0.0, 0.0], [1.0, 0.5]], 0.3), &Limits::from(&scene.arm().joints), 0.01).unwrap();
    let smooth = room([1.0, 1.0], [4.0, 4.0], [None, Some(1000.0)]);
    let found = limit_violations(&smooth.arm().joints, &recording(&timed.trajectory));
    assert_eq!(found.iter().map(|e| (e.joint, e.limit)).collect::<Vec<_>>(), [(1, Limit::AccelerationJump)]);
    assert!((found[0].value.abs() - 2.0).abs() < 1e-9 && found[0].allowed == 0.0 && found[0].moment.sample == 0);
}

#[test]
fn a_jerk_beyond_the_limit_is_a_broken_limit() {
    let scene = room([1.0, 1.0], [4.0, 4.0], [Some(20.2), Some(20.2)]);
    let timed = time(curve(&scene, &[[0.0, 0.0], [0.7, 0.7]], 0.3), &Limits::from(&scene.arm().joints), 0.01).unwrap();
    let gentler = room([1.0, 1.0], [4.0, 4.0], [Some(20.0), Some(20.2)]);
    let found = limit_violations(&gentler.arm().joints, &recording(&timed.trajectory));
    assert_eq!(found.iter().map(|e| (e.joint, e.limit)).collect::<Vec<_>>(), [(0, Limit::Jerk)]);
    assert!((found[0].value.abs() - 20.2).abs() < 1e-6 && found[0].allowed == 20.0);
}

#[test]
fn the_tip_satisfies_its_speed_limit() {
    let scene = room([3.0, 3.0], [40.0, 40.0], [Some(300.0), Some(900.0)]);
    let limits = Limits { tip: Some(TipSpeed::new(scene.arm(), 0.5)), ..Limits::from(&scene.arm().joints) };
    let timed = time(curve(&scene, &[[0.0, 0.0], [0.3, 0.4], [1.0, 0.4]], 0.3), &limits, 0.01).unwrap();
    check(&scene.arm().joints, &timed);
    // The tip of a gantry is at the joint values.
    let top = timed.trajectory.velocity.iter().map(|v| as_vector(*v).norm()).fold(0.0, f64::max);
    assert!((0.499..=0.5 + 1e-12).contains(&top), "{top}");
}

fn joints() -> impl Strategy<Value = [[f64; 2]; 3]> {
    let both = |range: std::ops::Range<f64>| prop::array::uniform2(range.prop_map(|e| 10f64.powf(e)));
    (both(-1.5..1.0), both(-1.0..2.5), both(-1.0..5.0)).prop_map(|(v, a, j)| [v, a, j])
}

proptest! {
    #![proptest_config(cplan_cases::cases(192))]

    #[test]
    fn motions_along_random_paths_keep_the_limits(
        waypoints in waypoints(), [velocity, acceleration, jerk] in joints(), period in prop_oneof![Just(0.01), 0.003..1.0_f64],
        unlimited in 0..4_usize,
    ) {
        let jerk = [0, 1].map(|k| (k != unlimited).then_some(jerk[k]));
        let scene = room(velocity, acceleration, jerk);
        let joints = &scene.arm().joints;
        let timed = time(curve(&scene, &waypoints, 0.1), &Limits::from(joints), period).unwrap();
        check(joints, &timed);
        let points: Vec<_> = waypoints.iter().map(|w| q(w[0], w[1])).collect();
        let (duration, floor) = shortest(&points, joints);
        let took = timed.trajectory.duration();
        prop_assert!(took >= duration * (1.0 - 1e-12) && took <= duration * (1.0 + 1e-9) + floor, "{took} {duration}");
    }
}

proptest! {
    #![proptest_config(cplan_cases::cases(2000))]

    /// Checks motions of one joint, with limits from those of an arm to far beyond.
    #[test]
    fn one_joint_is_as_fast_as_in_closed_form(
        length in -12.0..2.0_f64, speed in -3.0..4.0_f64, acceleration in -3.0..6.0_f64, jerk in -3.0..9.0_f64,
    ) {
        let [length, speed, acceleration, jerk] = [length, speed, acceleration, jerk].map(|e| 10f64.powf(e));
        let scene = room([speed, 1.0], [acceleration, 1.0], [Some(jerk), None]);
        let points = [[0.0, 0.0], [length, 0.0]];
        let joints = &scene.arm().joints;
        let (duration, floor) = shortest(&points.map(|p| q(p[0], p[1])), joints);
        let timed = time(curve(&scene, &points, 0.1), &Limits::from(joints), (duration / 20.0).max(1e-5)).unwrap();
        let took = timed.trajectory.duration();
        prop_assert!(took >= duration * (1.0 - 1e-12) && took <= duration * (1.0 + 1e-9) + floor, "{took} {duration}");
    }
}
