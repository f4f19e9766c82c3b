//! Slips of the keyboard and of units: the message names the probable intention.

use super::*;

#[test]
fn misspelled_words_get_the_nearest_one() {
    let place = Place::new();
    let world = |text: &str| format!("{FREE}{text}\n");
    for (text, meant) in [
        ("clearence = 0.1", "did you mean `clearance`?"),
        ("[[obstacel]]\nname = \"x\"", "did you mean `obstacle`?"),
        ("[[obstacle]]\npoligon = [[5, 5], [6, 5], [6, 6]]", "did you mean `polygon`?"),
        ("[[obstacle]]\ncircle = { centre = [5, 5], radius = 1 }", "did you mean `center`?"),
        ("[robot]\nvelocities = { shoulder = 1 }", "did you mean `velocity`?"),
    ] {
        // Keys of the world itself must come before its tables.
        let whole = if text.starts_with('[') { world(text) } else { format!("{text}\n{FREE}") };
        place.plan(whole, "").refused(1, &["unknown key", meant]);
    }
    place.plan(world("[robot]\ncolour = 1"), "").refused(1, &["unknown key `colour`", "use a known key"]);
    place.plan(FREE, "--planner visibilty").refused(2, &["visibilty", "'visibility'"]);
    place.plan(FREE, "--planer visibility").refused(2, &["--planer", "'--planner'"]);
}

#[test]
fn files_of_another_command_get_its_name() {
    let place = Place::new();
    let cell = "[[arm]]\nname = \"left\"\nurdf = \"arm.urdf\"\n";
    place.plan(cell, "").refused(1, &["unknown key `arm`", "`cplan cell "]);
    let place = place.with("world.toml", FREE);
    place.run(&["cell", "world.toml"], "").refused(1, &["unknown key `goal`", "use `cplan URDF WORLD`"]);
}

#[test]
fn misspelled_commands_get_the_nearest_one() {
    let place = Place::new();
    for (words, meant) in [
        (&["verfy", "no.urdf", "no.toml", "plan.csv"][..], "did you mean `cplan verify`?"),
        (&["explan", "no.urdf", "no.toml"], "did you mean `cplan explain`?"),
        (&["chekc", "no.urdf"], "did you mean `cplan check`?"),
        (&["help", "studdy"], "did you mean `cplan study`?"),
        (&["frobnicate"], "`cplan --help` lists the commands"),
    ] {
        place.run(words, "").refused(2, &["there is no command", meant]);
    }
    let told = place.run(&["verfy"], "--json");
    assert_eq!(told.json()["cure"], "did you mean `cplan verify`?");
}

#[test]
fn missing_files_get_the_nearest_name() {
    let place = Place::new();
    place.write("shelf.toml", FREE);
    let robot = shipped("robots/planar_2r.urdf");
    place.run(&[&robot, "shef.toml"], "").refused(1, &["shef.toml: cannot be read", "did you mean shelf.toml?"]);
    place.run(&[&robot, "nothing.toml"], "").refused(1, &["nothing.toml: cannot be read", "check the path"]);
    place.write("walls.yaml", "");
    let world = format!("{FREE}[[obstacle]]\nimage = \"wals.yaml\"\n");
    place.plan(world, "").refused(1, &["there is no file", "did you mean \"walls.yaml\"?"]);
}

