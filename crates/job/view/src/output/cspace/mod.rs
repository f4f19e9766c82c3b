//! The configuration space as data, for programs that draw or study it.

mod format;
mod geojson;
mod matrix;
mod seen;

pub use format::CSpaceFormat;
pub use seen::{Boxes, Cells, FieldGrid, Roadmap};

use super::picture::{PICTURE_TOLERANCE, contours};
use cplan_engine::{Detail, Motion, Plan};
use cplan_geometry::Point;
use cplan_handling::Task;
use cplan_judge::CheckedProof;
use cplan_legs::TaskAnswer;
use cplan_model::space::{Configuration, Path};
use cplan_model::{Joint, MotionProblem, Scene, Status};
use cplan_motion::CertifiedCurve;
use cplan_planners::cspace::{self, PolygonWithHoles, Proves};
use cplan_planners::planner::{FieldQuantity, Trace, VisibilityGraph};
use cplan_planners::waves::FreeCells;
use cplan_planners::waves::search::Estimates;
use cplan_solver::{Answer, Space};
#[cfg(test)]
use schemars::JsonSchema;
use serde::Serialize;
use std::sync::Arc;

/// A pair of joint values, base to tip; radians or metres.
pub type Values = [f64; 2];

/// The configuration spaces of a plan. Numbers have all their digits; units are radians and metres.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct CSpaces {
    /// Title of the workspace; may be empty.
    pub name: String,
    /// Name of the planner.
    pub planner: String,
    /// The outcome.
    pub status: Status,
    /// Axes of joint 1 and of joint 2.
    pub axes: [Axis; 2],
    /// One space for a single motion; for a task, one for each world that the arm moves in.
    pub spaces: Vec<CSpace>,
}

/// The values of one joint.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Axis {
    /// Name of the joint in the URDF.
    pub joint: String,
    /// `rad` or `m`.
    pub unit: &'static str,
    /// `interval` or `circle`: values on a circle that differ by its period are one.
    pub topology: &'static str,
    /// Least value; on a circle, the value at the cut.
    pub lower: f64,
    /// Greatest value.
    pub upper: f64,
    /// Length of a circle; null for an interval.
    pub period: Option<f64>,
}

/// A configuration space and its content. Data that a planner does not make is omitted.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct CSpace {
    /// Name of the payload in a task; otherwise empty.
    pub payload: String,
    /// Guarantee of blocked in `c_obstacles`, apart from the requested clearance: `exact` for the polygons of gantries
    /// with `--margin 0`.
    pub proves: Proves,
    /// C-obstacles, in the world's order.
    pub c_obstacles: Vec<ObstacleRegion>,
    /// Initial configuration of the arm.
    pub start: Values,
    /// Goals: both ends of a segment, which are the same for a single goal.
    pub goals: Vec<[Values; 2]>,
    /// Paths of the arm, in unwrapped values; empty if there is no path.
    pub paths: Vec<PathData>,
    /// The planner's polygons, from its last attempt.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub free: Option<FreeRegion>,
    /// Straight motions between configurations.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roadmap: Option<Roadmap>,
    /// Trapezoids or triangles of free space.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cells: Option<Cells>,
    /// Configurations that the search of a roadmap or of cells expanded, in that order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub expanded: Vec<Values>,
    /// Free stretches at fixed values of joint 1 that the path passes: both ends of each.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub rows: Vec<[Values; 2]>,
    /// Boxes of a subdivision.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub boxes: Option<Boxes>,
    /// Results of attempts in coarser spaces, or with cells that are wholly free, in words.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub failed_attempts: Vec<String>,
    /// Cells of a field.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grid: Option<FieldGrid>,
    /// Collision boxes that separate start and goals: least and greatest values of each.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub proof: Vec<[Values; 2]>,
}

/// Polygons with holes, nested like the coordinates of a `MultiPolygon` in GeoJSON. Each polygon is a list of rings,
/// the outer one first and counter-clockwise. Each ring is a list of corners, with the first one repeated at the end.
pub type Polygons = Vec<Vec<Vec<Values>>>;

/// The C-obstacle of an obstacle.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct ObstacleRegion {
    /// Name of the obstacle; may be empty.
    pub obstacle: String,
    /// Disjoint polygons within the axes' limits, cut at the seams of circles.
    pub polygons: Polygons,
}

/// A path.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct PathData {
    /// Name of the planner, or the step of a task.
    pub name: String,
    /// Waypoints, with straight segments between them.
    pub waypoints: Vec<Values>,
    /// The path with its corners rounded as in the motion, in short segments.
    pub outline: Vec<Values>,
}

/// Free space of a planner on polygons.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct FreeRegion {
    /// Guarantee of free and blocked here.
    pub proves: Proves,
    /// Least and greatest values; circles include further turns around the start, in which obstacles repeat.
    pub window: [Values; 2],
    /// Connected components.
    pub polygons: Polygons,
}

