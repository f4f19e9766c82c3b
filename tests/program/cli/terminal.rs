//! What names hold does nothing to a terminal.

use super::*;
use serde_json::Value;

/// Names that clear the screen, change the direction of writing, and say what is not so.
const NAMES: [&str; 3] = ["wall\u{1b}[2J", "wall\u{202e}eerf", "wall\nresult     free: proven\u{9b}31m"];

/// A world in which the start may collide with an obstacle of this name.
fn world(name: &str, start: &str) -> String {
    let name: String = name.chars().map(|c| format!("\\U{:08X}", u32::from(c))).collect();
    format!(
        "name = \"{name}\"\n[start]\njoints = {start}\n[goal]\njoints = [1.55, -0.35]\n\
         [[obstacle]]\nname = \"{name}\"\ncircle = {{ center = [1.2, -1.2], radius = 0.1 }}\n"
    )
}

#[track_caller]
fn harmless(done: &Done, name: &str) {
    for text in [&done.stdout, &done.stderr] {
        let acts = |c: char| c.is_control() && c != '\n' || c == '\u{202e}';
        assert!(!text.contains(acts), "{name:?}: {text:?}");
        assert!(!text.lines().any(|line| line.starts_with("result     free: proven")), "{name:?}: {text:?}");
    }
}

#[test]
fn names_of_obstacles_and_worlds_are_shown_with_escapes() {
    let robot = shipped("robots/planar_2r.urdf");
    for name in NAMES {
        let place = Place::new();
        place.write("free.toml", world(name, "[-0.5, 0.4]"));
        place.write("blocked.toml", world(name, "[-0.785, 0]"));
        place.write("m.csv", "shoulder,elbow\n-0.5,0.4\n-1.0,-0.1\n");
        let runs: [&[&str]; 9] = [
            &[&robot, "free.toml"],
            &[&robot, "free.toml", "--json"],
            &[&robot, "blocked.toml"],
            &["check", &robot, "free.toml", "--at", "-0.785,0"],
            &["check", &robot, "free.toml", "--at", "-0.785,0", "--json"],
            &["verify", &robot, "free.toml", "m.csv"],
            &["verify", &robot, "free.toml", "m.csv", "--json"],
            &["compare", &robot, "free.toml", "--planner", "visibility"],
            &["compare", &robot, "free.toml", "--planner", "visibility", "--json"],
        ];
        for arguments in runs {
            let done = place.run(arguments, "");
            assert_ne!(done.code, 2, "{}", done.stderr);
            harmless(&done, name);
            let said = format!("{}{}", done.stdout, done.stderr);
            if arguments.contains(&"blocked.toml") || arguments[0] == "check" || arguments[0] == "verify" {
                assert!(said.contains("wall"), "{arguments:?}: {said}");
            }
            // JSON holds the name as it is.
            if arguments.contains(&"--json") {
                serde_json::from_str::<Value>(&done.stdout).unwrap_or_else(|e| panic!("{e}: {}", done.stdout));
            }
        }
    }
}

#[test]
fn names_of_files_are_shown_with_escapes() {
    let place = Place::new();
    let name = "no\u{1b}[2Jworld\u{202e}.toml";
    harmless(&place.run(&[&shipped("robots/planar_2r.urdf"), name], ""), name);
    harmless(&place.run(&[&shelf()[0], &shelf()[1], "--output", "no\u{1b}[2J/plan.json"], ""), name);
}
