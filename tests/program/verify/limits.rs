//! Limits of recorded motions, between the samples too.

use crate::common::{q, rr};
use cplan::certify::{Excess, Limit, limits_kept};
use cplan::model::Joint;
use cplan::space::{Axis, Configuration, Recording};

/// Range from -1 to 1, top speed 1, acceleration 4.
fn joints() -> [Joint; 2] {
    rr([Axis::Interval { lower: -1.0, upper: 1.0 }; 2]).joints
}

fn judged(times: &[f64], position: Vec<Configuration>, velocity: Option<Vec<Configuration>>) -> Vec<Excess> {
    limits_kept(&joints(), &Recording::new(position, Some(times.to_vec()), velocity).unwrap())
}

fn only(found: &[Excess]) -> Excess {
    assert_eq!(found.len(), 1, "{found:?}");
    found[0]
}

#[test]
fn a_cubic_that_leaves_the_range_between_its_samples() {
    // From 0.95 at 0.5 / s and back in 1 s: the top is 0.95 + v h u (1 - u) at u = 1/2, 1.075.
    let velocity = Some(vec![q(0.0, 0.5), q(0.0, -0.5)]);
    let found = judged(&[0.0, 1.0], vec![q(0.0, 0.95); 2], velocity);
    let out: Vec<_> = found.iter().filter(|e| e.limit == Limit::Position).collect();
    assert_eq!(out.len(), 1);
    let Excess { joint, value, allowed, moment, .. } = *out[0];
    assert_eq!((joint, allowed, moment.sample), (1, 1.0, 0));
    assert!((value - 1.075).abs() < 1e-12 && (moment.time - 0.5).abs() < 1e-9, "{value} at {}", moment.time);
    let rest: Vec<_> = found.iter().map(|e| e.limit).filter(|l| *l != Limit::Position).collect();
    assert_eq!(rest, [Limit::RestAtStart, Limit::RestAtEnd]);
}

#[test]
fn a_cubic_that_is_too_fast_between_its_samples() {
    // From rest to rest over 0.9 in 1 s: 1.35 / s halfway, 5.4 / s^2 at the ends.
    let rest = || Some(vec![q(0.0, 0.0); 2]);
    let found = judged(&[5.0, 6.0], vec![q(0.0, 0.0), q(-0.9, 0.0)], rest());
    let kinds: Vec<_> = found.iter().map(|e| e.limit).collect();
    assert_eq!(kinds, [Limit::Velocity, Limit::Acceleration]);
    assert!((found[0].value + 1.35).abs() < 1e-12 && (found[0].moment.time - 5.5).abs() < 1e-9);
    assert!((found[1].value.abs() - 5.4).abs() < 1e-12 && found[1].allowed == 4.0);
    // Half as fast it keeps all limits.
    assert_eq!(judged(&[5.0, 7.0], vec![q(0.0, 0.0), q(-0.9, 0.0)], rest()), []);
}

#[test]
fn without_velocities_the_mean_ones_are_judged() {
    let found = judged(&[0.0, 1.0, 1.25], vec![q(0.0, 0.0), q(0.5, 0.0), q(0.8, -0.1)], None);
    let Excess { joint, limit, value, moment, .. } = only(&found);
    assert_eq!((joint, limit, moment.sample), (0, Limit::Velocity, 1));
    assert!((value - 1.2).abs() < 1e-12);
    let path = Recording::new(vec![q(0.0, 0.0), q(0.5, 0.0), q(0.8, 1.2)], None, None).unwrap();
    let Excess { joint, limit, value, moment, .. } = only(&limits_kept(&joints(), &path));
    assert_eq!((joint, limit, value, moment.time), (1, Limit::Position, 1.2, 2.0));
}

#[test]
fn a_single_sample_may_not_move() {
    let found = judged(&[0.0], vec![q(0.0, 0.0)], Some(vec![q(0.0, 0.2)]));
    assert_eq!(
        found.iter().map(|e| (e.joint, e.limit)).collect::<Vec<_>>(),
        [(1, Limit::RestAtStart), (1, Limit::RestAtEnd)]
    );
    assert_eq!(judged(&[0.0], vec![q(0.0, 0.0)], Some(vec![q(0.0, 0.0)])), []);
}

/// Constant acceleration `a` from rest for 0.25 s and the same back, every `h` seconds, numbers rounded to `decimals`.
fn ramps(a: f64, h: f64, decimals: i32) -> Vec<Excess> {
    let round = |v: f64| (v * 10f64.powi(decimals)).round() / 10f64.powi(decimals);
    let n = (0.5 / h).round() as u32;
    let times: Vec<f64> = (0..=n).map(|k| round(f64::from(k) * h)).collect();
    let state = |t: f64| match t <= 0.25 {
        true => (0.5 * a * t * t, a * t),
        false => (a * (0.0625 - 0.5 * (0.5 - t) * (0.5 - t)), a * (0.5 - t)),
    };
    let of = |f: fn((f64, f64)) -> f64| times.iter().map(|&t| q(round(f(state(t))), 0.0)).collect::<Vec<_>>();
    judged(&times, of(|s| s.0), Some(of(|s| s.1)))
}

#[test]
fn rounded_numbers_of_a_motion_at_its_limits_break_none() {
    for decimals in [6, 7, 9, 12, 15] {
        for h in [0.01, 0.001] {
            assert_eq!(ramps(4.0, h, decimals), [], "{decimals} decimals every {h} s");
        }
    }
    // Doubles themselves are rounded: over such short times differences of positions say little.
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
