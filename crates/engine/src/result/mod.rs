//! What became of a problem, for files and for people: one result, whether it is a single motion or the steps of a task.

mod files;
mod json;
mod task;

pub use task::{Choice, TaskFigures};

use super::Bound;
use super::Planner;
use super::moving::Timing;
use super::task::MessageError;
use cplan_core::check::CheckedProof;
use cplan_core::model::{Joint, Status};
use cplan_core::planner::VisibilityGraph;
use cplan_core::space::Metric;
use cplan_handling::RobotJoints;
use cplan_motion::CertifiedCurve;
use cplan_motion::{Blends, Fastest, FieldReport, Optimum, SearchUsed, Trajectory, interpolation};
use cplan_robot::AssumedLimits;
use std::collections::BTreeMap;

/// The result of a run. What of it a script relies on is always in its JSON, `path`, `length`, `clearance` and `trajectory` as null if
/// there is none; the rest is left out when `None` or empty. Of a task all that is optional and of a single motion is empty.
///
/// Numbers are finite; radians for a revolute joint and metres for a prismatic one, and seconds.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// Private, so that only what has found a certified motion can say "found".
    status: Status,
    /// Title of the workspace.
    pub name: Option<String>,
    /// Name of the planner; of a task that of its single motions.
    pub planner: String,
    /// How the wavefront planner searched its grids, or another its roadmap.
    pub search: Option<SearchUsed>,
    /// How the cells of the planner's grids were decided, if not by exact slices: `sampled`, which proves nothing by itself.
    pub space: Option<&'static str>,
    /// Names of the joints in the URDF, base to tip.
    pub joints: [String; 2],
    /// Unit of each joint's value: `rad` or `m`.
    pub units: [&'static str; 2],
    /// Limits that the timing takes for want of given ones.
    pub assumed: AssumedLimits,
    /// Why there is no motion, or why none is known.
    pub reason: Option<String>,
    /// Of an infeasible problem: boxes of colliding configurations that separate the start from all goals.
    pub proof: Option<CheckedProof>,
    /// Whether there is a path all the same, certified by another method than the one that was asked: `true`, of unknown
    /// results only, and left out where nothing is known.
    pub path_exists: Option<bool>,
    /// Which of the planner's paths it is: `own` or `taut`.
    pub path_kind: Option<&'static str>,
    /// Waypoints, straight segments between them: what the motion follows, but for its blends; of a task those of all its motions.
    pub path: Option<Vec<[f64; 2]>>,
    /// Joints of which the goal, the tip at a place, takes any value: the path's last waypoint says which was chosen.
    pub free_joints: Vec<String>,
    /// Euclidean length of the path in joint space.
    pub length: Option<f64>,
    /// How far the path is from the optimum at the most, if the planner tells.
    pub optimum: Option<Optimum>,
    /// How far the motion is from the fastest at the most, if that was asked for.
    pub fastest: Option<Fastest>,
    /// How the motion gets by what moves, if anything does.
    pub moving: Option<Timing>,
    /// Whether all of the continuous motion was shown free of collision; false without a motion, and if not all steps can be done.
    pub certified: bool,
    /// Proven lower bound on the distance between arm and obstacles all the time, metres. None without a motion, and where nothing
    /// can be hit: then it is infinite, for which JSON has no word.
    pub clearance: Option<f64>,
    /// The link and the obstacle that come closest, in words.
    pub closest: Option<String>,
    /// The field that was followed, if one was chosen.
    pub field: Option<FieldReport>,
    /// How much the planner built: `nodes` and `edges`, `cells` and `sweeps`, `windows` or `expanded` ones.
    pub size: BTreeMap<&'static str, usize>,
    /// Stages in the order in which they ran, with the milliseconds that each took; empty unless asked for, because they
    /// differ from run to run and nothing else in a result does.
    pub timings: Vec<(String, f64)>,
    /// The path's corners that the motion rounds; none without a path.
    pub blends: Option<Blends>,
    /// Of the whole motion, seconds.
    pub duration: Option<f64>,
    /// How to read the trajectory between its samples.
    pub interpolation: Option<&'static str>,
    /// The whole motion in time; none where there is none.
    pub trajectory: Option<Trajectory>,
    /// What is said of a task besides; none of a single motion.
    pub task: Option<Box<TaskFigures>>,
    /// The joints that ROS 2 messages name: at first the two planned ones.
    robot: RobotJoints,
    /// Whether tables and messages have accelerations; see [`Trajectory::check_accelerations`].
    accelerations: bool,
}

