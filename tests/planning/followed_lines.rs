//! Tasks with lines for the tip, compared with dense samples of the played motion.

use crate::random_tasks::record;
use cplan::Outcome;
use cplan::engine::task::{TaskAnswer, plan};
use cplan::engine::{Method, Options};
use cplan::input::{InputError, Overrides, Rules, Source, scene_from};
use cplan::model::{Action, FollowedLine, Task, ToolAngle};
use cplan::motion::Trajectory;
use cplan::space::{Configuration, Recording};
use cplan_cases::dice::Dice;
use cplan_testkit::follow_oracle::{Bars, Point, pass_together, played, points};
use cplan_testkit::replay;
use std::f64::consts::TAU;
use std::fmt::Write;

/// The arm of `robots/planar_2r.urdf`.
const BARS: Bars = Bars { lengths: [1.0, 0.8], width: 0.06 };

/// Returns the task of a world for `robots/planar_2r.urdf`.
fn load(world: &str) -> Result<Task, InputError> {
    load_for("planar_2r", world)
}

/// Returns the task of a world for a shipped robot.
fn load_for(robot: &str, world: &str) -> Result<Task, InputError> {
    let urdf = format!("{}/robots/{robot}.urdf", env!("CARGO_MANIFEST_DIR"));
    let scene = scene_from(Source::read(urdf.as_ref())?, Source::in_memory("world.toml", world))?;
    Ok(scene.resolve(&Overrides::default(), Rules::Plan)?.task.expect("a world with steps"))
}

/// Returns a world with two posts, perhaps an object that is picked first, and lines of all kinds.
pub fn world(dice: &mut Dice) -> String {
    let mut text = String::from("[start]\njoints = [0.3, 1.2]\n");
    let polar = |distance: f64, angle: f64| [distance * angle.cos(), distance * angle.sin()];
    for k in 0..2 {
        let [x, y] = polar(dice.within(0.5, 1.7), dice.within(-3.1, 3.1));
        let radius = dice.within(0.03, 0.12);
        writeln!(text, "[[obstacle]]\nname = \"post {k}\"\ncircle = {{ center = [{x}, {y}], radius = {radius} }}")
            .unwrap();
    }
    let carries = dice.chance(0.4);
    if carries {
        let [x, y] = polar(dice.within(0.9, 1.5), dice.within(-2.0, 2.0));
        writeln!(text, "[[object]]\nname = \"pen\"\ncircle = {{ center = [0, 0], radius = 0.04 }}\nat = [{x}, {y}]")
            .unwrap();
        writeln!(text, "[[step]]\npick = \"pen\"").unwrap();
    }
    for _ in 0..1 + dice.within(0.0, 2.0) as usize {
        let middle = polar(dice.within(0.7, 1.6), dice.within(-2.5, 2.5));
        let count = 3 + dice.within(0.0, 3.0) as u32;
        let size = dice.within(0.02, 0.15);
        let turn = dice.within(0.0, TAU);
        let corner = |k: u32| {
            let by = polar(size, turn + f64::from(k) * TAU / 6.0);
            format!("[{}, {}]", middle[0] + by[0], middle[1] + by[1])
        };
        let corners = (0..count).map(corner).collect::<Vec<_>>().join(", ");
        let line = match dice.within(0.0, 3.0) as u32 {
            0 => format!("points = [{corners}], radius = {}", size / 5.0),
            1 => format!("arc = [{}, {}, {}]", corner(0), corner(1), corner(3)),
            _ => format!("spline = [{corners}]"),
        };
        let speed = if dice.chance(0.5) { format!(", speed = {}", dice.within(0.05, 0.6)) } else { String::new() };
        writeln!(text, "[[step]]\nfollow = {{ {line}{speed}, tolerance = 5e-5 }}\nspeed = {}", dice.within(0.3, 1.0))
            .unwrap();
    }
    if carries {
        writeln!(text, "[[step]]\nplace = {{ at = [0.9, -0.9] }}").unwrap();
    }
    text
}

