//! Tests of tools that a wrist turns along lines. The oracle plays the written samples with its own polynomials, and compares
//! the tool's angle with directions of short chords of the line.

use super::{BARS, found, line, scene_of, stroke};
use cplan_cases::dice::Dice;
use cplan_follow::{Cause, Exclusion, FollowError, Found, Obstacle, Settings, WristAlong, WristExcess, follow};
use cplan_handling::{ToolAngle, WristGuide, WristJoint};
use cplan_model::Outcome;
use cplan_model::space::JointRange;
use cplan_motion::Trajectory;
use cplan_testkit::follow_oracle::{Bars, Point, pass_together_if};
use cplan_toolpath::{Curve, Piece, Toolpath};
use std::f64::consts::{PI, TAU};

const RANGE: JointRange = JointRange::Interval { lower: -6.0, upper: 6.0 };

fn wrist(angle: ToolAngle, range: JointRange) -> WristAlong {
    let joint = WristJoint { sign: -1.0, zero: 0.4, rest: 0.2, range };
    WristAlong { guide: WristGuide { angle, tolerance: 0.01 }, joint, velocity: 3.0, acceleration: 20.0 }
}

fn settings(wrist: WristAlong) -> Settings {
    Settings { wrist: Some(wrist), tolerance: 1e-4, ..Settings::default() }
}

/// The played state: the tip, the angle of the tool, and values, velocities and accelerations of the three joints.
struct State {
    tip: Point,
    angle: f64,
    is_at_rest: bool,
    joints: [[f64; 3]; 3],
}

/// Plays the samples by cubics, or by polynomials of degree four that also have the accelerations at their beginnings.
fn played(bars: &Bars, wrist: &WristAlong, trajectory: &Trajectory, step: f64, quartic: bool) -> Vec<State> {
    let sample = |k: usize| {
        let [p, v, a] = [&trajectory.position, &trajectory.velocity, &trajectory.acceleration].map(|rows| rows[k]);
        let [wp, wv, wa] = trajectory.wrist[k];
        [[p[0], v[0], a[0]], [p[1], v[1], a[1]], [wp, wv, wa]]
    };
    let mut states = Vec::new();
    for i in 1..trajectory.time.len() {
        let h = trajectory.time[i] - trajectory.time[i - 1];
        let polynomials: Vec<[f64; 5]> = sample(i - 1)
            .into_iter()
            .zip(sample(i))
            .map(|([p, v, a], [q, w, _])| {
                let (off, rate) = (q - p - v * h, w - v);
                if quartic {
                    let (off, rate) = (off - a * h * h / 2.0, rate - a * h);
                    [p, v, a / 2.0, (4.0 * off / h - rate) / h / h, (rate - 3.0 * off / h) / h / h / h]
                } else {
                    [p, v, (3.0 * off / h - rate) / h, (rate - 2.0 * off / h) / h / h, 0.0]
                }
            })
            .collect();
        let reach = bars.lengths[0] + bars.lengths[1];
        let moved = polynomials[..2].iter().map(|c| (1..5).map(|k| c[k].abs() * h.powi(k as i32)).sum::<f64>());
        let moved: f64 = moved.sum();
        let count = (moved * 2.0 * reach / step).ceil().max(8.0) as usize;
        for k in 0..=count {
            let t = h * k as f64 / count as f64;
            let joints: [[f64; 3]; 3] = [0, 1, 2].map(|j| {
                let c = polynomials[j];
                let value = c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * c[4])));
                let rate = c[1] + t * (2.0 * c[2] + t * (3.0 * c[3] + t * 4.0 * c[4]));
                [value, rate, 2.0 * c[2] + t * (6.0 * c[3] + t * 12.0 * c[4])]
            });
            let tip = bars.tip([joints[0][0], joints[1][0]]);
            // The tests' wrist turns clockwise, and its tool points to 0.4 rad with all joints at zero.
            let angle = wrist.joint.zero + joints[0][0] + joints[1][0] - joints[2][0];
            states.push(State { tip, angle, is_at_rest: moved == 0.0, joints });
        }
    }
    states
}

