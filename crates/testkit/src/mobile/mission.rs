//! The mission of Alves, with each of his controllers and with cplan's explorer.

use super::floor::Floor;
use super::follower;
use super::forces::{self, Ending, Manner};
use super::occupancy::{Occupancy, SIDE, cell};
use super::robot::Robot;
use super::{START, TARGETS, fields, in_the_way};
use cplan::engine::{CellCounts, Method, Planner, Setting};
use cplan::explore::{self, Exploration, Settings, explore};
use cplan::field::{
    Attraction, Device, Difference, Direction, Khatib, Limits, Measure, Order, Relaxation, Repulsion, Scan, Stencil,
};
use cplan::model::{Mount, Scene, Sensor};
use cplan::planner::{EquationChoice, FieldChoice, FieldPlanner, PathKind};
use cplan::{Configuration, Obstacle, Options, Point};
use std::error::Error;
use std::f64::consts::TAU;

/// A leg of the mission.
#[derive(Debug, Clone, PartialEq)]
pub struct Leg {
    /// The ending.
    pub ending: Ending,
    /// Length of the path, in metres.
    pub length: f64,
    /// Duration, in seconds.
    pub time: f64,
    /// Number of steps that were refused because the body would have hit an obstacle.
    pub refused: usize,
    /// Positions of the robot.
    pub way: Vec<Point>,
}

/// Runs the mission leg by leg. After a failed leg, the robot is placed at the target, so that each leg can be judged.
fn legs(floor: &Floor, mut drive: impl FnMut(&mut Robot, usize) -> Ending) -> Vec<Leg> {
    let mut robot = Robot::new(floor, START, 0.0);
    let leg = |leg: usize| {
        let begun = (robot.length, robot.time, robot.refused.len(), robot.track.len());
        let ending = drive(&mut robot, leg);
        let way = robot.track[begun.3 - 1..].iter().map(|pose| pose.at).collect();
        let done = Leg {
            ending,
            length: robot.length - begun.0,
            time: robot.time - begun.1,
            refused: robot.refused.len() - begun.2,
            way,
        };
        if ending != Ending::Reached {
            robot.pose.at = TARGETS[leg].1.into();
            robot.track.push(robot.pose);
        }
        done
    };
    (0..TARGETS.len()).map(leg).collect()
}

/// Performs the mission by forces, in an unknown room or with a known map. For `follows_text`, see [`Manner`].
pub fn by_forces(floor: &Floor, known: Option<&Occupancy>, follows_text: bool) -> Vec<Leg> {
    let mut map = known.cloned().unwrap_or_else(Occupancy::unknown);
    let manner = Manner { maps: known.is_none(), follows_text };
    legs(floor, |robot, leg| {
        let target = TARGETS[leg].1.into();
        map.set(cell(target), 0.0);
        let is_here = |at: Point| follows_text && (at - robot.pose.at).norm() < SIDE;
        for (_, at) in in_the_way(leg).into_iter().filter(|&(_, at)| !is_here(at)) {
            map.set(cell(at), 1.0);
        }
        forces::drive(robot, &mut map, target, manner)
    })
}

/// Performs the mission along fields that are relaxed on a map. A field that does not converge gives no path.
pub fn by_fields(floor: &Floor, field: &dyn Fn(usize) -> Option<Vec<f64>>) -> Vec<Leg> {
    legs(floor, |robot, leg| match field(leg) {
        Some(values) => fields::drive(robot, &values, TARGETS[leg].1.into()),
        None => Ending::Trapped((Point::from(TARGETS[leg].1) - robot.pose.at).norm()),
    })
}

/// Returns the map that the wall follower draws in this time, which is 300 s in the source, and its path.
pub fn followed(floor: &Floor, seconds: f64) -> (Occupancy, Vec<Point>) {
    let (mut robot, mut map) = (Robot::new(floor, START, 0.0), Occupancy::unknown());
    follower::follow(&mut robot, &mut map, seconds);
    let way = robot.way();
    (map, way)
}