/// Returns the planner's configuration space as data. Computes the C-obstacles again, which takes as long as for a
/// picture.
pub fn cspaces(plan: &Plan) -> CSpaces {
    let is_exact = plan.options().planner.is_exact();
    let axes = plan.arm().joints.each_ref().map(Axis::of);
    let spaces = match plan.detail() {
        Detail::Motion { problem, answer } => vec![CSpace::of_motion(problem, answer, is_exact)],
        Detail::Task { task, answer } => spaces_of_task(task, answer, is_exact),
    };
    CSpaces {
        name: plan.problem().scene().workspace().name.clone(),
        planner: plan.options().planner.method().to_string(),
        status: plan.status(),
        axes,
        spaces,
    }
}

impl CSpaces {
    /// Adds a number to the labels of all grids, whose first label is 0 otherwise.
    #[must_use]
    pub fn with_labels_from(mut self, first: u32) -> Self {
        self.spaces.iter_mut().filter_map(|space| space.grid.as_mut()).for_each(|grid| grid.shift_labels(first));
        self
    }
}

impl Axis {
    fn of(joint: &Joint) -> Self {
        let (lower, upper) = joint.range.domain();
        let is_circle = joint.range.is_circle();
        Self {
            joint: joint.name.clone(),
            unit: joint.unit(),
            topology: if is_circle { "circle" } else { "interval" },
            lower,
            upper,
            period: is_circle.then(|| joint.range.extent()),
        }
    }
}

impl CSpace {
    /// Creates a space with obstacles only.
    fn of_scene(scene: &Scene, start: Configuration, is_exact: bool) -> Self {
        let numbers = (0..scene.workspace().obstacles.len()).chain(scene.listed_self_obstacles());
        let names = numbers.map(|number| scene.obstacle(number).name.clone());
        let grown = || {
            let margin = MAX_GROWTH * PICTURE_TOLERANCE * scene.arm().reach();
            (contours(scene), Proves::Outer { margin })
        };
        let exact = if is_exact { cspace::exact_c_obstacles(scene) } else { None };
        let exact = exact.map(|contours| (contours, Proves::Exact));
        let (contours, proves) = exact.unwrap_or_else(grown);
        let united = cspace::united(scene, &contours);
        let region =
            |(obstacle, all): (String, Vec<PolygonWithHoles>)| ObstacleRegion { obstacle, polygons: polygons(&all) };
        Self {
            payload: scene.attachment().map(|payload| payload.name.clone()).unwrap_or_default(),
            proves,
            c_obstacles: names.zip(united).map(region).collect(),
            start: start.into(),
            goals: Vec::new(),
            paths: Vec::new(),
            free: None,
            roadmap: None,
            cells: None,
            expanded: Vec::new(),
            rows: Vec::new(),
            boxes: None,
            failed_attempts: Vec::new(),
            grid: None,
            proof: Vec::new(),
        }
    }

    fn of_motion(problem: &MotionProblem, answer: &Answer<Motion>, is_exact: bool) -> Self {
        let scene = problem.scene();
        let free = match &answer.space {
            Space::Regions(regions) => Some(FreeRegion {
                proves: regions.proves,
                window: [regions.window.map(|side| side.0), regions.window.map(|side| side.1)],
                polygons: polygons(&regions.free),
            }),
            _ => None,
        };
        let motion = answer.outcome.found().into_iter();
        let space = Self {
            goals: problem.goals().pieces().iter().map(|goal| goal.ends().map(Values::from)).collect(),
            paths: motion.map(|motion| PathData::of(answer.method.to_string(), &motion.timed.curve)).collect(),
            free,
            failed_attempts: answer.history.clone(),
            proof: answer.outcome.infeasible().map(boxes_of).unwrap_or_default(),
            ..Self::of_scene(scene, problem.start(), is_exact)
        };
        space.with_trace(&answer.drawn(), &answer.space)
    }

