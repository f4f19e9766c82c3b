//! Tests of motions along lines. Each answer is compared with checks that share no code with the crate.

mod course;
mod random;
mod smooth;
mod tiny;
mod wrist;

use cplan_follow::{Cause, FollowError, Found, Infeasible, Settings, follow, follow_between};
use cplan_model::space::Configuration;
use cplan_model::{Arm, Joint, Link, Obstacle, Outcome, Scene, Workspace};
use cplan_testkit::follow_oracle::{Bars, Point, State, pass_together, played, points};
use cplan_toolpath::{Curve, Format, Piece, Placement, Source, Toolpath, read};

const BARS: Bars = Bars { lengths: [1.0, 0.8], width: 0.06 };

/// A scene of the arm on joints from -`limit` to `limit`, with speeds of 2 rad/s and accelerations of 10 rad/s2.
pub fn scene_of(bars: Bars, limit: f64, obstacles: Vec<Obstacle>) -> Scene {
    let joint = |name: &str| Joint::turning(name, -limit, limit).at_most(2.0, 10.0);
    let link = |name: &str, length: f64| Link::bar(name, length, bars.width).expect("a link");
    let links = [link("upper arm", bars.lengths[0]), link("forearm", bars.lengths[1])];
    let arm = Arm::new([joint("shoulder"), joint("elbow")], links, bars.lengths);
    Scene::new(arm, Workspace::new(obstacles)).expect("a scene")
}

/// The tip's position of the gantry with both joints at 0.
pub const ORIGIN: Point = [0.1, 0.0];

/// Bars whose tip moves at least as fast as that of the gantry, for the number of states between samples.
pub const FAST: Bars = Bars { lengths: [1.0, 0.5], width: 0.0 };

/// Returns an empty gantry, with limits on jerks or without.
pub fn gantry(jerk: Option<f64>) -> Scene {
    let joint = |name: &str, direction: Point, upper: f64| Joint {
        jerk,
        ..Joint::sliding(name, direction.into(), 0.0, upper).at_most(1.0, 4.0)
    };
    let joints = [joint("bridge", [1.0, 0.0], 2.0), joint("head", [0.0, 1.0], 1.5)];
    let links = ["bridge", "head"].map(|name| Link::bar(name, 0.05, 0.05).expect("a link"));
    Scene::new(Arm::new(joints, links, [0.05, 0.05]), Workspace::new(vec![])).expect("a scene")
}

/// Returns the positions of the gantry's tip, less than a step apart.
pub fn gantry_tips(found: &Found, step: f64) -> Vec<Point> {
    let states = played(&FAST, &found.timed.trajectory, step);
    states.iter().map(|state| [0, 1].map(|k| ORIGIN[k] + state.position[k])).collect()
}

/// Returns a stroke of a line, from a line of a file.
pub fn stroke(curve: Curve, line: usize) -> Piece {
    Piece { curve, speed: None, is_travel: false, dwell: None, source: Source::of_line(line) }
}

/// Returns a line of strokes.
pub fn toolpath(curves: Vec<(Curve, usize)>) -> Toolpath {
    Toolpath::new(curves.into_iter().map(|(curve, k)| stroke(curve, k)).collect()).expect("a line")
}

fn line(text: &str) -> Toolpath {
    read(format!("G21 {text}").as_bytes(), Format::GCode, &Placement::default()).expect("a line")
}

fn found(scene: &Scene, line: &Toolpath, settings: &Settings) -> Found {
    match follow(scene, line, settings).expect("usable settings") {
        Outcome::Found(found) => found,
        other => panic!("{other:?}"),
    }
}

fn infeasible(scene: &Scene, line: &Toolpath) -> Infeasible {
    match follow(scene, line, &Settings::default()).expect("usable settings") {
        Outcome::Infeasible(proof) => proof,
        other => panic!("{:?}", other.status()),
    }
}

