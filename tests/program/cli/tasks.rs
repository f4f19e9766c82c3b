//! Worlds with steps.

use super::*;
use cplan::check::limit_violations;
use cplan::input::load_scene;
use cplan::model::Arm;
use cplan::space::{Configuration, Recording};
use cplan_cases::plane::distance;

/// A world with two objects, of which one is held by a wrist, and with a post as an obstacle. The steps are added to
/// it.
const CELL: &str = r#"name = "cell"
[robot]
wrist = { velocity = 6.0, acceleration = 60.0 }
[start]
joints = [0.3, 0.4]
[[obstacle]]
name = "post"
circle = { center = [1.45, 0.25], radius = 0.02 }
height = [0.0, 0.3]
[[object]]
name = "part"
polygon = [[-0.02, -0.02], [0.02, -0.02], [0.02, 0.02], [-0.02, 0.02]]
at = [1.1, 0.9]
renew = true
[[object]]
name = "cup"
circle = { center = [0.0, 0.0], radius = 0.03 }
at = [0.4, 1.3]
angle = 0.5
payload = "level"
renew = true
"#;

/// Steps that end in pauses. The last step moves nothing.
const STEPS: &str = r#"[[step]]
pick = "part"
dwell = 0.2
[[step]]
place = { at = [1.4, -0.5] }
speed = 0.5
[[step]]
pick = "cup"
[[step]]
place = { at = [0.9, -1.0], angle = 1.5 }
dwell = 0.1
[[step]]
move = { joints = [0.3, 0.4] }
[[step]]
move = { joints = [0.3, 0.4] }
"#;

const REPEATED: &str = "[task]\nrepeat = 5\n";

/// Steps that place the part into the post.
const BARRED: &str = "[[step]]\npick = \"part\"\n[[step]]\nplace = { at = [1.45, 0.25] }\n";
/// Steps with a target in the post. The arm could also turn the object during the motion.
const DOUBTFUL: &str = "[[step]]\npick = \"cup\"\n[[step]]\nplace = { at = [1.45, 0.25], angle = 1.0 }\n";

impl Place {
    fn task(&self, steps: &str, options: &str) -> Done {
        self.plan(format!("{CELL}{steps}"), options)
    }

    /// Returns the arm of the last task.
    fn arm(&self) -> Arm {
        load_scene(Path::new(&shipped("robots/planar_2r.urdf")), &self.path("world.toml")).unwrap().scene.into_parts().0
    }
}

fn numbers(value: &Value) -> Vec<f64> {
    serde_json::from_value(value.clone()).unwrap()
}

fn rows(value: &Value) -> Vec<[f64; 2]> {
    serde_json::from_value(value.clone()).unwrap()
}

/// Checks that position, velocity and limits agree: the judge of recorded motions finds no fault, and both ends are at
/// rest.
fn moves_within_limits(arm: &Arm, time: &[f64], position: &[[f64; 2]], velocity: &[[f64; 2]]) {
    let vectors = |rows: &[[f64; 2]]| rows.iter().map(|row| Configuration::new(row[0], row[1])).collect();
    let recording = Recording::new(vectors(position), Some(time.to_vec()), Some(vectors(velocity))).unwrap();
    assert_eq!(limit_violations(&arm.joints, &recording), []);
}

