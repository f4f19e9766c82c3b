//! Certificates of tasks, written by hand, and falsified ones.

use crate::common::gantry::{GANTRY, judge_steps};
use crate::common::robots::two_bars;
use crate::common::verdict::{Verdict, agrees, code, done, fails, holds, judge as judge_certificate, refused};

/// Returns a gantry with the tip at the joints' values. It has a small head, on an even smaller bridge.
fn gantry() -> String {
    let low = GANTRY.replace("<origin xyz=\"0 0 1\"/> <geometry> <box", "<geometry> <box");
    let bridge =
        "<link name=\"bridge\"> <collision> <geometry> <box size=\"0.02 0.02 0.02\"/> </geometry> </collision> </link>";
    low.replace("<link name=\"bridge\"/>", bridge)
}

const HEAD: &str =
    "robot = { joints = [\"x\", \"y\"], payload = \"level\", wrist = { velocity = 1 } }\nstart.joints = [0, 1]\n";
const BLOCK: &str =
    "[[object]]\nname = \"block\"\nat = [1, 1]\npolygon = [[-0.2, -0.1], [0.2, -0.1], [0.2, 0.1], [-0.2, 0.1]]\n";
const STEPS: &str =
    "[[step]]\npick = \"block\"\n[[step]]\nplace = { at = [3, 1] }\n[[step]]\nmove = { joints = [3, 2] }\n";
const KNOTS: &str = "[0, 0, 1], [1, 1, 1], [2, 1, 1], [3, 3, 1], [4, 3, 1], [5, 3, 2]";
const DONE: &str = r#"{"step": 1, "knots": [0, 1]}, {"step": 2, "knots": [2, 3]}, {"step": 3, "knots": [4, 5]}"#;

/// Checks a certificate for the gantry.
fn judge(world: &str, knots: &str, steps: &str) -> Verdict {
    judge_steps(&gantry(), world, knots, steps)
}

/// Checks a certificate for the block that is carried from (1, 1) to (3, 1), in a world with additional content.
fn judge_carried_block(more: &str) -> Verdict {
    judge(&format!("{HEAD}{BLOCK}{more}{STEPS}"), KNOTS, DONE)
}

#[test]
fn a_block_is_carried() {
    let report = holds(judge_carried_block(""));
    assert!(report.starts_with("a motion of \"x\" and \"y\" does all 3 steps from the start on"), "{report}");
}

#[test]
fn every_step_is_done_once_and_in_its_order() {
    let world = format!("{HEAD}{BLOCK}{STEPS}");
    let with = |steps: &str| judge(&world, KNOTS, steps);
    let [one, two, three] = <[&str; 3]>::try_from(DONE.split(", {").collect::<Vec<_>>()).unwrap();
    let [two, three] = [two, three].map(|step| format!("{{{step}"));
    fails(with(&format!("{one}, {two}")), "requires step 3 next, but the certificate ends");
    fails(with(&format!("{one}, {three}")), "steps[1] is step 3, but the world requires step 2");
    fails(with(&format!("{two}, {one}, {three}")), "steps[0] is step 2");
    fails(with(&format!("{DONE}, {three}")), "has no further steps");
    fails(with(""), "requires step 1");
    fails(with(&DONE.replace("[2, 3]", "[1, 2]")), "the arm moves after knot 2, outside all steps");
    fails(with(&DONE.replace("[0, 1]", "[0, 2]").replace("[2, 3]", "[1, 3]")), "steps[1] begins before");
    fails(with(&DONE.replace("[4, 5]", "[4, 6]")), "steps[2] ends before");
    fails(with(&DONE.replace("[2, 3]", "[3, 2]").replace("[0, 1]", "[0, 3]")), "steps[1] ends before");
    refused(judge(&format!("{HEAD}goal.joints = [3, 2]\n{BLOCK}"), KNOTS, DONE), "it has no steps");
    let goal = done(KNOTS, DONE).replacen("\"steps\"", "\"goal\": [3, 2], \"steps\"", 1);
    assert_eq!(code(&gantry(), &world, &goal), 1);
}

