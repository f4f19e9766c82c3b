//! Pictures of tasks: pick and place, rigid and level, repeated, large, infeasible.

use super::scenes::{TURN, arm, block, capsule, circle, interval, polygon};
use super::{inspected, pages, words};
use cplan::Outcome;
use cplan::cspace::{CObstacle, c_obstacles};
use cplan::engine::Method;
use cplan::engine::task::{Event, TaskAnswer, plan};
use cplan::geometry::{Point, Pose};
use cplan::model::{
    Action, Goal, Heights, Holding, Item, Object, Obstacle, Scene, Shape, Step, Task, ToolValues, Workspace, Wrist,
};
use cplan::space::Configuration;
use cplan::view::{Picture, TaskPicture, View};
use cplan_testkit::shapes::{convex, disc};
use std::collections::BTreeSet;

const START: [f64; 2] = [0.2, 2.2];

fn contours(scene: &Scene) -> Vec<CObstacle> {
    c_obstacles(scene, 2e-3, 2e-3)
}

/// Returns a square or a disc that lies somewhere.
fn object(name: &str, round: bool, holding: Holding, at: [f64; 2]) -> Object {
    let half = 0.09;
    let corners = [(-half, -half), (half, -half), (half, half), (-half, half)].map(|c| Point::new(c.0, c.1)).to_vec();
    let (shape, piece) = if round {
        (Shape::Circle { center: Point::zeros(), radius: half }, disc(Point::zeros(), half))
    } else {
        (Shape::Polygon(corners.clone()), convex(corners, 0.0))
    };
    let at = Pose::translation(at.into());
    Object {
        name: name.into(),
        shape,
        pieces: vec![piece],
        heights: Heights::ALL,
        lift: 0.0,
        holding,
        at,
        trajectory: None,
        mass: 0.0,
    }
}

fn pick(object: usize) -> Action {
    Action::Pick { object, grasp: Point::zeros(), supports: Vec::new(), when: Vec::new() }
}

fn place(x: f64, y: f64) -> Action {
    Action::Place { at: Point::new(x, y), angle: None, supports: Vec::new() }
}

fn turn_to(q1: f64, q2: f64) -> Action {
    Action::Move(Goal::Joints(Configuration::new(q1, q2)))
}

/// Returns a task that repeats these steps. Each round begins with new objects.
fn task(objects: Vec<Object>, obstacles: Vec<Obstacle>, steps: &[Action], rounds: usize) -> Task {
    let mut items = Vec::new();
    for cycle in 1..=rounds {
        if cycle > 1 {
            items.push(Item::Renew((0..objects.len()).collect()));
        }
        let step = |(i, action): (usize, &Action)| {
            let action = action.clone();
            Item::Step(Step {
                action,
                number: i + 1,
                cycle,
                place: String::new(),
                speed: 1.0,
                dwell: 0.25,
                tool: ToolValues::default(),
                elevation: 0.0,
            })
        };
        items.extend(steps.iter().enumerate().map(step));
    }
    Task {
        arm: arm(
            ["shoulder", "elbow"],
            [TURN; 2],
            [interval(-2.9, 2.9), interval(-2.7, 2.7)],
            [1.0, 0.8],
            [block(-0.06, -0.06, 1.06, 0.06), capsule(0.8, 0.05)],
        ),
        workspace: Workspace { name: "cell".into(), ..Workspace::new(obstacles) }.into(),
        objects,
        start: Configuration::new(START[0], START[1]),
        items,
        wrist: Some(Wrist { velocity: 3.0, acceleration: 10.0, jerk: None, turns_on_the_way: false, joint: None }),
        stroke: None,
        start_tool: ToolValues::default(),
    }
}

fn fixed() -> Vec<Obstacle> {
    vec![
        polygon("shelf", &[(0.95, 0.55), (1.45, 0.55), (1.45, 0.7), (0.95, 0.7)]),
        circle("post", -0.35, -1.2, 0.14),
        polygon("bin", &[(-1.5, 0.1), (-1.45, 0.1), (-1.45, 0.9), (-1.5, 0.9)]),
    ]
}

