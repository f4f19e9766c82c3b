//! Errors for scripts: with `--json`, any error gives one JSON object on stdout.

impl Done {
    /// Checks the kind of an error object and the parts of its message, and returns it.
    fn error(&self, code: i32, kind: &str, parts: &[&str]) -> serde_json::Value {
        assert_eq!(self.code, code, "{}{}", self.stdout, self.stderr);
        let json = self.json();
        assert_eq!((&json["status"], &json["kind"]), (&"error".into(), &kind.into()), "{json}");
        for key in ["file", "line", "message", "cure"] {
            assert!(json.get(key).is_some(), "no {key} in {json}");
        }
        let message = json["message"].as_str().unwrap();
        has(message, parts);
        json
    }
}

use super::*;
#[test]
fn errors_have_the_kind_of_the_mistake() {
    let place = Place::new();
    let post = format!("{FREE}[[obstacle]]\nname = \"post\"\ncircle = {{ center = [0.5, -0.6], radius = 0.1 }}\n");
    let json = place.plan(&post, "--json").error(1, "start", &["hits obstacle \"post\"", "deep"]);
    assert_eq!((&json["file"], &json["line"]), (&"world.toml".into(), &2.into()));
    assert!(json["cure"].as_str().unwrap().contains("away from the obstacle"));
    place.plan(FREE, "--json --start 9,0").error(1, "start", &["--start", "exceeds its limits"]);
    place.plan("[goal]\njoints = [0, 0]\n", "--json").error(1, "start", &["there is no start"]);
    place.plan(FREE, "--json --goal 9,0").error(1, "goal", &["--goal", "exceeds its limits"]);
    place.plan(FREE, "--json --goal-tip 9,9").error(1, "goal", &["out of reach"]);
    place.plan("[start]\njoints = [0, 0]\n", "--json").error(1, "goal", &["there is no goal"]);
    let json = place.plan("[start\n", "--json").error(1, "input", &[]);
    assert_eq!((&json["file"], &json["line"]), (&"world.toml".into(), &1.into()));
    place.run_in("none.urdf", FREE, "--json").error(1, "input", &["cannot be read"]);
    // All errors, if there are several.
    let two = format!("{FREE}[robot]\nvelocity = {{ a = 1, b = 2 }}\n");
    let json = place.plan(two, "--json").error(1, "input", &["no joint \"a\""]);
    assert_eq!(json["defects"].as_array().unwrap().len(), 2);
}

#[test]
fn a_wrong_command_line_is_json_too() {
    let place = Place::new();
    let json = place.run(&shelf(), "--json --planer visibility").error(2, "usage", &["unexpected argument '--planer'"]);
    assert!(json["cure"].as_str().unwrap().contains("--planner"), "{json}");
    place.run(&shelf(), "--json --planner best").error(2, "usage", &["invalid value 'best'"]);
    place.run::<&str>(&[], "--json").error(2, "usage", &["required"]);
    place.run(&shelf(), "--json --picture plan.bmp").error(2, "usage", &[".svg, .png, .gif or .html"]);
    // Without the flag, stdout is empty; help is no error.
    place.run(&shelf(), "--planner best").refused(2, &["invalid value"]);
    let tip = "astar is a search, not a planner; write `--planner wavefront --search astar` or `--planner prm --search astar`";
    place.run(&shelf(), "--planner astar").refused(2, &["invalid value", tip]);
    let help = place.run::<&str>(&[], "--json --help").exits(0);
    help.says(&["Usage:"]);
}

#[test]
fn every_command_with_json_answers_in_json() {
    let place = Place::new().with("world.toml", "[start\n").with("motion.csv", "time,shoulder,elbow\n0,0,0\n1,0,0\n");
    let robot = shipped("robots/planar_2r.urdf");
    let cases: [&[&str]; 3] = [
        &["compare", &robot, "world.toml"],
        &["check", &robot, "world.toml", "--at", "0,0"],
        &["verify", &robot, "world.toml", "motion.csv"],
    ];
    for words in cases {
        place.run(words, "--json").error(1, "input", &[]);
    }
    // For a robot that one cannot plan with, the report is the answer, and contains the diagnostics.
    let json = place.run(&["inspect", "none.urdf"], "--json").exits(1);
    assert_eq!(json.json()["plannable"], false);
}
