//! Results of tasks: the program's own ones, unchanged and tampered with, and in other worlds.

use super::*;
/// A shipped task with its plan.
struct Shipped {
    robot: PathBuf,
    world: String,
    result: Value,
}

/// Plans a shipped task with turns of the wrist at rest.
fn resting_task(name: &str) -> Shipped {
    let task = shipped_task(name).in_world("[robot]", "[robot]\narch = false");
    let result = plan_result(&task.robot, &task.written().path("world.toml"), "");
    Shipped { result, ..task }
}

fn shipped_task(name: &str) -> Shipped {
    let file = root(&format!("workspaces/tasks/{name}.toml"));
    let world = std::fs::read_to_string(&file).unwrap();
    let robot = world.lines().find_map(|line| line.strip_prefix("# robot: ")).unwrap();
    let robot = root(&format!("robots/{}.urdf", robot.trim()));
    let result = plan_result(&robot, &file, "");
    assert_eq!(result["status"], "found", "{name}");
    Shipped { robot, world, result }
}

impl Shipped {
    /// Returns a folder with the world and the result.
    fn written(&self) -> Place {
        Place::new().with("world.toml", &self.world).with("task.json", self.result.to_string())
    }

    /// Runs `verify` about the result.
    fn report(&self, options: &str) -> Done {
        self.written().run(&["verify", self.robot.to_str().unwrap(), "world.toml", "task.json"], options)
    }

    /// Returns the findings about the result.
    fn findings(&self) -> Value {
        let place = self.written();
        findings(&[self.robot.clone(), place.path("world.toml")], "task.json", self.result.to_string())
    }

    /// Returns the same result for a world with one text replaced.
    fn in_world(mut self, thing: &str, other: &str) -> Self {
        assert!(self.world.contains(thing), "{thing}");
        self.world = self.world.replacen(thing, other, 1);
        self
    }

    /// Returns the first and last sample of a step.
    fn samples(&self, step: usize) -> [usize; 2] {
        let sample = |key: &str| self.result["steps"][step][key].as_u64().unwrap() as usize;
        [sample("first_sample"), sample("last_sample")]
    }

    fn change(&mut self, key: &str, sample: usize, change: impl Fn(f64) -> f64) {
        match &mut self.result["trajectory"][key][sample] {
            Value::Array(row) => row.iter_mut().for_each(|v| *v = json!(change(v.as_f64().unwrap()))),
            value => *value = json!(change(value.as_f64().unwrap())),
        }
    }

    fn time(&self, sample: usize) -> f64 {
        self.result["trajectory"]["time"][sample].as_f64().unwrap()
    }

    fn count(&self) -> usize {
        self.result["trajectory"]["time"].as_array().unwrap().len()
    }

    /// Checks the verdict on the whole recording. Also checks that exactly these steps, counted from 0, are refuted.
    #[track_caller]
    fn refuted(&self, verdict: &str, steps: &[usize]) -> Value {
        let found = self.findings();
        assert_eq!(found["verdict"], verdict, "{found:#}");
        let of_steps = found["steps"].as_array().unwrap();
        let wrong: Vec<usize> = (0..of_steps.len()).filter(|&k| of_steps[k]["verdict"] != "free").collect();
        assert_eq!(wrong, steps, "{found:#}");
        assert!(steps.iter().any(|&k| of_steps[k]["verdict"] == verdict) || steps.is_empty());
        found
    }
}

