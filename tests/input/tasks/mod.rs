//! Objects and steps of the world file, read into a task.

use cplan::geometry::Point;
use cplan::input::{InputError, Overrides, Rules, load, load_scene};
use cplan::model::{Action, Goal, Holding, Item, Obstacle, Scene, Shape, Step, Task};
use cplan::space::Configuration;
use std::fs;
use std::path::Path;

mod errors;
mod pallets;
mod written_out;

/// A world with objects and the start of the arm, without steps.
const CELL: &str = r#"name = "cell"
[robot]
wrist = { velocity = 6.0, acceleration = 60.0 }
[start]
joints = [0.0, 0.5]
[[obstacle]]
name = "table"
circle = { center = [1.0, 1.2], radius = 0.3 }
[[object]]
name = "part"
polygon = [[-0.02, -0.02], [0.02, -0.02], [0.02, 0.02], [-0.02, 0.02]]
at = [1.0, 1.0]
supports = ["table"]
renew = true
[[object]]
name = "cup"
circle = { center = [0.01, 0], radius = 0.03 }
at = [-0.5, 1.0]
angle = 0.5
height = [0.0, 0.1]
lift = 0.05
payload = "level"
grasp = [0.01, 0.0]
"#;

/// Reads a world for an arm with two links, of 1 m and 0.8 m, and limits of 2.9 rad.
fn with_world<T>(world: &str, read: impl Fn(&Path, &Path) -> T) -> T {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("world.toml");
    fs::write(&file, world).unwrap();
    read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("robots/planar_2r.urdf"), &file)
}

/// A task, its scene, and the notes about it.
#[derive(Debug)]
struct LoadedTask {
    task: Task,
    scene: Scene,
    notes: Vec<String>,
}

fn task_of(world: &str, overrides: &Overrides) -> Result<LoadedTask, InputError> {
    let loaded = with_world(world, |urdf, world| load_scene(urdf, world)?.resolve(overrides, Rules::Plan))?;
    let task = loaded.task.expect("a world with steps");
    Ok(LoadedTask { task, scene: loaded.problem.into_scene(), notes: loaded.notes })
}

fn task(steps: &str) -> LoadedTask {
    task_of(&format!("{CELL}{steps}"), &Overrides::default()).unwrap_or_else(|e| panic!("{e}"))
}

/// Returns the steps as texts `number.cycle: action`, with groups in brackets.
fn step_texts(loaded: &LoadedTask) -> Vec<String> {
    let objects = &loaded.task.objects;
    let step = |s: &Step| format!("{}.{}: {}", s.number, s.cycle, s.action.describe(objects));
    let item = |item: &Item| match item {
        Item::Step(s) => step(s),
        Item::AnyOrder(pairs) => format!("[{}]", pairs.iter().flatten().map(step).collect::<Vec<_>>().join(", ")),
        Item::Renew(renewed) => {
            format!("renew {}", renewed.iter().map(|o| objects[*o].name.as_str()).collect::<Vec<_>>().join(", "))
        }
    };
    loaded.task.items.iter().map(item).collect()
}

#[test]
fn steps_become_a_task() {
    let loaded = task(
        r#"[[step]]
pick = "part"
dwell = 0.2
[[step]]
place = { at = [0.5, 1.5] }
speed = 0.5
[[step]]
pick = "cup"
grasp = [0.02, 0.0]
supports = ["part"]
[[step]]
place = { at = [0.5, 1.0], angle = 1.5, supports = ["table", "part"] }
[[step]]
move = { joints = [0.1, 0.2] }
[[step]]
move = { tip = [1.0, 1.0] }
"#,
    );
    let task = &loaded.task;
    let [part, cup] = &task.objects[..] else { panic!("two objects") };
    assert_eq!((part.name.as_str(), part.holding, part.lift), ("part", Holding::Rigid, 0.0));
    assert_eq!((cup.name.as_str(), cup.holding, cup.lift), ("cup", Holding::Level, 0.05));
    assert_eq!((cup.heights.lower, cup.heights.upper), (0.0, 0.1));
    assert!((cup.at.rotation.angle() - 0.5).abs() < 1e-15);
    assert_eq!(cup.at.translation, nalgebra::Vector2::new(-0.5, 1.0));
    assert_eq!(cup.shape, Shape::Circle { center: Point::new(0.01, 0.0), radius: 0.03 });
    assert_eq!(task.wrist.map(|w| (w.velocity, w.acceleration)), Some((6.0, 60.0)));
    assert_eq!(task.workspace.fixed.obstacles.len(), 1);
    assert_eq!(task.start, Configuration::new(0.0, 0.5));
    let steps: Vec<&Step> = task.steps().collect();
    let actions: Vec<&Action> = steps.iter().map(|s| &s.action).collect();
    assert_eq!(
        actions,
        [
            &Action::Pick { object: 0, grasp: Point::zeros(), supports: vec![0], when: Vec::new() },
            &Action::Place { at: Point::new(0.5, 1.5), angle: None, supports: vec![0] },
            &Action::Pick { object: 1, grasp: Point::new(0.02, 0.0), supports: vec![1], when: Vec::new() },
            &Action::Place { at: Point::new(0.5, 1.0), angle: Some(1.5), supports: vec![0, 1] },
            &Action::Move(Goal::Joints(Configuration::new(0.1, 0.2))),
            &Action::Move(Goal::Tip(Point::new(1.0, 1.0))),
        ]
    );
    let paces: Vec<(f64, f64)> = steps.iter().map(|s| (s.speed, s.dwell)).collect();
    assert_eq!(paces[..3], [(1.0, 0.2), (0.5, 0.0), (1.0, 0.0)]);
    assert!(steps[1].place.ends_with("world.toml:27:1"), "{}", steps[1].place);
}

