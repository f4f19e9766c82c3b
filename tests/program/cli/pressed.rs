//! How deep what is placed presses into what it rests on.

use super::{Place, shipped};

/// A level object whose tip points at a table's edge at y = 1.2.
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

/// The arm reaches 1.8 m, so 0.18 mm are allowed.
#[test]
fn no_corner_is_pressed_into_a_support() {
    for (what, polygon, table, numbers) in [
        ("a needle by 0.9 mm", NEEDLE, TABLE, [0.18, 9e-4, 0.0]),
        ("a needle by 0.2 mm", NEEDLE, TABLE, [0.18, 2e-4, 0.0]),
        ("a needle through what is thin", NEEDLE, EDGE, [0.18, 9e-4, 0.0]),
        ("a gable by 0.2 mm", GABLE, TABLE, [0.15, 2e-4, 0.0]),
        ("a gable by 1 mm, with a clearance", GABLE, TABLE, [0.15, 1e-3, 0.005]),
        ("a gable by 0.2 mm, with a clearance", GABLE, TABLE, [0.15, 2e-4, 0.005]),
        ("a side by 0.2 mm", BOX, TABLE, [0.1, 2e-4, 0.0]),
        ("a side by 0.2 mm, with a clearance", BOX, TABLE, [0.1, 2e-4, 0.005]),
    ] {
        let done = Place::new().plan(cell(polygon, table, numbers), "--json --quiet");
        assert_eq!(done.code, 3, "{what}: {}{}", done.stdout, done.stderr);
    }
}

#[test]
fn what_rests_on_a_support_may_touch_it() {
    for (what, polygon, table, numbers) in [
        ("a needle", NEEDLE, TABLE, [0.18, 0.0, 0.0]),
        ("a needle by half of what is allowed", NEEDLE, TABLE, [0.18, 9e-5, 0.0]),
        ("a gable, with a clearance", GABLE, TABLE, [0.15, 1e-6, 0.005]),
        ("a side by two thirds of what is allowed", BOX, TABLE, [0.1, 1.2e-4, 0.0]),
        ("a side by two thirds of what is allowed, with a clearance", BOX, TABLE, [0.1, 1.2e-4, 0.005]),
        ("a side on what is thin, with a clearance", BOX, EDGE, [0.1, 1.2e-4, 0.005]),
    ] {
        let done = Place::new().plan(cell(polygon, table, numbers), "--json --quiet");
        assert_eq!(done.code, 0, "{what}: {}{}", done.stdout, done.stderr);
    }
}

/// Objects of pieces, and a wall on the line of a side that they share: one that ends in the tip, and one that goes on from
/// a side of a cross, to which the wall comes after 8 cm beside it.
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
            let done = Place::new().plan(cell(polygon, &wall, [tip, by, 0.0]), "--json --quiet");
            assert_eq!(done.code, code, "{x}, {by} deep: {}{}", done.stdout, done.stderr);
        }
    }
}

/// The judge of recordings says the same: a plan is judged in a world where the table lies 1 mm nearer.
#[test]
fn a_recording_that_presses_a_corner_into_a_support_is_refuted() {
    for (polygon, numbers @ [.., clearance]) in [(NEEDLE, [0.18, 0.0, 0.0]), (GABLE, [0.15, 0.0, 0.005])] {
        let (place, world) = (Place::new(), cell(polygon, TABLE, numbers));
        let done = place.plan(&world, "--output plan.json --quiet");
        assert_eq!(done.code, 0, "{}", done.stderr);
        let verify = |world: &str| {
            place.write("nearer.toml", world);
            place.run(&["verify", &shipped("robots/planar_2r.urdf"), "nearer.toml", "plan.json"], "").code
        };
        assert_eq!(verify(&world), 0, "clearance {clearance}");
        assert_eq!(verify(&world.replace("1.2]", "1.199]")), 3, "clearance {clearance}");
    }
}
