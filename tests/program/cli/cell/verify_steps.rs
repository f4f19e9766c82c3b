//! `cplan verify` of the results of cells whose arms have steps: true ones, and changed ones.

use super::super::{Place, number};
use super::shipped;
use serde_json::{Value, json};

/// Plans a shipped cell. Returns the path of its file, and the result.
fn planned(place: &Place, name: &str) -> (String, Value) {
    let cell = shipped(&format!("workspaces/cells/{name}.toml"));
    place.run(&["cell", &cell], "--quiet --output cell.json").exits(0);
    (cell, serde_json::from_str(&place.read("cell.json")).unwrap())
}

/// Judges a result, and returns the exit code and the answer.
fn judged(place: &Place, cell: &str, result: &Value, options: &str) -> (i32, Value) {
    place.write("changed.json", result.to_string());
    let done = place.run(&["verify", cell], &format!("changed.json --json --quiet {options}"));
    (done.code, super::answer(&done))
}

/// Changes a result, and returns the verdict with all faults.
fn verdict(place: &Place, cell: &str, result: &Value, change: impl FnOnce(&mut Value)) -> (String, String) {
    let mut changed = result.clone();
    change(&mut changed);
    let (code, answer) = judged(place, cell, &changed, "");
    assert_eq!(code == 0, answer["verdict"] == "free", "{answer:#}");
    let of_arms = answer["arms"].as_array().unwrap().iter().map(|arm| arm["findings"]["faults"].to_string());
    let faults: Vec<String> = of_arms.chain([answer["faults"].to_string()]).collect();
    (answer["verdict"].as_str().unwrap().to_owned(), faults.join(" "))
}

fn add(value: &mut Value, by: f64) {
    if let Some(time) = value.as_f64() {
        *value = json!(time + by);
    }
}

/// Moves everything that an arm does from a time on.
fn shift(result: &mut Value, arm: usize, from: f64, by: f64) {
    let is_later = |time: &Value| time.as_f64().is_some_and(|time| time >= from - 1e-9);
    let arm = &mut result["arms"][arm];
    let times = arm["trajectory"]["time"].as_array_mut().unwrap();
    times.iter_mut().filter(|time| is_later(time)).for_each(|time| add(time, by));
    for step in arm["steps"].as_array_mut().unwrap() {
        for key in ["begin", "arrival", "event", "end"] {
            if is_later(&step[key]) {
                add(&mut step[key], by);
            }
        }
    }
}

#[test]
fn results_with_steps_are_free() {
    for (name, counts) in [("handover", [5, 5]), ("kitting", [7, 7]), ("kitting_one_arm", [13, 1])] {
        let place = Place::new();
        let (cell, result) = planned(&place, name);
        let (code, answer) = judged(&place, &cell, &result, "");
        assert_eq!(
            (code, &answer["verdict"], &answer["faults"]),
            (0, &"free".into(), &json!([])),
            "{name}: {answer:#}"
        );
        for (arm, count) in counts.into_iter().enumerate() {
            let steps = answer["arms"][arm]["findings"]["steps"].as_array().unwrap();
            assert_eq!(steps.len(), count, "{name}");
        }
        let [proven, required] = [number(&answer["between"]["clearance"]), number(&answer["required"])];
        assert!(proven >= required && required > 0.0, "{name}: {proven} {required}");
        let stated = number(&result["clearance_between"]);
        assert!((proven - stated).abs() < 0.2 * stated, "{name}: {proven} {stated}");
        place
            .run(&["verify", &cell, "cell.json"], "")
            .exits(0)
            .says(&["all steps, among the obstacles and between the arms, proven"]);
    }
}

