//! Motions with limits on jerks, as `verify` judges them in the files of the planner.

use super::*;
use cplan_cases::plane::{distance, distance_to_segment};

/// Worlds with corners whose legs are short and long.
const WORLDS: [&str; 5] = ["shelf", "discs", "limits_open", "two_branches", "crowd"];

fn files(world: &str) -> [PathBuf; 2] {
    shipped("planar_2r", world)
}

/// Returns the findings about a result.
fn findings(world: &str, result: &Value) -> Value {
    super::findings(&files(world), "plan.json", result.to_string())
}

fn rows(of: &Value) -> Vec<[f64; 2]> {
    serde_json::from_value(of.clone()).unwrap()
}

/// Returns the greatest distance from the nearest corner at which the motion of a result is off its path by more than a
/// millionth. Joins the samples by cubics.
fn rounded_within(result: &Value) -> f64 {
    let path = rows(&result["path"]);
    let samples = &result["trajectory"];
    let time: Vec<f64> = serde_json::from_value(samples["time"].clone()).unwrap();
    let (position, velocity) = (rows(&samples["position"]), rows(&samples["velocity"]));
    let mut farthest = 0.0_f64;
    for k in 1..time.len() {
        let span = time[k] - time[k - 1];
        for step in 0..8 {
            let u = f64::from(step) / 8.0;
            let at = [0, 1].map(|j| {
                let [p, q, v, w] =
                    [position[k - 1][j], position[k][j], span * velocity[k - 1][j], span * velocity[k][j]];
                let basis = [2.0 * u - 3.0, 3.0 - 2.0 * u, u - 2.0, u - 1.0];
                p + p * u * u * basis[0] + q * u * u * basis[1] + v * (u + u * u * basis[2]) + w * u * u * basis[3]
            });
            let off =
                path.windows(2).map(|leg| distance_to_segment(at, [leg[0], leg[1]])).fold(f64::INFINITY, f64::min);
            if off > 1e-6 {
                let corners = &path[1..path.len() - 1];
                farthest =
                    farthest.max(corners.iter().map(|corner| distance(*corner, at)).fold(f64::INFINITY, f64::min));
            }
        }
    }
    farthest
}

#[test]
fn verify_accepts_results_with_limits_on_jerks() {
    let mut rounded = 0;
    for (world, jerk) in WORLDS.into_iter().flat_map(|world| ["20,20", "50,50", "200,200"].map(|jerk| (world, jerk))) {
        let [robot, file] = files(world);
        let result = plan_result(&robot, &file, &format!("--jerk {jerk}"));
        let found = findings(world, &result);
        assert_eq!(found["verdict"], "free", "{world} {jerk}: {:#}", found["faults"]);
        let (stated, is) = (result["blends"]["largest_radius"].as_f64().unwrap(), rounded_within(&result));
        assert!(is <= stated + 1e-6, "{world} {jerk}: {is} {stated}");
        rounded += result["blends"]["count"].as_u64().unwrap();
    }
    assert!(rounded > 100, "{rounded}");
}

#[test]
fn motions_with_limits_on_jerks_leave_the_path_only_within_the_blend() {
    for (world, jerk, blend) in [
        ("shelf", "20,20", 0.05),
        ("discs", "50,50", 0.05),
        ("limits_open", "20,20", 0.02),
        ("two_branches", "20,20", 0.05),
        ("crowd", "50,50", 0.1),
    ] {
        let [robot, file] = files(world);
        let plan = |blend: &str| plan_result(&robot, &file, &format!("--jerk {jerk} --blend {blend}"));
        let (result, stopping) = (plan(&blend.to_string()), plan("none"));
        let [is, stated] = [rounded_within(&result), result["blends"]["largest_radius"].as_f64().unwrap()];
        assert!(is <= stated + 1e-6 && stated <= blend, "{world}: {is} {stated} {blend}");
        let found = findings(world, &result);
        assert_eq!(found["verdict"], "free", "{world}: {:#}", found["faults"]);
        // Corners are passed, not only stopped at.
        let [took, stops] = [&result, &stopping].map(|result| result["duration"].as_f64().unwrap());
        assert!(result["blends"]["count"].as_u64() > Some(0) && took < 0.95 * stops, "{world}: {took} {stops}");
    }
}

#[test]
fn the_files_of_a_smooth_motion_are_accepted() {
    let place = Place::new();
    let [robot, world] = files("shelf").map(|file| file.display().to_string());
    for blend in ["", "--blend 0.05"] {
        let options = format!("--jerk 20,20 {blend} --quiet --output plan.json --output plan.csv --output plan.yaml");
        place.run(&[&robot, &world], &options).exits(0);
        for file in ["plan.json", "plan.csv", "plan.yaml"] {
            place.run(&["verify", &robot, &world, file], "").exits(0);
        }
    }
}

/// States a smaller radius than the motion has. The deviation is within half of it, but too far from the corners.
#[test]
fn a_motion_that_leaves_its_path_far_from_corners_is_refused() {
    let [robot, file] = files("shelf");
    let mut result = plan_result(&robot, &file, "--jerk 20,20");
    result["blends"]["largest_radius"] = 0.5.into();
    let found = findings("shelf", &result);
    let faults = found["faults"].to_string();
    assert!(found["verdict"] == "claims" && faults.contains("from the nearest corner"), "{found:#}");
}