/// Checks the properties that every finished task must have.
fn consistent(arm: &Arm, result: &Value) {
    assert_eq!((&result["status"], &result["certified"]), (&json!("found"), &json!(true)));
    let trajectory = &result["trajectory"];
    let (time, position, velocity) =
        (numbers(&trajectory["time"]), rows(&trajectory["position"]), rows(&trajectory["velocity"]));
    let of_sample: Vec<usize> = serde_json::from_value(trajectory["step"].clone()).unwrap();
    assert_eq!([position.len(), velocity.len(), of_sample.len()], [time.len(); 3]);
    moves_within_limits(arm, &time, &position, &velocity);
    let steps = result["steps"].as_array().unwrap();
    let number = |step: &Value, key: &str| step[key].as_f64().unwrap();
    let sample = |step: &Value, key: &str| step[key].as_u64().unwrap() as usize;
    let mut path: Vec<[f64; 2]> = Vec::new();
    for (i, step) in steps.iter().enumerate() {
        let (first, last) = (sample(step, "first_sample"), sample(step, "last_sample"));
        let own = rows(&step["path"]);
        assert_eq!((position[first], position[last]), (own[0], own[own.len() - 1]), "step {i}");
        assert_eq!((velocity[first], velocity[last]), ([0.0; 2], [0.0; 2]), "step {i}");
        assert_eq!((time[first], time[last]), (number(step, "begin"), number(step, "arrival")), "step {i}");
        assert!((first..last).all(|k| of_sample[k] == i), "step {i}");
        let end = steps.get(i + 1).map_or(time[time.len() - 1], |next| {
            let follows = sample(next, "first_sample");
            assert!(follows == last || (follows == last + 1 && of_sample[last] == i), "step {i}");
            number(next, "begin")
        });
        assert_eq!(number(step, "end"), end, "step {i}");
        let length: f64 = own.windows(2).map(|leg| distance(leg[0], leg[1])).sum();
        assert!((length - number(step, "length")).abs() < 1e-12, "step {i}");
        assert!(number(result, "clearance") <= number(step, "clearance"), "step {i}");
        path.extend(&own[usize::from(path.last() == own.first())..]);
    }
    assert_eq!(rows(&result["path"]), path);
    let length: f64 = steps.iter().map(|step| number(step, "length")).sum();
    assert!((length - number(result, "length")).abs() < 1e-12);
    let (duration, lower) = (number(result, "duration"), number(result, "lower_bound"));
    assert!(duration == time[time.len() - 1] && 0.0 < lower && lower <= duration);
    assert!((number(result, "gap") - (duration / lower - 1.0)).abs() < 1e-12);

    let handling: Vec<&Value> = steps.iter().filter(|step| !step["object"].is_null()).collect();
    let events = result["events"].as_array().unwrap();
    assert_eq!(events.len(), handling.len());
    for (event, step) in events.iter().zip(handling) {
        assert_eq!(
            (&event["step"], &event["cycle"], &event["object"]),
            (&step["step"], &step["cycle"], &step["object"])
        );
        let own = rows(&step["path"]);
        let at = arm.tip_at(own[own.len() - 1].into());
        let output: [f64; 2] = serde_json::from_value(event["tip"].clone()).unwrap();
        assert!(distance(output, at.into()) < 1e-12, "{event}");
        let (time, arrival) = (number(event, "time"), number(step, "arrival"));
        if event["event"] == "grasp" {
            assert_eq!((&step["action"], &step["carried"], time), (&json!("pick"), &Value::Null, arrival));
            assert!(event.get("pose").is_none());
        } else {
            let turn = step["turn"]["seconds"].as_f64().unwrap_or(0.0);
            assert_eq!((&step["action"], &step["carried"]), (&json!("place"), &step["object"]));
            let before = step["turn"]["before_arrival"].as_f64().unwrap_or(0.0);
            assert!((time - (arrival + turn - before)).abs() < 1e-12 || (before >= turn && time == arrival));
        }
    }
}