#[test]
fn our_own_tasks_are_free_and_their_clearances_agree() {
    for (name, count) in [("kitting_cell", 24), ("tower", 5), ("board_turned", 3), ("feeder", 300), ("sorting", 8)] {
        let task = shipped_task(name);
        let found = task.findings();
        assert_eq!((&found["verdict"], &found["faults"]), (&json!("free"), &Value::Null), "{name}: {found:#}");
        assert_eq!(found["limits_broken"], json!([]), "{name}");
        let (ours, theirs) = (found["steps"].as_array().unwrap(), task.result["steps"].as_array().unwrap());
        assert_eq!((ours.len(), theirs.len()), (count, count), "{name}");
        for (ours, theirs) in ours.iter().zip(theirs) {
            for key in ["step", "cycle", "object", "carried", "first_sample", "last_sample"] {
                assert_eq!(ours[key], theirs[key], "{name}, {key}");
            }
            let turn = [&ours["turn"], &theirs["turn"]].map(|turn| Value::as_f64(&turn["clearance"]));
            // A part of a turn on the way has no clearance at rest.
            let overlaps = ["before_arrival", "after_departure"].iter().any(|key| theirs["turn"].get(key).is_some());
            assert!(
                turn[0] == turn[1] || (overlaps && turn[0].is_none_or(|least| turn[1].is_some_and(|t| least >= t)))
            );
            let bound = turn[0].into_iter().chain(Value::as_f64(&ours["clearance"])).reduce(f64::min);
            // Both are at least 0.9 of the same distance: one is of the curve, the other of the cubics between samples.
            match (bound, Value::as_f64(&theirs["clearance"])) {
                (Some(a), Some(b)) => assert!(a >= 0.89 * b && b >= 0.89 * a, "{name}: {a}, {b} in {ours:#}"),
                (a, b) => assert_eq!(a, b, "{name}"),
            }
        }
        assert!(Value::as_f64(&found["clearance"]).unwrap() > 0.0);
    }
}

#[test]
fn the_summary_has_a_line_a_step() {
    shipped_task("feeder").report("").exits(0).says(&[
        "step       1 (cycle 1)  pick \"part\"",
        "... 291 steps in cycles 4 to 100",
        "the whole task, 300 steps",
        "whether each step is a step of the world",
    ]);
    let turned = shipped_task("board_turned").in_world("velocity = 3.0", "velocity = 0.3");
    let words = ["not as required", "task       step 2 (cycle 1): the wrist turns in 0.", "result     not the task"];
    turned.report("").exits(3).says(&words);
    let quiet = turned.report("--quiet").exits(3);
    assert_eq!((quiet.stdout, quiet.stderr), (String::new(), String::new()));
}

#[test]
fn a_sample_in_an_obstacle_is_found() {
    let mut task = shipped_task("board_turned");
    let [first, last] = task.samples(2);
    let middle = (first + last) / 2;
    task.result["trajectory"]["position"][middle] = json!([1.0, 0.4]);
    let found = task.refuted("collision", &[2]);
    let hit = &found["steps"][2]["first_contact"];
    assert!(hit["obstacle"].as_str().unwrap().ends_with("wall"), "{hit:#}");
    let (time, sample) = (Value::as_f64(&hit["time"]).unwrap(), hit["sample"].as_u64().unwrap() as usize);
    assert!(task.time(sample) <= time && time <= task.time(middle) && sample == middle - 1, "{hit:#}");
    assert_eq!(&found["first_contact"], hit);
}

#[test]
fn an_object_elsewhere_is_found() {
    let task = shipped_task("sorting").in_world("at = [0.25, 0.45]", "at = [0.25, 0.40]");
    let steps = task.result["steps"].as_array().unwrap();
    let picked = steps.iter().position(|step| step["action"] == "pick" && step["object"] == "red").unwrap();
    let found = task.findings();
    assert_eq!(found["verdict"], "task", "{found:#}");
    for (at, what) in [(picked, "the tip ends 50.00 mm"), (picked + 1, "the object's origin ends 50.00 mm")] {
        let step = &found["steps"][at];
        assert_eq!(step["verdict"], "task");
        assert!(step["faults"][0].as_str().unwrap().starts_with(what), "{step:#}");
    }
}