#[test]
fn places_match_the_request_within_tolerance() {
    let world = format!("{HEAD}{BLOCK}{STEPS}");
    let at = |old: &str, new: &str| judge(&world, &KNOTS.replace(old, new), DONE);
    assert!(holds(at("1, 1, 1], [2, 1, 1]", "1, 1.000009, 1], [2, 1.000009, 1]")).contains("within 1e-5"));
    for [old, new] in [
        ["1, 1, 1], [2, 1, 1]", "1, 1.000011, 1], [2, 1.000011, 1]"],
        ["3, 1], [4, 3, 1]", "3, 1.000011], [4, 3, 1.000011]"],
        ["3, 2]", "3.000011, 2]"],
        ["[0, 0, 1]", "[0, 0.000011, 1]"],
    ] {
        fails(at(old, new), "by more than 1e-5");
    }
    // An object that is picked beside its intended point ends up beside its target.
    fails(
        at(
            "1, 1, 1], [2, 1, 1], [3, 3, 1], [4, 3, 1]",
            "1, 1.000009, 1], [2, 1.000009, 1], [3, 2.999994, 1], [4, 2.999994, 1]",
        ),
        "step 2",
    );
    fails(at("[4, 3, 1]", "[4, 3, 1.0000001]"), "the arm moves");
}

#[test]
fn payloads_avoid_obstacles_that_the_arm_clears() {
    for (y, is_free) in [(0.79, true), (0.81, false)] {
        let post = format!("[[obstacle]]\ncircle = {{ center = [2, {y}], radius = 0.1 }}\n");
        agrees(judge_carried_block(&post), is_free, "steps[1], step 2: after knot 2, the payload");
        let other =
            format!("[[object]]\nname = \"other\"\ncircle = {{ center = [0, 0], radius = 0.1 }}\nat = [2, {y}]\n");
        agrees(judge_carried_block(&other), is_free, "");
    }
    // 0.1 m from the tip's path: the clearance decides.
    let wall = "[[obstacle]]\npolyline = [[2.5, 0.8], [3.5, 0.8]]\n";
    holds(judge_carried_block(wall));
    let world = |clearance: &str| format!("clearance = {clearance}\n{HEAD}{BLOCK}{wall}{STEPS}");
    holds(judge(&world("0.0999"), KNOTS, DONE));
    fails(judge(&world("0.1"), KNOTS, DONE), "farther than 0.1 from obstacle 0");
}

#[test]
fn only_the_second_link_may_touch_the_target() {
    // The bridge runs along y = 0. The carried object may touch it.
    let head = HEAD.replace("wrist =", "own_body = false, wrist =");
    let low = |y: f64| {
        let world = format!("{head}{BLOCK}{STEPS}").replace("[1, 1]", &format!("[1, {y}]"));
        judge(&world, &KNOTS.replace("1, 1, 1], [2, 1, 1]", &format!("1, 1, {y}], [2, 1, {y}]")), DONE)
    };
    holds(low(0.2));
    fails(low(0.1), "link \"bridge\", collision 0 is not proven");
    // The head may leave the place of the released object once, but not return.
    let more = "[[step]]\nmove = { joints = [3, 1] }\n";
    let world = format!("{HEAD}{BLOCK}{STEPS}{more}");
    let knots = format!("{KNOTS}, [6, 3, 2], [7, 3, 1]");
    let done = format!("{DONE}, {{\"step\": 4, \"knots\": [6, 7]}}");
    fails(judge(&world, &knots, &done), "steps[3], step 4: after knot 6, link \"head\"");
    // The last step may end inside the released object, but not with the bridge inside it.
    let placed = |y: f64| {
        let steps = STEPS.split("[[step]]\nmove").next().unwrap().replace("[3, 1]", &format!("[3, {y}]"));
        let knots = KNOTS.split(", [4").next().unwrap().replace("[3, 3, 1]", &format!("[3, 3, {y}]"));
        judge(&format!("{head}{BLOCK}{steps}"), &knots, DONE.split(", {\"step\": 3").next().unwrap())
    };
    holds(placed(0.2));
    fails(placed(0.1), "step 2");
}

