//! Checks the JSON schema of world files with an independent validator. It accepts files that the program reads, and
//! refuses files that the program refuses for their form.

use cplan_testkit::world_reference::page;
use serde_json::Value;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn schema(name: &str) -> Value {
    serde_json::from_str(&std::fs::read_to_string(root().join("docs").join(name)).unwrap()).unwrap()
}

fn world_schema() -> Value {
    schema("world.schema.json")
}

fn validator() -> jsonschema::Validator {
    let schema = world_schema();
    assert!(jsonschema::meta::is_valid(&schema), "no JSON Schema");
    jsonschema::draft7::new(&schema).unwrap()
}

fn json(toml: &str) -> Value {
    let table: toml::Table = toml::from_str(toml).unwrap_or_else(|e| panic!("{toml}: {e}"));
    serde_json::to_value(table).unwrap()
}

#[track_caller]
fn is_valid(validator: &jsonschema::Validator, toml: &str) {
    let world = json(toml);
    let errors: Vec<String> = validator.iter_errors(&world).map(|e| format!("{}: {e}", e.instance_path())).collect();
    assert!(errors.is_empty(), "{toml}: {}", errors.join("; "));
}

fn worlds(folder: &str) -> Vec<PathBuf> {
    let files = std::fs::read_dir(root().join(folder)).unwrap().map(|entry| entry.unwrap().path());
    let mut worlds: Vec<PathBuf> = files.filter(|file| file.extension().is_some_and(|e| e == "toml")).collect();
    worlds.retain(|file| file.file_name().is_some_and(|name| name != "suite.toml"));
    worlds.sort();
    worlds
}

#[test]
fn shipped_worlds_are_valid() {
    let validator = validator();
    let all = [worlds("workspaces"), worlds("workspaces/tasks")].concat();
    assert!(all.len() > 30, "{}", all.len());
    for file in all {
        println!("{}", file.display());
        is_valid(&validator, &std::fs::read_to_string(&file).unwrap());
    }
}