#[test]
fn steps_in_a_forbidden_order_are_found() {
    // Pairs of a free group may come in any order.
    let sorting = shipped_task("sorting");
    let numbers = |task: &Shipped| {
        let steps = task.result["steps"].as_array().unwrap();
        steps.iter().map(|step| step["step"].as_u64().unwrap()).collect::<Vec<_>>()
    };
    assert!(!numbers(&sorting).is_sorted());
    assert_eq!(sorting.findings()["verdict"], "free");

    let mut tower = shipped_task("tower");
    tower.result["steps"][0]["step"] = json!(3);
    tower.result["steps"][2]["step"] = json!(1);
    let found = tower.refuted("task", &[]);
    assert_eq!(found["faults"], json!(["steps[0] is step 3 (cycle 1), but the world requires step 1 (cycle 1)"]));

    let mut tower = shipped_task("tower");
    tower.result["steps"].as_array_mut().unwrap().swap(3, 4);
    assert_eq!(tower.refuted("task", &[])["steps"].as_array().unwrap().len(), 3);

    let mut tower = shipped_task("tower");
    tower.result["steps"].as_array_mut().unwrap().pop();
    assert_eq!(
        tower.refuted("task", &[])["faults"][0],
        "after 4 steps the world requires step 5 (cycle 1), but the file ends"
    );

    let mut feeder = shipped_task("feeder");
    feeder.result["steps"][4]["cycle"] = json!(3);
    assert!(feeder.refuted("task", &[])["faults"][0].as_str().unwrap().contains("requires step 2 (cycle 2)"));

    // A place that is another pair's.
    let mut sorting = shipped_task("sorting");
    let number = |k: usize| sorting.result["steps"][k]["step"].clone();
    let (one, other) = (number(1), number(3));
    sorting.result["steps"][1]["step"] = other;
    sorting.result["steps"][3]["step"] = one;
    assert_eq!(sorting.refuted("task", &[])["steps"].as_array().unwrap().len(), 1);
}

#[test]
fn samples_that_belong_to_no_step_are_found() {
    let mut tower = shipped_task("tower");
    let [_, last] = tower.samples(1);
    tower.result["steps"][1]["last_sample"] = json!(last - 3);
    // The rest of the motion ends elsewhere, and not at rest.
    let found = tower.refuted("task", &[1]);
    assert!(found["faults"].to_string().contains("outside all steps"), "{found:#}");
    assert!(found["steps"][1]["limits_broken"].to_string().contains("rest at end"), "{found:#}");

    let mut tower = shipped_task("tower");
    let [first, _] = tower.samples(2);
    tower.result["steps"][2]["first_sample"] = json!(first - 5);
    assert!(tower.refuted("task", &[])["faults"][0].as_str().unwrap().starts_with("steps[2] begins with sample"));
}

#[test]
fn shortened_rests_are_found() {
    let mut tower = shipped_task("tower");
    let [_, last] = tower.samples(1);
    (last + 1..tower.count()).for_each(|sample| tower.change("time", sample, |time| time - 0.2));
    let found = tower.refuted("task", &[1]);
    assert_eq!(found["steps"][1]["faults"], json!(["the arm stands still for 0.100000 s, not for 0.300000 s"]));
}

#[test]
fn a_step_that_is_too_fast_is_found() {
    let mut tower = shipped_task("tower");
    let [first, last] = tower.samples(1);
    let [begin, end] = [first, last].map(|sample| tower.time(sample));
    for sample in first..=last {
        tower.change("time", sample, |time| begin + (time - begin) / 2.0);
        tower.change("velocity", sample, |velocity| 2.0 * velocity);
    }
    (last + 1..tower.count()).for_each(|sample| tower.change("time", sample, |time| time - (end - begin) / 2.0));
    let found = tower.refuted("limits", &[1]);
    let broken = found["limits_broken"].as_array().unwrap();
    assert!(!broken.is_empty() && broken == found["steps"][1]["limits_broken"].as_array().unwrap());
    let sample = broken[0]["sample"].as_u64().unwrap() as usize;
    assert!((first..=last).contains(&sample), "{broken:#?}");
}

