//! Pictures of tasks: pick and place, rigid and level, repeated, large, infeasible.

use super::{inspected, pages, words};
use crate::cli::shipped;
use cplan::Outcome;
use cplan::cspace::{CObstacle, c_obstacles};
use cplan::engine::Method;
use cplan::engine::task::{Event, TaskAnswer, plan};
use cplan::geometry::{Point, Pose};
use cplan::input::{Overrides, Rules, Source, scene_from};
use cplan::model::{Action, Goal, Item, Scene, Task};
use cplan::view::{Picture, TaskPicture, View};
use std::collections::BTreeSet;

fn contours(scene: &Scene) -> Vec<CObstacle> {
    c_obstacles(scene, 2e-3, 2e-3)
}

const HEAD: &str = "name = \"cell\"\n[start]\njoints = [0.2, 2.2]\n[robot]\nPAYLOAD\n\
                    [task]\ndwell = 0.25\n";
const POST: &str = "[[obstacle]]\nname = \"post\"\ncircle = { center = [-0.35, -1.2], radius = 0.14 }\n";
const FIXED: &str = "[[obstacle]]\nname = \"shelf\"\npolygon = [[0.95, 0.55], [1.45, 0.55], [1.45, 0.7], [0.95, 0.7]]\n\
                     [[obstacle]]\nname = \"bin\"\npolygon = [[-1.5, 0.1], [-1.45, 0.1], [-1.45, 0.9], [-1.5, 0.9]]\n";
const PART: &str = "[[object]]\nname = \"part\"\nat = [1.2, -0.5]\nrenew = true\n\
                    polygon = [[-0.09, -0.09], [0.09, -0.09], [0.09, 0.09], [-0.09, 0.09]]\n";
const DISC: &str = "[[object]]\nname = \"disc\"\nat = [0.55, -1.25]\ncircle = { center = [0, 0], radius = 0.09 }\n";

/// Returns the task of a world with this payload, these obstacles and objects, and these steps.
fn task(payload: &str, things: &[&str], steps: &[&str]) -> Task {
    let wrist = if payload == "level" { "wrist = { velocity = 3.0, acceleration = 10.0 }\narch = false\n" } else { "" };
    let head = HEAD.replace("PAYLOAD", &format!("{wrist}payload = \"{payload}\""));
    let steps: String = steps.iter().map(|step| format!("[[step]]\n{step}\n")).collect();
    let world = Source::in_memory("world.toml", format!("{head}{}{steps}", things.concat()));
    let robot = Source::read(shipped("robots/planar_2r.urdf").as_ref()).unwrap();
    let loaded = scene_from(robot, world).and_then(|scene| scene.resolve(&Overrides::default(), Rules::Plan));
    loaded.unwrap_or_else(|error| panic!("{error}")).task.expect("a world with steps")
}