/// Returns a task that moves two objects to two places, with motions before, between and after.
fn sorting(holding: Holding) -> Task {
    let objects = vec![object("part", false, holding, [1.2, -0.5]), object("disc", true, holding, [0.55, -1.25])];
    let home = turn_to(START[0], START[1]);
    let steps = [turn_to(1.2, 0.6), pick(0), place(-1.15, 0.75), pick(1), turn_to(1.5, -0.4), place(-1.1, 0.35), home];
    task(objects, fixed(), &steps, 1)
}

fn answer(task: &Task) -> TaskAnswer {
    plan(task, &Method::Visibility.into(), &mut |_| {})
}

fn drawn(name: &str, task: &Task, answer: &TaskAnswer) -> String {
    let status = match answer.outcome {
        Outcome::Found(_) => "found, certified",
        Outcome::Infeasible(_) => "impossible, proven",
        Outcome::Unknown(_) => "unknown",
    };
    let title = vec![format!("{name}: test arm"), format!("visibility: {:.2} s", answer.duration())];
    let (ending, facts) = (Some(answer.outcome.status()), Vec::new());
    let view = View::of_task(&TaskPicture {
        title,
        status: status.into(),
        ending,
        facts,
        task,
        answer,
        plane: None,
        c_obstacles: contours,
        in_time: |_, _, _| Vec::new(),
    });
    follows(name, task, answer, &view);
    inspected(name, &view)
}

/// Checks that a page of the task shows every motion at its time, with the objects where they are then.
fn follows(name: &str, task: &Task, answer: &TaskAnswer, view: &View) {
    let legs = &answer.legs;
    let value = pages::inspected(name, view);
    let list = |key: &str| value[key].as_array().unwrap().clone();
    let (motions, paths, worlds) = (list("motions"), list("paths"), list("worlds"));
    assert_eq!((paths.len(), motions.len()), (legs.len(), legs.len() + 1), "and one after the last step");
    let mut poses: Vec<Option<Pose>> = task.objects.iter().map(|object| Some(object.at)).collect();
    let mut from = 0.0;
    for (leg, motion) in legs.iter().zip(&motions) {
        assert!((motion["from"].as_f64().unwrap() - from).abs() < 1e-9);
        from = leg.event_time().unwrap_or(leg.end());
        let world = &worlds[motion["world"].as_u64().unwrap() as usize];
        let carried = leg.carried.map(|object| task.objects[object].name.as_str());
        assert_eq!(world["payload"]["object"].as_str(), carried);
        let numbers = world["obstacles"].as_array().unwrap();
        for (object, pose) in task.objects.iter().zip(&poses) {
            let lies = numbers.iter().any(|o| o["name"] == object.name.as_str() && o["own"].as_u64() > Some(0));
            assert_eq!(lies, pose.is_some(), "{name}: {} lies somewhere unless it is carried", object.name);
        }
        match leg.event {
            Some(Event::Grasp { object }) => poses[object] = None,
            Some(Event::Release { object, pose }) => poses[object] = Some(pose),
            None => {}
        }
    }
    // After all steps nothing is carried. If a step fails, its world shows the tried configurations.
    let last = &worlds[motions[legs.len()]["world"].as_u64().unwrap() as usize];
    if answer.failed().is_none() {
        assert!(last["payload"].is_null() && motions[legs.len()]["path"].is_null());
    } else {
        let tried = answer.failed().map_or(0, |fails| fails.ik_solutions.len());
        assert_eq!(last["unreached"].as_array().unwrap().len(), tried);
    }
}

fn done(name: &str, task: &Task) -> String {
    let answer = answer(task);
    assert_eq!(answer.failed(), None);
    drawn(name, task, &answer)
}

/// A surface or a line of a picture.
#[derive(Debug, Clone)]
struct Mark {
    stroke: String,
    filled: bool,
    dashed: bool,
    /// Stroked first: a union of pieces.
    union: bool,
    outline: String,
}