/// Checks the played motion by dense samples: the distance from the line in its order, and the limits. Returns the
/// greatest speed of the tip.
pub fn check(bars: &Bars, scene: &Scene, line: &Toolpath, settings: &Settings, found: &Found) -> f64 {
    let tolerance = settings.tolerance;
    assert!(found.deviation <= tolerance, "{}", found.deviation);
    let step = tolerance / 8.0;
    let states = played(bars, &found.timed.trajectory, step);
    let tips: Vec<Point> = states.iter().map(|state| bars.tip(state.position)).collect();
    // Between samples both curves move by at most a step more.
    assert!(pass_together(&tips, &points(line, step), found.deviation + step), "the tip leaves the line");
    let mut fastest = 0.0_f64;
    for (pair, tips) in states.windows(2).zip(tips.windows(2)) {
        for (k, joint) in scene.arm().joints.iter().enumerate() {
            assert!(joint.range.contains(pair[0].position[k]), "{:?}", pair[0]);
            assert!(pair[0].velocity[k].abs() <= joint.velocity * (1.0 + 1e-9), "{:?}", pair[0]);
            assert!(pair[0].acceleration[k].abs() <= joint.acceleration * (1.0 + 1e-6), "{:?}", pair[0]);
        }
        let speed = (tips[1][0] - tips[0][0]).hypot(tips[1][1] - tips[0][1]) / (pair[1].time - pair[0].time);
        fastest = fastest.max(speed);
    }
    fastest
}

#[test]
fn lines_of_all_shapes_are_followed() {
    let scene = scene_of(BARS, 3.0, vec![]);
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' width='1000mm' height='1000mm' viewBox='0 0 1000 1000'>\
               <path d='M 700 800 C 900 500 1000 900 800 400 S 600 300 700 700'/></svg>";
    let curve = cplan_drawing::read_line(svg.as_bytes(), &Placement::default()).expect("a line");
    // The ends of the last two arcs are not equally far from their centres, so that these are spirals.
    for (line, tolerance) in [
        (line("G0 X1200 Y0\nG3 I-200\nG2 X1000 Y-200 R200"), 1e-5),
        (curve, 1e-5),
        (line("G0 X1200 Y0\nG3 X1000 Y-200.19 I-200\nG2 X1040.003 Y-200.19 I20"), 2e-5),
    ] {
        let settings = Settings { tolerance, ..Settings::default() };
        check(&BARS, &scene, &line, &settings, &found(&scene, &line, &settings));
    }
    let line = line("G0 X900 Y-500\nG1 Y700");
    let found = found(&scene, &line, &Settings::default());
    let fastest = check(&BARS, &scene, &line, &Settings::default(), &found);
    // The tip is far faster than if the arm stopped between the parts of the line.
    assert!(fastest > 1.0 && found.timed.trajectory.duration() < 1.5, "{fastest}");
    assert!(found.changes.is_empty());
}

#[test]
fn corners_are_passed_within_the_tolerance_without_a_stop() {
    let (scene, line) = (scene_of(BARS, 3.0, vec![]), line("G0 X900 Y0\nG1 X1100\nY200\nX900 Y195\nX910 Y300"));
    let loose = Settings { tolerance: 2e-3, ..Settings::default() };
    let motions = [Settings::default(), loose].map(|settings| {
        let found = found(&scene, &line, &settings);
        check(&BARS, &scene, &line, &settings, &found);
        found.timed.trajectory
    });
    // A wider tolerance makes corners faster.
    assert!(motions[1].duration() < 0.97 * motions[0].duration(), "{}", motions[1].duration());
    let stops = |at: &Point| at[0].hypot(at[1]) < 1e-9;
    assert_eq!(motions[1].velocity.iter().filter(|v| stops(v)).count(), 2, "it stops only at its ends");
}

