//! Files as people and exporters write them. If a file can have only one meaning, the program uses that and reports it.
//! Otherwise it refuses the file with a hint.

impl Done {
    /// Checks that a path is found, and that the summary has all parts.
    fn found(&self, parts: &[&str]) {
        assert_eq!(self.code, 0, "{}{}", self.stdout, self.stderr);
        self.says(parts);
    }
}

use super::*;
fn obstacle(shape: &str) -> String {
    format!("{FREE}[[obstacle]]\nname = \"it\"\n{shape}\n")
}

/// Returns those parts of the result that do not depend on how the obstacles are written.
fn path_of(done: &Done) -> serde_json::Value {
    assert_eq!(done.code, 0, "{}", done.stderr);
    done.json()["path"].clone()
}

#[test]
fn repeated_points_of_rings_are_ignored() {
    let place = Place::new();
    let plain =
        path_of(&place.plan(obstacle("polygon = [[1.15, 0.18], [1.6, 0.18], [1.6, 0.3], [1.15, 0.3]]"), "--json"));
    for (shape, note) in [
        ("polygon = [[1.15, 0.18], [1.6, 0.18], [1.6, 0.3], [1.15, 0.3], [1.15, 0.18]]", "repeats the first"),
        ("polygon = [[1.15, 0.18], [1.6, 0.18], [1.6, 0.18], [1.6, 0.3], [1.15, 0.3]]", "repeat the previous point"),
        ("polygon = [[[1.15, 0.18], [1.6, 0.18], [1.6, 0.3], [1.15, 0.3], [1.15, 0.18]]]", "repeats the first"),
    ] {
        assert_eq!(path_of(&place.plan(obstacle(shape), "--json")), plain, "{shape}");
        place.plan(obstacle(shape), "").found(&["obstacle \"it\": ", note]);
    }
    let wall = path_of(&place.plan(obstacle("polyline = [[1.2, 0.2], [1.6, 0.2], [1.6, 0.4]]"), "--json"));
    let repeated = "polyline = [[1.2, 0.2], [1.2, 0.2], [1.6, 0.2], [1.6, 0.4], [1.6, 0.4]]";
    assert_eq!(path_of(&place.plan(obstacle(repeated), "--json")), wall);
    place.plan(obstacle(repeated), "").found(&["repeat the previous point"]);
    // A polyline may return to an earlier point.
    place
        .plan(obstacle("polyline = [[1.2, 0.2], [1.6, 0.2], [1.6, 0.4], [1.2, 0.2], [1.1, 0.3]]"), "--quiet")
        .found(&[]);
}

#[test]
fn preferred_regions_are_read_like_obstacles_and_noted_by_verify() {
    let place = Place::new();
    let robot = shipped("robots/planar_2r.urdf");
    let wish = |shape: &str| format!("{FREE}[[preference]]\nname = \"wish\"\nepsilon = 0.3\n{shape}\n");
    let options = "--planner wavefront --quiet --output a.csv";
    place.plan(wish("polygon = [[0.2, 0.3], [0.5, 0.3], [0.5, 0.6]]"), options).exits(0);
    for (shape, note) in [
        (
            "polygon = [[0.2, 0.3], [0.5, 0.3], [0.5, 0.6], [0.2, 0.3]]",
            "preference \"wish\": the last point of a ring repeats",
        ),
        (
            "polygon = [[0.2, 0.3], [0.5, 0.3], [0.5, 0.3], [0.5, 0.6]]",
            "preference \"wish\": points that repeat the previous",
        ),
        ("configurations = [[0, 0], [1, 0], [1, 1], [0, 0]]", "preference \"wish\": the last point of a ring repeats"),
    ] {
        place.plan(wish(shape), "").found(&[note]);
        // The motion for the world without repeated points is judged in this world.
        let judged = place.run(&["verify", &robot, "world.toml", "a.csv"], "");
        judged.found(&[note]);
    }
    for (shape, parts) in [
        ("polygon = [[0.2, 0.3], [0.5, 0.6], [0.5, 0.3], [0.2, 0.6]]", "sides 1 and 3 cross"),
        (
            "polygon = [[1.2, 0.2], [1.4, 0.1], [1.4, 0.3], [1.2, 0.2], [1.0, 0.35], [1.0, 0.3]]",
            "corners 1 and 4 coincide",
        ),
    ] {
        let refused = place.plan(wish(shape), "");
        refused.refused(
            1,
            &["preference \"wish\" is not a simple polygon", parts, "line 8", "hint: list the corners in order"],
        );
    }
}