fn options() -> Options {
    Method::Visibility.into()
}

/// Checks the motions along lines by dense samples: the distance from the line in its order, and the speed of the tip.
fn check_lines(task: &Task, answer: &TaskAnswer, seed: u64) -> usize {
    let mut lines = 0;
    for leg in &answer.legs {
        let Action::Follow(line) = &leg.step.action else { continue };
        lines += 1;
        let deviation = leg.deviation.expect("a bound on the distance");
        assert!(deviation <= line.tolerance, "seed {seed}: {deviation}");
        let step = line.tolerance / 8.0;
        let states = played(&BARS, &leg.timed.trajectory, step);
        let tips: Vec<Point> = states.iter().map(|state| BARS.tip(state.position)).collect();
        assert!(
            pass_together(&tips, &points(&line.path, step), deviation + step),
            "seed {seed}: the tip leaves the line"
        );
        let speeds = states.windows(2).zip(tips.windows(2)).map(|(states, tips)| {
            (tips[1][0] - tips[0][0]).hypot(tips[1][1] - tips[0][1]) / (states[1].time - states[0].time)
        });
        let fastest = speeds.fold(0.0, f64::max);
        assert!(line.speed.is_none_or(|speed| fastest <= speed * (1.0 + 1e-6)), "seed {seed}: {fastest}");
        let least = line.least_seconds();
        assert!(least <= leg.timed.trajectory.duration(), "seed {seed}: {least}");
        for state in &states {
            for (k, joint) in task.arm.joints.iter().enumerate() {
                let most = joint.velocity * leg.step.speed * (1.0 + 1e-9);
                assert!(state.velocity[k].abs() <= most, "seed {seed}: {state:?}");
            }
        }
    }
    lines
}

#[test]
fn tasks_with_lines_have_no_false_answer() {
    let (mut found, mut infeasible, mut unknown, mut lines) = (0_u64, 0_u64, 0_u64, 0);
    for seed in cplan_cases::seeds(80) {
        let Ok(task) = load(&world(&mut cplan_cases::dice(seed))) else { continue };
        let answer = plan(&task, &options(), &mut |_| {});
        match &answer.outcome {
            Outcome::Found(_) => {
                found += 1;
                lines += check_lines(&task, &answer, seed);
                replay::replay(&task, &answer, true).unwrap_or_else(|why| panic!("seed {seed}: {why}"));
                let least = answer.least_seconds();
                assert!(least <= answer.duration(), "seed {seed}: {least}");
                judge(&task, &answer, seed);
            }
            Outcome::Infeasible(_) => infeasible += 1,
            Outcome::Unknown(_) => unknown += 1,
        }
    }
    println!("found {found} with {lines} lines, infeasible {infeasible}, unknown {unknown}");
    assert!(found > 20 && infeasible > 0 && unknown * 5 < found, "{found} {infeasible} {unknown}");
}

/// Checks that the judge accepts the motion, and refuses it if the tip leaves the line.
fn judge(task: &Task, answer: &TaskAnswer, seed: u64) {
    let (recording, steps) = record(answer);
    for (step, leg) in cplan::check::replay(task, &recording, &steps).zip(&answer.legs) {
        assert!(step.faults.is_empty() && step.broken.is_empty(), "seed {seed}: {:?} {:?}", step.faults, step.broken);
        let Action::Follow(line) = &leg.step.action else { continue };
        let samples = step.recorded.samples.clone();
        let middle = (samples.start() + samples.end()) / 2;
        let mut moved = recording.positions().to_vec();
        let [joint, by] = aside(moved[middle - 1], moved[middle + 1]);
        moved[middle][joint as usize] += 4.0 * line.tolerance * by;
        let rows = (recording.times().map(<[f64]>::to_vec), recording.velocities().map(<[Configuration]>::to_vec));
        let moved = Recording::new(moved, rows.0, rows.1).unwrap();
        let index = answer.legs.iter().position(|other| std::ptr::eq(other, leg)).unwrap();
        let refused = cplan::check::replay(task, &moved, &steps).nth(index).expect("the same step");
        let words: Vec<String> = refused.faults.iter().map(ToString::to_string).collect();
        assert!(words.iter().any(|text| text.contains("from the line")), "seed {seed}: {words:?}");
    }
}