/// Worlds that have every key between them. Several files are needed, because some keys exclude each other: kinds of
/// goals, and goals and steps.
const FULL: [&str; 3] = [
    r#"
name = "full"
clearance = 0.01
start = { joints = [0, 0.5], stroke = -0.05, wrist = "10deg" }
goal = { tip = [0.3, 0.4], elbow = "left", stroke = -0.05, wrist = 0.5 }
map = { file = "room.map", preferences = "wishes.map", scale = 0.001, offset = [0, 0], frame = false, height = [0.0, 3.0] }
obstacle = [
  { circle = { center = [0, 0], radius = 0.1 }, motion = { stops = [{ time = 0, at = [3, 3] }, { time = 2, at = [3, 4], angle = "30deg" }], velocity = [0, 0.1] } },
  { polygon = [[0, 0], [1, 0], [1, 1]], holes = [[[0.1, 0.1], [0.2, 0.1], [0.2, 0.2]]] },
  { name = "disc", at = [0.1, 0], angle = 0.5, circle = { center = [1, 1], radius = 0.5 }, height = [0, 1] },
  { polyline = [[0, 0], [1, 0]] },
  { image = "den.yaml", unknown = "free" },
]
preference = [
  { name = "aisle", epsilon = -0.5, direction = [0, 1], polygon = [[0, 0], [1, 0], [1, 1]] },
  { epsilon = 1, configurations = [[0, 0], [1, 0], [1, 1]] },
]
[robot]
at = [0.5, -1]
angle = "30deg"
joints = ["a", "b"]
tip = "tool"
fixed = { c = 0 }
limits = { a = [-1, 1.5] }
velocity = { a = 2 }
acceleration = { a = 3.5 }
jerk = { a = 100 }
own_body = true
ignore_contact = [["base", "tool"]]
effort = { a = 50 }
drives = { elbow = "base", ratio = 0.5, gear = [5, -5], zero = [0, "90deg"], motors = { lower = [-9, -9], upper = [9, "500deg"], velocity = [9, 9], acceleration = [90, 90], jerk = [900, 900], effort = [5, 5] } }
calibration = { base = "0.5 mm, 0.05deg", links = 2e-4, zeros = "0.02deg", obstacles = "1 mm" }
dynamics = true
gravity = [0, 0, -9.81]
bar = 0.02
payload = "level"
wrist = { joint = "axis_4", velocity = 6.0, acceleration = 60.0, jerk = 900.0 }
stroke = { joint = "c", travel = 0.1, velocity = 1.0, acceleration = 4.0, jerk = 50.0 }
arch = { rise = 0.02, fall = 0.03 }
"#,
    r#"
start = { joints = [0, 0.5] }
task = { repeat = 10, order = "fixed", speed = 0.8, dwell = 0 }
sensor = { on = "base", rays = 180, field_of_view = "180deg", range = 2, step = 0.05, noise = 0.01, seed = 7, cell = 0.05 }
pallet = [{ name = "store", rows = 2, columns = 3, pitch = [0.1, -0.1], at = [0.5, 0.5], angle = 0.5, height = 0.1 }]
object = [
  { name = "lid", circle = { center = [0, 0], radius = 0.01 }, pallet = "store" },
  { name = "coin", circle = { center = [0, 0], radius = 0.01 }, at = [0.3, 0.2], motion = { velocity = [0, 0.1] } },
  { name = "part", polygon = [[0, 0], [1, 0], [1, 1]], at = [0.3, 0.1], angle = 1, height = [0, 0.02], lift = 0.05, mass = 1.5, payload = "rigid", grasp = [0, 0.005], supports = ["table"], renew = true },
]
step = [
  { pick = "part", elbow = "right", grasp = [0, 0], supports = [], at = [0.3, 0.2], window = [1, 2], dwell = 0.2 },
  { place = { at = [0.1, 0.3], angle = 1.57, supports = ["tray"], height = 0.0, elbow = "left" }, speed = 0.5 },
  { move = { joints = [0, 0.5] } },
  { follow = { points = [[0.9, 0], [1, 0], [1, 0.1]], radius = 0.02, speed = 0.1, tolerance = 0.0001, elbow = "left" } },
  { follow = { arc = [[0.9, 0], [1, 0.1], [0.9, 0.2]], scale = 1.1, turn = "10deg", move = [0.1, 0] } },
  { follow = { spline = [[0.9, 0], [1, 0.1]], turn = 0.1 } },
  { follow = { file = "plate.gcode", unit = "mm", wrist = "tangent", wrist_tolerance = 0.02 } },
  { follow = { spline = [[0.9, 0], [1, 0.1]], wrist = { tangent = "90deg" }, wrist_tolerance = "1deg" } },
  { follow = { spline = [[0.9, 0], [1, 0.1]], wrist = 0.3 } },
  { follow = { spline = [[0.9, 0], [1, 0.1]], wrist = "-30deg" } },
  { repeat = 100, order = "free", speed = 1, steps = [{ pick = "coin" }, { place = { at = [0.2, 0.3] } }] },
  { pick = "lid 1,1" },
  { place = { on = "store 1,1" } },
  { transfer = { objects = "lid", to = "store", angle = 0.5, supports = ["table"], elbow = "right" } },
]
"#,
    "goal.areas = [[[0.3, 0.4], [0.5, 0.6]]]",
];

/// Returns every key of every table of the schema.
fn keys(schema: &Value) -> Vec<String> {
    let mut keys = Vec::new();
    if let Value::Object(object) = schema {
        if let Some(Value::Object(properties)) = object.get("properties") {
            keys.extend(properties.keys().cloned());
        }
        keys.extend(object.values().flat_map(self::keys));
    }
    keys
}

#[test]
fn worlds_with_every_key_are_valid() {
    let validator = validator();
    let schema = world_schema();
    for full in FULL {
        is_valid(&validator, full);
    }
    for key in keys(&schema) {
        assert!(FULL.iter().any(|full| full.contains(&key)), "no world has the key {key}");
    }
}

