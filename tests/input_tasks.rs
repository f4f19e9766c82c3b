//! The world file's objects and steps, read into a task.

use cplan::geometry::Point;
use cplan::input::{InputError, LoadedTask, Overrides, load, load_scene};
use cplan::model::{Action, Goal, Holding, Item, Shape, Step};
use cplan::space::Configuration;
use std::fs;

/// An arm with two links of one metre, in the (x, y) plane.
const ARM: &str = r#"<robot name="arm">
  <link name="base"/>
  <joint name="j1" type="revolute">
    <parent link="base"/> <child link="upper"/>
    <axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="2"/>
  </joint>
  <link name="upper">
    <collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision>
  </link>
  <joint name="j2" type="revolute">
    <parent link="upper"/> <child link="fore"/>
    <origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" effort="1" velocity="2"/>
  </joint>
  <link name="fore">
    <collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision>
  </link>
  <joint name="end" type="fixed"><parent link="fore"/><child link="tool"/><origin xyz="1 0 0"/></joint>
  <link name="tool"/>
</robot>
"#;

/// Objects, and where the arm starts; steps follow.
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

fn with_files<T>(world: &str, read: impl Fn(&std::path::Path, &std::path::Path) -> T) -> T {
    let folder = tempfile::tempdir().unwrap();
    let (u, w) = (folder.path().join("arm.urdf"), folder.path().join("world.toml"));
    fs::write(&u, ARM).unwrap();
    fs::write(&w, world).unwrap();
    read(&u, &w)
}

fn task_of(world: &str, overrides: &Overrides) -> Result<LoadedTask, InputError> {
    with_files(world, |urdf, world| load_scene(urdf, world)?.task(overrides))
}

fn task(steps: &str) -> LoadedTask {
    task_of(&format!("{CELL}{steps}"), &Overrides::default()).unwrap_or_else(|e| panic!("{e}"))
}

/// The steps in words, `number.cycle: what`; groups in brackets.
fn in_words(loaded: &LoadedTask) -> Vec<String> {
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
    assert_eq!(cup.at.translation.vector, nalgebra::Vector2::new(-0.5, 1.0));
    assert_eq!(cup.shape, Shape::Circle { center: Point::new(0.01, 0.0), radius: 0.03 });
    assert_eq!(task.wrist.map(|w| (w.velocity, w.acceleration)), Some((6.0, 60.0)));
    assert_eq!(task.workspace.obstacles.len(), 1);
    assert_eq!(task.start, Configuration::new(0.0, 0.5));
    let steps: Vec<&Step> = task.steps().collect();
    let actions: Vec<&Action> = steps.iter().map(|s| &s.action).collect();
    assert_eq!(
        actions,
        [
            &Action::Pick { object: 0, grasp: Point::origin(), supports: vec![0] },
            &Action::Place { at: Point::new(0.5, 1.5), angle: None, supports: vec![0] },
            &Action::Pick { object: 1, grasp: Point::new(0.02, 0.0), supports: vec![1] },
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
    let names = |w: &cplan::model::Workspace| w.obstacles.iter().map(|o| o.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&loaded.scene.workspace), ["table", "part", "cup"]);
    assert_eq!(names(&loaded.task.workspace), ["table"]);
    assert_eq!(loaded.scene.workspace.obstacles[2].shape, {
        let (sin, cos) = 0.5f64.sin_cos();
        Shape::Circle { center: Point::new(-0.5 + 0.01 * cos, 1.0 + 0.01 * sin), radius: 0.03 }
    });
    let goal = format!("{CELL}[goal]\njoints = [0.1, -0.5]\n");
    let problem = with_files(&goal, |u, w| load(u, w, &Overrides::default())).unwrap().problem;
    assert_eq!(names(&problem.scene.workspace), ["table", "part", "cup"]);
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
    assert_eq!(in_words(&loaded), [once(1, 1), vec!["renew part".into()], once(3, 2)].concat());
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
    assert_eq!(in_words(&all), [words]);
    let group = task(&format!("[[step]]\norder = \"free\"\n[[step.steps]]\n{}", pairs.replace("KEY", "step.steps")));
    assert_eq!(in_words(&group), [words]);
}
