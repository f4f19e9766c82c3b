//! The command `inspect`: its reports on defective robots, on all shipped robots, and on published robots.

use cplan::input::{Inspection, LimitSource, RateSource, Role, inspect, load_scene};
use cplan_testkit::reference::published;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;

const ARM: &str = r#"<robot name="arm">
  <link name="base"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
  <joint name="j1" type="revolute">
    <parent link="base"/> <child link="upper"/>
    <axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="2" acceleration="5"/>
    <safety_controller soft_lower_limit="-2" soft_upper_limit="4" k_velocity="1"/>
  </joint>
  <link name="upper">
    <visual><geometry><sphere radius="0.5"/></geometry></visual>
    <collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision>
  </link>
  <joint name="j2" type="continuous">
    <parent link="upper"/> <child link="fore"/>
    <origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/>
    <limit effort="1" velocity="2"/>
  </joint>
  <link name="fore">
    <collision><origin xyz="0.5 0 0"/><geometry><box size="0.8 0.1 0.3"/></geometry></collision>
  </link>
  <joint name="end" type="fixed"><parent link="fore"/><child link="tool"/><origin xyz="1 0 0"/></joint>
  <link name="tool"/>
  <transmission name="t"/>
</robot>
"#;

/// Returns the report on a URDF, with a world if one is given.
fn report(urdf: &str, world: Option<&str>) -> Inspection {
    let folder = tempfile::tempdir().unwrap();
    let (u, w) = (folder.path().join("arm.urdf"), folder.path().join("world.toml"));
    fs::write(&u, urdf).unwrap();
    fs::write(&w, world.unwrap_or_default()).unwrap();
    inspect(&u, world.map(|_| w.as_path()))
}

fn inspection_with(from: &str, to: &str) -> Inspection {
    assert!(ARM.contains(from), "{from}");
    report(&ARM.replacen(from, to, 1), None)
}

fn messages(report: &Inspection) -> String {
    report.errors.iter().map(|e| e.to_string()).collect::<Vec<_>>().join("\n")
}

#[test]
fn a_sound_robot_is_described_in_full() {
    let found = report(ARM, None);
    assert!(found.is_plannable(), "{}", messages(&found));
    assert_eq!(found.root.as_deref(), Some("base"));
    assert_eq!(found.chosen, Some(["j1".into(), "j2".into()]));
    assert!(!found.assumed && found.help.is_none());
    let [first, second, end] = &found.joints[..] else { panic!("three joints") };
    assert_eq!((first.role, second.role, end.role), (Role::Moves, Role::Moves, Role::Rigid));
    let limits = first.limits.unwrap();
    assert_eq!((limits.source, limits.range), (LimitSource::Soft, Some([-2.0, 3.0])));
    assert_eq!(second.limits.unwrap().source, LimitSource::Continuous);
    assert_eq!(first.acceleration.map(|a| (a.value, a.source)), Some((5.0, RateSource::Urdf)));
    assert_eq!(second.acceleration.map(|a| (a.value, a.source)), Some((8.0, RateSource::Default)));
    let [upper, fore] = &found.outlines[..] else { panic!("two outlines") };
    assert_eq!((upper.source, upper.parts, fore.parts), ("collision", 1, 1));
    assert!((upper.area - 0.1).abs() < 1e-12 && (fore.area - 0.08).abs() < 1e-12);
    assert_eq!(fore.heights, Some([-0.15, 0.15]));
    let reach = found.reach.as_ref().unwrap();
    assert_eq!((reach.tip, reach.distances), ([2.0, 0.0], Some([0.0, 2.0])));
    let ignored = found.ignored.join("\n");
    for part in ["1 <transmission>", "1 visual shape of link \"upper\""] {
        assert!(ignored.contains(part), "no {part} in {ignored}");
    }
    let [base, upper] = &found.self_obstacles[..] else { panic!("the base and link 1") };
    assert_eq!((base.link.as_str(), base.moves, &base.ignored[..]), ("base", false, &["upper".to_owned()][..]));
    assert_eq!((upper.link.as_str(), upper.moves, &upper.ignored[..]), ("upper", true, &[][..]));
    assert_eq!(found.frames.len(), 3);
}

