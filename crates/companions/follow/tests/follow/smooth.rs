//! Motions with limits on jerks, compared with limits and distances from dense samples.

use super::{BARS, check, found, gantry, gantry_tips, line, scene_of, toolpath};
use cplan_cases::dice::Dice;
use cplan_follow::{Found, Settings, follow};
use cplan_interrupt::Interrupt;
use cplan_model::{Obstacle, Outcome, Scene};
use cplan_motion::Trajectory;
use cplan_testkit::follow_oracle::{Bars, Point, pass_together, points};
use cplan_toolpath::{Toolpath, polyline, spline};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

const JERK: f64 = 200.0;

/// Number of places at which each interval between samples is judged.
const PLACES: u32 = 8;

fn smooth_scene(bars: Bars, limit: f64, obstacles: Vec<Obstacle>) -> Scene {
    let mut scene = scene_of(bars, limit, obstacles);
    scene.arm_mut().joints.iter_mut().for_each(|joint| joint.jerk = Some(JERK));
    scene
}

/// Returns points on a wave with some irregularity.
fn wave(count: u32) -> Vec<Point> {
    let at = |k: u32| f64::from(k) / f64::from(count - 1);
    let jitter = |k: u32| 0.01 * (f64::from(k) * 2.4).sin();
    (0..count).map(|k| [1.0 + 0.25 * (19.0 * at(k)).sin() + jitter(k), at(k) - 0.5]).collect()
}

/// Checks speed, acceleration and jerk of the quintics that controllers make of all values of the samples. The cubics are
/// checked by [`check`].
fn check_quintics(scene: &Scene, trajectory: &Trajectory) {
    let Trajectory { time, position, velocity, acceleration, .. } = trajectory;
    for i in 1..time.len() {
        let h = time[i] - time[i - 1];
        for (k, joint) in scene.arm().joints.iter().enumerate() {
            let [p, v, a] = [position[i - 1][k], velocity[i - 1][k] * h, acceleration[i - 1][k] * h * h];
            let [q, w, b] = [position[i][k], velocity[i][k] * h, acceleration[i][k] * h * h];
            let d = q - p;
            // The coefficients of the third to the fifth power of the share of the interval.
            let c = [
                10.0 * d - 6.0 * v - 4.0 * w - 1.5 * a + 0.5 * b,
                -15.0 * d + 8.0 * v + 7.0 * w + 1.5 * a - b,
                6.0 * d - 3.0 * v - 3.0 * w - 0.5 * a + 0.5 * b,
            ];
            for u in (0..=PLACES).map(|n| f64::from(n) / f64::from(PLACES)) {
                let speed = v + u * (a + u * (3.0 * c[0] + u * (4.0 * c[1] + u * 5.0 * c[2])));
                let second = a + u * (6.0 * c[0] + u * (12.0 * c[1] + u * 20.0 * c[2]));
                let third = 6.0 * c[0] + u * (24.0 * c[1] + u * 60.0 * c[2]);
                // Positions are rounded to about 1e-16 of their size.
                let rounding = 4e-14;
                let rates = [
                    (speed, joint.velocity * h),
                    (second, joint.acceleration * h * h),
                    (third, joint.jerk.unwrap_or(f64::INFINITY) * h * h * h),
                ];
                for (order, (rate, most)) in rates.into_iter().enumerate() {
                    assert!(rate.abs() <= most * (1.0 + 1e-6) + rounding, "{order} at {}: {rate} {most}", time[i]);
                }
            }
        }
    }
}

/// Returns the number of times that a motion rests between its ends.
fn stops(trajectory: &Trajectory) -> usize {
    let rests = |i: usize| trajectory.velocity[i] == [0.0; 2];
    (1..trajectory.time.len()).filter(|&i| rests(i) && !rests(i - 1)).count() - 1
}

/// Returns points with corners of five degrees and of about ninety degrees, two of each.
fn bent() -> Vec<Point> {
    let [step, ahead] = [5.0_f64.to_radians().sin(), 5.0_f64.to_radians().cos()].map(|x| 0.15 * x);
    vec![
        [0.9, -0.4],
        [0.9, -0.2],
        [0.9 + step, ahead - 0.2],
        [1.1, ahead - 0.22],
        [1.1, -0.3],
        [1.1 - step, -0.3 - ahead],
    ]
}

