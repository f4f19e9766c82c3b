//! Certificates that tasks cannot be done, written by hand, and falsified ones.

use cplan_check::{CheckError, check};

/// A gantry: the tip is at the joints' values, in the middle of a small head.
const GANTRY: &str = r#"<robot name="g">
  <link name="base"/>
  <joint name="x" type="prismatic">
    <parent link="base"/> <child link="bridge"/> <axis xyz="1 0 0"/> <limit lower="0" upper="4"/>
  </joint>
  <link name="bridge"/>
  <joint name="y" type="prismatic">
    <parent link="bridge"/> <child link="head"/> <axis xyz="0 1 0"/> <limit lower="0" upper="2"/>
  </joint>
  <link name="head"> <collision> <geometry> <box size="0.1 0.1 0.1"/> </geometry> </collision> </link>
</robot>"#;

/// A block is carried through a gap that is this high, and after it the head goes back.
fn world(robot: &str, gap: f64, object: &str, steps: &str) -> String {
    let [low, high] = [1.0 - gap / 2.0, 1.0 + gap / 2.0];
    format!(
        "robot = {{ payload = \"level\"{robot} }}\nstart.joints = [0, 1]\n\
         [[obstacle]]\nname = \"sill\"\npolygon = [[1.9, -1], [2.1, -1], [2.1, {low}], [1.9, {low}]]\n\
         [[obstacle]]\nname = \"lintel\"\npolygon = [[1.9, {high}], [2.1, {high}], [2.1, 3], [1.9, 3]]\n\
         [[object]]\nname = \"block\"\nat = [1, 1]\npolygon = [[-0.2, -0.1], [0.2, -0.1], [0.2, 0.1], [-0.2, 0.1]]\n{object}\n{steps}"
    )
}

const STEPS: &str =
    "[[step]]\npick = \"block\"\n[[step]]\nplace = { at = [3, 1] }\n[[step]]\nmove = { joints = [0, 1] }\n";

/// Boxes across the range of the second joint, the block against the sill or the lintel: its depth in them outweighs how far it moves.
fn boxes() -> Vec<String> {
    let all = (0..100).map(|k| {
        let [low, high] = [0.02 * f64::from(k), 0.02 * f64::from(k + 1)];
        format!(r#"{{"lower": [1.99, {low}], "upper": [2.01, {high}], "shape": 0, "part": {}}}"#, k / 50)
    });
    all.collect()
}

const SHAPES: &str = r#"{"carried": [[-0.2, -0.1], [0.2, -0.1], [0.2, 0.1], [-0.2, 0.1]]}"#;
const FROM: &str = r#""step": 2, "from": [[0.999999, 1.000001], [0.999999, 1.000001]]"#;

fn certificate(shapes: &str, cases: &str) -> String {
    let [low, high] = [0.95, 1.05];
    format!(
        r#"{{"format": "cplan certificate 1", "answer": "infeasible", "shapes": [{shapes}], "parts": [
        {{"obstacle": 0, "corners": [[1.9, -1], [2.1, -1], [2.1, {low}], [1.9, {low}]]}},
        {{"obstacle": 1, "corners": [[1.9, {high}], [2.1, {high}], [2.1, 3], [1.9, 3]]}}], "cases": [{cases}]}}"#
    )
}

/// Whether it holds, by its exit code, and what is said.
fn judged(world: &str, certificate: &str) -> (i32, String) {
    match check(GANTRY, world, certificate) {
        Ok(said) => (0, said),
        Err(CheckError::Fails(why)) => (3, why),
        Err(CheckError::Input { message, .. }) => (1, message),
    }
}