/// Returns the content of each frame of a picture: first the workspace's frame, then those of the configuration spaces.
fn frames(text: &str) -> Vec<Vec<Mark>> {
    let tree = roxmltree::Document::parse(text).unwrap();
    let clipped = tree.descendants().filter(|n| n.has_tag_name("g") && n.has_attribute("clip-path"));
    let mark = |n: roxmltree::Node| Mark {
        stroke: n.attribute("stroke").unwrap_or_default().to_owned(),
        filled: n.attribute("fill").is_some_and(|fill| fill != "none"),
        dashed: n.has_attribute("stroke-dasharray"),
        union: n.has_attribute("paint-order"),
        outline: n.attribute("d").unwrap_or_default().to_owned(),
    };
    clipped.map(|g| g.children().filter(roxmltree::Node::is_element).map(mark).collect()).collect()
}

/// Returns the colour of a name in the legend.
fn color_of(text: &str, name: &str) -> String {
    let tree = roxmltree::Document::parse(text).unwrap();
    let mut texts = tree.descendants().filter(|n| n.has_tag_name("text"));
    let label = texts.rfind(|n| n.text().is_some_and(|t| t.trim() == name)).unwrap();
    let sign = label.prev_siblings().skip(1).find(roxmltree::Node::is_element).unwrap();
    sign.attribute("stroke").unwrap().to_owned()
}

/// Returns the titles of the configuration spaces: payload and steps.
fn titles(text: &str) -> Vec<String> {
    let all = words(text);
    let lines: Vec<&str> = all.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    let is_title = |line: &str| line == "Empty hand" || line.starts_with("Carrying ");
    lines.windows(2).filter(|pair| is_title(pair[0])).map(|pair| format!("{}: {}", pair[0], pair[1])).collect()
}

#[test]
fn each_payload_state_has_its_configuration_space() {
    let text = done("task_rigid", &sorting(Holding::Rigid));
    assert_eq!(
        titles(&text),
        [
            "Empty hand: steps 1\u{2013}2",
            "Carrying part: step 3",
            "Empty hand: step 4",
            "Carrying disc: steps 5\u{2013}6",
            "Empty hand: step 7"
        ]
    );
    let frames = frames(&text);
    let (workspace, spaces) = frames.split_first().unwrap();
    assert_eq!(spaces.len(), 5);
    let [part, disc] = ["part", "disc"].map(|name| color_of(&text, name));
    for name in ["shelf", "post", "bin", "part", "disc"] {
        let color = color_of(&text, name);
        assert!(workspace.iter().any(|m| m.stroke == color && m.filled && !m.dashed), "{name} is in the workspace");
        let count = spaces.iter().filter(|s| s.iter().any(|m| m.stroke == color && m.union)).count();
        assert_eq!(count, if color == part || color == disc { 4 } else { 5 }, "{name} is in the configuration spaces");
    }
    // Placed objects are dashed. The motion of a payload has its colour on both sides, and the payload is no obstacle
    // there.
    for (color, carrying) in [(&part, 1), (&disc, 3)] {
        let line = |m: &&Mark| m.stroke == *color && !m.filled && !m.outline.is_empty();
        assert_eq!(workspace.iter().filter(|m| m.stroke == *color && m.filled && m.dashed).count(), 1);
        assert!(workspace.iter().any(|m| line(&m)));
        for (k, space) in spaces.iter().enumerate() {
            assert_eq!(space.iter().any(|m| line(&m)), k == carrying);
            assert_eq!(space.iter().any(|m| m.stroke == *color && m.union), k != carrying);
        }
    }
    // Link 2 reaches into the object to pick, and out of the object that it has just placed.
    let open = |k: usize| -> BTreeSet<&str> {
        spaces[k].iter().filter(|m| m.union && m.dashed && !m.outline.is_empty()).map(|m| m.stroke.as_str()).collect()
    };
    assert_eq!(open(0), BTreeSet::from([part.as_str()]));
    assert_eq!(open(2), BTreeSet::from([part.as_str(), disc.as_str()]));
    assert!(open(1).is_empty() && open(3).is_empty());
    let words = words(&text);
    for word in ["Workspace", "shoulder", "pick \"disc\"", "\u{2713} found, certified", "reach"] {
        assert!(words.lines().any(|line| line.trim() == word), "{word} is missing in {words}");
    }
}

