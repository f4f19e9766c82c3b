//! The judge uses the motion that a ROS 2 controller makes of a message. The reference is the controller's own
//! formulas.

use cplan::check::{Limit, limit_violations};
use cplan::input::{load_recording, load_scene};
use cplan::model::Joint;
use cplan::space::{Configuration, Derivative, Interpolation, JointRange, Recording};
use cplan_testkit::arms::rr;
use proptest::prelude::*;
use std::fmt::Write;
use std::path::PathBuf;

/// A point of a message: seconds, and position, velocity and acceleration of both joints.
type Point = (f64, [[f64; 2]; 3]);

/// Returns position, velocity and acceleration at `t` seconds after the first point, as `joint_trajectory_controller`
/// samples them. The coefficients are those of a quintic, a cubic or a line, as in that program's function
/// `Trajectory::interpolate_between_points` for one joint.
fn sampled(before: [f64; 3], after: [f64; 3], span: f64, t: f64, given: usize) -> [f64; 3] {
    let ([p0, v0, a0], [p1, v1, a1]) = (before, after);
    let s = |k: i32| span.powi(k);
    let c = match given {
        3 => [
            p0,
            v0,
            0.5 * a0,
            (-20.0 * p0 + 20.0 * p1 - 3.0 * a0 * s(2) + a1 * s(2) - 12.0 * v0 * s(1) - 8.0 * v1 * s(1)) / (2.0 * s(3)),
            (30.0 * p0 - 30.0 * p1 + 3.0 * a0 * s(2) - 2.0 * a1 * s(2) + 16.0 * v0 * s(1) + 14.0 * v1 * s(1))
                / (2.0 * s(4)),
            (-12.0 * p0 + 12.0 * p1 - a0 * s(2) + a1 * s(2) - 6.0 * v0 * s(1) - 6.0 * v1 * s(1)) / (2.0 * s(5)),
        ],
        2 => [
            p0,
            v0,
            (-3.0 * p0 + 3.0 * p1 - 2.0 * v0 * s(1) - v1 * s(1)) / s(2),
            (2.0 * p0 - 2.0 * p1 + v0 * s(1) + v1 * s(1)) / s(3),
            0.0,
            0.0,
        ],
        _ => [p0, (p1 - p0) / s(1), 0.0, 0.0, 0.0, 0.0],
    };
    let at = |k: i32| t.powi(k);
    [
        c[0] + at(1) * c[1] + at(2) * c[2] + at(3) * c[3] + at(4) * c[4] + at(5) * c[5],
        c[1] + 2.0 * at(1) * c[2] + 3.0 * at(2) * c[3] + 4.0 * at(3) * c[4] + 5.0 * at(4) * c[5],
        2.0 * c[2] + 6.0 * at(1) * c[3] + 12.0 * at(2) * c[4] + 20.0 * at(3) * c[5],
    ]
}

/// Returns a message in YAML with the first `given` of positions, velocities and accelerations.
fn yaml(points: &[Point], given: usize) -> String {
    let mut text = String::from("joint_names: [shoulder, elbow]\npoints:\n");
    for (time, rows) in points {
        let lead = "- ".to_owned();
        let names = ["positions", "velocities", "accelerations"];
        for (k, (name, row)) in names.iter().zip(rows).take(given).enumerate() {
            let lead = if k == 0 { &lead } else { "  " };
            writeln!(text, "{lead}{name}: [{:?}, {:?}]", row[0], row[1]).unwrap();
        }
        writeln!(text, "  time_from_start: {time:?}").unwrap();
    }
    text
}

