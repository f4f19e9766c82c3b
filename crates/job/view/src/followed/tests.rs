//! Tests against values that follow from the construction of the cases, and against brute force.

use super::limits::ActiveLimit;
use super::solutions::other_solution;
use super::{Played, Tracker, active_limits, solutions, stops, stretches};
use cplan_handling::Piece;
use cplan_model::space::Configuration;
use cplan_model::{Arm, Obstacle, Scene, Workspace};
use cplan_motion::Trajectory;
use cplan_toolpath::{Curve, Format, Placement, Toolpath, read};

fn q(a: f64, b: f64) -> Configuration {
    Configuration::new(a, b)
}

fn line(text: &str) -> Toolpath {
    read(text.as_bytes(), Format::GCode, &Placement::default()).unwrap()
}

/// An arm whose joints have the speed limits 1 and 2, the acceleration limits 4 and 8, and jerk limits if asked.
fn arm(jerk: Option<f64>) -> Arm {
    let mut arm = Arm::rr([1.0, 0.8], 0.06).unwrap();
    for (joint, factor) in arm.joints.iter_mut().zip([1.0, 2.0]) {
        (joint.velocity, joint.acceleration, joint.jerk) = (factor, 4.0 * factor, jerk.map(|jerk| jerk * factor));
    }
    arm
}

/// Returns the quadratic motion from `at` with a velocity and an acceleration.
fn quadratic(at: Configuration, velocity: Configuration, acceleration: Configuration, duration: f64) -> Piece {
    let end = at + velocity * duration + acceleration * (duration * duration / 2.0);
    Piece::hermite(0.0, duration, [at, velocity], [end, velocity + acceleration * duration])
}

#[test]
fn each_limit_is_recognised_from_98_per_cent_on() {
    let (arm, bent) = (arm(None), q(0.0, 1.5));
    let one = |velocity, acceleration| quadratic(bent, velocity, acceleration, 0.01);
    let cases = [
        (one(q(0.985, 0.0), q(0.0, 0.0)), ActiveLimit::JointSpeed(0)),
        (one(q(0.0, -1.97), q(0.0, 0.0)), ActiveLimit::JointSpeed(1)),
        (one(q(0.975, -1.95), q(0.0, 0.0)), ActiveLimit::None),
        (one(q(0.1, 0.0), q(-3.95, 7.5)), ActiveLimit::JointAcceleration(0)),
        (one(q(0.1, 0.0), q(3.9, 7.9)), ActiveLimit::JointAcceleration(1)),
        // A joint at top speed cannot be faster with any acceleration.
        (one(q(1.0, 0.0), q(-4.0, 0.0)), ActiveLimit::JointSpeed(0)),
        (one(q(0.5, 0.5), q(1.0, 1.0)), ActiveLimit::None),
    ];
    for (piece, expected) in cases {
        assert_eq!(active_limits(&arm, &[piece], &[None]), [expected], "{piece:?}");
    }
}

#[test]
fn the_tip_reaches_its_speed_limit() {
    // With joint 2 at rest, the tip moves on a circle about the base: its speed is the radius times that of joint 1.
    let (arm, bent) = (arm(None), q(0.3, 1.2));
    let radius = (1.0_f64 + 0.64 + 2.0 * 0.8 * 1.2_f64.cos()).sqrt();
    let piece = quadratic(bent, q(0.1, 0.0), q(0.0, 0.0), 0.01);
    for (limit, expected) in [(0.1 * radius * 1.01, ActiveLimit::TipSpeed), (0.1 * radius * 1.03, ActiveLimit::None)] {
        assert_eq!(active_limits(&arm, &[piece], &[Some(limit)]), [expected], "{limit}");
    }
}

#[test]
fn jerks_count_if_they_are_limited() {
    // Acceleration from 0 to 0.5 rad/s2 in 0.01 s: 50 rad/s3.
    let (rest, end) = (q(0.0, 1.5), q(50.0 * 1e-6 / 6.0, 1.5));
    let last = [end, q(50.0 * 1e-4 / 2.0, 0.0), q(0.5, 0.0)];
    let piece = Piece::quintic(0.0, 0.01, [rest, q(0.0, 0.0), q(0.0, 0.0)], last);
    for (limit, expected) in
        [(Some(50.5), ActiveLimit::JointJerk(0)), (Some(52.0), ActiveLimit::None), (None, ActiveLimit::None)]
    {
        assert_eq!(active_limits(&arm(limit), &[piece], &[None]), [expected], "{limit:?}");
    }
}

#[test]
fn short_stretches_get_the_limit_of_their_neighbours() {
    let ends = [0.0, 1.0, 1.001, 2.0, 3.0];
    let pieces: Vec<Piece> =
        ends.windows(2).map(|pair| Piece::line(pair[0], pair[1], q(0.0, 0.0), q(0.1, 0.0))).collect();
    let limits = [ActiveLimit::TipSpeed, ActiveLimit::None, ActiveLimit::TipSpeed, ActiveLimit::JointSpeed(0)];
    let found = stretches(&pieces, &limits, 0.01);
    let shown: Vec<_> = found.iter().map(|stretch| (stretch.from, stretch.to, stretch.limit)).collect();
    assert_eq!(shown, [(0.0, 2.0, ActiveLimit::TipSpeed), (2.0, 3.0, ActiveLimit::JointSpeed(0))]);
    assert_eq!(stretches(&pieces, &limits, 0.0).len(), 4);
}

