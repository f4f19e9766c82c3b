//! Tests the judge with an arm and a world that are built in memory, without files.

use cplan_check::arm::{Arm, Joint, Motion};
use cplan_check::decimal::Decimal;
use cplan_check::domain::{Axis, Domain};
use cplan_check::interval::{Interval, Point};
use cplan_check::obstacle::{Obstacle, Outline};
use cplan_check::overlap::Shape;
use cplan_check::shapes::{Body, CollisionShape};
use cplan_check::world::{Goal, World};
use cplan_check::{CheckError, certificate, judge};
use std::collections::BTreeSet;

fn number(text: &str) -> Decimal {
    text.parse().unwrap()
}

fn point(x: i32, y: i32) -> Point {
    [x, y].map(Interval::whole)
}

/// Makes an arm of two bars, each 1 m long and 0.1 m wide. The second joint turns by at most 1 rad.
fn arm() -> Arm {
    let joint = |name: &str, far: &str| {
        let range = [&format!("-{far}"), far].map(number);
        Joint { name: name.into(), motion: Motion::Turn(1), axis: Axis::Line(range.clone()), within: Some(range) }
    };
    let body = |link: usize, points: Vec<Point>, radius: &str| {
        let shape = Shape { points, radius: Interval::from(&number(radius)) };
        Body { link, shape, heights: None }
    };
    let bar = |link: usize| {
        let body = body(link, vec![point(0, 0), point(1, 0)], "0.05");
        let (layer, ignored) = (None, BTreeSet::new());
        let (around, within) = (body.clone(), body);
        CollisionShape {
            link: ["upper", "lower"][link].into(),
            kind: "collision",
            number: 0,
            last: Some(link),
            layer,
            around,
            within,
            ignored,
        }
    };
    let joints = [joint("j1", "3"), joint("j2", "1")];
    Arm {
        domain: Domain::new(joints.each_ref().map(|joint| &joint.axis)),
        sum: None,
        joints,
        base: point(0, 0),
        offset: point(1, 0),
        tip_link: "lower".into(),
        tip: body(1, vec![point(1, 0)], "0"),
        shapes: vec![bar(0), bar(1)],
        bases: vec![],
        own: vec![],
        notes: String::new(),
    }
}

/// Makes a world with a post that blocks the first bar: start and goal are on opposite sides.
fn world() -> World {
    let joints = |q: [&str; 2]| Some(Goal::Joints(q.map(|value| [number(value), number(value)])));
    let outline = Outline::Circle([number("0.9"), number("0")], number("0.2"));
    let (at, turn) = (point(0, 0), point(0, 1));
    let post = Obstacle { at, turn, ..Obstacle::new(outline) };
    World { start: joints(["-1", "0"]), goal: joints(["1", "0"]), obstacles: vec![post], ..World::default() }
}

fn judge_text(text: &str) -> Result<String, CheckError> {
    judge(&arm(), &world(), &certificate::read(text)?)
}

#[test]
fn boxes_separate_the_ends() {
    let text = r#"{
        "format": "cplan certificate 1", "answer": "infeasible",
        "shapes": [{ "link": "upper", "collision": 0 }], "parts": [{ "obstacle": 0 }],
        "boxes": [{ "lower": [-0.1, -1], "upper": [0.1, 1], "shape": 0, "part": 0 }]
    }"#;
    let proven = r#"no motion of "j1" and "j2" leads from the start to the goal with clearance 0"#;
    assert_eq!(judge_text(text), Ok(proven.into()));
    // A box wider than the post allows, and one that does not reach across the domain.
    for (from, to, why) in [("0.1, 1]", "0.3, 1]", "does not touch"), ("0.1, 1]", "0.1, 0.9]", "do not separate")] {
        let Err(CheckError::Fails(message)) = judge_text(&text.replace(from, to)) else { panic!("{to} holds") };
        assert!(message.contains(why), "{message}");
    }
}

#[test]
fn a_motion_avoids_the_post_or_fails() {
    let text = |clearance: &str, through: &str| {
        format!(
            r#"{{
                "format": "cplan certificate 1", "answer": "found", "start": [0.5, 0.4], "goal": [1, 0], "clearance": {clearance},
                "motion": {{ "interpolation": ["linear"], "knots": [[0, 0.5, 0.4], [1, {through}, 0], [2, 1, 0]] }}
            }}"#
        )
    };
    let proven = judge_text(&text("0.1", "0.9")).unwrap();
    assert!(proven.contains("with clearance 0.1 (3 knots, read as linear)"), "{proven}");
    for (clearance, through) in [("0.3", "0.9"), ("0.1", "0")] {
        assert!(matches!(judge_text(&text(clearance, through)), Err(CheckError::Fails(_))), "{clearance} {through}");
    }
}