fn checked(scene: &Scene, line: &Toolpath, settings: &Settings) -> Trajectory {
    let found = found(scene, line, settings);
    check(&BARS, scene, line, settings, &found);
    check_quintics(scene, &found.timed.trajectory);
    found.timed.trajectory
}

/// Before motions followed curves of their own, this took a second for each point, and the motions ten times as long as
/// without limits on jerks.
#[test]
fn splines_through_many_points_are_followed_without_a_stop() {
    let scenes = [smooth_scene(BARS, 3.0, vec![]), scene_of(BARS, 3.0, vec![])];
    for (count, times_without_limit) in [(20, 1.35), (60, 1.35)] {
        let line = toolpath(spline(&wave(count)).expect("a spline"));
        let trajectory = checked(&scenes[0], &line, &Settings::default());
        assert_eq!(stops(&trajectory), 0, "{count}");
        let without = found(&scenes[1], &line, &Settings::default()).timed.trajectory.duration();
        let duration = trajectory.duration();
        assert!(duration < times_without_limit * without && duration > without, "{count}: {duration} {without}");
        assert!(trajectory.time.len() < 6000, "{}", trajectory.time.len());
    }
}

#[test]
fn a_wider_tolerance_and_a_limit_on_the_tip_are_used() {
    let scene = smooth_scene(BARS, 3.0, vec![]);
    let durations = |line: &Toolpath| {
        [1e-5, 1e-3].map(|tolerance| checked(&scene, line, &Settings { tolerance, ..Settings::default() }).duration())
    };
    let [fine, wide] = durations(&toolpath(polyline(&bent(), 0.0).expect("a polyline")));
    assert!(wide < 0.9 * fine, "{fine} {wide}");
    // A smooth line gains nothing.
    let line = toolpath(spline(&wave(30)).expect("a spline"));
    let [fine, wide] = durations(&line);
    assert!((wide / fine - 1.0).abs() < 0.02, "{fine} {wide}");
    let slow = Settings { tolerance: 1e-4, speed: Some(0.2), ..Settings::default() };
    let found = found(&scene, &line, &slow);
    let fastest = check(&BARS, &scene, &line, &slow, &found);
    assert!(fastest <= 0.2 * (1.0 + 1e-6) && fastest > 0.195, "{fastest}");
    // Nearly all of the line is passed at the greatest speed.
    assert!(found.timed.trajectory.duration() < 1.1 * line.length() / 0.2);
}

#[test]
fn small_corners_are_passed_and_great_ones_have_a_stop() {
    let scene = smooth_scene(BARS, 3.0, vec![]);
    // A circle of straight lines, which turns by a third of a degree at each corner.
    let angle = |k: u32| std::f64::consts::TAU * f64::from(k) / 1080.0;
    let circle: Vec<Point> = (0..=1080).map(|k| [1.1 + 0.25 * angle(k).cos(), 0.25 * angle(k).sin()]).collect();
    let polygon = checked(&scene, &toolpath(polyline(&circle, 0.0).expect("a polygon")), &Settings::default());
    let round = checked(&scene, &self::line("G0 X1350 Y0\nG3 I-250"), &Settings::default());
    assert_eq!([stops(&polygon), stops(&round)], [0, 0]);
    assert!(polygon.duration() < 1.02 * round.duration(), "{} {}", polygon.duration(), round.duration());
    // Only the corners of about ninety degrees have a stop.
    let bent = checked(&scene, &toolpath(polyline(&bent(), 0.0).expect("a polyline")), &Settings::default());
    assert_eq!(stops(&bent), 2);
}

#[test]
fn joints_with_and_without_a_limit_on_jerks_move_together() {
    let mut scene = scene_of(BARS, 3.0, vec![]);
    scene.arm_mut().joints[0].jerk = Some(JERK);
    let line = toolpath(spline(&wave(12)).expect("a spline"));
    let trajectory = checked(&scene, &line, &Settings { tolerance: 1e-4, ..Settings::default() });
    assert_eq!(stops(&trajectory), 0);
}