/// Tests the allowed penetration. The bridge reaches 1.01 m, so 0.101 mm are allowed, and 0.0714 mm beside right
/// angles.
#[test]
fn supported_objects_press_within_the_allowance() {
    let on = |deep: f64, supports: &str| {
        let table = format!(
            "[[obstacle]]\nname = \"table\"\npolygon = [[-5, 0], [9, 0], [9, {}], [-5, {}]]\n",
            0.9 + deep,
            0.9 + deep
        );
        let flat = gantry().replace(
            "<link name=\"bridge\"> <collision> <geometry>",
            "<link name=\"bridge\"> <collision> <origin xyz=\"0 -1 0\"/> <geometry>",
        );
        let block = BLOCK.replace("at =", &format!("{supports}\nat ="));
        judge_steps(&flat, &format!("{HEAD}{block}{table}{STEPS}"), KNOTS, DONE)
    };
    let table = "supports = [\"table\"]";
    holds(on(0.0, table));
    holds(on(7.1e-5, table));
    fails(on(7.2e-5, table), "within the allowed depth in obstacle 0");
    for supports in ["", "supports = []"] {
        holds(on(-1e-9, supports));
        fails(on(0.0, supports), "the payload");
    }
    refused(on(0.0, "supports = [\"tablet\"]"), "no obstacle and no object of this name");
}

#[test]
fn the_wrist_turns_the_payload() {
    let world = |more: &str| format!("{HEAD}{BLOCK}{more}{STEPS}").replace("[3, 1] }", "[3, 1], angle = 1.5708 }");
    let turned = |by: &str| DONE.replace("[2, 3]", &format!("[2, 3], \"turn\": {by}"));
    holds(judge(&world(""), KNOTS, &turned("1.5708")));
    holds(judge(&world(""), KNOTS, &turned("-4.712385307")));
    fails(judge(&world(""), KNOTS, DONE), "by more than 1e-5");
    fails(judge(&world(""), KNOTS, &turned("1.57082")), "by more than 1e-5");
    for round in ["7.853981634", "-7000000", "1e300"] {
        fails(judge(&world(""), KNOTS, &turned(round)), "by more than one revolution");
    }
    let level = |world: String| judge(&world, KNOTS, &turned("1.5708"));
    fails(level(world("").replace(", wrist = { velocity = 1 }", "")), "there is no wrist");
    fails(level(world("").replace("\"level\"", "\"rigid\"")), "there is no wrist");
    // A corner sweeps past at 0.2236 m from the tip, at 26.6 degrees from each end.
    for (far, is_free) in [(0.2237, true), (0.2235, false)] {
        let [x, y] = [3.0 + far * 0.8, 1.0 + far * 0.6];
        let post = format!("[[obstacle]]\ncircle = {{ center = [{x}, {y}], radius = 1e-9 }}\n");
        agrees(level(world(&post)), is_free, "");
    }
    // Turned where it is picked, it is carried upright.
    let tall = "[[obstacle]]\ncircle = { center = [2, 1.2], radius = 0.05 }\n";
    holds(level(world(tall)));
    let before = DONE.replace("[0, 1]", "[0, 1], \"turn\": 1.5708");
    fails(judge(&world(tall), KNOTS, &before), "the payload");
    holds(judge(&world(""), KNOTS, &before));
}

/// Tests an arm that picks an object at (1.8, 0) when it is stretched out, and turns by a quarter. The object ends up
/// at (0, 1.8), turned by a quarter.
#[test]
fn rigid_payloads_turn_with_the_arm() {
    let world = |angle: &str, post: f64| {
        format!(
            "start.joints = [0, 0.5]\n[[object]]\nname = \"bar\"\nat = [1.8, 0]\npolygon = [[0, -0.01], [0.3, -0.01], [0.3, 0.01], [0, 0.01]]\n\
             [[obstacle]]\ncircle = {{ center = [0, {post}], radius = 0.01 }}\n[[step]]\npick = \"bar\"\n\
             [[step]]\nplace = {{ at = [0, 1.8]{angle} }}\n"
        )
    };
    let quarter = "1.5707963267948966";
    let knots = format!("[0, 0, 0.5], [1, 0, 0], [2, {quarter}, 0]");
    let done = r#"{"step": 1, "knots": [0, 1]}, {"step": 2, "knots": [1, 2]}"#;
    let with = |world: &str| judge_steps(&two_bars(), world, &knots, done);
    holds(with(&world("", 2.2)));
    holds(with(&world(&format!(", angle = {quarter}"), 2.2)));
    holds(with(&world(", angle = \"90deg\"", 2.2)));
    fails(with(&world(", angle = 1.5708", 2.2).replace("1.5708", "1.5709")), "by more than 1e-5");
    fails(with(&world("", 2.105)), "the payload");
    // If a wrist keeps it level, its end does not reach there.
    holds(with(&world("", 2.105).replacen("start", "robot.payload = \"level\"\nstart", 1)));
}