/// Returns the joint that moves the tip most across its path, and its displacement for a metre across.
pub fn aside(before: Configuration, after: Configuration) -> [f64; 2] {
    let tip = |q: Configuration| BARS.tip([q[0], q[1]]);
    let [from, to] = [tip(before), tip(after)];
    let length = (to[0] - from[0]).hypot(to[1] - from[1]);
    let across = |joint: usize| {
        let mut moved = before;
        moved[joint] += 1e-6;
        let moved = tip(moved);
        ((to[0] - from[0]) * (moved[1] - from[1]) - (to[1] - from[1]) * (moved[0] - from[0])) / length / 1e-6
    };
    let joint = if across(0).abs() > across(1).abs() { 0 } else { 1 };
    [joint as f64, 1.0 / across(joint)]
}

/// Checks that a line which only one IK solution can follow is reached with that solution.
#[test]
fn the_solution_that_can_follow_the_line_is_chosen() {
    // The post stands where the elbow would be with the other solution.
    let world = "[start]\njoints = [0.6, -1.2]\n[[obstacle]]\nname = \"post\"\n\
                 circle = { center = [0.75, -0.55], radius = 0.1 }\n[[step]]\n\
                 follow = { points = [[1.2, -0.1], [1.2, 0.1]], speed = 0.2 }\n";
    let task = load(world).unwrap_or_else(|error| panic!("{error}"));
    let answer = plan(&task, &options(), &mut |_| {});
    assert!(answer.outcome.found().is_some(), "{:?}", answer.failed());
    assert_eq!(check_lines(&task, &answer, 0), 1);
    assert!(answer.legs[1].path().start()[1] < 0.0, "{:?}", answer.legs[1].path().start());
    assert!(answer.gap().is_some_and(|gap| gap < 1.0), "{:?}", answer.gap());
}

#[test]
fn lines_out_of_reach_are_infeasible() {
    let world = "[start]\njoints = [0.3, 1.2]\n[[step]]\nfollow = { points = [[1.5, 0], [1.9, 0]] }\n";
    let task = load(world).unwrap_or_else(|error| panic!("{error}"));
    let answer = plan(&task, &options(), &mut |_| {});
    let Outcome::Infeasible(failed) = &answer.outcome else { panic!("{:?}", answer.outcome.status()) };
    assert_eq!(failed.step.number, 2);
    assert!(failed.reasons.iter().any(|reason| reason.contains("reaches the end of the line")), "{:?}", failed.reasons);
}

#[test]
fn lines_among_moving_obstacles_are_refused() {
    let world = "[start]\njoints = [0.3, 1.2]\n[[obstacle]]\nname = \"cart\"\ncircle = { center = [0, 1], radius = 0.1 }\n\
                 motion = { velocity = [0.1, 0] }\n[[step]]\nfollow = { points = [[1.2, 0], [1.3, 0]] }\n";
    let error = load(world).unwrap_err().to_string();
    assert!(error.contains("\"cart\" moves, and lines can be followed only if all obstacles are static"), "{error}");
}

