//! `cplan cell`.

mod errors;
mod oracle;
mod program_steps;
mod programs;
mod proofs;
mod random;
mod set;
mod verify;
mod verify_steps;

use super::{Done, Place, number, read, shipped};
use oracle::{Arm, Motion, Solid, distance, replayed};
use serde_json::Value;
use std::f64::consts::PI;

/// Time between two samples of replays, seconds.
const STEP: f64 = 2e-3;

/// Seconds by which the clocks of the arms may differ, by default.
const SKEW: f64 = 0.02;

/// Returns the SCARA of `robots/scara.urdf` with its quill lowered by 0.15 m.
fn scara(base: [f64; 2], angle: f64) -> Arm {
    scara_with_quill(base, angle, 0.15)
}

/// Returns the SCARA of `robots/scara.urdf` with its quill lowered by a depth.
fn scara_with_quill(base: [f64; 2], angle: f64, depth: f64) -> Arm {
    let inner = [0.195, 0.265];
    let outer = [0.27, 0.43];
    let quill = [0.18 - depth, 0.4 - depth];
    let links = [
        vec![
            Solid::rectangle([0.15, 0.0], [0.3, 0.11], inner),
            Solid::disc([0.0, 0.0], 0.055, inner),
            Solid::disc([0.3, 0.0], 0.055, inner),
        ],
        vec![
            Solid::rectangle([0.125, 0.0], [0.25, 0.1], outer),
            Solid::disc([0.0, 0.0], 0.05, outer),
            Solid::disc([0.25, 0.0], 0.05, outer),
            Solid::disc([0.25, 0.0], 0.01, quill),
        ],
    ];
    Arm { base, angle, inner_length: 0.3, outer_length: 0.25, links, speeds: [7.243, 11.502] }
}

/// Returns an arm of `robots/dual_scara.urdf`, with the heights of its links.
fn column_arm([inner, outer, tool]: [[f64; 2]; 3]) -> Arm {
    let links = [
        vec![Solid::rectangle([0.13, 0.0], [0.26, 0.08], inner)],
        vec![Solid::rectangle([0.11, 0.0], [0.26, 0.07], outer), Solid::disc([0.22, 0.0], 0.02, tool)],
    ];
    Arm { base: [0.0; 2], angle: 0.0, inner_length: 0.26, outer_length: 0.22, links, speeds: [4.0, 6.0] }
}

fn bars(base: [f64; 2], angle: f64) -> Arm {
    Arm::bars(base, angle, [1.0, 0.8], 0.1, [2.0, 3.0])
}

/// Returns the answer about a cell as JSON.
fn answer(done: &Done) -> Value {
    serde_json::from_str(&done.stdout).unwrap_or_else(|error| panic!("{error}: {}{}", done.stdout, done.stderr))
}

/// Runs `cplan cell` with a shipped cell.
fn shipped_cell(name: &str, options: &[&str]) -> Done {
    let path = shipped(&format!("workspaces/cells/{name}.toml"));
    Place::new().run(&[&["cell", &path, "--json", "--quiet"], options].concat(), "")
}

