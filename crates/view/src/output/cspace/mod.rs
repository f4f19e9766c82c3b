//! The configuration space as data: what a plan's planner has to show, for programs that draw or study it.

mod format;
mod geojson;
mod matrix;
mod seen;

pub use format::CSpaceFormat;
pub use seen::{Boxes, Cells, FieldGrid, Roadmap};

use super::picture::{PICTURE_TOLERANCE, contours};
use cplan_core::check::CheckedProof;
use cplan_core::cspace::{self, Polygon, Proves};
use cplan_core::model::{Joint, Scene, Status};
use cplan_core::planner::{GraphKind, Trace, VisibilityGraph};
use cplan_core::space::{Configuration, Path};
use cplan_engine::{Kind, MotionPlan, Plan, Space, TaskPlan};
use cplan_geometry::Point;
use cplan_motion::CertifiedCurve;
use cplan_motion::line_a_field;
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde::Serialize;
use std::sync::Arc;

/// A pair of joint values, base to tip; radians or metres.
pub type Values = [f64; 2];

/// The configuration spaces of a plan. Numbers have all their digits; radians, metres.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct CSpaces {
    /// Title of the workspace; may be empty.
    pub name: String,
    /// Name of the planner.
    pub planner: String,
    /// What became of the problem.
    pub status: Status,
    /// Of joint 1 and of joint 2.
    pub axes: [Axis; 2],
    /// One of a single motion; of a task one for each world that the arm moves in.
    pub spaces: Vec<CSpace>,
}

/// What one joint can take.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Axis {
    /// Name of the joint in the URDF.
    pub joint: String,
    /// `rad` or `m`.
    pub unit: &'static str,
    /// `interval` or `circle`: values on a circle that differ by its period are one.
    pub topology: &'static str,
    /// Least value; on a circle where it is cut.
    pub lower: f64,
    /// Greatest value.
    pub upper: f64,
    /// Length of a circle; none of an interval.
    pub period: Option<f64>,
}

/// A configuration space and what takes place in it. What a planner does not make is left out.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct CSpace {
    /// What is carried, of a task; else empty.
    pub payload: String,
    /// What blocked proves in `c_obstacles`, besides the clearance asked for: `exact` for the polygons of gantries with `--margin 0`.
    pub proves: Proves,
    /// By obstacle, in the world's order.
    pub c_obstacles: Vec<ObstacleRegion>,
    /// Where the arm is at first.
    pub start: Values,
    /// Where it may end: both ends of a segment, which are the same for a single goal.
    pub goals: Vec<[Values; 2]>,
    /// What it follows, in unwrapped values; none if there is no way.
    pub paths: Vec<Way>,
    /// The planner's polygons, from the last attempt.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub free: Option<FreeRegion>,
    /// Straight motions between configurations.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roadmap: Option<Roadmap>,
    /// Trapezoids or triangles of free space.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cells: Option<Cells>,
    /// Where the search of roadmap or cells came, in that order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub expanded: Vec<Values>,
    /// Free stretches at fixed values of joint 1, which the path passes: both ends of each.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub rows: Vec<[Values; 2]>,
    /// Boxes of a subdivision.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub boxes: Option<Boxes>,
    /// Cells of a field.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grid: Option<FieldGrid>,
    /// Boxes of colliding configurations that separate start and goals: least and greatest values of each.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub proof: Vec<[Values; 2]>,
}

/// Polygons with holes, nested as the coordinates of a `MultiPolygon` in GeoJSON: of each polygon its rings, the outer one first
/// and counter-clockwise; of each ring its corners, the first again at the end.
pub type Polygons = Vec<Vec<Vec<Values>>>;

/// What an obstacle blocks.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ObstacleRegion {
    /// Name of the obstacle; may be empty.
    pub obstacle: String,
    /// Disjoint, within the axes' limits, cut where circles are.
    pub polygons: Polygons,
}