#[test]
fn the_world_decides_and_is_named_as_the_source() {
    let world = "[robot]\nlimits = { j2 = [-1.0, 1.0] }\nvelocity = { j1 = 0.5 }\nacceleration = { j1 = 0.7 }\njerk = { j1 = 9.0 }\n";
    let found = report(ARM, Some(world));
    assert!(found.is_plannable());
    assert_eq!(found.joints[1].limits.map(|l| (l.source, l.range)), Some((LimitSource::World, Some([-1.0, 1.0]))));
    assert_eq!(found.joints[0].velocity.map(|v| (v.value, v.source)), Some((0.5, RateSource::World)));
    assert_eq!(found.joints[0].acceleration.map(|v| (v.value, v.source)), Some((0.7, RateSource::World)));
    assert_eq!(found.joints[0].jerk.map(|v| (v.value, v.source)), Some((9.0, RateSource::World)));
    assert_eq!(found.joints[1].jerk, None);
    assert!(found.warnings.iter().any(|w| w.contains("there is no start")), "{:?}", found.warnings);
}

#[test]
fn single_diagnostics_leave_the_rest_of_the_report() {
    for (from, to, parts) in [
        ("size=\"1 0.1 0.1\"", "size=\"1 nan 0.1\"", ["line 11", "not finite"]),
        ("xyz=\"1 0 0\"", "xyz=\"1 0\"", ["line 15", "2 numbers"]),
        ("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 0\"/>", ["line 5", "is zero"]),
        ("lower=\"-3\"", "lower=\"nan\"", ["line 6", "not finite"]),
        ("type=\"fixed\"", "type=\"glued\"", ["line 22", "\"glued\" is unknown"]),
    ] {
        let found = inspection_with(from, to);
        assert!(!found.is_plannable());
        for part in parts {
            assert!(messages(&found).contains(part), "no {part} in {}", messages(&found));
        }
        assert_eq!(found.links.len(), 4, "{to}");
        // A mistake gives one diagnostic, and its consequences give none.
        assert_eq!(found.errors.iter().map(|e| e.diagnostics().len()).sum::<usize>(), 1, "{}", messages(&found));
        assert_eq!(found.pairs.is_empty(), !to.starts_with("size"), "{to}");
        assert!(found.joints.iter().any(|j| j.name == "j2" && j.kind == "continuous" && j.line == 13), "{to}");
    }
}

#[test]
fn several_stages_report_their_diagnostics_together() {
    let urdf = ARM
        .replace("lower=\"-3\" upper=\"3\"", "")
        .replace("xyz=\"0 0 1\"/>\n    <limit effort", "xyz=\"0 1 0\"/>\n    <limit effort")
        .replace("soft_lower_limit=\"-2\" soft_upper_limit=\"4\" ", "");
    let found = report(&urdf, None);
    let all = messages(&found);
    assert!(all.contains("one common plane") && all.contains("joint \"j1\" has no range"), "{all}");
    assert!(found.pairs.len() == 1 && !found.pairs[0].planar && found.pairs[0].reason.contains("not parallel"));
    assert!(found.help.is_none() && found.scene.is_none());
    assert_eq!(found.root.as_deref(), Some("base"));
}

#[test]
fn links_that_form_no_tree_are_listed_all_the_same() {
    let found = inspection_with("<parent link=\"base\"/>", "<parent link=\"tool\"/>");
    assert!(messages(&found).contains("cycle"));
    assert!(found.root.is_none() && found.joints.len() == 3 && found.links.len() == 4);
    let broken = report("<robot", None);
    assert!(messages(&broken).contains("not well-formed XML") && broken.joints.is_empty());
    let no_world = inspect(Path::new("robots/planar_2r.urdf"), Some(Path::new("no such world.toml")));
    assert!(messages(&no_world).contains("cannot be read") && no_world.outlines.len() == 2);
}

/// Checks that the robot loads if the world has the table that the report suggests.
fn help_works(urdf: &Path, found: &Inspection) {
    let Some(help) = &found.help else { return };
    let folder = tempfile::tempdir().unwrap();
    let world = folder.path().join("world.toml");
    fs::write(&world, format!("[robot]\n{help}\n")).unwrap();
    if let Err(error) = load_scene(urdf, &world) {
        panic!("{}: with the remedy\n{help}\n{error}", urdf.display());
    }
    assert!(inspect(urdf, Some(&world)).is_plannable());
}

#[test]
fn shipped_robots_can_be_planned_with_or_have_help() {
    let mut checked = 0;
    for entry in fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("robots")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "urdf") {
            continue;
        }
        let found = inspect(&path, None);
        assert!(found.is_plannable() != found.help.is_some(), "{}: {}", path.display(), messages(&found));
        help_works(&path, &found);
        checked += 1;
    }
    assert!(checked >= 8);
}

