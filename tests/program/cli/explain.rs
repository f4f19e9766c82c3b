//! `cplan explain`, from outside.

use super::{Done, Place, shelf, shipped};
use serde_json::Value;

fn explain(place: &Place, robot: &str, world: &str, options: &str) -> Done {
    let [robot, world] =
        [format!("robots/{robot}.urdf"), format!("workspaces/{world}.toml")].map(|file| shipped(&file));
    place.run(&["explain", &robot, &world], options)
}

fn json(done: &Done) -> Value {
    serde_json::from_str(&done.stdout).unwrap_or_else(|error| panic!("{error}: {}{}", done.stdout, done.stderr))
}

#[test]
fn walls_in_the_way_are_named_verdict_first() {
    let done = explain(&Place::new(), "planar_2r_continuous", "no_path", "");
    assert_eq!(done.code, 3, "{}", done.stderr);
    let second = done.stdout.lines().nth(1).unwrap_or_default();
    assert!(second.starts_with("result     there is no motion: proven; blocked by obstacle"), "{}", done.stdout);
    for words in ["\"front wall\"", "\"back wall\"", "opens a way (certified)", "does not (proven)"] {
        assert!(done.stdout.contains(words), "{words}: {}", done.stdout);
    }
}

/// The ends of a change are a millimetre apart.
#[test]
fn json_has_sets_and_changes() {
    let result = json(&explain(&Place::new(), "planar_2r_continuous", "no_path", "--json"));
    assert_eq!(
        (&result["status"], &result["blocking"]),
        (&"infeasible".into(), &serde_json::json!(["front wall", "back wall"]))
    );
    let blockers = result["sets"][0]["blockers"].as_array().expect("a list");
    for blocker in blockers.iter().filter(|blocker| blocker["kind"] == "obstacle") {
        assert_eq!(blocker["without"], "found");
        for change in blocker["changes"].as_array().expect("a list") {
            let [closed, opens] = ["closed", "opens"].map(|key| change[key].as_f64().expect("a number"));
            assert!(closed < opens && opens - closed <= 1e-3, "{change}");
        }
    }
    assert!(result["bottleneck"]["too_narrow_by"].as_f64().expect("a number") > 0.0);
}

#[test]
fn what_the_main_job_refuses_is_explained() {
    let place = Place::new();
    let blocked = explain(&place, "planar_2r", "shelf", "--goal 0.14,0 --json");
    assert_eq!(blocked.code, 3, "{}", blocked.stderr);
    let result = json(&blocked);
    assert_eq!(result["blocked_ends"][0]["end"], "goal");
    assert!(result["blocked_ends"][0]["nearest_free"]["distance"].as_f64().expect("a number") > 0.0);
    // Links of 1 m and 0.8 m miss a place 5 m off by 3.2 m.
    let far = explain(&place, "planar_2r", "shelf", "--goal-tip 5,0 --json");
    assert_eq!(far.code, 3);
    let misses = json(&far)["out_of_reach"]["misses"].as_f64().expect("a number");
    assert!((misses - 3.2).abs() < 1e-9, "{misses}");
}

/// The arm stands in the camera's column: no step can begin.
#[test]
fn a_start_of_steps_that_is_not_free_is_explained() {
    let done = explain(&Place::new(), "scara", "tasks/kitting_cell", "--start 0.3,0 --json");
    assert_eq!(done.code, 3, "{}", done.stderr);
    let result = json(&done);
    let ends = result["blocked_ends"].as_array().expect("a list");
    assert_eq!((ends.len(), &ends[0]["end"]), (1, &"start".into()), "{result}");
    assert_eq!(result["blocking"], serde_json::json!(["camera column"]));
    assert!(ends[0]["nearest_free"]["distance"].as_f64().expect("a number") > 0.0);
}

#[test]
fn a_motion_is_explained_by_what_shapes_it() {
    let done = explain(&Place::new(), "planar_2r", "shelf", "--json");
    assert_eq!(done.code, 0, "{}", done.stderr);
    let result = json(&done);
    assert!(!result["shaped_by"].as_array().expect("a list").is_empty());
    assert!(result["tightest"]["clearance"].as_f64().expect("a number") > 0.0);
}

#[test]
fn pictures_show_where_it_gets_stuck() {
    let place = Place::new();
    let done = explain(&place, "planar_2r_continuous", "no_path", "--picture why.svg --picture why.html --quiet");
    assert_eq!((done.code, done.stdout.as_str()), (3, ""), "{}", done.stderr);
    assert!(place.read("why.svg").contains("where it gets stuck"));
    assert!(place.read("why.html").contains("opens a way (certified)"));
}

#[test]
fn bad_input_is_refused() {
    let place = Place::new();
    let [robot, _] = shelf();
    assert_eq!(place.run(&["explain", &robot, "missing.toml"], "").code, 1);
    assert_eq!(explain(&place, "planar_2r", "shelf", "--start=a,b").code, 2);
    assert_eq!(explain(&place, "planar_2r", "shelf", "--picture why.txt").code, 2);
}

/// The slide of a polar arm ends long before its goal: without that limit there is a way, and as far as the program says the joint has to go.
#[test]
fn a_tip_beyond_the_slide_is_opened_by_its_limit() {
    let place = Place::new();
    let polar = shipped("robots/polar.urdf");
    place.write("far.toml", "[start]\njoints = [0.1, 0.2]\n[goal]\ntip = [3, 0]\n");
    let done = place.run(&["explain", &polar, "far.toml"], "--json");
    assert_eq!(done.code, 3, "{}", done.stderr);
    let result = json(&done);
    let blockers = result["sets"][0]["blockers"].as_array().expect("a list");
    let limit = blockers.iter().find(|blocker| blocker["joint"] == "ram_slide" && blocker["side"] == "upper");
    let change = &limit.unwrap_or_else(|| panic!("{result}"))["changes"][0];
    let place_of = |upper: f64| {
        let limits = format!("[robot.limits]\nram_slide = [0, {upper}]\n");
        place.write("wider.toml", format!("[start]\njoints = [0.1, 0.2]\n[goal]\ntip = [3, 0]\n{limits}"));
        place.run(&[&polar, "wider.toml"], "--quiet").code
    };
    let upper = place.run(&["inspect", &polar], "--json");
    let upper = json(&upper);
    let slide = upper["joints"].as_array().expect("a list").iter().find(|joint| joint["name"] == "ram_slide");
    let upper = slide.expect("the slide")["limits"]["range"][1].as_f64().expect("a limit");
    assert_eq!(place_of(upper + change["opens"].as_f64().expect("a number") + 1e-9), 0, "{change}");
    assert_ne!(place_of(upper + change["closed"].as_f64().expect("a number")), 0, "{change}");
}

/// A task that can be done is drawn as it is done.
#[test]
fn of_a_task_that_can_be_done_there_is_a_picture() {
    let place = Place::new();
    let done = explain(&place, "planar_2r", "tasks/elbow_choice", "--picture done.svg");
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(place.read("done.svg").contains("<svg"));
}
