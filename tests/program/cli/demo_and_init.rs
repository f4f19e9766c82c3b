//! The first five minutes: the demo, and files to start from.

use super::*;
use cplan::engine::Method;
use std::fs;

const KINDS: [&str; 5] = ["rr", "rp", "pr", "pp", "scara"];

fn names(place: &Place, folder: &str) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(place.path(folder))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

fn init(place: &Place, kind: &str) -> Done {
    place.run(&["init", kind, "--kind", kind], "")
}

#[test]
fn the_demo_needs_no_files() {
    let place = Place::new();
    let done = place.run(&["demo"], "--verbose").succeeds_silently();
    done.says(&["arm        scara (RR)", "found and certified", "file       plan.json", "next       open plan.html"]);
    assert_eq!(names(&place, "."), ["plan.html", "plan.json"]);
    let result: serde_json::Value = place.json("plan.json");
    assert_eq!((&result["status"], &result["certified"]), (&"found".into(), &true.into()));
    assert!(place.read("plan.html").contains("SCARA cell"));
    // The built-in cell is the one that `init` writes, so the plan of one must also hold for the other.
    assert_eq!(init(&place, "scara").code, 0);
    place.run(&["verify", "scara/arm.urdf", "scara/world.toml", "plan.json"], "").exits(0);
    let planned = place.run(&["scara/arm.urdf", "scara/world.toml"], "--json --quiet");
    assert_eq!(planned.stdout, place.read("plan.json"));
}

/// Checks the built-in cycle of a SCARA: its files are those of `init`, and each stroke overlaps with motions of the arm.
#[test]
fn the_demo_of_arch_motions_is_a_task() {
    let place = Place::new();
    place.run(&["demo"], "--kind arch").succeeds_silently().says(&["found and certified: 6 steps"]);
    let result: serde_json::Value = place.json("plan.json");
    let steps = result["steps"].as_array().unwrap();
    assert!(steps.iter().all(|step| step["stroke"]["before_arrival"].as_f64().unwrap() > 0.1), "{steps:?}");
    assert_eq!(init(&place, "arch").code, 0);
    place.run(&["verify", "arch/arm.urdf", "arch/world.toml", "plan.json"], "").exits(0);
    // The book compares this cycle with the one in which the arm rests during strokes.
    let world = place.read("arch/world.toml").replace("arch = { rise = 0.0, fall = 0.0 }", "arch = false");
    place.write("arch/resting.toml", &world);
    let resting = place.run(&["arch/arm.urdf", "arch/resting.toml"], "--json --quiet");
    let resting: serde_json::Value = serde_json::from_str(&resting.stdout).unwrap();
    let page = include_str!("../../../docs/arch_motions.md");
    let cycle = |result: &serde_json::Value| {
        let time = |event: usize| result["events"][event]["time"].as_f64().unwrap();
        time(4) - time(2)
    };
    assert!(cycle(&result) < 0.8 * cycle(&resting), "{} {}", cycle(&result), cycle(&resting));
    let row = format!("| {:.3} s | {:.3} s |", cycle(&resting), cycle(&result));
    let whole = format!("takes {:.3} s", resting["duration"].as_f64().unwrap());
    assert!(page.contains(&row) && page.contains(&whole), "docs/arch_motions.md: {row} {whole}");
}

/// Checks the built-in line: its answer is that of the shipped files, and options of planners do not apply to it.
#[test]
fn the_demo_of_a_line_follows_it() {
    let place = Place::new();
    let done = place.run(&["demo"], "--kind follow").succeeds_silently();
    done.says(&["found and certified: the tip is at most 0.009 mm from the line"]);
    assert!(place.read("plan.html").contains("The tip follows the line within"));
    let files =
        ["robots/planar_2r.urdf", "workspaces/follow/engraving.toml", "workspaces/follow/plate.gcode"].map(shipped);
    place.run(&["follow", &files[0], &files[1], &files[2]], "--output shipped.json --quiet").exits(0);
    let [demo, shipped] = ["plan.json", "shipped.json"].map(|name| {
        let mut result: serde_json::Value = place.json(name);
        result["line"].as_object_mut().unwrap().remove("file");
        result
    });
    assert_eq!(demo, shipped);
    let wider = place.run(&["demo"], "--kind follow --dir wide --clearance 0.05 --quiet");
    assert_eq!((wider.code, wider.stdout.as_str()), (0, ""), "{}", wider.stderr);
    place.run(&["demo"], "--kind follow --dir other --planner prm").refused(2, &["--kind follow takes only"]);
    assert!(!place.path("other/plan.json").exists());
}