/// Expected result: the file, whether planning works without changes, the pair of joints that the report describes, and
/// parts of diagnostics and pairs.
type Expected = (&'static str, bool, Option<[&'static str; 2]>, &'static [&'static str]);
const PUBLISHED: [Expected; 18] = [
    ("bullet_pantilt", false, Some(["pan_joint", "tilt_joint"]), &["these axes are not parallel"]),
    ("bullet_two_joint_w_fixed", true, None, &[]),
    ("bullet_two_joint_wo_fixed", true, None, &[]),
    ("dobot_mg400", false, Some(["j1", "j4"]), &["4 movable joints", "parallelogram", "link1.STL"]),
    ("drake_acrobot", true, Some(["shoulder", "elbow"]), &[]),
    (
        "drake_double_pendulum",
        false,
        Some(["shaft1", "shaft2"]),
        &["neither collision nor visual geometry", "bar = 0.05"],
    ),
    ("drake_pendulum_1dof", false, None, &["only one movable joint, \"theta\" (continuous)"]),
    ("gepetto_asr_twodof", false, None, &["qb_c_flange_m.dae\" does not exist"]),
    ("gepetto_double_pendulum", false, Some(["joint1", "joint2"]), &["has no range", "link1.stl\" does not exist"]),
    ("gepetto_double_pendulum_continuous", false, Some(["joint1", "joint2"]), &["does not exist"]),
    ("gepetto_double_pendulum_simple", false, Some(["joint1", "joint2"]), &["has no range"]),
    ("icube_scara", true, Some(["joint1", "joint2"]), &["not perpendicular"]),
    ("kawasaki_duaro1", false, None, &["8 movable joints"]),
    ("roma_scara", false, None, &["3 movable joints", "mimics joint \"arm1_joint_Gelenk\""]),
    ("ros2_control_rrbot", true, Some(["joint1", "joint2"]), &[]),
    ("sorydi3_scara", true, Some(["theta1", "theta2"]), &[]),
    ("sorydi3_theta_rho_RP", true, None, &[]),
    ("yao_scara_solidworks", false, None, &["link2.STL\" does not exist", "not perpendicular"]),
];

#[test]
#[ignore = "needs the published data that CPLAN_REFERENCE names"]
fn published_robots_are_diagnosed() {
    let folder = published("urdf");
    for (file, plannable, chosen, parts) in PUBLISHED {
        let path = folder.join(format!("{file}.urdf"));
        let found = inspect(&path, None);
        let reasons: Vec<&str> = found.pairs.iter().map(|p| p.reason.as_str()).collect();
        let all = format!("{}\n{}", messages(&found), reasons.join("\n"));
        assert_eq!(found.is_plannable(), plannable, "{file}: {all}");
        assert!(found.root.is_some() && !found.joints.is_empty() && !found.links.is_empty(), "{file}");
        if let Some(pair) = chosen {
            assert_eq!(found.chosen, Some(pair.map(String::from)), "{file}");
        }
        for part in parts {
            assert!(all.contains(part), "{file}: no \"{part}\" in {all}");
        }
        // If there is a planar pair, a table in the world file solves the problem.
        assert_eq!(!plannable && found.pairs.iter().any(|p| p.planar), found.help.is_some(), "{file}");
        help_works(&path, &found);
        // The report and planning refuse the same files, with the same first reason.
        let empty = tempfile::NamedTempFile::new().unwrap();
        let loaded = load_scene(&path, empty.path()).err().map(|e| e.to_string());
        assert_eq!(found.errors.first().map(|e| e.to_string()), loaded, "{file}");
    }
}

fn command(args: &[&str]) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_cplan")).arg("inspect").args(args).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

/// Returns a SCARA whose quill turns and whose hand tilts. It has three pairs of neighbouring joints, in two planes.
fn turning_quill(folder: &tempfile::TempDir) -> String {
    let urdf = std::fs::read_to_string("robots/scara.urdf").unwrap();
    assert!(urdf.contains("type=\"prismatic\""));
    let path = folder.path().join("quill.urdf");
    let joint = |name: &str, parent: &str, child: &str| {
        format!(
            "<joint name=\"{name}\" type=\"revolute\"><parent link=\"{parent}\"/><child link=\"{child}\"/><axis xyz=\"0 1 0\"/>\
             <limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"1\"/></joint><link name=\"{child}\"/></robot>"
        )
    };
    let nods = urdf.replace("type=\"prismatic\"", "type=\"revolute\"");
    let nods = nods.replace("</robot>", &joint("nod", "flange", "hand"));
    std::fs::write(&path, nods.replace("</robot>", &joint("nod_again", "hand", "finger"))).unwrap();
    path.display().to_string()
}