/// A world with a plate whose hole contains the start.
const PLATE: &str = "[start]\njoints = [0.0, 0.0]\n[goal]\njoints = [GOAL]\n[[obstacle]]\nname = \"plate\"\n";

#[test]
fn holes_are_free_and_enclosed() {
    let place = Place::new();
    let thin = |goal: &str, shape: &str| format!("{}{shape}\n", PLATE.replace("GOAL", goal));
    place.write("arm.urdf", arm("velocity=\"2\"").replace("size=\"1 0.05 0.05\"", "size=\"0.1 0.05 0.05\""));
    let plan = |world: String, options: &str| {
        place.write("world.toml", world);
        place.run(&["arm.urdf", "world.toml"], options)
    };
    // The second link, a short block at (1.5, 0), is in the hole. If joint 1 turns, the link leaves the hole.
    let outer = "[[1, -0.5], [2.2, -0.5], [2.2, 0.5], [1, 0.5]]";
    let hole = "[[1.3, -0.2], [1.7, -0.2], [1.7, 0.2], [1.3, 0.2]]";
    for shape in [format!("polygon = {outer}\nholes = [{hole}]"), format!("polygon = [{outer}, {hole}]")] {
        plan(thin("0.05, 0.0", &shape), "").found(&["plate"]);
        plan(thin("1.5, 0.0", &shape), "").exits(3);
    }
    plan(thin("0.05, 0.0", &format!("polygon = {outer}")), "").refused(1, &["the start", "hits obstacle \"plate\""]);
    let outside = format!("polygon = {outer}\nholes = [[[5, 5], [6, 5], [6, 6]]]");
    plan(thin("1.5, 0.0", &outside), "").refused(1, &["hole 1 does not lie inside", "line 8", "hint"]);
    let alone = "circle = { center = [1, 1], radius = 0.1 }\nholes = [[[5, 5], [6, 5], [6, 6]]]";
    plan(thin("1.5, 0.0", alone), "").refused(1, &["`holes` needs `polygon`", "hint"]);
    // Pictures of all kinds show the obstacles.
    let shape = format!("polygon = {outer}\nholes = [{hole}]");
    plan(thin("0.05, 0.0", &shape), "--picture a.svg --picture a.html --quiet").found(&[]);
    assert!(place.read("a.svg").contains("<path"));
}

#[test]
fn touching_corners_are_accepted_and_crossings_refused() {
    let place = Place::new();
    // Two lobes that meet in a point, and a ring whose corner lies on another of its sides.
    let lobes = "polygon = [[1.2, 0.2], [1.4, 0.1], [1.4, 0.3], [1.2, 0.2], [1.0, 0.35], [1.0, 0.3]]";
    place.plan(obstacle(lobes), "").found(&["touches itself in single points"]);
    let pinched = "polygon = [[1.1, 0.2], [1.5, 0.2], [1.5, 0.4], [1.3, 0.2], [1.1, 0.4]]";
    place.plan(obstacle(pinched), "").found(&["touches itself in single points"]);
    let crossing = "polygon = [[1.1, 0.2], [1.3, 0.3], [1.5, 0.4], [1.5, 0.2], [1.3, 0.3], [1.1, 0.4]]";
    place.plan(obstacle(crossing), "").refused(1, &["crosses itself at (1.3, 0.3)", "hint"]);
}

/// Returns an arm whose joints have only these attributes in their `<limit>`.
fn arm(limit: &str) -> String {
    let link = |name: &str| {
        format!(
            "<link name=\"{name}\"><collision><origin xyz=\"0.5 0 0\"/><geometry><box size=\"1 0.05 0.05\"/></geometry>\
             </collision></link>"
        )
    };
    let joint = |name: &str, at: &str, parent: &str, child: &str| {
        let limit = if limit.is_empty() { String::new() } else { format!("<limit {limit}/>") };
        format!(
            "<joint name=\"{name}\" type=\"continuous\"><origin xyz=\"{at}\"/><parent link=\"{parent}\"/>\
             <child link=\"{child}\"/><axis xyz=\"0 0 1\"/>{limit}</joint>"
        )
    };
    format!(
        "<robot name=\"r\"><link name=\"base\"/>{}{}{}{}</robot>",
        link("upper"),
        link("fore"),
        joint("j1", "0 0 0", "base", "upper"),
        joint("j2", "1 0 0", "upper", "fore")
    )
}

const TURN: &str = "[start]\njoints = [0, 1]\n[goal]\njoints = [1, -1]\n";

