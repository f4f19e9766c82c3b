//! A robot with two driven wheels follows a plan by the controllers of the literature: from waypoint to waypoint, and
//! along the cells of a wavefront and of A\*. It also drives without a plan.
//!
//! ```text
//! cargo run --example differential_drive [-- FOLDER]
//! ```
//!
//! With a folder, it writes a picture of both routes there.

use cplan::engine::{CellCounts, GridSpace, Method, Planner, Setting};
use cplan::planner::{GridSearch, PathKind};
use cplan::{Options, Problem, plan};
use cplan_testkit::mobile::floor::Floor;
use cplan_testkit::mobile::robot::Robot;
use cplan_testkit::mobile::tanh::{AHEAD, DEVIATION, Drive, Tanh, follow, waypoints};
use cplan_testkit::mobile::tracking::{Tracked, Tracking, track};
use cplan_testkit::mobile::{START, TARGETS};
use std::error::Error;
use std::path::{Path, PathBuf};

/// Constants of the controller that follows waypoints. Its repulsion acts within the body's radius and part of the
/// clearance, where the planned path never goes.
const LAW: Tanh = Tanh { pull: 10.0, push: 1.0, range: 0.26 };

/// Constants of the controller without a plan. It must react to obstacles earlier than the other one.
const ALONE: Tanh = Tanh { pull: 1.0, push: 1.0, range: 1.0 };

/// Constants of the controller that follows the cells of a grid path. The gain is that of the source.
const ALONG_CELLS: Tracking = Tracking { gain: 1.0, speed: 0.5 };

/// A problem on a grid: robot, world, number of cells, how cells are tested for collisions, start and goal.
type Gridded = (&'static str, &'static str, [usize; 2], GridSpace, [f64; 2], [f64; 2]);

/// Problems on grids: the two rooms of the mission, in which a wall is thinner than a cell, and the source's own map
/// with its cells, start and goal.
const GRIDS: [Gridded; 3] = [
    ("mobile_robot", "explore/hall.toml", [40, 20], GridSpace::Rows, START, TARGETS[0].1),
    ("mobile_robot", "explore/house.toml", [40, 20], GridSpace::Rows, START, TARGETS[0].1),
    ("stage_robot", "published/obstacle_map.toml", [12, 20], GridSpace::Centers, [-12.0, 11.0], [15.0, -17.0]),
];

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).map(PathBuf::from);
    for name in ["hall", "house"] {
        let floor = Floor::load(&format!("explore/{name}.toml"))?;
        println!("{name}: R. F. Goncalves da Silva, Trabalho Pratico 1, from {START:?} to {:?}", TARGETS[0].1);
        // The plan's clearance exceeds the greatest deviation, so that what remains of the clearance is proven.
        let scene = floor.scene.clone().with_clearance(DEVIATION)?;
        let (arm, workspace) = scene.into_parts();
        let problem = Problem::new(arm, workspace, START, TARGETS[0].1)?;
        let plan = plan(&problem, &Options::default())?;
        let path = plan.waypoints().ok_or("there is no plan")?;
        let first = [path[1][0] - path[0][0], path[1][1] - path[0][1]];
        let heading = first[1].atan2(first[0]);

        // The controlled point begins at the start of the plan.
        let behind = [START[0] - AHEAD * heading.cos(), START[1] - AHEAD * heading.sin()];
        let mut guided = Robot::new(&floor, behind, heading);
        let marks = waypoints(&path);
        let drive = follow(&mut guided, &LAW, &marks, 1_000.0);
        report("along the plan", &guided, &drive, marks.len());
        let mut alone = Robot::new(&floor, behind, heading);
        let goal = [TARGETS[0].1.into()];
        let drive = follow(&mut alone, &ALONE, &goal, 300.0);
        report("without a plan", &alone, &drive, 1);
        if let Some(folder) = &folder {
            let ways = [
                ("plan".to_owned(), path.iter().map(|&corner| corner.into()).collect()),
                ("along the plan".to_owned(), guided.way()),
                ("without a plan".to_owned(), alone.way()),
            ];
            let picture = floor.picture("Differential drive", &[TARGETS[0].1], &ways);
            std::fs::write(folder.join(format!("differential_drive_{name}.svg")), picture)?;
        }
    }
    for grid in GRIDS {
        along_cells(grid, folder.as_deref())?;
    }
    Ok(())
}

/// Follows the cells of a wave and of A\*.
fn along_cells(
    (robot, world, cells, space, start, goal): Gridded,
    folder: Option<&Path>,
) -> Result<(), Box<dyn Error>> {
    let floor = Floor::of_robot(robot, world)?;
    println!("{world}: {} x {} cells, from {start:?} to {goal:?}", cells[0], cells[1]);
    let mut ways = Vec::new();
    for search in [GridSearch::Wave, GridSearch::AStar] {
        let (arm, workspace) = floor.scene.clone().into_parts();
        let problem = Problem::new(arm, workspace, start, goal)?;
        let planner = Planner::named(Method::Wavefront).with_path(PathKind::Own).with_space(space);
        let planner = planner.with(Setting::GridSearch, |settings| settings.grid_search = search);
        let planner = planner.with_cell_counts(CellCounts(cells));
        let plan = plan(&problem, &Options { levels: 1, ..Options::from(planner) })?;
        let path = plan.waypoints().ok_or("there is no plan")?;
        let first = [path[1][0] - path[0][0], path[1][1] - path[0][1]];
        let heading = first[1].atan2(first[0]);
        let mut driven =
            Robot::new(&floor, [start[0] - AHEAD * heading.cos(), start[1] - AHEAD * heading.sin()], heading);
        let Tracked { arrived, farthest } = track(&mut driven, &ALONG_CELLS, &path, 1_000.0);
        let gap = driven.track.iter().map(|pose| floor.gap(pose.at)).fold(f64::INFINITY, f64::min);
        println!(
            "  cells of {search}: {} in {:.1} s, {:.2} m; {gap:.3} m free at the least, the point at most {farthest:.4} m from the desired one",
            if arrived { "arrived" } else { "not there" },
            driven.time,
            driven.length
        );
        ways.push((format!("cells of {search}"), path.iter().map(|&corner| corner.into()).collect()));
        ways.push((format!("along those of {search}"), driven.way()));
    }
    if let Some(folder) = folder {
        let name = Path::new(world).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let picture = floor.picture("Differential drive along cells", &[goal], &ways);
        std::fs::write(folder.join(format!("along_cells_{name}.svg")), picture)?;
    }
    Ok(())
}

fn report(how: &str, robot: &Robot, drive: &Drive, waypoints: usize) {
    let gap = robot.track.iter().map(|pose| robot.floor.gap(pose.at)).fold(f64::INFINITY, f64::min);
    let Drive { passed, repelled, fastest: [ahead, about] } = drive;
    println!(
        "  {how}: {passed} of {waypoints} waypoints in {:.1} s, {:.2} m; {gap:.3} m free at the least, repelled in {repelled} \
         commands, at most {ahead:.2} m/s and {about:.2} rad/s",
        robot.time, robot.length
    );
}