#[test]
fn degrees_and_millimetres_are_suspected() {
    let place = Place::new();
    place.plan(FREE, "--start -51.6,0.4").refused(1, &["exceeds its limits", "write -51.6deg"]);
    place.plan(FREE.replace("-0.9", "-51.6"), "").refused(1, &["exceeds its limits", "write \"-51.6deg\""]);
    place.plan(FREE, "--goal 400deg,0").refused(1, &["exceeds its limits", "choose values within the limits"]);
    place
        .plan(FREE.replace("-0.9", "\"400deg\""), "")
        .refused(1, &["exceeds its limits", "choose values within the limits"]);
    place.plan(FREE, "--start 3.5,0.4").refused(1, &["exceeds its limits", "choose values within the limits"]);
    let post = format!("{FREE}[[obstacle]]\ncircle = {{ center = [1.2, 1.4], radius = 0.1 }}\n");
    place.plan(&post, "--clearance 20").refused(1, &["clearance of 20 m", "if 20 mm are meant, write 20mm"]);
    let far = format!("{post}[[obstacle]]\nname = \"far\"\ncircle = {{ center = [500, 0], radius = 1 }}\n");
    let done = place.plan(far, "");
    assert!(done.stderr.contains("obstacle \"far\" is 499.0000 m from joint 1"), "{}", done.stderr);
    assert!(!place.plan(post, "").stderr.contains("warning"));
    place.write("world.toml", FREE);
    let check =
        |at: &str| place.run(&["check", &shipped("robots/planar_2r.urdf"), "world.toml", "--at", at], "").stdout;
    assert!(check("10,45").contains("if degrees are meant, write 10deg and 45deg"));
    assert!(!check("400deg,0").contains("degrees are meant"));
}

/// Checks that a world with units is the same world as one in metres, for the program and for the checker.
#[test]
fn lengths_may_have_units() {
    let place = Place::new();
    let metres = format!(
        "clearance = 0.02\n{FREE}[robot]\nat = [0.05, 0]\n[[obstacle]]\nname = \"post\"\ncircle = {{ center = [1.2, 1.4], radius = 0.1 }}\n\
         [[obstacle]]\nname = \"board\"\nat = [0, -1.7]\npolygon = [[0, 0], [0.254, 0], [0.254, 0.05]]\nheight = [-1, 1]\n"
    );
    let units = metres
        .replace("clearance = 0.02", "clearance = \"20 mm\"")
        .replace("at = [0.05, 0]", "at = [\"5cm\", 0]")
        .replace("[1.2, 1.4], radius = 0.1", "[\"1200mm\", 1.4], radius = \"1 dm\"")
        .replace("[0.254, 0], [0.254, 0.05]", "[\"10in\", 0], [\"254 mm\", \"50 mm\"]")
        .replace("[0, -1.7]", "[\"0 m\", \"-1700mm\"]")
        .replace("[-1, 1]", "[\"-1m\", \"1m\"]");
    let path = |world: &str| place.plan(world, "--json --certificate proof.json").json()["path"].clone();
    let expected = path(&metres);
    assert!(expected.is_array());
    assert_eq!(path(&units), expected);
    let checked = place.run(&["recheck", &shipped("robots/planar_2r.urdf"), "world.toml", "--proof", "proof.json"], "");
    assert_eq!(checked.code, 0, "{}{}", checked.stdout, checked.stderr);
    let refused = units.replace("\"1 dm\"", "\"1 foot\"");
    place.plan(refused, "").refused(1, &["a length such as \"20 mm\", found \"1 foot\""]);
    place.plan(units.replace("\"1 dm\"", "\"10\""), "").refused(1, &["found \"10\""]);
    assert_eq!(place.plan(&metres, "--clearance 20mm --json").json()["path"], expected);
    place.plan(metres, "--clearance 20furlongs").refused(2, &["20furlongs", "such as 0.02 or 20mm"]);
}

#[test]
fn without_words_the_commands_are_listed() {
    let done = Place::new().run::<&str>(&[], "");
    assert_eq!((done.code, done.stdout.as_str()), (2, ""));
    for part in ["explain", "study", "cplan demo", "cplan --help"] {
        assert!(done.stderr.contains(part), "{part}: {}", done.stderr);
    }
    assert!(done.stderr.lines().count() < 50);
}

/// Checks that `follow` says that a world has steps, which it leaves out, and what plans them.
#[test]
fn follow_refers_worlds_with_steps_to_plan() {
    let place = Place::new();
    let [robot, world] = ["robots/scara.urdf", "workspaces/tasks/kitting_cell.toml"].map(shipped);
    let line = shipped("workspaces/follow/gasket.gcode");
    let done = place.run(&["follow", &robot, &world, &line], "");
    assert!(done.stdout.contains("ignores the world's steps; `cplan plan`"), "{}", done.stdout);
    place.run(&["follow", &robot, &world], "").refused(2, &["PATH", "cplan plan URDF WORLD"]);
}
