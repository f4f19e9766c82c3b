//! The robot's own body: static links, and links that joint 1 carries, are obstacles for other links.

use crate::common::robots::gantry;
use crate::common::scara::{LIMITS, QUILL, folded, folding_certificate, scara, world};
use crate::common::verdict::{Verdict, agrees, done, fails_with, found, holds, judge as judge_in, refused};

/// Adds a link beside the base.
fn with_link_beside_base(scara: &str, kind: &str, shape: &str) -> String {
    let joint = format!(
        r#"<joint name="c" type="{kind}"> <parent link="base"/> <child link="box"/> <limit lower="-1" upper="1"/> </joint>"#
    );
    scara.replace("</robot>", &format!("{joint} <link name=\"box\"> {shape} </link> </robot>"))
}

fn judge(urdf: &str, robot: &str, certificate: &str) -> Verdict {
    judge_in(urdf, &world(robot), certificate)
}

const HIT: [&str; 3] = ["after knot 0, ", "link \"quill\", collision 0", "link \"base\", collision 0"];

/// Tests that links of a robot may touch each other above and below. Links and obstacles must not.
#[test]
fn a_base_is_hit_and_passed_over() {
    let fold = |lowest: f64| judge(&scara(lowest), "", &folded(""));
    fails_with(fold(0.1), &HIT);
    fails_with(fold(0.2999), &HIT);
    for over in [0.3, 0.31] {
        holds(fold(over));
    }
    // The same base as an obstacle.
    let bare = scara(0.3).replacen("<collision>", "<lamp>", 1).replacen("</collision>", "</lamp>", 1);
    let block = "[[obstacle]]\npolygon = [[-0.2, -0.15], [0.2, -0.15], [0.2, 0.15], [-0.2, 0.15]]\n";
    let among = |heights: &str| judge_in(&bare, &format!("{}{block}{heights}", world("")), &folded(""));
    fails_with(among("height = [0, 0.3]"), &["obstacle 0"]);
    // The upper arm begins at 0.25 m, and is not a neighbour of an obstacle.
    holds(among("height = [0, 0.24]"));
    // Folded less, the quill stays beside the base, at less than 0.3 m.
    let turned = |extra: &str| judge(&scara(0.1), "", &folded(extra).replace("2.8]]", "2.2]]"));
    holds(turned(r#""goal": [-1, 2.2],"#));
    fails_with(turned(r#""goal": [-1, 2.2], "clearance": 0.3,"#), &HIT);
}

/// Tests that the base moves with the robot.
#[test]
fn a_base_stands_where_the_world_puts_the_robot() {
    for at in ["", "at = [3, -2]", "at = [3, -2]\nangle = \"70deg\""] {
        fails_with(judge(&scara(0.1), at, &folded("")), &HIT);
        holds(judge(&scara(0.31), at, &folded("")));
    }
}

#[test]
fn the_world_excludes_pairs_of_links() {
    let report = |robot: &str| judge(&scara(0.1), robot, &folded(""));
    holds(report("own_body = false"));
    fails_with(report("own_body = true"), &HIT);
    for pair in ["[\"base\", \"quill\"]", "[\"quill\", \"base\"]"] {
        holds(report(&format!("ignore_contact = [{pair}]")));
    }
    fails_with(report("ignore_contact = [[\"base\", \"fore\"], [\"upper\", \"quill\"]]"), &HIT);
    for (robot, part) in [
        ("ignore_contact = [[\"base\", \"hand\"]]", "no link \"hand\""),
        ("ignore_contact = [[\"base\"]]", "a list of two"),
        ("ignore_contact = [[\"base\", 1]]", "expected a text"),
        ("own_body = 1", "true or false"),
    ] {
        refused(report(robot), part);
    }
}

/// Tests that a cylinder that leans is an obstacle as well. Its outline is at most 0.5 mm wider than 0.1 m.
#[test]
fn a_leaning_base_is_as_wide_as_it_is() {
    let leaning = |turn: &str| {
        let shape = "<cylinder radius=\"0.1\" length=\"0.4\"/>";
        let urdf = scara(0.1).replacen("<box size=\"0.4 0.3 0.3\"/>", shape, 1);
        urdf.replacen("<origin xyz=\"0 0 0.15\"/>", &format!("<origin xyz=\"0 0 0.15\" rpy=\"{turn}\"/>"), 1)
    };
    fails_with(judge(&leaning("0 1.2 0"), "", &folded("")), &HIT);
    holds(judge(&leaning("1.2 0 0"), "", &folded(r#""clearance": 0.0465,"#)));
    fails_with(judge(&leaning("1.2 0 0"), "", &folded(r#""clearance": 0.0485,"#)), &HIT);
}

/// Tests that shapes of neighbours may overlap if they do so at every angle. Other shapes must not, whichever links lie
/// between them.
#[test]
fn neighbours_may_meet_at_their_joint() {
    let sunk = scara(0.31).replacen("size=\"0.4 0.3 0.3\"", "size=\"0.4 0.3 0.6\"", 1);
    // Up to 0.45 m high, the base blocks the quill, but not the forearm.
    fails_with(judge(&sunk, "", &folded("")), &["link \"quill\""]);
    holds(judge(&sunk, "ignore_contact = [[\"base\", \"quill\"]]", &folded("")));
    let higher = sunk.replacen("0.4 0.3 0.6", "0.4 0.3 0.62", 1);
    let ignored = "ignore_contact = [[\"base\", \"quill\"]]";
    fails_with(judge(&higher, ignored, &folded("")), &["link \"fore\", collision 0", "link \"base\""]);
    // This is so even if the upper arm has no shape.
    let bare = higher.replacen("size=\"0.6 0.1 0.2\"", "size=\"0 0 0\"", 1);
    fails_with(judge(&bare, ignored, &folded("")), &["link \"fore\", collision 0", "link \"base\""]);
    // A second shape of the base is beside the axis.
    let second =
        r#"<collision> <origin xyz="0.1 -0.2 0.35"/> <geometry> <sphere radius="0.05"/> </geometry> </collision>"#;
    let boxed = scara(0.31).replacen("<link name=\"base\">", &format!("<link name=\"base\"> {second}"), 1);
    fails_with(judge(&boxed, "", &folded("")), &["link \"upper\", collision 0", "link \"base\", collision 0"]);
    // A base without a shape does not make the links beside it neighbours.
    let shape =
        r#"<collision> <origin xyz="0.1 -0.2 0.35"/> <geometry> <sphere radius="0.05"/> </geometry> </collision>"#;
    fails_with(
        judge(&with_link_beside_base(&scara(0.31), "fixed", shape), "", &folded("")),
        &["link \"upper\"", "link \"box\""],
    );
    // On a joint of its own, its position is unknown.
    holds(judge(&with_link_beside_base(&scara(0.31), "prismatic", shape), "joints = [\"a\", \"b\"]", &folded("")));
}

/// Tests that the visual shapes of a link are used if it has no collision shapes, regardless of other links. An
/// unreadable mesh of the base is reported.
#[test]
fn each_link_has_its_visual_shapes_by_itself() {
    let of = |link: &str, urdf: &str| {
        let (before, after) = urdf.split_once(&format!("<link name=\"{link}\">")).unwrap();
        let (own, after) = after.split_once("</link>").unwrap();
        format!("{before}<link name=\"{link}\">{}</link>{after}", own.replace("collision", "visual"))
    };
    let seen = of("quill", &of("base", &scara(0.1)));
    fails_with(judge(&seen, "", &folded("")), &["link \"quill\", visual 0", "link \"base\", visual 0"]);
    let both = seen.replace(
        "<link name=\"quill\">",
        "<link name=\"quill\"> <collision> <geometry> <sphere radius=\"0.01\"/> </geometry> </collision>",
    );
    // A small ball as collision shape replaces the visual shape.
    fails_with(judge(&both, "", &folded("")), &["link \"quill\", collision 0"]);
    holds(judge(&both.replace("<sphere radius=\"0.01\"/>", "<box size=\"0 0 0\"/>"), "own_body = false", &folded("")));
    let unread = |link: &str, kind: &str, urdf: &str| {
        let mesh = format!("<{kind}> <geometry> <mesh filename=\"none.stl\"/> </geometry> </{kind}>");
        urdf.replace(&format!("<link name=\"{link}\">"), &format!("<link name=\"{link}\">{mesh}"))
    };
    let report = holds(judge(&unread("base", "collision", &scara(0.31)), "", &folded("")));
    assert!(report.contains("collision of link \"base\" is ignored"), "{report}");
    // The other shape of the base still counts.
    fails_with(judge(&unread("base", "collision", &scara(0.1)), "", &folded("")), &HIT);
    let report = holds(judge(&unread("quill", "visual", &of("quill", &scara(0.31))), "", &folded("")));
    assert!(report.contains("visual of link \"quill\" is ignored"), "{report}");
    refused(judge(&unread("quill", "collision", &scara(0.31)), "", &folded("")), "other files");
}

/// Tests that shapes may meet if they do so in every configuration, and that no certificate can ask for more.
#[test]
fn shapes_that_always_meet_are_ignored() {
    let sized = |size: &str| scara(0.1).replacen("size=\"0.4 0.3 0.3\"", &format!("size=\"{size}\""), 1);
    holds(judge(&sized("4 4 0.3"), "", &folded("")));
    // Stretched, the quill leaves this base.
    fails_with(judge(&sized("1.8 1.8 0.3"), "", &folded("")), &["link \"base\", collision 0"]);
    // Two links that only touch at some angles, where one begins at the axis and the other ends there.
    let level = scara(0.31).replacen("xyz=\"0.5 0 0.1\"", "xyz=\"0.5 0 0\"", 1);
    let level = level.replacen("xyz=\"0.2 0 0.05\"", "xyz=\"0.25 0 0.05\"", 1);
    let quill = "ignore_contact = [[\"base\", \"quill\"], [\"upper\", \"quill\"]]";
    holds(judge(&level.replacen("0.25 0 0\"", "0.2 0 0\"", 1), quill, &folded("")));
    // This disc about the axis of joint 1 just touches the upper arm, at all angles.
    let disc = scara(0.31).replacen("<box size=\"0.4 0.3 0.3\"/>", "<cylinder radius=\"0.2\" length=\"0.3\"/>", 1);
    let disc = disc.replacen("0 0 0.15", "0 0 0.25", 1).replacen("0.6 0.1 0.2", "0.1 0.1 0.2", 1);
    holds(judge(&disc, "ignore_contact = [[\"base\", \"quill\"], [\"base\", \"fore\"]]", &folded("")));
    refused(judge(&scara(0.1), "", &folded(r#""ignored": [["base", "quill"]],"#)), "ignored");
}

const BASE: &str = r#"{"own": "base", "collision": 0}"#;

fn with_round_base(lowest: f64) -> String {
    scara(lowest).replacen("<box size=\"0.4 0.3 0.3\"/>", "<cylinder radius=\"0.3\" length=\"0.3\"/>", 1)
}

#[test]
fn proofs_name_fixed_links() {
    let certificate = folding_certificate(QUILL, BASE);
    holds(judge(&with_round_base(0.1), LIMITS, &certificate));
    holds(judge(&with_round_base(0.1), &format!("{LIMITS}\nat = [1, 1]\nangle = 2"), &certificate));
    holds(judge(
        &with_round_base(0.1).replacen("collision", "visual", 2),
        LIMITS,
        &certificate.replace("base\", \"collision", "base\", \"visual"),
    ));
    for (lowest, robot, shape, part, why) in [
        (0.3, "", QUILL, BASE, "passes over or under"),
        (0.1, "own_body = false", QUILL, BASE, "no collision shape 0"),
        (0.1, "ignore_contact = [[\"quill\", \"base\"]]", QUILL, BASE, "is allowed to touch link \"base\""),
        (0.1, "", FIRST, BASE, "is allowed to touch link \"base\""),
        (0.1, "", QUILL, r#"{"own": "base", "collision": 1}"#, "no collision shape 1"),
        (0.1, "", QUILL, r#"{"own": "base", "visual": 0}"#, "no visual shape"),
        (0.1, "", QUILL, r#"{"own": "fore", "collision": 0}"#, "link \"fore\" has no"),
        (0.1, "", QUILL, r#"{"obstacle": 0}"#, "obstacle 0 does not exist"),
    ] {
        fails_with(
            judge(&with_round_base(lowest), &format!("{LIMITS}\n{robot}"), &folding_certificate(shape, part)),
            &[why],
        );
    }
    for part in [
        "{}",
        r#"{"own": "base"}"#,
        r#"{"own": "base", "obstacle": 0}"#,
        r#"{"own": "base", "collision": 0, "corners": []}"#,
    ] {
        refused(judge(&with_round_base(0.1), LIMITS, &folding_certificate(QUILL, part)), "");
    }
    // A smaller base leaves room.
    let small = with_round_base(0.1).replacen("radius=\"0.3\"", "radius=\"0.2\"", 1);
    fails_with(judge(&small, LIMITS, &certificate), &["does not touch"]);
}

/// Tests that a carried object must not hit static links.
#[test]
fn payloads_avoid_the_base() {
    let base = r#"<link name="base"> <collision> <origin xyz="2 0.87 0"/> <geometry> <sphere radius="0.04"/> </geometry> </collision> </link>"#;
    let bridge =
        r#"<link name="bridge"> <collision> <geometry> <box size="0.02 0.02 0.02"/> </geometry> </collision> </link>"#;
    let gantry = gantry([-9, 9], r#"box size="0.1 0.1 0.1""#).replace("<link name=\"base\"/>", base);
    let gantry = gantry.replace("<link name=\"bridge\"/>", bridge);
    let carried = |size: &str, robot: &str| {
        let world = format!(
            "robot = {{ payload = \"level\", wrist = {{ velocity = 1 }}, {robot} }}\nstart.joints = [0, 1]\n[[object]]\nname = \"block\"\nat = [1, 1]\n\
             polygon = [[-0.2, -{size}], [0.2, -{size}], [0.2, 0.1], [-0.2, 0.1]]\nheight = [0.02, 0.04]\n\
             [[step]]\npick = \"block\"\n[[step]]\nplace = {{ at = [3, 1] }}\n"
        );
        let steps = r#"{"step": 1, "knots": [0, 1]}, {"step": 2, "knots": [2, 3]}"#;
        judge_in(&gantry, &world, &done("[0, 0, 1], [1, 1, 1], [2, 1, 1], [3, 3, 1]", steps))
    };
    holds(carried("0.08", ""));
    fails_with(carried("0.1", ""), &["step 2", "the payload", "link \"base\", collision 0"]);
    holds(carried("0.1", "own_body = false"));
    fails_with(carried("0.1", "ignore_contact = [[\"base\", \"head\"]]"), &["the payload"]);
}

/// Tests a bar that replaces a link.
#[test]
fn bars_must_not_collide() {
    let bare = scara(0.2).replacen("<collision>", "<lamp>", 4).replacen("</collision>", "</lamp>", 4);
    let base = bare
        .replacen("lamp>", "collision>", 1)
        .replacen("</lamp>", "</collision>", 1)
        .replace("0.45 0 -0.45", "0.45 0 0");
    let high = |height: &str| base.replacen("0.4 0.3 0.3", height, 1);
    // The bar of the forearm is 0.4 m to 0.5 m high, and reaches to the quill.
    fails_with(judge(&high("0.4 0.3 0.7"), "bar = 0.05", &folded("")), &["the bar of link \"fore\"", "link \"base\""]);
    holds(judge(&high("0.4 0.3 0.4"), "bar = 0.05", &folded("")));
}

/// Returns a SCARA with a continuous elbow, and an upper arm of this width.
fn turning(lowest: f64, wide: f64) -> String {
    let upper = scara(lowest).replacen("0.6 0.1 0.2", &format!("0.6 {wide} 0.2"), 1);
    upper.replacen("name=\"b\" type=\"revolute\"", "name=\"b\" type=\"continuous\"", 1)
}

/// Tests an arm that is folded back. The quill is in the middle of the upper arm. It passes above if it is high enough.
#[test]
fn the_upper_arm_is_hit_and_passed_over() {
    let fold =
        |urdf: &str, robot: &str, knots: &str, extra: &str| judge(urdf, robot, &found(extra, r#""linear""#, knots));
    let goal = |to: f64| format!(r#""goal": [1, {to}],"#);
    let round = "[0, -1, 0], [1, 1, 4]";
    let hit = ["after knot 0, ", "link \"quill\", collision 0", "link \"upper\", collision 0"];
    for lowest in [0.35, 0.449] {
        fails_with(fold(&turning(lowest, 0.1), "", round, &goal(4.0)), &hit);
        fails_with(fold(&turning(lowest, 0.1), "at = [3, -2]\nangle = 1", round, &goal(4.0)), &hit);
        holds(fold(&turning(lowest, 0.1), "own_body = false", round, &goal(4.0)));
        holds(fold(&turning(lowest, 0.1), "ignore_contact = [[\"upper\", \"quill\"]]", round, &goal(4.0)));
    }
    holds(fold(&turning(0.45, 0.1), "", round, &goal(4.0)));
    // 0.45 sin(2.8) - 0.02 - 0.05 = 0.0807 beside it, for any shoulder.
    for (clearance, is_free) in [(0.08, true), (0.081, false)] {
        let extra = format!("{}\"clearance\": {clearance},", goal(2.8));
        agrees(fold(&turning(0.35, 0.1), "", "[0, -1, 0], [1, 1, 2.8]", &extra), is_free, "");
    }
    // An upper arm that covers the quill at every angle.
    let wide = turning(0.35, 2.5).replacen("0.6 2.5 0.2", "2.5 2.5 0.2", 1);
    holds(fold(&wide, "", round, &goal(4.0)));
}

/// Tests a joint 1 that slides. The carriage is an obstacle for everything that the elbow moves, at any carriage
/// position.
#[test]
fn a_carriage_is_hit_wherever_it_slides() {
    let slides = turning(0.35, 0.1).replacen("name=\"a\" type=\"revolute\"", "name=\"a\" type=\"prismatic\"", 1);
    let slides = slides.replacen("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 1 0\"/>", 1);
    let slid = |lowest: &str, to: f64| {
        let certificate = folded(&format!(r#""start": [1, 0], "goal": [2, {to}],"#));
        let certificate = certificate.replace("[0, -1, 0], [1, -1, 2.8]", &format!("[0, 1, 0], [1, 2, {to}]"));
        judge(&slides.replacen("0.425", lowest, 1), "", &certificate)
    };
    fails_with(slid("0.425", 4.0), &["link \"quill\"", "link \"upper\""]);
    holds(slid("0.425", 2.8));
    holds(slid("0.53", 4.0));
}

/// The upper arm as a shape of a certificate.
const FIRST: &str = r#"{"link": "upper", "collision": 0}"#;
const UPPER: &str = r#"{"own": "upper", "collision": 0}"#;

/// Tests that contact with a part of the upper arm depends on the elbow alone. So a box may be as wide as the
/// shoulder's range.
#[test]
fn proofs_name_links_that_joint_1_carries() {
    let proof = |boxes: &[f64], shape: &str, part: &str| {
        let stuck = |at: &f64| {
            let [low, high] = [at - 0.01, at + 0.01];
            format!(r#"{{"lower": [-0.6, {low}], "upper": [0.6, {high}], "shape": 0, "part": 0}}"#)
        };
        let boxes: Vec<String> = boxes.iter().map(stuck).collect();
        format!(
            r#"{{"format": "cplan certificate 1", "answer": "infeasible", "start": [-0.1, 0], "goal": [0.1, 2.9],
                "shapes": [{shape}], "parts": [{part}], "boxes": [{}]}}"#,
            boxes.join(",")
        )
    };
    let both = proof(&[2.65, -2.65], QUILL, UPPER);
    holds(judge(&turning(0.35, 0.5), LIMITS, &both));
    holds(judge(&turning(0.35, 0.5), &format!("{LIMITS}\nat = [1, 1]\nangle = 2"), &both));
    // The elbow may also turn to the right.
    fails_with(judge(&turning(0.35, 0.5), LIMITS, &proof(&[2.65], QUILL, UPPER)), &["do not separate"]);
    holds(judge(&scara(0.35).replacen("0.6 0.1 0.2", "0.6 0.5 0.2", 1), LIMITS, &proof(&[2.65], QUILL, UPPER)));
    for (lowest, wide, robot, shape, part, why) in [
        (0.35, 0.3, "", QUILL, UPPER, "does not touch"),
        (0.45, 0.5, "", QUILL, UPPER, "passes over or under"),
        (0.35, 0.5, "own_body = false", QUILL, UPPER, "no collision shape 0"),
        (0.35, 0.5, "ignore_contact = [[\"quill\", \"upper\"]]", QUILL, UPPER, "is allowed to touch link \"upper\""),
        (0.35, 0.5, "", FIRST, UPPER, "is allowed to touch link \"upper\""),
        (0.35, 0.5, "", FIRST, r#"{"own": "quill", "collision": 0}"#, "link \"quill\""),
    ] {
        let robot = format!("{LIMITS}\n{robot}");
        fails_with(judge(&turning(lowest, wide), &robot, &proof(&[2.65, -2.65], shape, part)), &[why]);
    }
}

/// Tests that a rigidly held object turns with the forearm. A level object turns relative to the upper arm, and needs
/// space all around.
#[test]
fn payloads_avoid_the_upper_arm() {
    let carried = |long: f64, elbow: f64, robot: &str| {
        let tip = [f64::cos, f64::sin].map(|of| 0.5 * of(1.0) + 0.45 * of(1.0 + elbow));
        let world = format!(
            "[robot]\n{robot}\n[start]\njoints = [0, 0]\n[[object]]\nname = \"block\"\nat = [0.95, 0]\nheight = [0.31, 0.4]\n\
             polygon = [[-{long}, -0.02], [0.02, -0.02], [0.02, 0.02], [-{long}, 0.02]]\n\
             [[step]]\npick = \"block\"\n[[step]]\nplace = {{ at = {tip:?} }}\n"
        );
        let steps = r#"{"step": 1, "knots": [0, 1]}, {"step": 2, "knots": [1, 2]}"#;
        judge_in(&scara(0.46), &world, &done(&format!("[0, 0, 0], [1, 0, 0], [2, 1, {elbow}]"), steps))
    };
    let level = "payload = \"level\"\nwrist = { velocity = 1 }";
    let hit = ["step 2", "the payload", "link \"upper\", collision 0"];
    holds(carried(0.3, 2.2, ""));
    fails_with(carried(0.3, 2.8, ""), &hit);
    // The tip is 0.3138 m beside the upper arm.
    holds(carried(0.31, 2.2, level));
    fails_with(carried(0.32, 2.2, level), &hit);
    holds(carried(0.32, 2.2, ""));
    holds(carried(0.32, 2.2, &format!("{level}\nown_body = false")));
}
