//! Redraws the pictures of the documentation: each planner on one workspace, one workspace without a path, and two tasks.
//!
//! ```text
//! cargo run --release --example pictures
//! ```

use cplan::cspace::{CObstacle, c_obstacles};
use cplan::draw::{Picture, TaskPicture, svg, task_svg};
use cplan::input::{self, Overrides};
use cplan::model::Scene;
use cplan::solve::{Effort, Method, Verdict, solve};
use cplan::task::{Manner, TaskVerdict, plan};
use cplan::trajectory::{Drive, write_whole};
use std::error::Error;
use std::path::Path;

/// C-obstacles, within less than a pixel.
fn contours(scene: &Scene) -> Vec<CObstacle> {
    let tolerance = 1e-3 * scene.arm.reach();
    c_obstacles(scene, tolerance, tolerance)
}

/// Draws a shipped task.
fn draw_task(robot: &str, world: &str, file: &Path) -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let urdf = root.join("robots").join(robot).with_extension("urdf");
    let world = root.join("workspaces/tasks").join(world).with_extension("toml");
    let task = input::load_scene(&urdf, &world)?.task(&Overrides::default())?.task;
    let manner = Manner { method: Method::Visibility, effort: Effort::default(), drive: Drive::default() };
    let answer = plan(&task, &manner, &mut |_| {});
    let status = match &answer.verdict {
        TaskVerdict::Done => "done, certified",
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
    write_whole(file, task_svg(&picture).as_bytes())?;
    println!("{}", file.display());
    Ok(())
}

/// Draws what `method` answers to a shipped workspace.
fn draw(robot: &str, world: &str, method: Method, file: &Path) -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let urdf = root.join("robots").join(robot).with_extension("urdf");
    let world = root.join("workspaces").join(world).with_extension("toml");
    let problem = input::load(&urdf, &world, &Overrides::default())?.problem;
    let scene = &problem.scene;
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
        title: vec![format!("{}: {}", scene.workspace.name, scene.arm.name), detail],
        status: status.into(),
        scene,
        start: problem.start,
        goals: &problem.goals,
        paths: path.map(|path| (method.to_string(), path)).into_iter().collect(),
        trace: Some(&answer.drawn()),
        proof: answer.verdict.proof(),
        c_obstacles: &contours(scene),
    };
    write_whole(file, svg(&picture).as_bytes())?;
    println!("{}", file.display());
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/pictures");
    std::fs::create_dir_all(&docs)?;
    for method in Method::ALL {
        draw("planar_2r", "workbench", method, &docs.join(format!("{method}.svg")))?;
    }
    draw("planar_2r_continuous", "no_path", Method::Wavefront, &docs.join("no_path.svg"))?;
    draw_task("rrbot_vertical", "tower", &docs.join("tower.svg"))?;
    draw_task("gantry", "board_and_gate", &docs.join("board_and_gate.svg"))
}
