//! Tools that are lowered at picks and places, and wrists that turn: their effects on the duration, the certificate and
//! the files.

use super::controller::{Message, played, seconds};
use super::{Run, files, root};
use serde_json::Value;

/// A SCARA with its quill and its wrist, and a part that must be turned.
const CELL: &str = r#"name = "cell"
[robot]
joints = ["axis_1", "axis_2"]
tip = "flange"
payload = "level"
wrist = { joint = "axis_4", velocity = 30.0, acceleration = 200.0 }
STROKE
[start]
joints = [0.0, 1.2]
[[object]]
name = "part"
polygon = [[-0.012, -0.006], [0.012, -0.006], [0.012, 0.006], [-0.012, 0.006]]
at = [0.14, 0.36]
height = [0.0, 0.01]
lift = 0.12
[[step]]
pick = "part"
dwell = 0.1
[[step]]
place = { at = [0.35, -0.17], angle = 1.0 }
dwell = 0.2
[[step]]
move = { joints = [0.0, 1.2] }
"#;

/// The arm rests during strokes.
const STROKE: &str = "arch = false\nstroke = { joint = \"axis_3\", velocity = 1.0, acceleration = 5.0 }";

/// The tool moves with the arm, as far as possible.
const ARCH: &str = "stroke = { joint = \"axis_3\", velocity = 1.0, acceleration = 5.0 }";

