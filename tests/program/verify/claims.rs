//! Results with one false claim: the judge finds every change of each claim that it checks.

use super::*;
use cplan::input::Overrides;
use cplan_cases::dice::Dice;

/// A robot and a world, and the program's result for them.
struct Case {
    files: [PathBuf; 2],
    result: Value,
}

impl Case {
    fn new(robot: &str, world: &str) -> Self {
        Self::of(shipped(robot, world))
    }

    /// Returns a shipped task with five steps.
    fn tower() -> Self {
        Self::new("rrbot_vertical", "tasks/tower")
    }

    fn of(files: [PathBuf; 2]) -> Self {
        let result = plan_result(&files[0], &files[1], "");
        assert_eq!(result["status"], "found", "{}", files[1].display());
        Self { files, result }
    }

    /// Returns the findings about a result, or the error.
    fn findings_or_error(&self, result: &Value, question: &Question) -> Value {
        let found = judged(&self.files, "r.json", result.to_string(), question);
        found.unwrap_or_else(|error| Value::String(error.to_string()))
    }

    /// Returns the findings about a motion or task, with the start and goal that its world states.
    fn findings(&self, result: &Value) -> Value {
        self.findings_or_error(result, &Question::default())
    }

    #[track_caller]
    fn refused(&self, change: impl FnOnce(&mut Value), verdict: &str, part: &str) {
        let mut result = self.result.clone();
        change(&mut result);
        let found = self.findings(&result);
        assert_eq!(found["verdict"], verdict, "{found:#}");
        assert!(found["faults"].to_string().contains(part), "{found:#}");
    }
}

#[test]
fn unchanged_results_have_no_false_claims() {
    for (robot, world) in [("planar_2r", "shelf"), ("planar_2r", "two_branches"), ("scara", "scara_cell")] {
        let case = Case::new(robot, world);
        let found = case.findings(&case.result);
        assert_eq!((&found["verdict"], &found["faults"]), (&json!("free"), &Value::Null), "{world}: {found:#}");
        let unjudged = found["not_judged"].to_string();
        assert!(unjudged.contains("planner") && unjudged.contains("optimum.lower_bound"), "{unjudged}");
    }
}

#[test]
fn claims_about_a_missing_motion_are_named() {
    let case = Case::new("planar_2r", "shelf");
    let mut result = case.result.clone();
    result["trajectory"] = Value::Null;
    let found = case.findings(&result);
    assert_eq!(found["verdict"], "free", "{found:#}");
    assert!(found["not_judged"].to_string().contains("\"duration\""), "{found:#}");
    let upright = Case::new("rrbot_vertical", "upright");
    let mut result = upright.result.clone();
    result["trajectory"]["torque"] = json!([[0, 0]]);
    let found = upright.findings(&result);
    assert_eq!(found["verdict"], "free", "{found:#}");
    assert!(found["not_judged"].to_string().contains("trajectory.torque"), "{found:#}");
    result["units"] = json!(["rad"]);
    let error = upright.findings(&result);
    assert!(error.as_str().is_some_and(|error| error.contains("there are 2 joints")), "{error:#}");
}

#[test]
fn a_colliding_path_beside_a_good_trajectory_is_found() {
    let case = Case::new("planar_2r", "shelf");
    let ends = [0, case.result["path"].as_array().unwrap().len() - 1].map(|k| case.result["path"][k].clone());
    let straight = |result: &mut Value| result["path"] = json!(ends);
    case.refused(straight, "claims", "the path is not free");
    // The false path is found even if all reported data of the path fits it.
    let straight = |result: &mut Value| {
        result["path"] = json!(ends);
        let d: Vec<f64> = (0..2).map(|k| ends[1][k].as_f64().unwrap() - ends[0][k].as_f64().unwrap()).collect();
        result["length"] = json!(d[0].hypot(d[1]));
        result["blends"] = json!({"count": 0, "largest_radius": d[0].hypot(d[1])});
        result.as_object_mut().unwrap().remove("optimum");
    };
    case.refused(straight, "claims", "the path is not free");
}