/// Tests three discs that are moved from one pallet to another, in any order, by pairs.
#[test]
fn pairs_may_come_in_any_order() {
    let pallet = |name: &str, y: f64| {
        format!("[[pallet]]\nname = \"{name}\"\nrows = 1\ncolumns = 3\npitch = [1, 0]\nat = [1, {y}]\n")
    };
    let world = |order: &str| {
        format!(
            "{HEAD}{}{}[[object]]\nname = \"pin\"\npallet = \"feeder\"\ncircle = {{ center = [0, 0], radius = 0.02 }}\n\
             [task]\norder = \"{order}\"\n[[step]]\ntransfer = {{ objects = \"pin\", to = \"tray\" }}\n",
            pallet("feeder", 1.0),
            pallet("tray", 2.0)
        )
    };
    // Each is reached from above, and the arm returns upwards: nothing lies at y = 3.
    let carried = |order: &[usize]| {
        let (mut knots, mut steps) = (vec!["[0, 0, 1]".to_owned(), "[1, 0, 0.5]".into()], Vec::new());
        for &k in order {
            let (x, first) = (k as f64 + 1.0, knots.len() - 1);
            let time = |more: usize| first + 1 + more;
            knots.push(format!("[{}, {x}, 0.5]", time(0)));
            knots.push(format!("[{}, {x}, 1]", time(1)));
            knots.push(format!("[{}, {x}, 2]", time(2)));
            knots.push(format!("[{}, {}, 2]", time(3), x + 0.5));
            knots.push(format!("[{}, {}, 0.5]", time(4), x + 0.5));
            steps.push(format!(
                "{{\"step\": {}, \"knots\": [{}, {}]}}",
                2 * k + 1,
                if steps.is_empty() { 0 } else { first - 2 },
                first + 2
            ));
            steps.push(format!("{{\"step\": {}, \"knots\": [{}, {}]}}", 2 * k + 2, first + 2, first + 3));
        }
        knots.truncate(knots.len() - 2);
        (knots.join(", "), steps.join(", "))
    };
    let with = |order: &str, k: &[usize]| {
        let (knots, steps) = carried(k);
        judge(&world(order), &knots, &steps)
    };
    holds(with("fixed", &[0, 1, 2]));
    for order in [[0, 1, 2], [2, 0, 1], [1, 2, 0], [2, 1, 0]] {
        holds(with("free", &order));
    }
    fails(with("fixed", &[1, 0, 2]), "steps[0] is step 3, but the world requires step 1");
    fails(with("free", &[0, 1, 1]), "but the world requires step 5");
    fails(with("free", &[0, 1]), "requires step 5 next");
}

#[test]
fn repetitions_find_a_new_object_where_it_is_renewed() {
    let world = |renew: &str| {
        format!(
            "{HEAD}{BLOCK}{renew}[task]\nrepeat = 2\n[[step]]\npick = \"block\"\n[[step]]\nplace = {{ at = [3, 1] }}\n"
        )
    };
    let again = "[0, 0, 1], [1, 1, 1], [2, 3, 1], [3, 3, 3], [4, 1, 3], [5, 1, 1], [6, 1, 2], [7, 3, 2], [8, 3, 1]";
    let steps = |last: &str| {
        format!(
            r#"{{"step": 1, "knots": [0, 1]}}, {{"step": 2, "knots": [1, 2]}}, {{"step": 1, "knots": [2, {last}]}}, {{"step": 2, "knots": [{last}, 8]}}"#
        )
    };
    // The first object lies at the target of the second: they are one object.
    holds(judge(&world("renew = true\n"), again, &steps("5")));
    fails(judge(&world(""), again, &steps("5")), "steps[2], step 1: the motion misses the target");
    // Without a new object, the same object is picked from where it lies.
    holds(judge(
        &world(""),
        "[0, 0, 1], [1, 1, 1], [2, 3, 1], [3, 3, 2], [4, 3, 1], [8, 3, 1]",
        &steps("4").replace("8]", "4]"),
    ));
}

