//! What the pictures of the documentation show. `tests/program/pictures.rs` draws them, too.

use cplan::cspace::{CObstacle, c_obstacles};
use cplan::draw::{Picture, TaskPicture, svg, task_svg};
use cplan::engine::task::{Manner, TaskVerdict, plan};
use cplan::engine::{Effort, Method, Verdict, solve};
use cplan::input::{self, Overrides};
use cplan::model::Scene;
use cplan::motion::Drive;
use std::error::Error;
use std::path::Path;

/// A picture of the documentation.
pub enum Subject {
    /// What a planner answers to a workspace: robot, workspace, planner.
    Answer(&'static str, &'static str, Method),
    /// What comes of a task: robot, workspace in `tasks`.
    Task(&'static str, &'static str),
}

/// All, with the names of their files.
pub const PICTURES: [(&str, Subject); 10] = [
    ("shortest", Subject::Answer("planar_2r", "workbench", Method::Shortest)),
    ("visibility", Subject::Answer("planar_2r", "workbench", Method::Visibility)),
    ("trapezoid", Subject::Answer("planar_2r", "workbench", Method::Trapezoid)),
    ("wavefront", Subject::Answer("planar_2r", "workbench", Method::Wavefront)),
    ("harmonic", Subject::Answer("planar_2r", "workbench", Method::Harmonic)),
    ("subdivision", Subject::Answer("planar_2r", "workbench", Method::Subdivision)),
    ("no_path", Subject::Answer("planar_2r_continuous", "no_path", Method::Wavefront)),
    ("scara_cell", Subject::Answer("scara", "scara_cell", Method::Shortest)),
    ("tower", Subject::Task("rrbot_vertical", "tower")),
    ("board_and_gate", Subject::Task("gantry", "board_and_gate")),
];

impl Subject {
    /// The picture, SVG.
    pub fn svg(&self) -> Result<String, Box<dyn Error>> {
        match *self {
            Subject::Answer(robot, world, method) => answer(robot, world, method),
            Subject::Task(robot, world) => task(robot, world),
        }
    }
}

/// C-obstacles, within less than a pixel.
fn contours(scene: &Scene) -> Vec<CObstacle> {
    let tolerance = 1e-3 * scene.arm().reach();
    c_obstacles(scene, tolerance, tolerance)
}

/// What comes of a shipped task.
fn task(robot: &str, world: &str) -> Result<String, Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let urdf = root.join("robots").join(robot).with_extension("urdf");
    let world = root.join("workspaces/tasks").join(world).with_extension("toml");
    let task = input::load_scene(&urdf, &world)?.task(&Overrides::default())?.task;
    let manner = Manner { method: Method::Shortest, effort: Effort::default(), drive: Drive::default() };
    let answer = plan(&task, &manner, &mut |_| {});
    let status = match &answer.verdict {
        TaskVerdict::Found(()) => "done, certified",
        TaskVerdict::Infeasible(_) => "impossible, proven",
        TaskVerdict::Unknown(_) => "unknown",
    };
    let picture = TaskPicture {
        title: vec![format!("{}: {}", task.workspace.name, task.arm.name), format!("{:.3} s", answer.duration())],
        status: status.into(),
        task: &task,
        answer: &answer,
        c_obstacles: contours,
    };
    Ok(task_svg(&picture))
}

/// What `method` answers to a shipped workspace.
fn answer(robot: &str, world: &str, method: Method) -> Result<String, Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let urdf = root.join("robots").join(robot).with_extension("urdf");
    let world = root.join("workspaces").join(world).with_extension("toml");
    let problem = input::load(&urdf, &world, &Overrides::default())?.problem;
    let scene = problem.scene();
    let answer = solve(&problem, method, &Effort::default(), &mut |_| {});
    let (status, detail, path) = match &answer.verdict {
        Verdict::Found(certified) => {
            let (length, clearance) = (certified.path().length(), 1e3 * certified.clearance());
            let detail = format!("{method}: length {length:.3}, proven clearance {clearance:.2} mm");
            ("found, certified", detail, Some(certified.path()))
        }
        Verdict::Infeasible(proof) => {
            let detail =
                format!("{method}: {} boxes of colliding configurations separate the two", proof.stuck().len());
            ("no path: proven", detail, None)
        }
        Verdict::Unknown(reason) => ("unknown", reason.clone(), None),
    };
    let picture = Picture {
        title: vec![format!("{}: {}", scene.workspace().name, scene.arm().name), detail],
        status: status.into(),
        scene,
        start: problem.start(),
        goals: problem.goals().pieces(),
        paths: path.map(|path| (method.to_string(), path)).into_iter().collect(),
        trace: Some(&answer.drawn()),
        proof: answer.verdict.proof(),
        c_obstacles: &contours(scene),
    };
    Ok(svg(&picture))
}
