//! Certificates of tasks in which the wrist turns the load while the arm moves.

use crate::common::gantry::{GANTRY, KNOTS, judge_steps};
use crate::common::verdict::{Verdict, fails, holds};
#[allow(dead_code, reason = "other tests use more of it")]
use cplan_cases as random;
use cplan_cases::dice::Dice;
use std::f64::consts::{FRAC_PI_2, PI};

/// Half the sides of the block, which is carried at its own height. The grasp is its middle.
const HALF: [f64; 2] = [0.2, 0.1];

/// Duration of turns and strokes, seconds.
const DURATION: f64 = 0.4;

/// The world with obstacles, with the block to be placed at an angle.
fn world(robot: &str, content: &str) -> String {
    let [a, b] = HALF;
    format!(
        "[robot]\njoints = [\"x\", \"y\"]\npayload = \"level\"\nwrist = {{ velocity = 1 }}\n{robot}\n[start]\njoints = [0, 1]\n\
         [[object]]\nname = \"block\"\nat = [1, 1]\nheight = [0, 0.05]\nlift = 0.3\n\
         polygon = [[-{a}, -{b}], [{a}, -{b}], [{a}, {b}], [-{a}, {b}]]\n{content}\
         [[step]]\npick = \"block\"\n[[step]]\nplace = {{ at = [3, 1], angle = 1.5707963267948966 }}\n\
         [[step]]\nmove = {{ joints = [5, 1] }}\n"
    )
}

const STROKE: &str = "stroke = { joint = \"z\" }";

fn post([x, y]: [f64; 2], radius: f64) -> String {
    format!("[[obstacle]]\nheight = [0.3, 0.34]\ncircle = {{ center = [{x}, {y}], radius = {radius} }}\n")
}

fn judge(world: &str, more: [&str; 3]) -> Verdict {
    let step = |k: usize| format!("{{\"step\": {}, \"knots\": [{}, {}]{}}}", k + 1, 2 * k, 2 * k + 1, more[k]);
    let steps: Vec<String> = (0..3).map(step).collect();
    judge_steps(GANTRY, world, KNOTS, &steps.join(", "))
}

/// A turn by an angle that begins at a time, in a single cubic.
fn turning(begin: f64, by: f64) -> String {
    format!(", \"turn\": {by:?}, \"turning\": [[{begin}, 0, 0], [{}, {by:?}, 0]]", begin + DURATION)
}

#[test]
fn turns_may_overlap_with_motions() {
    for robot in ["", STROKE] {
        let world = world(robot, "");
        holds(judge(&world, ["", ", \"turn\": 1.5707963267948966", ""]));
        holds(judge(&world, ["", &turning(2.8, FRAC_PI_2), ""]));
        holds(judge(&world, ["", &turning(2.0, FRAC_PI_2), ""]));
        holds(judge(&world, [&turning(1.7, FRAC_PI_2), "", ""]));
        holds(judge(&world, [&turning(2.6, FRAC_PI_2), "", ""]));
        // In the other direction, with another end.
        fails(judge(&world, ["", &turning(2.8, -FRAC_PI_2), ""]), "target");
    }
}

#[test]
fn a_turn_is_in_the_motion_to_a_place_or_from_a_pick() {
    let world = world(STROKE, "");
    let by = FRAC_PI_2;
    for (more, part) in [
        (["", &*turning(1.9, by), ""], "begins before the motion"),
        (["", &*turning(3.7, by), ""], "ends after the departure"),
        ([&*turning(0.9, by), "", ""], "begins before the arrival"),
        ([&*turning(2.7, by), "", ""], "ends after the motion"),
        (["", ", \"turn\": 1.5707963267948966", &*turning(4.5, by)], "must be before a place, or after a pick"),
        (["", ", \"turning\": [[2.8, 0, 0], [3.1, 1.5, 0]]", ""], "without \"turn\""),
        (["", ", \"turn\": 1.5707963267948966, \"turning\": [[2.8, 0, 0], [3.1, 1.5, 0]]", ""], "angle of the turn"),
        (["", ", \"turn\": 1.5, \"turning\": [[2.8, 0, 0], [3.1, 1.5, 0.1]]", ""], "do not begin and end at rest"),
        (["", ", \"turn\": 1.5, \"turning\": [[2.8, 0, 0], [2.9, 1.6, 0], [3.1, 1.5, 0]]", ""], "turn back"),
        (["", ", \"turn\": 8, \"turning\": [[2.8, 0, 0], [3.1, 8, 0]]", ""], "more than one revolution"),
    ] {
        fails(judge(&world, more), part);
    }
}

