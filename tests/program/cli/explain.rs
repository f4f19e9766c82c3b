//! `cplan explain`, from outside.

use super::*;
fn explain(place: &Place, robot: &str, world: &str, options: &str) -> Done {
    let [robot, world] =
        [format!("robots/{robot}.urdf"), format!("workspaces/{world}.toml")].map(|file| shipped(&file));
    place.run(&["explain", &robot, &world], options)
}

fn json(done: &Done) -> Value {
    serde_json::from_str(&done.stdout).unwrap_or_else(|error| panic!("{error}: {}{}", done.stdout, done.stderr))
}

#[test]
fn walls_in_the_way_are_named_verdict_first() {
    let done = explain(&Place::new(), "planar_2r_continuous", "no_path", "").exits(3);
    let mut lines = done.stdout.lines();
    assert_eq!(lines.next(), Some("The front wall and the back wall are in the way."));
    let third = lines.nth(1).unwrap_or_default();
    assert!(third.starts_with("result     infeasible: proven; blocked by obstacle"), "{}", done.stdout);
    for words in
        ["\"back wall\"", "Move the front wall 602 mm right: 601.6 mm opens a path, certified;", "mm does not, proven"]
    {
        done.says(&[words]);
    }
}

/// Checks that the two ends of a change are a millimetre apart.
#[test]
fn json_has_sets_and_changes() {
    let result = json(&explain(&Place::new(), "planar_2r_continuous", "no_path", "--json"));
    assert_eq!(
        (&result["status"], &result["blocking"]),
        (&"infeasible".into(), &serde_json::json!(["front wall", "back wall"]))
    );
    let blockers = result["sets"][0]["blockers"].as_array().expect("a list");
    for blocker in blockers.iter().filter(|blocker| blocker["kind"] == "obstacle") {
        assert_eq!(blocker["without"], "found");
        for change in blocker["changes"].as_array().expect("a list") {
            let [closed, opens] = ["closed", "opens"].map(|key| change[key].as_f64().expect("a number"));
            assert!(closed < opens && opens - closed <= 1e-3, "{change}");
        }
    }
    assert!(result["bottleneck"]["too_narrow_by"].as_f64().expect("a number") > 0.0);
}

#[test]
fn problems_that_planning_refuses_are_explained() {
    let place = Place::new();
    let blocked = explain(&place, "planar_2r", "shelf", "--goal 0.14,0 --json").exits(3);
    let result = json(&blocked);
    assert_eq!(result["blocked_ends"][0]["end"], "goal");
    assert!(result["blocked_ends"][0]["nearest_free"]["distance"].as_f64().expect("a number") > 0.0);
    // Links of 1 m and 0.8 m miss a place 5 m off by 3.2 m.
    let far = explain(&place, "planar_2r", "shelf", "--goal-tip 5,0 --json").exits(3);
    let misses = json(&far)["out_of_reach"]["misses"].as_f64().expect("a number");
    assert!((misses - 3.2).abs() < 1e-9, "{misses}");
}

/// Checks an arm that stands in the camera's column, so that no step can begin.
#[test]
fn a_start_of_steps_that_is_not_free_is_explained() {
    let done = explain(&Place::new(), "scara", "tasks/kitting_cell", "--start 0.3,0 --json").exits(3);
    let result = json(&done);
    let ends = result["blocked_ends"].as_array().expect("a list");
    assert_eq!((ends.len(), &ends[0]["end"]), (1, &"start".into()), "{result}");
    assert_eq!(result["blocking"], serde_json::json!(["camera column"]));
    assert!(ends[0]["nearest_free"]["distance"].as_f64().expect("a number") > 0.0);
}

/// Start of the worlds for the shipped SCARA, whose quill is lowered.
const LOWERED: &str = "[robot]\njoints = [\"axis_1\", \"axis_2\"]\ntip = \"flange\"\nstroke = { joint = \"axis_3\" }\n\
                       wrist = { joint = \"axis_4\", velocity = 20.0 }\n";

/// A pick and a place. The lowered flange is 5 mm inside the wall that stands beside the part. `move` shifts the wall.
fn pick_beside_wall(shift: f64, rest: &str) -> String {
    let [lower, upper] = [-0.35 - shift, -0.21 - shift];
    format!(
        "{LOWERED}{rest}[start]\njoints = [0.0, 1.2]\n[[obstacle]]\nname = \"wall\"\n\
         polygon = [[0.1, {lower}], [0.3, {lower}], [0.3, {upper}], [0.1, {upper}]]\nheight = [0.0, 0.08]\n\
         [[object]]\nname = \"part\"\ncircle = {{ center = [0.0, 0.0], radius = 0.009 }}\nat = [0.2, -0.195]\n\
         height = [0.0, 0.02]\nlift = 0.15\n[[step]]\npick = \"part\"\n[[step]]\nplace = {{ at = [0.2, 0.2]"
    )
}