/// Returns the corners of an outline of straight lines.
fn corners(outline: &str) -> Vec<[f64; 2]> {
    let spots = outline.split(['M', 'L', 'Z']).filter(|s| !s.is_empty());
    let spot = |s: &str| {
        let (x, y) = s.split_once(' ').unwrap();
        [x, y].map(|v| v.parse().unwrap())
    };
    spots.map(spot).collect()
}

/// Returns the directions of the sides, degrees modulo a right angle.
fn directions(outline: &str) -> Vec<f64> {
    let angle = |w: &[[f64; 2]]| (w[0][1] - w[1][1]).atan2(w[1][0] - w[0][0]).to_degrees().rem_euclid(90.0);
    corners(outline).windows(2).filter(|w| w[0] != w[1]).map(angle).collect()
}

/// Checks a square that is carried to the end and is drawn there. It is upright if it is held level, and otherwise
/// turned with link 2.
#[test]
fn payloads_are_drawn_in_their_places() {
    for (name, holding) in [("task_carried_rigid", Holding::Rigid), ("task_carried_level", Holding::Level)] {
        let objects = vec![object("part", false, holding, [1.2, -0.5])];
        let task = task(objects, fixed(), &[pick(0), turn_to(1.8, 0.7)], 1);
        let answer = answer(&task);
        assert_eq!(answer.failed(), None);
        let text = drawn(name, &task, &answer);
        let color = color_of(&text, "part");
        let frames = frames(&text);
        let payload: Vec<&Mark> = frames[0].iter().filter(|m| m.stroke == color && m.union).collect();
        let [payload] = payload[..] else { panic!("{name}: {payload:?}") };
        let grasp = answer.legs[0].timed.curve.curve().path().goal();
        let turned = match holding {
            Holding::Rigid => (1.8 + 0.7 - grasp[0] - grasp[1]).to_degrees(),
            Holding::Level => 0.0,
        };
        let directions = directions(&payload.outline);
        assert!(directions.len() >= 4);
        for direction in directions {
            // Corners are rounded to a hundredth of a pixel, sides are some 20 pixels long.
            let off = (direction - turned + 45.0).rem_euclid(90.0) - 45.0;
            assert!(off.abs() < 0.1, "{name}: {direction} for {turned}");
        }
    }
}

#[test]
fn level_payloads_have_configuration_spaces_of_their_own() {
    let text = done("task_level", &sorting(Holding::Level));
    assert_eq!(frames(&text).len(), 6);
    let shelves = |text: &str| -> Vec<String> {
        let color = color_of(text, "shelf");
        frames(text)[1..].iter().map(|s| s.iter().find(|m| m.stroke == color).unwrap().outline.clone()).collect()
    };
    // Decides whether two outlines are equal except for their position on the page, which is rounded to hundredths.
    let alike = |a: &str, b: &str| {
        let (a, b) = (corners(a), corners(b));
        let off = |(p, q): (&[f64; 2], &[f64; 2])| {
            (0..2).map(|k| (p[k] - a[0][k] - q[k] + b[0][k]).abs()).fold(0.0, f64::max)
        };
        a.len() == b.len() && a.iter().zip(&b).map(off).fold(0.0, f64::max) < 0.05
    };
    let (level, rigid) = (shelves(&text), shelves(&done("task_rigid_again", &sorting(Holding::Rigid))));
    assert!(alike(&level[0], &rigid[0]) && alike(&level[0], &level[2]), "empty-handed");
    assert!(!alike(&level[1], &level[0]) && !alike(&level[1], &rigid[1]), "carrying");
}