#[test]
fn objects_are_obstacles_where_they_lie_at_first() {
    let loaded = task("[[step]]\npick = \"part\"\n");
    let names = |obstacles: &[Obstacle]| obstacles.iter().map(|o| o.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&loaded.scene.workspace().obstacles), ["table", "part", "cup"]);
    assert_eq!(names(&loaded.task.workspace.fixed.obstacles), ["table"]);
    assert_eq!(loaded.scene.workspace().obstacles[2].shape, {
        let (sin, cos) = 0.5f64.sin_cos();
        Shape::Circle { center: Point::new(-0.5 + 0.01 * cos, 1.0 + 0.01 * sin), radius: 0.03 }
    });
    let goal = format!("{CELL}[goal]\njoints = [0.1, -0.5]\n");
    let problem = with_world(&goal, |u, w| load(u, w, &Overrides::default())).unwrap().problem;
    assert_eq!(names(&problem.scene().workspace().obstacles), ["table", "part", "cup"]);
}

#[test]
fn repetitions_are_written_out() {
    let loaded = task(
        r#"[task]
repeat = 2
speed = 0.8
dwell = 0.1
[[step]]
repeat = 2
dwell = 0.3
[[step.steps]]
pick = "part"
[[step.steps]]
place = { at = [0.5, 1.5] }
dwell = 0.0
[[step]]
move = { joints = [0.0, 0.5] }
speed = 1
"#,
    );
    let once = |c: usize, d: usize| {
        vec![
            format!("1.{c}: pick \"part\""),
            format!("2.{c}: place at (0.5, 1.5) m"),
            "renew part".into(),
            format!("1.{}: pick \"part\"", c + 1),
            format!("2.{}: place at (0.5, 1.5) m", c + 1),
            format!("3.{d}: move to joints (0, 0.5)"),
        ]
    };
    assert_eq!(step_texts(&loaded), [once(1, 1), vec!["renew part".into()], once(3, 2)].concat());
    let paces: Vec<(f64, f64)> = loaded.task.steps().take(3).map(|s| (s.speed, s.dwell)).collect();
    assert_eq!(paces, [(0.8, 0.3), (0.8, 0.0), (0.8, 0.3)]);
    assert_eq!(loaded.task.steps().nth(4).map(|s| (s.speed, s.dwell)), Some((1.0, 0.1)));
}

#[test]
fn a_free_order_keeps_pairs_together() {
    let pairs = r#"pick = "part"
[[KEY]]
place = { at = [0.5, 1.5] }
[[KEY]]
pick = "cup"
[[KEY]]
place = { at = [0.5, 1.0] }
"#;
    let words = "[1.1: pick \"part\", 2.1: place at (0.5, 1.5) m, 3.1: pick \"cup\", 4.1: place at (0.5, 1) m]";
    let all = task(&format!("[task]\norder = \"free\"\n[[step]]\n{}", pairs.replace("KEY", "step")));
    assert_eq!(step_texts(&all), [words]);
    let group = task(&format!("[[step]]\norder = \"free\"\n[[step.steps]]\n{}", pairs.replace("KEY", "step.steps")));
    assert_eq!(step_texts(&group), [words]);
}

#[test]
fn defaults_of_the_robot_hold_where_an_object_does_not_say_otherwise() {
    let world = CELL.replace("[robot]", "[robot]\npayload = \"level\"").replace(", acceleration = 60.0", "");
    let loaded = task_of(&format!("{world}[[step]]\npick = \"part\"\n"), &Overrides::default()).unwrap();
    assert!(loaded.task.objects.iter().all(|o| o.holding == Holding::Level));
    assert_eq!(loaded.task.wrist.map(|w| w.acceleration), Some(24.0));
    assert!(loaded.notes.iter().any(|n| n.contains("wrist: no acceleration limit given; 24 rad/s2 assumed")));
}