#[test]
fn missing_speeds_are_assumed_and_reported() {
    let place = Place::new().with("world.toml", TURN);
    let run = |urdf: String, options: &str| {
        place.write("arm.urdf", urdf);
        place.run(&["arm.urdf", "world.toml"], options)
    };
    let given = run(arm("velocity=\"1\" effort=\"1\""), "--json").json();
    assert!(given["assumed"].get("velocity").is_none(), "{given}");
    for limit in ["", "effort=\"inf\"", "velocity=\"0\"", "velocity=\"inf\" effort=\"inf\""] {
        let json = run(arm(limit), "--json").json();
        assert_eq!(json["assumed"]["velocity"], serde_json::json!({ "j1": 1.0, "j2": 1.0 }), "{limit}");
        assert_eq!(json["assumed"]["acceleration"], serde_json::json!({ "j1": 4.0, "j2": 4.0 }), "{limit}");
        assert_eq!((&json["path"], &json["trajectory"]), (&given["path"], &given["trajectory"]), "{limit}");
        run(arm(limit), "").found(&["joint \"j1\": no top speed given; 1 rad/s assumed"]);
    }
    let sliding = arm("lower=\"-1\" upper=\"1\"").replace("type=\"continuous\"", "type=\"prismatic\"");
    let sliding = sliding.replacen("xyz=\"0 0 1\"", "xyz=\"1 0 0\"", 1).replacen("xyz=\"0 0 1\"", "xyz=\"0 1 0\"", 1);
    let json = run(sliding, "--json").json();
    assert_eq!(json["assumed"]["velocity"], serde_json::json!({ "j1": 0.25, "j2": 0.25 }));
    let named = TURN.to_owned() + "[robot]\nvelocity = { j1 = 2.0, j2 = 3.0 }\nacceleration = { j1 = 9, j2 = 9 }\n";
    place.write("world.toml", named);
    assert!(run(arm(""), "--json").json().get("assumed").is_none());
}

#[test]
fn missing_limits_make_a_joint_continuous() {
    let place = Place::new().with("world.toml", TURN);
    let turning = |limits: &str| arm(&format!("{limits} velocity=\"1\"")).replace("\"continuous\"", "\"revolute\"");
    let run = |urdf: String, options: &str| {
        place.write("arm.urdf", urdf);
        place.run(&["arm.urdf", "world.toml"], options)
    };
    let plain = path_of(&run(arm("velocity=\"1\""), "--json"));
    for limits in ["lower=\"-1e16\" upper=\"1e16\"", "lower=\"-inf\" upper=\"inf\"", "lower=\"-1e9\" upper=\"1e10\""] {
        assert_eq!(path_of(&run(turning(limits), "--json")), plain, "{limits}");
        run(turning(limits), "").found(&["counts as continuous"]);
    }
    for limits in ["lower=\"-1\" upper=\"inf\"", "lower=\"-1\" upper=\"1e16\"", "lower=\"-2000\" upper=\"2000\""] {
        run(turning(limits), "").refused(1, &["joint \"j1\"", "too long for planning", "limits = { j1 = ", "hint"]);
    }
    run(turning("lower=\"nan\" upper=\"1\""), "").refused(1, &["not finite"]);
    // Prismatic joints of any length. Link 2 slides past the end of link 1, which it would touch.
    place.write("world.toml", format!("robot.own_body = false\n{TURN}"));
    let sliding = |limits: &str| {
        let urdf = arm(&format!("{limits} velocity=\"1\"")).replace("\"continuous\"", "\"prismatic\"");
        urdf.replacen("xyz=\"0 0 1\"", "xyz=\"1 0 0\"", 1).replacen("xyz=\"0 0 1\"", "xyz=\"0 1 0\"", 1)
    };
    run(sliding("lower=\"-800\" upper=\"800\""), "--verbose").found(&["-800.0000 m to 800.0000 m"]);
    for limits in ["lower=\"-1e16\" upper=\"1e16\"", "lower=\"-inf\" upper=\"inf\""] {
        run(sliding(limits), "").found(&["cut to -1e6 to 1e6 m"]);
    }
}

