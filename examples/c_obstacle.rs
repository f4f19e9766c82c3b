//! Builds the C-obstacles of an arm in a workspace and draws them beside it.
//!
//! ```text
//! cargo run --release --example c_obstacle -- robots/planar_2r_continuous.urdf workspaces/wrap_around.toml torus.svg
//! ```

use cplan::cspace::c_obstacles;
use cplan::input;
use cplan::model::Contacts;
use cplan::motion::write_whole;
use cplan::view::{Picture, View, svg};
use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1).map(PathBuf::from);
    let urdf = args.next().unwrap_or_else(|| "robots/planar_2r.urdf".into());
    let world = args.next().unwrap_or_else(|| "workspaces/shelf.toml".into());
    let file = args.next().unwrap_or_else(|| "c_obstacles.svg".into());

    let loaded = input::load(&urdf, &world, &input::Overrides::default())?;
    let scene = loaded.problem.scene();

    // One slice: with joint 1 at its start value, the exact intervals of joint 2 in which shapes collide, and the pairs
    // that collide.
    let start = loaded.problem.start();
    let mut slice = cplan::cspace::Slice::default();
    slice.compute(&Contacts::new(scene), start[0], 0.0);
    println!("with {} at {:.4}, {} must stay out of", scene.arm().joints[0].name, start[0], scene.arm().joints[1].name);
    for interval in &slice.merged {
        println!("  [{:8.4}, {:8.4}] {}", interval[0], interval[1], scene.arm().joints[1].unit());
    }

    // The whole space: the boundaries of the C-obstacles as polygons, accurate to a millimetre in the workspace.
    let contours = c_obstacles(scene, 1e-3, 1e-3);
    println!(
        "{} C-obstacle contours with {} corners",
        contours.len(),
        contours.iter().map(|c| c.contour.len()).sum::<usize>()
    );

    let view = View::of_picture(&Picture {
        title: vec![format!("{}: {}", scene.workspace().name, scene.arm().name)],
        goals: loaded.problem.goals().pieces(),
        c_obstacles: &contours,
        ..Picture::new(scene, start)
    });
    write_whole(&file, svg(&view).as_bytes())?;
    println!("drawn to {}", file.display());
    Ok(())
}