#[test]
fn a_motion_that_does_not_lead_from_start_to_goal_is_found() {
    let place = Place::new().with("free.toml", "[start]\njoints = [-0.9, 0.4]\n[goal]\njoints = [1.55, -0.35]\n");
    let case = Case::of([root("robots/planar_2r.urdf"), place.path("free.toml")]);
    let only = |samples: std::ops::Range<usize>| {
        let mut result = json!({"joints": case.result["joints"], "trajectory": {}});
        for key in ["time", "position"] {
            result["trajectory"][key] = json!(case.result["trajectory"][key].as_array().unwrap()[samples.clone()]);
        }
        result
    };
    let count = case.result["trajectory"]["time"].as_array().unwrap().len();
    for (samples, part) in [(1..count, "begins at"), (0..count - 1, "ends at"), (3..4, "begins at")] {
        let found = case.findings(&only(samples.clone()));
        assert_eq!(found["verdict"], "ends", "{found:#}");
        assert!(found["faults"].to_string().contains(part), "{found:#}");
        assert_eq!(case.findings_or_error(&only(samples), &Question::with_free_ends())["verdict"], "free");
    }
    assert_eq!(case.findings(&only(0..count))["verdict"], "free");
    for overrides in [
        Overrides { goal: Some("1.5,0".parse().unwrap()), ..Overrides::default() },
        Overrides { goal_tip: Some("0.5,0.5".parse().unwrap()), ..Overrides::default() },
        Overrides { start: Some("0,0".parse().unwrap()), ..Overrides::default() },
    ] {
        let found = case.findings_or_error(&only(0..count), &Question { overrides, ..Question::default() });
        assert_eq!(found["verdict"], "ends", "{found:#}");
    }
    // Any IK solution satisfies a goal of the tip.
    let case = Case::new("planar_2r", "two_branches");
    let count = case.result["trajectory"]["time"].as_array().unwrap().len();
    let path = case.result["path"].as_array().unwrap();
    let other = Case {
        files: case.files.clone(),
        result: json!({"joints": case.result["joints"], "path": [path[0], [0.0, 0.0]]}),
    };
    assert!(count > 1 && other.findings(&other.result)["faults"].to_string().contains("the tip"));
}

#[test]
fn each_false_claim_of_a_motion_is_named() {
    let case = Case::new("planar_2r", "shelf");
    let kept = case.result["clearance"].as_f64().unwrap();
    case.refused(|r| r["status"] = json!("infeasible"), "claims", "status");
    case.refused(|r| r["certified"] = json!(false), "claims", "certified");
    case.refused(|r| r["units"] = json!(["rad", "m"]), "claims", "units");
    case.refused(|r| r["length"] = json!(3.0), "claims", "length");
    case.refused(|r| r["clearance"] = json!(1.2 * kept), "claims", "clearance");
    case.refused(|r| r["clearance"] = Value::Null, "claims", "no obstacle within reach");
    case.refused(|r| r["duration"] = json!(1.0), "claims", "duration");
    case.refused(|r| r["blends"]["count"] = json!(500), "claims", "blends.count");
    case.refused(|r| r["blends"]["largest_radius"] = json!(0.0), "claims", "does not follow");
    case.refused(|r| r["optimum"]["length"] = json!(3.0), "claims", "optimum.length");
    case.refused(|r| r["optimum"]["lower_bound"] = json!(9.0), "claims", "optimum.lower_bound");
    case.refused(|r| r["optimum"]["gap"] = json!(0.25), "claims", "optimum.gap");
    case.refused(|r| r["optimum"]["metric"] = json!("weighted"), "claims", "optimum.metric");
    let mut less = case.result.clone();
    less["clearance"] = json!(0.5 * kept);
    let found = case.findings(&less);
    assert_eq!(found["verdict"], "free", "a weaker claim is true: {found:#}");
}

