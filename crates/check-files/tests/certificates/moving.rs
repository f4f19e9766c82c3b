//! Moving obstacles and objects: motions computed by hand, and statements about static obstacles that hold in spite of
//! them.

use crate::common::robots::gantry;
use crate::common::verdict::{Verdict, agrees, done, fails, holds, judge};
use cplan_check_files::{CheckError, Input, check};

/// Returns the URDF of a gantry with a square of 1 m at its tip.
fn square() -> String {
    gantry([0, 9], r#"box size="1 1 1""#)
}

const ENDS: &str = "start.joints = [1, 1]\ngoal.joints = [9, 1]\n";
const WALL: &str = "[[obstacle]]\npolygon = [[4, -1], [6, -1], [6, 10], [4, 10]]\n";
const MOTIONS: [&str; 2] =
    ["{ velocity = [0.1, 0] }", "{ stops = [{ time = 0, at = [3, 3] }, { time = 1, at = [8, 8] }] }"];

/// Returns a moving obstacle far away.
fn cart(motion: &str) -> String {
    format!(
        "[[obstacle]]\nname = \"cart\"\ncircle = {{ center = [0, 0], radius = 0.1 }}\nat = [50, 50]\nmotion = {motion}\n"
    )
}

fn certificate(answer: &str, evidence: &str) -> String {
    format!(
        r#"{{"format": "cplan certificate 1", "answer": "{answer}", {evidence},
             "shapes": [{{"link": "head", "collision": 0}}],
             "parts": [{{"obstacle": 0, "corners": [[4, -1], [6, -1], [6, 10], [4, 10]]}}]}}"#
    )
}

const BOUND: &str = r#""bound": {"to": [9, 1], "length": 8, "walls": [], "potentials": []}"#;