#[test]
fn a_task_is_one_motion_with_steps_and_events() {
    let place = Place::new();
    let result = place.task(STEPS, "--json").exits(0).json();
    consistent(&place.arm(), &result);
    let steps = result["steps"].as_array().unwrap();
    let words: Vec<_> = steps.iter().map(|step| [&step["action"], &step["object"], &step["carried"]]).collect();
    let (part, cup, none) = (json!("part"), json!("cup"), Value::Null);
    let [pick, put, go] = ["pick", "place", "move"].map(|word| json!(word));
    assert_eq!(
        words,
        [
            [&pick, &part, &none],
            [&put, &part, &part],
            [&pick, &cup, &none],
            [&put, &cup, &cup],
            [&go, &none, &none],
            [&go, &none, &none]
        ]
    );
    // Here the hand grips objects at their origins.
    for (event, i) in result["events"].as_array().unwrap().iter().zip(0..) {
        let own = rows(&steps[i]["path"]);
        let goes_to = [[1.1, 0.9], [1.4, -0.5], [0.4, 1.3], [0.9, -1.0]][i];
        assert!(distance(tip(own[own.len() - 1]), goes_to) < 1e-9, "{event}");
        assert!(event["event"] == "grasp" || event["pose"]["at"] == json!(goes_to), "{event}");
    }
    let still = |i: usize| steps[i]["end"].as_f64().unwrap() - steps[i]["arrival"].as_f64().unwrap();
    let turned = |i: usize| steps[i]["turn"]["seconds"].as_f64().unwrap_or(0.0);
    assert!((still(0) - 0.2).abs() < 1e-12 && still(1) == 0.0 && still(4) == 0.0);
    // The wrist turns the cup by 1 rad after the pick or before the release: 1 / 6 s at top speed, 6 / 60 s to reach
    // it, or up to twice as long while the arm moves. Times are whole nanoseconds.
    let least = 1.0 / 6.0 + 0.1;
    let overlap = |i: usize| {
        let seconds = |key: &str| steps[i]["turn"][key].as_f64().unwrap_or(0.0);
        seconds("before_arrival") + seconds("after_departure")
    };
    let [turned, hidden] = [turned(2) + turned(3), overlap(2) + overlap(3)];
    assert!((least - 1e-8..=2.0 * least).contains(&turned) && (0.0..=turned).contains(&hidden), "{turned} {hidden}");
    assert!(
        (still(2) + still(3) - (turned - hidden + 0.1)).abs() < 1e-8 && turned - hidden < least,
        "{turned} {hidden}"
    );
    assert_eq!((&steps[5]["first_sample"], &steps[5]["path"]), (&steps[5]["last_sample"], &json!([[0.3, 0.4]])));
}

#[test]
fn repeated_tasks_are_counted_in_cycles() {
    let place = Place::new();
    let world = format!("{STEPS}{REPEATED}");
    let result = place.task(&world, "--json --quiet").json();
    consistent(&place.arm(), &result);
    let cycles: Vec<_> = result["steps"].as_array().unwrap().iter().map(|s| s["cycle"].as_u64().unwrap()).collect();
    assert_eq!(cycles, (0..30).map(|i| i / 6 + 1).collect::<Vec<_>>());
    let text = place.task(&world, "--verbose").stdout;
    has(
        &text,
        &["1 obstacle, 2 objects", "1 (cycle 3)", "... 12 steps in cycles 4 to 5", "found and certified: 30 steps"],
    );
    has(&text, &["carrying \"cup\"", "every sequence of motions takes at least", "closest: ", "motions planned"]);
    assert!(!text.contains("(cycle 4)"), "{text}");
}

#[test]
fn shipped_tasks_are_consistent() {
    for (robot, world) in [("scara", "feeder"), ("room_gantry", "room_mission"), ("rrbot_vertical", "tower")] {
        let files =
            [format!("robots/{robot}.urdf"), format!("workspaces/tasks/{world}.toml")].map(|file| shipped(&file));
        let done = Place::new().run(&files, "--json --quiet").succeeds_silently();
        let [urdf, world] = files.each_ref().map(Path::new);
        consistent(load_scene(urdf, world).unwrap().scene.arm(), &done.json());
    }
}

