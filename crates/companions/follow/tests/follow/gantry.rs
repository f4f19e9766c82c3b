//! Lines with narrow hairpins, on a gantry with limits on jerks.

use cplan_follow::{Found, Settings, follow};
use cplan_interrupt::Interrupt;
use cplan_model::{Arm, Joint, Link, Outcome, Scene, Workspace};
use cplan_testkit::follow_oracle::{Bars, Point, pass_together, played, points};
use cplan_toolpath::{Curve, Piece, Source, Toolpath, spline};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// The tip's position with both joints at 0.
const ORIGIN: Point = [0.1, 0.0];

/// Bars whose tip moves at least as fast as that of the gantry, for the number of states between samples.
const FAST: Bars = Bars { lengths: [1.0, 0.5], width: 0.0 };

/// Greatest number of checkpoints of a plan. Before hairpins were considered, millions of steps of motions were tried.
const MOST_CHECKPOINTS: usize = 6000;

fn gantry(jerk: f64) -> Scene {
    let joint = |name: &str, direction: Point, upper: f64| Joint {
        jerk: Some(jerk),
        ..Joint::sliding(name, direction.into(), 0.0, upper).at_most(1.0, 4.0)
    };
    let joints = [joint("bridge", [1.0, 0.0], 2.0), joint("head", [0.0, 1.0], 1.5)];
    let links = ["bridge", "head"].map(|name| Link::bar(name, 0.05, 0.05).expect("a link"));
    Scene::new(Arm::new(joints, links, [0.05, 0.05]), Workspace::new(vec![])).expect("a scene")
}

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
    let piece = |(curve, k): (Curve, usize)| Piece {
        curve,
        speed: None,
        is_travel: false,
        dwell: None,
        source: Source::of_line(k),
    };
    let pieces = spline(&through).expect("a spline").into_iter().map(piece).collect();
    let line = Toolpath::new(pieces).expect("a line");
    let scene = gantry(50.0);
    let mut narrow = f64::INFINITY;
    for tolerance in [1e-4, 1e-3, 5e-3] {
        let (found, checkpoints) = counted(&scene, &line, &Settings { tolerance, ..Settings::default() });
        let trajectory = &found.timed.trajectory;
        assert!(found.deviation <= tolerance, "{tolerance}: {}", found.deviation);
        assert!(checkpoints < MOST_CHECKPOINTS, "{tolerance}: {checkpoints}");
        narrow = narrow.min(trajectory.duration());
        assert!(trajectory.duration() < 1.01 * narrow, "{tolerance}: {} {narrow}", trajectory.duration());
        let step = tolerance / 2.0;
        let states = played(&FAST, trajectory, step);
        let tips: Vec<Point> = states.iter().map(|state| [0, 1].map(|k| ORIGIN[k] + state.position[k])).collect();
        assert!(pass_together(&tips, &points(&line, step), found.deviation + step), "{tolerance}");
    }
}
