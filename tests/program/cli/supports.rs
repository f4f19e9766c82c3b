//! Supports of objects: a bottom that touches a top is no collision, for planner, judge and checker.

use super::*;
/// The way in which the tool is lowered, and in which the part is held.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Hand {
    Lifting,
    Stroke,
    /// A wrist turns the part over the table so that it stays level.
    Wrist,
}

/// A part with a lower height, a table with an upper height, and steps.
struct Cell {
    hand: Hand,
    top: f64,
    bottom: f64,
    lift: f64,
    supports: &'static str,
}

impl Cell {
    fn new(hand: Hand) -> Self {
        Self { hand, top: 0.05, bottom: 0.05, lift: 0.1, supports: "" }
    }

    fn world(&self, steps: &str) -> String {
        let Self { hand, top, bottom, lift, supports } = self;
        let (robot, level) = match hand {
            Hand::Lifting => ("", ""),
            Hand::Stroke => ("stroke = { joint = \"axis_3\" }", ""),
            Hand::Wrist => ("wrist = { velocity = 6.0, acceleration = 60.0 }", "payload = \"level\""),
        };
        format!(
            "[robot]\n{robot}\n[start]\njoints = [0.3, 0.4]\n\
             [[obstacle]]\nname = \"table\"\nheight = [0.0, {top}]\n\
             polygon = [[0.25, -0.35], [0.45, -0.35], [0.45, -0.15], [0.25, -0.15]]\n\
             [[object]]\nname = \"part\"\ncircle = {{ center = [0.0, 0.0], radius = 0.01 }}\nat = [0.1, 0.4]\n\
             height = [{bottom}, 0.06]\nlift = {lift}\n{level}\n{supports}\n{steps}"
        )
    }

    fn set_down(&self) -> String {
        let angle = if self.hand == Hand::Wrist { ", angle = 1.0" } else { "" };
        self.world(&format!("[[step]]\npick = \"part\"\n[[step]]\nplace = {{ at = [0.35, -0.25]{angle} }}\n"))
    }
}

/// Plans with a certificate, and checks it if the task is done.
fn plan_and_check(place: &Place, world: &str) -> Done {
    place.write("world.toml", world);
    let urdf = shipped("robots/scara.urdf");
    let done = place.run(&[&urdf, "world.toml"], "--certificate c.json --output plan.json");
    if done.code == 0 {
        place.judged([&urdf, "world.toml", "c.json"]).unwrap();
        place.run(&["verify", &urdf, "world.toml", "plan.json"], "").exits(0);
    }
    done
}

#[test]
fn a_part_is_set_on_a_table_that_its_bottom_touches() {
    let place = Place::new();
    for hand in [Hand::Lifting, Hand::Stroke, Hand::Wrist] {
        for supports in ["", "supports = [\"table\"]"] {
            // A difference of a micrometre is allowed, because stacks add up. Without a lift, the part may slide.
            for (bottom, lift) in [(0.05, 0.1), (0.049_999_5, 0.1), (0.05, 0.0)] {
                let cell = Cell { bottom, lift, supports, ..Cell::new(hand) };
                plan_and_check(&place, &cell.set_down()).exits(0);
            }
        }
    }
}

#[test]
fn pressing_deeper_than_the_tolerance_is_a_contact() {
    let place = Place::new();
    for hand in [Hand::Lifting, Hand::Stroke] {
        let cell = Cell { bottom: 0.049_998, ..Cell::new(hand) };
        plan_and_check(&place, &cell.set_down()).exits(3).says(&["payload \"part\" hits obstacle \"table\""]);
    }
}

#[test]
fn the_checker_knows_the_tolerance_by_itself() {
    let place = Place::new();
    let urdf = read(shipped("robots/scara.urdf"));
    for hand in [Hand::Lifting, Hand::Stroke] {
        let cell = Cell::new(hand);
        plan_and_check(&place, &cell.set_down()).exits(0);
        let certificate = super::certificates::without_digests(&place.read("c.json"));
        for (top, holds) in [(0.04, true), (0.050_001, true), (0.050_001_1, false), (0.06, false)] {
            let report = check(&urdf, &Cell { top, ..Cell::new(hand) }.set_down(), &certificate);
            assert_eq!(report.is_ok(), holds, "{hand:?}, table up to {top}: {report:?}");
        }
        let deep = Cell { top: 0.06, ..Cell::new(hand) };
        plan_and_check(&place, &deep.set_down()).exits(3);
    }
}

#[test]
fn parts_are_stacked_and_taken_off_again() {
    let place = Place::new();
    for hand in [Hand::Lifting, Hand::Stroke] {
        let upper = "[[object]]\nname = \"lid\"\ncircle = { center = [0.0, 0.0], radius = 0.01 }\nat = [0.0, 0.45]\n\
                     height = [0.06, 0.07]\nlift = 0.1\n";
        let steps = "[[step]]\npick = \"part\"\n[[step]]\nplace = { at = [0.35, -0.25] }\n\
                     [[step]]\npick = \"lid\"\n[[step]]\nplace = { at = [0.35, -0.25] }\n\
                     [[step]]\npick = \"lid\"\n[[step]]\nplace = { at = [0.0, 0.45] }\n\
                     [[step]]\npick = \"part\"\n[[step]]\nplace = { at = [0.1, 0.4] }\n";
        plan_and_check(&place, &Cell::new(hand).world(&format!("{upper}{steps}"))).exits(0);
        // An object with another one on it can be neither lifted nor pulled out from under it.
        let (first, _) = steps.split_at(steps.find("[[step]]\npick = \"lid\"\n[[step]]\nplace = { at = [0.0").unwrap());
        let taken = format!("{upper}{first}[[step]]\npick = \"part\"\n[[step]]\nplace = {{ at = [0.1, 0.4] }}\n");
        let lift = if hand == Hand::Stroke { 0.1 } else { 0.0 };
        let done = plan_and_check(&place, &Cell { lift, ..Cell::new(hand) }.world(&taken)).exits(3);
        done.says(&["hits obstacle \"lid\""]);
    }
}

#[test]
fn the_arm_itself_rests_on_nothing() {
    let place = Place::new();
    // The flange ends at 0.18 m.
    for (top, is_free) in [(0.18, false), (0.179_999, true)] {
        let cell = Cell { top, ..Cell::new(Hand::Lifting) };
        place.write("world.toml", cell.set_down());
        let urdf = shipped("robots/scara.urdf");
        let done = place.run(&["check", &urdf, "world.toml"], "--at -0.0169,-1.3524");
        assert_eq!(done.stdout.starts_with("result     free"), is_free, "{top}: {}{}", done.stdout, done.stderr);
    }
}