#[test]
fn the_committed_reference_is_up_to_date() {
    let kept = std::fs::read_to_string(root().join("docs/world_reference.md")).unwrap();
    assert_eq!(page(&world_schema()), kept, "run `cargo run --example world_reference`");
    for key in keys(&world_schema()) {
        assert!(kept.contains(&format!("| `{key}`")), "the reference has no key {key}");
    }
}

#[cfg(feature = "study")]
#[test]
fn worlds_and_studies_that_the_book_shows_are_valid() {
    let (of_worlds, of_studies) = (validator(), studies());
    let pages = std::fs::read_dir(root().join("docs")).unwrap().map(|entry| entry.unwrap().path());
    let mut seen = 0;
    for file in pages.filter(|file| file.extension().is_some_and(|e| e == "md")) {
        let text = std::fs::read_to_string(&file).unwrap();
        for block in text.split("```toml\n").skip(1).filter(|block| !block.contains("[[arm")) {
            let block = block.split("```").next().unwrap_or_default();
            is_valid(if block.contains("[[parameter]]") { &of_studies } else { &of_worlds }, block);
            seen += 1;
        }
    }
    assert!(seen >= 6, "only {seen} worlds");
}

#[cfg(feature = "study")]
fn studies() -> jsonschema::Validator {
    jsonschema::draft7::new(&schema("study.schema.json")).unwrap()
}

/// Checks that the schema of studies accepts the shipped studies, and refuses files that the program refuses for their
/// form.
#[cfg(feature = "study")]
#[test]
fn studies_are_valid_and_others_are_not() {
    let validator = studies();
    let files = worlds("workspaces/studies");
    assert!(files.len() >= 2);
    for file in files {
        let study = std::fs::read_to_string(&file).unwrap();
        assert!(validator.is_valid(&json(&study)), "{}", file.display());
        assert!(!validator.is_valid(&json(&format!("size = 3\n{study}"))));
        assert!(!validator.is_valid(&json(&study.replace("sets =", "set ="))));
    }
}

/// Checks that every key has a description, which editors show.
#[test]
fn every_key_is_described() {
    fn check(schema: &Value, at: &str) {
        let Value::Object(object) = schema else { return };
        if let Some(Value::Object(properties)) = object.get("properties") {
            for (key, value) in properties {
                let described = value.get("description").is_some() || value.get("$ref").is_some();
                assert!(described, "{at}/{key} has no description: {value}");
            }
        }
        for (key, value) in object {
            check(value, &format!("{at}/{key}"));
        }
    }
    check(&world_schema(), "");
}