fn plan_and_check(world: &str, options: &[&str]) -> (Run, Option<(i32, String)>) {
    let folder = tempfile::tempdir().unwrap();
    let (robot, file) = (root("robots/scara.urdf"), folder.path().join("world.toml"));
    std::fs::write(&file, world).unwrap();
    let run = Run::of(&robot, &file, options);
    let verified = (run.code == 0).then(|| run.verified(&robot, &file, "json"));
    (run, verified)
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Returns position and velocity of a joint at a time of a message, by the controller's formula.
fn joint_state_at(message: &Message, joint: &str, time: f64) -> [f64; 2] {
    let named = message.joints.iter().position(|name| name == joint).unwrap();
    let k = message.since.partition_point(|since| seconds(0, *since) <= time).max(1) - 1;
    let k = k.min(message.since.len() - 2);
    let [position, velocity, _] = played(message, k, named, time - seconds(0, message.since[k]));
    [position, velocity]
}

#[test]
fn a_stroke_takes_its_time_in_the_task_and_in_its_bound() {
    let (with, verified) = plan_and_check(&CELL.replace("STROKE", STROKE), &[]);
    assert_eq!(verified.expect("done").0, 0);
    let (without, _) = plan_and_check(&CELL.replace("STROKE", "arch = false"), &[]);
    let (with, without) = (with.json(), without.json());
    // Two strokes down and two up. Each is 0.12 m at 5 m/s2, which does not reach the top speed of 1 m/s.
    let way = 2.0 * (0.12_f64 / 5.0).sqrt();
    for key in ["duration", "lower_bound"] {
        let more = number(&with[key]) - number(&without[key]);
        assert!((more - 4.0 * way).abs() < 1e-6, "{key}: {more}");
    }
    assert!(number(&with["lower_bound"]) <= number(&with["duration"]));
    for (step, wait) in [(0, 0.1), (1, 0.2)] {
        let (step, event) = (&with["steps"][step], &with["events"][step]);
        let stroke = &step["stroke"];
        assert_eq!((number(&stroke["raised"]), number(&stroke["lowered"])), (0.0, -0.12));
        assert!((number(&stroke["seconds"]) - way).abs() < 1e-8);
        let turn = step["turn"].get("seconds").map_or(0.0, number);
        let [arrival, end] = ["arrival", "end"].map(|key| number(&step[key]));
        assert!((end - arrival - wait - turn - 2.0 * way).abs() < 1e-8);
        // The gripper acts while the tool is lowered. In a place step, the wrist turns before that.
        let before = if event["event"] == "release" { turn } else { 0.0 };
        assert!((number(&event["time"]) - arrival - before - way).abs() < 1e-8, "{event}");
    }
    assert!(with["steps"][2].get("stroke").is_none());
}

#[test]
fn the_quill_goes_down_at_picks_and_places_and_nowhere_else() {
    let (run, _) = plan_and_check(&CELL.replace("STROKE", STROKE), &[]);
    let (message, result) = (files::yaml(&run.text("yaml")), run.json());
    assert_eq!(message.joints, ["axis_1", "axis_2", "axis_3", "axis_4"]);
    for event in result["events"].as_array().unwrap() {
        let [depth, speed] = joint_state_at(&message, "axis_3", number(&event["time"]) + 1e-9);
        assert!((depth + 0.12).abs() < 1e-9 && speed.abs() < 1e-6, "{event}: {depth}, {speed}");
    }
    for step in result["steps"].as_array().unwrap() {
        let [begin, arrival] = ["begin", "arrival"].map(|key| number(&step[key]));
        for i in 0..=200 {
            let time = begin + (arrival - begin) * f64::from(i) / 200.0;
            let [depth, speed] = joint_state_at(&message, "axis_3", time);
            assert!(depth.abs() < 1e-12 && speed.abs() < 1e-6, "the quill is at {depth} while the arm moves");
        }
    }
    let quill = message.joints.iter().position(|name| name == "axis_3").unwrap();
    let (mut deepest, mut fastest, mut strongest) = (0.0_f64, 0.0_f64, 0.0_f64);
    for k in 0..message.since.len() - 1 {
        let duration = seconds(message.since[k], message.since[k + 1]);
        for share in 0..=16 {
            let [z, v, a] = played(&message, k, quill, duration * f64::from(share) / 16.0);
            (deepest, fastest, strongest) = (deepest.min(z), fastest.max(v.abs()), strongest.max(a.abs()));
        }
    }
    assert!(
        (deepest + 0.12).abs() < 1e-9 && fastest <= 1.0 + 1e-9 && (strongest - 5.0).abs() < 1e-4,
        "{deepest} {fastest} {strongest}"
    );
    #[cfg(feature = "mcap")]
    {
        // One message per step, each from rest to rest with its own stroke.
        let messages = files::mcap(&run.bytes("mcap"));
        assert_eq!(messages.len(), 3);
        for (begin, message) in &messages[..2] {
            let end = seconds(0, begin + message.since[message.since.len() - 1]);
            let [raised, lowered] =
                [0.0, -0.12].map(|z| message.points.iter().filter(|point| point[0][quill] == z).count());
            assert!(
                raised > 2 && lowered == 2 && end <= number(&result["duration"]) + 1e-9,
                "{raised} {lowered} {end}"
            );
        }
    }
}

/// Checks turns that overlap with motions as a controller plays them, with and without a stroke: the wrist keeps its
/// limits, and the part has the old orientation until the turn begins, and the new one when it is released.
#[test]
fn the_wrist_turns_while_the_arm_moves() {
    for stroke in ["", ARCH] {
        let (resting, _) = plan_and_check(&CELL.replace("STROKE", &format!("{stroke}\narch = false")), &[]);
        let (run, verified) = plan_and_check(&CELL.replace("STROKE", stroke), &[]);
        assert_eq!(verified.expect("done").0, 0, "{stroke}");
        let (message, result) = (files::yaml(&run.text("yaml")), run.json());
        let saved = number(&resting.json()["duration"]) - number(&result["duration"]);
        assert!(saved > 0.1 && number(&result["lower_bound"]) <= number(&result["duration"]), "{saved} s saved");
        let (steps, events) = (&result["steps"], &result["events"]);
        let index = usize::from(steps[0]["turn"].is_null());
        let (step, turn) = (&steps[index], &steps[index]["turn"]);
        let seconds_of = |key: &str| turn.get(key).map_or(0.0, number);
        let begin = match seconds_of("before_arrival") {
            0.0 => number(&step["end"]) + seconds_of("after_departure") - number(&turn["seconds"]),
            before => number(&step["arrival"]) - before,
        };
        let orientation = |time: f64| {
            ["axis_1", "axis_2", "axis_4"].map(|joint| joint_state_at(&message, joint, time)[0]).iter().sum::<f64>()
        };
        let [grasp, release] = [0, 1].map(|event| number(&events[event]["time"]));
        let first = orientation(grasp);
        assert!((orientation(begin) - first).abs() < 1e-6, "{stroke}");
        let by = number(&turn["to"]) - number(&turn["from"]);
        let middle = orientation(begin + number(&turn["seconds"]) / 2.0) - first;
        assert!((middle - by / 2.0).abs() < 1e-3, "{middle} of {by}");
        for time in [begin + number(&turn["seconds"]), release] {
            assert!((orientation(time) - first - by).abs() < 1e-5, "{stroke}, at {time}");
        }
        // The wrist compensates and turns at once. Its limits hold during the turn.
        let wrist = message.joints.iter().position(|name| name == "axis_4").unwrap();
        let (mut checked, mut fastest) = (0, 0.0_f64);
        for k in 0..message.since.len() - 1 {
            let [from, to] = [k, k + 1].map(|k| seconds(0, message.since[k]));
            if from < begin - 1e-9 || to > begin + number(&turn["seconds"]) + 1e-9 || to - from < 2e-6 {
                continue;
            }
            for share in 0..=8 {
                let [_, v, a] = played(&message, k, wrist, (to - from) * f64::from(share) / 8.0);
                assert!(v.abs() <= 30.0 * (1.0 + 1e-6) && a.abs() <= 200.0 * (1.0 + 1e-3), "{v} {a} after sample {k}");
                (checked, fastest) = (checked + 1, fastest.max(v.abs()));
            }
        }
        assert!(checked > 20 && fastest > 1.0, "{checked} {fastest}");
    }
}

/// Checks arch motions as a controller plays them: the quill moves while the arm does, keeps its limits, is down at picks
/// and places, and the arm stands still there.
#[test]
fn the_quill_moves_while_the_arm_does() {
    let world = CELL.replace(", angle = 1.0", "");
    let (resting, _) = plan_and_check(&world.replace("STROKE", STROKE), &[]);
    let (run, verified) = plan_and_check(&world.replace("STROKE", ARCH), &[]);
    assert_eq!(verified.expect("done").0, 0);
    let (message, result) = (files::yaml(&run.text("yaml")), run.json());
    let saved = number(&resting.json()["duration"]) - number(&result["duration"]);
    let steps = result["steps"].as_array().unwrap();
    let overlap = |step: &Value, key: &str| step["stroke"].get(key).map_or(0.0, number);
    let overlaps: f64 =
        steps.iter().map(|step| overlap(step, "before_arrival") + overlap(step, "after_departure")).sum();
    assert!(saved > 0.4 && (saved - overlaps).abs() < 1e-6, "{saved} s saved, {overlaps} s overlap");
    assert!(number(&result["lower_bound"]) <= number(&result["duration"]));
    for (step, event) in steps.iter().zip(result["events"].as_array().unwrap()) {
        let time = number(&event["time"]);
        let dwell = if event["event"] == "release" { 0.2 } else { 0.1 };
        for time in [time + 1e-9, time + dwell / 2.0, time + dwell - 1e-6] {
            let [depth, speed] = joint_state_at(&message, "axis_3", time);
            assert!((depth + 0.12).abs() < 1e-6 && speed.abs() < 1e-4, "{event}: {depth}, {speed}");
            let still = ["axis_1", "axis_2"].map(|joint| joint_state_at(&message, joint, time)[1]);
            assert!(still.iter().all(|speed| speed.abs() < 1e-6), "the arm moves at {time}: {still:?}");
        }
        // The stroke down, by the formulas for constant acceleration: it begins before the arm arrives.
        let (seconds, begin) =
            (number(&step["stroke"]["seconds"]), number(&step["arrival"]) - overlap(step, "before_arrival"));
        assert!((begin + seconds - time).abs() < 1e-6, "{step}");
        for share in [0.1, 0.3, 0.5, 0.7, 0.9] {
            let depth = 0.12 * if share < 0.5 { 2.0 * share * share } else { 1.0 - 2.0 * (1.0_f64 - share).powi(2) };
            let [played, _] = joint_state_at(&message, "axis_3", begin + share * seconds);
            assert!((played + depth).abs() < 1e-5, "{played} at {share} of the stroke, not {}", -depth);
        }
    }
    let quill = message.joints.iter().position(|name| name == "axis_3").unwrap();
    for k in 0..message.since.len() - 1 {
        let duration = seconds(message.since[k], message.since[k + 1]);
        for share in 0..=16 {
            let [z, v, a] = played(&message, k, quill, duration * f64::from(share) / 16.0);
            let is_within =
                (-0.12 - 1e-9..=1e-9).contains(&z) && v.abs() <= 1.0 + 1e-6 && a.abs() <= 5.0 * (1.0 + 1e-4);
            assert!(is_within, "{z} {v} {a} after sample {k}");
        }
    }
    #[cfg(feature = "mcap")]
    {
        // One message per step, each from rest to rest; together they are the whole motion.
        let messages = files::mcap(&run.bytes("mcap"));
        assert_eq!(messages.len(), 3);
        for (begin, part) in &messages {
            for point in [&part.points[0], &part.points[part.points.len() - 1]] {
                assert!(point[1].iter().all(|speed| speed.abs() < 1e-9), "moves at an end of a step: {point:?}");
            }
            for k in 0..part.since.len() {
                let time = seconds(0, begin + part.since[k]);
                let [whole, _] = joint_state_at(&message, "axis_3", time);
                assert!((part.points[k][0][quill] - whole).abs() < 1e-9, "the quill differs at {time}");
            }
        }
    }
}

#[test]
fn the_wrist_levels_and_turns_the_payload() {
    let (run, _) = plan_and_check(&CELL.replace("STROKE", STROKE), &[]);
    let (message, result) = (files::yaml(&run.text("yaml")), run.json());
    // Three joints turn about z, so the orientation of the flange is the sum of their values.
    let level = |time: f64| {
        ["axis_1", "axis_2", "axis_4"].map(|joint| joint_state_at(&message, joint, time)[0]).iter().sum::<f64>()
    };
    let place = &result["steps"][1];
    assert_eq!(place["carried"], "part");
    let times = ["begin", "arrival"].map(|key| number(&place[key]));
    let held = level(times[0]);
    for i in 0..=300 {
        let time = times[0] + (times[1] - times[0]) * f64::from(i) / 300.0;
        assert!((level(time) - held).abs() < 1e-6, "turned by {} at {time}", level(time) - held);
    }
    let picked = &result["steps"][0];
    // The part turns from its initial orientation, 0, to that of its place, before or after the carrying motion.
    let turned = level(number(&result["events"][1]["time"])) - level(number(&result["events"][0]["time"]));
    assert!((turned - 1.0).abs() < 1e-6, "{turned}: {picked}");
    // Without a payload, the wrist returns to its rest position.
    assert!(joint_state_at(&message, "axis_4", number(&result["duration"]))[0].abs() < 1e-9);
}

#[test]
fn collisions_of_the_lowered_tool_are_found() {
    // The post is beside the place, and lower than everything that travels. It is nearer than the width of the flange,
    // which comes down to 0.06 m.
    let post =
        "[[obstacle]]\nname = \"stub\"\ncircle = { center = [0.35, -0.155], radius = 0.003 }\nheight = [0.0, 0.1]\n";
    let world = format!("{CELL}{post}").replace(", angle = 1.0", "");
    assert_eq!(plan_and_check(&world.replace("STROKE", ""), &[]).0.code, 0);
    let (run, _) = plan_and_check(&world.replace("STROKE", STROKE), &[]);
    assert_eq!(run.code, 3, "{}", run.errors);
    let reasons = run_json(&world);
    assert!(reasons.contains("while the tool is lowered") && reasons.contains("stub"), "{reasons}");
}

/// Returns the reasons why a step of the task fails, from the program's JSON result.
fn run_json(world: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("world.toml");
    std::fs::write(&file, world.replace("STROKE", STROKE)).unwrap();
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_cplan"))
        .args([&root("robots/scara.urdf"), &file])
        .args(["--json", "--quiet"])
        .output()
        .unwrap();
    let result: Value = serde_json::from_slice(&output.stdout).unwrap();
    result["failed"]["reasons"].to_string()
}

#[test]
fn strokes_that_cannot_be_are_refused() {
    for (stroke, words) in [
        ("stroke = { joint = \"axis_9\" }", ["no joint \"axis_9\"", "axis_3"]),
        ("stroke = { joint = \"axis_1\" }", ["axis_1", "one of the two planned joints"]),
        ("stroke = { joint = \"axis_4\" }", ["axis_4", "slides"]),
        ("stroke = { joint = \"axis_3\", travel = 0.0 }", ["travel", "other than 0"]),
        ("stroke = { joint = \"axis_3\", velocity = -1.0 }", ["velocity", "positive"]),
        ("stroke = { joint = \"axis_3\", travel = 0.3 }", ["part", "-0.18"]),
        ("stroke = { speed = 1.0 }", ["speed", "joint"]),
        ("arch = { rise = 0.1 }", ["arch", "stroke"]),
        ("stroke = { joint = \"axis_3\" }\narch = { rise = -0.1 }", ["rise", "negative"]),
        ("stroke = { joint = \"axis_3\" }\narch = { raise = 0.1 }", ["raise", "fall"]),
        ("stroke = { joint = \"axis_3\" }\narch = 3", ["rise", "false"]),
    ] {
        let (run, _) = plan_and_check(&CELL.replace("STROKE", stroke), &[]);
        assert_eq!(run.code, 1, "{stroke}");
        assert!(words.iter().all(|word| run.errors.contains(word)), "{stroke}: {}", run.errors);
    }
    let (run, _) = plan_and_check(&CELL.replace("STROKE", STROKE), &["--accelerations", "--jerk", "300,300"]);
    for part in ["accelerations cannot be written", "joint \"axis_3\" of the tool", "--joints planned"] {
        assert!(run.code == 1 && run.errors.contains(part), "{part}: {}", run.errors);
    }
    // The two planned joints alone have no jumps of the acceleration.
    let (run, _) = plan_and_check(
        &CELL.replace("STROKE", STROKE),
        &["--accelerations", "--jerk", "300,300", "--joints", "planned"],
    );
    assert_eq!(run.code, 0, "{}", run.errors);
}