#[test]
fn a_different_turn_is_found() {
    let reversed = |from: f64, to: f64| {
        let mut task = resting_task("board_turned");
        task.result["steps"][1]["turn"]["from"] = json!(from);
        task.result["steps"][1]["turn"]["to"] = json!(to);
        task
    };
    let to = Value::as_f64(&resting_task("board_turned").result["steps"][1]["turn"]["to"]).unwrap();
    let found = reversed(to, 0.0).refuted("task", &[1, 2]);
    assert_eq!(
        found["steps"][1]["faults"],
        json!(["the recorded turn of the wrist begins 1.570800 rad away from the object's orientation"])
    );
    // The turn has the other direction, in the time of the shorter one.
    let found = reversed(0.0, to - std::f64::consts::TAU).refuted("task", &[1]);
    assert!(found["steps"][1]["faults"][0].as_str().unwrap().starts_with("the wrist turns in"), "{found:#}");
    // Without the turn, the board does not pass in its first orientation.
    let mut task = resting_task("board_turned");
    task.result["steps"][1]["turn"] = Value::Null;
    task.refuted("collision", &[2]);
    // The post blocks only the turn.
    let post = "[[obstacle]]\nname = \"post\"\ncircle = { center = [0.52, 1.1], radius = 0.01 }\nheight = [0.0, 0.04]\n\n[[object]]";
    let found = resting_task("board_turned").in_world("[[object]]", post).findings();
    let turn = &found["steps"][1]["turn"];
    assert_eq!((&found["steps"][1]["verdict"], &turn["contact"]["obstacle"]), (&json!("collision"), &json!("post")));
    // The post's centre is 0.12 from the tip, and the board's long side 0.06. They touch when the centre is 0.07 from
    // the board's axis, in either direction of the turn.
    let expected = (0.07_f64 / 0.12).acos();
    let angle = |turn: &Value| Value::as_f64(&turn["contact"]["angle"]).unwrap();
    assert!((angle(turn) - expected).abs() < 1e-6, "{turn:#}");
    let back = reversed(0.0, to - std::f64::consts::TAU).in_world("[[object]]", post).findings();
    assert!((angle(&back["steps"][1]["turn"]) + expected).abs() < 1e-6, "{back:#}");
}

/// Checks turns that overlap with a motion: in the other direction, at other times, and past a post that only the turning
/// board meets.
#[test]
fn a_different_turn_on_the_way_is_found() {
    let changed = |key: &str, value: f64| {
        let mut task = shipped_task("board_turned");
        task.result["steps"][1]["turn"][key] = json!(value);
        task
    };
    let turn = shipped_task("board_turned").result["steps"][1]["turn"].clone();
    let [to, seconds] = ["to", "seconds"].map(|key| Value::as_f64(&turn[key]).unwrap());
    assert_eq!(Value::as_f64(&turn["after_departure"]), Some(seconds));
    let found = changed("to", to - std::f64::consts::TAU).findings();
    let of_motion = found["steps"][2]["faults"].to_string();
    assert!(of_motion.contains("the wrist exceeds its limits while the arm moves"), "{found:#}");
    // The arm must rest for the part that is not on the way.
    let found = changed("after_departure", seconds / 2.0).refuted("task", &[1]);
    assert!(found["steps"][1]["faults"].to_string().contains("the arm stands still for"), "{found:#}");
    // The board turns too late to pass the gate.
    let found = changed("after_departure", 2.0 * seconds).findings();
    assert_eq!(found["steps"][2]["verdict"], "collision", "{found:#}");
    let found = changed("before_arrival", 0.1).findings();
    assert!(found["steps"][1]["faults"].to_string().contains("neither after a pick nor before a place"), "{found:#}");
    let found = changed("after_departure", 9.0).findings();
    assert!(found["steps"][2]["faults"].to_string().contains("overlap with the motion for"), "{found:#}");
    let world = "[robot]\narch = false";
    let found = shipped_task("board_turned").in_world("[robot]", world).findings();
    assert!(found["steps"][2]["faults"].to_string().contains("which the world forbids"), "{found:#}");
    changed("after_departure", -1.0).report("").exits(1).warns(&["the turn's after_departure is -1"]);
}

