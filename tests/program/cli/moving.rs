//! Obstacles that move, through the program: planned, played, judged, refused.

use super::{FREE, Place, shipped};
use serde_json::Value;

fn moving(name: &str) -> [String; 2] {
    [shipped("robots/planar_2r.urdf"), shipped(&format!("workspaces/moving/{name}.toml"))]
}

/// A world with one obstacle of this motion, far from the arm.
fn world(motion: &str) -> String {
    format!("{FREE}[[obstacle]]\nname = \"cart\"\ncircle = {{ center = [0, 0], radius = 0.1 }}\nmotion = {motion}\n")
}

#[test]
fn the_arm_waits_until_the_cart_has_gone() {
    let place = Place::new();
    let [urdf, world] = moving("crossing");
    let done = place
        .run(&moving("crossing"), "--output m.json --output m.csv --output m.yaml --picture m.html --picture m.svg");
    assert_eq!(done.code, 0, "{}", done.stderr);
    for part in ["moving     1 obstacle", "waits      from ", "1 obstacle, 1 moving"] {
        assert!(done.stdout.contains(part), "no {part} in {}", done.stdout);
    }
    let result: Value = serde_json::from_str(&place.read("m.json")).unwrap();
    let told = &result["moving"];
    let number = |value: &Value| value.as_f64().expect("a number");
    assert_eq!((&told["obstacles"], &told["free_until"]), (&1.into(), &Value::Null));
    assert_eq!(result["closest"], "link \"forearm\" and obstacle \"cart\"");
    assert!(number(&result["clearance"]) <= number(&told["clearance"]) && number(&result["clearance"]) > 0.0);
    // The cart is out of the way at 2.9 s at the soonest, and the arm takes 1.15 s without it.
    let [from, to] = ["from", "to"].map(|end| number(&told["waits"][0][end]));
    assert!(from < 1.0 && 1.0 < to && to < 3.0, "{told}");
    assert!((2.9..3.7).contains(&number(&result["duration"])), "{}", result["duration"]);
    // Every consumer plays what is certified.
    for file in ["m.json", "m.csv", "m.yaml"] {
        let verified = place.run(&["verify", &urdf, &world, file], "");
        assert_eq!(verified.code, 0, "{file}: {}", verified.stdout);
    }
    let page = place.read("m.html");
    assert!(page.contains("\"movers\":[{") && page.contains("\"moments\":[{"));
    // The same motion, but for its waiting: into the cart.
    let table = place.read("m.csv");
    let mut lines = table.lines();
    let header = lines.next().unwrap();
    let rows: Vec<Vec<f64>> = lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    let begins = rows.iter().position(|row| row[0] >= to - 1e-9).unwrap();
    let rushed = rows[begins..].iter().map(|row| {
        let cells = std::iter::once(row[0] - rows[begins][0]).chain(row[1..].iter().copied());
        cells.map(|cell| cell.to_string()).collect::<Vec<_>>().join(",")
    });
    place.write("rushed.csv", [header.to_owned()].into_iter().chain(rushed).collect::<Vec<_>>().join("\n"));
    let judged = place.run(&["verify", &urdf, &world, "rushed.csv"], "--anywhere");
    assert_eq!(judged.code, 3, "{}", judged.stdout);
    assert!(judged.stdout.contains("obstacle \"cart\""), "{}", judged.stdout);
    // Without times nobody can tell.
    place.write("path.csv", "shoulder,elbow\n-0.9,0.3\n0.9,-0.3\n");
    let judged = place.run(&["verify", &urdf, &world, "path.csv"], "");
    assert_eq!(judged.code, 4, "{}", judged.stdout);
    assert!(judged.stdout.contains("no times"), "{}", judged.stdout);
}

