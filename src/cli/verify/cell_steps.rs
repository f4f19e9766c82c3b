//! The steps in a result of `cplan cell`: those that the file states, compared with those of the motions.

use crate::cli::cell::{assignment_json, handover_json, step_json};
use cplan_cell::{Cell, HandoverTimes, JudgedSteps, StepTimes, ToolTimes};
use serde_json::{Map, Value, json};

/// Largest difference between a stated value and that of the motions, seconds, metres or radians.
const TOLERANCE: f64 = 1e-6;

/// The members of a step that the replay of the arm's motion needs.
const REPLAYED: [&str; 6] = ["cycle", "object", "turn", "raising", "stroke", "wrist"];

/// Returns the steps of an arm in the form of one arm's result, with the times at which its tool acts.
///
/// # Errors
/// The member that is missing, or is not a number.
pub fn read(arm: &Value) -> Result<(Value, Vec<ToolTimes>), String> {
    let none = Vec::new();
    let steps = arm["steps"].as_array().ok_or("there are no steps")?;
    let samples: Vec<f64> =
        arm["trajectory"]["time"].as_array().unwrap_or(&none).iter().filter_map(Value::as_f64).collect();
    let nearest = |time: f64| {
        let far = |sample: &usize| (samples[*sample] - time).abs();
        (0..samples.len()).min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(0)
    };
    let clock = samples.first().copied().unwrap_or(0.0);
    let (mut replayed, mut tools) = (Vec::new(), Vec::new());
    for (index, step) in steps.iter().enumerate() {
        let number = |key: &str| step[key].as_f64().ok_or_else(|| format!("steps[{index}] has no number \"{key}\""));
        let [begin, arrival, end] = [number("begin")?, number("arrival")?, number("end")?];
        number("file_step")?;
        let mut members: Map<String, Value> =
            REPLAYED.map(|key| (key.to_owned(), step[key].clone())).into_iter().collect();
        members.extend([
            ("step".to_owned(), step["file_step"].clone()),
            ("first_sample".to_owned(), json!(nearest(begin))),
            ("last_sample".to_owned(), json!(nearest(arrival))),
            ("begin".to_owned(), json!(begin - clock)),
            ("arrival".to_owned(), json!(arrival - clock)),
        ]);
        replayed.push(Value::Object(members));
        tools.push(ToolTimes { raising: step["raising"]["begin"].as_f64(), end });
    }
    Ok((Value::Array(replayed), tools))
}

/// Returns the statements of a result about steps that disagree with the motions.
pub fn false_statements(cell: &Cell, stated: &Value, judged: &JudgedSteps) -> Vec<String> {
    let mut found = Vec::new();
    for (arm, steps) in cell.arms.iter().zip(&judged.steps) {
        let own = stated["arms"].as_array().and_then(|arms| arms.iter().find(|one| one["name"] == arm.name.as_str()));
        let steps: Vec<Value> = steps.iter().map(|step: &StepTimes| step_json(step)).collect();
        compare(
            &own.map_or(Value::Null, |own| own["steps"].clone()),
            &json!(steps),
            &format!("{}: steps", arm.name),
            &mut found,
        );
    }
    let mut handovers: Vec<Value> =
        judged.handovers.iter().map(|times: &HandoverTimes| handover_json(cell, times)).collect();
    let place = |handover: &Value| {
        let stated = stated["handovers"].as_array()?;
        stated.iter().position(|known| known["object"] == handover["object"])
    };
    handovers.sort_by_key(place);
    compare(&stated["handovers"], &json!(handovers), "handovers", &mut found);
    let assignment = judged.assignment.as_ref().map(|names| assignment_json(cell, names));
    compare(&stated["assignment"], &json!(assignment), "assignment", &mut found);
    found
}

/// Adds the differences of a stated value from that of the motions. `place` names the value.
fn compare(stated: &Value, is: &Value, place: &str, found: &mut Vec<String>) {
    match (stated, is) {
        (Value::Object(stated), Value::Object(is)) => {
            for (key, is) in is {
                compare(stated.get(key).unwrap_or(&Value::Null), is, &format!("{place}.{key}"), found);
            }
        }
        (Value::Array(stated), Value::Array(is)) if stated.len() == is.len() => {
            for (index, (stated, is)) in stated.iter().zip(is).enumerate() {
                compare(stated, is, &format!("{place}[{index}]"), found);
            }
        }
        _ => {
            let is_near = stated.as_f64().zip(is.as_f64()).is_some_and(|(a, b)| (a - b).abs() <= TOLERANCE);
            if stated != is && !is_near {
                found.push(format!("{place} is stated as {stated}, but by the motions it is {is}"));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_named_by_their_places() {
        let is = json!({ "a": [{ "time": 1.0, "name": "x" }], "b": null });
        let differences = |stated: Value| {
            let mut found = Vec::new();
            compare(&stated, &is, "all", &mut found);
            found
        };
        assert_eq!(differences(json!({ "a": [{ "time": 1.0 + 1e-9, "name": "x", "more": 1 }] })), [""; 0]);
        let wrong = differences(json!({ "a": [{ "time": 1.1, "name": "y" }], "b": 2 }));
        assert_eq!(wrong.len(), 3, "{wrong:?}");
        assert!(
            wrong.contains(&"all.a[0].time is stated as 1.1, but by the motions it is 1.0".to_owned()),
            "{wrong:?}"
        );
        assert_eq!(differences(json!({ "a": [] })).len(), 1);
    }
}