/// A point of a line, with the direction there. At a corner the direction is unknown, and on travels as well.
struct Mark {
    point: Point,
    heading: Option<f64>,
    is_travel: bool,
}

fn marks(line: &Toolpath, step: f64) -> Vec<Mark> {
    let mut marks: Vec<Mark> = Vec::new();
    for piece in line.pieces() {
        let count = (piece.curve.length() / step).ceil().max(2.0) as usize;
        if !marks.is_empty() {
            marks.push(Mark { point: piece.curve.at(0.0), heading: None, is_travel: false });
        }
        for k in 0..=count {
            let u = k as f64 / count as f64;
            let [a, b] = [(u - 1e-5).max(0.0), (u + 1e-5).min(1.0)].map(|u| piece.curve.at(u));
            let heading = Some((b[1] - a[1]).atan2(b[0] - a[0]));
            marks.push(Mark { point: piece.curve.at(u), heading, is_travel: piece.is_travel });
        }
    }
    marks
}

fn turned(by: f64) -> f64 {
    (by + PI).rem_euclid(TAU) - PI
}

/// Checks the played motion by dense samples: the angle of the tool along the line, and the limits of the wrist.
fn check(bars: &Bars, line: &Toolpath, settings: &Settings, found: &Found) {
    let wrist = settings.wrist.expect("a wrist");
    let trajectory = &found.timed.trajectory;
    let bound = found.tool_deviation.expect("a bound");
    assert!(bound <= wrist.guide.tolerance && trajectory.wrist.len() == trajectory.time.len(), "{bound}");
    let step = settings.tolerance / 4.0;
    for quartic in [false, true] {
        let states = played(bars, &wrist, trajectory, step, quartic);
        for joint in states.iter().map(|state| state.joints[2]) {
            let [value, rate, gain] = joint;
            if let JointRange::Interval { lower, upper } = wrist.joint.range {
                assert!((lower - 1e-9..=upper + 1e-9).contains(&value), "{joint:?}");
            }
            assert!(rate.abs() <= wrist.velocity * settings.share * (1.0 + 1e-9), "{joint:?}");
            let most = wrist.acceleration * settings.share * settings.share;
            assert!(gain.abs() <= most * (1.0 + 1e-6), "{joint:?}: {most}");
        }
        match wrist.guide.angle {
            ToolAngle::Fixed(angle) => {
                let off = states.iter().map(|state| turned(state.angle - angle).abs()).fold(0.0, f64::max);
                assert!(off <= bound + 1e-9, "{off}");
            }
            ToolAngle::Tangent(offset) => {
                let marks = marks(line, step);
                // Between two marks, the direction changes by about this.
                let bend = marks.windows(2).filter_map(|pair| Some(turned(pair[1].heading? - pair[0].heading?).abs()));
                let slack = bend.filter(|bend| *bend < 0.5).fold(1e-4, f64::max);
                let follows = |i: usize, j: usize| {
                    let (state, mark) = (&states[i], &marks[j]);
                    let apart = (state.tip[0] - mark.point[0]).hypot(state.tip[1] - mark.point[1]);
                    let is_angle = match mark.heading {
                        _ if mark.is_travel => true,
                        Some(heading) => turned(state.angle - heading - offset).abs() <= bound + slack,
                        None => state.is_at_rest,
                    };
                    // A corner is passed while the arm rests, or within the bound on both sides.
                    let is_corner = mark.heading.is_none() && !state.is_at_rest && {
                        let beside = [j - 1, j + 1].map(|k| (marks[k].heading, marks[k].is_travel));
                        beside.iter().all(|(heading, is_travel)| {
                            *is_travel
                                || heading.is_some_and(|h| turned(state.angle - h - offset).abs() <= bound + slack)
                        })
                    };
                    apart <= found.deviation + step && (is_angle || is_corner)
                };
                assert!(pass_together_if([states.len(), marks.len()], follows), "the tool leaves its angle");
            }
        }
    }
}

