//! The continuous check against dense sampling and contacts known in closed form.

use cplan::check::{CollisionCheck, check_collision};
use cplan::geometry::Point;
use cplan::model::Scene;
use cplan::space::{Configuration, JointRange, Recording};
use cplan_testkit::arms::{all_kinds, rr};
use cplan_testkit::scenes::{clutter, q, scene};
use cplan_testkit::shapes::{disc, rectangle};
use proptest::prelude::*;
use std::f64::consts::FRAC_PI_4;

/// Computes cubic Hermite interpolation by its basis polynomials.
fn hermite(h: f64, u: f64, [a, va]: [Configuration; 2], [b, vb]: [Configuration; 2]) -> Configuration {
    let (u2, u3) = (u * u, u * u * u);
    a * (2.0 * u3 - 3.0 * u2 + 1.0) + va * (h * (u3 - 2.0 * u2 + u)) + b * (3.0 * u2 - 2.0 * u3) + vb * (h * (u3 - u2))
}

/// Returns the configuration at `time`, independently of the library.
fn configuration_at(recording: &Recording, time: f64) -> Configuration {
    let (times, rows) = (recording.times().unwrap(), recording.positions());
    let k = times.iter().rposition(|t| *t <= time).unwrap().min(times.len() - 2);
    let h = times[k + 1] - times[k];
    let u = (time - times[k]) / h;
    match recording.velocities() {
        Some(v) => hermite(h, u, [rows[k], v[k]], [rows[k + 1], v[k + 1]]),
        None => rows[k] * (1.0 - u) + rows[k + 1] * u,
    }
}

/// Returns times and the distances from obstacles at these times, at `n` equal steps.
fn sampled(scene: &Scene, recording: &Recording, n: u32) -> Vec<(f64, f64)> {
    let times = recording.times().unwrap();
    let (from, to) = (times[0], times[times.len() - 1]);
    let time = |i: u32| from + (to - from) * f64::from(i) / f64::from(n);
    (0..=n).map(|i| (time(i), scene.clearance(configuration_at(recording, time(i))))).collect()
}

proptest! {
    #![proptest_config(cplan_cases::cases(96))]

    #[test]
    fn verdict_agrees_with_dense_sampling(
        kind in 0_usize..5,
        curved in any::<bool>(),
        rows in prop::collection::vec((prop::array::uniform4(0.0..1.0_f64), 0.3..1.0_f64), 2..6),
        reach in 0.02..0.5_f64,
    ) {
        let scene = scene(all_kinds().swap_remove(kind), clutter());
        let domain = [0, 1].map(|k| scene.arm().topology().ranges[k].domain());
        let corner = |k: usize, t: f64| domain[k].0 + t * (domain[k].1 - domain[k].0);
        let first = rows[0].0;
        // The walk stays near one place, so that some motions are free.
        let near = |k: usize, t: f64| corner(k, first[k] + reach * (t - first[k]));
        let position: Vec<_> = rows.iter().map(|(r, _)| q(near(0, r[0]), near(1, r[1]))).collect();
        prop_assume!(scene.clearance(position[0]) > 0.0);
        let velocity = rows.iter().map(|(r, _)| q(r[2] - 0.5, r[3] - 0.5) * 2.0).collect();
        let time: Vec<f64> = rows.iter().scan(-1.0, |t, (_, dt)| { *t += dt; Some(*t) }).collect();
        let recording = Recording::new(position, Some(time), curved.then_some(velocity)).unwrap();
        const STEPS: u32 = 4000;
        let samples = sampled(&scene, &recording, STEPS);
        let seen = samples.iter().map(|s| s.1).fold(f64::INFINITY, f64::min);
        // No point of these arms is farther than 3 m from a joint, which bounds the change of distances between
        // samples.
        let turned = |w: &[(f64, f64)]| (configuration_at(&recording, w[1].0) - configuration_at(&recording, w[0].0)).abs().sum();
        let step = 3.0 * samples.windows(2).map(turned).fold(0.0, f64::max);
        match check_collision(&scene, &recording, 0.0) {
            CollisionCheck::Free { clearance, nearest } => {
                prop_assert!(clearance > 0.0 && clearance <= seen + 1e-12);
                let nearest = nearest.expect("there are obstacles");
                prop_assert!(clearance >= 0.9 * nearest.contact.separation.distance - 1e-12);
                prop_assert!((configuration_at(&recording, nearest.moment.time) - nearest.moment.at).norm() < 1e-9);
                prop_assert!(nearest.contact.separation.distance <= seen + step);
            }
            CollisionCheck::Collision { first, free_until, deepest, .. } => {
                prop_assert!(scene.clearance(first.moment.at) <= 0.0);
                prop_assert!((configuration_at(&recording, first.moment.time) - first.moment.at).norm() < 1e-9);
                prop_assert!(free_until <= first.moment.time && first.moment.time - free_until < 1e-9);
                let before = samples.iter().find(|(t, d)| *d <= 0.0 && *t < free_until);
                prop_assert!(before.is_none(), "{before:?} before {free_until}");
                prop_assert!(deepest.contact.separation.distance <= seen + step);
                let place = recording.times().unwrap().iter().rposition(|t| *t <= first.moment.time);
                prop_assert_eq!(Some(first.moment.sample), place);
            }
            CollisionCheck::Undecided(place) => prop_assert!(place.contact.separation.distance.abs() < 1e-6),
        }
    }
}