/// Runs `plan` and `explain` in a world of the SCARA. Returns the exit codes and the explanation in JSON and in words.
fn planned_and_explained(world: &str) -> ([i32; 2], Value, String) {
    let (place, robot) = (Place::new(), shipped("robots/scara.urdf"));
    let plan = place.run_in(&robot, world, "");
    let words = place.run(&["explain", &robot, "world.toml"], "");
    let done = place.run(&["explain", &robot, "world.toml"], "--json");
    assert_eq!(words.code, done.code, "{}", words.stderr);
    ([plan.code, done.code], json(&done), words.stdout)
}

/// Checks that an explanation judges a pick with the tool at its heights, and that its instruction helps.
#[test]
fn a_tool_that_hits_while_it_is_lowered_is_explained() {
    let world = |shift: f64| pick_beside_wall(shift, "") + " }\n";
    let (codes, result, words) = planned_and_explained(&world(0.0));
    assert_eq!(codes, [3, 3], "{words}");
    assert_eq!(words.lines().next(), Some("At the goal, while the tool is lowered, the flange hits the wall."));
    assert_eq!(result["blocking"], serde_json::json!(["wall"]));
    let ends = result["blocked_ends"].as_array().expect("a list");
    assert!(ends.len() == 2 && ends.iter().all(|end| end["when"] == "while the tool is lowered"), "{result}");
    let changes = result["sets"][0]["blockers"][0]["changes"].as_array().expect("a list");
    let moved = changes.iter().find(|change| change["change"] == "moved").expect("a move");
    assert!(moved["direction"][1].as_f64().expect("a number") < -0.999, "{moved}");
    let [opens, closed] = ["opens", "closed"].map(|key| moved[key].as_f64().expect("a number"));
    assert_eq!(planned_and_explained(&world(opens)).0, [0, 0]);
    assert_eq!(planned_and_explained(&world(closed)).0, [3, 3]);
}

/// Checks a motion whose lowered tool hits at its goal, and one that is lowered into an obstacle at its start.
#[test]
fn a_motion_of_four_joints_is_explained_with_its_tool() {
    let world = |start: f64, goal: f64| {
        format!(
            "{LOWERED}[start]\njoints = [-0.5, 0.8]\nstroke = {start}\n[goal]\njoints = [0.5, 0.8]\nstroke = {goal}\n\
             [[obstacle]]\nname = \"box\"\nheight = [0.0, 0.1]\npolygon = [[0.0, 0.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]]\n\
             [[obstacle]]\nname = \"pit\"\nheight = [0.0, 0.02]\npolygon = [[0.3, -0.2], [0.6, -0.2], [0.6, 0.0], [0.3, 0.0]]\n"
        )
    };
    assert_eq!(planned_and_explained(&world(-0.05, -0.05)).0, [0, 0]);
    let (codes, result, words) = planned_and_explained(&world(0.0, -0.15));
    assert_eq!((codes, &result["blocking"]), ([3, 3], &serde_json::json!(["box"])), "{words}");
    assert!(words.starts_with("At the goal, while the tool is lowered, the flange hits the box."), "{words}");
    let (codes, result, words) = planned_and_explained(&world(-0.175, 0.0));
    assert_eq!((codes, &result["blocking"]), ([1, 3], &serde_json::json!(["pit"])), "{words}");
    assert_eq!(result["blocked_ends"][0]["when"], "while the tool is lowered", "{result}");
}

/// Checks a task whose answer is unknown, because the wrist might turn the object elsewhere. The obstacle that blocks the
/// step is still named.
#[test]
fn an_unknown_task_stays_unknown_and_names_what_blocks_the_step() {
    let world = pick_beside_wall(0.0, "payload = \"level\"\n") + ", angle = 1.0 }\n";
    let (codes, result, words) = planned_and_explained(&world);
    assert_eq!((codes, &result["status"]), ([4, 4], &"unknown".into()), "{words}");
    assert_eq!(result["blocking"], serde_json::json!(["wall"]));
    assert!(result["reason"].as_str().expect("a reason").contains("while the tool is lowered"), "{result}");
    assert!(words.contains("result     unknown: neither a motion for step 1"), "{words}");
}