impl Report {
    /// A run that found a path, whose motion follows `curve` as `trajectory` says. What is optional and not known here (name, closest pair, size,
    /// timings) is left empty, for the caller to fill.
    #[must_use]
    pub fn found(planner: &str, joints: &[Joint; 2], curve: &CertifiedCurve, trajectory: Trajectory) -> Self {
        let (path, clearance) = (curve.curve().path(), curve.clearance());
        Self {
            path: Some(path.waypoints().iter().map(|q| [q[0], q[1]]).collect()),
            length: Some(path.length()),
            clearance: finite(clearance),
            blends: Some(Blends::of(curve)),
            ..Self::moving(planner, joints, trajectory)
        }
    }

    /// A run that proved that there is no path.
    #[must_use]
    pub fn infeasible(planner: &str, joints: &[Joint; 2], reason: String) -> Self {
        Self { reason: Some(reason), ..Self::bare(Status::Infeasible, planner, joints) }
    }

    /// A run that found no path and ruled none out.
    #[must_use]
    pub fn unknown(planner: &str, joints: &[Joint; 2], reason: String) -> Self {
        Self { reason: Some(reason), ..Self::bare(Status::Unknown, planner, joints) }
    }

    /// A run that found a motion.
    fn moving(planner: &str, joints: &[Joint; 2], trajectory: Trajectory) -> Self {
        Self {
            certified: true,
            duration: Some(trajectory.duration()),
            interpolation: Some(interpolation(joints)),
            trajectory: Some(trajectory),
            ..Self::bare(Status::Found, planner, joints)
        }
    }

    fn bare(status: Status, planner: &str, joints: &[Joint; 2]) -> Self {
        let names = joints.each_ref().map(|joint| joint.name.clone());
        Self {
            status,
            name: None,
            planner: planner.to_owned(),
            search: None,
            space: None,
            robot: RobotJoints::planned(&names),
            joints: names,
            units: joints.each_ref().map(Joint::unit),
            assumed: AssumedLimits::default(),
            reason: None,
            proof: None,
            path_exists: None,
            path_kind: None,
            path: None,
            free_joints: Vec::new(),
            length: None,
            optimum: None,
            fastest: None,
            moving: None,
            certified: false,
            clearance: None,
            closest: None,
            field: None,
            size: BTreeMap::new(),
            timings: Vec::new(),
            blends: None,
            duration: None,
            interpolation: None,
            trajectory: None,
            task: None,
            accelerations: false,
        }
    }

    /// Lets messages name these joints, and tables and messages have accelerations or not.
    ///
    /// # Errors
    /// Accelerations that jump, of the arm or of the tool.
    pub fn name_joints(&mut self, robot: &RobotJoints, accelerations: bool) -> Result<(), MessageError> {
        self.robot = robot.clone();
        self.accelerations = accelerations;
        let messages = self.task.as_ref().and_then(|task| task.messages.as_ref());
        if let Some(trajectory) = self.trajectory.as_ref().filter(|_| accelerations) {
            trajectory.check_accelerations()?;
            messages.map_or(Ok(()), |messages| messages.check_accelerations(robot))?;
        }
        Ok(())
    }

    /// How the run ended.
    #[must_use]
    pub fn status(&self) -> Status {
        self.status
    }
}

/// JSON has no word for what is infinite.
pub(super) fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

impl From<Bound> for Optimum {
    fn from(bound: Bound) -> Self {
        let (metric, weights) = match bound.metric {
            Metric::Euclidean => ("euclidean", None),
            Metric::Weighted { weights } => ("weighted", Some(weights)),
            Metric::Time { .. } => ("time", None),
        };
        Self { metric, weights, length: bound.upper, lower_bound: bound.lower, gap: finite(bound.gap()) }
    }
}

/// How a planner searches its grid, or its roadmap if that is not by the usual search.
#[must_use]
pub fn search_used(planner: &Planner) -> Option<SearchUsed> {
    if let Planner::Wavefront { search, ties, forward, neighborhood, .. } = planner {
        return Some(SearchUsed {
            search: search.name(),
            ties: (!ties.is_usual()).then(|| ties.name()),
            neighbors: Some(neighborhood.count()),
            backward: forward.then_some(false),
            graph: None,
        });
    }
    let graph = planner.graph().filter(|graph| *graph == VisibilityGraph::Full).map(VisibilityGraph::name);
    let search = planner.search().filter(|search| !search.is_usual() || graph.is_some())?;
    let backward = Some(search.backward);
    Some(SearchUsed { search: search.order.name(), ties: None, neighbors: None, backward, graph })
}