#[test]
fn the_first_step_that_fails_is_named() {
    let place = Place::new();
    for (steps, code, status, verdict) in [
        (BARRED, 3, "infeasible", "result     infeasible: step 2, place at (1.45, 0.25) m"),
        (DOUBTFUL, 4, "unknown", "result     unknown: neither a motion for step 2"),
    ] {
        place.write("a.csv", "old");
        let done = place.task(steps, "--output a.csv --json");
        let result = done.json();
        assert_eq!((done.code, &result["status"], &result["certified"]), (code, &json!(status), &json!(false)));
        for key in ["path", "length", "clearance", "trajectory"] {
            assert!(result.as_object().unwrap().contains_key(key) && result[key].is_null(), "{key}");
        }
        let failed = &result["failed"];
        assert_eq!((&failed["step"], &failed["cycle"], &failed["action"]), (&json!(2), &json!(1), &json!("place")));
        assert!(failed["place"].as_str().unwrap().contains("world.toml:"), "{failed}");
        let reasons = failed["reasons"].as_array().unwrap();
        assert!(reasons.iter().any(|reason| reason.as_str().unwrap().contains("post")), "{failed}");
        assert_eq!(&failed["from"], result["steps"][0]["path"].as_array().unwrap().last().unwrap());
        let ik_solutions = failed["postures"].as_array().unwrap();
        let ends = rows(&ik_solutions.iter().map(|ik_solution| ik_solution["joints"].clone()).collect());
        assert!(
            !ends.is_empty() && ik_solutions.iter().all(|ik_solution| ik_solution["reason"].is_string()),
            "{failed}"
        );
        let off = |q: [f64; 2]| (tip(q)[0] - 1.45).hypot(tip(q)[1] - 0.25);
        assert!(ends.into_iter().all(|q| off(q) < 1e-9), "{failed}");
        let before = result["steps"].as_array().unwrap();
        assert_eq!((before.len(), &before[0]["action"]), (1, &json!("pick")));
        assert!(before[0]["path"].as_array().unwrap().len() > 1 && before[0]["first_sample"].is_null());
        assert_eq!(result["events"].as_array().unwrap().len(), 1);
        assert!(
            done.stderr.contains(
                "a.csv is not written: the result has no trajectory; the existing file of this name is from an earlier run"
            ),
            "{}",
            done.stderr
        );
        assert_eq!(place.read("a.csv"), "old");
        let text = place.task(steps, "").stdout;
        assert_eq!(place.task(steps, "--quiet --picture a.svg").code, code);
        assert!(place.read("a.svg").contains(if code == 3 { "step 2 fails: proven" } else { "step 2 fails: unknown" }));
        has(&text, &[verdict, "why ", "1 step planned"]);
    }
}

#[test]
fn the_same_task_gives_the_same_bytes() {
    let place = Place::new();
    let names = ["a.json", "a.csv", "a.yaml", "a.svg", "a.html"];
    let outputs = "--output a.json --output a.csv --output a.yaml --picture a.svg --picture a.html";
    let read = || names.map(|name| place.read(name));
    assert_eq!(place.task(STEPS, outputs).code, 0);
    let before = read();
    let again = place.task(STEPS, &format!("{outputs} --json"));
    assert!(read() == before && again.stdout == before[0]);
    assert!(before[3].starts_with("<svg") && before[3].contains("found, certified"));
    let timed = place.task(STEPS, "--json --timings").json();
    assert!(timed["timings"]["plan"].is_number() && !before[0].contains("timings"));

    let table: Vec<Vec<&str>> = before[1].lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(table[0].last(), Some(&"step"));
    let steps: Vec<usize> = serde_json::from_value(again.json()["trajectory"]["step"].clone()).unwrap();
    let column: Vec<usize> = table[1..].iter().map(|row| row[5].parse().unwrap()).collect();
    assert_eq!(column, steps.iter().map(|step| step + 1).collect::<Vec<_>>());
    assert_eq!(before[2].matches("time_from_start").count(), steps.len());
}

#[test]
fn each_step_has_a_file_of_its_own() {
    let place = Place::new().with("a-007.csv", "old");
    let done = place.task(STEPS, "--per-step --output a.csv --output a.yaml --output a.json").exits(0);
    assert!(done.stdout.contains("a-001.csv to a-006.csv") && done.stderr.contains("a-007.csv"), "{}", done.stderr);
    assert!(!place.path("a.csv").exists() && !place.path("a.yaml").exists() && !place.path("a-001.json").exists());
    let result = place.json("a.json");
    let whole = rows(&result["trajectory"]["position"]);
    for (i, step) in result["steps"].as_array().unwrap().iter().enumerate() {
        let text = place.read(&format!("a-{:03}.csv", i + 1));
        let table: Vec<Vec<f64>> =
            text.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
        assert!(table.iter().all(|row| row[5] == (i + 1) as f64));
        let column = |k: usize| table.iter().map(|row| row[k]).collect::<Vec<f64>>();
        let pairs = |k: usize| table.iter().map(|row| [row[k], row[k + 1]]).collect::<Vec<_>>();
        let [first, last] = ["first_sample", "last_sample"].map(|key| step[key].as_u64().unwrap() as usize);
        assert_eq!((column(0)[0], pairs(1)), (0.0, whole[first..=last].to_vec()));
        let seconds = step["arrival"].as_f64().unwrap() - step["begin"].as_f64().unwrap();
        assert!((column(0)[table.len() - 1] - seconds).abs() < 1e-12);
        moves_within_limits(&place.arm(), &column(0), &pairs(1), &pairs(3));
        let message: Value = serde_saphyr::from_str(&place.read(&format!("a-{:03}.yaml", i + 1))).unwrap();
        assert_eq!(message["points"].as_array().unwrap().len(), table.len());
    }
}