/// Checks that motions are safe for all skews, and within the limits. Returns the motions.
#[track_caller]
fn check_found(answer: &Value, arms: &[Arm; 2], skew: f64) -> [Motion; 2] {
    assert_eq!(answer["status"], "found", "{answer}");
    let motions = [0, 1].map(|k| Motion::read(&answer["arms"][k]));
    let mut least = replayed(arms, &motions, skew, STEP);
    // The replay misses places between its samples.
    if let Some(times) = answer["nearest"]["times"].as_array() {
        let times = [number(&times[0]), number(&times[1])];
        assert!((times[0] - times[1]).abs() <= skew + 1e-9, "{times:?}");
        least = least.min(distance(arms, [0, 1].map(|k| motions[k].at(times[k]))));
    }
    let proven = number(&answer["clearance_between"]);
    assert!(least > 0.0 && proven > 0.0 && proven <= least + 1e-9, "proven {proven}, replayed {least}");
    assert!(proven >= 0.5 * least, "proven {proven}, replayed {least}");
    let duration = motions[0].end().max(motions[1].end());
    assert_eq!(number(&answer["duration"]), duration);
    assert!(number(&answer["lower_bound"]) <= duration + 1e-9);
    for (arm, motion) in arms.iter().zip(&motions) {
        let ends = [0, motion.time.len() - 1].map(|k| motion.velocity[k]);
        assert_eq!(ends, [[0.0; 2]; 2], "the motion begins and ends at rest");
        let mut before = motion.position[0];
        let count = (motion.end() / 1e-3).ceil() as usize;
        for k in 1..=count {
            let here = motion.at(motion.end() * k as f64 / count as f64);
            let step = motion.end() / count as f64;
            for joint in 0..2 {
                assert!((here[joint] - before[joint]).abs() <= arm.speeds[joint] * step * (1.0 + 1e-6) + 1e-12);
            }
            before = here;
        }
    }
    motions
}

fn crossing_arms() -> [Arm; 2] {
    [scara([0.0, 0.0], 0.0), scara([0.8, 0.0], PI)]
}

#[test]
fn crossing_goals_are_reached_without_a_collision() {
    let answer = answer(&shipped_cell("crossing", &[]));
    let arms = crossing_arms();
    let motions = check_found(&answer, &arms, SKEW);
    for (k, tip) in [[0.4, 0.25], [0.4, -0.25]].into_iter().enumerate() {
        let [x, y] = arms[k].tip(motions[k].at(motions[k].end()));
        assert!((x - tip[0]).hypot(y - tip[1]) < 1e-9, "({x}, {y})");
    }
    // Both fastest motions at once would collide.
    let alone = |k: usize| number(&answer["arms"][k]["alone"]["duration"]);
    assert!(number(&answer["duration"]) >= alone(0).max(alone(1)) - 1e-6);
}

#[test]
fn the_certificate_holds_for_the_requested_skew() {
    let arms = crossing_arms();
    let mut durations = Vec::new();
    for skew in [0.0, 0.02, 0.2] {
        let answer = answer(&shipped_cell("crossing", &["--skew", &skew.to_string()]));
        check_found(&answer, &arms, skew);
        assert_eq!(number(&answer["skew"]), skew);
        durations.push(number(&answer["duration"]));
    }
    // The motions are local optima.
    assert!(durations.windows(2).all(|pair| pair[0] <= 1.01 * pair[1]), "{durations:?}");
}

#[test]
fn two_arms_on_one_column_are_one_robot() {
    let done = shipped_cell("column", &[]);
    let answer = answer(&done);
    let lower = column_arm([[0.2, 0.26], [0.13, 0.19], [0.05, 0.15]]);
    let upper = column_arm([[0.3, 0.36], [0.13, 0.29], [0.05, 0.15]]);
    check_found(&answer, &[lower, upper], SKEW);
}

/// Checks that an arm stands still during its waits.
#[track_caller]
fn check_waits(arm: &Value, motion: &Motion) {
    for wait in arm["waits"].as_array().unwrap() {
        for share in [0.0, 0.5, 1.0] {
            let time = number(&wait["from"]) * (1.0 - share) + number(&wait["to"]) * share;
            let q = motion.at(time);
            assert!((0..2).all(|k| (q[k] - number(&wait["at"][k])).abs() < 1e-9), "{q:?} {wait}");
        }
    }
}

#[test]
fn arms_that_use_one_place_move_at_the_same_time() {
    let answer = answer(&shipped_cell("relay", &[]));
    check_found(&answer, &crossing_arms(), SKEW);
    let alone = |k: usize| number(&answer["arms"][k]["alone"]["duration"]);
    assert!(number(&answer["duration"]) < alone(0) + alone(1), "{answer}");
}

