//! How deep a placed object may press into its support.

use super::*;
use std::f64::consts::FRAC_1_SQRT_2;

/// Returns a world with a level object whose tip points at a table's edge at y = 1.2.
fn cell(polygon: &str, table: &str, [tip, deep, clearance]: [f64; 3]) -> String {
    let at = 1.2 - tip + deep;
    format!(
        r#"name = "cell"
clearance = {clearance}
[start]
joints = [0.0, 0.5]
[[obstacle]]
name = "table"
{table}
[[object]]
name = "part"
polygon = {polygon}
at = [0.8, 0.8]
payload = "level"
[[step]]
pick = "part"
[[step]]
place = {{ at = [0.8, {at}], supports = ["table"] }}
"#
    )
}

const TABLE: &str = "polygon = [[0.3, 1.2], [1.3, 1.2], [1.3, 1.4], [0.3, 1.4]]";
const EDGE: &str = "polyline = [[0.3, 1.2], [1.3, 1.2]]";
const NEEDLE: &str = "[[-0.02, -0.02], [0.02, -0.02], [0.0, 0.18]]";
const GABLE: &str = "[[-0.05, -0.02], [0.05, -0.02], [0.05, 0.1], [0.0, 0.15], [-0.05, 0.1]]";
const CROSS: &str = "[[-0.02, 0.04], [0.02, 0.04], [0.02, 0.1], [0.06, 0.1], [0.06, 0.14], [0.02, 0.14], [0.02, 0.22], \
                     [-0.02, 0.22], [-0.02, 0.14], [-0.06, 0.14], [-0.06, 0.1], [-0.02, 0.1]]";
const CLEFT: &str = "[[-0.05, -0.02], [0.0, 0.05], [0.05, -0.02], [0.05, 0.1], [0.0, 0.12], [-0.05, 0.1]]";
const BOX: &str = "[[-0.05, -0.02], [0.05, -0.02], [0.05, 0.1], [-0.05, 0.1]]";

/// Checks that a corner may touch its support, but presses into it by at most 1e-4 of the arm's reach: 0.18 mm of
/// 1.8 m.
#[test]
fn no_corner_is_pressed_into_a_support() {
    for (what, polygon, table, numbers, code) in [
        ("a needle by 0.9 mm", NEEDLE, TABLE, [0.18, 9e-4, 0.0], 3),
        ("a needle by 0.2 mm", NEEDLE, TABLE, [0.18, 2e-4, 0.0], 3),
        ("a needle through what is thin", NEEDLE, EDGE, [0.18, 9e-4, 0.0], 3),
        ("a gable by 0.2 mm", GABLE, TABLE, [0.15, 2e-4, 0.0], 3),
        ("a gable by 1 mm, with a clearance", GABLE, TABLE, [0.15, 1e-3, 0.005], 3),
        ("a gable by 0.2 mm, with a clearance", GABLE, TABLE, [0.15, 2e-4, 0.005], 3),
        ("a side by 0.2 mm", BOX, TABLE, [0.1, 2e-4, 0.0], 3),
        ("a side by 0.2 mm, with a clearance", BOX, TABLE, [0.1, 2e-4, 0.005], 3),
        ("a needle", NEEDLE, TABLE, [0.18, 0.0, 0.0], 0),
        ("a needle by half of what is allowed", NEEDLE, TABLE, [0.18, 9e-5, 0.0], 0),
        ("a gable, with a clearance", GABLE, TABLE, [0.15, 1e-6, 0.005], 0),
        ("a side by two thirds of what is allowed", BOX, TABLE, [0.1, 1.2e-4, 0.0], 0),
        ("a side by two thirds of what is allowed, with a clearance", BOX, TABLE, [0.1, 1.2e-4, 0.005], 0),
        ("a side on what is thin, with a clearance", BOX, EDGE, [0.1, 1.2e-4, 0.005], 0),
    ] {
        println!("{what}");
        Place::new().plan(cell(polygon, table, numbers), "--json --quiet").exits(code);
    }
}

