//! The pictures of the documentation, which `tests/program/pictures.rs` draws as well.

use crate::root;
use cplan::PlanOutput as _;
use cplan::engine::{Method, Planner, Setting};
use cplan::field::{Attraction, Khatib, Limits, Repulsion};
use cplan::planner::{FieldChoice, FieldPlanner, PathKind};
use cplan::{Options, Plan, Problem, plan};
use std::error::Error;
use std::path::Path;

/// A picture of the documentation.
pub enum Subject {
    /// A planner's answer in a workspace: robot, workspace, planner.
    Answer(&'static str, &'static str, Method),
    /// The potential field of a constant attraction and of repulsion by all obstacle cells: robot, workspace, charge of
    /// a cell.
    Forces(&'static str, &'static str, f64),
    /// The result of a task: robot, and workspace in the folder `tasks`.
    Task(&'static str, &'static str),
}

/// Pictures of the documentation with the names of their files.
pub const PICTURES: [(&str, Subject); 18] = [
    ("shortest", Subject::Answer("planar_2r", "workbench", Method::Shortest)),
    ("visibility", Subject::Answer("planar_2r", "workbench", Method::Visibility)),
    ("trapezoid", Subject::Answer("planar_2r", "workbench", Method::Trapezoid)),
    ("voronoi", Subject::Answer("planar_2r", "workbench", Method::Voronoi)),
    ("wavefront", Subject::Answer("planar_2r", "workbench", Method::Wavefront)),
    ("harmonic", Subject::Answer("planar_2r", "workbench", Method::Harmonic)),
    ("khatib_trapped", Subject::Forces("stage_robot", "published/cup", 1.0)),
    ("khatib_cured", Subject::Forces("stage_robot", "published/cup", 3.0)),
    ("khatib_blocked", Subject::Forces("stage_robot", "published/cup", 4.0)),
    ("subdivision", Subject::Answer("planar_2r", "workbench", Method::Subdivision)),
    ("no_path", Subject::Answer("planar_2r_continuous", "no_path", Method::Wavefront)),
    ("scara_cell", Subject::Answer("scara", "scara_cell", Method::Shortest)),
    ("upright", Subject::Answer("rrbot_vertical", "upright", Method::Shortest)),
    ("crossing", Subject::Answer("planar_2r", "moving/crossing", Method::Shortest)),
    ("belt", Subject::Answer("planar_2r", "moving/belt_pick", Method::Shortest)),
    ("arch", Subject::Answer("scara", "arch/pick_and_place", Method::Shortest)),
    ("tower", Subject::Task("rrbot_vertical", "tower")),
    ("board_and_gate", Subject::Task("gantry", "board_and_gate")),
];

/// The animated picture at the top of the README: the names of its file, and of the still picture of the same scene.
pub const MOVING: (&str, &str) = ("thinking", "shortest");

impl Subject {
    /// Draws the picture as SVG, as the program does.
    pub fn svg(&self) -> Result<String, Box<dyn Error>> {
        Ok(self.plan()?.svg())
    }

    /// Plans as the program does.
    pub fn plan(&self) -> Result<Plan, Box<dyn Error>> {
        let (robot, world, options) = match *self {
            Subject::Answer(robot, world, method) => (robot, Path::new("").join(world), method.into()),
            Subject::Forces(robot, world, charge) => (robot, Path::new("").join(world), by_forces(charge)),
            Subject::Task(robot, world) => (robot, Path::new("tasks").join(world), Options::default()),
        };
        let urdf = root().join("robots").join(robot).with_extension("urdf");
        let world = root().join("workspaces").join(world).with_extension("toml");
        Ok(plan(&Problem::load(urdf, world)?, &options)?)
    }
}

/// Returns options for a planner by attraction and repulsion, with one attempt on 80 x 80 cells.
fn by_forces(charge: f64) -> Options {
    let laws = Khatib { attraction: Attraction::Constant(1.0), repulsion: Repulsion::Sum(charge), saturated: false };
    let (limits, path) = (Limits::High, PathKind::Own);
    let field = Some(FieldPlanner { field: FieldChoice::Khatib(laws), limits, escape: None, path });
    let planner = Planner::named(Method::Harmonic).with(Setting::Field, |settings| settings.field = field);
    Options { levels: 1, ..Options::from(planner.with_cells(80)) }
}
