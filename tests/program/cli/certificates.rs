//! `--certificate`, and what the checker, which shares no code with the program, says of it.

use super::{FREE, Place, shelf, shipped};
use cplan_check::{CheckError, check};
use serde_json::Value;
use std::path::Path;

/// Shipped worlds without a way, and their robots.
fn closed() -> Vec<(String, String)> {
    let folder = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("workspaces")).unwrap();
    let mut found = Vec::new();
    for path in folder.map(|entry| entry.unwrap().path()).filter(|path| path.extension().is_some_and(|e| e == "toml")) {
        let text = std::fs::read_to_string(&path).unwrap();
        let robot = text.lines().find_map(|line| line.strip_prefix("# robot: "));
        if let Some(robot) = robot.filter(|_| text.contains("# expect: infeasible")) {
            found.push((path.display().to_string(), shipped(&format!("robots/{robot}.urdf"))));
        }
    }
    found.sort();
    found
}

#[test]
fn every_shipped_world_without_a_way_has_a_certificate_that_holds() {
    let closed = closed();
    assert!(closed.len() >= 7, "{closed:?}");
    for (world, robot) in closed {
        let place = Place::new();
        let done = place.run(&[&robot, &world], "--quiet --certificate c.json");
        assert_eq!(done.code, 3, "{}", done.stderr);
        let certificate = place.read("c.json");
        assert!(certificate.len() < 1 << 20, "{world}: {} bytes", certificate.len());
        let read = |path: &str| std::fs::read_to_string(path).unwrap();
        let judged = |world: &str, certificate: &str| check(&read(&robot), world, certificate);
        judged(&read(&world), &certificate).unwrap_or_else(|why| panic!("{world}: {why}"));
        // Without one of the boxes that are needed a way is open, and in the twin, whose way is open, some of it is not true.
        let whole: Value = serde_json::from_str(&certificate).unwrap();
        let without = |k: usize| {
            let mut fewer = whole.clone();
            fewer["boxes"].as_array_mut().unwrap().remove(k);
            judged(&read(&world), &fewer.to_string())
        };
        let count = whole["boxes"].as_array().unwrap().len();
        assert!((0..count).rev().any(|k| matches!(without(k), Err(CheckError::Fails(_)))), "{world}");
        if let Some(twin) = world.strip_suffix("_closed.toml") {
            let open = read(&format!("{twin}_open.toml"));
            assert!(matches!(judged(&open, &certificate), Err(CheckError::Fails(_))), "{twin}");
        }
    }
}

#[test]
fn what_is_asked_on_the_command_line_is_in_the_certificate() {
    let place = Place::new();
    let files = [shipped("robots/planar_2r.urdf"), shipped("workspaces/limits_closed.toml")];
    let done = place.run(&files, "--quiet --certificate c.json --start 0.4,10deg --goal 2.5,0.1 --clearance 0.01");
    assert_eq!(done.code, 3, "{}", done.stderr);
    let read = |path: &String| std::fs::read_to_string(path).unwrap();
    let said = check(&read(&files[0]), &read(&files[1]), &place.read("c.json")).unwrap();
    for part in ["start (0.4, 0.17453292519943295)", "goal (2.5, 0.1)", "clearance 0.01"] {
        assert!(said.contains(part), "{said}");
    }
}

#[test]
fn answers_that_have_no_certificate_yet_say_so() {
    let place = Place::new();
    let tip = format!("{} --goal-tip 0.35,0.5", "--quiet --certificate c.json");
    let done = place.run(&shelf(), &tip);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(done.stderr.contains("c.json is not written") && done.stderr.contains("\"found\""), "{}", done.stderr);
    let kitting = [shipped("robots/scara.urdf"), shipped("workspaces/tasks/kitting_cell.toml")];
    let done = place.run(&kitting, "--quiet --certificate c.json");
    assert!(done.stderr.contains("c.json is not written: tasks"), "{}", done.stderr);
    assert!(!place.path("c.json").exists());
    let done = place.plan(FREE, "--quiet --certificate world.toml");
    done.refused(1, &["world.toml is the input"]);
}