#[test]
fn arms_that_block_each_other_make_room() {
    let answer = answer(&shipped_cell("swap", &[]));
    check_found(&answer, &[bars([-1.3, 0.0], 0.0), bars([1.3, 0.0], PI)], SKEW);
    assert!(answer["tried"][0].as_str().unwrap().contains("deadlock"), "{}", answer["tried"]);
}

/// Plays both motions with controllers that obey the signals, each with its own random speed, and returns the least distance.
fn played_with_signals(answer: &Value, arms: &[Arm; 2], motions: &[Motion; 2], seed: u64) -> f64 {
    let mut random = cplan_cases::dice(seed);
    let name = |k: usize| answer["arms"][k]["name"].as_str().unwrap();
    let signals: Vec<(usize, f64, f64)> = answer["interlocks"]
        .as_array()
        .expect("interlocks")
        .iter()
        .map(|signal| {
            let waits = (0..2).find(|k| signal["waits"] == name(*k)).unwrap();
            (waits, number(&signal["at"]["time"]), number(&signal["after"]["time"]))
        })
        .collect();
    let (mut clocks, mut speeds, mut least) = ([0.0_f64; 2], [1.0_f64; 2], f64::INFINITY);
    let mut steps = 0;
    while (0..2).any(|k| clocks[k] < motions[k].end()) {
        if steps % 50 == 0 {
            speeds = [0, 1].map(|_| if random.within(0.0, 1.0) < 0.3 { 0.0 } else { random.within(0.1, 1.0) });
            // One of them always moves.
            speeds[(steps / 50) % 2] = 1.0;
        }
        steps += 1;
        assert!(steps < 1_000_000, "the arms wait for each other: {clocks:?} {signals:?}");
        let next = [0, 1].map(|k| {
            let holds = signals.iter().filter(|(waits, _, set)| *waits == k && clocks[1 - k] < *set);
            let limit = holds.map(|(_, at, _)| *at).fold(f64::INFINITY, f64::min);
            (clocks[k] + speeds[k] * STEP).min(limit.max(clocks[k])).min(motions[k].end())
        });
        clocks = next;
        least = least.min(distance(arms, [0, 1].map(|k| motions[k].at(clocks[k]))));
    }
    least
}

#[test]
fn signals_make_motions_safe_for_any_speed_of_the_clocks() {
    let answer = answer(&shipped_cell("crossing", &[]));
    let arms = crossing_arms();
    let motions = check_found(&answer, &arms, SKEW);
    assert!(!answer["interlocks"].as_array().unwrap().is_empty(), "{answer}");
    for seed in 0..6 {
        let least = played_with_signals(&answer, &arms, &motions, seed);
        assert!(least > 0.0, "seed {seed}");
    }
    // Without the signals, some speeds lead to a collision.
    let mut without = answer.clone();
    without["interlocks"] = serde_json::json!([]);
    assert!((0..6).any(|seed| played_with_signals(&without, &arms, &motions, seed) <= 0.0));
}