#[test]
fn each_false_claim_of_a_task_is_named() {
    let case = Case::tower();
    let found = case.findings(&case.result);
    assert_eq!((&found["verdict"], &found["faults"]), (&json!("free"), &Value::Null), "{found:#}");
    case.refused(|r| r["events"][0]["time"] = json!(0.01), "claims", "events[0].time");
    case.refused(|r| r["events"][0]["event"] = json!("release"), "claims", "events[0].event");
    case.refused(|r| r["events"][1]["object"] = json!("nothing"), "claims", "events[1].object");
    case.refused(|r| r["events"][1]["tip"][1] = json!(0.9), "claims", "events[1].tip");
    case.refused(|r| r["events"][1]["pose"]["at"][0] = json!(0.9), "claims", "events[1].pose.at");
    case.refused(|r| r["events"][1]["pose"]["angle"] = json!(0.9), "claims", "events[1].pose.angle");
    case.refused(|r| drop(r["events"].as_array_mut().unwrap().pop()), "claims", "the gripper acts");
    case.refused(|r| r["events"] = json!([]), "claims", "the gripper acts");
    case.refused(|r| r["steps"][0]["action"] = json!("place"), "claims", "steps[0].action");
    case.refused(|r| r["steps"][1]["carried"] = Value::Null, "claims", "steps[1].carried");
    case.refused(|r| r["steps"][1]["object"] = json!("nothing"), "claims", "steps[1].object");
    case.refused(|r| r["steps"][2]["arrival"] = json!(0.0), "claims", "steps[2].arrival");
    case.refused(|r| r["steps"][2]["clearance"] = json!(1.0), "claims", "steps[2].clearance");
    case.refused(|r| r["clearance"] = json!(1.0), "claims", "clearance");
    case.refused(|r| r["steps"][0]["length"] = json!(1.0), "claims", "steps[0].length");
    case.refused(|r| r["path"][0][0] = json!(1.0), "claims", "path");
    case.refused(|r| r["trajectory"]["step"][0] = json!(1), "claims", "trajectory.step");
    case.refused(|r| r["duration"] = json!(1.0), "claims", "duration");
}

/// Adds to `found` all numbers, words and booleans of a result that are claims, as JSON pointers.
fn leaves(value: &Value, at: String, found: &mut Vec<String>) {
    match value {
        Value::Object(members) => members.iter().for_each(|(key, value)| leaves(value, format!("{at}/{key}"), found)),
        Value::Array(items) => items.iter().enumerate().for_each(|(k, item)| leaves(item, format!("{at}/{k}"), found)),
        Value::Null => {}
        _ => found.push(at),
    }
}

/// Returns true if the judge detects every change of this claim.
fn is_judged(pointer: &str) -> bool {
    let words: Vec<&str> = pointer.split('/').skip(1).collect();
    let last = words[words.len() - 1];
    match words[0] {
        "status" | "certified" | "units" | "length" | "clearance" | "duration" | "events" | "path" => true,
        "optimum" => matches!(last, "length" | "gap"),
        "trajectory" => words[1] == "step",
        "steps" => {
            let judged = ["action", "object", "carried", "begin", "arrival", "end", "path", "length", "clearance"];
            judged.contains(&words[2])
        }
        _ => false,
    }
}

/// Returns a false value for a claim. A clearance is a lower bound, so only a greater value is false.
fn different_value(value: &Value, pointer: &str, dice: &mut Dice) -> Value {
    match value {
        Value::Bool(value) => json!(!value),
        Value::String(text) => json!(format!("{text}x")),
        Value::Number(number) if number.is_u64() && !pointer.ends_with("length") => {
            json!(number.as_u64().unwrap() + 1 + dice.below(3_u64))
        }
        Value::Number(number) => {
            let value = number.as_f64().unwrap();
            let by = 10f64.powf(dice.within(-3.0, 0.0)) * (1.0 + value.abs());
            let up = pointer.ends_with("clearance") || dice.chance(0.5);
            json!(if up { value + by + 0.05 * f64::from(u8::from(pointer.ends_with("clearance"))) } else { value - by })
        }
        other => other.clone(),
    }
}

#[test]
fn any_judged_claim_that_is_changed_is_found() {
    let cases = [Case::new("planar_2r", "shelf"), Case::new("scara", "scara_cell"), Case::tower()];
    let judged: Vec<Vec<String>> = cases
        .iter()
        .map(|case| {
            let mut found = Vec::new();
            leaves(&case.result, String::new(), &mut found);
            found.retain(|pointer| is_judged(pointer));
            found
        })
        .collect();
    for seed in cplan_cases::seeds(36) {
        let mut dice = Dice::new(seed);
        let k = dice.below(cases.len());
        let pointer = &judged[k][dice.below(judged[k].len())];
        let mut result = cases[k].result.clone();
        let place = result.pointer_mut(pointer).unwrap();
        let other = different_value(place, pointer, &mut dice);
        *place = other.clone();
        let found = cases[k].findings(&result);
        let is_refuted = found["verdict"].as_str().is_some_and(|verdict| !["free", "undecided"].contains(&verdict));
        assert!(is_refuted, "seed {seed}: {pointer} as {other}: {found:#}");
    }
}