/// The line is straight in joint space too, and both of its ends are free.
#[test]
fn a_straight_line_that_is_blocked_in_its_middle_is_infeasible() {
    let world = "[start]\njoints = [0.4, 0.7]\n[[step]]\nfollow = { points = [[0.5, 0.9], [1.2, 0.9]] }\n[[obstacle]]\n\
                 polygon = [[0.8, 0.6], [1.0, 0.6], [1.0, 0.7], [0.8, 0.7]]\n";
    let task = load_for("gantry", world).unwrap_or_else(|error| panic!("{error}"));
    let answer = plan(&task, &options(), &mut |_| {});
    let Outcome::Infeasible(failed) = &answer.outcome else { panic!("{:?}", answer.outcome.status()) };
    assert!(failed.reasons.iter().any(|reason| reason.contains("no IK solution is possible")), "{:?}", failed.reasons);
}

/// The whole line is shorter than a hundred times its tolerance.
#[test]
fn a_wide_tolerance_does_not_hide_a_motion() {
    let world = "[start]\njoints = [1.07, 0.03]\n[[step]]\nfollow = { spline = [[0.250785, 0.462893], [0.250249, 0.463919], \
                 [0.249853, 0.46374], [0.250415, 0.464009], [0.249739, 0.463134]], speed = 0.001, tolerance = 1e-3 }\n";
    let task = load_for("polar", world).unwrap_or_else(|error| panic!("{error}"));
    let answer = plan(&task, &options(), &mut |_| {});
    assert!(answer.outcome.found().is_some(), "{:?}", answer.failed());
    assert!(answer.legs[1].deviation.is_some_and(|deviation| deviation <= 1e-3));
}

/// Returns a task for `robots/scara.urdf` with lines along which the tool has an angle, perhaps after an object was placed.
fn wrist_world(dice: &mut Dice) -> String {
    let mut text = String::from(
        "[robot]\njoints = [\"axis_1\", \"axis_2\"]\ntip = \"flange\"\nfixed = { axis_3 = -0.05 }\npayload = \"level\"\n\
         wrist = { joint = \"axis_4\", velocity = 15, acceleration = 150 }\n[start]\njoints = [-0.9, 1.6]\n",
    );
    if dice.chance(0.5) {
        let angle = dice.within(-3.0, 3.0);
        writeln!(
            text,
            "[[object]]\nname = \"pin\"\ncircle = {{ center = [0, 0], radius = 0.01 }}\nheight = [0, 0.02]\nlift = 0.05\n\
             at = [0.1, -0.3]\n[[step]]\npick = \"pin\"\n[[step]]\nplace = {{ at = [0.0, -0.35], angle = {angle} }}"
        )
        .unwrap();
    }
    for _ in 0..1 + dice.within(0.0, 2.0) as usize {
        let (distance, angle) = (dice.within(0.3, 0.45), dice.within(-0.5, 1.5));
        let middle = [distance * angle.cos(), distance * angle.sin()];
        let (count, size, turn) = (3 + dice.within(0.0, 3.0) as u32, dice.within(0.02, 0.06), dice.within(0.0, TAU));
        let corner = |k: u32| {
            let angle = turn + f64::from(k) * TAU / 6.0;
            format!("[{}, {}]", middle[0] + size * angle.cos(), middle[1] + size * angle.sin())
        };
        let corners = (0..count).map(corner).collect::<Vec<_>>().join(", ");
        let line = match dice.within(0.0, 4.0) as u32 {
            0 => format!("points = [{corners}], radius = {}", size / 5.0),
            1 => format!("points = [{corners}]"),
            2 => format!("arc = [{}, {}, {}]", corner(0), corner(1), corner(3)),
            _ => format!("spline = [{corners}]"),
        };
        let angle = dice.within(-3.0, 3.0);
        let wrist = if dice.chance(0.3) { angle.to_string() } else { format!("{{ tangent = {angle} }}") };
        let speed = dice.within(0.4, 1.0);
        writeln!(text, "[[step]]\nfollow = {{ {line}, tolerance = 5e-5, wrist = {wrist} }}\nspeed = {speed}").unwrap();
    }
    text
}

