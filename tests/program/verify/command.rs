//! The command `verify` as its users see it: exit codes and output.

use super::*;

fn shelf(csv: &str, options: &str) -> Done {
    verify_table(&Place::new(), ["planar_2r", "shelf"], csv, options)
}

#[test]
fn exit_codes_agree_with_the_findings() {
    let json = |csv: &str, code: i32| shelf(csv, "--json --anywhere").exits(code).json();
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

    shelf("shoulder,elbow\n-0.9,0.4\n-0.8,x\n", "").refused(1, &["m.csv: line 3"]);
    shelf("shoulder,elbow\n-0.9,0.4\n", "--clearance -1").exits(1);
}

#[test]
fn summary_picture_clearance_and_quiet() {
    let (place, files) = (Place::new(), ["planar_2r", "shelf"]);
    let csv = "time,shoulder,elbow\n0,-0.9,0.4\n2,1.55,-0.35\n";
    let done = verify_table(&place, files, csv, "--picture m.svg").exits(3);
    done.says(&["contact", "obstacle \"shelf\" at 0.7", "proven free before 0.7", "deepest", "collision: proven"]);
    assert!(place.read("m.svg").starts_with("<svg"));
    let quiet = verify_table(&place, files, csv, "--quiet").exits(3);
    assert_eq!((quiet.stdout, quiet.stderr), (String::new(), String::new()));
    let near = shelf("shoulder,elbow\n-0.9,0.4\n-0.8,0.4\n", "--clearance 5").exits(3);
    near.says(&["apart", "too near by"]);
}

#[test]
fn jumps_of_wrapped_angles_are_noted_and_removed() {
    let run = |options: &str| {
        let csv = "shoulder,elbow\n3.1,0.4\n-3.1,0.4\n";
        verify_table(&Place::new(), ["planar_2r_continuous", "wrap_around"], csv, options)
    };
    run("").says(&["--unwrap", "-6.2000 rad"]);
    let done = run("--unwrap");
    assert!(!done.says(&["3.1832 rad"]).stdout.contains("--unwrap"), "{}", done.stdout);
}

/// Checks a motion that slides past a wall at exactly the distance to keep. All lengths are binary fractions, so the
/// computed distance is exact, but the judge must allow for rounding. So the motion is undecided.
#[test]
fn a_motion_that_grazes_at_exactly_the_clearance_is_undecided() {
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
    // The head's upper side is at 1.75.
    let table = "time,x,y\n0,0.5,1.5\n6,3.5,1.5\n";
    let place = Place::new().with("gantry.urdf", robot).with("world.toml", world).with("m.csv", table);
    let verify =
        |options: &str| place.run(&["verify", "gantry.urdf", "world.toml", "m.csv"], &format!("--clearance {options}"));
    let text = verify("0.25").exits(4).stdout;
    let line = |key: &str| text.lines().find(|line| line.starts_with(key)).unwrap_or_else(|| panic!("{key}:\n{text}"));
    assert_eq!(line("result"), "result     undecided");
    has(line("undecided"), &["link \"head\"", "obstacle \"wall\"", "250.0 mm, too near to decide"]);
    assert!(!text.contains("proven"), "{text}");
    let found = verify("0.25 --json").exits(4).json();
    assert_eq!(found["verdict"], "undecided");
    let [time, depth] = ["time", "depth"].map(|key| found["undecided"][key].as_f64().unwrap());
    // The head reaches the wall's side after 0.5 s, when its front is at 1.
    assert!((depth + 0.25).abs() < 1e-9 && (time - 0.5).abs() < 1e-3, "{depth} at {time}");
    assert!(["clearance", "first_contact", "nearest"].iter().all(|key| found[key].is_null()), "{found}");
    assert_eq!(verify("0.25 --quiet").exits(4).stdout, "");
    // Slightly to either side, the verdict is definite.
    verify("0.249999").exits(0);
    verify("0.250001").exits(3);
}