/// Checks the built-in cell of two arms: its files are those of `init`, whose further commands work.
#[test]
fn the_demo_of_two_arms_is_the_cell_of_init() {
    let place = Place::new();
    let done = place.run(&["demo"], "--kind cell --output left.csv --output right.csv").exits(0);
    done.says(&["found: both motions are certified", "next       open plan.html", "cplan demo --kind follow"]);
    let done = init(&place, "cell").succeeds_silently();
    assert_eq!(names(&place, "cell"), ["arm.urdf", "cell.toml"]);
    let commands: Vec<&str> = done.stdout.lines().filter_map(|l| l.split_once(" cplan ").map(|c| c.1)).collect();
    assert_eq!(commands.len(), 3, "{}", done.stdout);
    for command in commands {
        place.run(&command.split(' ').collect::<Vec<_>>(), "").exits(0);
    }
    assert_eq!(names(&place, "cell"), ["arm.urdf", "cell.html", "cell.json", "cell.toml", "left.mod", "right.mod"]);
    assert_eq!(place.read("plan.json"), place.read("cell/cell.json"));
    place.run(&["verify", "cell/cell.toml", "left.csv", "right.csv"], "").exits(0);
    let cell = place.read("cell/cell.toml");
    place.write("cell/changed.toml", cell.replace("\n#height", "\nheight"));
    assert_ne!(cell, place.read("cell/changed.toml"));
    place.run(&["cell", "cell/changed.toml"], "--quiet").succeeds_silently();
    place.run(&["init", "cell"], "--kind cell").refused(1, &["cell/arm.urdf and cell/cell.toml exist already"]);
    place.run(&["init", "other"], "--kind cell --links 1,1").refused(2, &["numbers of a data sheet need"]);
    place.run(&["demo"], "--kind cell --dir other --planner prm").refused(2, &["--kind cell takes only"]);
    let done = place.run(&["demo"], "--kind cell --dir programs --template epson --output left.prg --output right.prg");
    done.exits(0).says(&["whichever program is late: proven"]);
}

#[test]
fn the_demo_does_not_overwrite_files() {
    let place = Place::new().with("plan.json", "mine");
    place.run(&["demo"], "").refused(1, &["plan.json exists already", "nothing was written", "--force", "--dir"]);
    assert_eq!((names(&place, "."), place.read("plan.json")), (vec!["plan.json".to_owned()], "mine".to_owned()));
    let elsewhere = place.run(&["demo"], "--dir new/folder --quiet --planner wavefront");
    assert_eq!((elsewhere.code, elsewhere.stdout.as_str()), (0, ""));
    assert_eq!(names(&place, "new/folder"), ["plan.html", "plan.json"]);
    place.run(&["demo"], "--dir new/folder").refused(1, &["plan.json and new/folder/plan.html exist already"]);
    // Further demonstrations write into the same folder.
    let elsewhere = place.run(&["demo"], "--dir other");
    elsewhere.says(&["cplan demo --kind arch --force --dir other", "the quill moves while the arm moves"]);
    // All commands that it suggests work, one after the other.
    let here = Place::new();
    let done = here.run(&["demo"], "").exits(0);
    let suggested: Vec<String> =
        done.stdout.lines().filter_map(|line| line.trim().strip_prefix("cplan ")).map(str::to_owned).collect();
    assert_eq!(suggested.len(), 7, "{}", done.stdout);
    for line in suggested {
        let command = line.split("  ").next().unwrap_or_default();
        here.run(&command.split(' ').collect::<Vec<_>>(), "").exits(0);
    }
    let next = "demo --planner harmonic --force --dir other";
    place.run(&next.split(' ').collect::<Vec<_>>(), "").exits(0);
    let forced = place.run(&["demo"], "--force --json --output more.csv");
    assert_eq!((forced.code, place.read("plan.json")), (0, forced.stdout));
    assert!(place.read("more.csv").starts_with("time,axis_1,"));
    place.run(&["demo"], "--dir plan.json/x").refused(1, &["cannot make the folder plan.json/x"]);
    place.run(&["demo"], "--dir plan.json").refused(1, &["plan.json: a file of this name exists"]);
    // Bad options are reported as by `cplan plan`.
    place.run(&["demo"], "--force --goal-tip 9,9").refused(1, &["--goal-tip", "out of reach"]);
    place
        .run(&["demo"], "--force --planner wavefront --gap 0.1")
        .refused(2, &["--gap needs --planner shortest or visibility"]);
}