/// Checks steps that fail for another reason than an obstacle: the explanation has the planner's reason and exit code.
#[test]
fn steps_without_blocking_obstacles_keep_the_planners_answer() {
    let place = Place::new();
    let line = "[start]\njoints = [0.3, 1.2]\n[[obstacle]]\nname = \"post\"\ncircle = { center = [1.2, 0.3], radius = 0.1 }\n\
                [[step]]\nfollow = { points = [[1.2, -0.2], [1.2, 0.8]], tolerance = 1e-3 }\n";
    place.plan(line, "").exits(3);
    let robot = shipped("robots/planar_2r.urdf");
    let done = place.run(&["explain", &robot, "world.toml"], "--json");
    assert_eq!((done.code, &json(&done)["status"]), (3, &"infeasible".into()), "{}", done.stderr);
    assert!(!json(&done)["reasons"].as_array().expect("a list").is_empty(), "{}", done.stdout);
    let words = place.run(&["explain", &robot, "world.toml"], "").stdout;
    assert!(words.contains("result     infeasible: step 2") && words.contains("cplan follow"), "{words}");
}

#[test]
fn a_motion_is_explained_by_the_obstacles_that_shape_it() {
    let done = explain(&Place::new(), "planar_2r", "shelf", "--json").exits(0);
    let result = json(&done);
    assert!(!result["shaped_by"].as_array().expect("a list").is_empty());
    assert!(result["tightest"]["clearance"].as_f64().expect("a number") > 0.0);
}

#[test]
fn pictures_show_where_it_gets_stuck() {
    let place = Place::new();
    let done = explain(&place, "planar_2r_continuous", "no_path", "--picture why.svg --picture why.html --quiet");
    assert_eq!((done.code, done.stdout.as_str()), (3, ""), "{}", done.stderr);
    assert!(place.read("why.svg").contains("the narrowest place"));
    assert!(place.read("why.html").contains("opens a path, certified"));
}

/// Checks that the first line is the reason in a sentence, and that proven values are rounded to the safe side.
#[test]
fn the_first_line_says_what_is_wrong() {
    let place = Place::new();
    let first = |robot: &str, world: &str, options: &str| {
        explain(&place, robot, world, options).stdout.lines().next().unwrap_or_default().to_owned()
    };
    assert_eq!(first("planar_2r", "no_path", ""), "The front wall is in the way.");
    assert_eq!(
        first("planar_2r", "limits_closed", ""),
        "The pole is in the way, and the elbow cannot turn far enough."
    );
    assert_eq!(first("planar_2r", "shelf", "--goal 0.14,0"), "At the goal, the forearm hits the shelf.");
    assert_eq!(first("planar_2r", "shelf", "--goal-tip 5,0"), "The goal is out of reach.");
    assert_eq!(first("planar_2r", "shelf", ""), "The shelf makes the path longer.");
    let limits = explain(&place, "planar_2r", "limits_closed", "--time 60").stdout;
    let line = "Widen the upper limit of the elbow to 87.2 deg: 87.15 deg opens a path, certified; 87.11 deg does not";
    assert!(limits.contains(line), "{limits}");
}

#[test]
fn bad_input_is_refused() {
    let place = Place::new();
    let [robot, _] = shelf();
    place.run(&["explain", &robot, "missing.toml"], "").exits(1);
    assert_eq!(explain(&place, "planar_2r", "shelf", "--start=a,b").code, 2);
    assert_eq!(explain(&place, "planar_2r", "shelf", "--picture why.txt").code, 2);
}

/// Checks a polar arm whose slide ends long before its goal. Without that limit there is a path. The joint must move as
/// far beyond the limit as the program reports.
#[test]
fn a_tip_beyond_the_slide_is_opened_by_its_limit() {
    let place = Place::new();
    let polar = shipped("robots/polar.urdf");
    place.write("far.toml", "[start]\njoints = [0.1, 0.2]\n[goal]\ntip = [3, 0]\n");
    let done = place.run(&["explain", &polar, "far.toml"], "--json").exits(3);
    let result = json(&done);
    let blockers = result["sets"][0]["blockers"].as_array().expect("a list");
    let limit = blockers.iter().find(|blocker| blocker["joint"] == "ram_slide" && blocker["side"] == "upper");
    let change = &limit.unwrap_or_else(|| panic!("{result}"))["changes"][0];
    let place_of = |upper: f64| {
        let limits = format!("[robot.limits]\nram_slide = [0, {upper}]\n");
        place.write("wider.toml", format!("[start]\njoints = [0.1, 0.2]\n[goal]\ntip = [3, 0]\n{limits}"));
        place.run(&[&polar, "wider.toml"], "--quiet").code
    };
    let upper = place.run(&["inspect", &polar], "--json");
    let upper = json(&upper);
    let slide = upper["joints"].as_array().expect("a list").iter().find(|joint| joint["name"] == "ram_slide");
    let upper = slide.expect("the slide")["limits"]["range"][1].as_f64().expect("a limit");
    assert_eq!(place_of(upper + change["opens"].as_f64().expect("a number") + 1e-9), 0, "{change}");
    assert_ne!(place_of(upper + change["closed"].as_f64().expect("a number")), 0, "{change}");
}