/// With all boxes, in a world that is a little other.
fn among(robot: &str, gap: f64, object: &str, steps: &str) -> (i32, String) {
    let case = format!(r#"{{{FROM}, "boxes": [{}]}}"#, boxes().join(", "));
    judged(&world(robot, gap, object, steps), &certificate(SHAPES, &case))
}

#[track_caller]
fn says((code, said): (i32, String), expected: i32, part: &str) {
    assert!(code == expected && said.contains(part), "{code} {said}");
}

#[test]
fn a_block_does_not_pass_a_gap_that_is_lower() {
    says(among("", 0.1, "", STEPS), 0, "no motion of \"x\" and \"y\" from the start on does the steps up to step 2");
    // Half a box of 0.02 by 0.02 is 0.02 of motion: the block, 0.2 high, is no deeper than that in a sill where the gap is 0.18.
    says(among("", 0.15, "", STEPS), 0, "step 2");
    for gap in [0.18, 0.19, 0.25] {
        says(among("", gap, "", STEPS), 3, "can come off the part");
    }
    // It is the block that does not pass: the head does.
    let head = r#"{"link": "head", "collision": 0}"#;
    let case = format!(r#"{{{FROM}, "boxes": [{}]}}"#, boxes().join(", "));
    says(judged(&world("", 0.1, "", STEPS), &certificate(head, &case)), 3, "can come off the part");
}

#[test]
fn all_boxes_and_cases_are_needed() {
    let world = world("", 0.1, "", STEPS);
    let with = |cases: &str| judged(&world, &certificate(SHAPES, cases));
    let all = boxes();
    for missing in [0, 31, 49, 50, 99] {
        let left: Vec<&str> = all.iter().enumerate().filter(|(k, _)| *k != missing).map(|(_, text)| &**text).collect();
        says(with(&format!(r#"{{{FROM}, "boxes": [{}]}}"#, left.join(", "))), 3, "leave open that all steps are done");
    }
    let boxes = all.join(", ");
    says(with(""), 3, "leave open");
    says(with(&format!(r#"{{"step": 2, "boxes": [{boxes}]}}"#)), 3, "step 2 may begin where no case does");
    let beside = FROM.replace("1.000001", "1");
    says(with(&format!(r#"{{{beside}, "boxes": [{boxes}]}}"#)), 3, "step 2 may begin where no case does");
    let turned = r#""step": 2, "from": [[1.000001, 0.999999], [1.000001, 0.999999]]"#;
    says(with(&format!(r#"{{{turned}, "boxes": [{boxes}]}}"#)), 3, "step 2 may begin where no case does");
    // From beyond the wall, which is not where the arm is, ...
    let beyond = r#""step": 2, "from": [[0, 4], [0, 2]]"#;
    says(with(&format!(r#"{{{beyond}, "boxes": [{boxes}]}}"#)), 3, "leave open");
    // ... and of another step, in which nothing is carried.
    says(with(&format!(r#"{{"step": 1, "boxes": [{boxes}]}}"#)), 3, "carried where nothing is");
    let back = FROM.replace(r#""step": 2"#, r#""step": 3"#);
    says(with(&format!(r#"{{{back}, "boxes": [{boxes}]}}"#)), 3, "step 3 may begin where no case does");
}

#[test]
fn what_the_block_may_do_proves_nothing() {
    says(among("", 0.1, "supports = [\"sill\"]", STEPS), 3, "the shape may meet the obstacle");
    let resting = STEPS.replace("[3, 1]", "[3, 1], supports = [\"lintel\"]");
    says(among("", 0.1, "", &resting), 3, "the shape may meet the obstacle");
    // A wrist may turn it; and what turns with the arm is another case, though not on a gantry.
    says(among(", wrist = { velocity = 1 }", 0.1, "", STEPS), 3, "carried where nothing is");
    says(among("", 0.1, "payload = \"rigid\"", STEPS), 0, "step 2");
    let after = STEPS.replacen("[[step]]\nplace", "[[step]]\nmove = { joints = [1, 1] }\n[[step]]\nplace", 1);
    let third = format!(r#"{{{}, "boxes": [{}]}}"#, FROM.replace("2,", "3,"), boxes().join(", "));
    let after = |payload: &str| judged(&world("", 0.1, payload, &after), &certificate(SHAPES, &third));
    says(after("payload = \"rigid\""), 3, "carried where nothing is");
    says(after(""), 0, "step 3");
    // Over the walls.
    let high = "height = [0, 0.1]\nlift = 0.2";
    let low = |world: String| world.replace("name = \"sill\"", "name = \"sill\"\nheight = [0, 0.15]");
    let case = format!(r#"{{{FROM}, "boxes": [{}]}}"#, boxes().join(", "));
    let certificate = certificate(SHAPES, &case);
    says(judged(&low(world("", 0.1, high, STEPS)), &certificate), 3, "passes over or under");
    says(judged(&low(world("", 0.1, "height = [0, 0.1]\nlift = 0.1", STEPS)), &certificate), 0, "step 2");
}

/// The block lies where it was let go of; the head is free to meet it until it has gone on.
#[test]
fn objects_lie_where_they_were_let_go_of() {
    // In a lane that the block fills.
    let lane = |steps: &str| {
        format!(
            "robot = {{ payload = \"level\" }}\nstart.joints = [0, 1]\n\
             [[object]]\nname = \"block\"\nat = [1, 1]\npolygon = [[-0.1, -2], [0.1, -2], [0.1, 2], [-0.1, 2]]\n{steps}"
        )
    };
    let steps = "[[step]]\npick = \"block\"\n[[step]]\nplace = { at = [2, 1] }\n";
    let block = |x: f64| format!("[[{0}, -1], [{1}, -1], [{1}, 3], [{0}, 3]]", x - 0.1, x + 0.1);
    let certificate = |step: usize, from: [f64; 2], x: f64| {
        let all = (0..20).map(|k| {
            let [low, high] = [0.1 * f64::from(k), 0.1 * f64::from(k + 1)];
            format!(r#"{{"lower": [{}, {low}], "upper": [{}, {high}], "shape": 0, "part": 0}}"#, x - 0.01, x + 0.01)
        });
        let from = from.map(|at| format!("[{}, {}]", at - 1e-6, at + 1e-6)).join(", ");
        format!(
            r#"{{"format": "cplan certificate 1", "answer": "infeasible", "shapes": [{{"link": "head", "collision": 0}}],
            "parts": [{{"obstacle": 0, "corners": {}}}],
            "cases": [{{"step": {step}, "from": [{from}], "boxes": [{}]}}]}}"#,
            block(x),
            all.collect::<Vec<_>>().join(", ")
        )
    };
    let away = |x: f64| format!("{steps}[[step]]\nmove = {{ joints = [{x}, 1] }}\n");
    // It may leave the block to either side.
    says(judged(&lane(&away(3.0)), &certificate(3, [2.0, 1.0], 2.0)), 3, "the shape may meet the obstacle");
    let back = |from: f64, to: f64| format!("{}[[step]]\nmove = {{ joints = [{to}, 1] }}\n", away(from));
    says(judged(&lane(&back(1.0, 3.0)), &certificate(4, [1.0, 1.0], 2.0)), 0, "up to step 4");
    says(judged(&lane(&back(3.0, 1.0)), &certificate(4, [3.0, 1.0], 2.0)), 0, "up to step 4");
    says(judged(&lane(&back(3.0, 3.5)), &certificate(4, [3.0, 1.0], 2.0)), 3, "leave open");
    // Corners are those that are nearest to where it lies then.
    says(judged(&lane(&back(3.0, 1.0)), &certificate(4, [3.0, 1.0], 1.5)), 3, "its corners are not those");
    // Of what turns with the arm it is not known how it lies.
    let rigid = lane(&back(3.0, 1.0)).replace("payload = \"level\"", "payload = \"rigid\"");
    says(judged(&rigid, &certificate(4, [3.0, 1.0], 2.0)), 3, "not known to stand anywhere");
}

#[test]
fn bad_input_is_named() {
    let case = format!(r#"{{{FROM}, "boxes": [{}]}}"#, boxes().join(", "));
    let certificate = certificate(SHAPES, &case);
    let free = format!("task.order = \"free\"\n{}", world("", 0.1, "", &STEPS[..STEPS.rfind("[[step]]").unwrap()]));
    says(judged(&free, &certificate), 1, "in any order");
    says(judged(&world("", 0.1, "", "goal.joints = [3, 1]").replace("goal", "#"), &certificate), 1, "it has no steps");
    let all = world("", 0.1, "", STEPS);
    says(judged(&all, &certificate.replacen("\"cases\"", "\"goal\": [3, 1], \"cases\"", 1)), 1, "has no goal");
    says(judged(&all, &certificate.replacen("\"cases\"", "\"boxes\": [], \"cases\"", 1)), 1, "of a task cases");
    says(judged(&all, &certificate.replacen("infeasible", "found", 1)), 1, "has a motion");
    says(
        judged(&all, &certificate.replacen("{\"carried\"", "{\"link\": \"head\", \"carried\"", 1)),
        1,
        "or is carried",
    );
    says(judged(&all, &certificate.replacen("\"part\": 0", "\"part\": 7", 1)), 3, "that is not there");
}