#[test]
fn the_files_of_init_can_be_planned_at_once() {
    let place = Place::new();
    for (kind, arm) in KINDS.into_iter().zip(["RR", "RP", "PR", "PP", "RR"]) {
        let done = init(&place, kind).succeeds_silently();
        assert_eq!(names(&place, kind), ["arm.urdf", "world.schema.json", "world.toml"]);
        assert!(!place.read(&format!("{kind}/world.toml")).contains("{{"), "{kind}: a mark is left");
        // The commands that it prints.
        let commands: Vec<&str> = done.stdout.lines().filter_map(|l| l.split_once(" cplan ").map(|c| c.1)).collect();
        assert_eq!(commands.len(), 4, "{}", done.stdout);
        for command in commands {
            let words: Vec<&str> = command.split_whitespace().collect();
            let ran = place.run(&words, "").exits(0);
            assert!(!ran.stderr.contains("warning"), "{command}: {}", ran.stderr);
            match words[0] {
                "check" => assert!(ran.stdout.contains("result     "), "{}", ran.stdout),
                "inspect" => {
                    ran.says(&["result     planning with this robot is possible"]);
                    assert!(!ran.stdout.contains("warning"), "{}", ran.stdout);
                }
                "compare" => {
                    assert_eq!(ran.stdout.matches("found").count(), Method::ALL.len(), "{kind}: {}", ran.stdout)
                }
                _ => {
                    ran.says(&["found and certified"]);
                    let verbose = place.run(&words, "--verbose").stdout;
                    assert!(verbose.contains(&format!("({arm})")), "{verbose}");
                }
            }
        }
    }
}

/// Arms of data sheets, from toys to large ones: the words of the command line, and the reach that `inspect` states, in metres.
const SHEETS: [(&str, Option<f64>); 10] = [
    ("--kind scara --links 0.225,0.225 --stroke 0.2 --limits 130,145", Some(0.45)),
    ("--kind scara --links 0.4,0.2 --stroke 0.1", Some(0.6)),
    ("--kind scara --links 0.25,0.2 --limits -42:222,145", Some(0.45)),
    ("--kind scara --links 0.3,0.3 --limits 20,25 --speeds 400,600", Some(0.6)),
    ("--kind 2r --links 0.2,0.1 --limits 360,170", Some(0.3)),
    ("--kind rr --links 3,2", Some(5.0)),
    ("--kind gantry --limits 0.3,0.2 --speeds 0.5,0.4", None),
    ("--kind pp --limits 3,2", None),
    ("--kind polar --links 0.3 --limits 90,0.4", None),
    ("--kind rp --links 2 --limits 170,1", None),
];

#[test]
fn robots_of_data_sheets_can_be_planned_at_once() {
    let place = Place::new();
    for (number, (sheet, reach)) in SHEETS.into_iter().enumerate() {
        let folder = format!("sheet{number}");
        place.run(&["init", &folder], sheet).succeeds_silently();
        let [urdf, world] = ["arm.urdf", "world.toml"].map(|file| format!("{folder}/{file}"));
        let text = place.read(&world);
        assert!(!place.read(&urdf).contains("{{") && !text.contains("{{"), "{sheet}: a mark is left");
        // Only the arm with small ranges has no way past obstacles, so that they are commented out.
        assert_eq!(text.contains("\n[[obstacle]]"), !sheet.contains("--limits 20,25"), "{sheet}");
        place.run(&[&urdf, &world], "--verbose").succeeds_silently().says(&["found and certified"]);
        // The reach that the robot has is that of the data sheet.
        let inspected = place.run(&["inspect", &urdf, &world], "--json").json();
        if let Some(reach) = reach {
            let farthest = inspected["reach"]["distances"][1].as_f64().unwrap();
            assert!((farthest - reach).abs() < 1e-9, "{sheet}: {farthest}");
        }
    }
}