/// Checks objects that consist of pieces, with a wall on the line of a side that two pieces share. One such side ends
/// in the tip of the object. Another extends a side of a cross, beside which the wall has room for 8 cm.
#[test]
fn no_wall_gets_between_the_pieces_of_an_object() {
    for (x, polygon, tip, free, deep) in [
        (0.8, CLEFT, 0.12, 0.0, 0.04),
        (0.80005, CLEFT, 0.12, 0.0, 0.04),
        (0.82, CROSS, 0.22, 0.08, 0.1),
        (0.78, CROSS, 0.22, 0.08, 0.1),
    ] {
        let wall = format!("polyline = [[{x}, 1.2], [{x}, 1.3]]");
        for (by, code) in [(free, 0), (deep, 3)] {
            Place::new().plan(cell(polygon, &wall, [tip, by, 0.0]), "--json --quiet").exits(code);
        }
    }
}

/// Checks that the judge of recordings agrees. A plan is judged in a world where the table is 1 mm nearer.
#[test]
fn a_recording_that_presses_a_corner_into_a_support_is_refuted() {
    for (polygon, numbers @ [.., clearance]) in [(NEEDLE, [0.18, 0.0, 0.0]), (GABLE, [0.15, 0.0, 0.005])] {
        let (place, world) = (Place::new(), cell(polygon, TABLE, numbers));
        place.plan(&world, "--output plan.json --quiet").exits(0);
        let verify = |world: &str| {
            place.write("nearer.toml", world);
            place.run(&["verify", &shipped("robots/planar_2r.urdf"), "nearer.toml", "plan.json"], "").code
        };
        assert_eq!(verify(&world), 0, "clearance {clearance}");
        assert_eq!(verify(&world.replace("1.2]", "1.199]")), 3, "clearance {clearance}");
    }
}

/// Depth to which an object may press into its support, metres: a fraction of the arm's reach of 1.8 m.
const PENETRATION_ALLOWANCE: f64 = 1.8e-4;

/// Objects that end in a tip on their axis. Each has its outline and the way in which it is held, the distance of the
/// tip from the origin, and the share of [`PENETRATION_ALLOWANCE`] that holds for the tip. The allowance moves corners
/// inwards by all of it, and sides by the sine of half the angle beside them.
const TIPPED: [([&str; 2], f64, f64); 5] = [
    (["polygon = [[-0.05, -0.02], [0.05, -0.02], [0.05, 0.1], [-0.05, 0.1]]", "level"], 0.1, FRAC_1_SQRT_2),
    (["polygon = [[-0.05, -0.02], [0.05, -0.02], [0.05, 0.1], [0, 0.15], [-0.05, 0.1]]", "level"], 0.15, 1.0),
    (["polygon = [[-0.02, -0.02], [0.02, -0.02], [0.0, 0.18]]", "level"], 0.18, 1.0),
    (["circle = { center = [0.0, 0.06], radius = 0.05 }", "level"], 0.11, 1.0),
    // In any orientation, it ends at the same distance.
    (["circle = { center = [0.0, 0.0], radius = 0.11 }", "rigid"], 0.11, 1.0),
];