/// Numbers of cells of the coarse grid, whose cells are 0.5 m wide.
const COARSE: CellCounts = CellCounts([80, 40]);

/// Returns the planners with which cplan explores towards a target, by name.
pub fn planners() -> Vec<(&'static str, Planner)> {
    let named = Planner::named(Method::Harmonic);
    let with = |choice: FieldChoice| {
        let field = FieldPlanner { field: choice, limits: Limits::High, escape: None, path: PathKind::Own };
        named.with(Setting::Field, |settings| settings.field = Some(field))
    };
    // As in the source, attraction is constant, and every occupied cell repels with 1/d^2.
    let khatib = Khatib { attraction: Attraction::Constant(1.0), repulsion: Repulsion::Sum(1.0), saturated: false };
    let direction = Direction::of([0.0, 1.0]).expect("a direction");
    let oriented = FieldChoice::Relaxed {
        on: Device::Cpu,
        equation: EquationChoice::Oriented { direction, epsilon: 0.5, difference: Difference::Upwind },
        relaxation: Relaxation::gauss_seidel(Order::Lines(Scan::ROWS)),
        measure: Measure::GreatestRelativeChange,
        tolerance: 1e-6,
        stencil: Stencil::Square,
        initial: cplan::field::Initial::High,
        max_sweeps: 10_000,
    };
    vec![
        ("Khatib", with(FieldChoice::Khatib(khatib)).with_cell_counts(COARSE)),
        ("harmonic", named.with_cell_counts(COARSE)),
        ("oriented", with(oriented).with_cell_counts(COARSE)),
        ("shortest", Planner::named(Method::Shortest)),
    ]
}

/// The sensor of cplan's robot, which is a gantry without a heading. The source's robot turns its scanner of 180 degrees, so this
/// sensor sees in all directions. The cells are those of the source.
pub const SENSOR: Sensor = Sensor {
    mount: Mount::Tip,
    turn: 0.0,
    rays: 360,
    field_of_view: TAU,
    range: 8.0,
    step: 0.5,
    noise: 0.0,
    seed: 0,
    cell: 0.5,
};

/// Performs the mission with cplan: to each target in turn, through a room that is initially unknown.
///
/// # Errors
/// Invalid settings.
pub fn explored(floor: &Floor, planner: Planner) -> Result<Vec<(Scene, Exploration)>, Box<dyn Error>> {
    let starts = [START, TARGETS[0].1, TARGETS[1].1, TARGETS[2].1];
    let mut legs = Vec::new();
    for (leg, start) in starts.into_iter().enumerate() {
        let mut workspace = floor.scene.workspace().clone();
        let elsewhere = |&(_, at): &(&str, Point)| at != Point::from(start);
        for (name, at) in in_the_way(leg).into_iter().filter(elsewhere) {
            workspace.obstacles.push(Obstacle::circle(name, at.into(), 0.25)?);
        }
        let scene = Scene::new(floor.scene.arm().clone(), workspace)?;
        let usual = Settings::default();
        // Fields use one grid per decision, because finer grids would show nothing new.
        let levels = if planner.method() == Method::Harmonic { 1 } else { usual.options.levels };
        let options = Options { planner, levels, ..usual.options };
        let settings = Settings { cells: [160, 80], decisions: 2_000, options, ..usual };
        let start = Configuration::from(start);
        let goals = TARGETS[leg].1.into();
        let exploration = explore(&scene, &SENSOR, start, Some(&goals), &settings, &mut |_| ())?;
        legs.push((scene, exploration));
    }
    Ok(legs)
}

/// Returns the path of an exploration by its corners.
pub fn way(exploration: &Exploration) -> Vec<Point> {
    let corners = |leg: &explore::Leg| leg.curve.curve().path().waypoints().to_vec();
    exploration.legs.iter().flat_map(corners).collect()
}