/// Returns a scene with a tiny obstacle in the path of the outstretched arm, and the angle at which the bar's side
/// meets it.
fn speck() -> (Scene, f64) {
    let radius = 1e-9;
    let scene = scene(rr([JointRange::Circle, JointRange::Circle]), vec![disc(Point::new(1.2, 1.2), radius)]);
    (scene, FRAC_PI_4 - ((0.05 + radius) / 1.2_f64.hypot(1.2)).asin())
}

fn collision(scene: &Scene, recording: &Recording) -> (f64, f64) {
    match check_collision(scene, recording, 0.0) {
        CollisionCheck::Collision { first, free_until, .. } => {
            assert_eq!((first.contact.pair.link, first.contact.pair.obstacle), (1, 0));
            (first.moment.time, free_until)
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn collisions_between_samples_are_found_at_their_times() {
    let (scene, angle) = speck();
    let ends = || vec![q(0.0, 0.0), q(1.5, 0.0)];
    // Straight, from t = 10 to 13 at half a radian a second.
    let (time, free) = collision(&scene, &Recording::new(ends(), Some(vec![10.0, 13.0]), None).unwrap());
    assert!((time - (10.0 + 2.0 * angle)).abs() < 1e-7, "{time}");
    assert!(free <= 10.0 + 2.0 * angle && free > time - 1e-9);
    // Without times, the contact is at the same fraction of the path.
    let (share, _) = collision(&scene, &Recording::new(ends(), None, None).unwrap());
    assert!((share - angle / 1.5).abs() < 1e-7, "{share}");
    // From rest to rest in 1 s: the fraction 3 u^2 - 2 u^3 of the path.
    let rest = vec![q(0.0, 0.0); 2];
    let (time, _) = collision(&scene, &Recording::new(ends(), Some(vec![0.0, 1.0]), Some(rest)).unwrap());
    assert!((1.5 * time * time * (3.0 - 2.0 * time) - angle).abs() < 1e-7, "{time}");
}

#[test]
fn an_excursion_between_samples_that_stand_still_is_found() {
    // Both samples are at 0, but the velocities move the cubic up to 4 / 27 h v at a third of the interval, and back.
    let (scene, angle) = speck();
    let excursion = |v: f64| {
        let velocity = vec![q(v, 0.0), q(0.0, 0.0)];
        Recording::new(vec![q(0.0, 0.0); 2], Some(vec![0.0, 1.0]), Some(velocity)).unwrap()
    };
    let (time, _) = collision(&scene, &excursion(6.0));
    assert!((6.0 * time * (1.0 - time) * (1.0 - time) - angle).abs() < 1e-7 && time < 1.0 / 3.0, "{time}");
    // Just short of the speck it is free, just beyond it hits.
    let reaching = angle * 27.0 / 4.0;
    assert!(matches!(check_collision(&scene, &excursion(reaching - 1e-5), 0.0), CollisionCheck::Free { .. }));
    let (time, _) = collision(&scene, &excursion(reaching + 1e-5));
    assert!((time - 1.0 / 3.0).abs() < 1e-2, "{time}");
}

#[test]
fn contacts_at_the_very_ends_count() {
    let (scene, angle) = speck();
    let motion =
        |from: f64, to: f64| Recording::new(vec![q(from, 0.0), q(to, 0.0)], Some(vec![0.0, 1.0]), None).unwrap();
    assert_eq!(collision(&scene, &motion(angle + 1e-3, 0.0)), (0.0, 0.0));
    let (time, _) = collision(&scene, &motion(0.0, angle + 1e-9));
    assert!(time > 0.999_999);
    let still = Recording::new(vec![q(FRAC_PI_4, 0.0)], Some(vec![4.0]), None).unwrap();
    assert_eq!(collision(&scene, &still), (4.0, 4.0));
    let still = Recording::new(vec![q(0.0, 0.0)], None, None).unwrap();
    assert!(matches!(check_collision(&scene, &still, 0.0), CollisionCheck::Free { clearance, .. } if clearance > 0.5));
}

#[test]
fn the_clearance_asked_for_decides() {
    let scene = scene(rr([JointRange::Circle, JointRange::Circle]), vec![rectangle(1.9, 2.0, -1.0, 1.0)]);
    let motion = Recording::new(vec![q(-0.3, 0.0), q(0.3, 0.0)], Some(vec![0.0, 1.0]), None).unwrap();
    let truth = 1.9 - 1.8_f64.hypot(0.05);
    assert!(
        matches!(check_collision(&scene, &motion, 0.0985), CollisionCheck::Free { clearance, .. } if clearance >= 0.0985)
    );
    let CollisionCheck::Collision { first, .. } = check_collision(&scene, &motion, truth + 1e-6) else {
        panic!("too near")
    };
    assert!(first.contact.separation.distance < truth + 1e-6 && first.contact.separation.distance > 0.0);
}

#[test]
fn grazing_at_exactly_the_clearance_is_not_called_free() {
    // The forearm's corner stays on a circle; the wall touches that circle.
    let reach = 1.8_f64.hypot(0.05);
    let scene = scene(rr([JointRange::Circle, JointRange::Circle]), vec![rectangle(reach, 3.0, -1.0, 1.0)]);
    let motion = Recording::new(vec![q(-0.3, 0.0), q(0.3, 0.0)], Some(vec![0.0, 1.0]), None).unwrap();
    let verdict = check_collision(&scene, &motion, 0.0);
    assert!(!matches!(verdict, CollisionCheck::Free { .. }), "{verdict:?}");
}

#[test]
fn a_scene_without_obstacles_is_free() {
    let motion = Recording::new(vec![q(-0.3, 0.0), q(0.3, 0.0)], None, None).unwrap();
    let verdict = check_collision(&scene(rr([JointRange::Circle, JointRange::Circle]), vec![]), &motion, 0.0);
    assert_eq!(verdict, CollisionCheck::Free { clearance: f64::INFINITY, nearest: None });
}

#[test]
fn many_samples_of_one_motion_give_its_verdict() {
    let (scene, angle) = speck();
    for n in [1_u32, 3, 1000, 5000] {
        let share = |i: u32| f64::from(i) / f64::from(n);
        let position = (0..=n).map(|i| q(1.5 * share(i), 0.0)).collect();
        let recording = Recording::new(position, Some((0..=n).map(share).collect()), None).unwrap();
        let (time, _) = collision(&scene, &recording);
        assert!((time - angle / 1.5).abs() < 1e-7, "{n}: {time}");
    }
}