/// A path.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Way {
    /// The planner's name, or the step of a task.
    pub name: String,
    /// Straight segments between them.
    pub waypoints: Vec<Values>,
    /// The same with its corners rounded as the motion rounds them, in short segments.
    pub outline: Vec<Values>,
}

/// Free space as a planner on polygons sees it.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct FreeRegion {
    /// What free and blocked prove here.
    pub proves: Proves,
    /// Least and greatest values: on circles turns around the start, in which obstacles repeat.
    pub window: [Values; 2],
    /// Connected components.
    pub polygons: Polygons,
}

/// The schema of [`CSpaces`] as JSON, JSON Schema draft 2020-12.
#[must_use]
pub fn cspace_schema() -> serde_json::Value {
    let settings = SchemaSettings::draft2020_12().for_serialize();
    let mut schema = settings.into_generator().into_root_schema_for::<CSpaces>().to_value();
    schema.sort_all_objects();
    schema
}

/// What its planner has to show in the configuration space, as data. C-obstacles are traced anew, which takes the time
/// that it takes for a picture.
#[must_use]
pub fn cspaces(plan: &Plan) -> CSpaces {
    let is_exact = plan.options().planner.is_exact();
    let axes = plan.arm().joints.each_ref().map(Axis::of);
    let spaces = match plan.made() {
        Kind::Motion(made) => vec![CSpace::of_motion(made, is_exact)],
        Kind::Task(made) => spaces_of_task(made, is_exact),
    };
    CSpaces {
        name: plan.problem().scene().workspace().name.clone(),
        planner: plan.report().planner.clone(),
        status: plan.status(),
        axes,
        spaces,
    }
}

impl CSpaces {
    /// As a JSON object, a line a field.
    #[must_use]
    pub fn json(&self) -> String {
        line_a_field(self)
    }

    /// Returns the values of the first grid as a matrix in CSV, if there is a grid.
    #[must_use]
    pub fn csv(&self) -> Option<String> {
        self.spaces.iter().find_map(|space| space.grid.as_ref()).map(FieldGrid::matrix)
    }

    /// As a GeoJSON `FeatureCollection`, whose coordinates are joint values.
    #[must_use]
    pub fn geojson(&self) -> String {
        geojson::text(self)
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
    /// Obstacles alone.
    fn of_scene(scene: &Scene, start: Configuration, is_exact: bool) -> Self {
        let numbers = (0..scene.workspace().obstacles.len()).chain(scene.self_obstacles());
        let names = numbers.map(|number| scene.obstacle(number).name.clone());
        let grown = || {
            let margin = MARGIN * PICTURE_TOLERANCE * scene.arm().reach();
            (contours(scene), Proves::Outer { margin })
        };
        let exact = if is_exact { cspace::exact_c_obstacles(scene) } else { None };
        let (contours, proves) = exact.unwrap_or_else(grown);
        let united = cspace::united(scene, &contours);
        let region = |(obstacle, all): (String, Vec<Polygon>)| ObstacleRegion { obstacle, polygons: polygons(&all) };
        Self {
            payload: scene.payload().map(|payload| payload.object.clone()).unwrap_or_default(),
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
            grid: None,
            proof: Vec::new(),
        }
    }

    fn of_motion(plan: &MotionPlan, is_exact: bool) -> Self {
        let MotionPlan { problem, answer, curve, .. } = plan;
        let scene = problem.scene();
        let free = match &answer.space {
            Space::Regions(regions) => Some(FreeRegion {
                proves: regions.proves,
                window: [regions.window.map(|side| side.0), regions.window.map(|side| side.1)],
                polygons: polygons(&regions.free),
            }),
            _ => None,
        };
        let space = Self {
            goals: problem.goals().pieces().iter().map(|goal| goal.ends().map(Values::from)).collect(),
            paths: curve.iter().map(|curve| Way::of(answer.method.to_string(), curve)).collect(),
            free,
            proof: answer.verdict.proof().map(boxes_of).unwrap_or_default(),
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
                let visibility = match kind {
                    GraphKind::Visibility(graph) => Some(graph.name()),
                    GraphKind::Roadmap => None,
                };
                Self { roadmap: Some(Roadmap::of(edges, true, visibility)), expanded: all(expanded), ..self }
            }
            Trace::Slices { free } => Self { rows: pairs(free), ..self },
            Trace::Channel { cells, channel, points, expanded } => {
                let cells = Cells {
                    corners: cells.iter().map(|cell| all(cell)).collect(),
                    channel: channel.clone(),
                    centers: all(&points.centers),
                    middles: all(&points.middles),
                };
                Self { cells: Some(cells), expanded: all(expanded), ..self }
            }
            Trace::Boxes { free, stuck, mixed } => {
                let boxes = Boxes { free: pairs(free), stuck: pairs(stuck), mixed: pairs(mixed) };
                Self { boxes: Some(boxes), ..self }
            }
            Trace::Wavefront { labels, forward, .. } => {
                let steps = |&label: &u32| if label == u32::MAX { f64::INFINITY } else { f64::from(label) };
                let quantity = if *forward { "steps_from_start" } else { "steps" };
                Self { grid: grid(quantity, &labels.iter().map(steps).collect::<Vec<_>>()), ..self }
            }
            Trace::Potential { heights, .. } => Self { grid: grid("height", heights), ..self },
            // Guessed for pictures.
            Trace::Harmonic { potential: None, .. } => Self { grid: grid("ln_potential", &[]), ..self },
            Trace::Field { .. } | Trace::Harmonic { .. } => {
                let logarithms = trace.logarithms();
                let values = logarithms.as_ref().map_or(&[][..], |(_, values)| values);
                Self { grid: grid("ln_potential", values), ..self }
            }
        }
    }
}

