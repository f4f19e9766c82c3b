//! Redraws the pictures of the documentation: each planner on one workspace, and one workspace without a path.
//!
//! ```text
//! cargo run --release --example pictures
//! ```

use cplan::cspace::c_obstacles;
use cplan::draw::{Picture, svg};
use cplan::input::{self, Overrides};
use cplan::solve::{Effort, Method, Verdict, solve};
use cplan::trajectory::write_whole;
use std::error::Error;
use std::path::Path;

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
    // Within less than a pixel.
    let tolerance = 1e-3 * scene.arm.reach();
    let picture = Picture {
        title: vec![format!("{}: {}", scene.workspace.name, scene.arm.name), detail],
        status: status.into(),
        scene,
        start: problem.start,
        goals: &problem.goals,
        paths: path.map(|path| (method.to_string(), path)).into_iter().collect(),
        trace: Some(&answer.drawn()),
        proof: answer.verdict.proof(),
        c_obstacles: &c_obstacles(scene, tolerance, tolerance),
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
    draw("planar_2r_continuous", "no_path", Method::Wavefront, &docs.join("no_path.svg"))
}