    fn with_trace(self, trace: &Trace, space: &Space) -> Self {
        let grid = |quantity, values: &[f64]| FieldGrid::of(space, quantity, values);
        match trace {
            Trace::Roadmap { edges, whole } => {
                let reduced = Some(VisibilityGraph::Reduced.name());
                Self { roadmap: Some(Roadmap::of(edges, *whole, reduced)), ..self }
            }
            Trace::Roads { edges, expanded, kind } => {
                let visibility = kind.visibility().map(VisibilityGraph::name);
                Self { roadmap: Some(Roadmap::of(edges, true, visibility)), expanded: joint_values(expanded), ..self }
            }
            Trace::Slices { free } => Self { rows: pairs(free), ..self },
            Trace::Channel { cells, channel, points, expanded, .. } => {
                let cells = Cells {
                    corners: cells.iter().map(|cell| joint_values(cell)).collect(),
                    channel: channel.clone(),
                    centers: joint_values(&points.centers),
                    middles: joint_values(&points.middles),
                };
                Self { cells: Some(cells), expanded: joint_values(expanded), ..self }
            }
            Trace::Boxes { free, stuck, mixed } => {
                let boxes = Boxes { free: pairs(free), stuck: pairs(stuck), mixed: pairs(mixed) };
                Self { boxes: Some(boxes), ..self }
            }
            Trace::Wavefront { labels, forward, estimates, .. } => {
                let steps = |&label: &u32| if label == u32::MAX { f64::INFINITY } else { f64::from(label) };
                let quantity = if *forward { "steps_from_start" } else { "steps" };
                let values: Vec<f64> = labels.iter().map(steps).collect();
                let estimates = estimates.iter().flat_map(|estimates| estimated_costs(estimates, space));
                let grid = grid(quantity, &values).map(|grid| grid.with_estimates(estimates.collect()));
                Self { grid, ..self }
            }
            Trace::Field { quantity, values, .. } => {
                let (quantity, values): (_, &[f64]) = match quantity {
                    FieldQuantity::Height => ("height", values),
                    FieldQuantity::Logarithm => ("ln_potential", values),
                    FieldQuantity::EstimatedLogarithm => ("ln_potential", &[]),
                };
                Self { grid: grid(quantity, values), ..self }
            }
        }
    }
}

/// Returns the estimate of each cell of a grid.
fn estimated_costs(estimates: &Estimates, space: &Space) -> Vec<f64> {
    let Space::Grid(grid) = space else { return Vec::new() };
    let free = FreeCells::new(grid);
    (0..grid.blocked.len()).map(|cell| estimates.of(&free, cell).value()).collect()
}

/// Largest growth of obstacles, as a multiple of the tolerance of pictures: the margin itself, twice the flattening error, and
/// two more margins around shapes with many corners (see [`cspace::c_obstacles`]).
const MAX_GROWTH: f64 = 5.0;

impl PathData {
    fn of(name: String, curve: &CertifiedCurve) -> Self {
        let values = |path: &Path| joint_values(path.waypoints());
        Self { name, waypoints: values(curve.curve().path()), outline: values(&curve.outline()) }
    }
}

/// Returns a space for each world, in the order of the arm's motion, and last that of a failed step.
fn spaces_of_task(task: &Task, answer: &TaskAnswer, is_exact: bool) -> Vec<CSpace> {
    let mut scenes: Vec<&Arc<Scene>> = Vec::new();
    let mut spaces: Vec<CSpace> = Vec::new();
    for leg in &answer.legs {
        let curve = &leg.timed.curve;
        let path = curve.curve().path();
        let known = scenes.iter().position(|scene| Arc::ptr_eq(scene, &leg.scene) || **scene == leg.scene);
        let number = known.unwrap_or_else(|| {
            scenes.push(&leg.scene);
            spaces.push(CSpace::of_scene(&leg.scene, path.start(), is_exact));
            spaces.len() - 1
        });
        let name = format!("{}. {}", leg.step.number, leg.step.action.describe(&task.objects));
        spaces[number].goals.push([path.goal().into(); 2]);
        spaces[number].paths.push(PathData::of(name, curve));
    }
    if let Some(fails) = answer.failed() {
        let proofs = fails.ik_solutions.iter().filter_map(|to| to.proof.as_ref());
        spaces.push(CSpace {
            goals: fails.ik_solutions.iter().map(|to| [to.ik_solution.into(); 2]).collect(),
            proof: proofs.flat_map(boxes_of).collect(),
            ..CSpace::of_scene(&fails.scene, fails.from, is_exact)
        });
    }
    spaces
}

fn joint_values(configurations: &[Configuration]) -> Vec<Values> {
    configurations.iter().copied().map(Values::from).collect()
}

fn pairs(pairs: &[[Configuration; 2]]) -> Vec<[Values; 2]> {
    pairs.iter().map(|pair| pair.map(Values::from)).collect()
}

fn boxes_of(proof: &CheckedProof) -> Vec<[Values; 2]> {
    proof.collision_boxes().iter().map(|stuck| [stuck.cell.lower, stuck.cell.upper]).collect()
}

fn polygons(polygons: &[PolygonWithHoles]) -> Polygons {
    let closed = |ring: &Vec<Point>| ring.iter().chain(ring.first()).map(|p| [p.x, p.y]).collect();
    polygons.iter().map(|polygon| std::iter::once(&polygon.outer).chain(&polygon.holes).map(closed).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_robot::schema::compare_with_file;
    use schemars::generate::SchemaSettings;

    #[test]
    fn the_schema_agrees_with_its_file() {
        let generator = SchemaSettings::draft2020_12().for_serialize().into_generator();
        compare_with_file(generator.into_root_schema_for::<CSpaces>(), "cspace.schema.json");
    }
}
