//! The command `verify` as its users see it: exit codes and output.

use crate::cli::has;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

fn repository_file(file: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(file).display().to_string()
}

/// Runs `verify` on a robot, a world and a CSV text.
fn verify(robot: &str, world: &str, csv: &str, options: &[&str]) -> (i32, String, String) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("m.csv"), csv).unwrap();
    let (robot, world) =
        (repository_file(&format!("robots/{robot}.urdf")), repository_file(&format!("workspaces/{world}.toml")));
    let run = Command::new(env!("CARGO_BIN_EXE_cplan"))
        .current_dir(folder.path())
        .args(["verify", &robot, &world, "m.csv"])
        .args(options)
        .output();
    let Output { status, stdout, stderr } = run.unwrap();
    for file in options.iter().filter(|o| o.ends_with(".svg")) {
        let picture = std::fs::read_to_string(folder.path().join(file)).unwrap();
        assert!(picture.starts_with("<svg") || picture.starts_with("<?xml"), "{picture:.40}");
    }
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (status.code().unwrap(), text(stdout), text(stderr))
}

#[test]
fn exit_codes_agree_with_the_findings() {
    let shelf = |csv: &str, options: &[&str]| verify("planar_2r", "shelf", csv, options);
    let json = |csv: &str, code: i32| -> Value {
        let (found, stdout, stderr) = shelf(csv, &["--json", "--anywhere"]);
        assert_eq!(found, code, "{stderr}");
        serde_json::from_str(&stdout).unwrap()
    };
    let free = json("shoulder,elbow\n-0.9,0.4\n-0.8,0.4\n", 0);
    assert_eq!((&free["verdict"], &free["joints"][1]), (&"free".into(), &"elbow".into()));
    assert!(free["clearance"].as_f64().unwrap() > 0.0 && free["nearest"]["depth"].as_f64().unwrap() < 0.0);
    assert!(free["first_contact"].is_null() && free["duration"].is_null());

    let hit = json("time,shoulder,elbow\n0,-0.9,0.4\n2,1.55,-0.35\n", 3);
    assert_eq!((&hit["verdict"], &hit["first_contact"]["obstacle"]), (&"collision".into(), &"shelf".into()));
    let (time, until) = (hit["first_contact"]["time"].as_f64().unwrap(), hit["free_until"].as_f64().unwrap());
    assert!(0.0 < until && until <= time && time < 2.0);

    let fast = json("time,shoulder,elbow\n0,-0.9,0.4\n0.01,-0.8,0.4\n", 3);
    assert_eq!(fast["verdict"], "limits");
    let broken = &fast["limits_broken"][0];
    assert_eq!((&broken["joint"], &broken["limit"]), (&"shoulder".into(), &"velocity".into()));
    assert!((broken["value"].as_f64().unwrap() - 10.0).abs() < 1e-9);

    let (code, stdout, stderr) = shelf("shoulder,elbow\n-0.9,0.4\n-0.8,x\n", &[]);
    assert_eq!((code, stdout.as_str()), (1, ""));
    assert!(stderr.contains("m.csv: line 3"), "{stderr}");
    assert_eq!(shelf("shoulder,elbow\n-0.9,0.4\n", &["--clearance", "-1"]).0, 1);
}

#[test]
fn summary_picture_clearance_and_quiet() {
    let csv = "time,shoulder,elbow\n0,-0.9,0.4\n2,1.55,-0.35\n";
    let (code, stdout, _) = verify("planar_2r", "shelf", csv, &["--picture", "m.svg"]);
    assert_eq!(code, 3);
    has(&stdout, &["contact", "obstacle \"shelf\" at 0.7", "proven free before 0.7", "deepest", "collision: proven"]);
    assert_eq!(verify("planar_2r", "shelf", csv, &["--quiet"]), (3, String::new(), String::new()));
    let near = "shoulder,elbow\n-0.9,0.4\n-0.8,0.4\n";
    let (code, stdout, _) = verify("planar_2r", "shelf", near, &["--clearance", "5"]);
    assert_eq!(code, 3);
    assert!(stdout.contains("apart") && stdout.contains("nearer than the required clearance"), "{stdout}");
}