/// Returns supports of many shapes. On each, the object's tip is the first to touch, at the height `y` on the object's
/// axis.
fn on_the_axis(y: f64) -> [(&'static str, String); 7] {
    let at = |above: f64| y + above;
    [
        ("thick", format!("polygon = [[0.3, {y}], [1.3, {y}], [1.3, {0}], [0.3, {0}]]", at(0.2))),
        ("thin", format!("polygon = [[0.3, {y}], [1.3, {y}], [1.3, {0}], [0.3, {0}]]", at(0.004))),
        ("a wall along", format!("polyline = [[0.3, {y}], [1.3, {y}]]")),
        ("a wall across", format!("polyline = [[0.8, {y}], [0.8, {}]]", at(0.2))),
        ("a corner", format!("polygon = [[0.8, {y}], [1.1, {0}], [0.5, {0}]]", at(0.3))),
        ("a sharp corner", format!("polygon = [[0.8, {y}], [0.81, {0}], [0.79, {0}]]", at(0.2))),
        ("a peg", format!("circle = {{ center = [0.8, {}], radius = 0.003 }}", at(0.003))),
    ]
}

/// Returns a world with an object, a support, the depth of the tip, and a clearance.
fn world_of_outline([outline, held]: [&str; 2], support: &str, numbers: [f64; 3]) -> String {
    cell("[]", support, numbers).replace("polygon = []", outline).replace("\"level\"", &format!("\"{held}\""))
}

/// Checks that a clearance allows no deeper pressing. On thick and thin supports, and corner on corner, a place is free
/// if the tip is less deep than its allowance. It is not free if the tip is deeper by a hundredth of the allowance.
#[test]
fn with_a_clearance_nothing_is_pressed_deeper_than_without() {
    let mut wrong = Vec::new();
    for (object, tip, share) in TIPPED {
        for (what, support) in on_the_axis(1.2) {
            for (clearance, deeper) in [(0.005, 1.01), (0.02, 20.0)] {
                for (by, code) in [(0.99, 0), (deeper, 3)] {
                    let world =
                        world_of_outline(object, &support, [tip, by * share * PENETRATION_ALLOWANCE, clearance]);
                    let done = Place::new().plan(world, "--json --quiet");
                    let kept = done.code != 0 || done.json()["clearance"].as_f64().unwrap() >= clearance;
                    if done.code != code || !kept {
                        wrong
                            .push(format!("{object:?} {by} deep in {what}, {clearance}: {}{}", done.code, done.stderr));
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
}

/// Removes the clearances from a result, because they would be false in a world with a nearer support.
fn without_clearances(result: &str) -> String {
    let mut result: serde_json::Value = serde_json::from_str(result).unwrap();
    assert!(result.as_object_mut().unwrap().remove("clearance").is_some());
    for step in result["steps"].as_array_mut().unwrap() {
        step.as_object_mut().unwrap().remove("clearance");
    }
    result.to_string()
}

/// Checks that the judge of recordings agrees. Plans are judged in worlds where the support is nearer than planned.
#[test]
fn with_a_clearance_nothing_recorded_may_press_deeper_than_without() {
    let mut wrong = Vec::new();
    for (object, tip, share) in TIPPED {
        for ((what, support), clearance) in on_the_axis(1.2).into_iter().zip([0.005, 0.02].into_iter().cycle()) {
            let place = Place::new();
            place
                .plan(world_of_outline(object, &support, [tip, 0.0, clearance]), "--output plan.json --quiet")
                .exits(0);
            place.write("plan.json", without_clearances(&place.read("plan.json")));
            for (by, code) in [(0.0, 0), (0.99, 0), (1.01, 3), (20.0, 3)] {
                let nearer = on_the_axis(1.2 - by * share * PENETRATION_ALLOWANCE)
                    .into_iter()
                    .find(|nearer| nearer.0 == what)
                    .unwrap()
                    .1;
                place.write("nearer.toml", world_of_outline(object, &nearer, [tip, 0.0, clearance]));
                let done = place.run(&["verify", &shipped("robots/planar_2r.urdf"), "nearer.toml", "plan.json"], "");
                if done.code != code {
                    wrong.push(format!("{object:?} {by} deep in {what}, {clearance}: {}", done.code));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
}

/// Returns a world with a table 5e-5 m higher than the place of the object. A gantry may press in by 1.6e-4 m.
fn on_a_table(polygon: &str) -> String {
    format!(
        "robot.payload = \"level\"\nstart.tip = [0.3, 0.3]\n[[obstacle]]\nname = \"table\"\n\
         polygon = [[0.2, 0.2], [1.8, 0.2], [1.8, 0.50005], [0.2, 0.50005]]\nheight = [0.0, 0.01]\n\
         [[object]]\nname = \"part\"\npolygon = {polygon}\nat = [0.5, 0.5]\nheight = [0.0, 0.015]\nsupports = [\"table\"]\n\
         [[step]]\npick = \"part\"\n[[step]]\nplace = {{ at = [1.0, 0.5] }}\n"
    )
}

/// Checks outlines of the same object. Corners on straight sides have no effect, and a rib that is too fine does not
/// affect the sides beside it. If the checker would refuse to move an object's corners, there is no certificate.
#[test]
fn outlines_say_the_same_however_they_are_written() {
    let urdf = shipped("robots/gantry.urdf");
    for (what, polygon, is_certified) in [
        (
            "a straight corner",
            "[[-0.05, 0], [0, 0], [0.05, 0], [0.05, 0.1], [0.02, 0.1], [0.02, 0.05], [-0.02, 0.05], [-0.02, 0.1], [-0.05, 0.1]]",
            true,
        ),
        (
            "a hole, and a straight corner",
            "[[[-0.05, 0], [0, 0], [0.05, 0], [0.05, 0.1], [-0.05, 0.1]], [[-0.02, 0.03], [0.02, 0.03], [0.02, 0.07], [-0.02, 0.07]]]",
            true,
        ),
        (
            "a rib",
            "[[-0.05, 0], [0.05, 0], [0.05, 0.08], [0.0001, 0.08], [0.0001, 0.09], [-0.0001, 0.09], [-0.0001, 0.08], [-0.05, 0.08]]",
            true,
        ),
        (
            "holes that touch",
            "[[[-0.08, 0], [0.08, 0], [0.08, 0.16], [-0.08, 0.16]], [[0, 0.08], [0.04, 0.1], [0.04, 0.06]], [[0, 0.08], [-0.04, 0.1], [-0.04, 0.06]]]",
            false,
        ),
    ] {
        let place = Place::new().with("world.toml", on_a_table(polygon));
        let done = place.run(&[&urdf, "world.toml"], "--quiet --certificate c.json --output plan.json").exits(0);
        assert_eq!(place.path("c.json").exists(), is_certified, "{what}: {}", done.stderr);
        if is_certified {
            has(&place.judged([&urdf, "world.toml", "c.json"]).unwrap(), &["does all 2 steps"]);
        } else {
            done.warns(&["the outline of object \"part\", which rests on a support, cannot be shrunk"]);
        }
        let verified = place.run(&["verify", &urdf, "world.toml", "plan.json"], "--quiet --certificate v.json");
        assert_eq!((verified.code, place.path("v.json").exists()), (0, is_certified), "{what}: {}", verified.stderr);
    }
}

/// Checks three corners on a line, up to rounding. The middle one does not count as a corner, so it may not be moved
/// farther than its side.
#[test]
fn corners_bent_by_rounding_are_ignored() {
    let world = |x: f64, deep: f64| {
        let y = 0.5 + 0.1 * x + deep;
        format!(
            "start.joints = [0.1, 0.1]\n[[obstacle]]\nname = \"post\"\npolyline = [[{0}, 0.4], [{0}, {y}]]\nheight = [0.0, 0.01]\n\
             [[object]]\nname = \"part\"\npolygon = [[0, 0], [{x}, {1}], [0.1, 0.01], [0.1, 0.1], [0, 0.1]]\nat = [0.5, 0.5]\n\
             height = [0.0, 0.015]\nlift = 0.05\nsupports = [\"post\"]\n[[step]]\npick = \"part\"\n[[step]]\nplace = {{ at = [1.0, 0.5] }}\n",
            1.0 + x,
            (x * 1e4).round() / 1e5
        )
    };
    // Two thirds of 1.6e-4 m are allowed there.
    for x in [0.01, 0.02, 0.03, 0.05, 0.06, 0.07] {
        for (deep, code) in [(8e-5, 0), (1.4e-4, 3)] {
            Place::new()
                .with("world.toml", world(x, deep))
                .run(&[&shipped("robots/gantry.urdf"), "world.toml"], "--quiet")
                .exits(code);
        }
    }
}

/// Checks C-obstacles of which some sides almost coincide. Their union used to take minutes and gigabytes.
#[test]
fn rings_beside_what_they_rest_on_are_planned() {
    let world = r#"clearance=0
[robot]
payload="level"
[start]
joints=[0.1,0.1]
[[obstacle]]
name="s0"
polygon=[[1.443710767478203, 1.0324135044022258], [1.5974607674782029, 0.9747835044022257], [1.5996607674782028, 0.8628335044022257]]
height=[0.0,0.01]
[[object]]
name="part"
polygon=[[[-0.0168289, 0.0990708], [-0.0994224, 0.0146093], [-0.0446175, -0.0900418], [0.0718472, -0.0702582]], [[0.0039533, -0.0082987], [0.0004618, -0.0079051], [-0.0027371, -0.0064519], [-0.0053303, -0.0040813], [-0.0070641, -0.0], [-0.0077687, 0.0024167], [0.01, 0.01], [0.0146687, 0.0]]]
at=[0.673, 0.9604]
angle=0
height=[0.0,0.015]
lift=0
grasp=[0,0]
supports=["s0"]
[[step]]
pick="part"
[[step]]
place={at=[1.5622, 1.1317]}"#;
    Place::new().with("world.toml", world).run(&[&shipped("robots/gantry.urdf"), "world.toml"], "--quiet").exits(0);
}
