//! Limits of recorded motions, also between the samples.

use cplan::check::{Limit, LimitViolation, limit_violations};
use cplan::model::Joint;
use cplan::space::{Configuration, Derivative, JointRange, Recording};
use cplan_testkit::arms::rr;
use cplan_testkit::scenes::q;
use proptest::prelude::*;

/// Returns joints with a range from -1 to 1, top speed 1 and acceleration 4.
fn joints() -> [Joint; 2] {
    rr([JointRange::Interval { lower: -1.0, upper: 1.0 }; 2]).joints
}

fn violations_of_samples(
    times: &[f64],
    position: Vec<Configuration>,
    velocity: Option<Vec<Configuration>>,
) -> Vec<LimitViolation> {
    limit_violations(&joints(), &Recording::new(position, Some(times.to_vec()), velocity).unwrap())
}

fn only_violation(found: &[LimitViolation]) -> LimitViolation {
    assert_eq!(found.len(), 1, "{found:?}");
    found[0]
}

#[test]
fn a_cubic_that_leaves_the_range_between_its_samples_is_found() {
    // From 0.95 at 0.5 / s and back in 1 s: the top is 0.95 + v h u (1 - u) at u = 1/2, 1.075.
    let velocity = Some(vec![q(0.0, 0.5), q(0.0, -0.5)]);
    let found = violations_of_samples(&[0.0, 1.0], vec![q(0.0, 0.95); 2], velocity);
    let out: Vec<_> = found.iter().filter(|e| e.limit == Limit::Position).collect();
    assert_eq!(out.len(), 1);
    let LimitViolation { joint, value, allowed, moment, .. } = *out[0];
    assert_eq!((joint, allowed, moment.sample), (1, 1.0, 0));
    assert!((value - 1.075).abs() < 1e-12 && (moment.time - 0.5).abs() < 1e-9, "{value} at {}", moment.time);
    let rest: Vec<_> = found.iter().map(|e| e.limit).filter(|l| *l != Limit::Position).collect();
    assert_eq!(rest, [Limit::RestAtStart, Limit::RestAtEnd]);
}

#[test]
fn a_cubic_that_is_too_fast_between_its_samples_is_found() {
    // From rest to rest over 0.9 in 1 s: 1.35 / s halfway, 5.4 / s^2 at the ends.
    let rest = || Some(vec![q(0.0, 0.0); 2]);
    let found = violations_of_samples(&[5.0, 6.0], vec![q(0.0, 0.0), q(-0.9, 0.0)], rest());
    let kinds: Vec<_> = found.iter().map(|e| e.limit).collect();
    assert_eq!(kinds, [Limit::Velocity, Limit::Acceleration]);
    assert!((found[0].value + 1.35).abs() < 1e-12 && (found[0].moment.time - 5.5).abs() < 1e-9);
    assert!((found[1].value.abs() - 5.4).abs() < 1e-12 && found[1].allowed == 4.0);
    // Half as fast it keeps all limits.
    assert_eq!(violations_of_samples(&[5.0, 7.0], vec![q(0.0, 0.0), q(-0.9, 0.0)], rest()), []);
}

#[test]
fn without_velocities_the_mean_ones_are_judged() {
    let found = violations_of_samples(&[0.0, 1.0, 1.25], vec![q(0.0, 0.0), q(0.5, 0.0), q(0.8, -0.1)], None);
    let LimitViolation { joint, limit, value, moment, .. } = only_violation(&found);
    assert_eq!((joint, limit, moment.sample), (0, Limit::Velocity, 1));
    assert!((value - 1.2).abs() < 1e-12);
    let path = Recording::new(vec![q(0.0, 0.0), q(0.5, 0.0), q(0.8, 1.2)], None, None).unwrap();
    let LimitViolation { joint, limit, value, moment, .. } = only_violation(&limit_violations(&joints(), &path));
    assert_eq!((joint, limit, value, moment.time), (1, Limit::Position, 1.2, 2.0));
}

#[test]
fn a_single_sample_may_not_move() {
    let found = violations_of_samples(&[0.0], vec![q(0.0, 0.0)], Some(vec![q(0.0, 0.2)]));
    assert_eq!(
        found.iter().map(|e| (e.joint, e.limit)).collect::<Vec<_>>(),
        [(1, Limit::RestAtStart), (1, Limit::RestAtEnd)]
    );
    assert_eq!(violations_of_samples(&[0.0], vec![q(0.0, 0.0)], Some(vec![q(0.0, 0.0)])), []);
}

/// Judges a motion that accelerates with `a` from rest for 0.25 s, and decelerates in the same way. Its samples are `h`
/// seconds apart, and its numbers are rounded to `decimals`.
fn ramps(a: f64, h: f64, decimals: i32) -> Vec<LimitViolation> {
    let round = |v: f64| (v * 10f64.powi(decimals)).round() / 10f64.powi(decimals);
    let n = (0.5 / h).round() as u32;
    let times: Vec<f64> = (0..=n).map(|k| round(f64::from(k) * h)).collect();
    let state = |t: f64| match t <= 0.25 {
        true => (0.5 * a * t * t, a * t),
        false => (a * (0.0625 - 0.5 * (0.5 - t) * (0.5 - t)), a * (0.5 - t)),
    };
    let of = |f: fn((f64, f64)) -> f64| times.iter().map(|&t| q(round(f(state(t))), 0.0)).collect::<Vec<_>>();
    violations_of_samples(&times, of(|s| s.0), Some(of(|s| s.1)))
}