#[test]
fn missing_supports_are_found() {
    let task = shipped_task("tower").in_world("at = [0.50, 0.45]\nsupports = [\"table\"]", "at = [0.50, 0.45]");
    let found = task.refuted("collision", &[1]);
    let hit = &found["first_contact"];
    assert_eq!((&hit["obstacle"], &hit["body"]), (&json!("table"), &json!("base block")), "{hit:#}");
}

#[test]
fn a_larger_payload_is_found() {
    let board = |half: f64| format!("[[-{half}, -0.15], [{half}, -0.15], [{half}, 0.15], [-{half}, 0.15]]");
    let task = shipped_task("board_turned").in_world(&board(0.06), &board(0.12));
    let hit = &task.refuted("collision", &[2])["first_contact"];
    assert_eq!(hit["body"], "board");
    assert!(hit["obstacle"].as_str().unwrap().ends_with("wall"), "{hit:#}");
}

#[test]
fn a_different_start_is_found() {
    let tower = shipped_task("tower");
    tower.report("--start 0.6,0.8 --quiet").exits(0);
    tower.report("--start 0.6,0.7").exits(3).says(&["step 1 (cycle 1): the motion does not begin at the start"]);
    tower.report("--picture a.svg").exits(2).warns(&["--picture"]);
    // A clearance that is greater than the actual distance.
    shipped_task("sorting").report("--clearance 0.01").exits(3).says(&["too near by"]);
}

#[test]
fn a_file_without_steps_is_one_motion() {
    let mut tower = shipped_task("tower");
    tower.result.as_object_mut().unwrap().remove("steps");
    let found = tower.findings();
    assert!(found["steps"].is_null());
    assert!(found["notes"].to_string().contains("the world has steps, but the file has none"), "{found:#}");
    tower.report("--start 0,0").exits(3).says(&["not at the start (0, 0)"]);
}

#[test]
fn steps_that_are_none_are_refused() {
    let tower = shipped_task("tower");
    let with = |change: &dyn Fn(&mut Value)| {
        let mut task = Shipped { robot: tower.robot.clone(), world: tower.world.clone(), result: tower.result.clone() };
        change(&mut task.result);
        task.report("")
    };
    let refused = |steps: Value, parts: &[&str]| {
        with(&|result| result["steps"] = steps.clone()).refused(1, &[&["task.json"], parts].concat());
    };
    let step = |members: Value| {
        let mut step = json!({"step": 1, "cycle": 1, "first_sample": 0, "last_sample": 1});
        step.as_object_mut().unwrap().extend(members.as_object().unwrap().clone());
        json!([step])
    };
    refused(json!(7), &["line 1", "hint"]);
    refused(json!([1]), &["line 1"]);
    refused(json!([{}]), &["missing field `step`"]);
    refused(json!([{"step": 1}]), &["missing field `cycle`"]);
    refused(step(json!({"step": -1})), &["line 1"]);
    refused(step(json!({"step": 1.5})), &["line 1"]);
    refused(step(json!({"cycle": "one"})), &["line 1"]);
    refused(step(json!({"first_sample": null})), &["steps[0]", "first_sample or last_sample is missing"]);
    refused(step(json!({"first_sample": 1, "last_sample": 0})), &["steps[0]", "samples of the step are 1 to 0"]);
    refused(step(json!({"last_sample": u64::MAX})), &["steps[0]", "the trajectory has"]);
    refused(step(json!({"turn": {"from": 0.0, "to": 1.0}})), &["missing field `seconds`"]);
    refused(step(json!({"turn": {"from": 0.0, "to": 1e300, "seconds": 1.0}})), &["the turn's to is 1"]);
    for member in ["/trajectory/velocity", "/trajectory"] {
        let (owner, key) = member.rsplit_once('/').unwrap();
        let done = with(&|result| drop(result.pointer_mut(owner).unwrap().as_object_mut().unwrap().remove(key)));
        done.exits(1).warns(&["lacks time, position or velocity"]);
    }
    // No steps, or numbers that the world does not have, are not the task.
    for steps in [json!([]), step(json!({"step": 99})), step(json!({"cycle": 0}))] {
        with(&|result| result["steps"] = steps.clone()).exits(3).says(&["not the task"]);
    }
}