#[test]
fn options_replace_start_and_clearance() {
    let overrides =
        Overrides { start: Some("10deg,0".parse().unwrap()), clearance: Some(0.01), ..Overrides::default() };
    let loaded = task_of(&format!("{CELL}[[step]]\npick = \"cup\"\n"), &overrides).unwrap();
    assert!((loaded.task.start[0] - 10f64.to_radians()).abs() < 1e-15);
    assert_eq!((loaded.task.workspace.fixed.clearance, loaded.scene.workspace().clearance), (0.01, 0.01));
}

#[test]
fn an_orientation_that_the_object_has_needs_no_wrist() {
    let turn = "wrist = { velocity = 6.0, acceleration = 60.0 }\n";
    let steps = "[[step]]\npick = \"cup\"\n[[step]]\nplace = { at = [0.5, 1.0], angle = 6.783185307179586 }\n";
    let loaded = task_of(&format!("{}{steps}", CELL.replace(turn, "")), &Overrides::default()).unwrap();
    let Some(Action::Place { angle: Some(angle), .. }) = loaded.task.steps().nth(1).map(|s| s.action.clone()) else {
        panic!("a place with an angle")
    };
    assert_eq!(angle, loaded.task.objects[1].at.rotation.angle());
}

#[test]
fn obstacles_of_one_name_support_together() {
    let second = "[[obstacle]]\nname = \"table\"\ncircle = { center = [-1.0, 1.2], radius = 0.3 }\n[[object]]";
    let world = CELL.replacen("[[object]]", second, 1);
    let loaded = task_of(&format!("{world}[[step]]\npick = \"part\"\n"), &Overrides::default()).unwrap();
    let Some(Action::Pick { supports, .. }) = loaded.task.steps().next().map(|s| s.action.clone()) else {
        panic!("a pick")
    };
    assert_eq!(supports, [0, 1]);
}

#[test]
fn steps_count_for_more_than_the_goal_of_a_map() {
    let maps = Path::new(env!("CARGO_MANIFEST_DIR")).join("workspaces");
    let map = format!(
        "[map]\nfile = \"{}\"\npreferences = \"{}\"\noffset = [50, 50]\n[[step]]\npick = \"part\"\n",
        maps.join("store_room.map").display(),
        maps.join("store_room_wishes.map").display()
    );
    assert_eq!(task_of(&format!("{CELL}{map}"), &Overrides::default()).unwrap().task.steps().count(), 1);
}

#[test]
fn the_book_shows_what_can_be_written() {
    let page = include_str!("../../../docs/world_file.md");
    let block = page.split("```toml\n").map(|b| b.split("```").next().unwrap_or_default());
    let block = block.filter(|b| b.contains("[[step]]")).collect::<Vec<_>>();
    let [block, pallets] = block[..] else { panic!("two blocks with steps") };
    // The robot of these tests has no joint that could lower a tool.
    let words = ["default: no stroke", "arch = {", "these are the defaults. false"];
    let stroke = |line: &&str| line.starts_with("stroke = ") || words.iter().any(|words| line.contains(words));
    assert_eq!(block.lines().filter(stroke).count(), 4);
    let block: String = block.lines().filter(|line| !stroke(line)).map(|line| format!("{line}\n")).collect();
    let circle = |table: &str, name: &str, center: &str| {
        format!("[[{table}]]\nname = \"{name}\"\ncircle = {{ center = {center}, radius = 0.02 }}\n")
    };
    let rest = [
        "[start]\njoints = [2.5, 0.0]\n".to_owned(),
        circle("obstacle", "table", "[0.3, 0.15]"),
        circle("obstacle", "tray", "[-0.1, 0.4]"),
        circle("object", "lid", "[0, 0]") + "at = [0.4, 0.5]\n",
    ];
    let loaded = task_of(&format!("{block}{}", rest.concat()), &Overrides::default()).unwrap();
    assert_eq!(loaded.task.steps().count(), 10 * (3 + 2 * 100));
    assert_eq!(loaded.task.items.iter().filter(|item| matches!(item, Item::AnyOrder(_))).count(), 1000);
    let feeder = "[[pallet]]\nname = \"feeder\"\nrows = 5\ncolumns = 4\npitch = [0.05, 0.05]\nat = [1.0, 0.5]\n";
    let scene = with_world(&format!("{pallets}{feeder}"), |urdf, world| load_scene(urdf, world))
        .unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(scene.world.objects.len(), 20);
}
