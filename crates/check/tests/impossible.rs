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
    of_robot(GANTRY, world, certificate)
}

/// The same of an arm of which the second joint turns.
fn turning(world: &str, certificate: &str) -> (i32, String) {
    let (before, second) = GANTRY.split_once("name=\"y\" type=\"prismatic\"").unwrap();
    let second = second.replace("xyz=\"0 1 0\"", "xyz=\"0 0 1\"");
    of_robot(&format!("{before}name=\"y\" type=\"revolute\"{second}"), world, certificate)
}

fn of_robot(robot: &str, world: &str, certificate: &str) -> (i32, String) {
    match check(robot, world, certificate) {
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
    // It does not pass through what it rests on.
    says(among("", 0.1, "supports = [\"sill\"]", STEPS), 0, "step 2");
    let resting = STEPS.replace("[3, 1]", "[3, 1], supports = [\"lintel\"]");
    says(among("", 0.1, "", &resting), 0, "step 2");
    // A wrist may turn it, if its place asks for an angle; and what turns with the arm is another case, though not on a gantry.
    says(among(", wrist = { velocity = 1 }", 0.1, "", STEPS), 0, "step 2");
    let turned = STEPS.replace("[3, 1]", "[3, 1], angle = 0");
    says(among("", 0.1, "", &turned), 0, "step 2");
    says(among(", wrist = { velocity = 1 }", 0.1, "", &turned), 3, "carried where nothing is");
    says(among("", 0.1, "payload = \"rigid\"", STEPS), 0, "step 2");
    let after = STEPS.replacen("[[step]]\nplace", "[[step]]\nmove = { joints = [1, 1] }\n[[step]]\nplace", 1);
    let third = format!(r#"{{{}, "boxes": [{}]}}"#, FROM.replace("2,", "3,"), boxes().join(", "));
    let after = |payload: &str| world("", 0.1, payload, &after);
    let certificate_of_third = certificate(SHAPES, &third);
    says(turning(&after("payload = \"rigid\""), &certificate_of_third), 3, "carried where nothing is");
    says(judged(&after("payload = \"rigid\""), &certificate_of_third), 0, "step 3");
    says(judged(&after(""), &certificate_of_third), 0, "step 3");
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
    says(turning(&rigid, &certificate(4, [3.0, 1.0], 2.0)), 3, "not known to stand anywhere");
    says(judged(&rigid, &certificate(4, [3.0, 1.0], 2.0)), 0, "up to step 4");
}

/// Two blocks that change places, in any order, and then the head goes somewhere.
fn swap(task: &str, [a, b]: [[f64; 2]; 2], after: &str) -> String {
    let block = |name: &str, at: [f64; 2], to: [f64; 2]| {
        let object = format!(
            "[[object]]\nname = \"{name}\"\nat = {at:?}\npolygon = [[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, 0.1]]\n"
        );
        let steps = format!("[[step.steps]]\npick = \"{name}\"\n[[step.steps]]\nplace = {{ at = {to:?} }}\n");
        [object, steps]
    };
    let [first, second] = [block("a", [1.0, 1.0], a), block("b", [3.0, 1.0], b)];
    format!(
        "robot = {{ payload = \"level\" }}\nstart.joints = [0, 1]\n{}{}[[step]]\n{task}\n{}{}{after}",
        first[0], second[0], first[1], second[1]
    )
}

/// A case of a step in which the configurations about a place are not free.
fn about(step: usize, after: &str, from: &str, [x, y]: [f64; 2], shape: usize, part: usize) -> String {
    let [lower, upper] = [[x - 0.01, y - 0.01], [x + 0.01, y + 0.01]];
    format!(
        r#"{{"step": {step}, {after} {from} "boxes": [{{"lower": {lower:?}, "upper": {upper:?}, "shape": {shape}, "part": {part}}}]}}"#
    )
}

/// The rectangle about a place.
fn from([x, y]: [f64; 2]) -> String {
    format!(r#""from": [[{}, {}], [{}, {}]],"#, x - 1e-6, x + 1e-6, y - 1e-6, y + 1e-6)
}

const HEAD: &str = r#"{"link": "head", "collision": 0}"#;

/// About a block that is carried (shape 0) or the head (shape 1), and obstacles that lie somewhere.
fn among_blocks(lying: &[(usize, [f64; 2])], cases: &[String]) -> String {
    let part = |(obstacle, [x, y]): &(usize, [f64; 2])| {
        let corners = [[x - 0.1, y - 0.1], [x + 0.1, y - 0.1], [x + 0.1, y + 0.1], [x - 0.1, y + 0.1]];
        format!(r#"{{"obstacle": {obstacle}, "corners": {corners:?}}}"#)
    };
    format!(
        r#"{{"format": "cplan certificate 1", "answer": "infeasible",
        "shapes": [{{"carried": [[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, 0.1]]}}, {HEAD}],
        "parts": [{}], "cases": [{}]}}"#,
        lying.iter().map(part).collect::<Vec<_>>().join(", "),
        cases.join(", ")
    )
}

const A: [f64; 2] = [1.0, 1.0];
const B: [f64; 2] = [3.0, 1.0];

/// What does not depend on the order holds in whichever.
#[test]
fn a_block_does_not_pass_a_gap_in_whichever_order() {
    let case = format!(r#"{{{FROM}, "boxes": [{}]}}"#, boxes().join(", "));
    let other = |number: usize, [x, y]: [f64; 2]| {
        let object = "circle = { center = [0, 0], radius = 0.05 }";
        (
            format!("[[object]]\nname = \"other {number}\"\nat = {:?}\n{object}\n", [x, y]),
            format!("[[step]]\npick = \"other {number}\"\n[[step]]\nplace = {{ at = {:?} }}\n", [x, y + 0.2]),
        )
    };
    for count in [0, 1, 12] {
        let others: Vec<_> = (0..count).map(|k| other(k, [0.1 * k as f64, 1.5])).collect();
        let (objects, steps): (Vec<_>, Vec<_>) = others.into_iter().unzip();
        let pair = &STEPS[..STEPS.rfind("[[step]]").unwrap()];
        let free = |gap| {
            format!(
                "task.order = \"free\"\n{}{}",
                world("", gap, "", &objects.concat()),
                [pair, &steps.concat()].concat()
            )
        };
        let last = format!("up to step {}", 2 * count + 2);
        says(judged(&free(0.1), &certificate(SHAPES, &case)), 0, &last);
        says(judged(&free(0.25), &certificate(SHAPES, &case)), 3, "can come off the part");
    }
}

/// What is in free order is tried in all orders, those that are barred at once left out.
#[test]
fn two_blocks_do_not_change_places() {
    let cases = [about(2, r#""after": [],"#, &from(A), B, 0, 1), about(4, r#""after": [],"#, &from(B), A, 0, 0)];
    let free = |to: [[f64; 2]; 2]| swap("order = \"free\"", to, "");
    says(judged(&free([B, A]), &among_blocks(&[(0, A), (1, B)], &cases)), 0, "up to step 4");
    // Either may go first if it goes elsewhere, ...
    says(judged(&free([[2.0, 1.0], A]), &among_blocks(&[(0, A), (1, B)], &cases)), 3, "leave open");
    says(judged(&free([B, [2.0, 1.0]]), &among_blocks(&[(0, A), (1, B)], &cases)), 3, "leave open");
    // ... and each order has to be ruled out.
    for case in 0..2 {
        says(judged(&free([B, A]), &among_blocks(&[(0, A), (1, B)], &cases[case..=case])), 3, "leave open");
    }
    // In whichever order that does not hold: the other one may have gone, and its own place is another one's by then.
    let whichever = cases.each_ref().map(|case| case.replace(r#""after": [],"#, ""));
    says(judged(&free([B, A]), &among_blocks(&[(0, A), (1, B)], &whichever)), 3, "not known to stand anywhere");
    for (after, why) in [("[1]", "leave open"), ("[1, 3]", "leave open"), ("[3]", "its corners are not those")] {
        let case = about(2, &format!("\"after\": {after},"), &from(A), B, 0, 1);
        says(judged(&free([B, A]), &among_blocks(&[(0, A), (1, B)], &[case])), 3, why);
    }
    // In the order of the file there is nothing before.
    let fixed = swap("order = \"fixed\"", [B, A], "");
    says(judged(&fixed, &among_blocks(&[(0, A), (1, B)], &cases)), 3, "leave open");
    says(judged(&fixed, &among_blocks(&[(0, A), (1, B)], &[whichever[0].clone()])), 0, "up to step 2");
}

/// What rules out orders rules out where the arm may be after them, but only the first time.
#[test]
fn what_holds_the_first_time_need_not_hold_the_last() {
    // The second block goes where the first lies: that one has to go first, and the second is let go of last.
    let places = [[1.5, 1.0], A];
    let world = |task: &str| swap(task, places, "[[step]]\nmove = { joints = [1.5, 1.1] }\n");
    let certificate = |cases: &[String]| among_blocks(&[(0, A), (0, [1.5, 1.0])], cases);
    // The head does not go where the first block lies then.
    let second_first = about(4, r#""after": [],"#, &from(B), A, 0, 0);
    let from_second = about(5, "", &from(A), [1.5, 1.1], 1, 1);
    let cases = [second_first, from_second];
    let once = world("order = \"free\"");
    says(judged(&once, &certificate(&cases)), 0, "up to step 5");
    says(judged(&once, &certificate(&cases[1..])), 3, "step 5 may begin where no case does");
    // The second time either may be last, so that the head may be free to meet either.
    let twice = world("order = \"free\"\nrepeat = 2");
    says(judged(&twice, &certificate(&cases)), 3, "step 5 may begin where no case does");
    let all = [&cases[..], &[about(5, "", &from([1.5, 1.0]), [1.5, 1.1], 1, 1)]].concat();
    says(judged(&twice, &certificate(&all)), 3, "the shape may meet the obstacle");
}

/// The last step leaves the arm in a place where it cannot stay.
#[test]
fn the_arm_stays_where_the_last_step_ends() {
    // The bridge, which is no part of the second link, may not be above the block once that has been let go of.
    let robot = GANTRY.replace(
        "<link name=\"bridge\"/>",
        "<link name=\"bridge\"> <collision> <origin xyz=\"0 1 0\"/> <geometry> <box size=\"0.1 0.1 0.1\"/> </geometry> </collision> </link>",
    );
    let world = |x: f64| {
        format!(
            "robot = {{ payload = \"level\" }}\nstart.joints = [0, 1]\n[[object]]\nname = \"block\"\nat = [1, 0.5]\n\
             polygon = [[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, 0.1]]\n[[step]]\npick = \"block\"\n[[step]]\nplace = {{ at = [{x}, 1] }}\n"
        )
    };
    let certificate = |step: usize| {
        let case = about(step, "", &from([2.0, 1.0]), [2.0, 1.0], 0, 0);
        format!(
            r#"{{"format": "cplan certificate 1", "answer": "infeasible", "shapes": [{{"link": "bridge", "collision": 0}}],
            "parts": [{{"obstacle": 0, "corners": [[1.9, 0.9], [2.1, 0.9], [2.1, 1.1], [1.9, 1.1]]}}], "cases": [{case}]}}"#
        )
    };
    says(of_robot(&robot, &world(2.0), &certificate(3)), 0, "up to step 2");
    // Nor is there anything after that, nor does it lie there before.
    says(of_robot(&robot, &world(2.0), &certificate(4)), 3, "leave open");
    says(of_robot(&robot, &world(2.0), &certificate(2)), 3, "step 2 may begin where no case does");
    says(of_robot(&robot, &world(2.5), &certificate(3)), 3, "step 3 may begin where no case does");
    // The head may be there.
    says(judged(&world(2.0), &certificate(3).replace("bridge", "head")), 3, "the shape may meet the obstacle");
    // Further steps begin there.
    let moved = world(2.0) + "[[step]]\nmove = { joints = [0, 0] }\n";
    says(of_robot(&robot, &moved, &certificate(3)), 0, "up to step 3");
    says(of_robot(&robot, &moved, &certificate(4)), 3, "leave open");
}

/// Where a pick is repeated and the place after it is not, the arm may be on its way to another place, and touch what supports the block there.
#[test]
fn what_a_repeated_pick_places_may_rest_on_what_either_place_says() {
    let steps = |repeat: usize| {
        format!(
            "[[step]]\npick = \"block\"\n[[step]]\nrepeat = {repeat}\n[[step.steps]]\nplace = {{ at = [0.5, 1], supports = [\"sill\"] }}\n\
             [[step.steps]]\npick = \"block\"\n[[step]]\nplace = {{ at = [3, 1] }}\n"
        )
    };
    // 0.25 m would do if no clearance were kept from the sill.
    let clear = |repeat: usize| "clearance = 0.05\n".to_owned() + &world("", 0.27, "", &steps(repeat));
    let boxes = (0..1000).map(|k| {
        let [low, high] = [0.002 * f64::from(k), 0.002 * f64::from(k + 1)];
        format!(r#"{{"lower": [1.999, {low}], "upper": [2.001, {high}], "shape": 0, "part": {}}}"#, k / 500)
    });
    let boxes = boxes.collect::<Vec<_>>().join(", ");
    let case = format!(r#"{{"step": 4, "from": [[0.499999, 0.500001], [0.999999, 1.000001]], "boxes": [{boxes}]}}"#);
    let certificate =
        certificate(SHAPES, "CASE").replace("0.95", "0.865").replace("1.05", "1.135").replace("CASE", &case);
    says(judged(&clear(1), &certificate), 0, "up to step 4");
    says(judged(&clear(2), &certificate), 3, "can come off the part");
}

/// A block that is turned upright and put into the gap leaves the head no way; one that is taken anew lies flat.
#[test]
fn a_repetition_finds_a_new_object_as_it_lay_at_first() {
    let world = |renew: &str| {
        let steps = "[[step]]\npick = \"block\"\n[[step]]\nplace = { at = [0.5, 1], angle = 1.5707963 }\n[[step]]\nrepeat = 2\n\
                     [[step.steps]]\npick = \"block\"\n[[step.steps]]\nplace = { at = [2, 1] }\n\
                     [[step]]\nmove = { joints = [1, 1] }\n[[step]]\nmove = { joints = [3, 1] }\n";
        world(", wrist = { velocity = 1 }", 0.5, renew, steps)
    };
    let boxes = (0..100).map(|k| {
        let [low, high] = [0.02 * f64::from(k), 0.02 * f64::from(k + 1)];
        let part = if high <= 0.79 {
            0
        } else if low >= 1.21 {
            1
        } else {
            2
        };
        format!(r#"{{"lower": [1.99, {low}], "upper": [2.01, {high}], "shape": 0, "part": {part}}}"#)
    });
    let boxes = boxes.collect::<Vec<_>>().join(", ");
    let certificate = format!(
        r#"{{"format": "cplan certificate 1", "answer": "infeasible", "shapes": [{{"link": "head", "collision": 0}}], "parts": [
        {{"obstacle": 0, "corners": [[1.9, -1], [2.1, -1], [2.1, 0.75], [1.9, 0.75]]}},
        {{"obstacle": 1, "corners": [[1.9, 1.25], [2.1, 1.25], [2.1, 3], [1.9, 3]]}},
        {{"obstacle": 2, "corners": [[1.9, 0.8], [2.1, 0.8], [2.1, 1.2], [1.9, 1.2]]}}],
        "cases": [{{"step": 6, "from": [[0.999999, 1.000001], [0.999999, 1.000001]], "boxes": [{boxes}]}}]}}"#
    );
    says(judged(&world(""), &certificate), 0, "up to step 6");
    says(judged(&world("renew = true"), &certificate), 3, "can come off the part");
}

/// The head may touch what it has let go of until the arm goes on from where it has picked something else.
#[test]
fn the_arm_may_stay_where_it_picks_last() {
    let world = |last: &str| {
        format!(
            "robot = {{ payload = \"level\" }}\nstart.joints = [0, 0]\n\
             [[object]]\nname = \"a\"\ncircle = {{ center = [0, 0], radius = 0.1 }}\nat = [0.5, 0.5]\n\
             [[object]]\nname = \"b\"\ncircle = {{ center = [0, 0], radius = 0.01 }}\nat = [1, 1.12]\n\
             [[step]]\npick = \"a\"\n[[step]]\nplace = {{ at = [1, 1] }}\n[[step]]\npick = \"b\"\n{last}"
        )
    };
    let certificate = r#"{"format": "cplan certificate 1", "answer": "infeasible", "shapes": [{"link": "head", "collision": 0}],
        "parts": [{"obstacle": 0}], "cases": [{"step": 4, "from": [[0.999, 1.001], [1.119, 1.121]],
        "boxes": [{"lower": [0.998, 1.118], "upper": [1.002, 1.122], "shape": 0, "part": 0}]}]}"#;
    says(judged(&world(""), certificate), 3, "leave open");
    // It cannot go on from there.
    says(judged(&world("[[step]]\nmove = { joints = [3, 1] }\n"), certificate), 0, "up to step 4");
}

/// The head reaches 0.0707 m, so that corners may be 7.07e-6 m deep in the table, and sides 5e-6 m.
#[test]
fn a_block_presses_into_its_support_no_deeper_than_it_may() {
    let pressed = |depth: f64, supports: &str| {
        let at = [3.0, 0.1 - depth];
        let world = format!(
            "robot = {{ payload = \"level\" }}\nclearance = 0.01\nstart.joints = [0, 1]\n[[obstacle]]\nname = \"table\"\n             polygon = [[0, -1], [4, -1], [4, 0], [0, 0]]\n[[object]]\nname = \"block\"\nat = [1, 1]\n             polygon = [[-0.2, -0.1], [0.2, -0.1], [0.2, 0.1], [-0.2, 0.1]]\n{supports}\n[[step]]\npick = \"block\"\n             [[step]]\nplace = {{ at = {at:?} }}\n"
        );
        let [lower, upper] = [-1e-7, 1e-7].map(|by| at.map(|c| c + by));
        let certificate = format!(
            r#"{{"format": "cplan certificate 1", "answer": "infeasible", "shapes": [{SHAPES}],
            "parts": [{{"obstacle": 0, "corners": [[0, -1], [4, -1], [4, 0], [0, 0]]}}],
            "cases": [{{{FROM}, "boxes": [{{"lower": {lower:?}, "upper": {upper:?}, "shape": 0, "part": 0}}]}}]}}"#
        );
        judged(&world, &certificate)
    };
    let rests = "supports = [\"table\"]";
    says(pressed(6e-6, rests), 0, "up to step 2");
    says(pressed(4.5e-6, rests), 3, "can come off the part");
    // No clearance is kept from what supports it.
    says(pressed(-9e-3, ""), 0, "up to step 2");
    says(pressed(-9e-3, rests), 3, "can come off the part");
}

/// A slide along x that carries a lever, 0.6 m by 0.05 m, which turns about a point of it 0.1 m from its end; the tip is at the other end.
const LEVER: &str = r#"<robot name="l">
  <link name="base"/>
  <joint name="x" type="prismatic">
    <parent link="base"/> <child link="slide"/> <axis xyz="1 0 0"/> <limit lower="0" upper="4"/>
  </joint>
  <link name="slide"/>
  <joint name="q" type="revolute">
    <parent link="slide"/> <child link="lever"/> <axis xyz="0 0 1"/> <limit lower="-1.5" upper="1.5"/>
  </joint>
  <link name="lever">
    <collision> <origin xyz="0.2 0 0"/> <geometry> <box size="0.6 0.05 0.1"/> </geometry> </collision>
  </link>
  <joint name="t" type="fixed"> <parent link="lever"/> <child link="tool"/> <origin xyz="0.5 0 0"/> </joint>
  <link name="tool"/>
</robot>"#;

/// A bar is taken at q = 0 and let go of at q = 30 deg, turned so: half of it, if that is 0.6 m long, lies across the slide's way.
#[test]
fn what_has_been_turned_bars_the_way() {
    let world = |half: f64, place: &str| {
        format!(
            "start.joints = [0, 0]\n\
             [[object]]\nname = \"bar\"\nat = [1.5, 0]\n\
             polygon = [[-{half}, -0.05], [{half}, -0.05], [{half}, 0.05], [-{half}, 0.05]]\n\
             [[step]]\npick = \"bar\"\n[[step]]\nplace = {{ at = [2, 0.25]{place} }}\n\
             [[step]]\nmove = {{ joints = [0, -1] }}\n[[step]]\nmove = {{ joints = [3, -1] }}\n"
        )
    };
    let ((sine, cosine), x) = (30_f64.to_radians().sin_cos(), 2.0 - 0.5 * 30_f64.to_radians().cos());
    let about = |[x, y]: [f64; 2], by: f64| format!("[[{:?}, {:?}], [{:?}, {:?}]]", x - by, x + by, y - by, y + by);
    let (taken, placed) = (about([1.0, 0.0], 1e-6), about([x, 30_f64.to_radians()], 1e-4));
    let corner = |[u, v]: [f64; 2]| format!("[{:?}, {:?}]", 2.0 + cosine * u - sine * v, 0.25 + sine * u + cosine * v);
    let bar = |half: f64| [[-half, -0.05], [half, -0.05], [half, 0.05], [-half, 0.05]].map(corner).join(", ");
    let boxes: Vec<String> = (0..60)
        .map(|k| {
            let [low, high] = [k, k + 1].map(|k| -1.5 + 0.05 * f64::from(k));
            format!(r#"{{"lower": [{}, {low}], "upper": [{}, {high}], "shape": 0, "part": 0}}"#, x - 0.004, x + 0.004)
        })
        .collect();
    let certificate = |half: f64, turned: [&str; 2]| {
        let told =
            turned.map(|ends| if ends.is_empty() { String::new() } else { format!(r#""turned": [[{ends}]], "#) });
        format!(
            r#"{{"format": "cplan certificate 1", "answer": "infeasible", "shapes": [{{"link": "lever", "collision": 0}}],
                "parts": [{{"obstacle": 0, "corners": [{}]}}], "cases": [
                {{"step": 2, "from": {taken}, "boxes": []}}, {{"step": 3, {}"from": {placed}, "boxes": []}},
                {{"step": 4, {}"from": {}, "boxes": [{}]}}]}}"#,
            bar(half),
            told[0],
            told[1],
            about([0.0, -1.0], 1e-6),
            boxes.join(", ")
        )
    };
    let judged =
        |half: f64, place: &str, told: [&str; 2]| of_robot(LEVER, &world(half, place), &certificate(half, told));
    let ends = format!("{taken}, {placed}");
    says(judged(0.6, "", [&ends; 2]), 0, "does the steps up to step 4");
    // What is not told is not known, and no case is about what was carried from or to elsewhere.
    says(judged(0.6, "", [""; 2]), 3, "not known to stand anywhere");
    for other in [format!("{}, {placed}", about([1.0, 0.0], 1e-7)), format!("{taken}, {taken}")] {
        says(judged(0.6, "", [&ends, &other]), 3, "leave open that all steps are done");
    }
    // A shorter bar ends before it crosses the way, and one that is to lie straight is not let go of turned.
    says(judged(0.4, "", [&ends; 2]), 3, "can come off the part");
    says(judged(0.6, ", angle = 0", [&ends; 2]), 3, "");
}

#[test]
fn bad_input_is_named() {
    let case = format!(r#"{{{FROM}, "boxes": [{}]}}"#, boxes().join(", "));
    let certificate = certificate(SHAPES, &case);
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
