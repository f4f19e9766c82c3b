//! Checks that every diagnostic has a hint, with hundreds of files that have a typing error.

use super::*;
use cplan_cases::slips::slipped;
use cplan_cases::{dice, times};

/// Messages about missing things. They have no line.
const MISSING: [&str; 6] =
    ["there is no ", "there are no ", "holds no ", "holds neither ", "is missing", "has no link"];

/// Names of members whose documents are nested. In them, syntax errors have lines, but errors of content do not.
const MEMBERS: [&str; 7] = ["points", "steps", "path", "trajectory", "joint_names", "\"joints\"", "is too large"];

/// Checks that the program succeeds (with code 0, 3 or 4), or that it reports the error in one object with file, place,
/// message and help. Returns true if it is an error.
fn is_refused_with_help(done: &Done, text: &str) -> bool {
    let what = || format!("{}{}\n{text}", done.stdout, done.stderr);
    assert!(!done.stderr.contains("panicked"), "{}", what());
    if matches!(done.code, 0 | 3 | 4) {
        return false;
    }
    assert_eq!(done.code, 1, "{}", what());
    let json = done.json();
    assert_eq!(json["status"], "error", "{}", what());
    let own = vec![json.clone()];
    let diagnostics = json["defects"].as_array().filter(|diagnostics| !diagnostics.is_empty()).unwrap_or(&own);
    for diagnostic in diagnostics {
        let report = |key: &str| diagnostic[key].as_str().is_some_and(|text| !text.trim().is_empty());
        assert!(report("file") && report("message") && report("cure"), "{diagnostic:#}\n{text}");
        let message = diagnostic["message"].as_str().unwrap_or_default();
        let is_missing = MISSING.iter().any(|words| message.contains(words));
        let is_document =
            diagnostic["file"].as_str().is_some_and(|file| file.ends_with(".json") || file.ends_with(".yaml"));
        let is_member = is_document && MEMBERS.iter().any(|words| message.contains(words));
        assert!(
            diagnostic["line"].as_u64().is_some_and(|line| line > 0) || is_missing || is_member,
            "no line: {diagnostic:#}\n{text}"
        );
    }
    true
}

/// Runs many texts with one typing error each, and checks that `run` answers each of them. Both kinds of answers must
/// occur.
fn every_slip_is_answered(stream: u64, usual: u64, text: &str, run: impl Fn(&str) -> Done) {
    assert_eq!(run(text).code, 0, "{}", run(text).stdout);
    let mut dice = dice(stream);
    let errors = (0..times(usual)).filter(|_| {
        let text = slipped(&mut dice, text);
        is_refused_with_help(&run(&text), &text)
    });
    assert!(errors.count() > 0);
}

#[test]
fn slips_in_a_world_are_accepted_or_explained() {
    let place = Place::new();
    let world = format!(
        "name = \"cell\"\nclearance = 0.001\n[robot]\nlimits = {{ elbow = [\"-120deg\", 2.1] }}\nvelocity = {{ elbow = 1.0 }}\n\
         {FREE}[[obstacle]]\nname = \"frame\"\npolygon = [[-1.0, 1.0], [-2.0, 1.0], [-2.0, 2.0], [-1.0, 2.0]]\n\
         [[obstacle]]\ncircle = {{ center = [-0.6, -0.7], radius = 0.05 }}\nheight = [0.0, 0.2]\n\
         [[preference]]\nepsilon = 0.1\npolygon = [[0.2, 0.3], [0.5, 0.3], [0.5, 0.6]]\n"
    );
    every_slip_is_answered(21, 80, &world, |world| place.plan(world, "--json --planner subdivision"));
}

#[test]
fn slips_in_a_robot_are_accepted_or_explained() {
    let place = Place::new().with("world.toml", FREE);
    let robot = read(shipped("robots/planar_2r.urdf"));
    every_slip_is_answered(22, 80, &robot, |robot| {
        place.write("arm.urdf", robot);
        place.run(&["arm.urdf", "world.toml"], "--json --planner subdivision")
    });
}

#[test]
fn slips_in_a_task_are_accepted_or_explained() {
    let place = Place::new();
    let task = "[start]\njoints = [0.3, 0.4]\n[[object]]\nname = \"part\"\n\
        polygon = [[-0.02, -0.02], [0.02, -0.02], [0.02, 0.02], [-0.02, 0.02]]\nat = [1.1, 0.9]\n\
        [[step]]\npick = \"part\"\ndwell = 0.2\n[[step]]\nplace = { at = [1.4, -0.5] }\nspeed = 0.5\n\
        [[step]]\nmove = { joints = [0.3, 0.4] }\n";
    every_slip_is_answered(23, 60, task, |task| place.plan(task, "--json"));
}

/// Checks typing errors in a motion of a format, for the world [`FREE`].
fn slips_in_a_motion(stream: u64, file: &str) {
    let place = Place::new();
    place.plan(FREE, &format!("--quiet --path taut --period 0.4 --output {file}")).exits(0);
    let motion = place.read(file);
    let robot = shipped("robots/planar_2r.urdf");
    every_slip_is_answered(stream, 60, &motion, |motion| {
        place.write(file, motion);
        place.run(&["verify", &robot, "world.toml", file], "--json")
    });
}

#[test]
fn slips_in_motions_of_each_format_are_accepted_or_explained() {
    for (stream, file) in [(24, "motion.json"), (25, "motion.csv"), (26, "motion.yaml")] {
        slips_in_a_motion(stream, file);
    }
}

#[test]
fn a_json_list_is_no_motion() {
    let place = Place::new().with("world.toml", FREE);
    let robot = shipped("robots/planar_2r.urdf");
    for text in ["[]", " [ ]", "[null, null, null, null, null, null, null, null]", "{}", "3", "\"path\"", "", "nul"] {
        place.write("motion.json", text);
        let done = place.run(&["verify", &robot, "world.toml", "motion.json"], "--json");
        assert!(is_refused_with_help(&done, text), "{text} is taken");
        let json: Value = done.json();
        assert!(json["cure"].as_str().unwrap().contains("JointTrajectory"), "{json}");
    }
    place.write("motion.json", "[]");
    let report = place.run(&["verify", &robot, "world.toml", "motion.json"], "");
    report.refused(1, &["motion.json: line 1, column 1: is a list, but must be an object { ... }", "hint: "]);
}