/// Checks by dense samples of the played motion that the tool has its angle at a place of the line near the tip, while the
/// arm moves.
fn check_tool(line: &FollowedLine, trajectory: &Trajectory, seed: u64) {
    let bars = Bars { lengths: [0.3, 0.25], width: 0.0 };
    let guide = line.wrist.expect("an angle of the tool");
    let marks: Vec<(Point, f64)> = line
        .path
        .pieces()
        .iter()
        .flat_map(|piece| {
            let count = (piece.curve.length() / 2e-5).ceil();
            (0..=count as usize).map(move |k| {
                let u = k as f64 / count;
                let [a, b] = [(u - 1e-5).max(0.0), (u + 1e-5).min(1.0)].map(|u| piece.curve.at(u));
                (piece.curve.at(u), (b[1] - a[1]).atan2(b[0] - a[0]))
            })
        })
        .collect();
    for k in (1..trajectory.time.len()).step_by(7) {
        let [a, b] = [k - 1, k];
        if trajectory.position[a] == trajectory.position[b] {
            continue;
        }
        let h = trajectory.time[b] - trajectory.time[a];
        // The middle of a cubic through values and velocities.
        let middle = |p: f64, q: f64, v: f64, w: f64| (p + q) / 2.0 + (v - w) * h / 8.0;
        let q = [0, 1].map(|j| {
            let (position, velocity) = (&trajectory.position, &trajectory.velocity);
            middle(position[a][j], position[b][j], velocity[a][j], velocity[b][j])
        });
        let [from, to] = [trajectory.wrist[a], trajectory.wrist[b]];
        let angle = q[0] + q[1] + middle(from[0], to[0], from[1], to[1]);
        let off = |wanted: f64| ((angle - wanted + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0).abs();
        let tip = bars.tip(q);
        let near = marks.iter().filter(|(point, _)| (point[0] - tip[0]).hypot(point[1] - tip[1]) < 8e-5);
        let least = match guide.angle {
            ToolAngle::Fixed(fixed) => off(fixed),
            ToolAngle::Tangent(offset) => near.map(|(_, heading)| off(heading + offset)).fold(f64::INFINITY, f64::min),
        };
        assert!(least <= guide.tolerance + 1e-3, "seed {seed}: {least} at {tip:?}");
    }
}

#[test]
fn tools_turn_along_the_lines_of_tasks() {
    let (mut found, mut lines) = (0_u64, 0);
    let total = cplan_cases::seeds(30).count() as u64;
    for seed in cplan_cases::seeds(30) {
        let world = wrist_world(&mut cplan_cases::dice(seed));
        let task = load_for("scara", &world).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        let answer = plan(&task, &options(), &mut |_| {});
        if answer.outcome.found().is_none() {
            continue;
        }
        found += 1;
        let (recording, steps) = record(&answer);
        for (step, leg) in cplan::check::replay(&task, &recording, &steps).zip(&answer.legs) {
            let Action::Follow(line) = &leg.step.action else { continue };
            lines += 1;
            assert!(
                step.faults.is_empty() && step.broken.is_empty(),
                "seed {seed}: {:?} {:?}",
                step.faults,
                step.broken
            );
            check_tool(line, &leg.timed.trajectory, seed);
            let index = answer.legs.iter().position(|other| std::ptr::eq(other, leg)).unwrap();
            let mut changed = steps.clone();
            let rows = changed[index].wrist_motion.as_mut().expect("the wrist's motion");
            let middle = rows.len() - 3;
            rows[middle][0] += 0.03;
            let refused = cplan::check::replay(&task, &recording, &changed).nth(index).expect("the same step");
            let words: Vec<String> = refused.faults.iter().map(ToString::to_string).collect();
            assert!(
                words.iter().any(|text| text.contains("the angle of the tool may be wrong by")),
                "seed {seed}: {words:?}"
            );
        }
    }
    println!("found {found} of {total} with {lines} lines");
    assert!(3 * found > 2 * total, "{found}");
}
