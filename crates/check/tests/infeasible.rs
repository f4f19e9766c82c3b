//! Certificates written by hand, and falsified ones.

#[path = "../../../tests/common/random.rs"]
mod random;

use cplan_check::{CheckError, Input, check};

/// A bar of 1 m and 0.1 m about the origin, and one of 0.8 m at its end.
fn robot(first: &str, second: &str) -> String {
    format!(
        r#"<robot name="r">
  <link name="base"/>
  <joint name="a" type="{first}">
    <parent link="base"/> <child link="upper"/> <axis xyz="{}"/> <limit lower="-2.9" upper="2.9"/>
  </joint>
  <link name="upper">
    <collision> <origin xyz="0.5 0 0"/> <geometry> <box size="1.0 0.1 0.1"/> </geometry> </collision>
    <collision> <origin xyz="1 0 0.2"/> <geometry> <cylinder radius="0.06" length="0.1"/> </geometry> </collision>
  </link>
  <joint name="b" type="{second}">
    <parent link="upper"/> <child link="fore"/> <origin xyz="1 0 0"/> <axis xyz="{}"/> <limit lower="-2.9" upper="2.9"/>
  </joint>
  <link name="fore">
    <collision> <origin xyz="0.4 0 0"/> <geometry> <box size="0.8 0.1 0.1"/> </geometry> </collision>
  </link>
</robot>"#,
        if first == "prismatic" { "1 0 0" } else { "0 0 1" },
        if second == "prismatic" { "0 1 0" } else { "0 0 1" },
    )
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

/// Whether it holds, by its exit code.
fn code(urdf: &str, world: &str, certificate: &str) -> i32 {
    match check(urdf, world, certificate) {
        Ok(_) => 0,
        Err(CheckError::Fails(_)) => 3,
        Err(CheckError::Input { .. }) => 1,
    }
}

/// The bar meets a wall along the x axis at depth 0.05 / cos q in its direction: a box of half-width `w` around 0 holds as long
/// as the corner farthest from the axis, at sqrt(1 + 0.05^2), moves by less than that.
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
        // Slid by 0 the bar reaches from 0 to 1.
        assert_eq!(code(&arm, &world(post), &certificate("", UPPER, disc, &whole)), 0);
        let beyond = [("0.7, -3", "0.9, 3", 0, 0)];
        assert_eq!(code(&arm, &world(post), &certificate("", UPPER, disc, &beyond)), 3);
    }
    // The second bar, of each kind, met by a large disc wherever it is.
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
    // The wrong way round, and a side alone.
    for wrong in [
        r#"{"obstacle": 0, "corners": [[0.3, 0.2], [0.9, 0.2], [0.9, -0.2], [0.3, -0.2]]}"#,
        r#"{"obstacle": 0, "corners": [[0.3, 0.2], [0.9, 0.2]]}"#,
        r#"{"obstacle": 0}"#,
        r#"{"obstacle": 1}"#,
    ] {
        assert_eq!(code(&arm, &world(polygon), &certificate("", UPPER, wrong, &whole)), 3, "{wrong}");
    }
    // The same, turned and moved to where it was.
    let placed = "[[obstacle]]\nat = [0.6, 0]\nangle = \"90deg\"\npolygon = [[-0.2, -0.3], [0.2, -0.3], [0.2, 0.3], [-0.2, 0.3]]\n";
    assert_eq!(code(&arm, &world(placed), &certificate("", UPPER, corners, &whole)), 0);
}