#[test]
fn options_unsupported_for_steps_are_refused() {
    let place = Place::new();
    let refused = |options: &str, code: i32, part: &str| place.task(STEPS, options).refused(code, &[part]);
    refused("--gap 0.01", 2, "--gap does not apply to worlds with steps");
    refused("--per-step", 2, "--per-step needs an --output");
    refused("--per-step --output a.json", 2, ".csv or .yaml");
    refused("--goal 0.1,0.2", 1, "goal");
    let plain = "[start]\njoints = [-0.9, 0.4]\n[goal]\njoints = [1.55, -0.35]\n";
    place.plan(plain, "--per-step --output a.csv").refused(2, &["--per-step needs a world with steps"]);
    std::fs::create_dir(place.path("a-002.csv")).unwrap();
    refused("--per-step --output a.csv", 1, "a-002.csv");
    assert!(!place.path("a-001.csv").exists(), "nothing is written if not all can be");
}

#[cfg(feature = "mcap")]
#[test]
fn a_recording_has_a_message_for_each_motion() {
    let place = Place::new();
    let result = place.task(STEPS, "--per-step --output a.csv --output a.mcap --json").json();
    let file = std::fs::read(place.path("a.mcap")).unwrap();
    let topic = |topic: &str| {
        let messages = mcap::MessageStream::new(&file).unwrap().map(Result::unwrap);
        messages.filter(|message| message.channel.topic == topic).map(|message| message.log_time).collect::<Vec<u64>>()
    };
    let steps = result["steps"].as_array().unwrap();
    let begins: Vec<u64> = steps.iter().map(|step| (step["begin"].as_f64().unwrap() * 1e9).round() as u64).collect();
    assert_eq!(topic("/joint_trajectory"), begins);
    let sample = |step: &Value, key: &str| step[key].as_u64().unwrap() as usize;
    let samples: usize = steps.iter().map(|step| sample(step, "last_sample") - sample(step, "first_sample") + 1).sum();
    // If the arm does not rest between two steps, they share a state.
    let shared = steps.windows(2).filter(|pair| sample(&pair[0], "last_sample") == sample(&pair[1], "first_sample"));
    assert_eq!(topic("/joint_states").len(), samples - shared.count());
}

/// Checks pictures of a task with a clearance. The supports shrink in the configuration space of the payload, because
/// their radius is negative.
#[test]
fn supports_that_recede_are_drawn() {
    let place = Place::new();
    let options = "--clearance 0.005 --picture plan.svg --picture plan.html";
    place.run(&[shipped("robots/rrbot_vertical.urdf"), shipped("workspaces/tasks/tower.toml")], options).exits(0);
    assert!(place.read("plan.svg").contains("</svg>") && place.read("plan.html").contains("\"worlds\""));
}

/// Checks a bar that fits into a bay in few directions only. The walls of the configuration space then span the full
/// turn of the first joint, and no taut path leads around their ends.
#[test]
fn walls_all_round_a_joint_have_no_end() {
    let place = Place::new();
    place.write(
        "world.toml",
        "[robot]\npayload = \"level\"\n[start]\njoints = [-0.5, 1.0]\n[[obstacle]]\nheight = [-2, -1]\n\
         polyline = [[0.3, 0.7], [0.4, 0.6], [0.6, 0.7], [0.5, 0.8], [0.3, 0.8]]\n[[object]]\nname = \"bar\"\n\
         polygon = [[0.05, -0.001], [-0.043, 0.001], [-0.05, 0.001]]\nat = [0.742, -1.169]\nheight = [-2, -1]\n\
         [[step]]\npick = \"bar\"\n[[step]]\nplace = { at = [0.4, 0.7] }\n",
    );
    let urdf = shipped("robots/planar_2r_continuous.urdf");
    has(&place.certified(&urdf, "world.toml", "--output plan.json", 0).1, &["does all 2 steps"]);
}