#[test]
fn the_command_reports_on_stdout_and_fails_with_one_error() {
    let (code, stdout, stderr) = command(&["robots/planar_2r.urdf", "workspaces/shelf.toml"]);
    assert_eq!((code, stderr.as_str()), (0, ""));
    for part in ["tree ", "movable ", "outline ", "reach ", "planning with this robot is possible"] {
        assert!(stdout.contains(part), "no {part} in {stdout}");
    }
    let folder = tempfile::tempdir().unwrap();
    let (code, stdout, stderr) = command(&[&turning_quill(&folder)]);
    assert_eq!(code, 1);
    assert!(stdout.contains("[\"axis_1\", \"axis_2\"] RR: a planar arm"), "{stdout}");
    assert!(stdout.contains("joints = [\"axis_1\", \"axis_2\"]"), "{stdout}");
    assert_eq!(stderr.matches("error: ").count(), 1, "{stderr}");
}

#[test]
fn the_json_has_the_documented_fields() {
    let folder = tempfile::tempdir().unwrap();
    let (code, stdout, _) = command(&[&turning_quill(&folder), "--json"]);
    let json: Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!((code, &json["plannable"]), (1, &Value::Bool(false)));
    assert_eq!(json["robot"], "scara");
    assert_eq!(json["chosen"], serde_json::json!(["axis_1", "axis_2"]));
    assert_eq!(json["assumed"], true);
    assert_eq!(json["joints"][2]["type"], "revolute");
    assert_eq!(json["joints"][2]["role"], "held");
    assert_eq!(json["joints"][0]["limits"]["source"], "urdf");
    assert_eq!(json["joints"][0]["limits"]["range"].as_array().map(Vec::len), Some(2));
    assert_eq!(json["joints"][0]["acceleration"]["source"], "default");
    assert!(json["pairs"].as_array().is_some_and(|p| p.len() == 15));
    assert_eq!(json["plane"]["normal"], serde_json::json!([0.0, 0.0, 1.0]));
    assert!(json["outlines"][0]["area"].as_f64().is_some_and(|a| a > 0.0));
    assert!(json["defects"][0]["message"].as_str().is_some_and(|m| m.contains("6 movable joints")));
    assert!(json["defects"][0]["cure"].is_string());
    for key in ["urdf", "world", "root", "links", "tip", "reach", "ignored", "warnings", "remedy"] {
        assert!(json.get(key).is_some(), "{key} is missing");
    }
}

#[test]
fn the_picture_shows_the_frames() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("arm.svg");
    let (code, ..) = command(&["robots/rrbot_vertical.urdf", "--picture", file.to_str().unwrap()]);
    let text = fs::read_to_string(&file).unwrap();
    let tree = roxmltree::Document::parse(&text).unwrap();
    let words: Vec<&str> =
        tree.descendants().filter(|n| n.has_tag_name("text")).filter_map(|n| n.text()).map(str::trim).collect();
    let found = inspect(Path::new("robots/rrbot_vertical.urdf"), None);
    assert_eq!(code, i32::from(!found.is_plannable()));
    for name in found.frames.iter().map(|f| f.name.as_str()) {
        assert!(words.contains(&name), "no {name} in {words:?}");
    }
    assert_eq!(words.iter().filter(|w| **w == "y").count(), 3, "{words:?}");
    let (code, _, stderr) = command(&["Cargo.toml", "--picture", folder.path().join("none.svg").to_str().unwrap()]);
    assert_eq!(code, 1);
    assert!(stderr.contains("no planar arm to draw"), "{stderr}");
}

/// Checks a case that fuzzing found: a joint is held because there is no pair, and its limits are in the wrong order,
/// or one of them is missing.
#[test]
fn reversed_limits_of_a_held_joint_are_reported_and_no_more() {
    let wrist = |limit: &str| {
        let joint = format!(
            "<joint name=\"j3\" type=\"revolute\"><parent link=\"tool\"/><child link=\"hand\"/><axis xyz=\"0 0 1\"/>\
             <limit {limit} effort=\"1\" velocity=\"2\"/></joint><link name=\"hand\"/><transmission name=\"t\"/>"
        );
        let found = inspection_with("<transmission name=\"t\"/>", &joint);
        let text = messages(&found);
        assert_eq!(text.matches("reversed").count(), 1, "{text}");
        text
    };
    assert!(wrist("lower=\"2.5\" upper=\"-2.5\"").contains("lower 2.5 is above upper -2.5"));
    let text = wrist("lower=\"2.5\"");
    assert!(text.contains("lower 2.5 is above upper 0 (no upper is given)") && text.contains("give upper"), "{text}");
    assert!(wrist("upper=\"-1\"").contains("lower 0 is above upper -1 (no lower is given)"));
    let soft = "soft_lower_limit=\"4\" soft_upper_limit=\"-2\"";
    let text = messages(&inspection_with("soft_lower_limit=\"-2\" soft_upper_limit=\"4\"", soft));
    assert_eq!(text.matches("soft limits").count(), 1, "{text}");
}