/// Tests a head that passes through a new object. The new object has the index of the object that was just released.
#[test]
fn a_new_object_differs_from_the_released_one() {
    let side = "[[object]]\nname = \"pin\"\nat = [6, 5]\ncircle = { center = [0, 0], radius = 0.01 }\n";
    let world = |renew: &str| {
        format!(
            "{HEAD}{BLOCK}{renew}{side}[task]\nrepeat = 2\n[[step]]\nmove = {{ joints = [5, 1] }}\n[[step]]\npick = \"block\"\n             [[step]]\nplace = {{ at = [1, 1] }}\n"
        )
    };
    let knots = "[0, 0, 1], [1, 0, 3], [2, 5, 3], [3, 5, 1], [4, 5, 3], [5, 1, 3], [6, 1, 1], [7, 5, 1], [8, 1, 1]";
    let steps = r#"{"step": 1, "knots": [0, 3]}, {"step": 2, "knots": [3, 6]}, {"step": 3, "knots": [6, 6]},
                   {"step": 1, "knots": [6, 7]}, {"step": 2, "knots": [7, 8]}, {"step": 3, "knots": [8, 8]}"#;
    // The head may leave the released object, but no other.
    holds(judge(&world(""), knots, steps));
    fails(judge(&world("renew = true\n"), knots, steps), "link \"head\"");
}

/// Tests a bridge that overlaps an object after it is placed, and before a new one appears elsewhere.
#[test]
fn renewed_objects_stay_until_the_next_motion() {
    let head = HEAD.replace("wrist =", "own_body = false, wrist =");
    let world = format!(
        "{head}{BLOCK}renew = true\n[task]\nrepeat = 2\n[[step]]\npick = \"block\"\n[[step]]\nplace = {{ at = [3, 0.05] }}\n"
    );
    let knots = "[0, 0, 1], [1, 1, 1], [2, 3, 0.05], [3, 3, 0.05], [4, 1, 1], [5, 3, 0.05]";
    let steps = r#"{"step": 1, "knots": [0, 1]}, {"step": 2, "knots": [1, 2]}, {"step": 1, "knots": [3, 4]}, {"step": 2, "knots": [4, 5]}"#;
    fails(judge(&world, knots, steps), "steps[2], step 1: link \"bridge\", collision 0 is inside obstacle 0");
}

/// Tests a motion that, read as a cubic, continues at the end of a step. It does not rest there.
#[test]
fn the_arm_rests_where_a_step_ends() {
    let played = |speed: &str| {
        let knots = format!("[0, 0, 1, 0, 0], [1, 1, 1, {speed}, 0], [3, 3, 1, 0, 0], [5, 3, 2, 0, 0]");
        let steps = r#"{"step": 1, "knots": [0, 1]}, {"step": 2, "knots": [1, 2]}, {"step": 3, "knots": [2, 3]}"#;
        let certificate = done(&knots, steps).replace("linear", "cubic");
        judge_certificate(&gantry(), &format!("{HEAD}{BLOCK}{STEPS}"), &certificate)
    };
    holds(played("0"));
    for speed in ["0.5", "1e-300"] {
        fails(played(speed), "the arm still moves at the end of the step");
    }
}

/// Tests a wrist that turns the carried object about the tip, and a stroke that lowers it. Both carry the tip, and the
/// wrist's axis passes through it.
#[test]
fn the_tool_carries_the_tip() {
    let with = |wrist: &str, tip: &str| {
        let end = format!(
            "<link name=\"spindle\"/> <joint name=\"w\" type=\"revolute\"> <parent link=\"quill\"/> <child link=\"spindle\"/>
               <axis xyz=\"0 0 1\"/> <limit lower=\"-3\" upper=\"3\"/> </joint>
             <link name=\"flange\"/> <joint name=\"f\" type=\"fixed\"> <parent link=\"{wrist}\"/> <child link=\"flange\"/>
               <origin xyz=\"{tip} 0 -0.1\"/> </joint> </robot>"
        );
        let head = HEAD
            .replace("velocity = 1", "velocity = 1, joint = \"w\"")
            .replace("robot = {", "robot = { tip = \"flange\",");
        judge_steps(&gantry().replace("</robot>", &end), &format!("{head}{BLOCK}{STEPS}"), KNOTS, DONE)
    };
    holds(with("spindle", "0"));
    refused(with("spindle", "1e-5"), "does not pass through");
    refused(with("quill", "0"), "does not carry the tip");
}