#[test]
fn a_posture_is_checked_at_a_time() {
    let place = Place::new();
    let [urdf, world] = moving("crossing");
    let check = |options: &str| place.run(&["check", &urdf, &world], &format!("--at 0,0 {options}")).stdout;
    assert!(check("").contains("result     free"));
    assert!(check("--time 1.5").contains("obstacle \"cart\": penetrates"));
    assert!(check("--time 9").contains("result     free"));
}

#[test]
fn where_no_timing_helps_that_is_proven_and_the_answer_is_unknown() {
    let place = Place::new();
    let done = place.run(&moving("parked"), "--json");
    assert_eq!(done.code, 4, "{}", done.stderr);
    let told = done.json();
    assert_eq!((&told["status"], &told["trajectory"]), (&"unknown".into(), &Value::Null));
    let reason = told["reason"].as_str().unwrap();
    assert!(
        reason.contains("proven: along the one way that was tried no timing keeps clear of what moves"),
        "{reason}"
    );
}

#[test]
fn motions_that_are_none_are_refused_with_their_place() {
    let place = Place::new();
    for (motion, parts) in [
        ("{ }", ["world.toml: line 8, column 10", "neither stops nor a velocity"]),
        ("{ velocity = [0.1] }", ["world.toml: line 8", "two numbers"]),
        ("{ velocity = [inf, 0] }", ["world.toml: line 8", "not a finite number"]),
        ("{ stops = [] }", ["world.toml: line 8", "a course needs a stop"]),
        ("{ stops = [{ time = -1, at = [3, 3] }] }", ["world.toml: line 8", "must not be negative"]),
        (
            "{ stops = [{ time = 1, at = [3, 3] }, { time = 1, at = [4, 3] }] }",
            ["world.toml: line 8", "does not come after"],
        ),
        ("{ stops = [{ time = 1e9, at = [3, 3] }] }", ["world.toml: line 8", "too large (at most 1e6)"]),
        ("{ speed = 1 }", ["world.toml: line 8", "unknown key `speed`"]),
        ("3", ["world.toml: line 8", "motion = { velocity = [vx, vy] }"]),
    ] {
        place.plan(world(motion), "").refused(1, &parts);
    }
    // Where the arm begins.
    let done = place.plan(world("{ stops = [{ time = 0, at = [0.6, -0.8] }, { time = 1, at = [3, 3] }] }"), "--json");
    assert_eq!(done.code, 1);
    let told = done.json();
    assert_eq!(told["kind"], "start");
    assert!(told["message"].as_str().unwrap().contains("hits moving obstacle \"cart\""), "{told}");
}

/// A task, and something that moves far off.
const TASK: &str = "[start]\njoints = [-0.9, 0.4]\n[[step]]\nmove = { joints = [1.0, 0.2] }\n";
const FAR: &str = "circle = { center = [0, 0], radius = 0.1 }\nat = [3, 3]\nmotion = { velocity = [0.1, 0] }\n";

#[test]
fn what_knows_no_time_refuses_what_moves() {
    let place = Place::new();
    let [urdf, world] = moving("crossing");
    for command in ["compare", "explain", "explore", "reach", "converge"] {
        let done = place.run(&[command, &urdf, &world], "");
        done.refused(1, &["obstacle \"cart\" moves", "remove its motion"]);
    }
    place.write("task.toml", format!("{TASK}[[obstacle]]\nname = \"cart\"\n{FAR}"));
    place.run(&[urdf.as_str(), "task.toml"], "").refused(1, &["obstacle \"cart\" moves"]);
}

#[test]
fn a_motion_among_what_moves_has_no_certificate() {
    let place = Place::new();
    let [urdf, world] = moving("crossing");
    let done = place.run(&moving("crossing"), "--certificate c.json --output m.json");
    assert!(done.stderr.contains("c.json is not written") && !place.path("c.json").exists(), "{}", done.stderr);
    let verified = place.run(&["verify", &urdf, &world, "m.json"], "--certificate c.json");
    assert!(verified.stderr.contains("what moves") && !place.path("c.json").exists(), "{}", verified.stderr);
}