/// Checks that the picture of a feasible task has the task's motions.
#[test]
fn a_feasible_task_has_a_picture() {
    let place = Place::new();
    explain(&place, "planar_2r", "tasks/elbow_choice", "--picture done.svg").exits(0);
    assert!(place.read("done.svg").contains("<svg"));
}

/// An arm of hundreds of metres. The program soon finds its blockers, but needs over a minute to find which of them are
/// necessary.
const LONG_ARM: &str = r#"<robot name="long"><link name="base"/>
<joint name="j1" type="revolute"><parent link="base"/><child link="first"/><origin xyz="-143.9847 267.1032 0" rpy="3.141592653589793 0 0"/>
<axis xyz="0 0 1"/><limit lower="-1.2907" upper="1.5639" effort="1" velocity="1"/></joint>
<link name="first"><collision><origin xyz="273.3623 0 0"/><geometry><box size="304.9523 59.3303 50"/></geometry></collision>
<collision><origin xyz="396.1733 51.1006 0"/><geometry><box size="59.3303 102.2012 50"/></geometry></collision></link>
<joint name="j2" type="revolute"><parent link="first"/><child link="second"/><origin xyz="425.8384 0 0"/>
<axis xyz="0 0 1"/><limit lower="-3.1096" upper="4.8904" effort="1" velocity="1"/></joint>
<link name="second"><collision><origin xyz="447.9735 0 0"/><geometry><box size="895.947 60.3479 50"/></geometry></collision></link></robot>
"#;

const WIDE_WORLD: &str = r#"clearance = 39.6536
[start]
joints = [-0.9125, 4.1826]
[goal]
joints = [-0.9723, 0.5891]
[[obstacle]]
name = "o0"
polygon = [[207.7316, 125.5632], [-76.092, 289.4288], [-76.092, -38.3025]]
[[obstacle]]
name = "o1"
polygon = [[-320.9808, -154.5411], [-409.6456, -210.1317], [-423.927, -212.3088], [-443.2852, -213.0322], [-474.6479, -208.7825], [-541.6537, 42.8578], [-408.1092, 80.6394], [-291.5286, -48.3271]]
[[obstacle]]
name = "o2"
circle = { center = [1029.5896, -213.1444], radius = 95.3178 }
"#;

#[test]
fn at_the_time_limit_partial_results_are_reported() {
    let place = Place::new().with("a.urdf", LONG_ARM).with("world.toml", WIDE_WORLD);
    let result = json(&place.run(&["explain", "a.urdf", "world.toml"], "--time 0.3 --json"));
    assert_eq!((&result["status"], &result["stopped_after"]), (&"infeasible".into(), &0.3.into()), "{result}");
    // With hardly any time.
    let done = place.run(&["explain", "a.urdf", "world.toml"], "--time 0.000001").exits(3);
    for words in [
        "infeasible: proven; blocked by",
        "collision boxes, even if nothing else is in the way; not proven irreducible",
        "stopped    the explanation is incomplete, because its time of 0.000001 s was up; --time 5 allows more time",
    ] {
        done.says(&[words]);
    }
    let result = json(&place.run(&["explain", "a.urdf", "world.toml"], "--time 0.000001 --json"));
    assert_eq!(result["sets"][0]["irreducible"], false, "{result}");
    // If there is time, the output does not mention the time limit.
    let usual = json(&explain(&Place::new(), "planar_2r_continuous", "no_path", "--json"));
    assert!(usual["stopped_after"].is_null() && usual["sets"][0]["irreducible"] == true, "{usual}");
    for time in ["0", "-1", "nan", "inf", "1e10"] {
        assert_eq!(place.run(&["explain", "a.urdf", "world.toml"], &format!("--time {time}")).code, 2, "{time}");
    }
}