/// Returns a task that moves two objects to two places, with motions before, between and after.
fn sorting(payload: &str) -> Task {
    let steps = [
        "move = { joints = [1.2, 0.6] }",
        "pick = \"part\"",
        "place = { at = [-1.15, 0.75] }",
        "pick = \"disc\"",
        "move = { joints = [1.5, -0.4] }",
        "place = { at = [-1.1, 0.35] }",
        "move = { joints = [0.2, 2.2] }",
    ];
    task(payload, &[FIXED, POST, PART, DISC], &steps)
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
    let text = done("task_rigid", &sorting("rigid"));
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
    for holding in ["rigid", "level"] {
        let name = &format!("task_carried_{holding}");
        let task = task(holding, &[FIXED, POST, PART], &["pick = \"part\"", "move = { joints = [1.8, 0.7] }"]);
        let answer = answer(&task);
        assert_eq!(answer.failed(), None);
        let text = drawn(name, &task, &answer);
        let color = color_of(&text, "part");
        let frames = frames(&text);
        let payload: Vec<&Mark> = frames[0].iter().filter(|m| m.stroke == color && m.union).collect();
        let [payload] = payload[..] else { panic!("{name}: {payload:?}") };
        let grasp = answer.legs[0].timed.curve.curve().path().goal();
        let turned = if holding == "rigid" { (1.8 + 0.7 - grasp[0] - grasp[1]).to_degrees() } else { 0.0 };
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
    let text = done("task_level", &sorting("level"));
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
    let (level, rigid) = (shelves(&text), shelves(&done("task_rigid_again", &sorting("rigid"))));
    assert!(alike(&level[0], &rigid[0]) && alike(&level[0], &level[2]), "empty-handed");
    assert!(!alike(&level[1], &level[0]) && !alike(&level[1], &rigid[1]), "carrying");
}

#[test]
fn repetitions_are_drawn_once() {
    let steps = ["repeat = 12\n[[step.steps]]\npick = \"part\"\n[[step.steps]]\nplace = { at = [-1.1, 0.4] }"];
    let text = done("task_repeated", &task("rigid", &[FIXED, POST, PART], &steps));
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
    // Objects lie below the arm, and are carried above the lying ones.
    let (mut things, mut steps) = (vec![POST.to_owned()], Vec::new());
    for i in 0..13 {
        let [x, y] = [1.15 + 0.22 * f64::from(i % 3), -0.6 + 0.22 * f64::from(i / 3)];
        things.push(format!(
            "[[object]]\nname = \"part {}\"\nat = [{x}, {y}]\ncircle = {{ center = [0, 0], radius = 0.05 }}\n\
             height = [-0.3, -0.25]\nlift = 0.06\n",
            i + 1
        ));
        let [x, y] = [-0.5 - 0.25 * f64::from(i % 4), 1.0 - 0.25 * f64::from(i / 4)];
        steps.extend([format!("pick = \"part {}\"", i + 1), format!("place = {{ at = [{x}, {y}] }}")]);
    }
    let [things, steps] = [&things, &steps].map(|texts| texts.iter().map(String::as_str).collect::<Vec<_>>());
    let kit = task("level", &things, &steps);
    let text = done("task_kit", &kit);
    // Nothing but the payload changes a configuration space, and all parts are alike.
    assert_eq!(frames(&text).len(), 3);
    let odd: Vec<String> = (1..=13).map(|k| (2 * k - 1).to_string()).collect();
    let titles = titles(&text);
    assert_eq!(titles[0], format!("Empty hand: steps {}", odd.join(", ")));
    assert!(titles[1].starts_with("Carrying part 1 or others: steps 2, 4, "), "{titles:?}");
}

/// Checks targets out of reach. The reader of worlds refuses them, so they are put into the task that it read.
#[test]
fn a_step_that_fails_is_named() {
    let far = Action::Place { at: Point::new(-5.0, 0.0), angle: None, supports: Vec::new() };
    let farther = Action::Move(Goal::Tip(Point::new(-7.0, 0.0)));
    let steps = ["move = { joints = [1.2, 0.6] }", "pick = \"part\"", "place = { at = [-0.5, 0] }"];
    for (name, number, action, reason, panels) in [
        ("task_failed", 3, far, "step 3, place at (-5, 0) m: no IK solution", 3),
        ("task_failed_at_once", 1, farther, "step 1, move the tip to (-7, 0) m: no IK solution", 2),
    ] {
        let mut task = task("rigid", &[FIXED, POST, PART], &steps[..number]);
        let Some(Item::Step(last)) = task.items.last_mut() else { panic!("no step") };
        last.action = action;
        let text = drawn(name, &task, &answer(&task));
        let words = words(&text);
        let fails = format!("step {number} fails: impossible, proven");
        assert!(words.contains(&fails) && words.contains(reason), "{words}");
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
    let block = "[[obstacle]]\nname = \"block\"\npolygon = [[-1.2, 0.35], [-1.1, 0.35], [-1.1, 0.45], [-1.2, 0.45]]\n";
    let steps = ["pick = \"part\"", "place = { at = [-1.1, 0.4] }"];
    let blocked = task("level", &[FIXED, POST, block, PART], &steps);
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
    let task = sorting("level");
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