#[test]
fn repetitions_are_drawn_once() {
    let objects = vec![object("part", false, Holding::Rigid, [1.2, -0.5])];
    let text = done("task_repeated", &task(objects, fixed(), &[pick(0), place(-1.1, 0.4)], 12));
    let titles = titles(&text);
    assert_eq!(frames(&text).len(), 1 + titles.len());
    // The first round begins elsewhere, and the second where the first ended.
    assert!((3..=6).contains(&titles.len()), "{titles:?}");
    for what in ["Empty hand: step 1", "Carrying part: step 2"] {
        let times = titles.iter().filter_map(|title| title.strip_prefix(what)).map(|end| {
            let many = end.strip_prefix(" (\u{d7}").and_then(|n| n.strip_suffix(')'));
            many.map_or_else(|| usize::from(end.starts_with(", round ")), |n| n.parse().unwrap())
        });
        assert_eq!(times.sum::<usize>(), 12, "{titles:?}");
    }
    assert!(words(&text).contains("first of 12 rounds"));
}

#[test]
fn a_kit_of_like_parts_has_two_configuration_spaces() {
    let rows = |i: usize| [1.15 + 0.22 * (i % 3) as f64, -0.6 + 0.22 * (i / 3) as f64];
    let part = |i: usize| Object {
        pieces: vec![disc(Point::zeros(), 0.05)],
        shape: Shape::Circle { center: Point::zeros(), radius: 0.05 },
        ..object(&format!("part {}", i + 1), true, Holding::Level, rows(i))
    };
    let mut steps = Vec::new();
    for i in 0..13 {
        steps.extend([pick(i), place(-0.5 - 0.25 * (i % 4) as f64, 1.0 - 0.25 * (i / 4) as f64)]);
    }
    let mut kit = task((0..13).map(part).collect(), vec![fixed().swap_remove(1)], &steps, 1);
    // Objects lie below the arm, and are carried above the lying ones.
    for (link, heights) in kit.arm.links.iter_mut().zip([(0.3, 0.4), (0.2, 0.3)]) {
        link.parts.iter_mut().for_each(|p| p.heights = Heights { lower: heights.0, upper: heights.1 });
    }
    for object in &mut kit.objects {
        (object.heights, object.lift) = (Heights { lower: 0.0, upper: 0.05 }, 0.06);
    }
    let text = done("task_kit", &kit);
    // Nothing but the payload changes a configuration space, and all parts are alike.
    assert_eq!(frames(&text).len(), 3);
    let odd: Vec<String> = (1..=13).map(|k| (2 * k - 1).to_string()).collect();
    let titles = titles(&text);
    assert_eq!(titles[0], format!("Empty hand: steps {}", odd.join(", ")));
    assert!(titles[1].starts_with("Carrying part 1 or others: steps 2, 4, "), "{titles:?}");
}

#[test]
fn a_step_that_fails_is_named() {
    let objects = || vec![object("part", false, Holding::Rigid, [1.2, -0.5])];
    let far = [turn_to(1.2, 0.6), pick(0), place(-5.0, 0.0)];
    let farther = [Action::Move(Goal::Tip(Point::new(-7.0, 0.0)))];
    let (first, third) = ("step 1 fails: impossible, proven", "step 3 fails: impossible, proven");
    for (name, steps, step, reason, panels) in [
        ("task_failed", &far[..], third, "step 3, place at (-5, 0) m: no IK solution", 3),
        ("task_failed_at_once", &farther[..], first, "step 1, move the tip to (-7, 0) m: no IK solution", 2),
    ] {
        let task = task(objects(), fixed(), steps, 1);
        let text = drawn(name, &task, &answer(&task));
        let words = words(&text);
        assert!(words.contains(step) && words.contains(reason), "{words}");
        // There are frames of the workspace, of the steps done (if any), and of the failing step.
        assert_eq!(frames(&text).len(), panels);
    }
}