/// By how many times the tolerance of pictures obstacles are grown at the most: the margin itself, twice what the flattening may
/// take, and two margins more around shapes with many corners (see [`cspace::c_obstacles`]).
const MARGIN: f64 = 5.0;

impl Way {
    fn of(name: String, curve: &CertifiedCurve) -> Self {
        let values = |path: &Path| all(path.waypoints());
        Self { name, waypoints: values(curve.curve().path()), outline: values(&curve.outline()) }
    }
}

/// A space for each world, in the order in which the arm moves in them; that of the step that fails comes last.
fn spaces_of_task(plan: &TaskPlan, is_exact: bool) -> Vec<CSpace> {
    let TaskPlan { task, answer } = plan;
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
        spaces[number].paths.push(Way::of(name, curve));
    }
    if let Some(fails) = answer.impossible() {
        let proofs = fails.ik_solutions.iter().filter_map(|to| to.proof.as_ref());
        spaces.push(CSpace {
            goals: fails.ik_solutions.iter().map(|to| [to.ik_solution.into(); 2]).collect(),
            proof: proofs.flat_map(boxes_of).collect(),
            ..CSpace::of_scene(&fails.scene, fails.from, is_exact)
        });
    }
    spaces
}

fn all(configurations: &[Configuration]) -> Vec<Values> {
    configurations.iter().copied().map(Values::from).collect()
}

fn pairs(pairs: &[[Configuration; 2]]) -> Vec<[Values; 2]> {
    pairs.iter().map(|pair| pair.map(Values::from)).collect()
}

fn boxes_of(proof: &CheckedProof) -> Vec<[Values; 2]> {
    proof.stuck().iter().map(|stuck| [stuck.cell.lower, stuck.cell.upper]).collect()
}

fn polygons(polygons: &[Polygon]) -> Polygons {
    let closed = |ring: &Vec<Point>| ring.iter().chain(ring.first()).map(|p| [p.x, p.y]).collect();
    polygons.iter().map(|polygon| std::iter::once(&polygon.outer).chain(&polygon.holes).map(closed).collect()).collect()
}