#[test]
fn a_fixed_angle_is_kept_everywhere() {
    let (scene, line) =
        (scene_of(BARS, 3.0, vec![]), line("G0 X900 Y-500\nG1 Y300\nG3 X800 Y400 I-100\nG0 X700 Y0\nG1 X900"));
    let settings = settings(wrist(ToolAngle::Fixed(1.0), RANGE));
    let found = found(&scene, &line, &settings);
    assert!(found.tool_deviation.expect("a bound") < 1e-9, "{:?}", found.tool_deviation);
    check(&BARS, &line, &settings, &found);
    // A slower wrist makes the motion slower.
    let slow = WristAlong { velocity: 0.3, acceleration: 1.0, ..settings.wrist.expect("a wrist") };
    let slow = Settings { wrist: Some(slow), ..settings };
    let slower = self::found(&scene, &line, &slow);
    check(&BARS, &line, &slow, &slower);
    assert!(slower.timed.trajectory.duration() > 1.5 * found.timed.trajectory.duration());
}

#[test]
fn the_tool_follows_lines_arcs_and_corners() {
    let scene = scene_of(BARS, 3.0, vec![]);
    let line = line("G0 X900 Y-300\nG1 Y100\nG3 X800 Y200 I-100\nG1 X500\nX505 Y300\nG0 X700 Y0\nG1 X900");
    let settings = settings(wrist(ToolAngle::Tangent(0.3), RANGE));
    let found = found(&scene, &line, &settings);
    check(&BARS, &line, &settings, &found);
    // The arm rests at the corner, and turns on the arc without a stop.
    let trajectory = &found.timed.trajectory;
    let turns = (1..trajectory.time.len()).filter(|&k| trajectory.position[k] == trajectory.position[k - 1]);
    let at_rest: Vec<Point> = turns.map(|k| BARS.tip(trajectory.position[k])).collect();
    let is_at = |tip: &Point, x: f64, y: f64| (tip[0] - x).hypot(tip[1] - y) < 1e-6;
    assert!(!at_rest.is_empty() && at_rest.iter().all(|tip| is_at(tip, 0.5, 0.2)), "{at_rest:?}");
}

/// A corner of less than the tolerance is passed without a stop.
#[test]
fn a_slight_corner_is_passed_without_a_stop() {
    let (scene, line) = (scene_of(BARS, 3.0, vec![]), line("G0 X800 Y0\nG1 X900\nG1 X1000 Y0.8"));
    let settings = settings(wrist(ToolAngle::Tangent(0.0), RANGE));
    let found = found(&scene, &line, &settings);
    check(&BARS, &line, &settings, &found);
    let stops = found.timed.trajectory.velocity.iter().filter(|v| v[0].hypot(v[1]) < 1e-9).count();
    assert_eq!(stops, 2, "it stops only at its ends");
}

/// Back and forth, the joint returns the way it came, although each reversal is half a turn.
#[test]
fn reversals_do_not_wind_up_the_joint() {
    let scene = scene_of(BARS, 3.0, vec![]);
    let line = line("G0 X800 Y0\nG1 X900\nX800\nX900\nX800\nX900\nX800\nX900");
    let range = JointRange::Interval { lower: -3.6, upper: 3.6 };
    let settings = settings(wrist(ToolAngle::Tangent(0.0), range));
    check(&BARS, &line, &settings, &found(&scene, &line, &settings));
}

#[test]
fn limited_jerks_allow_a_fixed_angle_only() {
    let mut scene = scene_of(BARS, 3.0, vec![]);
    scene = scene.changed(|arm, _| arm.joints.iter_mut().for_each(|joint| joint.jerk = Some(100.0)));
    let line = line("G0 X900 Y-200\nG1 Y200\nX800");
    let fixed = settings(wrist(ToolAngle::Fixed(0.0), RANGE));
    check(&BARS, &line, &fixed, &found(&scene, &line, &fixed));
    let slow = WristAlong { velocity: 0.2, acceleration: 1.0, ..fixed.wrist.expect("a wrist") };
    let slow = Settings { wrist: Some(slow), ..fixed };
    check(&BARS, &line, &slow, &found(&scene, &line, &slow));
    let tangent = settings(wrist(ToolAngle::Tangent(0.0), RANGE));
    assert_eq!(follow(&scene, &line, &tangent), Err(FollowError::TangentWithJerk));
}

