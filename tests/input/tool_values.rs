//! Values of the tool's joints in `[start]` and `[goal]`: how they are read, and which are refused.

use crate::{changes, fits, with_change};
use cplan::engine::Options;
use cplan::input::{InputError, Overrides, Rules, Source, load_recording, scene_from};
use cplan::model::{Action, Goal, Task};
use cplan::{Outcome, Problem, plan};
use std::path::Path;

const ROBOT: &str = "[robot]\njoints = [\"axis_1\", \"axis_2\"]\nstroke = { joint = \"axis_3\" }\n\
                     wrist = { joint = \"axis_4\", velocity = 20 }\n";
const START: &str = "[start]\njoints = [0.5, 1.0]\nstroke = -0.05\n";
const GOAL: &str = "[goal]\njoints = [-0.8, -0.9]\nstroke = -0.06\nwrist = \"90deg\"\n";

fn scara() -> Source {
    Source::read(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/robots/scara.urdf"))).unwrap()
}

fn task(world: &str, overrides: &Overrides) -> Result<Task, InputError> {
    let scene = scene_from(scara(), Source::in_memory("world.toml", world))?;
    Ok(scene.resolve(overrides, Rules::Plan)?.task.expect("values of the tool"))
}

#[track_caller]
fn refused(world: &str, pattern: &str) {
    let error = task(world, &Overrides::default()).expect_err("should be refused").to_string();
    fits(&error, &format!("hint:  ... {pattern}"));
}

#[test]
fn values_make_the_motion_a_task_of_one_move() {
    let world = [ROBOT, START, GOAL].concat();
    let task = task(&world, &Overrides::default()).unwrap();
    let steps: Vec<_> = task.steps().collect();
    let [step] = steps[..] else { panic!("{steps:?}") };
    assert!(matches!(step.action, Action::Move(Goal::Joints(q)) if [q[0], q[1]] == [-0.8, -0.9]), "{step:?}");
    assert_eq!((task.start_tool.depth, task.start_tool.wrist), (0.05, Some(0.0)));
    assert_eq!((step.tool.depth, step.tool.wrist), (0.06, Some(std::f64::consts::FRAC_PI_2)));
    assert_eq!(step.place, "world.toml:9:10");
    assert!(task.check().is_ok());
}

#[test]
fn a_goal_on_the_command_line_keeps_the_values() {
    let world = [ROBOT, START, GOAL].concat();
    let overrides = Overrides { goal: Some("0.1,0.2".parse().unwrap()), ..Overrides::default() };
    let task = task(&world, &overrides).unwrap();
    let step = task.steps().next().unwrap();
    assert!(matches!(step.action, Action::Move(Goal::Joints(q)) if [q[0], q[1]] == [0.1, 0.2]), "{step:?}");
    assert_eq!(step.tool.depth, 0.06);
    let scene = scene_from(scara(), Source::in_memory("world.toml", world)).unwrap();
    let plan = plan(&Problem::of_scene(scene, &overrides).unwrap(), &Options::default()).unwrap();
    let error = plan.certificate(&overrides, None).unwrap_err().to_string();
    assert!(error.contains("the goal must be in the world file"), "{error}");
}

#[test]
fn a_wrist_without_a_value_at_the_goal_stays() {
    let goal = GOAL.replace("wrist = \"90deg\"\n", "");
    let world = [ROBOT, START, "wrist = 0.7\n", &goal].concat();
    let task = task(&world, &Overrides::default()).unwrap();
    let step = task.steps().next().unwrap();
    assert_eq!((task.start_tool.wrist, step.tool.wrist), (Some(0.7), Some(0.7)));
}

/// Tests limits at which a stroke would last for longer than a million seconds.
#[test]
fn strokes_that_take_for_ever_are_refused() {
    for limit in ["velocity = 1e-12", "acceleration = 1e-300", "jerk = 1e-30"] {
        let robot = ROBOT.replace("joint = \"axis_3\"", &format!("joint = \"axis_3\", {limit}"));
        refused(&[&robot, START, GOAL].concat(), "at most a million seconds ... raise the limits");
    }
}

/// Tests a value of the wrist alone: the tool stays raised, and the wrist takes longer than the arm.
#[test]
fn the_wrist_alone_is_a_task_and_may_take_longest() {
    let urdf = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/robots/scara.urdf"));
    let folder = tempfile::tempdir().unwrap();
    let world = folder.path().join("world.toml");
    let robot = "[robot]\njoints = [\"axis_1\", \"axis_2\"]\n\
                 wrist = { joint = \"axis_4\", velocity = 1, acceleration = 4 }\n";
    let ends = "[start]\njoints = [0.5, 1.0]\nwrist = -1\n[goal]\njoints = [0.6, 1.0]\nwrist = 2\n";
    std::fs::write(&world, format!("{robot}{ends}")).unwrap();
    let problem = Problem::load(urdf, &world).unwrap();
    let plan = plan(&problem, &Options::default()).unwrap();
    let (_, answer) = plan.task().unwrap();
    let Outcome::Found(motion) = &answer.outcome else { panic!("{:?}", answer.failed()) };
    // Three radians at 1 rad/s, with 0.25 s for each ramp.
    assert!((motion.seconds() - 3.25).abs() < 1e-6, "{}", motion.seconds());
    assert!(answer.gap().is_some_and(|gap| gap < 1e-6), "{:?}", answer.gap());
}

#[test]
fn invalid_values_are_refused() {
    let table = r#"
-0.05 => -0.5 => world.toml: line 7, column 10 ... axis_3 ... [-0.18, 0]
90deg => 900deg => line 11, column 9 ... axis_4 ... outside its limits
-0.06 => nan => line 10 ... stroke
" => "10deg" => line 10, column 10
[-0.8, -0.9] => [-8, -0.9] => the goal is outside the joint limits
GOAL => nothing => there is no goal
" => [goal]\nareas = [[[0.2, 0.2], [0.3, 0.3]]]\n => goal of areas ... hint: joints
" => [[step]]\nmove = { joints = [0.1, 0.2], stroke = -0.05 }\n => line 9 ... move: a step cannot have values of the tool's joints
stroke = { joint = "axis_3" } => nothing => the start has a value `stroke` ... names no joint that lowers the tool
wrist = { joint = "axis_4", velocity = 20 } => nothing => the goal has a value `wrist` ... names no joint that turns the tool
[goal] => [[obstacle]]\nname = "hut"\ncircle = { center = [0.28, 0.39], radius = 0.03 }\nheight = [0, 0.16]\n[goal]
    => line 6 ... not free while the tool is lowered ... hut
" => [[obstacle]]\nname = "cart"\ncircle = { center = [1, 1], radius = 0.1 }\nmotion = { velocity = [0.1, 0] }\n[goal]
    => "cart" moves ... only if all obstacles are static
"#;
    for row in changes(&table.replace("GOAL", &GOAL.replace('\n', "\\n"))) {
        refused(&with_change(&[ROBOT, START, GOAL].concat(), &row[0], &row[1]), &row[2]);
    }
}

#[test]
fn other_commands_refuse_such_worlds() {
    let scene = scene_from(scara(), Source::in_memory("world.toml", [ROBOT, START, GOAL].concat())).unwrap();
    assert!(scene.is_task() && !scene.has_steps());
    let error = scene.problem(&Overrides::default()).unwrap_err().to_string();
    assert!(error.contains("only `cplan plan` and `cplan verify`") && error.contains("hint: "), "{error}");
}

/// Tests that results with damaged values of the tool are refused.
#[test]
fn damaged_results_are_refused() {
    let world = [ROBOT, START, GOAL].concat();
    let scene = scene_from(scara(), Source::in_memory("world.toml", world)).unwrap();
    let problem = Problem::of_scene(scene.clone(), &Overrides::default()).unwrap();
    let json = plan(&problem, &Options::default()).unwrap().to_json();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("result.json");
    let mut value: serde_json::Value = serde_json::from_str(&json).unwrap();
    for (member, wrong, part) in
        [("/steps/0/wrist/begin", 1e9, "the wrist's begin is"), ("/steps/0/raising/after_departure", -1.0, "raising's")]
    {
        let right = std::mem::replace(value.pointer_mut(member).unwrap(), wrong.into());
        std::fs::write(&file, value.to_string()).unwrap();
        let error = load_recording(&file, &scene).unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
        *value.pointer_mut(member).unwrap() = right;
    }
}