fn read(text: &str) -> Recording {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let scene = load_scene(root.join("robots/planar_2r.urdf"), &root.join("workspaces/shelf.toml")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("m.yaml");
    std::fs::write(&file, text).unwrap();
    load_recording(&file, &scene).unwrap_or_else(|e| panic!("{e}")).recording
}

fn points() -> impl Strategy<Value = Vec<Point>> {
    let row = || prop::array::uniform2(-1.0..1.0_f64);
    let point = (0.05..1.0_f64, [row(), row(), row()]);
    prop::collection::vec(point, 2..6).prop_map(|mut points| {
        let mut time = 0.0;
        for (step, rows) in &mut points {
            (time, *step) = (time + *step, time);
            rows[1].iter_mut().for_each(|v| *v *= 2.0);
            rows[2].iter_mut().for_each(|a| *a *= 5.0);
        }
        points
    })
}

/// Samples of a piece between two points.
const LOOKS: u32 = 400;

proptest! {
    #![proptest_config(cplan_cases::cases(24))]

    /// Compares what the judge finds with samples of the controller's formula: positions, velocities and accelerations
    /// between all points, and the exceeded limits.
    #[test]
    fn messages_are_judged_as_the_controller_plays_them(points in points(), given in 1..=3_usize) {
        let recording = read(&yaml(&points, given));
        let expected = [Interpolation::Linear, Interpolation::Cubic, Interpolation::Quintic][given - 1];
        prop_assert_eq!(recording.interpolation(), expected);
        let mut greatest = [[0.0_f64; 3]; 2];
        for (k, piece) in recording.pieces().iter().enumerate() {
            let [(from, before), (to, after)] = [points[k], points[k + 1]];
            for i in 0..=LOOKS {
                let u = f64::from(i) / f64::from(LOOKS);
                for joint in 0..2 {
                    let state = |rows: [[f64; 2]; 3]| rows.map(|row| row[joint]);
                    let played = sampled(state(before), state(after), to - from, u * (to - from), given);
                    let of = [Derivative::Position, Derivative::Velocity, Derivative::Acceleration];
                    for (order, (of, played)) in of.into_iter().zip(played).enumerate() {
                        let ours = piece.derivative(of, u)[joint];
                        let size = 1.0 + (to - from).powi(-2) * 100.0;
                        prop_assert!((ours - played).abs() < 1e-12 * size, "{of:?} {ours} {played}");
                        greatest[joint][order] = greatest[joint][order].max(played.abs());
                    }
                }
            }
        }
        // Limits a little above and a little below the greatest observed value.
        let broken = |factor: f64| {
            let mut joints: [Joint; 2] = rr([JointRange::Circle; 2]).joints;
            for (joint, greatest) in joints.iter_mut().zip(greatest) {
                (joint.velocity, joint.acceleration) = (greatest[1] * factor, greatest[2].max(1e-3) * factor);
            }
            let found = limit_violations(&joints, &recording);
            move |joint: usize, limit: Limit| found.iter().any(|e| e.joint == joint && e.limit == limit)
        };
        let (above, below) = (broken(1.001), broken(0.999));
        for joint in 0..2 {
            prop_assert!(!above(joint, Limit::Velocity) && below(joint, Limit::Velocity), "velocity of joint {}", joint);
            if given > 1 {
                prop_assert!(!above(joint, Limit::Acceleration) && below(joint, Limit::Acceleration), "acceleration");
            }
        }
    }
}

/// Checks a dwell of a task whose two points differ in acceleration. A quintic between them moves away and returns.
#[test]
fn a_dwell_with_different_accelerations_counts_as_motion() {
    let still = |time: f64, acceleration: f64| (time, [[0.3, 0.4], [0.0; 2], [acceleration, 0.0]]);
    let recording = read(&yaml(&[still(0.0, -8.0), still(0.5, 8.0)], 3));
    let moved = recording.pieces()[0].at(0.5) - Configuration::new(0.3, 0.4);
    // Halfway (u = 1/2) of -8 t^2 / 2 and the same from the end: -8 h^2 (u^2 - 3 u^3 + 3 u^4 - u^5) / 2 + 8 h^2 (u^3 -
    // 2 u^4 + u^5) / 2.
    assert!(moved[0].abs() < 1e-15, "{moved}");
    let quarter = recording.pieces()[0].at(0.25) - Configuration::new(0.3, 0.4);
    assert!(quarter[0] < -0.01, "{quarter}");
}

#[test]
fn messages_that_no_controller_joins_are_refused() {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let scene = load_scene(root.join("robots/planar_2r.urdf"), &root.join("workspaces/shelf.toml")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("m.yaml");
    let head = "joint_names: [shoulder, elbow]\npoints:\n- {positions: [0, 0], velocities: [0, 0], accelerations: [0, 0], \
                time_from_start: 0}\n";
    for (last, expected) in [
        ("- {positions: [0, 0], velocities: [0, 0], time_from_start: 1}\n", "1 of 2 points have accelerations"),
        ("- {positions: [0, 0], accelerations: [0, 0], time_from_start: 1}\n", "1 of 2 points have velocities"),
        ("- {positions: [0, 0], velocities: [0, 0], accelerations: [0], time_from_start: 1}\n", "has 1 values"),
    ] {
        std::fs::write(&file, format!("{head}{last}")).unwrap();
        let message = load_recording(&file, &scene).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
    std::fs::write(&file, "joint_names: [shoulder, elbow]\npoints:\n- {positions: [0, 0], accelerations: [0, 0]}\n")
        .unwrap();
    let message = load_recording(&file, &scene).unwrap_err().to_string();
    assert!(message.contains("accelerations, but no velocities"), "{message}");
}