/// Returns boxes along the wall, one metre each. In the middle of each box, the square is deeper in the wall than it
/// can move within the box.
fn boxes() -> String {
    let stuck = |y: i32| {
        let above = y + 1;
        format!(r#"{{"lower": [4.8, {y}], "upper": [5.2, {above}], "shape": 0, "part": 0}}"#)
    };
    format!(r#""boxes": [{}]"#, (0..9).map(stuck).collect::<Vec<_>>().join(", "))
}

/// Tests that parts use the indices of static obstacles, regardless of moving obstacles before them in the file.
#[test]
fn tasks_infeasible_among_static_obstacles_stay_infeasible() {
    for motion in MOTIONS {
        let worlds =
            [[&cart(motion), WALL], [WALL, &cart(motion)]].map(|obstacles| format!("{ENDS}{}", obstacles.concat()));
        for world in worlds {
            holds(judge(&square(), &world, &certificate("infeasible", &boxes())));
            holds(judge(&square(), &world, &certificate("no_shorter", BOUND)));
            let other = certificate("infeasible", &boxes()).replace(r#""obstacle": 0"#, r#""obstacle": 1"#);
            fails(judge(&square(), &world, &other), "obstacle 1 does not exist");
        }
    }
}

/// A motion from the start to the goal in eight seconds, at a metre per second.
const DRIVEN: &str = r#""motion": {"interpolation": ["linear"], "knots": [[0, 1, 1], [8, 9, 1]]}"#;

/// Checks a motion as given, among some obstacles.
fn judge_among(obstacles: &str, evidence: &str) -> Verdict {
    let text = format!(r#"{{"format": "cplan certificate 1", "answer": "found", {evidence}}}"#);
    judge(&square(), &format!("{ENDS}{obstacles}"), &text)
}

/// Tests a motion that can be computed by hand. The left side of the square is at `0.5 + t`, its right side at `1.5 +
/// t`, and its upper side at 1.5. A disc of radius 0.1 moves down along x = 5.
#[test]
fn motions_among_moving_obstacles_agree_with_results_by_hand() {
    let disc = |motion: &str| {
        format!("[[obstacle]]\ncircle = {{ center = [0, 0], radius = 0.1 }}\nat = [5, 5]\nmotion = {motion}\n")
    };
    let falling = |from: &str| disc(&format!("{{ stops = [{{ time = 0, at = [5, {from}] }}], velocity = [0, -1] }}"));
    // At 4.6 s the square has passed: then the disc's lowest point is at `from - 4.7`. At 3.4 s it arrives: then the
    // disc's highest point is at `from - 3.3`.
    for (from, is_free) in
        [("6.21", true), ("6.19", true), ("6.1", false), ("5", false), ("3.9", false), ("3.7", true), ("1.7", true)]
    {
        agrees(judge_among(&falling(from), DRIVEN), is_free, "obstacle 0");
    }
    // The disc waits for its time, and arrives too late or just in time. It stays at its last stop.
    let late = |from: f64| {
        let until = from + 4.0;
        disc(&format!("{{ stops = [{{ time = {from:?} }}, {{ time = {until:?}, at = [5, 1] }}] }}"))
    };
    holds(judge_among(&late(1.3), DRIVEN));
    fails(judge_among(&late(1.0), DRIVEN), "obstacle 0");
    fails(judge_among(&disc("{ stops = [{ time = 0 }, { time = 1, at = [5, 1] }] }"), DRIVEN), "obstacle 0");
    // The disc moves ahead of the square at the same speed. At a lower speed the square hits it.
    let ahead = |speed: &str| disc(&format!("{{ stops = [{{ time = 0, at = [1.7, 1] }}], velocity = [{speed}, 0] }}"));
    holds(judge_among(&ahead("1"), DRIVEN));
    fails(judge_among(&ahead("0.98"), DRIVEN), "obstacle 0");
    // The clock begins with the motion.
    let later = DRIVEN.replace("[[0,", "[[2,").replace("[8,", "[10,");
    holds(judge_among(&falling("6.19"), &later));
    fails(judge_among(&falling("5"), &later), "obstacle 0");
    // An obstacle that surrounds the square initially.
    let around =
        "[[obstacle]]\npolygon = [[-3, -3], [3, -3], [3, 3], [-3, 3]]\nat = [1, 1]\nmotion = { velocity = [1, 0] }\n";
    fails(judge_among(around, DRIVEN), "inside obstacle 0");
    // Numbers of moving obstacles follow those of static ones.
    let post = "[[obstacle]]\ncircle = { center = [5, 9], radius = 1 }\n";
    fails(judge_among(&format!("{}{post}", falling("5")), DRIVEN), "obstacle 1");
    // A bound is about static obstacles.
    holds(judge_among(&falling("7"), &format!("{DRIVEN}, {BOUND}")));
}

/// Tests a bar that extends 2 m to each side of a pivot above the square's path.
#[test]
fn turning_obstacles_are_avoided_at_all_times() {
    let bar = |stops: &str| {
        let shape = "polygon = [[-2, -0.01], [2, -0.01], [2, 0.01], [-2, 0.01]]\nat = [5, 3]";
        format!("[[obstacle]]\n{shape}\nmotion = {{ stops = [{stops}] }}\n")
    };
    holds(judge_among(&bar("{ time = 0 }"), DRIVEN));
    fails(judge_among(&bar("{ time = 0, angle = \"90deg\" }"), DRIVEN), "obstacle 0");
    // One end comes down behind the square, or onto it.
    holds(judge_among(&bar("{ time = 5 }, { time = 6, angle = \"90deg\" }"), DRIVEN));
    fails(judge_among(&bar("{ time = 5 }, { time = 6, angle = \"-90deg\" }"), DRIVEN), "obstacle 0");
    // After half a turn the bar is as before, but not during the turn.
    holds(judge_among(&bar("{ time = 9 }, { time = 10, angle = \"180deg\" }"), DRIVEN));
    fails(judge_among(&bar("{ time = 3 }, { time = 4, angle = \"180deg\" }"), DRIVEN), "obstacle 0");
}

/// Tests bottles on a belt along y = 4. The tip picks each at the corner of its frame, and carries it to its target.
#[test]
fn moving_objects_are_picked_at_their_place_and_time() {
    let world = |step: &str| {
        let belt = "[[object]]\nname = \"bottle\"\ncircle = { center = [0, 0], radius = 0.1 }\nat = [9, 4]\nmotion = { velocity = [-1, 0] }\n";
        let steps = format!("[[step]]\npick = \"bottle\"\n{step}\n[[step]]\nplace = {{ at = [2, 8] }}\n");
        format!("start.joints = [1, 1]\n{belt}{steps}")
    };
    // At 4 s the bottle is at (5, 4).
    let picked = |pick: &str, late: &str| {
        let knots = format!("[0, 1, 1], [2, {pick}], [4, {pick}], [{late}, {pick}], [9, 2, 8]");
        let steps = r#"{"step": 1, "knots": [0, 2]}, {"step": 2, "knots": [3, 4]}"#;
        done(&knots, steps)
    };
    let judge_pick = |step: &str, pick: &str, late: &str| judge(&square(), &world(step), &picked(pick, late));
    holds(judge_pick("", "5, 4", "5"));
    holds(judge_pick("window = [3.5, 4]\nat = [5, 4]", "5, 4", "5"));
    fails(judge_pick("", "5.01, 4", "5"), "misses the target");
    fails(judge_pick("window = [1, 3.9]", "5, 4", "5"), "outside its time window");
    fails(judge_pick("at = [5.1, 4]", "5, 4", "5"), "not at the stated place");
    // The second bottle hits the arm while it rests at the first one, unless the arm leaves in time: its square begins
    // at x = 5.5.
    let second = "[[object]]\nname = \"other\"\ncircle = { center = [0, 0], radius = 0.1 }\nat = [10.5, 4]\nmotion = { velocity = [-1, 0] }\n";
    let both = |late: &str| judge(&square(), &format!("{}{second}", world("")), &picked("5, 4", late));
    holds(both("4.5"));
    fails(both("5"), "obstacle 1");
}

#[test]
fn invalid_trajectories_are_refused() {
    for (motion, message) in [
        ("{ stops = [] }", "each later than the previous one"),
        ("{ stops = [{ time = 1 }, { time = 1, at = [0, 9] }] }", "each later than the previous one"),
        ("{ stops = [{ at = [0, 9] }] }", "a stop needs a time"),
        ("{ stops = [{ time = 1, speed = 3 }] }", "the key speed of a stop"),
        ("{ turn = 3 }", "the key turn of a motion"),
        ("3", "expected a table"),
    ] {
        let certificate = format!(r#"{{"format": "cplan certificate 1", "answer": "found", {DRIVEN}}}"#);
        let judged = check(&square(), &format!("{ENDS}{}", cart(motion)), &certificate);
        let is_refused = |why: &CheckError| matches!(why, CheckError::Input { input: Input::World, line: Some(_), message: why } if why.contains(message));
        assert!(judged.as_ref().is_err_and(is_refused), "{motion}: {judged:?}");
    }
}