/// Returns the times at which a trajectory rests, and for how long, seconds. A stop of a sample lasts no time.
fn rests(trajectory: &cplan_motion::Trajectory) -> Vec<(f64, Point)> {
    let is_still = |v: &Point| v[0].hypot(v[1]) < 1e-9;
    let mut rests: Vec<(f64, Point)> = Vec::new();
    for (k, (time, q)) in trajectory.time.iter().zip(&trajectory.position).enumerate() {
        match rests.last_mut() {
            Some((length, at)) if is_still(&trajectory.velocity[k]) && at == q => {
                *length += time - trajectory.time[k - 1]
            }
            _ if is_still(&trajectory.velocity[k]) => rests.push((0.0, *q)),
            _ => {}
        }
    }
    rests
}

/// The line goes straight on at its dwells, with and without limits on jerks. Two of them are 20 nm apart.
#[test]
fn the_tip_rests_at_dwells() {
    let line = line(
        "G0 X900 Y0\nG1 X1000 F6000\nG4 P0.75\nG1 X1100\nG4 P0\nG1 X1200\nG4 P0.25\nG1 X1200.00002\nG4 P0.25\nG3 X1200 Y100 J50",
    );
    for jerk in [None, Some(200.0)] {
        let mut scene = scene_of(BARS, 3.0, vec![]);
        if let Some(jerk) = jerk {
            let mut arm = scene.arm().clone();
            arm.joints.iter_mut().for_each(|joint| joint.jerk = Some(jerk));
            scene = Scene::new(arm, Workspace::new(vec![])).expect("a scene");
        }
        let found = found(&scene, &line, &Settings::default());
        check(&BARS, &scene, &line, &Settings::default(), &found);
        let rests = rests(&found.timed.trajectory);
        for (seconds, x) in [(0.75, 1.0), (0.0, 1.1), (0.5, 1.2)] {
            let is_there = |(length, q): &&(f64, Point)| {
                let tip = BARS.tip(*q);
                (length - seconds).abs() < 1e-6 && (tip[0] - x).hypot(tip[1]) < 1e-5
            };
            assert_eq!(rests.iter().filter(is_there).count(), 1, "{jerk:?} {seconds}: {rests:?}");
        }
    }
}

#[test]
fn a_place_out_of_reach_is_named() {
    let (scene, line) = (scene_of(BARS, 3.0, vec![]), line("G0 X900 Y0\nG1 X1500\nG1 X1900"));
    let proof = infeasible(&scene, &line);
    let Cause::OutOfReach { by } = proof.cause else { panic!("{proof:?}") };
    assert!(proof.place.piece == 1 && proof.place.source.line == 3, "{:?}", proof.place);
    assert!((proof.place.point.x - 1.8 - by).abs() < 1e-9 && by > 1e-5);
    // The inner circle is out of reach as well.
    let line = self::line("G0 X300 Y0\nG1 X0 Y100");
    assert!(matches!(infeasible(&scene, &line).cause, Cause::OutOfReach { .. }));
}

fn block(name: &str, [x, y]: Point, [w, h]: Point) -> Obstacle {
    Obstacle::polygon(name, [[x, y], [x + w, y], [x + w, y + h], [x, y + h]]).expect("a polygon")
}

#[test]
fn an_obstacle_leaves_one_solution() {
    // The elbow above the line is in the block, and the elbow below is free.
    let scene = scene_of(BARS, 3.0, vec![block("shelf", [0.2, 0.45], [0.6, 0.3])]);
    let line = line("G0 X1000 Y-200\nG1 Y200");
    let found = found(&scene, &line, &Settings::default());
    check(&BARS, &scene, &line, &Settings::default(), &found);
    assert!(found.timed.trajectory.position.iter().all(|q| q[1] > 0.0), "the elbow is below the line");
}

#[test]
fn joint_limits_are_named() {
    // With joint 1 within half a radian, the tip cannot be above the base.
    let scene = scene_of(BARS, 0.5, vec![]);
    let proof = infeasible(&scene, &line("G0 X1700 Y0\nG1 X1000 Y1000"));
    let (Cause::Excluded(list) | Cause::NoChange(list)) = &proof.cause else { panic!("{proof:?}") };
    assert!(list.iter().all(|exclusion| exclusion.describe(&scene).contains("outside its limits")), "{list:?}");
}