/// Random lines among discs, near the limits of joints and near full reach. Nothing about the answers is known, except
/// that limits on jerks do not change whether there is a motion.
#[test]
fn random_lines_are_followed_within_all_limits() {
    let mut followed = 0;
    for seed in cplan_cases::seeds(40) {
        let mut dice = cplan_cases::dice(seed);
        let disc = |dice: &mut Dice, name: &str| {
            let (distance, angle) = (dice.within(0.3, 1.5), dice.within(-3.0, 3.0));
            Obstacle::circle(name, [distance * angle.cos(), distance * angle.sin()], dice.within(0.02, 0.1))
        };
        let discs = ["one", "two"].map(|name| disc(&mut dice, name).expect("a disc")).to_vec();
        let limit = dice.within(1.5, 3.1);
        let center = dice.within(-1.5, 1.5);
        let at = |dice: &mut Dice| {
            let (distance, angle) = (dice.within(0.4, 1.79), center + dice.within(-0.3, 0.3));
            [distance * angle.cos(), distance * angle.sin()]
        };
        let through: Vec<Point> = (0..dice.within(3.0, 9.0) as usize).map(|_| at(&mut dice)).collect();
        let curves = if dice.chance(0.7) { spline(&through) } else { polyline(&through, 0.0) };
        let line = toolpath(curves.expect("different points"));
        let settings = Settings { tolerance: [1e-5, 1e-4, 1e-3][(seed % 3) as usize], ..Settings::default() };
        let [plain, smooth] = [scene_of(BARS, limit, discs.clone()), smooth_scene(BARS, limit, discs)];
        let answers = [&plain, &smooth].map(|scene| follow(scene, &line, &settings).expect("usable settings"));
        let [plain, smooth_answer] = &answers;
        assert_eq!(plain.status(), smooth_answer.status(), "{seed}");
        if let Outcome::Found(found) = smooth_answer {
            followed += 1;
            check(&BARS, &smooth, &line, &settings, found);
            check_quintics(&smooth, &found.timed.trajectory);
            assert!(points(&line, 0.1).len() > 1);
        }
    }
    assert!(followed > 8, "{followed}");
}

/// Greatest number of checkpoints of a plan. Before hairpins were considered, millions of steps of motions were tried.
const MOST_CHECKPOINTS: usize = 6000;

/// Returns a motion, and the number of checkpoints that were passed to find it.
fn counted(scene: &Scene, line: &Toolpath, settings: &Settings) -> (Found, usize) {
    let count = Arc::new(AtomicUsize::new(0));
    let own = count.clone();
    let counts = move || {
        own.fetch_add(1, Ordering::Relaxed);
        false
    };
    let interrupt = Interrupt::new().with_callback(Duration::ZERO, counts);
    let answer = interrupt.run(|| follow(scene, line, settings)).expect("nobody interrupts").expect("usable settings");
    match answer {
        Outcome::Found(found) => (found, count.load(Ordering::Relaxed)),
        other => panic!("{:?}", other.status()),
    }
}

/// The line turns back in hairpins of less than 0.1 mm. With a tolerance of 1 mm, planning took 40 s, and the motion was
/// slower by a fifth than with 0.1 mm.
#[test]
fn a_wide_tolerance_at_hairpins_takes_neither_long_nor_slow_motions() {
    let through = [
        [1.254, 0.769],
        [1.077, 0.866],
        [0.653, 0.584],
        [0.845, 0.857],
        [0.748, 0.678],
        [0.741, 0.505],
        [0.901, 0.973],
    ];
    let line = toolpath(spline(&through).expect("a spline"));
    let scene = gantry(Some(50.0));
    let mut narrow = f64::INFINITY;
    for tolerance in [1e-4, 1e-3, 5e-3] {
        let (found, checkpoints) = counted(&scene, &line, &Settings { tolerance, ..Settings::default() });
        let trajectory = &found.timed.trajectory;
        assert!(found.deviation <= tolerance, "{tolerance}: {}", found.deviation);
        assert!(checkpoints < MOST_CHECKPOINTS, "{tolerance}: {checkpoints}");
        narrow = narrow.min(trajectory.duration());
        assert!(trajectory.duration() < 1.01 * narrow, "{tolerance}: {} {narrow}", trajectory.duration());
        let step = tolerance / 2.0;
        assert!(pass_together(&gantry_tips(&found, step), &points(&line, step), found.deviation + step), "{tolerance}");
    }
}
