//! Certificates written by hand, and falsified ones.

use crate::common::robots::{bars, two_bars};
use crate::common::verdict::{code, fails, holds, judge, refused};
use cplan_check_files::{CheckError, Input, check};

/// Returns a robot of two bars. The first one has a cylinder at its end, above the second one.
fn robot(first: &str, second: &str) -> String {
    let cylinder = r#"<collision> <origin xyz="1 0 0.2"/> <geometry> <cylinder radius="0.06" length="0.1"/> </geometry> </collision>"#;
    bars(first, second).replacen("</collision>", &format!("</collision> {cylinder}"), 1)
}

const ENDS: &str = "start.joints = [-1, 0]\ngoal.joints = [1, 0]\n";

fn world(obstacles: &str) -> String {
    format!("{ENDS}{obstacles}")
}

/// Boxes: lower and upper ends, shape and part.
type Boxes<'a> = &'a [(&'a str, &'a str, usize, usize)];

fn certificate(extra: &str, shapes: &str, parts: &str, boxes: Boxes) -> String {
    let boxes: Vec<String> = boxes
        .iter()
        .map(|(lower, upper, shape, part)| {
            format!(r#"{{"lower": [{lower}], "upper": [{upper}], "shape": {shape}, "part": {part}}}"#)
        })
        .collect();
    let boxes = boxes.join(",");
    format!(
        r#"{{"format": "cplan certificate 1", "answer": "infeasible", {extra} "shapes": [{shapes}], "parts": [{parts}], "boxes": [{boxes}]}}"#
    )
}

const UPPER: &str = r#"{"link": "upper", "collision": 0}"#;
const FORE: &str = r#"{"link": "fore", "collision": 0}"#;
const WALL: &str = "[[obstacle]]\npolyline = [[0.5, 0], [2.5, 0]]\n";
const WALL_PART: &str = r#"{"obstacle": 0, "corners": [[0.5, 0], [2.5, 0]]}"#;

/// Tests a bar that overlaps a wall along the x axis, by 0.05 / cos q in the wall's direction. A box of half-width `w`
/// around 0 holds as long as the farthest corner, at sqrt(1 + 0.05^2), moves by less than that.
#[test]
fn a_box_holds_up_to_the_closed_form() {
    let arm = robot("revolute", "revolute");
    let at = |w: &str| {
        let (lower, upper) = (format!("-{w}, -3"), format!("{w}, 3"));
        code(&arm, &world(WALL), &certificate("", UPPER, WALL_PART, &[(&lower, &upper, 0, 0)]))
    };
    // 2 sin(w / 2) sqrt(1.0025) = 0.05 at w = 0.04994287...
    assert_eq!((at("0.04994"), at("0.04995")), (0, 3));
    assert_eq!(at("0.0499428"), 0);
    assert_eq!(at("0.0499430"), 3);
}

#[test]
fn all_kinds_of_joints_and_shapes() {
    let post = "[[obstacle]]\ncircle = { center = [0.6, 0], radius = 0.2 }\n";
    let disc = r#"{"obstacle": 0}"#;
    let whole = [("-0.1, -3", "0.1, 3", 0, 0)];
    for second in ["revolute", "prismatic"] {
        let arm = robot("revolute", second);
        assert_eq!(code(&arm, &world(post), &certificate("", UPPER, disc, &whole)), 0);
        let arm = robot("prismatic", second);
        // Slid by 0, the bar reaches from 0 to 1.
        assert_eq!(code(&arm, &world(post), &certificate("", UPPER, disc, &whole)), 0);
        let beyond = [("0.7, -3", "0.9, 3", 0, 0)];
        assert_eq!(code(&arm, &world(post), &certificate("", UPPER, disc, &beyond)), 3);
    }
    // The second bar, with each type of joint. A large disc touches it everywhere.
    let large = "[[obstacle]]\ncircle = { center = [1, 0], radius = 40 }\n";
    for (first, second) in
        [("revolute", "revolute"), ("revolute", "prismatic"), ("prismatic", "revolute"), ("prismatic", "prismatic")]
    {
        let boxes = [("-0.1, -3", "0.1, 3", 0, 0)];
        assert_eq!(code(&robot(first, second), &world(large), &certificate("", FORE, disc, &boxes)), 0);
    }
    let polygon = "[[obstacle]]\npolygon = [[0.3, -0.2], [0.9, -0.2], [0.9, 0.2], [0.3, 0.2]]\n";
    let corners = r#"{"obstacle": 0, "corners": [[0.3, -0.2], [0.9, -0.2], [0.9, 0.2], [0.3, 0.2]]}"#;
    let arm = robot("revolute", "revolute");
    assert_eq!(code(&arm, &world(polygon), &certificate("", UPPER, corners, &whole)), 0);
    // A cylinder across the plane, at 45 degrees: 0.2 wide to each side, and 0.2 sqrt 2 along.
    let oblique = arm
        .replace("<box size=\"1.0 0.1 0.1\"/>", "<cylinder radius=\"0.2\" length=\"0.4\"/>")
        .replace("<origin xyz=\"0.5 0 0\"/>", "<origin xyz=\"0.5 0 0\" rpy=\"0 0.78539816339744830962 0\"/>");
    let beside = |center: &str, radius: &str| {
        let post = format!("[[obstacle]]\ncircle = {{ center = [{center}], radius = {radius} }}\n");
        code(&oblique, &world(&post), &certificate("", UPPER, disc, &[("-0.0001, -3", "0.0001, 3", 0, 0)]))
    };
    assert_eq!((beside("0.5, 0.3", "0.101"), beside("0.5, 0.3", "0.0999")), (0, 3));
    assert_eq!((beside("1, 0", "0.218"), beside("1, 0", "0.217")), (0, 3));
    // Corners in any order; but not a side alone.
    let other = r#"{"obstacle": 0, "corners": [[0.3, 0.2], [0.9, -0.2], [0.9, 0.2], [0.3, -0.2]]}"#;
    assert_eq!(code(&arm, &world(polygon), &certificate("", UPPER, other, &whole)), 0);
    for wrong in [r#"{"obstacle": 0, "corners": [[0.3, 0.2], [0.9, 0.2]]}"#, r#"{"obstacle": 0}"#, r#"{"obstacle": 1}"#]
    {
        assert_eq!(code(&arm, &world(polygon), &certificate("", UPPER, wrong, &whole)), 3, "{wrong}");
    }
    // The same polygon, turned and moved to the same place.
    let placed = "[[obstacle]]\nat = [0.6, 0]\nangle = \"90deg\"\npolygon = [[-0.2, -0.3], [0.2, -0.3], [0.2, 0.3], [-0.2, 0.3]]\n";
    assert_eq!(code(&arm, &world(placed), &certificate("", UPPER, corners, &whole)), 0);
}

#[test]
fn clearance_counts_and_other_queries_are_described() {
    let arm = robot("revolute", "revolute");
    let apart = "[[obstacle]]\ncircle = { center = [1.2, 0], radius = 0.1 }\n";
    let disc = r#"{"obstacle": 0}"#;
    let boxes = [("-0.01, -3", "0.01, 3", 0, 0)];
    let asked = |extra: &str| judge(&arm, &world(apart), &certificate(extra, UPPER, disc, &boxes));
    fails(asked(""), "box 0");
    assert!(holds(asked(r#""clearance": 0.15,"#)).contains("clearance 0.15"));
    assert_eq!(code(&arm, &format!("clearance = 0.15\n{}", world(apart)), &certificate("", UPPER, disc, &boxes)), 0);
    let report = holds(asked(r#""clearance": 0.15, "start": [-2, 1], "goal": [2, 1],"#));
    assert!(report.contains("start (-2, 1)") && report.contains("goal (2, 1)"), "{report}");
    fails(asked(r#""clearance": 0.15, "goal": [-2, 1],"#), "");
    refused(asked(r#""goal": [3, 1],"#), "");
}

#[test]
fn heights_that_do_not_meet_are_no_contact() {
    let arm = robot("revolute", "revolute");
    let at = |heights: &str, collision: usize| {
        let obstacle = format!("[[obstacle]]\nheight = {heights}\ncircle = {{ center = [1.0, 0], radius = 0.2 }}\n");
        let shape = format!(r#"{{"link": "upper", "collision": {collision}}}"#);
        code(&arm, &world(&obstacle), &certificate("", &shape, r#"{"obstacle": 0}"#, &[("-0.01, -3", "0.01, 3", 0, 0)]))
    };
    // The box lies at -0.05 to 0.05, the cylinder at 0.15 to 0.25.
    assert_eq!((at("[0.1, 0.2]", 0), at("[0.1, 0.2]", 1)), (3, 0));
    assert_eq!((at("[-0.2, 0.0]", 0), at("[-0.2, 0.0]", 1)), (0, 3));
    assert_eq!((at("[0.3, 0.4]", 1), at("[0.0, 0.2]", 1)), (3, 0));
    assert_eq!(at("[0.0, 0.2]", 2), 3);
}

/// Tests a tip position that both elbow solutions reach. Neither must be free behind the wall.
#[test]
fn a_place_of_the_tip_is_all_configurations_that_reach_it() {
    let arm = robot("revolute", "revolute");
    let tip = |tip: &str, boxes: Boxes| {
        let extra = format!(r#""goal_tip": {tip},"#);
        let named = code(&arm, &world(WALL), &certificate(&extra, UPPER, WALL_PART, boxes));
        let place = format!("start.joints = [-1, 0]\ngoal.tip = {tip}\n{WALL}");
        assert_eq!(code(&arm, &place, &certificate("", UPPER, WALL_PART, boxes)), named);
        named
    };
    let wall = [("-0.04, -3", "0.04, 3", 0, 0)];
    // Elbows left and right: (1, 1), and about (1.88, -1).
    assert_eq!(tip("[0.2073848661404736, 1.5689089262373]", &wall), 0);
    assert_eq!(tip("[0.2073848661404736, 1.5689089262373]", &[("-0.04, -3", "0.04, 2", 0, 0)]), 3);
    // One elbow solution on either side of the wall, and both on the start's side.
    assert_eq!((tip("[1.4, 0.1]", &wall), tip("[0.2, -1.5]", &wall)), (3, 3));
    // Out of reach, and stretched out beyond the wall and in front of it.
    assert_eq!((tip("[0, 1.9]", &wall), tip("[0, 1.8]", &wall), tip("[0, -1.8]", &wall)), (0, 0, 3));
    // The statement is about the tip that the world names.
    let place = format!("start.joints = [-1, 0]\nrobot.tip = \"fore\"\n{WALL}");
    let extra = r#""goal_tip": [0.6, 0.8],"#;
    let report = holds(judge(&arm, &place, &certificate(extra, UPPER, WALL_PART, &wall)));
    assert!(report.contains("to the goal (0.6, 0.8), a position of the tip \"fore\","), "{report}");
    let place = place.replace("fore", "upper");
    assert_eq!(code(&arm, &place, &certificate(extra, UPPER, WALL_PART, &wall)), 1);
    let both = r#""goal": [1, 0], "goal_tip": [0.6, 0.8],"#;
    assert_eq!(code(&arm, &world(WALL), &certificate(both, UPPER, WALL_PART, &wall)), 1);
}

/// Tests a goal that leaves a joint free, which is a curve. All of it must be beyond the boxes.
#[test]
fn a_place_of_the_tip_that_leaves_a_joint_free() {
    // The tip on the second axis, at q1 = 1, with any q2.
    let arm = robot("revolute", "revolute");
    let elbow = |tip: &str, boxes: Boxes| {
        let place = format!("start.joints = [-1, 0]\nrobot.tip = \"fore\"\ngoal.tip = {tip}\n{WALL}");
        code(&arm, &place, &certificate("", UPPER, WALL_PART, boxes))
    };
    let wall = [("-0.04, -3", "0.04, 3", 0, 0)];
    assert_eq!(elbow("[0.6, 0.8]", &wall), 0);
    assert_eq!(elbow("[0.6, -0.8]", &wall), 3);
    assert_eq!(elbow("[0.6, 0.8]", &[("-0.04, -3", "0.04, 2.8", 0, 0)]), 3);
    // Bars of equal length, and the tip at the first axis: q2 is half a turn, with limits that exclude or allow it.
    let alike = arm.replace("1 0 0\"/> <axis", "0.8 0 0\"/> <axis");
    let folded = |limit: &str, boxes: Boxes| {
        let place = format!("start.joints = [-1, 0]\ngoal.tip = [0, 0]\nrobot.limits.b = [-3, {limit}]\n{WALL}");
        code(&alike, &place, &certificate("", UPPER, WALL_PART, boxes))
    };
    assert_eq!((folded("3.1", &wall), folded("3.2", &wall)), (0, 3));
    // A carriage along x with a rotating bar: all carriage positions within reach of the tip position count.
    let cart = robot("prismatic", "revolute");
    let disc = "[[obstacle]]\ncircle = { center = [1, 0], radius = 0.3 }\n";
    let shut = [("-0.2, -3", "0.2, 3", 0, 0)];
    let tip = |tip: &str| {
        let place = format!("start.joints = [-1, 0]\ngoal.tip = {tip}\n{disc}");
        code(&cart, &place, &certificate("", UPPER, r#"{"obstacle": 0}"#, &shut))
    };
    assert_eq!((tip("[2.5, 0.3]"), tip("[1.5, 0.3]"), tip("[0, 0.3]")), (0, 3, 3));
}

/// Compares an arm that the world places elsewhere with the same arm in a world that is moved and turned oppositely.
#[test]
fn a_robot_stands_where_the_world_puts_it() {
    let disc = r#"{"obstacle": 0}"#;
    for (first, second) in
        [("revolute", "revolute"), ("revolute", "prismatic"), ("prismatic", "revolute"), ("prismatic", "prismatic")]
    {
        let arm = robot(first, second);
        // In the robot's frame it is at (0.9, 0.02), in the world at (2 - 0.02, 3 + 0.9).
        let at = |center: &str| {
            let place = "[robot]\nat = [2, 3]\nangle = \"90deg\"\n";
            let place = format!("{place}[[obstacle]]\ncircle = {{ center = {center}, radius = 0.2 }}\n");
            let boxes = [("-0.05, -3", "0.05, 3", 0, 0)];
            code(&arm, &format!("{ENDS}{place}"), &certificate("", UPPER, disc, &boxes))
        };
        assert_eq!((at("[1.98, 3.9]"), at("[2.02, 2.1]"), at("[2.9, 3.02]")), (0, 3, 3), "{first} {second}");
    }
    // About y the plane is (x, z), and the robot turns from x to z.
    let arm = robot("revolute", "revolute").replace("axis xyz=\"0 0 1\"", "axis xyz=\"0 -1 0\"");
    let place = "[robot]\nangle = \"90deg\"\n[[obstacle]]\ncircle = { center = [-0.02, 0.9], radius = 0.2 }\n";
    let boxes = [("-0.05, -3", "0.05, 3", 0, 0)];
    assert_eq!(code(&arm, &format!("{ENDS}{place}"), &certificate("", UPPER, disc, &boxes)), 0);
}

/// Tests that visual shapes replace collision shapes for a link without any.
#[test]
fn visual_shapes_replace_missing_collision_shapes() {
    let arm = robot("revolute", "revolute");
    let seen = arm.replace("collision", "visual");
    let visual = UPPER.replace("collision", "visual");
    let wall = [("-0.04, -3", "0.04, 3", 0, 0)];
    let at = |arm: &str, shape: &str| code(arm, &world(WALL), &certificate("", shape, WALL_PART, &wall));
    assert_eq!((at(&arm, UPPER), at(&seen, &visual)), (0, 0));
    assert_eq!((at(&arm, &visual), at(&seen, UPPER)), (3, 3));
    // Each link by itself: shapes of other links do not matter.
    let fore = "<collision> <geometry> <sphere radius=\"0.01\"/> </geometry> </collision>";
    assert_eq!(at(&seen.replace("<link name=\"tool\"/>", &format!("<link name=\"tool\">{fore}</link>")), &visual), 0);
    let fixed =
        r#"<joint name="u" type="fixed"> <parent link="upper"/> <child link="rod"/> </joint> <link name="rod">"#;
    let both = seen.replace("</robot>", &format!("{fixed}{fore}</link></robot>"));
    assert_eq!(at(&both, &visual), 0);
    let own = seen.replace("<link name=\"upper\">", &format!("<link name=\"upper\">{fore}"));
    assert_eq!(at(&own, &visual), 3);
    // Bars replace links without either.
    let bare = arm.replace("collision", "lamp");
    let bars = |arm: &str, robot: &str, shape: &str, obstacle: &str, part: &str| {
        let place = format!("[robot]\n{robot}\n{obstacle}\n[start]\njoints = [-1, 0]\n[goal]\njoints = [1, 0]");
        code(arm, &place, &certificate("", shape, part, &wall))
    };
    let (upper, fore) = (r#"{"link": "upper", "bar": 0}"#, r#"{"link": "fore", "bar": 0}"#);
    let on_wall = |arm: &str, robot: &str, shape: &str| bars(arm, robot, shape, WALL, WALL_PART);
    assert_eq!((on_wall(&bare, "bar = 0.05", upper), on_wall(&bare, "bar = 0.02", upper)), (0, 3));
    assert_eq!(
        (on_wall(&bare, "", upper), on_wall(&arm, "bar = 0.05", upper), on_wall(&seen, "bar = 0.05", upper)),
        (1, 3, 3)
    );
    assert_eq!((on_wall(&bare, "bar = 0.05", &upper.replace('0', "1")), on_wall(&bare, "bar = -1", upper)), (1, 1));
    // From the second joint to the tip, for any elbow, and all at the height of the joints.
    let disc = "[[obstacle]]\ncircle = { center = [1, 0], radius = 1.2 }\n";
    let on_disc = |robot: &str, obstacle: &str| bars(&bare, robot, fore, obstacle, r#"{"obstacle": 0}"#);
    assert_eq!((on_disc("bar = 0.1", disc), on_disc("bar = 0.1", &disc.replace("[1, 0]", "[5, 0]"))), (3, 3));
    let large = disc.replace("1.2", "4");
    assert_eq!(on_disc("bar = 0.1\ntip = \"fore\"", disc), 0);
    let low = format!("{large}height = [-1, -0.2]");
    assert_eq!((on_disc("bar = 0.1", &large), on_disc("bar = 0.1", &low), on_disc("bar = 0.3", &low)), (0, 3, 0));
    for wrong in [r#"{"link": "upper"}"#, r#"{"link": "upper", "visual": 0, "collision": 0}"#] {
        assert_eq!(at(&seen, wrong), 1, "{wrong}");
    }
}

/// Tests that unknown or wrong content of each file is bad input. The message names the file and the place.
#[test]
fn unknown_input_is_refused_with_its_place() {
    let arm = robot("revolute", "revolute");
    let (place, good) = (world(WALL), certificate("", UPPER, WALL_PART, &[("-0.01, -3", "0.01, 3", 0, 0)]));
    assert_eq!(code(&arm, &place, &good), 0);
    let bad = |urdf: &str, world: &str, certificate: &str, file: Input, at: Option<usize>, part: &str| match check(
        urdf,
        world,
        certificate,
    )
    .unwrap_err()
    {
        CheckError::Input { input, line, message } => {
            assert!((input, line) == (file, at) && message.contains(part), "{input:?} {line:?} {message}");
        }
        CheckError::Fails(why) => panic!("{part}: {why}"),
    };
    let urdf = |from: &str, to: &str, at, part| {
        assert!(arm.contains(from), "{from}");
        bad(&arm.replace(from, to), &place, &good, Input::Urdf, at, part);
    };
    urdf("</robot>", "", Some(1), "root");
    urdf("robot", "model", Some(1), "no <robot>");
    urdf("1.0 0.1 0.1", "1.0 0.1", Some(7), "3 numbers");
    urdf("1.0 0.1 0.1", "1.0 0.1 x", Some(7), "not a decimal");
    urdf("1.0 0.1 0.1", "1.0 0.1 -1", Some(7), "negative");
    urdf("box size=\"1.0 0.1 0.1\"", "mesh filename=\"m\"", Some(7), "mesh");
    urdf("lower=\"-2.9\"", "lower=\"2.9\"", Some(3), "limits");
    urdf("name=\"b\"", "name=\"a\"", Some(9), "another joint");
    urdf("xyz=\"1 0 0\"/> <axis xyz=\"0 0 1\"", "xyz=\"1 0 0\"/> <axis xyz=\"0 1 1\"", Some(9), "plane");
    urdf("xyz=\"0 0 1\"", "xyz=\"0 0 0\"", Some(4), "the axis is zero");
    urdf("parent link=\"base\"", "parent link=\"fore\"", Some(9), "ring");
    urdf("parent link=\"upper\"", "parent link=\"base\"", Some(9), "carries");
    urdf("type=\"revolute\"", "type=\"fixed\"", None, "0 movable joints");
    let worlds = |text: &str, at, part| bad(&arm, text, &good, Input::World, at, part);
    worlds("start = 3", Some(1), "table");
    worlds("start.joints = [1]", Some(1), "list of two");
    worlds("start.tip = [1, 2]\ngoal.joints = [1, 0]", None, "the start is a position of the tip");
    worlds("start = { joints = [1, 2], near = 3 }", Some(1), "joints");
    worlds("goal.tip = [1, 2]\ngoal.joints = [1, 2]", Some(1), "joints");
    worlds("\nstart.joints = [1, inf]", Some(2), "decimal");
    worlds("start.joints = [1, true]", Some(1), "decimal");
    worlds("goal.joints = [1, 2]", None, "no start");
    worlds(&format!("{ENDS}[[step]]"), Some(3), "step");
    worlds(&format!("{ENDS}[[obstacle]]"), Some(3), "one shape");
    worlds(&format!("{ENDS}[[obstacle]]\nsize = 3"), Some(4), "size");
    worlds("name = \"\n", Some(1), "");
    worlds("[robot]\nstands = [1, 2]", Some(2), "[robot] stands");
    worlds(&format!("{ENDS}[[obstacle]]\ncircle = {{ center = [0, 0], radius = 1, height = 2 }}"), Some(4), "circle");
    worlds(
        &format!("{ENDS}[[obstacle]]\nheight = [1, 0]\ncircle = {{ center = [0, 0], radius = 1 }}"),
        Some(4),
        "upper end",
    );
    worlds(&format!("clearance = -1\n{place}"), None, "negative");
    let certificates = |from: &str, to: &str, part: &str| {
        assert!(good.contains(from), "{from}");
        bad(&arm, &place, &good.replace(from, to), Input::Certificate, Some(1), part);
    };
    certificates("infeasible", "unknown", "unknown");
    certificates("\"boxes\"", "\"box\"", "box");
    certificates("-0.01", "\"-0.01\"", "decimal");
    certificates("-0.01", "1e9999", "digits");
    for (from, to, part) in
        [("certificate 1", "certificate 2", "certificate 2"), ("infeasible", "found", "needs a motion")]
    {
        bad(&arm, &place, &good.replace(from, to), Input::Certificate, None, part);
    }
}

/// Tests proofs of earlier versions of cplan that a task is infeasible. They were written case by case, in a file of
/// their own or within a result.
#[test]
fn proofs_about_tasks_are_not_judged() {
    let old = r#"{"format": "cplan certificate 1", "answer": "infeasible", "joints": ["a", "b"],
        "shapes": [{"carried": [[-0.1, -0.1], [0.1, -0.1], [0, 0.1]]}], "parts": [{"obstacle": 0}],
        "cases": [{"step": 2, "from": [[0, 1], [0, 1]],
                   "boxes": [{"lower": [-0.1, -3], "upper": [0.1, 3], "shape": 0, "part": 0}]}]}"#;
    let within = format!(r#"{{"outcome": "infeasible", "certificate": {old}}}"#);
    for certificate in [old, &within] {
        refused(judge(&two_bars(), &world(WALL), certificate), "does not judge proofs that a task is infeasible");
    }
}

/// Tests a wall of boxes, each as wide as possible. Any change to one of them opens a gap or makes a box too large, so
/// falsified certificates must be refused.
#[test]
fn falsified_certificates_are_refused() {
    let arm = robot("revolute", "revolute");
    let place = world(WALL);
    let edges: Vec<f64> = (0..=8).map(|k| -3.0 + f64::from(k) * 0.75).collect();
    // Up to 0.04994 each, in steps, so that neighbours share one value only.
    let boxes = |edges: &[f64]| -> Vec<[f64; 4]> {
        let from = |k: usize| if k.is_multiple_of(2) { -0.0499 } else { 0.0 };
        edges.windows(2).enumerate().map(|(k, e)| [from(k), from(k) + 0.0499, e[0], e[1]]).collect()
    };
    let judged = |boxes: &[[f64; 4]]| {
        let texts: Vec<_> = boxes.iter().map(|[l, r, b, t]| (format!("{l}, {b}"), format!("{r}, {t}"))).collect();
        let named: Vec<_> = texts.iter().map(|(lower, upper)| (&lower[..], &upper[..], 0, 0)).collect();
        code(&arm, &place, &certificate("", UPPER, WALL_PART, &named))
    };
    // Half a box to each side of the wall: the corner at 0.05 lies on one side, so it is less deep on the other.
    let whole = boxes(&edges);
    assert_eq!(judged(&whole), 0);
    for gone in 0..whole.len() {
        let mut fewer = whole.clone();
        fewer.remove(gone);
        assert_eq!(judged(&fewer), 3, "without {gone}");
    }
    for (number, end) in (0..whole.len()).flat_map(|n| [2, 3].map(|e| (n, e))) {
        let mut shrunk = whole.clone();
        let whole_end = shrunk[number][end];
        shrunk[number][end] = if end == 2 { whole_end.next_up() } else { whole_end.next_down() };
        // Beyond the limits, at 2.9, there is nothing to close.
        let is_outermost = (number, end) == (0, 2) || (number, end) == (7, 3);
        assert_eq!(judged(&shrunk), if is_outermost { 0 } else { 3 }, "box {number}, end {end}");
    }
    // Twice as wide, the sides no longer touch the wall.
    for number in 0..whole.len() {
        let mut grown = whole.clone();
        grown[number][0] -= 0.06;
        grown[number][1] += 0.06;
        assert_eq!(judged(&grown), 3, "box {number}");
    }
}

/// Tests that extremely large numbers and deep nests are refused.
#[test]
fn hostile_input_is_refused() {
    let arm = robot("revolute", "revolute");
    let wall = [("-0.04, -3", "0.04, 3", 0, 0)];
    let good = certificate("", UPPER, WALL_PART, &wall);
    let digits = format!("0.04{}", "1".repeat(2000));
    for (number, answer) in [
        ("1e1000", 3),
        ("1e999999999", 1),
        ("1e-999999999", 1),
        ("1e99999999999999999999", 1),
        (&digits, 1),
        ("NaN", 1),
        ("-1e1000", 3),
        ("null", 1),
        ("\"0.04\"", 1),
        ("0.04e0", 0),
        ("4E-2", 0),
    ] {
        let huge = good.replace("[0.04,", &format!("[{number},"));
        assert!(huge != good && code(&arm, &world(WALL), &huge) == answer, "{number}");
        let world = world(WALL).replace("2.5", number);
        assert!([1, 3, answer].contains(&code(&arm, &world, &good)), "{number}");
        for place in ["1.0 0.1 0.1", "1 0 0\"/> <axis xyz=\"0 0 1\"", "lower=\"-2.9\""] {
            assert!(arm.contains(place));
            code(&arm.replace(place, &place.replacen(['0', '1', '2'], number, 1)), &world, &good);
        }
        let angle = format!("xyz=\"0.5 0 0\" rpy=\"0 0 {number}\"");
        assert_ne!(code(&arm.replace("xyz=\"0.5 0 0\"", &angle), &world, &good), 0, "{number}");
    }
    let nested = |open: &str, close: &str| [open.repeat(100_000), close.repeat(100_000)].concat();
    for nest in [nested("[", "]"), nested("{\"a\":", "}"), nested("[", "")] {
        assert_eq!(code(&arm, &world(WALL), &nest), 1);
        assert_eq!(code(&arm, &world(WALL), &good.replace("[0.04, 3]", &format!("[{nest}, 3]"))), 1);
        assert_eq!(code(&arm, &format!("name = {nest}"), &good), 1);
    }
    let twice = good.replace("\"answer\"", "\"answer\": \"infeasible\", \"answer\"");
    assert_eq!(code(&arm, &world(WALL), &twice), 1);
    assert_eq!(code(&arm, &format!("clearance = 0\nclearance = 0\n{}", world(WALL)), &good), 1);
    assert_eq!(code(&arm.replace("0 0 1", "1e-300 1e-300 0"), &world(WALL), &good), 1);
    // A long chain of links, and one that is too long.
    for (links, answer) in [(900, 0), (1100, 1)] {
        let link = |k: usize| {
            format!(
                r#"<link name="l{k}"/><joint name="f{k}" type="fixed"><parent link="l{}"/><child link="l{k}"/></joint>"#,
                k + 1
            )
        };
        let chain: String = (0..links).map(link).collect();
        let ends = format!(r#"<link name="l{links}"/>"#);
        let long = arm.replace("<link name=\"base\"/>", &format!("{chain}{ends}")).replace("\"base\"", "\"l0\"");
        assert_eq!(code(&long, &world(WALL), &good), answer, "{links}");
    }
    // Strips times gaps.
    let many: Vec<(String, String)> = (0..3000)
        .flat_map(|k| {
            let (at, to) = (0.0001 * f64::from(k), 0.0001 * (f64::from(k) + 0.5));
            [(format!("-2, {at}"), format!("2, {to}")), (format!("{at}, 2.8"), format!("{to}, 2.9"))]
        })
        .collect();
    let many: Vec<_> = many.iter().map(|(lower, upper)| (&lower[..], &upper[..], 0, 0)).collect();
    assert_eq!(code(&arm, &world(WALL), &certificate("", UPPER, WALL_PART, &many)), 3);
}