#[test]
fn clearance_counts_and_what_is_asked_elsewhere_is_said() {
    let arm = robot("revolute", "revolute");
    let apart = "[[obstacle]]\ncircle = { center = [1.2, 0], radius = 0.1 }\n";
    let disc = r#"{"obstacle": 0}"#;
    let boxes = [("-0.01, -3", "0.01, 3", 0, 0)];
    let asked = |extra: &str, boxes: Boxes| check(&arm, &world(apart), &certificate(extra, UPPER, disc, boxes));
    assert!(matches!(asked("", &boxes), Err(CheckError::Fails(why)) if why.contains("box 0")));
    assert!(asked(r#""clearance": 0.15,"#, &boxes).unwrap().contains("clearance 0.15"));
    assert_eq!(code(&arm, &format!("clearance = 0.15\n{}", world(apart)), &certificate("", UPPER, disc, &boxes)), 0);
    let said = asked(r#""clearance": 0.15, "start": [-2, 1], "goal": [2, 1],"#, &boxes).unwrap();
    assert!(said.contains("start (-2, 1)") && said.contains("goal (2, 1)"), "{said}");
    assert!(matches!(asked(r#""clearance": 0.15, "goal": [-2, 1],"#, &boxes), Err(CheckError::Fails(_))));
    assert!(matches!(asked(r#""goal": [3, 1],"#, &boxes), Err(CheckError::Input { input: Input::World, .. })));
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

/// What the reader of each file does not know or what is wrong there is bad input, with the file and the place.
#[test]
fn bad_input_is_named() {
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
    urdf("name=\"b\"", "name=\"a\"", Some(10), "second joint");
    urdf("xyz=\"0 0 1\"", "xyz=\"0 0.001 1\"", Some(10), "plane");
    urdf("xyz=\"0 0 1\"", "xyz=\"0 0 0\"", Some(4), "no direction");
    urdf("parent link=\"base\"", "parent link=\"fore\"", Some(10), "ring");
    urdf("parent link=\"upper\"", "parent link=\"base\"", Some(10), "carries");
    urdf("type=\"revolute\"", "type=\"fixed\"", None, "0 joints can move");
    let worlds = |text: &str, at, part| bad(&arm, text, &good, Input::World, at, part);
    worlds("start = 3", Some(1), "table");
    worlds("start.joints = [1]", Some(1), "two numbers");
    worlds("start.tip = [1, 2]", Some(1), "tip");
    worlds("\nstart.joints = [1, inf]", Some(2), "decimal");
    worlds("start.joints = [1, 0x10]", Some(1), "decimal");
    worlds("goal.joints = [1, 2]", None, "no start");
    worlds(&format!("{ENDS}[[step]]"), Some(3), "step");
    worlds(&format!("{ENDS}[[obstacle]]"), Some(3), "one shape");
    worlds(&format!("{ENDS}[[obstacle]]\nsize = 3"), Some(4), "size");
    worlds("name = \"\n", Some(1), "");
    worlds("[robot]\nat = [1, 2]", Some(2), "[robot] at");
    worlds(&format!("clearance = -1\n{place}"), None, "negative");
    let certificates = |from: &str, to: &str, part: &str| {
        assert!(good.contains(from), "{from}");
        bad(&arm, &place, &good.replace(from, to), Input::Certificate, Some(1), part);
    };
    certificates("infeasible", "found", "found");
    certificates("\"boxes\"", "\"box\"", "box");
    certificates("-0.01", "\"-0.01\"", "decimal");
    certificates("-0.01", "1e9999", "digits");
    bad(&arm, &place, &good.replace("certificate 1", "certificate 2"), Input::Certificate, None, "certificate 2");
}

/// A wall of boxes that all are as wide as they may be. Whatever is done to one of them opens a way or makes a box too large: what
/// is falsified is refused.
#[test]
fn falsified_certificates_are_refused() {
    let arm = robot("revolute", "revolute");
    let place = world(WALL);
    let edges: Vec<f64> = (0..=8).map(|k| -3.0 + f64::from(k) * 0.75).collect();
    // Up to 0.04994 each, in steps so that neighbours overlap at one value only.
    let boxes = |edges: &[f64]| -> Vec<[f64; 4]> {
        let from = |k: usize| if k.is_multiple_of(2) { -0.0499 } else { 0.0 };
        edges.windows(2).enumerate().map(|(k, e)| [from(k), from(k) + 0.0499, e[0], e[1]]).collect()
    };
    let judged = |boxes: &[[f64; 4]]| {
        let texts: Vec<_> = boxes.iter().map(|[l, r, b, t]| (format!("{l}, {b}"), format!("{r}, {t}"))).collect();
        let named: Vec<_> = texts.iter().map(|(lower, upper)| (&lower[..], &upper[..], 0, 0)).collect();
        code(&arm, &place, &certificate("", UPPER, WALL_PART, &named))
    };
    // Half a box to each side of the wall: the corner at 0.05 lies on the one side, so less deep at the other.
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
    // Twice as wide: the sides come off the wall.
    for number in 0..whole.len() {
        let mut grown = whole.clone();
        grown[number][0] -= 0.06;
        grown[number][1] += 0.06;
        assert_eq!(judged(&grown), 3, "box {number}");
    }
}

/// Random boxes against the closed form: what holds is true. The bar meets the wall as long as its long side is not beyond the
/// wall's near end.
#[test]
fn what_holds_is_true() {
    let arm = robot("revolute", "revolute");
    let place = world(WALL);
    let mut held = 0;
    for seed in random::seeds(400) {
        // Weyl's sequences.
        let [a, b] = [0.754_877_666, 0.569_840_290].map(|step| (seed as f64 * step).fract());
        let (middle, half) = (0.3 * (a - 0.5), 0.08 * b);
        let (lower, upper) = (format!("{}, -3", middle - half), format!("{}, 3", middle + half));
        let code = code(&arm, &place, &certificate("", UPPER, WALL_PART, &[(&lower, &upper, 0, 0)]));
        let is_true = (middle.abs() + half).sin() * 0.5 <= 0.05;
        assert!(code == 0 && is_true || code == 3, "{lower} to {upper}: {code}");
        held += u64::from(code == 0);
    }
    assert!(held > random::times(20), "{held}");
}