#[test]
fn starts_are_taken_by_the_tip_if_one_ik_solution_alone_reaches_it() {
    let place = Place::new().with("arm.urdf", arm("velocity=\"1\""));
    let limited = arm("lower=\"0\" upper=\"3\" velocity=\"1\"").replace("\"continuous\"", "\"revolute\"");
    place.write("limited.urdf", limited);
    let world = "[robot]\nlimits = { j2 = [0, 3] }\n[start]\ntip = [1, 0.5]\n[goal]\njoints = [1, 1]\n";
    // Without other links, the tip is the origin of "fore": the end of link 1.
    let tool = |urdf: &str| {
        let urdf = place.read(urdf);
        let tool = "<link name=\"tool\"/><joint name=\"t\" type=\"fixed\"><origin xyz=\"1 0 0\"/><parent link=\"fore\"/>\
                    <child link=\"tool\"/></joint></robot>";
        place.write("arm.urdf", urdf.replace("</robot>", tool));
    };
    tool("arm.urdf");
    let run = |world: &str, options: &str| {
        place.write("world.toml", world);
        place.run(&["arm.urdf", "world.toml"], options)
    };
    run(world, "").found(&["the only IK solution for the tip at (1, 0.5)"]);
    let both = world.replace("[robot]\nlimits = { j2 = [0, 3] }\n", "");
    run(&both, "").refused(1, &["2 IK solutions put the tip at (1, 0.5)", "give joint values: joints = [", "line "]);
    run(&world.replace("[1, 0.5]", "[5, 0]"), "").refused(1, &["the start (5, 0) m is out of reach", "hint"]);
    run(&both.replace("[1, 0.5]", "[0, 0]"), "").refused(1, &["infinitely many IK solutions", "hint"]);
    run(&world.replace("tip", "joints = [0, 1]\ntip"), "").refused(1, &["either `joints` or `tip`", "hint"]);
}

#[test]
fn values_beyond_a_limit_by_rounding_are_the_limit() {
    let place = Place::new();
    // planar_2r's limits are -2.9 and 2.9.
    let world = FREE.replace("[-0.9, 0.4]", "[-2.9000000004, 0.4]").replace("[1.55, -0.35]", "[1.55, 2.9000000001]");
    place.plan(&world, "").found(&[
        "the start: joint \"shoulder\" at -2.9000000004 rad exceeds its limit by a rounding error; -2.9 rad is used",
        "the goal: joint \"elbow\" at 2.9000000001 rad exceeds its limit by a rounding error; 2.9 rad is used",
    ]);
    place.plan(FREE.replace("-0.9", "-2.90000001"), "").refused(1, &["exceeds its limits", "hint"]);
}

#[test]
fn angles_may_be_in_degrees() {
    let place = Place::new();
    let radians = FREE.replace("-0.9", &(-50f64).to_radians().to_string());
    let plain = path_of(&place.plan(radians, "--json"));
    for start in ["\"-50deg\"", "\" -50 deg \"", "'-5e1deg'"] {
        assert_eq!(path_of(&place.plan(FREE.replace("-0.9", start), "--json")), plain, "{start}");
    }
    let limits = "[robot]\nlimits = { shoulder = [\"-90deg\", \"90deg\"] }\n";
    place
        .plan(format!("{limits}{FREE}"), "--verbose")
        .found(&["shoulder: -90.00 deg (-1.5708 rad) to 90.00 deg (1.5708 rad)"]);
    for text in ["\"-50\"", "\"deg\"", "\"50rad\"", "\"nandeg\"", "true"] {
        place.plan(FREE.replace("-0.9", text), "").exits(1).warns(&["world.toml: line 2"]);
    }
    place.write("world.toml", "[start]\njoints = [0.1, \"20deg\"]\n[goal]\njoints = [0.2, 0.2]\n");
    let rp = place.run(&[shipped("robots/polar.urdf"), "world.toml".into()], "");
    rp.refused(1, &["slides: its value cannot be in degrees", "line 2", "hint"]);
}

#[test]
fn a_document_type_without_entities_is_harmless() {
    let place = Place::new()
        .with("world.toml", TURN)
        .with("arm.urdf", format!("<?xml version=\"1.0\"?>\n<!DOCTYPE robot>\n{}", arm("velocity=\"1\"")));
    place.run(&["arm.urdf", "world.toml"], "--quiet").found(&[]);
    place.write(
        "arm.urdf",
        format!("<!DOCTYPE robot SYSTEM \"urdf.dtd\" [<!ELEMENT robot ANY>]>\n{}", arm("velocity=\"1\"")),
    );
    place.run(&["arm.urdf", "world.toml"], "--quiet").found(&[]);
    let bomb = "<!DOCTYPE robot [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;\">]>\n";
    place.write("arm.urdf", format!("{bomb}{}", arm("velocity=\"1\"")));
    place.run(&["arm.urdf", "world.toml"], "").refused(1, &["arm.urdf", "line 1", "entit", "hint"]);
}