/// A scene in which the elbow cannot be far above the line, and joint 1 not far below the x axis.
fn lopsided() -> Scene {
    let mut arm = scene_of(BARS, 3.0, vec![]).arm().clone();
    let ranges = [(-0.2, 3.0), (-1.0, 3.0)];
    for (joint, (lower, upper)) in arm.joints.iter_mut().zip(ranges) {
        *joint = Joint::turning(&joint.name, lower, upper).at_most(2.0, 10.0);
    }
    Scene::new(arm, Workspace::new([])).expect("a scene")
}

/// The beginning allows only the elbow below the line, and the end only the elbow above. Between them the line touches
/// the reach of the arm, where both solutions meet.
#[test]
fn the_solution_changes_at_full_stretch() {
    let (scene, line) = (lopsided(), line("G0 X808.1 Y1018.3\nG1 X1579.648 Y862.965\nG1 X1650 Y0"));
    for settings in [Settings::default(), Settings { tolerance: 1e-4, ..Settings::default() }] {
        let found = found(&scene, &line, &settings);
        check(&BARS, &scene, &line, &settings, &found);
        let [change] = found.changes[..] else { panic!("{:?}", found.changes) };
        assert!(change.point.norm() > 1.7999 && (change.distance - 0.787).abs() < 1e-3, "{change:?}");
        let positions = &found.timed.trajectory.position;
        assert!(positions[0][1] > 0.5 && positions[positions.len() - 1][1] < -0.5, "the elbow changes its side");
    }
}

#[test]
fn no_change_of_the_solution_is_possible_away_from_full_stretch() {
    let (scene, line) = (lopsided(), line("G0 X808.1 Y1018.3\nG1 X1540 Y840\nG1 X1650 Y0"));
    let proof = infeasible(&scene, &line);
    let Cause::NoChange(list) = &proof.cause else { panic!("{proof:?}") };
    let words: Vec<String> = list.iter().map(|exclusion| exclusion.describe(&scene)).collect();
    assert!(words.iter().any(|text| text.contains("\"shoulder\" would be")), "{words:?}");
    assert!(words.iter().any(|text| text.contains("\"elbow\" would be")), "{words:?}");
    assert_ne!(list[0].solution, list[1].solution);
}

#[test]
fn the_tip_is_slow_near_full_stretch() {
    let scene = scene_of(BARS, 3.0, vec![]);
    let near = line("G0 X1799 Y-400\nG1 Y400");
    let near_error = infeasible(&scene, &near);
    assert!(matches!(near_error.cause, Cause::OutOfReach { .. }));
    let radial = line("G0 X1000 Y0\nG1 X1799.99");
    let found = found(&scene, &radial, &Settings::default());
    let fastest = check(&BARS, &scene, &radial, &Settings::default(), &found);
    let states = played(&BARS, &found.timed.trajectory, 1e-5);
    let slow = states.windows(2).filter(|pair| {
        let [x, y] = BARS.tip(pair[0].position);
        (1.79..1.7995).contains(&x.hypot(y))
    });
    let speed = |pair: &[State]| {
        let [a, b] = [0, 1].map(|k| BARS.tip(pair[k].position));
        (b[0] - a[0]).hypot(b[1] - a[1]) / (pair[1].time - pair[0].time)
    };
    let near_stretch = slow.map(speed).fold(0.0, f64::max);
    assert!(near_stretch < 0.5 * fastest, "{near_stretch} {fastest}");
}

