//! Certificates of tasks with lines, written by hand, and falsified ones.

use crate::common::robots::gantry;
use crate::common::verdict::{Verdict, agrees, fails, found, holds, judge as judge_certificate, refused};
#[allow(dead_code, reason = "other tests use more of it")]
use cplan_cases::{dice, seeds};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt::Write as _;

/// Robot and start of all worlds.
const HEAD: &str = "robot.bar = 0.01\nrobot.own_body = false\nstart.joints = [0, 1]\n";

/// Content of a world with a line of two pieces.
const ANGLE: &str = "[[step]]\nfollow = { points = [[1, 1], [3, 1], [3, 2]] }\n";

const KNOTS: &str = "[0, 0, 1], [1, 1, 1], [2, 3, 1], [3, 3, 2]";
const MOVE: &str = r#"{"step": 1, "knots": [0, 1]}"#;
const PIECES: &str = r#"{"straight": [[1, 1], [3, 1]]}, {"straight": [[3, 1], [3, 2]]}"#;
const PLACES: &str = "[0, 0], [1, 1], [2, 2]";

/// Returns the entry of a step along a line.
fn line(step: usize, knots: [usize; 2], pieces: &str, places: &str) -> String {
    format!(r#"{{"step": {step}, "knots": {knots:?}, "line": {{"pieces": [{pieces}], "places": [{places}]}}}}"#)
}

/// Checks a certificate whose knots are joined in a way. Returns the exit code and the message.
fn judge_read(world: &str, reading: &str, knots: &str, steps: &str) -> Verdict {
    let certificate = found(&format!(r#""steps": [{steps}],"#), &format!("{reading:?}"), knots);
    judge_certificate(&gantry([-9, 9], r#"box size="0.1 0.1 0.1""#), &format!("{HEAD}{world}"), &certificate)
}

fn judge(world: &str, knots: &str, steps: &str) -> Verdict {
    judge_read(world, "linear", knots, steps)
}

/// Returns the steps of the line of two pieces.
fn both_steps() -> String {
    format!("{MOVE}, {}", line(2, [1, 3], PIECES, PLACES))
}

#[test]
fn a_line_is_two_steps() {
    let report = holds(judge(ANGLE, KNOTS, &both_steps()));
    let words = "; in step 2 the tip follows a line of 2 pieces from (1.000000, 1.000000) to (3.000000, 2.000000), within \
                 0.00001 of the line and in its order";
    assert!(report.contains("does all 2 steps") && report.ends_with(words), "{report}");
    let along = line(2, [1, 3], PIECES, PLACES);
    fails(judge(ANGLE, KNOTS, MOVE), "requires step 2 next");
    fails(judge(ANGLE, KNOTS, &along), "steps[0] is step 2, but the world requires step 1");
    fails(judge(ANGLE, KNOTS, &format!("{along}, {MOVE}")), "steps[0] is step 2");
    // Steps after the line have the next numbers.
    let world = format!("{ANGLE}[[step]]\nmove = {{ joints = [3, 3] }}\n");
    let knots = format!("{KNOTS}, [4, 3, 3]");
    let third = r#"{"step": 3, "knots": [3, 4]}"#;
    holds(judge(&world, &knots, &format!("{}, {third}", both_steps())));
    fails(judge(&world, &knots, &format!("{MOVE}, {third}, {along}")), "steps[1] is step 3");
    fails(judge(&world, &knots, &both_steps()), "requires step 3 next");
}

#[test]
fn the_tip_stays_within_the_tolerance_of_the_world() {
    let with = |tolerance: &str| ANGLE.replace("]] }", &format!("]], tolerance = {tolerance} }}"));
    let off = |by: f64| KNOTS.replace("[2, 3, 1]", &format!("[2, 3, {}]", 1.0 + by));
    holds(judge(ANGLE, &off(9e-6), &both_steps()));
    fails(judge(ANGLE, &off(1.1e-5), &both_steps()), "steps[1], step 2: after knot 1, the tip");
    fails(judge(&with("1e-6"), &off(9e-6), &both_steps()), "within 0.000001 of piece 0");
    holds(judge(&with("1e-4"), &off(9e-5), &both_steps()));
    // The end of the line.
    fails(judge(ANGLE, &KNOTS.replace("[3, 3, 2]", "[3, 3, 1.99]"), &both_steps()), "of piece 1");
    // The certificate cannot replace the tolerance.
    for key in ["\"tolerance\": 1", "\"stretch\": [0, 1]"] {
        let steps = both_steps().replace("\"places\"", &format!("{key}, \"places\""));
        refused(judge(ANGLE, &off(1e-3), &steps), "the \"line\" of a step cannot have a tolerance");
    }
    refused(judge(&with("0"), KNOTS, &both_steps()), "must be positive");
}

#[test]
fn the_line_is_passed_in_its_order() {
    let with = |places: &str| judge(ANGLE, KNOTS, &format!("{MOVE}, {}", line(2, [1, 3], PIECES, places)));
    holds(with("[0, 0], [0.5, 0.5], [1, 1], [2, 2]"));
    fails(with("[0, 0], [1, 1], [2, 1.5]"), "are not the ends of the motion");
    fails(with("[1, 0], [2, 1], [3, 2]"), "are not the ends of the motion");
    fails(with("[0, 0], [0.5, 0.5], [0.75, 0.25], [1, 1], [2, 2]"), "places[2] goes back");
    fails(with("[0, 0], [2, 2]"), "places[1] goes back, or skips");
    // The tip returns to the middle of the first piece on its way.
    let knots = "[0, 0, 1], [1, 1, 1], [2, 2.5, 1], [3, 2, 1], [4, 3, 1], [5, 3, 2]";
    let places = "[0, 0], [1, 0.75], [2, 0.75], [3, 1], [4, 2]";
    fails(judge(ANGLE, knots, &format!("{MOVE}, {}", line(2, [1, 5], PIECES, places))), "after knot 2");
}

#[test]
fn pieces_are_those_of_the_world_if_the_world_states_them() {
    let with = |pieces: &str| judge(ANGLE, KNOTS, &format!("{MOVE}, {}", line(2, [1, 3], pieces, PLACES)));
    let not_of_the_world = "the certificate and the world have different lines for step 2";
    holds(with(&PIECES.replace("[3, 1]", "[3.000000001, 1]")));
    fails(with(&PIECES.replace("[3, 1]", "[3.000001, 1]")), not_of_the_world);
    fails(with(&PIECES.replace("[1, 1]", "[1.000001, 1]")), not_of_the_world);
    fails(with(r#"{"straight": [[1, 1], [3, 1]]}"#), not_of_the_world);
    fails(with(r#"{"straight": [[3, 2], [3, 1]]}, {"straight": [[3, 1], [1, 1]]}"#), not_of_the_world);
    fails(
        with(
            &PIECES.replace(r#"{"straight": [[3, 1], [3, 2]]}"#, r#"{"cubic": [[3, 1], [3, 1.3], [3, 1.6], [3, 2]]}"#),
        ),
        not_of_the_world,
    );
    fails(with(&PIECES.replace("[[3, 1], [3, 2]]", "[[3, 1.01], [3, 2]]")), "piece 1 of the line does not begin");
    // A placed line.
    let placed =
        "[[step]]\nfollow = { points = [[0, 0], [0, -1], [0.5, -1]], scale = 2, turn = \"90deg\", move = [1, 1] }\n";
    holds(judge(placed, KNOTS, &both_steps()));
    for [from, to] in [["scale = 2", "scale = 2.001"], ["90deg", "89.99deg"], ["[1, 1] }", "[1, 1.001] }"]] {
        fails(judge(&placed.replace(from, to), KNOTS, &both_steps()), not_of_the_world);
    }
    holds(judge(&ANGLE.replace("]] }", "]], radius = 0, speed = 0.1 }"), KNOTS, &both_steps()));
}

#[test]
fn other_lines_are_taken_from_the_certificate() {
    for form in [
        "spline = [[1, 1], [3, 1], [3, 2]]",
        "points = [[1, 1], [3, 1], [3, 2]], radius = 0.1",
        "file = \"line.svg\", unit = \"mm\"",
    ] {
        let report = holds(judge(&format!("[[step]]\nfollow = {{ {form} }}\n"), KNOTS, &both_steps()));
        assert!(report.ends_with("in its order, as the certificate states it"), "{report}");
    }
    let world = ANGLE.replace("]] }", "]], wrist = \"tangent\", wrist_tolerance = 0.02 }");
    assert!(holds(judge(&world, KNOTS, &both_steps())).ends_with("; the angle of the tool there is not judged"));
    for (form, part) in [
        (
            "points = [[1, 1], [3, 1]], arc = [[1, 1], [2, 1], [3, 2]]",
            "exactly one of `points`, `arc`, `spline` and `file`",
        ),
        ("speed = 1", "exactly one of `points`, `arc`, `spline` and `file`"),
        ("points = [[1, 1], [3, 1]], feed = 1", "does not know the key feed of a line"),
        ("points = [[1, 1], [3, 1]], unit = \"mm\"", "only a line with `file` has a `unit`"),
        ("spline = [[1, 1], [3, 1]], radius = 1", "only a line with `points` has a `radius`"),
        ("arc = [[1, 1], [3, 1]]", "an arc needs three points"),
    ] {
        refused(judge(&format!("[[step]]\nfollow = {{ {form} }}\n"), KNOTS, &both_steps()), part);
    }
}

#[test]
fn an_arc_passes_its_three_points() {
    // A quarter of the circle of radius 1 about (1, 0), from (1, 1) to the left, in chords.
    let parts = 64;
    let (mut knots, mut places) = (String::from("[0, 0, 1]"), String::new());
    for k in 0..=parts {
        let (sin, cos) = (FRAC_PI_2 + FRAC_PI_2 * f64::from(k) / f64::from(parts)).sin_cos();
        write!(knots, ", [{}, {:?}, {sin:?}]", k + 1, 1.0 + cos).unwrap();
        write!(places, "{}[{k}, {:?}]", if k > 0 { ", " } else { "" }, f64::from(k) / f64::from(parts)).unwrap();
    }
    // A chord is 0.00008 m from its arc.
    let world = |arc: &str, tolerance: &str| format!("[[step]]\nfollow = {{ arc = {arc}, tolerance = {tolerance} }}\n");
    let with = |arc: &str, tolerance: &str, [radius, by]: [f64; 2]| {
        let piece =
            format!(r#"{{"arc": {{"center": [1, 0], "radius": {radius:?}, "from": {FRAC_PI_2:?}, "by": {by:?}}}}}"#);
        judge(&world(arc, tolerance), &knots, &format!("{MOVE}, {}", line(2, [1, parts as usize + 1], &piece, &places)))
    };
    let root = 0.5_f64.sqrt();
    let arc = format!("[[1, 1], [{:?}, {root:?}], [0, 0]]", 1.0 - root);
    let report = holds(with(&arc, "1e-4", [1.0, FRAC_PI_2]));
    assert!(!report.contains("as the certificate states it"), "{report}");
    fails(with(&arc, "5e-5", [1.0, FRAC_PI_2]), "the tip is not proven to stay");
    let not_of_the_world = "the certificate and the world have different lines for step 2";
    fails(with(&arc, "1e-4", [1.0 + 1e-6, FRAC_PI_2]), not_of_the_world);
    fails(with(&arc, "1e-4", [1.0, FRAC_PI_2 + 1e-6]), not_of_the_world);
    // The rest of the circle has the same ends, and a whole turn more passes the same points.
    fails(with(&arc, "1e-4", [1.0, -3.0 * FRAC_PI_2]), not_of_the_world);
    fails(with(&arc, "1e-4", [1.0, 5.0 * FRAC_PI_2]), not_of_the_world);
    fails(with("[[1, 1], [2, 0], [0, 0]]", "1e-4", [1.0, FRAC_PI_2]), not_of_the_world);
    fails(with(&arc.replace("[1, 1]", "[1.000001, 1]"), "1e-4", [1.0, FRAC_PI_2]), not_of_the_world);
    let steps = format!("{MOVE}, {}", line(2, [1, parts as usize + 1], r#"{"straight": [[1, 1], [0, 0]]}"#, &places));
    fails(judge(&world(&arc, "1e-4"), &knots, &steps), not_of_the_world);
}

/// An arc that is placed at random in a world, and a motion along it in chords.
struct PlacedArc {
    world: String,
    knots: String,
    places: String,
    /// Centre, radius, direction of the beginning, and angle.
    arc: [f64; 5],
}

/// Number of chords of a motion along a placed arc.
const CHORDS: u32 = 48;

impl PlacedArc {
    fn random(dice: &mut cplan_cases::dice::Dice) -> Self {
        let [x, y, radius] = [(-3.0, 3.0), (-3.0, 3.0), (0.1, 3.0)].map(|(low, high)| dice.within(low, high));
        let [from, turned] = [dice.within(-4.0, 4.0), dice.within(0.3, 6.0)];
        let by = if dice.chance(0.5) { turned } else { -turned };
        let at = |u: f64| [x + radius * (from + by * u).cos(), y + radius * (from + by * u).sin()];
        let (scale, turn, shift) = (dice.within(0.1, 10.0), dice.within(-4.0, 4.0), [dice.within(-2.0, 2.0), 0.5]);
        // The world states the points before they are scaled, turned and moved.
        let point = |u: f64| {
            let [x, y] = [0, 1].map(|k| (at(u)[k] - shift[k]) / scale);
            [x * turn.cos() + y * turn.sin(), y * turn.cos() - x * turn.sin()]
        };
        let points = [0.0, dice.within(0.05, 0.95), 1.0].map(point);
        let world = format!(
            "[[step]]\nfollow = {{ arc = {points:?}, scale = {scale:?}, turn = {turn:?}, move = {shift:?}, tolerance = 0.01 }}\n"
        );
        let share = |k: u32| f64::from(k) / f64::from(CHORDS);
        let knot = |k: u32| format!(", [{}, {:?}, {:?}]", k + 1, at(share(k))[0], at(share(k))[1]);
        let places: Vec<String> = (0..=CHORDS).map(|k| format!("[{k}, {:?}]", share(k))).collect();
        let knots = "[0, 0, 1]".to_owned() + &(0..=CHORDS).map(knot).collect::<String>();
        Self { world, knots, places: places.join(", "), arc: [x, y, radius, from, by] }
    }

    /// Judges the motion with an arc in the certificate.
    fn judge(&self, [x, y, radius, from, by]: [f64; 5]) -> Verdict {
        let piece =
            format!(r#"{{"arc": {{"center": [{x:?}, {y:?}], "radius": {radius:?}, "from": {from:?}, "by": {by:?}}}}}"#);
        let along = line(2, [1, CHORDS as usize + 1], &piece, &self.places);
        judge(&self.world, &self.knots, &format!("{MOVE}, {along}"))
    }
}

#[test]
fn random_arcs_hold_and_no_others() {
    let mut count = 0;
    for seed in seeds(40) {
        let mut dice = dice(seed);
        let placed = PlacedArc::random(&mut dice);
        let (code, report) = placed.judge(placed.arc);
        assert!(
            code == 0 && !report.contains("as the certificate states it"),
            "seed {seed}: {report}\n{}",
            placed.world
        );
        let by = placed.arc[4];
        // The rest of the circle, and a whole turn more.
        for other in [by - TAU * by.signum(), by + TAU * by.signum()] {
            let [x, y, radius, from, _] = placed.arc;
            fails(
                placed.judge([x, y, radius, from, other]),
                "the certificate and the world have different lines for step 2",
            );
        }
        for number in 0..5 {
            let mut other = placed.arc;
            let size = 10_f64.powf(dice.within(-5.5, -1.0));
            other[number] += if dice.chance(0.5) { size } else { -size };
            fails(placed.judge(other), "the certificate and the world have different lines for step 2");
        }
        count += 8;
    }
    println!("{count} arcs");
}

#[test]
fn the_tip_moves_to_the_beginning_of_the_line_first() {
    // Within the wide tolerance of the line, but not at its beginning.
    let world = ANGLE.replace("]] }", "]], tolerance = 1e-3 }");
    let at = |x: &str| judge(&world, &KNOTS.replace("[1, 1, 1]", &format!("[1, {x}, 1]")), &both_steps());
    assert!(holds(at("1.000009")).contains("within 1e-5"));
    fails(at("1.000011"), "steps[0], step 1: the motion misses the target");
}

#[test]
fn the_arm_rests_at_both_ends_of_the_line() {
    let knots = "[0, 0, 1, 0, 0], [1, 1, 1, 0, 0], [2, 3, 1, 0, 0], [3, 3, 2, 0, 0]";
    holds(judge_read(ANGLE, "cubic", knots, &both_steps()));
    for (moving, part) in
        [("[3, 3, 2, 0, 0.0001]", "steps[1], step 2: the arm still moves"), ("[1, 1, 1, 0.1, 0]", "steps[0], step 1")]
    {
        let at_rest = &moving.replace("0.0001]", "0]").replace("0.1, 0]", "0, 0]");
        fails(judge_read(ANGLE, "cubic", &knots.replace(at_rest, moving), &both_steps()), part);
    }
    // The dwell is at the end of the line, not before it.
    let world = format!("{ANGLE}dwell = 0.5\n");
    let after = |time: &str| judge(&world, &format!("{KNOTS}, [{time}, 3, 2]"), &both_steps());
    holds(after("3.5"));
    fails(after("3.4"), "after steps[1], step 2, the arm does not rest for 0.5 s");
    // The line may also begin after a rest.
    let knots = "[0, 0, 1], [1, 1, 1], [1.5, 1, 1], [2, 3, 1], [3, 3, 2]";
    holds(judge(ANGLE, knots, &format!("{MOVE}, {}", line(2, [2, 4], PIECES, PLACES))));
}

#[test]
fn only_steps_along_lines_have_lines() {
    let along = line(2, [1, 3], PIECES, PLACES);
    refused(judge(ANGLE, KNOTS, &format!("{MOVE}, {{\"step\": 2, \"knots\": [1, 3]}}")), "has no \"line\"");
    let first = line(1, [0, 1], PIECES, "[0, 0], [1, 1]");
    refused(
        judge(ANGLE, KNOTS, &format!("{first}, {along}")),
        "step 1 follows no line, but the certificate has a \"line\" for it",
    );
}

#[test]
fn a_repeated_line_is_the_same_each_time() {
    let world = "task.repeat = 2\n[[step]]\nfollow = { spline = [[1, 1], [3, 1], [3, 2]] }\n";
    let knots = format!("{KNOTS}, [4, 1, 1], [5, 3, 1], [6, 3, 2]");
    let again = |pieces: &str| {
        let steps =
            format!("{}, {{\"step\": 1, \"knots\": [3, 4]}}, {}", both_steps(), line(2, [4, 6], pieces, PLACES));
        judge(world, &knots, &steps)
    };
    assert_eq!(holds(again(PIECES)).matches("in step 2").count(), 1);
    fails(again(&PIECES.replace("[3, 2]", "[3, 2.000001]")), "the line of step 2 changes");
}

#[test]
fn the_arm_and_its_payload_are_free_along_the_line() {
    let carried = "[[object]]\nname = \"block\"\nat = [0, 1]\npolygon = [[-0.2, -0.2], [0.2, -0.2], [0.2, 0.2], [-0.2, 0.2]]\n\
                   [[step]]\npick = \"block\"\n";
    let steps = format!(
        r#"{{"step": 1, "knots": [0, 0]}}, {{"step": 2, "knots": [0, 1]}}, {}"#,
        line(3, [1, 3], PIECES, PLACES)
    );
    let post = |y: f64| format!("[[obstacle]]\ncircle = {{ center = [2, {y}], radius = 0.1 }}\n");
    for (y, with_block, alone) in [(1.31, true, true), (1.29, false, true), (1.14, false, false)] {
        agrees(judge(&format!("{}{carried}{ANGLE}", post(y)), KNOTS, &steps), with_block, "");
        agrees(judge(&format!("{}{ANGLE}", post(y)), KNOTS, &both_steps()), alone, "");
    }
}