#[test]
fn rounded_numbers_of_a_motion_at_its_limits_break_none() {
    for decimals in [6, 7, 9, 12, 15] {
        for h in [0.01, 0.001] {
            assert_eq!(ramps(4.0, h, decimals), [], "{decimals} decimals every {h} s");
        }
    }
    // Doubles themselves are rounded, so over such short times differences of positions are inexact.
    for h in [1e-4, 1e-5] {
        assert_eq!(ramps(4.0, h, 15), [], "every {h} s");
        assert!(ramps(4.04, h, 15).iter().any(|e| e.limit == Limit::Acceleration), "every {h} s");
    }
}

#[test]
fn one_percent_beyond_the_limit_is_seen_in_numbers_that_can_show_it() {
    for (decimals, h) in [(6, 0.01), (9, 0.01), (9, 0.001), (15, 0.001)] {
        let found = ramps(4.0 * 1.01, h, decimals);
        let of = |limit| found.iter().filter(|e| e.limit == limit).count();
        assert_eq!(
            (of(Limit::Velocity), of(Limit::Acceleration), found.len()),
            (1, 1, 2),
            "{decimals}, {h}: {found:?}"
        );
    }
}

#[test]
fn stated_velocities_are_judged_as_stated_however_close_the_samples() {
    // Four rows at a microsecond, as six decimals write it, and 1.7 / s against a limit of 1.
    let times = [0.0, 1e-6, 2e-6, 3e-6];
    let position = times.map(|t| q(1.7 * t, 0.0)).to_vec();
    let found = violations_of_samples(&times, position, Some(vec![q(1.7, 0.0); 4]));
    let speed = found.iter().find(|e| e.limit == Limit::Velocity).expect("it is too fast");
    assert_eq!((speed.joint, speed.allowed), (0, 1.0));
    assert!((speed.value - 1.7).abs() < 1e-12, "{speed:?}");
}

#[test]
fn a_fast_move_is_found_with_samples_a_microsecond_apart() {
    // The speed rises to 1.7 / s at 4 / s^2 and falls again, sampled finely only where it is too fast. Numbers have six
    // decimals.
    let (a, top) = (4.0, 1.7 / 4.0);
    let state = |t: f64| match t <= top {
        true => (0.5 * a * t * t, a * t),
        false => (a * (top * top - 0.5 * (2.0 * top - t) * (2.0 * top - t)), a * (2.0 * top - t)),
    };
    let round = |v: f64| (v * 1e6).round() / 1e6;
    let slow = (0..=24).map(|k| f64::from(k) * 0.01);
    let fast = (0..369_990).step_by(3).map(|k| 0.24 + f64::from(k) * 1e-6 + 1e-6);
    let down = (0..=24).map(|k| 0.61 + f64::from(k) * 0.01);
    let times: Vec<f64> = slow.chain(fast).chain(down).map(round).collect();
    let rows = |f: fn((f64, f64)) -> f64| times.iter().map(|&t| q(round(f(state(t))) - 0.36, 0.0)).collect::<Vec<_>>();
    let velocity = times.iter().map(|&t| q(round(state(t).1), 0.0)).collect();
    let found = violations_of_samples(&times, rows(|s| s.0), Some(velocity));
    let speed = found.iter().find(|e| e.limit == Limit::Velocity).expect("it is too fast");
    assert!(speed.value > 1.6, "{speed:?}");
    // The stated velocities hide the excess, but the positions show it.
    let hidden = vec![q(0.99, 0.0); times.len()];
    let found = violations_of_samples(&times, rows(|s| s.0), Some(hidden));
    assert!(found.iter().any(|e| e.limit == Limit::Velocity && e.value > 1.1), "{found:?}");
}

proptest! {
    #![proptest_config(cplan_cases::cases(64))]

    /// Checks random cubics that are written with all their digits. The judge finds exactly the excesses that dense
    /// samples show.
    #[test]
    fn speeds_and_accelerations_are_those_of_dense_samples(
        rows in prop::collection::vec((1e-6..1.0_f64, -0.2..0.2_f64, -1.1..1.1_f64), 2..6),
    ) {
        let mut time = 0.0;
        let times: Vec<f64> = rows.iter().map(|row| { time += row.0; time }).collect();
        let mut at = 0.0;
        let position: Vec<Configuration> =
            rows.iter().map(|row| { at += row.0 * row.1; q(at, 0.0) }).collect();
        let velocity: Vec<Configuration> = rows.iter().map(|row| q(row.2, 0.0)).collect();
        let recording = Recording::new(position, Some(times), Some(velocity)).unwrap();
        let mut seen = [0.0_f64; 2];
        for piece in recording.pieces() {
            for i in 0..=500 {
                let of = |of| piece.derivative(of, f64::from(i) / 500.0)[0].abs();
                seen = [seen[0].max(of(Derivative::Velocity)), seen[1].max(of(Derivative::Acceleration))];
            }
        }
        let found = limit_violations(&joints(), &recording);
        let is_found = |limit| found.iter().any(|e| e.joint == 0 && e.limit == limit);
        for (limit, seen, allowed) in [(Limit::Velocity, seen[0], 1.0), (Limit::Acceleration, seen[1], 4.0)] {
            if seen > 1.02 * allowed + 1e-3 {
                prop_assert!(is_found(limit), "{:?} of {}", limit, seen);
            }
            if seen < 0.999 * allowed {
                prop_assert!(!is_found(limit), "{:?} of {}", limit, seen);
            }
        }
    }
}
