//! Certificates of motions that begin and end with a lowered tool.

use crate::common::gantry::{GANTRY, judge_steps};
use crate::common::verdict::{Verdict, fails, found, holds, judge as judge_certificate, refused};
#[allow(dead_code, reason = "other tests use more of it")]
use cplan_cases as random;

/// Values of the stroke's joint at the start and the goal, metres. Greater values are lower.
const ENDS: [f64; 2] = [0.2, 0.3];

/// Duration of the strokes, seconds.
const DURATION: f64 = 0.4;

/// The arm departs at 1 s, arrives at 3 s, and rests until 4 s.
const KNOTS: &str = "[0, 0, 1], [1, 0, 1], [3, 4, 1], [4, 4, 1]";

/// The world with the robot's table and obstacles.
fn world(robot: &str, content: &str) -> String {
    format!(
        "[robot]\njoints = [\"x\", \"y\"]\nstroke = {{ joint = \"z\" }}\n{robot}\n\
         [start]\njoints = [0, 1]\nstroke = {}\n[goal]\njoints = [4, 1]\nstroke = {}\n{content}",
        ENDS[0], ENDS[1]
    )
}

/// Obstacle around a place of the path, from one height to another.
fn post(x: f64, radius: f64, [low, high]: [f64; 2]) -> String {
    format!("[[obstacle]]\nheight = [{low}, {high}]\ncircle = {{ center = [{x}, 1], radius = {radius} }}\n")
}

/// A stroke that begins at a time, in a single cubic.
fn stroke(name: &str, begin: f64, [from, to]: [f64; 2]) -> String {
    format!(", \"{name}\": [[{begin}, {from}, 0], [{}, {to}, 0]]", begin + DURATION)
}

fn raising(begin: f64) -> String {
    stroke("raising_first", begin, [ENDS[0], 0.0])
}

fn lowering(begin: f64) -> String {
    stroke("lowering", begin, [0.0, ENDS[1]])
}

fn judge(world: &str, more: &str) -> Verdict {
    judge_steps(GANTRY, world, KNOTS, &format!("{{\"step\": 1, \"knots\": [1, 2]{more}}}"))
}

#[test]
fn the_tool_is_raised_and_lowered_at_rest_or_on_the_way() {
    let world = world("", "");
    for more in
        [String::new(), raising(0.8), lowering(2.7), raising(1.0) + &lowering(3.0), raising(0.0) + &lowering(3.6)]
    {
        holds(judge(&world, &more));
    }
}

#[test]
fn wrong_strokes_are_refuted() {
    let open = world("", "");
    for (more, part) in [
        (raising(1.1), "between the start and the departure"),
        (raising(-0.1), "between the start and the departure"),
        (lowering(2.5), "between the arrival of the arm and the end"),
        (lowering(3.7), "between the arrival of the arm and the end"),
        (stroke("raising_first", 0.8, [0.3, 0.0]), "from the raised to the lowered height"),
        (stroke("lowering", 2.8, [0.0, 0.2]), "from the raised to the lowered height"),
        (stroke("raising", 2.8, [0.3, 0.0]), "neither picks nor places"),
    ] {
        fails(judge(&open, &more), part);
    }
    fails(judge(&world("arch = false", ""), &raising(0.8)), "the arm to rest during strokes");
    holds(judge(&world("arch = false", ""), ""));
    fails(judge(&world("arch = { rise = 0.19 }", ""), &raising(0.9)), "has risen by");
    fails(judge(&world("arch = { fall = 0.1 }", ""), &lowering(2.62)), "lower than");
    let raised = open.replace("stroke = 0.2\n", "").replace("stroke = 0.3\n", "");
    holds(judge(&(raised.clone() + "wrist = 1\n"), ""));
    fails(judge(&(raised.clone() + "wrist = 1\n"), &raising(0.8)), "is raised at the start");
    fails(judge(&(raised.clone() + "wrist = 1\n"), &lowering(2.8)), "neither picks nor places");
    refused(judge(&raised, ""), "no steps");
    refused(judge(&open.replace("stroke = { joint = \"z\" }", ""), ""), "has no `stroke`");
}

#[test]
fn a_certificate_without_steps_is_refused() {
    refused(judge_certificate(GANTRY, &world("", ""), &found("", "\"linear\"", KNOTS)), "needs steps");
}

#[test]
fn the_lowered_tool_meets_what_is_below() {
    // The ball of the raised quill is from 0.49 to 0.51.
    for (x, height) in [(0.0, 0.31), (4.0, 0.21)] {
        fails(judge(&world("", &post(x, 0.05, [0.0, height])), ""), "quill");
        holds(judge(&world("", &post(x, 0.05, [0.0, height - 0.03])), ""));
    }
    // Beside the path's ends, a post of a height that only the lowered tool meets.
    for (x, height, early, late) in
        [(0.4, 0.47, raising(1.0), raising(0.6)), (3.6, 0.47, lowering(2.7), lowering(2.95))]
    {
        let world = world("", &post(x, 0.1, [0.0, height]));
        holds(judge(&world, &late));
        fails(judge(&world, &early), "during a stroke");
    }
}

/// Returns the share of a stroke's length that it has gone after a share of its duration.
fn gone(of_duration: f64) -> f64 {
    let share = of_duration.clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

#[test]
fn random_strokes_hold_only_if_samples_are_free() {
    let (mut held, mut failed) = (0, 0);
    for seed in random::seeds(120) {
        let mut dice = random::dice(seed);
        let beside = dice.within(0.0, 0.7);
        let (x, radius) = (if dice.chance(0.5) { beside } else { 4.0 - beside }, dice.within(0.02, 0.2));
        let height = dice.within(0.2, 0.485);
        let (up, down) = (dice.within(0.55, 1.0), dice.within(2.65, 3.0));
        // Height of the ball's lower end.
        let lowest = |time: f64| {
            let depth = ENDS[0] * (1.0 - gone((time - up) / DURATION)) + ENDS[1] * gone((time - down) / DURATION);
            0.49 - depth
        };
        let hits = |time: f64| {
            let at = 2.0 * (time - 1.0).clamp(0.0, 2.0);
            lowest(time) <= height && (at - x).abs() <= radius + 0.01
        };
        let collides = (0..=4000).any(|k| hits(f64::from(k) / 1000.0));
        let (code, report) = judge(&world("", &post(x, radius, [0.0, height])), &(raising(up) + &lowering(down)));
        if code == 0 {
            assert!(!collides, "seed {seed}");
            held += 1;
        } else {
            assert_eq!(code, 3, "seed {seed}: {report}");
            failed += u32::from(collides);
        }
    }
    assert!(held > 20 && failed > 20, "{held} {failed}");
}