#[test]
fn the_world_can_forbid_turns_on_the_way() {
    for robot in ["arch = false", "stroke = { joint = \"z\" }\narch = false"] {
        let world = world(robot, "");
        holds(judge(&world, ["", ", \"turn\": 1.5707963267948966", ""]));
        fails(judge(&world, ["", &turning(2.8, FRAC_PI_2), ""]), "requires the arm to rest during turns");
    }
}

#[test]
fn the_tool_is_raised_during_turns() {
    let world = world(STROKE, "");
    let lowering = |begin: f64| format!(", \"lowering\": [[{begin}, 0, 0], [{}, 0.3, 0]]", begin + DURATION);
    let raising = |begin: f64| format!(", \"raising\": [[{begin}, 0.3, 0], [{}, 0, 0]]", begin + DURATION);
    let place =
        |turn: f64, down: f64| judge(&world, ["", &format!("{}{}", turning(turn, FRAC_PI_2), lowering(down)), ""]);
    holds(place(2.4, 2.8));
    holds(place(2.2, 2.8));
    fails(place(2.41, 2.8), "overlaps with a stroke of the tool");
    let pick = |up: f64, turn: f64| judge(&world, [&format!("{}{}", raising(up), turning(turn, FRAC_PI_2)), "", ""]);
    holds(pick(1.8, 2.2));
    fails(pick(1.8, 2.19), "overlaps with a stroke of the tool");
    // The turn after the pick ends before the lowering for the place begins.
    let both = |down: f64| judge(&world, [&turning(2.3, FRAC_PI_2), &lowering(down), ""]);
    holds(both(2.7));
    fails(both(2.69), "overlaps with a stroke of the tool");
}

/// Tests a post beside the path that the turned block touches, and the block at rest does not.
#[test]
fn the_load_has_the_angles_of_each_moment() {
    // The long side passes the post below it while the block has not turned far, or once the block is past it.
    let world = world(STROKE, &post([2.5, 0.83], 0.01));
    holds(judge(&world, ["", ", \"turn\": 1.5707963267948966", ""]));
    // The block passes the post from 2.65 to 2.85 s, so it must not turn far before it has passed.
    holds(judge(&world, ["", &turning(2.86, FRAC_PI_2), ""]));
    fails(judge(&world, ["", &turning(2.5, FRAC_PI_2), ""]), "during a turn of the wrist, ");
    // After the pick, a turn at the beginning of the motion leaves the block turned for the rest of it.
    fails(judge(&world, [&turning(1.9, FRAC_PI_2), "", ""]), "after knot 2, the payload");
}

/// Compares verdicts on random turns past random posts with dense samples.
#[test]
fn verdicts_agree_with_dense_samples() {
    let (mut held, mut refused) = (0, 0);
    for seed in 0..random::times(60) {
        let mut dice = Dice::new(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) + 7);
        let center = [dice.within(1.3, 2.9), 1.0 + dice.within(0.1, 0.3) * if dice.chance(0.5) { 1.0 } else { -1.0 }];
        let radius = dice.within(0.005, 0.03);
        let begin = dice.within(2.0, 2.9);
        let by = if dice.chance(0.5) { FRAC_PI_2 } else { FRAC_PI_2 - 2.0 * PI };
        let world = world(STROKE, &post(center, radius));
        let distance = |x: f64, angle: f64| {
            let (sin, cos) = angle.sin_cos();
            let off = [center[0] - x, center[1] - 1.0];
            let own = [cos * off[0] + sin * off[1], cos * off[1] - sin * off[0]];
            let beyond = [own[0].abs() - HALF[0], own[1].abs() - HALF[1]];
            let outside = beyond[0].max(0.0).hypot(beyond[1].max(0.0));
            outside + beyond[0].max(beyond[1]).min(0.0) - radius
        };
        // The motion at the first angle, the turn at rest, and the turn during the motion.
        let mut least = f64::INFINITY;
        for look in 0..=4000 {
            let share = f64::from(look) / 4000.0;
            let time = 2.0 + share;
            let done = ((time - begin) / DURATION).clamp(0.0, 1.0);
            let x = 1.0 + 2.0 * share;
            for at in [distance(x, 0.0), distance(3.0, by * share), distance(x, by * done * done * (3.0 - 2.0 * done))]
            {
                least = least.min(at);
            }
        }
        let (code, report) = judge(&world, ["", &turning(begin, by), ""]);
        if least > 1e-3 {
            assert_eq!(code, 0, "seed {seed}: {least} {report}");
            held += 1;
        } else if least < 0.0 {
            assert_eq!(code, 3, "seed {seed}: {least} {report}");
            refused += 1;
        }
    }
    println!("{held} hold, {refused} are refused");
    assert!(held > 10 && refused > 10, "{held} hold, {refused} are refused");
}
