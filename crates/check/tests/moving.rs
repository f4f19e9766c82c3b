//! Obstacles that move: the checker knows no time, and says of what stands alone what holds in spite of them.

use cplan_check::{CheckError, Input, check};

/// A gantry with a square of 1 m at its tip.
const GANTRY: &str = r#"<robot name="g">
  <link name="base"/>
  <joint name="x" type="prismatic">
    <parent link="base"/> <child link="bridge"/> <axis xyz="1 0 0"/> <limit lower="0" upper="9"/>
  </joint>
  <link name="bridge"/>
  <joint name="y" type="prismatic">
    <parent link="bridge"/> <child link="tool"/> <axis xyz="0 1 0"/> <limit lower="0" upper="9"/>
  </joint>
  <link name="tool"> <collision> <geometry> <box size="1 1 1"/> </geometry> </collision> </link>
</robot>"#;

const ENDS: &str = "start.joints = [1, 1]\ngoal.joints = [9, 1]\n";
const WALL: &str = "[[obstacle]]\npolygon = [[4, -1], [6, -1], [6, 10], [4, 10]]\n";
const MOTIONS: [&str; 2] =
    ["{ velocity = [0.1, 0] }", "{ stops = [{ time = 0, at = [3, 3] }, { time = 1, at = [8, 8] }] }"];

/// Something far off that moves.
fn cart(motion: &str) -> String {
    format!(
        "[[obstacle]]\nname = \"cart\"\ncircle = {{ center = [0, 0], radius = 0.1 }}\nat = [50, 50]\nmotion = {motion}\n"
    )
}

fn certificate(answer: &str, evidence: &str) -> String {
    format!(
        r#"{{"format": "cplan certificate 1", "answer": "{answer}", {evidence},
             "shapes": [{{"link": "tool", "collision": 0}}],
             "parts": [{{"obstacle": 0, "corners": [[4, -1], [6, -1], [6, 10], [4, 10]]}}]}}"#
    )
}

const BOUND: &str = r#""bound": {"to": [9, 1], "length": 8, "walls": [], "potentials": []}"#;
const MOTION: &str = r#""motion": {"interpolation": ["linear"], "knots": [[0, 1, 1], [1, 9, 1]]}"#;

/// Boxes all along the wall, a metre each: the square in the middle of one is deeper in the wall than it can move there.
fn boxes() -> String {
    let stuck = |y: i32| {
        let above = y + 1;
        format!(r#"{{"lower": [4.8, {y}], "upper": [5.2, {above}], "shape": 0, "part": 0}}"#)
    };
    format!(r#""boxes": [{}]"#, (0..9).map(stuck).collect::<Vec<_>>().join(", "))
}

/// Parts go by their number among the obstacles that stand, whatever moves before them in the file.
#[test]
fn what_is_impossible_among_what_stands_is_so_among_more() {
    for motion in MOTIONS {
        let worlds =
            [[&cart(motion), WALL], [WALL, &cart(motion)]].map(|obstacles| format!("{ENDS}{}", obstacles.concat()));
        for world in worlds {
            check(GANTRY, &world, &certificate("infeasible", &boxes())).unwrap();
            check(GANTRY, &world, &certificate("no_shorter", BOUND)).unwrap();
            let other = certificate("infeasible", &boxes()).replace(r#""obstacle": 0"#, r#""obstacle": 1"#);
            let why = check(GANTRY, &world, &other).unwrap_err();
            assert!(matches!(&why, CheckError::Fails(why) if why.contains("there is no obstacle 1")), "{why}");
        }
    }
}

#[test]
fn no_motion_is_known_to_be_free_among_what_moves() {
    let alone = |evidence: &str| format!(r#"{{"format": "cplan certificate 1", "answer": "found", {evidence}}}"#);
    check(GANTRY, ENDS, &alone(MOTION)).unwrap();
    let refused = |world: &str, evidence: &str| match check(GANTRY, world, &alone(evidence)) {
        Err(CheckError::Input { input: Input::World, line, message }) => (line, message),
        other => panic!("{world}: {other:?}"),
    };
    for motion in MOTIONS {
        let world = format!("{ENDS}{}", cart(motion));
        let (line, message) = refused(&world, MOTION);
        assert_eq!(
            (line, &*message),
            (Some(3), "obstacle \"cart\" moves: the checker knows no time, and so no motion in it")
        );
        assert_eq!(refused(&world, &format!("{MOTION}, {BOUND}")).1, message);
        let task = format!("{world}[[step]]\nmove = {{ joints = [9, 1] }}\n").replace("goal.joints = [9, 1]\n", "");
        assert_eq!(refused(&task, &format!(r#"{MOTION}, "steps": [{{"step": 1, "knots": [0, 1]}}]"#)).1, message);
    }
    // Without a name by its place in the file.
    let post = "[[obstacle]]\ncircle = { center = [50, 0], radius = 1 }\n";
    let (_, message) = refused(&format!("{ENDS}{post}{}", cart(MOTIONS[0]).replace("name = \"cart\"\n", "")), MOTION);
    assert!(message.contains("obstacle \"obstacle 2\" moves"), "{message}");
}

/// An object is where it lies, and has no motion of its own.
#[test]
fn objects_do_not_move_by_themselves() {
    let world = format!("{ENDS}{}", cart(MOTIONS[0]).replace("[[obstacle]]", "[[object]]"));
    let why = check(GANTRY, &world, &certificate("no_shorter", BOUND)).unwrap_err().to_string();
    assert!(why.contains("does not know the key motion"), "{why}");
}
