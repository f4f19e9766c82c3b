//! Goals that are areas for the tip.

use crate::common::robots::{LIMIT, bars, two_bars};
use crate::common::verdict::{found, judge};

/// Returns an arm of two bars that slide along x and y. The tip is at `(1.8 + a, b)`.
fn sliding() -> String {
    bars("prismatic", "prismatic")
}

fn world(areas: &str) -> String {
    format!("robot.own_body = false\nstart.joints = [-1, 0]\ngoal.areas = [{areas}]\n")
}

fn motion(last: &str) -> String {
    found("", r#""linear""#, &format!("[0, -1, 0], [1, {last}]"))
}

#[test]
fn a_motion_ends_in_any_of_the_areas() {
    let ends = |areas: &str, last: &str| judge(&sliding(), &world(areas), &motion(last));
    let area = "[[2.5, 0.5], [3.5, 1.5]]";
    // On the border, inside, and a hundredth outside along either axis.
    for (last, code) in
        [("0.7, 0.5", 0), ("1, 1", 0), ("0.69, 0.5", 3), ("0.7, 0.49", 3), ("1.71, 1", 3), ("1, 1.51", 3)]
    {
        assert_eq!(ends(area, last).0, code, "{last}");
    }
    let (code, report) = ends(area, "1, 1");
    assert!(code == 0 && report.contains("the goal, an area of the tip \"tool\""), "{report}");
    // Any two opposite corners, and any of several areas.
    for corners in ["[[3.5, 1.5], [2.5, 0.5]]", "[[2.5, 1.5], [3.5, 0.5]]"] {
        assert_eq!((ends(corners, "1, 1").0, ends(corners, "0.6, 1").0), (0, 3));
    }
    let two = format!("[[-1, -1], [-1, -1]], {area}");
    assert_eq!((ends(&two, "1, 1").0, ends(&two, "-2.8, -1").0, ends(&two, "-2.8, -0.9").0), (0, 0, 3));
    assert_eq!(ends("[[2.5, 0.5]]", "1, 1").0, 1);
    let beside = world(area) + "goal.tip = [1, 1]\n";
    assert_eq!(judge(&sliding(), &beside, &motion("1, 1")).0, 1);
}

#[test]
fn for_an_arm_that_turns_an_area_is_its_middle() {
    // Stretched out at an angle of 1 rad, which is within the limits.
    let angle = 1f64.min(LIMIT);
    let (x, y) = (1.8 * angle.cos(), 1.8 * angle.sin());
    let about = |dx: f64| format!("[[{}, {}], [{}, {}]]", x - 0.1 + dx, y - 0.1, x + 0.1 + dx, y + 0.1);
    let ends = |areas: &str| judge(&two_bars(), &world(areas), &motion("1, 0")).0;
    assert_eq!((ends(&about(0.0)), ends(&about(0.05))), (0, 3));
}

#[test]
fn no_area_is_reached_if_all_are_beyond_the_boxes() {
    // A wall across the path of the first bar, at 0.3 m.
    let wall = "[[obstacle]]\npolyline = [[0.3, -10], [0.3, 10]]\n";
    let proof = r#"{"format": "cplan certificate 1", "answer": "infeasible",
        "shapes": [{"link": "upper", "collision": 0}], "parts": [{"obstacle": 0, "corners": [[0.3, -10], [0.3, 10]]}],
        "boxes": [{"lower": [-0.1, -3], "upper": [0.1, 3], "shape": 0, "part": 0}]}"#;
    let closed = |areas: &str| judge(&sliding(), &(world(areas) + wall), proof);
    let (code, report) = closed("[[2.5, 0.5], [3.5, 1.5]]");
    assert_eq!(code, 0, "{report}");
    // On the start's side entirely, partly, and one of two areas.
    for areas in ["[[1, 0.5], [1.2, 1.5]]", "[[1.6, 0.5], [3.5, 1.5]]", "[[2.5, 0.5], [3.5, 1.5]], [[1, 1], [1, 1]]"] {
        assert_eq!(closed(areas).0, 3, "{areas}");
    }
}