#[test]
fn stops_are_samples_at_rest() {
    let trajectory = Trajectory {
        time: vec![0.0, 1.0, 2.0, 3.0],
        position: vec![[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [1.0, 0.5]],
        velocity: vec![[0.0, 0.0], [0.5, 0.0], [0.0, 0.0], [0.0, 0.0]],
        acceleration: vec![[0.0, 0.0]; 4],
        torque: Vec::new(),
        wrist: Vec::new(),
    };
    assert_eq!(stops(&trajectory), [0.0, 2.0, 3.0]);
    // The cubic from 0 to 0.5 with the velocities 0 and 0.5: 0.5 (3 u^2 - 2 u^3) + 0.5 (u^3 - u^2).
    let played = Played::new(&arm(None), &trajectory);
    let expected = 0.5 * (3.0 * 0.25 - 2.0 * 0.125) + 0.5 * (0.125 - 0.25);
    assert!((played.at(0.5)[0] - expected).abs() < 1e-12 && played.duration() == 3.0);
    let all = played.between(0.2, 2.5);
    assert_eq!((all[0], all[all.len() - 1]), (played.at(0.2), played.at(2.5)));
    let [before, after] = [played.before(1.0, 4).next().unwrap(), played.after(1.0, 4).next().unwrap()];
    assert_eq!((before, after), (played.at(0.75), played.at(1.25)));
}

/// Compares the distance from the line with the nearest of many points of the piece, on a line with a corner, an arc, and
/// a return on itself.
#[test]
fn feet_are_nearest_in_the_order_of_the_line() {
    const OFFSET: f64 = 8e-6;
    let given = line("G21 G0 X0 Y0\nG1 X100 F100\nG1 Y50\nG3 X80 Y70 I-20\nG1 X20\nG1 X80\n");
    let mut tracker = Tracker::new(&given, 1e-5);
    let mut seen = Vec::new();
    for (index, piece) in given.pieces().iter().enumerate() {
        // At the corners themselves, the tip would jump from one side of the line to the other.
        for k in 2..=198 {
            let u = f64::from(k) / 200.0;
            let ([x, y], [dx, dy]) = (piece.curve.at(u), piece.curve.derivative(u));
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            let side = sign * OFFSET / dx.hypot(dy);
            let tip = [x - dy * side, y + dx * side];
            let foot = tracker.advance(tip);
            seen.push(foot.piece);
            let own = &given.pieces()[foot.piece].curve;
            let nearest = (0..=100_000).map(|i| away(own, f64::from(i) / 1e5, tip)).fold(f64::INFINITY, f64::min);
            assert!((foot.offset.abs() - nearest).abs() < 1e-6, "{index} {u}: {foot:?} {nearest}");
            if (0.05..=0.95).contains(&u) {
                assert_eq!(foot.piece, index, "{u}");
                assert!((foot.offset - sign * OFFSET).abs() < 1e-9, "{index} {u}: {foot:?}");
            }
        }
    }
    assert!(seen.windows(2).all(|pair| pair[0] <= pair[1]), "the feet never return");
}

fn away(curve: &Curve, u: f64, [x, y]: [f64; 2]) -> f64 {
    let [a, b] = curve.at(u);
    (a - x).hypot(b - y)
}

/// Tests that the tip of each IK solution is on the line, and that the solutions that touch the box are excluded.
#[test]
fn both_solutions_follow_the_line_and_the_colliding_one_is_excluded() {
    let tip = |q: Configuration| [q[0].cos() + 0.8 * (q[0] + q[1]).cos(), q[0].sin() + 0.8 * (q[0] + q[1]).sin()];
    let arm = Arm::rr([1.0, 0.8], 0.06).unwrap();
    let corners = [[0.5, 0.4], [0.9, 0.4], [0.9, 0.8], [0.5, 0.8]];
    let wall = Obstacle::polygon("wall", corners).unwrap();
    let scene = Scene::new(arm, Workspace::new([wall])).unwrap();
    let given = line("G21 G0 X1100 Y-150\nG1 X1300 F100\n");
    let parts = solutions(&scene, &given);
    for part in &parts {
        for q in &part.points {
            let [x, y] = tip(*q);
            assert!((y + 0.15).abs() < 1e-9 && (1.1 - 1e-9..1.3 + 1e-9).contains(&x), "{q:?}");
        }
        // The elbow is above the line if joint 2 bends to the right. Then the upper arm passes the wall.
        assert_eq!(part.is_excluded, part.points[0][1] < 0.0, "{part:?}");
    }
    let mut numbers: Vec<usize> = parts.iter().map(|part| part.solution).collect();
    numbers.dedup();
    assert_eq!(numbers, [0, 1]);
    let free = parts.iter().find(|part| !part.is_excluded).unwrap().points[0];
    let (other, is_excluded) = other_solution(&scene, free).unwrap();
    assert!(is_excluded && (tip(other)[0] - 1.1).abs() < 1e-9 && other[1] < 0.0);
}