#[test]
fn the_speed_of_the_tip_is_kept() {
    let scene = scene_of(BARS, 3.0, vec![]);
    // 20 mm/s and then 50 mm/s.
    let line = line("G0 X1000 Y0\nG1 X1020 F1200\nY50 F3000\nX1000");
    let settings = Settings::default();
    let found = found(&scene, &line, &settings);
    let fastest = check(&BARS, &scene, &line, &settings, &found);
    assert!(fastest <= 0.05 * (1.0 + 1e-6) && fastest > 0.049, "{fastest}");
    let states = played(&BARS, &found.timed.trajectory, 1e-6);
    for pair in states.windows(2) {
        let [a, b] = [0, 1].map(|k| BARS.tip(pair[k].position));
        let speed = (b[0] - a[0]).hypot(b[1] - a[1]) / (pair[1].time - pair[0].time);
        assert!(b[1] > 2e-5 || speed <= 0.02 * (1.0 + 1e-4), "{speed} at {a:?}");
    }
    // 20 mm at 20 mm/s and 70 mm at 50 mm/s.
    let duration = found.timed.trajectory.duration();
    assert!((2.4..2.45).contains(&duration), "{duration}");
    let own = self::found(&scene, &line, &Settings { speed: Some(0.01), ..settings });
    assert!((9.0..9.1).contains(&own.timed.trajectory.duration()));
}

#[test]
fn jerks_are_limited() {
    let mut scene = scene_of(BARS, 3.0, vec![]);
    scene.arm_mut().joints.iter_mut().for_each(|joint| joint.jerk = Some(100.0));
    let line = line("G0 X1000 Y-200\nG1 Y200\nG3 X900 Y300 I-100\nG1 X800 Y200");
    let settings = Settings { tolerance: 1e-4, ..Settings::default() };
    let found = found(&scene, &line, &settings);
    check(&BARS, &scene, &line, &settings, &found);
    let states = played(&BARS, &found.timed.trajectory, 1e-5);
    for pair in states.windows(2) {
        let step = pair[1].time - pair[0].time;
        for k in 0..2 {
            let change = (pair[1].acceleration[k] - pair[0].acceleration[k]).abs();
            assert!(change <= 100.0 * step * (1.0 + 1e-3) + 1e-3, "{change} in {step}");
        }
    }
    assert!(found.timed.trajectory.duration() < 6.0, "{}", found.timed.trajectory.duration());
}

/// Arms that slide along one axis or both, with their kinematics written out: the tip for joint values.
#[test]
fn arms_that_slide_follow_lines() {
    type Tip = fn(Point) -> Point;
    let slide = |name: &str, direction: Point| Joint::sliding(name, direction.into(), -1.5, 1.5).at_most(1.0, 5.0);
    let turn = |name: &str| Joint::turning(name, -3.0, 3.0).at_most(2.0, 10.0);
    let arms: [([Joint; 2], Tip); 3] = [
        ([turn("turn"), slide("slide", [1.0, 0.0])], |[a, b]| [(1.4 + b) * a.cos(), (1.4 + b) * a.sin()]),
        ([slide("slide", [1.0, 0.0]), turn("turn")], |[a, b]| [a + 0.8 + 0.6 * b.cos(), 0.6 * b.sin()]),
        ([slide("x", [1.0, 0.0]), slide("y", [0.0, 1.0])], |[a, b]| [a + 1.4, b]),
    ];
    let line = line("G0 X900 Y0\nG1 X1100 Y150\nG2 X1300 Y150 R150\nG1 X1200 Y-200\nX1000 Y-150");
    for (joints, tip) in arms {
        let links = [Link::bar("first", 0.8, 0.06), Link::bar("second", 0.6, 0.06)].map(|link| link.expect("a link"));
        let arm = Arm::new(joints, links, [0.8, 0.6]);
        let scene = Scene::new(arm, Workspace::new([block("crate", [0.9, 0.75], [0.3, 0.3])])).expect("a scene");
        let settings = Settings::default();
        let found = self::found(&scene, &line, &settings);
        let step = settings.tolerance / 8.0;
        // These bars only bound the speed of the tip.
        let bars = Bars { lengths: [3.0, 1.0], width: 0.0 };
        let tips: Vec<Point> =
            played(&bars, &found.timed.trajectory, step).iter().map(|state| tip(state.position)).collect();
        assert!(pass_together(&tips, &points(&line, step), found.deviation + step), "{}", scene.arm().kind());
        let away = self::line("G0 X900 Y0\nG1 X900 Y3500");
        let proof = infeasible(&scene, &away);
        let beyond = matches!(proof.cause, Cause::OutOfReach { .. } | Cause::Excluded(_) | Cause::NoChange(_));
        assert!(beyond && proof.place.source.line == 2, "{}: {proof:?}", scene.arm().kind());
    }
}