/// The data sheet's numbers are those of the arm, in radians.
#[test]
fn limits_and_speeds_of_data_sheets_are_those_of_the_joints() {
    let place = Place::new();
    let words = "--kind scara --links 0.225,0.225 --stroke 0.2 --limits 130,145 --speeds 375,600";
    let done = place.run(&["init", "cell"], words);
    let numbers = "links 0.225 and 0.225 m, ranges -130 to 130 deg and -145 to 145 deg, top speeds 375 deg/s and 600 deg/s, \
                   stroke 0.2 m; the shapes are simple envelopes";
    done.says(&[numbers]);
    let problem = cplan::Problem::load(place.path("cell/arm.urdf"), place.path("cell/world.toml")).unwrap();
    for (joint, [degrees, speed]) in problem.scene().arm().joints.iter().zip([[130.0, 375.0], [145.0, 600.0_f64]]) {
        let range = joint.range.domain();
        assert!((range.1.to_degrees() - degrees).abs() < 1e-3 && (range.0.to_degrees() + degrees).abs() < 1e-3);
        assert!((joint.velocity.to_degrees() - speed).abs() < 1e-3, "{}", joint.velocity);
    }
    place
        .run(&["init", "sides"], "--kind 2r --limits=-42:222,145")
        .says(&["ranges -42 to 222 deg and -145 to 145 deg"]);
    let problem = cplan::Problem::load(place.path("sides/arm.urdf"), place.path("sides/world.toml")).unwrap();
    let ranges = problem.scene().arm().joints.each_ref().map(|joint| joint.range.domain());
    for ((lower, upper), [from, to]) in ranges.into_iter().zip([[-42.0, 222.0], [-145.0, 145.0_f64]]) {
        assert!((lower.to_degrees() - from).abs() < 1e-3 && (upper.to_degrees() - to).abs() < 1e-3, "{lower} {upper}");
    }
    for (words, message) in [
        ("--kind scara --limits 10:130,145", "a range must contain 0, such as -100:130"),
        ("--kind scara --limits=-100:x,145", "x"),
        ("--kind scara --limits=-9000:130,145", "--limits -9000 is not from -3600 to -0.1 degrees"),
        (
            "--kind gantry --limits=1,-1:2",
            "--limits: joint 2 slides, beginning at 0; give only its travel, such as 0.8",
        ),
        ("--kind rr --links 0.2", "--links: an arm of two turning joints needs 2, not 1"),
        (
            "--kind gantry --links 0.2,0.1",
            "--links does not apply to a gantry, which has no links; --limits states its travels",
        ),
        ("--kind rr --stroke 0.2", "--stroke needs --kind scara"),
        ("--kind scara --limits 130", "--limits needs two numbers separated by a comma"),
        ("--kind scara --links 225,225", "--links 225 is not from 0.001 to 100 metres"),
        ("--kind scara --links 0.2,1e-9", "--links 0.000000001 is not from 0.001 to 100 metres"),
        ("--kind scara --stroke 200", "--stroke 200 is not from 0.001 to 100 metres"),
        ("--kind gantry --speeds 1,1e9", "--speeds 1000000000 is not from 0.001 to 100000 metres per second"),
        ("--kind scara --links 0,0.2", "greater than 0"),
        ("--kind scara --limits 5000,10", "--limits 5000 is not from 0.1 to 3600 degrees"),
        ("--kind pr --links 1,1", "numbers of a data sheet need --kind rr, rp, pp or scara"),
    ] {
        place.run(&["init", "other"], words).refused(2, &[message]);
    }
}

/// Returns true for lines of a starter world that are commented keys. A `#` is directly before a key, but followed by a
/// blank before words.
fn is_key(line: &str) -> bool {
    line.strip_prefix('#').is_some_and(|rest| rest.starts_with(|c: char| c.is_alphabetic() || c == '['))
}

/// The help lists other names of kinds, which mean the same.
#[test]
fn kinds_have_other_names() {
    let place = Place::new();
    let help = place.run(&["init", "--help"], "").stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    for (kind, other) in [("rr", "2r"), ("rp", "polar"), ("pp", "gantry")] {
        assert!(help.contains(&format!("; {other} is the same")), "{help}");
        for name in [kind, other] {
            place.run(&["init", name, "--kind", name], "").exits(0);
        }
        for file in ["arm.urdf", "world.toml"] {
            assert_eq!(place.read(&format!("{kind}/{file}")), place.read(&format!("{other}/{file}")), "{file}");
        }
    }
}

#[test]
fn keys_that_are_commented_out_are_valid() {
    let place = Place::new();
    for kind in ["rr", "rp", "pr", "pp"] {
        assert_eq!(init(&place, kind).code, 0);
        let world = place.read(&format!("{kind}/world.toml"));
        let lines: Vec<&str> = world.lines().collect();
        let mut tried = 0;
        let mut i = 0;
        while i < lines.len() {
            if !is_key(lines[i]) {
                i += 1;
                continue;
            }
            // A table includes the keys below it; other keys are separate.
            let is_table = lines[i].starts_with("#[");
            let end =
                if is_table { (i..lines.len()).find(|&j| !is_key(lines[j])).unwrap_or(lines.len()) } else { i + 1 };
            let mut changed: Vec<&str> = lines.clone();
            changed[i..end].iter_mut().for_each(|line| *line = &line[1..]);
            if lines[i - 1].starts_with("# Instead of the line above") {
                changed[i - 2] = "";
            }
            place.write(&format!("{kind}/changed.toml"), changed.join("\n"));
            let [robot, changed] = ["arm.urdf", "changed.toml"].map(|file| format!("{kind}/{file}"));
            place.run(&[robot, changed], "--quiet").succeeds_silently();
            tried += 1;
            i = end;
        }
        assert!(tried >= 9, "{kind}: only {tried} keys were found");
    }
}

