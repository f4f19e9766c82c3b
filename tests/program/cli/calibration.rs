//! Errors of the robot and its world, and clearances of single obstacles, through the program and the checker.

use super::*;

const ALL: &str = "base=0.5mm,0.05deg; links=0.2mm; zeros=0.02deg; obstacles=1mm";

/// Returns the shipped world with these lines before its start.
fn with(world: &str, lines: &str) -> String {
    let [_, world] = files(world);
    read(&world).replacen("[start]", &format!("{lines}\n[start]"), 1)
}

/// The option and the world file state the same errors, and the answers are the same.
#[test]
fn errors_in_the_world_and_in_the_option_have_the_same_answer() {
    let place = Place::new();
    let [urdf, world] = files("shelf");
    let table = "[robot]\ncalibration = { base = \"0.5 mm, 0.05deg\", links = \"0.2 mm\", zeros = \"0.02deg\", obstacles = \"1 mm\" }";
    place.write("world.toml", with("shelf", table));
    let drawn = place.run(&[&urdf, &world, "--json"], "").exits(0);
    let option = place.run(&[&urdf, &world, "--json", "--calibration", ALL], "").exits(0);
    let file = place.run(&[&urdf, "world.toml", "--json"], "").exits(0);
    let [drawn, option, file] = [drawn, option, file].map(|done| serde_json::from_str::<Value>(&done.stdout).unwrap());
    assert!(drawn.get("calibration").is_none(), "{drawn}");
    assert_eq!(option["path"], file["path"]);
    assert_eq!(option["calibration"], file["calibration"]);
    let calibration = &option["calibration"];
    assert!((number(&calibration["base"]["angle"]) - 0.05_f64.to_radians()).abs() < 1e-15, "{calibration}");
    assert_eq!((number(&calibration["links"]), number(&calibration["obstacles"])), (2e-4, 1e-3));
    assert_eq!(calibration["drawn"], "found");
    assert!(calibration["proves"].as_str().unwrap().contains("free for every robot"), "{calibration}");
    assert!(number(&option["length"]) > number(&drawn["length"]), "the path is not longer");
    // Margins of the drawn robot cover the errors.
    for margin in option["margins"].as_array().unwrap() {
        assert!(
            margin["kind"] != "obstacle" || margin["clearance"].as_f64().is_none_or(|kept| kept >= 0.9 * 1.5e-3),
            "{margin}"
        );
    }
    let words = place.run(&[&urdf, &world, "--calibration", ALL], "").exits(0);
    let line =
        "the motion is free for every robot and world within these errors: base 0.5 mm and 0.05 deg, links 0.2 mm";
    assert!(words.stdout.contains(line), "{}", words.stdout);
}

/// The checker reads the errors by itself, and refutes a motion that is free for the drawn robot alone.
#[test]
fn the_checker_knows_errors_and_clearances_of_obstacles() {
    let place = Place::new();
    let [urdf, world] = files("shelf");
    let judged = |world: &str, certificate: &str| check(&read(&urdf), world, certificate);
    let certified = |words: &[&str]| {
        place.run(&[&[&urdf as &str, "world.toml", "--quiet", "--certificate", "c.json"], words].concat(), "").exits(0);
        certificates::without_digests(&place.read("c.json"))
    };
    let text = read(&world);
    place.write("world.toml", &text);
    let drawn = certified(&[]);
    let within = certified(&["--calibration", ALL]);
    assert!(judged(&text, &drawn).is_ok());
    let said = judged(&text, &within).unwrap();
    assert!(said.contains("this holds for all robots and worlds within the stated errors"), "{said}");
    let table =
        with("shelf", "[robot]\ncalibration = { base = \"0.5 mm, 0.05deg\", links = \"0.2 mm\", zeros = \"0.02deg\" }");
    let refuted = judged(&table, &drawn).unwrap_err().to_string();
    assert!(refuted.contains("is not proven") || refuted.contains("farther than"), "{refuted}");
    let near = text.replace("[[obstacle]]\nname = \"shelf\"\n", "[[obstacle]]\nname = \"shelf\"\nclearance = 0.03\n");
    assert_ne!(near, text);
    place.write("world.toml", &near);
    let kept = certified(&[]);
    assert!(judged(&near, &kept).is_ok(), "{:?}", judged(&near, &kept));
    assert!(judged(&near, &drawn).is_err());
    assert!(judged(&near.replace("clearance = 0.03", "clearance = 0.06"), &kept).is_err());
}