#[test]
fn files_have_the_motions_of_both_arms() {
    let place = Place::new();
    let cell = shipped("workspaces/cells/crossing.toml");
    let outputs = ["cell.json", "cell.csv", "cell_left.yaml", "right.yaml", "both.yaml", "cell.svg", "cell.html"];
    let mut words = vec!["cell", &cell];
    for output in outputs {
        words.extend([
            if output.ends_with("svg") || output.ends_with("html") { "--picture" } else { "--output" },
            output,
        ]);
    }
    let done = place.run(&words, "");
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(done.stdout.contains("result") && done.stdout.contains("found: both motions"), "{}", done.stdout);
    let answer: Value = serde_json::from_str(&place.read("cell.json")).unwrap();
    let motions = [0, 1].map(|k| Motion::read(&answer["arms"][k]));
    let table = place.read("cell.csv");
    let mut lines = table.lines();
    let columns = "time,left/axis_1,left/axis_2,right/axis_1,right/axis_2,left/axis_1_velocity,left/axis_2_velocity,\
                   right/axis_1_velocity,right/axis_2_velocity";
    assert_eq!(lines.next(), Some(columns));
    let mut times = Vec::new();
    for line in lines {
        let row: Vec<f64> = line.split(',').map(|value| value.parse().unwrap()).collect();
        let at = motions.each_ref().map(|motion| motion.at(row[0]));
        for (k, value) in at.iter().flatten().enumerate() {
            assert!((value - row[k + 1]).abs() < 1e-9, "{line}");
        }
        times.push(row[0]);
    }
    assert!(times.is_sorted() && times[times.len() - 1] == number(&answer["duration"]));
    let left = place.read("cell_left.yaml");
    // All joints of the robot, as in other messages.
    assert!(left.contains("- \"axis_1\"\n- \"axis_2\"\n- \"axis_3\"\n- \"axis_4\"\n"), "{left:.300}");
    assert!(place.read("both.yaml").contains("- \"left/axis_1\"\n- \"left/axis_2\"\n- \"right/axis_1\""));
    assert!(place.read("right.yaml").contains("points:"));
    assert!(place.read("cell.svg").contains("waits for signal 1, which"));
}

fn title(page: &str) -> &str {
    let (_, rest) = page.split_once("<title>").expect("a title");
    rest.split_once("</title>").expect("its end").0
}

#[test]
fn titles_state_the_cycle_and_the_gap() {
    let place = Place::new();
    let done = place
        .run(&["cell", &shipped("workspaces/cells/relay.toml")], "--json --quiet --picture a.html --picture a.svg");
    let (answer, page) = (answer(&done), place.read("a.html"));
    let [duration, bound] = ["duration", "lower_bound"].map(|key| number(&answer[key]));
    let title = title(&page);
    let gap = title.strip_prefix(&format!("Both arms arrive after {duration:.3} s, proven within ")).expect(title);
    let gap: f64 = gap.strip_suffix(" % of the least time").expect(title).parse().unwrap();
    assert!(duration <= bound * (1.0 + gap / 100.0) && duration > bound * (1.0 + (gap - 0.011) / 100.0), "{title}");
    assert!(place.read("a.svg").contains(title), "{title}");
}

/// A picture shows the start: an object lies at its place, and dashed outlines show where it is placed.
#[test]
fn pictures_show_steps_handovers_and_destinations() {
    let place = Place::new();
    let done = place.run(&["cell", &shipped("workspaces/cells/handover.toml")], "--json --quiet --picture a.svg");
    let (answer, picture) = (answer(&done), place.read("a.svg"));
    let list = |value: &Value| value.as_array().unwrap().clone();
    let mut releases = 0;
    let arms = list(&answer["arms"]);
    for (arm, step) in arms.iter().flat_map(|arm| list(&arm["steps"]).into_iter().map(move |step| (arm, step))) {
        let [name, action] = [&arm["name"], &step["action"]].map(|text| text.as_str().unwrap());
        let at = step["event"].as_f64().map_or_else(String::new, |time| format!(", at {time:.3} s"));
        let title = format!("<title>{name}, step {}: {action}{at}</title>", step["step"]);
        assert!(picture.contains(&title), "{title}");
        releases += usize::from(action.starts_with("place"));
    }
    assert_eq!((releases, picture.matches("stroke-dasharray=\"5 3\"").count()), (4, releases));
    for handover in list(&answer["handovers"]) {
        let [gives, object, takes] = ["gives", "object", "takes"].map(|key| handover[key].as_str().unwrap());
        assert!(picture.contains(&format!("<title>{gives} hands \"{object}\" over to {takes}</title>")), "{object}");
    }
    assert!(picture.contains("\npick bracket 1\n") && picture.contains("\nhandover 2\n"));
}

#[test]
fn a_result_is_the_same_in_every_run() {
    let [one, two] = [0, 1].map(|_| shipped_cell("crossing", &[]).stdout);
    assert!(!one.is_empty() && one == two);
}