#[test]
fn a_stroke_takes_the_tool_through_all_heights() {
    let world = |robot: &str, height: &str| {
        let head = HEAD.replace("wrist =", &format!("{robot} wrist ="));
        let block = BLOCK.replace("at =", "height = [0, 0.05]\nlift = 0.3\nat =");
        let shelf = format!(
            "[[obstacle]]\nheight = {height}\npolygon = [[2.9, 1.05], [3.1, 1.05], [3.1, 1.08], [2.9, 1.08]]\n"
        );
        format!("{head}{block}{shelf}{STEPS}")
    };
    let with = |robot: &str, height: &str| judge(&world(robot, height), KNOTS, DONE);
    let stroke = "stroke = { joint = \"z\" },";
    // Between where the object lies and where it is carried.
    holds(with("", "[0.1, 0.2]"));
    fails(with(stroke, "[0.1, 0.2]"), "the payload");
    // The quill's ball is at heights 0.49 to 0.51, and is lowered by 0.3 or by the stated travel.
    let beneath = |travel: &str| {
        let post = "[[obstacle]]\nheight = [0.3, 0.35]\ncircle = { center = [3, 1], radius = 0.001 }\n";
        let world = world(&format!("stroke = {{ joint = \"z\"{travel} }},"), "[7, 8]").replacen(
            "[[step]]",
            &format!("{post}[[step]]"),
            1,
        );
        // Carried as high as the post, the block would hit it.
        judge(&world.replace("lift = 0.3", "lift = 0.2"), KNOTS, DONE)
    };
    holds(beneath(", travel = 0.1"));
    holds(beneath(", travel = 0.13"));
    fails(beneath(", travel = 0.15"), "link \"quill\", collision 0");
    fails(beneath(""), "link \"quill\", collision 0");
    refused(with("stroke = { joint = \"y\" },", "[0.1, 0.2]"), "does not move the tool along the normal");
}

/// Tests that the target of an object must be free, however the object is lowered. Things beside it are allowed.
#[test]
fn placed_objects_are_free_without_a_stroke() {
    let lying = |at: f64, height: &str| {
        let block = BLOCK.replace("at =", "height = [-0.3, -0.25]\nlift = 0.15\nat =");
        let other = block.replace("\"block\"", "\"other\"").replace("at = [1, 1]", &format!("at = [{at}, 1]"));
        let other = other.replace("[-0.3, -0.25]", height);
        judge(&format!("{HEAD}{block}{other}{STEPS}"), KNOTS, DONE)
    };
    fails(lying(3.0, "[-0.3, -0.25]"), "step 2: obstacle 1 is inside the payload");
    fails(lying(3.39, "[-0.3, -0.25]"), "step 2");
    holds(lying(3.41, "[-0.3, -0.25]"));
    holds(lying(3.0, "[-0.24, -0.16]"));
}

#[test]
fn the_arm_rests_for_the_dwell() {
    let world = |dwell: &str| {
        format!("{HEAD}{BLOCK}{STEPS}").replacen("pick = \"block\"", &format!("pick = \"block\"\ndwell = {dwell}"), 1)
    };
    holds(judge(&world("1.0000009"), KNOTS, DONE));
    fails(judge(&world("1.000002"), KNOTS, DONE), "does not rest for 1.000002 s");
}

#[test]
fn nonconvex_objects_are_carried() {
    let block = |corners: &str| BLOCK.replace("[[-0.2, -0.1], [0.2, -0.1], [0.2, 0.1], [-0.2, 0.1]]", corners);
    let angle = "[[-0.2, -0.2], [0.2, -0.2], [0.2, -0.1], [-0.1, -0.1], [-0.1, 0.2], [-0.2, 0.2]]";
    let with = |more: &str| judge(&format!("{HEAD}{}{more}{STEPS}", block(angle)), KNOTS, DONE);
    holds(with(""));
    // A long wall across the whole path is in the notch all the time, or hits one arm.
    let wall = |y: f64| {
        format!("[[obstacle]]\npolygon = [[1.7, {y}], [1.8, {y}], [1.8, {}], [1.7, {}]]\n", y + 0.01, y + 0.01)
    };
    fails(with(&wall(1.1)), "the payload");
    holds(with(&wall(1.21)));
    // Small things inside the object. Its sides do not touch them.
    for inside in
        ["circle = { center = [1, 0.85], radius = 0.01 }", "polygon = [[0.99, 0.84], [1.01, 0.84], [1, 0.86]]"]
    {
        fails(with(&format!("[[obstacle]]\n{inside}\n")), "inside the payload");
    }
    holds(with("[[obstacle]]\ncircle = { center = [1.05, 1.4], radius = 0.01 }\n"));
}