/// Returns true if a tool can keep its exact angle along a line, by brute force over places 1 mm apart: each IK solution,
/// with each value of the wrist that is possible. At sharp corners and on travels the wrist may turn to any value.
fn passes(bars: &Bars, limit: f64, line: &Toolpath, wrist: &WristAlong) -> bool {
    let JointRange::Interval { lower, upper } = wrist.joint.range else { return true };
    let mut reached: Option<Vec<[f64; 3]>> = None;
    let mut last: Option<f64> = None;
    for mark in marks(line, 1e-3) {
        let Some(heading) = mark.heading else { continue };
        let angle = match wrist.guide.angle {
            ToolAngle::Fixed(angle) => Some(angle),
            ToolAngle::Tangent(offset) => (!mark.is_travel).then_some(heading + offset),
        };
        let turns = || (-2..=2).map(|turn| f64::from(turn) * TAU);
        let arms = bars.solutions(mark.point).into_iter().flatten();
        let arms = arms.flat_map(|q| turns().flat_map(move |a| turns().map(move |b| [q[0] + a, q[1] + b])));
        let arms: Vec<Point> = arms.filter(|q| q.iter().all(|v| v.abs() < limit)).collect();
        let is_free = angle.zip(last).is_none_or(|(a, b)| turned(a - b).abs() > wrist.guide.tolerance);
        last = angle;
        let values = |q: &Point| -> Vec<f64> {
            let Some(angle) = angle else { return vec![f64::NAN] };
            let value = -(angle - wrist.joint.zero - q[0] - q[1]);
            (-6..=6).map(|k| value + f64::from(k) * TAU).filter(|v| (lower..=upper).contains(v)).collect()
        };
        let here: Vec<[f64; 3]> = arms.iter().flat_map(|q| values(q).into_iter().map(|v| [q[0], q[1], v])).collect();
        let next: Vec<[f64; 3]> = match &reached {
            None => here,
            Some(before) => {
                let joins = |a: &[f64; 3], b: &[f64; 3]| {
                    let near = |k: usize| (a[k] - b[k]).abs() < 0.1;
                    near(0) && near(1) && (is_free || (a[2] - b[2]).abs() < 0.3)
                };
                here.into_iter().filter(|a| before.iter().any(|b| joins(a, b))).collect()
            }
        };
        if next.is_empty() {
            return false;
        }
        reached = Some(next);
    }
    true
}

/// The joint's range is too small for the angle with either IK solution.
#[test]
fn a_place_outside_the_range_is_named() {
    let (scene, line) = (scene_of(BARS, 3.0, vec![]), line("G0 X900 Y-300\nG1 Y300"));
    let range = JointRange::Interval { lower: -0.3, upper: 0.3 };
    let wrist = wrist(ToolAngle::Tangent(0.0), range);
    let Ok(Outcome::Infeasible(proof)) = follow(&scene, &line, &settings(wrist)) else { panic!("infeasible") };
    assert!(!passes(&BARS, 3.0, &line, &wrist));
    assert!(
        proof.evidence.iter().any(|exclusion| matches!(exclusion.by, Obstacle::Wrist(WristExcess::Value(..)))),
        "{proof:?}"
    );
    let text: Vec<String> = proof.evidence.iter().map(|exclusion| exclusion.describe(&scene)).collect();
    assert!(text[1].contains("outside its limits from -0.3 to 0.3 rad"), "{text:?}");
}