#[test]
fn broken_worlds_are_not_valid() {
    const POSED: &str = "[start]\njoints = [0, 0]\n[goal]\njoints = [1, 1]\n";
    let broken = [
        "nam = \"x\"",
        "name = 3",
        "clearance = -0.1",
        "clearance = \"0.1\"",
        "[start]\njoint = [0, 0]",
        "[start]\njoints = [0]",
        "[start]\njoints = [0, 0, 0]",
        "[start]\njoints = [\"0\", 0]",
        "[start]",
        "[goal]",
        "[goal]\njoints = [0, 0]\ntip = [0, 0]",
        "[robot]\njoints = [\"a\"]",
        "[robot]\nlimits = { a = 1 }",
        "[robot]\nvelocity = { a = 0 }",
        "[robot]\nwrist = { acceleration = 1 }",
        "[robot]\npayload = \"loose\"",
        "[[obstacle]]\nname = \"none\"",
        "[[obstacle]]\npolygon = [[0, 0], [1, 0]]",
        "[[obstacle]]\npolygon = [[0, 0], [1, 0], [1]]",
        "[[obstacle]]\npolygon = [[0, 0], [1, 0], [1, 1]]\ncircle = { center = [0, 0], radius = 1 }",
        "[[obstacle]]\ncircle = { center = [0, 0], radius = 0 }",
        "[[obstacle]]\ncircle = { center = [0, 0], radios = 1 }",
        "[[obstacle]]\npolyline = [[0, 0]]",
        "[[obstacle]]\npolyline = [[0, 0], [1, 1]]\nunknown = \"free\"",
        "[[obstacle]]\nimage = \"a.yaml\"\nunknown = \"maybe\"",
        "[obstacle]\npolyline = [[0, 0], [1, 1]]",
        "[[preference]]\npolygon = [[0, 0], [1, 0], [1, 1]]",
        "[[preference]]\nepsilon = 1",
        "[map]\nscale = 1",
        "[map]\nfile = \"a\"\nscale = 0",
        "[[object]]\nname = \"a\"\ncircle = { center = [0, 0], radius = 1 }",
        "[[object]]\ncircle = { center = [0, 0], radius = 1 }\nat = [0, 0]",
        "[[object]]\nname = \"a\"\nat = [0, 0]",
        "[[step]]",
        "[[step]]\npick = \"a\"\nplace = { at = [0, 0] }",
        "[[step]]\nplace = [0, 0]",
        "[[step]]\nfollow = { points = [[0, 0]] }",
        "[[step]]\nfollow = { arc = [[0, 0], [1, 1]] }",
        "[[step]]\nfollow = { points = [[0, 0], [1, 1]], spline = [[0, 0], [1, 1]] }",
        "[[step]]\nfollow = { spline = [[0, 0], [1, 1]], radius = 1 }",
        "[[step]]\nfollow = { spline = [[0, 0], [1, 1]], wrist = \"along\" }",
        "[[step]]\nfollow = { spline = [[0, 0], [1, 1]], wrist = { tangents = 1 } }",
        "[[step]]\nfollow = { spline = [[0, 0], [1, 1]], wrist_tolerance = 0.1 }",
        "[[step]]\nplace = { at = [0, 0] }\ngrasp = [0, 0]",
        "[[step]]\npick = \"a\"\nrepeat = 2",
        "[[step]]\nmove = { joints = [0, 0] }\nwindow = [1, 2]",
        "[[step]]\nmove = { joints = [0, 0] }\norder = \"free\"",
        "[[step]]\nsteps = []",
        "[[step]]\npick = \"a\"\nspeed = 1.5",
        "[[step]]\npick = \"a\"\nspeed = 0",
        "[[step]]\npick = \"a\"\ndwell = -1",
        "[[pallet]]\nname = \"a\"\nrows = 1\ncolumns = 1\nat = [0, 0]",
        "[[pallet]]\nname = \"a\"\nrows = 0\ncolumns = 1\npitch = [1, 1]\nat = [0, 0]",
        "[[pallet]]\nname = \"a\"\nrows = 1\ncolumns = 1.5\npitch = [1, 1]\nat = [0, 0]",
        "[[object]]\nname = \"a\"\ncircle = { center = [0, 0], radius = 1 }\nat = [0, 0]\npallet = \"b\"",
        "[[step]]\nplace = { at = [0, 0], on = \"a 1,1\" }",
        "[[step]]\nplace = { angle = 1 }",
        "[[step]]\ntransfer = \"a\"",
        "[[step]]\ntransfer = { objects = \"a\" }",
        "[[step]]\npick = \"a\"\ntransfer = { objects = \"a\", to = \"b\" }",
        "[task]\nrepeat = 2",
        "[goal]\njoints = [0, 0]\n[[step]]\nmove = { joints = [0, 0] }",
        "[[step]]\nmove = { joints = [0, 0] }\n[task]\nrepeat = 0",
        "[[step]]\nmove = { joints = [0, 0] }\n[task]\nrepeat = 1.5",
    ];
    let validator = validator();
    assert!(validator.is_valid(&json(POSED)));
    let folder = tempfile::tempdir().unwrap();
    let robot = root().join("robots/planar_2r.urdf");
    for text in broken {
        assert!(!validator.is_valid(&json(text)), "{text}");
        // The program agrees.
        let world = folder.path().join("world.toml");
        std::fs::write(&world, text).unwrap();
        assert!(cplan::input::load_scene(&robot, &world).is_err(), "{text}");
    }
}