/// Tests a block like a C, open to the right, over a rail that fits into its slot. The arm reaches 1.01 m, so sides
/// beside right angles yield by 0.0714 mm.
#[test]
fn nonconvex_objects_press_within_the_allowance() {
    let slotted =
        "[[-0.2, -0.1], [0.2, -0.1], [0.2, 0.2], [-0.1, 0.2], [-0.1, 0.3], [0.2, 0.3], [0.2, 0.5], [-0.2, 0.5]]";
    let flat = gantry().replace(
        "<link name=\"bridge\"> <collision> <geometry>",
        "<link name=\"bridge\"> <collision> <origin xyz=\"0 -1 0\"/> <geometry>",
    );
    let over = |outline: &str, support: &str, rests: bool| {
        let supports = if rests { "supports = [\"rail\"]" } else { "" };
        let block = format!("[[object]]\nname = \"block\"\nat = [1, 1]\n{outline}\n{supports}\n");
        let world = format!("{HEAD}{block}[[obstacle]]\nname = \"rail\"\n{support}\n{STEPS}");
        judge_steps(&flat, &world, KNOTS, DONE)
    };
    let rail = |y: f64| format!("polyline = [[3.06, {y}], [9, {y}]]");
    let backwards =
        "[[-0.2, 0.5], [0.2, 0.5], [0.2, 0.3], [-0.1, 0.3], [-0.1, 0.2], [0.2, 0.2], [0.2, -0.1], [-0.2, -0.1]]";
    for outline in [slotted, backwards] {
        let slotted = format!("polygon = {outline}");
        holds(over(&slotted, &rail(1.25), false));
        fails(over(&slotted, &rail(1.2), false), "farther than 0 from obstacle 0");
        for (y, is_free) in
            [(1.25, true), (1.2 - 7.1e-5, true), (1.2 - 7.2e-5, false), (1.3 + 7.1e-5, true), (1.31, false)]
        {
            agrees(over(&slotted, &rail(y), true), is_free, "within the allowed depth in obstacle 0");
        }
        // The object may touch the button, but must not contain it.
        let button = "circle = { center = [1, 1.1], radius = 1e-6 }";
        fails(over(&slotted, button, true), "obstacle 0 is inside the payload");
    }
    let foil = |thick: f64| {
        let top = thick - 0.1;
        format!("polygon = [[-0.2, -0.1], [0.2, -0.1], [0.2, {top}], [-0.2, {top}]]")
    };
    holds(over(&foil(1.5e-4), &rail(1.25), true));
    refused(over(&foil(1.4e-4), &rail(1.25), true), "too thin or too pointed: it cannot be shrunk by the depth");
}

#[test]
fn unknown_requests_of_worlds_are_refused() {
    let with = |old: &str, new: &str| judge(&format!("{HEAD}{BLOCK}{STEPS}").replace(old, new), KNOTS, DONE);
    for (old, new, part) in [
        ("pick = \"block\"", "pick = \"blok\"", "no object of this name"),
        ("place = {", "place = { on = \"tray 1,1\",", "either `at` or `on`"),
        ("pick = \"block\"", "pick = \"block\"\nplace = { at = [3, 1] }", "a step needs exactly one action"),
        ("pick = \"block\"", "pick = \"block\"\nhow = 1", "does not know the key how"),
        ("at = [1, 1]", "pallet = \"tray\"", "no pallet of this name"),
        ("\"level\"", "\"lose\"", "\"rigid\" or \"level\""),
        (
            "[[step]]\npick",
            "[[object]]\nname = \"block\"\nat = [5, 5]\ncircle = { center = [0, 0], radius = 1 }\n[[step]]\npick",
            "another object or obstacle",
        ),
        (
            "[[step]]\npick",
            "[[obstacle]]\nname = \"block\"\npolyline = [[5, 5], [6, 6]]\n[[step]]\npick",
            "another object or obstacle",
        ),
        ("[[step]]\npick", "[task]\norder = \"free\"\n[[step]]\npick", "pick, place, pick, place"),
        ("[[step]]\npick", "[task]\nrepeat = 0\n[[step]]\npick", "a whole number of at least 1"),
        ("[[step]]\npick", "[[step]]\nsteps = []\n[[step]]\npick", "there are no steps"),
    ] {
        refused(with(old, new), part);
    }
    // Huge numbers of repetitions are not expanded one by one.
    fails(with("[[step]]\npick", "[task]\nrepeat = 900000000000000\n[[step]]\npick"), "but the certificate ends");
}