/// Two circles without a stop turn the tool by two turns, more than the joint's range.
#[test]
fn a_line_that_winds_up_the_joint_is_refused() {
    let scene = scene_of(BARS, 3.0, vec![]);
    let line = line("G0 X1100 Y0\nG3 I-100\nG3 I-100");
    let tangent = wrist(ToolAngle::Tangent(0.0), JointRange::Interval { lower: -5.0, upper: 6.0 });
    let Ok(Outcome::Infeasible(proof)) = follow(&scene, &line, &settings(tangent)) else { panic!("infeasible") };
    assert!(!passes(&BARS, 3.0, &line, &tangent));
    // Other whole turns of the elbow are outside its limits.
    let is_turn = |exclusion: &Exclusion| match exclusion.by {
        Obstacle::Wrist(WristExcess::Turn(turn, _)) => turn > 11.0,
        ref by => *by == Obstacle::Limit(1),
    };
    let Cause::NoChange(list) = &proof.cause else { panic!("{proof:?}") };
    assert!(proof.evidence.iter().all(is_turn) && list.len() == 2, "{proof:?}");
    assert!(
        proof.describe().starts_with("the wrist cannot turn far enough for the tool's angle before 1.104 m"),
        "{}",
        proof.describe()
    );
    let wide = wrist(ToolAngle::Tangent(0.0), JointRange::Interval { lower: -7.0, upper: 7.0 });
    check(&BARS, &line, &settings(wide), &found(&scene, &line, &settings(wide)));
}

fn random_line(dice: &mut Dice) -> Toolpath {
    let (distance, angle) = (dice.within(0.6, 1.5), dice.within(-1.5, 1.5));
    let mut at = [distance * angle.cos(), distance * angle.sin()];
    let mut pieces = Vec::new();
    for k in 0..1 + dice.within(0.0, 4.0) as usize {
        let next = [0, 1].map(|k| at[k] + dice.within(-0.15, 0.15));
        let is_travel = k > 0 && dice.chance(0.15);
        let curve = match dice.within(0.0, 3.0) as u32 {
            0 if !is_travel => Curve::Cubic([at, [at[0] + 0.1, at[1]], [next[0] + 0.02, next[1] + 0.1], next]),
            1 if !is_travel => {
                let radius = dice.within(0.02, 0.15);
                let from = dice.within(0.0, TAU);
                let center = [at[0] - radius * from.cos(), at[1] - radius * from.sin()];
                Curve::Arc {
                    center,
                    radius,
                    from,
                    by: dice.within(-4.0, 4.0),
                    growth: radius * dice.within(-0.05, 0.05),
                }
            }
            _ => Curve::Line { from: at, to: next },
        };
        at = curve.at(1.0);
        let speed = (!is_travel && dice.chance(0.3)).then(|| dice.within(0.05, 0.5));
        pieces.push(Piece { speed, is_travel, ..stroke(curve, k + 1) });
    }
    Toolpath::new(pieces).expect("a line")
}

#[test]
fn random_lines_keep_the_angle_and_the_limits() {
    let mut answers = [0; 3];
    for seed in cplan_cases::seeds(60) {
        let mut dice = cplan_cases::dice(seed);
        let bars = Bars { lengths: [dice.within(0.7, 1.2), dice.within(0.6, 1.2)], width: 0.05 };
        let limit = dice.within(2.0, 6.0);
        let scene = scene_of(bars, limit, vec![]);
        let line = random_line(&mut dice);
        let range = match dice.within(0.0, 3.0) as u32 {
            0 => JointRange::Circle,
            1 => RANGE,
            _ => JointRange::Interval { lower: -dice.within(1.0, 4.0), upper: dice.within(1.0, 4.0) },
        };
        let angle = dice.within(-PI, PI);
        let angle = if dice.chance(0.3) { ToolAngle::Fixed(angle) } else { ToolAngle::Tangent(angle) };
        let wrist =
            WristAlong { velocity: dice.within(0.5, 6.0), acceleration: dice.within(2.0, 60.0), ..wrist(angle, range) };
        let share = if dice.chance(0.3) { 0.5 } else { 1.0 };
        let settings = Settings { share, ..settings(wrist) };
        match follow(&scene, &line, &settings).expect("usable settings") {
            Outcome::Found(found) => {
                answers[0] += 1;
                check(&bars, &line, &settings, &found);
            }
            Outcome::Infeasible(proof) => {
                answers[1] += 1;
                assert!(!passes(&bars, limit, &line, &wrist), "{seed}: brute force passes, but: {proof:?}");
            }
            Outcome::Unknown(why) => {
                println!("{seed}: {why}");
                answers[2] += 1;
            }
        }
    }
    println!("found, infeasible, unknown: {answers:?}");
    assert!(2 * answers[0] > answers.iter().sum::<i32>(), "{answers:?}");
}