/// Returns the number of hollow diamonds in the picture, including the one in the legend.
fn hollow_diamonds(text: &str) -> usize {
    let tree = roxmltree::Document::parse(text).unwrap();
    let white = tree.descendants().filter(|n| n.has_tag_name("path") && n.attribute("fill") == Some("#ffffff"));
    let outlines = white.filter_map(|n| n.attribute("d")).filter(|outline| !outline.contains('A'));
    // A diamond has four lines whose ends are 14 pixels apart across and along.
    let is_diamond = |outline: &&str| {
        let corners = corners(outline);
        let size = |k: usize| {
            let values = || corners.iter().map(|c| c[k]);
            values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min)
        };
        corners.len() == 4 && (size(0) - 14.0).abs() < 0.05 && (size(1) - 14.0).abs() < 0.05
    };
    outlines.filter(is_diamond).count()
}

/// Checks that the motion that fails is drawn. With the object in the hand, both configurations at the target collide.
#[test]
fn the_motion_that_fails_is_drawn() {
    let held = |holding| vec![object("part", false, holding, [1.2, -0.5])];
    let mut obstacles = fixed();
    obstacles.push(polygon("block", &[(-1.2, 0.35), (-1.1, 0.35), (-1.1, 0.45), (-1.2, 0.45)]));
    let blocked = task(held(Holding::Level), obstacles, &[pick(0), place(-1.1, 0.4)], 1);
    let answer = answer(&blocked);
    let Outcome::Infeasible(why) = &answer.outcome else { panic!("{:?}", answer.outcome) };
    assert_eq!((why.step.number, why.ik_solutions.len()), (2, 2));
    assert_eq!(why.from, answer.legs[0].timed.curve.curve().path().goal());
    assert_eq!(why.scene.attachment().map(|payload| payload.name.as_str()), Some("part"));
    for to in &why.ik_solutions {
        let tip = blocked.arm.tip_at(to.ik_solution);
        assert!((tip - Point::new(-1.1, 0.4)).norm() < 1e-9, "{tip}");
        assert!(to.reason.contains("block") && !why.scene.obstructions(to.ik_solution).is_empty(), "{to:?}");
        let [a, b] = [0, 1].map(|k| (to.ik_solution[k] * 1e4).round() / 1e4);
        assert!(why.reasons.iter().any(|reason| reason.contains(&format!("({a}, {b}) rad"))), "{:?}", why.reasons);
    }
    let text = drawn("task_blocked", &blocked, &answer);
    let words = words(&text);
    assert!(titles(&text).contains(&"Carrying part: step 2 fails".to_owned()), "{words}");
    assert!(words.contains("not reached") && !words.contains("separating boxes"), "{words}");
    let frames = frames(&text);
    assert_eq!((frames.len(), hollow_diamonds(&text)), (3, 3));
    // The hand holds the object in both configurations, and their colour is that of blocked ones.
    let part = color_of(&text, "part");
    assert_eq!(frames[0].iter().filter(|m| m.stroke == part && m.union).count(), 2);
    assert!(frames[2].iter().all(|m| m.stroke != part));
}

/// Checks pictures of one motion. The payload is drawn by its own pieces, and there is no obstacle at its former place.
#[test]
fn pictures_of_one_motion_show_what_is_carried() {
    let task = sorting(Holding::Level);
    let answer = answer(&task);
    let leg = &answer.legs[2];
    let path = leg.timed.curve.curve().outline();
    let picture = Picture {
        title: vec!["carrying".into()],
        goals: &[path.goal().into()],
        paths: vec![("visibility".into(), &path)],
        c_obstacles: &contours(&leg.scene),
        ..Picture::new(&*leg.scene, path.start())
    };
    let text = inspected("carrying", &View::of_picture(&picture));
    let words = words(&text);
    assert!(words.contains("part, carried") && !words.lines().any(|line| line.trim() == "part"), "{words}");
    assert!(!words.contains("outside this picture"));
    let color = color_of(&text, "part, carried");
    let frames = frames(&text);
    // The poses are the start, the goal and five in between, always upright.
    let payload: Vec<&Mark> = frames[0].iter().filter(|m| m.stroke == color && m.union).collect();
    assert_eq!(payload.len(), 7);
    let off = |direction: f64| (direction + 45.0).rem_euclid(90.0) - 45.0;
    assert!(payload.iter().flat_map(|m| directions(&m.outline)).all(|d| off(d).abs() < 0.1));
}
