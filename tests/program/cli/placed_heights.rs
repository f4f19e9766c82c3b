//! Heights of places: objects that are placed lower or higher than they were picked.

use super::*;

/// Returns a task that takes a part from a tray, 20 mm high, to a box and back. A low bar lies in the box.
fn world(robot: &str, there: &str, back: &str, bar: &str) -> String {
    format!(
        r#"[robot]
payload = "level"
stroke = {{ joint = "axis_3", {robot} }}
[start]
joints = [0.3, 0.9]
[[pallet]]
name = "pockets"
rows = 1
columns = 1
pitch = [0.1, 0.1]
at = [0.35, 0.25]
height = 0.02
[[obstacle]]
name = "tray"
polygon = [[0.25, 0.15], [0.45, 0.15], [0.45, 0.35], [0.25, 0.35]]
height = [0.0, 0.02]
[[obstacle]]
name = "box"
polyline = [[0.25, -0.35], [0.45, -0.35], [0.45, -0.15], [0.25, -0.15], [0.25, -0.35]]
height = [0.0, 0.03]
[[obstacle]]
name = "bar"
polygon = [[0.33, -0.255], [0.37, -0.255], [0.37, -0.245], [0.33, -0.245]]
height = {bar}
[[object]]
name = "part"
circle = {{ center = [0.0, 0.0], radius = 0.01 }}
pallet = "pockets"
height = [0.02, 0.03]
lift = 0.12
[[step]]
pick = "part 1,1"
[[step]]
place = {{ at = [0.35, -0.25]{there} }}
[[step]]
pick = "part 1,1"
[[step]]
place = {{ {back} }}
"#
    )
}

/// Deep below everything, so that it blocks nothing.
const NO_BAR: &str = "[-0.5, -0.4]";

/// The tool goes down to the floor of the box, and to the top of the tray. `verify` and the checker agree.
#[test]
fn the_tool_goes_down_to_the_stated_heights() {
    let scara = shipped("robots/scara.urdf");
    for (robot, reaches) in [("", [-0.12, -0.14, -0.14, -0.12]), ("travel = 0.1", [-0.1, -0.12, -0.12, -0.1])] {
        let place = Place::new().with("world.toml", world(robot, ", height = 0.0", "on = \"pockets 1,1\"", NO_BAR));
        place.certified(&scara, "world.toml", "--output plan.json", 0);
        let plan = place.json("plan.json");
        let lowered = |step: &Value| step["stroke"]["lowered"].as_f64().unwrap();
        let steps: Vec<f64> = plan["steps"].as_array().unwrap().iter().map(lowered).collect();
        assert!(steps.iter().zip(reaches).all(|(is, asked)| (is - asked).abs() < 1e-12), "{steps:?}");
        place.run(&["verify", &scara, "world.toml", "plan.json"], "").exits(0);
        // At its other height, the checker and the judge see a wrong stroke.
        place.write("wrong.toml", world(robot, ", height = 0.01", "on = \"pockets 1,1\"", NO_BAR));
        place.run(&["verify", &scara, "wrong.toml", "plan.json"], "").exits(3);
    }
}

/// A bar that ends 15 mm above the floor blocks a part on the floor, but not one at 20 mm.
#[test]
fn placed_objects_have_the_stated_heights() {
    let back = "at = [0.35, 0.25], height = 0.02";
    for (there, bar, code) in [
        (", height = 0.0", "[0.0, 0.015]", 3),
        (", height = 0.02", "[0.0, 0.015]", 0),
        // It rests on the bar.
        (", height = 0.015", "[0.0, 0.015]", 0),
        ("", "[0.0, 0.02]", 0),
        (", height = 0.0", "[0.01, 0.02]", 3),
    ] {
        Place::new().run_in(&shipped("robots/scara.urdf"), world("", there, back, bar), "--quiet").exits(code);
    }
}

#[test]
fn places_in_the_air_are_errors() {
    let back = "at = [0.35, 0.25], height = 0.02";
    for (there, back, bar, message) in [
        (
            "",
            back,
            NO_BAR,
            "step 2: object \"part 1,1\" would hang in the air at (0.35, -0.25) m: its bottom is at a height of 20.00 mm",
        ),
        (
            ", height = 0.0",
            "at = [0.35, 0.25]",
            NO_BAR,
            "step 4: object \"part 1,1\" would hang in the air at (0.35, 0.25) m: its bottom is at a height of 0.000 mm",
        ),
        (
            ", height = 0.15",
            back,
            NO_BAR,
            "step 2: object \"part 1,1\" is placed at a height of 150.0 mm, above the height at which it is carried, 140.0 mm",
        ),
        (
            ", height = -0.1",
            back,
            NO_BAR,
            "step 2 (world.toml:33:1): the tool would be lowered to -0.24 m, outside the limits [",
        ),
    ] {
        let done = Place::new().run_in(&shipped("robots/scara.urdf"), world("", there, back, bar), "--quiet");
        done.exits(1).warns(&[message, "world.toml"]);
    }
}

/// A stated height at which nothing ends means a surface that the world leaves out. A note says so.
#[test]
fn assumed_surfaces_are_noted() {
    let note = "\"part 1,1\": placed at the stated height of 0.000 mm; no obstacle or object ends at this height, so a surface is assumed there";
    for (height, bar, is_noted) in
        [("0.0", NO_BAR, true), ("0.0", "[-0.1, 0.0]", false), ("0.02", "[0.0, 0.02]", false)]
    {
        let there = format!(", height = {height}");
        let done =
            Place::new().run_in(&shipped("robots/scara.urdf"), world("", &there, "on = \"pockets 1,1\"", bar), "");
        assert!(done.code == 0 && done.stdout.contains(note) == is_noted, "{height}, {bar}: {}", done.stdout);
    }
}

/// Hints about heights have the form of the value that the key takes, and a note states where the tool's travel does not suffice.
#[test]
fn hints_about_heights_can_be_followed() {
    let place = Place::new();
    let run = |from: &str, to: &str| {
        let text = world("travel = 0.1", ", height = 0.0", "on = \"pockets 1,1\"", NO_BAR);
        assert!(text.contains(from), "{from}");
        place.write("world.toml", text.replacen(from, to, 1));
        place.run(&[&shipped("robots/scara.urdf"), "world.toml"], "")
    };
    let done = run("height = 0.02\n", "height = \"20 feet\"\n");
    assert!(done.code == 1 && done.stderr.contains("hint: height = 0.02, metres"), "{}", done.stderr);
    let done = run("height = [0.02, 0.03]", "height = [0.03, 0.02]");
    assert!(done.code == 1 && !done.stderr.contains("the height of its pallet is"), "{}", done.stderr);
    let done = run("name", "name");
    let note = "\"part 1,1\" counts as lifted by 120.0 mm, but the stroke raises the tool only by 100.0 mm";
    assert!(done.code == 0 && done.stdout.contains(note), "{}", done.stdout);
}