#[test]
fn init_does_not_overwrite_files() {
    let place = Place::new();
    place.run(&["init"], "").exits(0).says(&["cplan arm.urdf world.toml --picture plan.html"]);
    place.write("world.toml", "mine");
    fs::remove_file(place.path("world.schema.json")).unwrap();
    place
        .run(&["init"], "--kind pp")
        .refused(1, &["arm.urdf and world.toml exist already", "--force", "cplan init DIR"]);
    assert_eq!(
        (names(&place, "."), place.read("world.toml")),
        (vec!["arm.urdf".into(), "world.toml".into()], "mine".into())
    );
    place.run(&["init"], "--kind pp --force").exits(0);
    assert!(place.read("world.toml").contains("bridge_slide"));
    place.run(&["init", "world.toml"], "").refused(1, &["cannot make the folder world.toml"]);
    place.run(&["init"], "--kind xyz").refused(2, &["rr, rp, pr, pp, scara"]);
    // Names that a shell would split are printed in quotes.
    place.run(&["init", "a b"], "").says(&["cplan inspect \"a b/arm.urdf\" \"a b/world.toml\""]);
}

/// Checks that a folder in which nothing can be created gives one error, and that its contents do not change.
#[cfg(unix)]
#[test]
fn places_that_cannot_be_written_give_one_error() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let place = Place::new();
    symlink("nowhere", place.path("plan.json")).unwrap();
    place.run(&["demo"], "").refused(1, &["plan.json exists already"]);
    fs::create_dir(place.path("locked")).unwrap();
    fs::set_permissions(place.path("locked"), fs::Permissions::from_mode(0o555)).unwrap();
    // For users who may write everywhere (root), no folder is locked. On systems with /proc, not even they can write
    // there.
    let locked = if fs::write(place.path("locked/probe"), "").is_ok() { "/proc" } else { "locked" };
    if fs::metadata(locked).is_ok() || locked == "locked" {
        for command in ["demo --dir", "init", "man"] {
            let words: Vec<&str> = command.split(' ').chain([locked]).collect();
            place.run(&words, "").refused(1, &["cannot write"]);
            let inside = format!("{locked}/new");
            let words: Vec<&str> = command.split(' ').chain([inside.as_str()]).collect();
            place.run(&words, "").refused(1, &["cannot make the folder"]);
        }
    }
    fs::set_permissions(place.path("locked"), fs::Permissions::from_mode(0o755)).unwrap();
}

/// Checks that every value of a wrong type is refused with its place and the right form.
#[test]
fn every_wrong_kind_of_value_has_help() {
    let place = Place::new();
    for (world, help) in [
        ("[start]\njoints = {}\n", "joints = [q1, q2]"),
        ("start = [0.1, 0.2]\n", "[start] joints = [q1, q2]"),
        ("goal = [0.1, 0.2]\n", "[goal] joints = [q1, q2]"),
        ("[robot]\njoints = { a = 1 }\n", "joints = [\"first\", \"second\"]"),
        ("[[obstacle]]\npolygon = { a = 1 }\n", "polygon = [[x, y], [x, y], [x, y]]"),
        ("[[obstacle]]\npolygon = [1, 2]\n", "write a point as [x, y]"),
        ("[[obstacle]]\ncircle = [1, 2, 3]\n", "hint"),
        ("[obstacle]\npolygon = []\n", "[[obstacle]]"),
        ("clearance = \"1 foot\"\n", "clearance = 0.01"),
        ("name = 3\n", "name = \"words\""),
        ("[[obstacle]]\ncircle = { center = [1e308, 0], radius = 1 }\n", "metres"),
    ] {
        place.plan(world, "").refused(1, &["world.toml: line ", help, "hint: "]);
    }
    place.write("world.toml", FREE);
    let robot = read(shipped("robots/planar_2r.urdf"));
    for size in ["1e308 0.1 0.1", "1e7 0.1 0.1"] {
        let at = robot.find("size=\"").unwrap() + 6;
        let end = at + robot[at..].find('"').unwrap();
        place.write("arm.urdf", format!("{}{size}{}", &robot[..at], &robot[end..]));
        place.run(&["arm.urdf", "world.toml"], "").refused(1, &["arm.urdf: line ", "too large", "metres", "hint: "]);
    }
}
