//! The motion of all joints in results of tasks, compared with the steps and with tables of the same motion.

use super::*;
use std::fmt::Write;

/// Returns the motion of all joints of a result as a table.
fn table(result: &Value) -> String {
    let all = &result["all_joints"];
    let names: Vec<String> = serde_json::from_value(all["joints"].clone()).unwrap();
    let rows = |of: &str| -> Vec<Vec<f64>> { serde_json::from_value(all[of].clone()).unwrap() };
    let time: Vec<f64> = serde_json::from_value(all["time"].clone()).unwrap();
    let velocities: Vec<String> = names.iter().map(|name| format!("{name}_velocity")).collect();
    let mut text = format!("time,{},{}\n", names.join(","), velocities.join(","));
    for ((time, q), v) in time.iter().zip(rows("position")).zip(rows("velocity")) {
        let numbers: Vec<String> = q.iter().chain(&v).map(f64::to_string).collect();
        writeln!(text, "{time},{}", numbers.join(",")).unwrap();
    }
    text
}

/// Changes the values of a joint in all samples. Its velocities become zero.
fn change(result: &mut Value, joint: &str, value: impl Fn(usize, f64) -> f64) {
    let all = &mut result["all_joints"];
    let column = all["joints"].as_array().unwrap().iter().position(|name| name == joint).unwrap();
    for (k, row) in all["position"].as_array_mut().unwrap().iter_mut().enumerate() {
        row[column] = value(k, row[column].as_f64().unwrap()).into();
    }
    for row in all["velocity"].as_array_mut().unwrap() {
        row[column] = 0.0.into();
    }
}

/// Returns true if a fault states that a joint is elsewhere than according to the steps.
fn blames(found: &Value, joint: &str) -> bool {
    let mut faults = found["faults"].as_array().unwrap().iter().filter_map(Value::as_str);
    let place = format!(" s, joint \"{joint}\" is at ");
    faults.any(|fault| {
        fault.starts_with("all_joints: at ") && fault.contains(&place) && fault.contains("according to the steps")
    })
}

/// Holds the tool low during the whole motion into a box, whose sides it would hit.
#[test]
fn a_tool_that_is_held_low_gets_the_same_verdict_in_json_and_csv() {
    let files = shipped("scara", "arch/into_the_box");
    let result = plan_result(&files[0], &files[1], "");
    assert_eq!(findings(&files, "plan.json", result.to_string())["verdict"], "free");
    assert_eq!(findings(&files, "plan.csv", table(&result))["verdict"], "free");
    let mut low = result.clone();
    let positions = result["all_joints"]["position"].as_array().unwrap();
    let joints = result["all_joints"]["joints"].as_array().unwrap();
    let quill = joints.iter().position(|name| name == "axis_3").unwrap();
    let lowest = positions.iter().map(|row| row[quill].as_f64().unwrap()).fold(f64::INFINITY, f64::min);
    change(&mut low, "axis_3", |_, _| lowest);
    let [json, csv] =
        [("low.json", low.to_string()), ("low.csv", table(&low))].map(|(name, text)| findings(&files, name, &text));
    assert_eq!(json["verdict"], "collision", "{:#}", json["faults"]);
    assert_eq!(csv["verdict"], "collision", "{csv:#}");
    assert_eq!(json["first_contact"], csv["first_contact"]);
    assert!(blames(&json, "axis_3"), "{:#}", json["faults"]);
}

#[test]
fn a_result_without_steps_is_judged_by_its_motion_of_all_joints() {
    let files = shipped("scara", "arch/into_the_box");
    let mut result = plan_result(&files[0], &files[1], "");
    let members = result.as_object_mut().unwrap();
    // The path of a whole task does not state its blends.
    members.retain(|member, _| !["steps", "events", "path", "length"].contains(&member.as_str()));
    let found = findings(&files, "plan.json", result.to_string());
    assert_eq!(found["verdict"], "free", "{found:#}");
    let slides =
        |found: &Value| found["notes"].to_string().contains("joint \\\"axis_3\\\" slides between -0.15 and 0 m");
    assert!(slides(&found), "{found:#}");
}

/// Compares the tool's joints of whole tasks with the steps: picks, places, and turns on the way. Then moves each of
/// the joints to and fro.
#[test]
fn joints_that_move_differently_from_the_steps_are_refused() {
    for (robot, world) in
        [("scara", "tasks/kitting_cell"), ("scara", "arch/pick_and_place"), ("scara", "arch/into_the_box")]
    {
        let files = shipped(robot, world);
        let result = plan_result(&files[0], &files[1], "");
        let found = findings(&files, "plan.json", result.to_string());
        assert_eq!(found["verdict"], "free", "{world}: {:#}", found["faults"]);
        let joints: Vec<String> = serde_json::from_value(result["all_joints"]["joints"].clone()).unwrap();
        for joint in &joints {
            let mut moved = result.clone();
            change(&mut moved, joint, |k, value| if k % 2 == 1 { value - 0.01 } else { value });
            let found = findings(&files, "plan.json", moved.to_string());
            assert_ne!(found["verdict"], "free", "{world} {joint}");
            assert!(blames(&found, joint), "{world} {joint}: {:#}", found["faults"]);
        }
    }
}