/// An answer states that only the errors exclude motions, and the checker accepts its proof.
#[test]
fn no_motion_for_all_robots_is_apart_from_none_for_the_drawn_one() {
    let place = Place::new();
    let [urdf, world] = files("shelf");
    let errors = ["--calibration", "obstacles=200mm"];
    let done = place.run(&[&[&urdf as &str, &world, "--json", "--certificate", "c.json"], &errors[..]].concat(), "");
    let result: Value = serde_json::from_str(&done.stdout).unwrap();
    assert_eq!((done.code, &result["calibration"]["drawn"]), (3, &Value::from("found")), "{}", done.stdout);
    let proves = result["calibration"]["proves"].as_str().unwrap();
    assert!(proves.contains("no motion is free for all robots"), "{proves}");
    let certificate = certificates::without_digests(&place.read("c.json"));
    let judged = |certificate: &str| check(&read(&urdf), &read(&world), certificate);
    assert!(judged(&certificate).is_ok(), "{:?}", judged(&certificate));
    assert!(judged(&certificate.replace("obstacles=0.2m", "obstacles=0.001m")).is_err());
    let words = place.run(&[&[&urdf as &str, &world], &errors[..]].concat(), "").exits(3);
    assert!(words.stdout.contains("; without errors, there is one"), "{}", words.stdout);
}

/// `verify` and `check` ask for the same distances, and state those of the real shapes.
#[test]
fn configurations_and_recordings_are_judged_within_the_errors() {
    let place = Place::new();
    let [urdf, world] = files("shelf");
    place.run(&[&urdf, &world], "--quiet --output drawn.json").exits(0);
    place.run(&[&urdf, &world, "--calibration", ALL], "--quiet --output within.json").exits(0);
    place.run(&["verify", &urdf, &world, "within.json", "--calibration", ALL], "").exits(0);
    place.run(&["verify", &urdf, &world, "drawn.json"], "").exits(0);
    let done = place.run(&["verify", &urdf, &world, "drawn.json", "--calibration", ALL], "");
    assert!(done.code == 3 || done.code == 4, "{}", done.stdout);
    let nearest = place.json("drawn.json");
    let at = nearest["margins"].as_array().unwrap().iter().min_by(|a, b| {
        let size = |margin: &Value| margin["clearance"].as_f64().unwrap_or(f64::INFINITY);
        size(a).total_cmp(&size(b))
    });
    let at = at.unwrap()["at"].as_array().unwrap();
    let at = format!("--at={},{}", at[0], at[1]);
    let free = place.run(&["check", &urdf, &world, &at], "").exits(0);
    assert!(free.stdout.contains("free"), "{}", free.stdout);
    let near = place.run(&["check", &urdf, &world, &at, "--calibration", ALL], "");
    assert!(near.stdout.contains("for the stated errors"), "{}", near.stdout);
    assert!(!near.stdout.contains("penetrates"), "{}", near.stdout);
}

#[test]
fn mistakes_have_a_place_and_a_hint() {
    let place = Place::new();
    let [urdf, world] = files("shelf");
    for (lines, message) in [
        ("[robot]\ncalibration = { base = 0.5 }", "reach"),
        ("[robot]\ncalibration = { bases = \"1 mm\" }", "unknown key `bases`"),
        ("[robot]\ncalibration = { base = \"1\" }", "\"1\" has no unit"),
        ("[robot]\ncalibration = { links = \"1deg\" }", "the error of a length"),
        ("[robot]\ncalibration = { zeros = \"-1deg\" }", "from 0 to 90 degrees"),
    ] {
        place.write("world.toml", with("shelf", lines));
        let done = place.run(&[&urdf, "world.toml"], "");
        assert!(done.code == 1, "{lines}: {}", done.code);
        if message != "reach" {
            done.warns(&[message, "world.toml: line "]);
        }
    }
    let lower = with("shelf", "").replace("name = \"crate\"\n", "name = \"crate\"\nclearance = 0.01\n");
    place.write("world.toml", format!("clearance = 0.02\n{lower}"));
    let refused = place.run(&[&urdf, "world.toml"], "").exits(1);
    refused.warns(&["the clearance of 0.01 m is less than the world's clearance of 0.02 m", "hint"]);
    let refused = place.run(&[&urdf, &world, "--calibration", "base=1"], "").exits(2);
    refused.warns(&["--calibration", "no unit"]);
    let job = ["gcode", "labels.toml", "labels.gcode"].map(|name| shipped(&format!("workspaces/gcode/{name}")));
    let scara = shipped("robots/scara.urdf");
    let judged = |errors| place.run(&["gcode", &scara, &job[1], &job[2], "--check", "--calibration", errors], "");
    judged("zeros=0.02deg").exits(1).warns(&["G-code is judged only for errors of the places"]);
    judged("obstacles=1mm").exits(3);
    let task = [shipped("robots/scara.urdf"), shipped("workspaces/tasks/feeder.toml")];
    let refused = place.run(&[&task[0], &task[1], "--calibration", "base=1mm"], "").exits(1);
    refused.warns(&["errors (calibration) do not apply to worlds with steps", "hint"]);
}