#[test]
fn unusable_settings_are_refused() {
    let (scene, line) = (scene_of(BARS, 3.0, vec![]), line("G0 X900 Y0\nG1 X1000"));
    for tolerance in [0.0, -1.0, 1e-7, f64::NAN, f64::INFINITY] {
        let answer = follow(&scene, &line, &Settings { tolerance, ..Settings::default() });
        assert!(matches!(answer, Err(FollowError::Tolerance(_))), "{tolerance}");
    }
    let answer = follow(&scene, &line, &Settings { period: 0.0, ..Settings::default() });
    assert!(matches!(answer, Err(FollowError::Timing(_))));
}

/// Follows a line between all pairs of IK solutions at its ends. The line stays away from full stretch, so the solution
/// stays the same.
#[test]
fn motions_begin_and_end_as_asked() {
    let scene = scene_of(BARS, 3.0, vec![]);
    let (line, settings) = (line("G0 X1000 Y-200\nG1 Y200\nG1 X800 Y300"), Settings::default());
    let [starts, ends] =
        [line.start(), line.end()].map(|point| BARS.solutions(point).expect("within reach").map(Configuration::from));
    for (from, start) in starts.into_iter().enumerate() {
        for (to, end) in ends.into_iter().enumerate() {
            let answer = follow_between(&scene, &line, &settings, [start, end]).expect("usable settings");
            if from == to {
                let Outcome::Found(found) = answer else { panic!("{answer:?}") };
                check(&BARS, &scene, &line, &settings, &found);
                let positions = &found.timed.trajectory.position;
                assert_eq!(Configuration::from(positions[0]), start);
                assert!((Configuration::from(positions[positions.len() - 1]) - end).amax() < 1e-9);
            } else {
                let Outcome::Infeasible(why) = answer else { panic!("{answer:?}") };
                assert!(why.contains("cannot change"), "{why}");
            }
        }
    }
    // A configuration that is no IK solution of the line's start.
    let elsewhere = starts[0] + Configuration::new(0.1, 0.0);
    let answer = follow_between(&scene, &line, &settings, [elsewhere, ends[0]]).expect("usable settings");
    assert!(matches!(answer, Outcome::Unknown(_)), "{answer:?}");
}

/// Slows down the joints, and the tip on travels as well.
#[test]
fn shares_of_speeds_are_kept() {
    let (scene, line) = (scene_of(BARS, 3.0, vec![]), line("G0 X1000 Y-200\nG1 Y200\nG0 X800 Y300\nG1 X900"));
    let half = Settings { share: 0.5, tip_speed: Some(0.2), ..Settings::default() };
    let found = found(&scene, &line, &half);
    let fastest = check(&BARS, &scene, &line, &half, &found);
    assert!(fastest <= 0.2 * (1.0 + 1e-6) && fastest > 0.19, "{fastest}");
    let states = played(&BARS, &found.timed.trajectory, 1e-4);
    let greatest = |of: fn(&State) -> Point| states.iter().flat_map(of).map(f64::abs).fold(0.0, f64::max);
    assert!(greatest(|state| state.acceleration) <= 2.5 * (1.0 + 1e-6));
    assert!(greatest(|state| state.velocity) <= 1.0);
}