#[test]
fn changed_results_with_steps_are_refused() {
    let place = Place::new();
    let (cell, result) = planned(&place, "handover");
    let verdict = |change: &dyn Fn(&mut Value)| verdict(&place, &cell, &result, change);
    // Shifts of a whole motion lead to collisions of the arms.
    for by in [-0.5, 0.5, 1.0] {
        let (verdict, _) = verdict(&|result| shift(result, 1, f64::NEG_INFINITY, by));
        assert_eq!(verdict, "collision", "{by}");
    }
    // If nobody takes the first bracket away, the second one meets it.
    let mut late = result.clone();
    shift(&mut late, 1, f64::NEG_INFINITY, 100.0);
    let (_, answer) = judged(&place, &cell, &late, "");
    let links = answer["between"]["first"]["links"].as_str().unwrap();
    assert!(links.contains("bracket 1") && links.contains("bracket 2"), "{answer:#}");
    let time = number(&result["handovers"][0]["placed"]);
    let early = number(&result["handovers"][0]["taken"]) - time;
    let (_, faults) = verdict(&|result| shift(result, 1, f64::NEG_INFINITY, -early - 0.1));
    assert!(faults.contains("but left has placed it only at"), "{faults}");
    // The arm is not at the object that it picks.
    let (of_point, faults) = verdict(&|result| {
        let arrival = number(&result["arms"][0]["steps"][0]["arrival"]);
        let trajectory = &mut result["arms"][0]["trajectory"];
        let times = trajectory["time"].as_array().unwrap();
        let at =
            (0..times.len()).find(|k| number(&times[*k]) > arrival - 1e-9).map(|k| trajectory["position"][k].clone());
        for place in trajectory["position"].as_array_mut().unwrap() {
            if Some(&*place) == at.as_ref() {
                add(&mut place[0], 1e-3);
            }
        }
    });
    assert!(of_point == "task" && faults.contains("step 1 (cycle 1): the tip ends 0.3"), "{of_point} {faults}");
    for (change, expected, named) in [
        (
            &(|result: &mut Value| {
                let steps = result["arms"][1]["steps"].as_array_mut().unwrap();
                let [one, three] = [0, 2].map(|k| steps[k]["file_step"].clone());
                (steps[0]["file_step"], steps[2]["file_step"]) = (three, one);
            }) as &dyn Fn(&mut Value),
            "task",
            "but the world requires step 1",
        ),
        (
            &|result| {
                result["arms"][1]["steps"].as_array_mut().unwrap().pop();
            },
            "task",
            "after 4 steps the world requires step 5",
        ),
        (&|result| add(&mut result["arms"][0]["steps"][1]["end"], 0.01), "task", "left, step 2: the tool needs"),
        (
            &|result| add(&mut result["arms"][0]["steps"][1]["event"], 0.01),
            "claims",
            "left: steps[1].event is stated as",
        ),
        (&|result| add(&mut result["handovers"][1]["placed"], 0.01), "claims", "handovers[1].placed is stated as"),
        (
            &|result| result["arms"][0]["steps"][1]["turn"] = json!({ "from": 0.0, "to": 0.1, "seconds": 0.0 }),
            "task",
            "left leaves it 0.000 mm and -0.100000 rad from the place from which right takes it",
        ),
        (&|result| result["arms"][0]["steps"][0]["object"] = json!("bracket 2"), "claims", "bracket 2"),
        (&|result| result["clearance_between"] = json!(0.5), "claims", "states that the arms keep 500.0 mm"),
    ] {
        let (verdict, faults) = verdict(change);
        assert!(verdict == expected && faults.contains(named), "{named}: {verdict} {faults}");
    }
}

#[test]
fn files_without_steps_are_refused() {
    let place = Place::new();
    let (cell, mut result) = planned(&place, "handover");
    place.write("left.csv", "time,axis_1,axis_2\n0,1,1\n1,1,1\n");
    place.run(&["verify", &cell, "left.csv", "left.csv"], "").refused(1, &["the arms have steps", "cell.json"]);
    result["arms"][1]["steps"][0].as_object_mut().unwrap().remove("begin");
    place.write("changed.json", result.to_string());
    place
        .run(&["verify", &cell, "changed.json"], "")
        .refused(1, &["changed.json", "arm \"right\": steps[0] has no number \"begin\"", "hint: "]);
}