#[test]
fn jumps_of_wrapped_angles_are_noted_and_removed() {
    let csv = "shoulder,elbow\n3.1,0.4\n-3.1,0.4\n";
    let run = |options: &[&str]| verify("planar_2r_continuous", "wrap_around", csv, options);
    let (_, stdout, _) = run(&[]);
    assert!(stdout.contains("--unwrap") && stdout.contains("-6.2000 rad"), "{stdout}");
    let (_, stdout, _) = run(&["--unwrap"]);
    assert!(!stdout.contains("--unwrap") && stdout.contains("3.1832 rad"), "{stdout}");
}

/// Checks a motion that slides past a wall at exactly the distance to keep. All lengths are binary fractions, so the
/// computed distance is exact, but the judge must allow for rounding. So the motion is undecided.
#[test]
fn a_motion_that_grazes_at_exactly_the_clearance_is_undecided() {
    let folder = tempfile::tempdir().unwrap();
    let at = |file: &str| folder.path().join(file);
    let slide = |name: &str, parent: &str, child: &str, axis: &str| {
        format!(
            "<joint name=\"{name}\" type=\"prismatic\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
             <axis xyz=\"{axis}\"/><limit lower=\"0\" upper=\"4\" effort=\"1\" velocity=\"1\"/></joint>"
        )
    };
    let robot = format!(
        "<robot name=\"gantry\"><link name=\"base\"/>{}<link name=\"bridge\"/>{}<link name=\"head\"><collision>\
         <geometry><box size=\"0.5 0.5 0.5\"/></geometry></collision></link></robot>",
        slide("x", "base", "bridge", "1 0 0"),
        slide("y", "bridge", "head", "0 1 0")
    );
    let world = "[[obstacle]]\nname = \"wall\"\npolygon = [[1.0, 2.0], [3.0, 2.0], [3.0, 2.5], [1.0, 2.5]]\n";
    std::fs::write(at("gantry.urdf"), robot).unwrap();
    std::fs::write(at("world.toml"), world).unwrap();
    // The head's upper side is at 1.75.
    std::fs::write(at("m.csv"), "time,x,y\n0,0.5,1.5\n6,3.5,1.5\n").unwrap();
    let verify = |options: &[&str]| {
        let run = Command::new(env!("CARGO_BIN_EXE_cplan"))
            .current_dir(folder.path())
            .args(["verify", "gantry.urdf", "world.toml", "m.csv"])
            .args(options)
            .output();
        let Output { status, stdout, .. } = run.unwrap();
        (status.code(), String::from_utf8(stdout).unwrap())
    };
    let (code, text) = verify(&["--clearance", "0.25"]);
    assert_eq!(code, Some(4), "{text}");
    let line = |key: &str| text.lines().find(|line| line.starts_with(key)).unwrap_or_else(|| panic!("{key}:\n{text}"));
    assert_eq!(line("result"), "result     undecided");
    for part in ["link \"head\"", "obstacle \"wall\"", "250.0 mm, too near to decide"] {
        assert!(line("undecided").contains(part), "no \"{part}\" in:\n{text}");
    }
    assert!(!text.contains("proven"), "{text}");
    let (code, json) = verify(&["--clearance", "0.25", "--json"]);
    let found: Value = serde_json::from_str(&json).unwrap();
    assert_eq!((code, &found["verdict"]), (Some(4), &"undecided".into()));
    let [time, depth] = ["time", "depth"].map(|key| found["undecided"][key].as_f64().unwrap());
    // The head reaches the wall's side after 0.5 s, when its front is at 1.
    assert!((depth + 0.25).abs() < 1e-9 && (time - 0.5).abs() < 1e-3, "{depth} at {time}");
    assert!(["clearance", "first_contact", "nearest"].iter().all(|key| found[key].is_null()), "{json}");
    assert_eq!(verify(&["--clearance", "0.25", "--quiet"]), (Some(4), String::new()));
    // Slightly to either side, the verdict is definite.
    assert_eq!(verify(&["--clearance", "0.249999"]).0, Some(0));
    assert_eq!(verify(&["--clearance", "0.250001"]).0, Some(3));
}
