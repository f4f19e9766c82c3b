//! What a run found, as JSON.

use super::json::{as_map, line_a_field};
use super::{FieldReport, Trajectory};
use crate::check::{CertifiedCurve, CheckedProof};
use crate::model::{AssumedLimits, Joint, RobotJoints, Status};
use crate::space::{INTERPOLATION, SMOOTH_INTERPOLATION};
use serde::Serialize;
use std::collections::BTreeMap;

/// How to read trajectories of these joints.
pub(crate) fn interpolation(joints: &[Joint; 2]) -> &'static str {
    if joints.iter().any(|joint| joint.jerk.is_some()) { SMOOTH_INTERPOLATION } else { INTERPOLATION }
}

/// A path's place between a proven lower bound on the length of every free motion and its own length.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Optimum {
    /// How lengths are measured: `euclidean`, `weighted` or `time` (seconds at the joints' top speeds).
    pub metric: &'static str,
    /// Weights of the joints, if any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub weights: Option<[f64; 2]>,
    /// Length of the path in this metric.
    pub length: f64,
    /// No motion to any of the goals is shorter: proven.
    pub lower_bound: f64,
    /// `length / lower_bound - 1`; none where the bound is 0 and the length is not.
    pub gap: Option<f64>,
}

/// The corners that a motion does not stop at.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Blends {
    /// How many there are; the path's other corners are stopped at.
    pub count: usize,
    /// Greatest distance between a blend's ends and its corner, in joint space (radians and metres as they come).
    pub largest_radius: f64,
}

impl Blends {
    /// Those of a curve.
    #[must_use]
    pub fn of(curve: &CertifiedCurve) -> Self {
        let radii = || curve.curve().radii().iter().copied().filter(|radius| *radius > 0.0);
        Self { count: radii().count(), largest_radius: radii().fold(0.0, f64::max) }
    }
}

/// How a grid was searched.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct SearchUsed {
    /// `wave`, `bfs`, `dfs`, `dijkstra` or `astar`.
    pub search: &'static str,
    /// 4, or 8 with diagonal moves.
    pub neighbors: u8,
}

/// The result of a run. [`Report::json`] writes the fields in this order. Those that a
/// script relies on are always there, `path`, `length`, `clearance` and `trajectory` as null if there is none; the others
/// are left out when `None` or empty.
///
/// Numbers are finite; radians for a revolute joint and metres for a prismatic one, and seconds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// Private, so that only [`Report::found`] can say "found".
    status: Status,
    /// Title of the workspace.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Name of the planner.
    pub planner: String,
    /// How the wavefront planner searched its grid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub search: Option<SearchUsed>,
    /// How the cells of the planner's grid were decided, if not by exact slices: `sampled`, which proves nothing by itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub space: Option<&'static str>,
    /// Names of the joints in the URDF, base to tip.
    pub joints: [String; 2],
    /// Unit of each joint's value: `rad` or `m`.
    pub units: [&'static str; 2],
    /// Limits that the timing takes for want of given ones.
    #[serde(skip_serializing_if = "AssumedLimits::is_empty")]
    pub assumed: AssumedLimits,
    /// Why there is no path, or why none is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Of an infeasible problem: boxes of colliding configurations that separate the start from all goals.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub proof: Option<CheckedProof>,
    /// Whether there is a path all the same, certified by another method than the one that was asked: `true`, of unknown
    /// results only, and left out where nothing is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path_exists: Option<bool>,
    /// Which of the planner's paths it is: `own` or `taut`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path_kind: Option<&'static str>,
    /// Waypoints, straight segments between them: what the motion follows, but for its blends.
    pub path: Option<Vec<[f64; 2]>>,
    /// Joints of which the goal, the tip at a place, takes any value: the path's last waypoint says which was chosen.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub free_joints: Vec<String>,
    /// Euclidean length of the path in joint space.
    pub length: Option<f64>,
    /// How far the path is from the optimum at the most, if the planner tells.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub optimum: Option<Optimum>,
    /// Whether the whole continuous motion was shown free of collision; false without a path.
    pub certified: bool,
    /// Proven lower bound on the distance between arm and obstacles along the path and its blends, metres. None without a path, and
    /// where nothing can be hit: then it is infinite, for which JSON has no word.
    pub clearance: Option<f64>,
    /// The link and the obstacle that come closest, in words.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub closest: Option<String>,
    /// The field that was followed, if one was chosen.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub field: Option<FieldReport>,
    /// How much the planner built: `nodes` and `edges`, `cells` and `sweeps`, `windows` or `expanded` ones.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub size: BTreeMap<&'static str, usize>,
    /// Stages in the order in which they ran, with the milliseconds that each took; empty unless asked for, because they
    /// differ from run to run and nothing else in a result does.
    #[serde(skip_serializing_if = "Vec::is_empty", serialize_with = "as_map")]
    pub timings: Vec<(String, f64)>,
    /// The path's corners that the motion rounds; none without a path.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub blends: Option<Blends>,
    /// Of the motion, seconds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub duration: Option<f64>,
    /// How to read the trajectory between its samples.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interpolation: Option<&'static str>,
    /// The motion in time; none where there is none.
    pub trajectory: Option<Trajectory>,
    /// The joints that ROS 2 messages name: at first the two planned ones.
    #[serde(skip)]
    pub robot: RobotJoints,
    /// Whether tables and messages have accelerations; see [`Trajectory::check_accelerations`].
    #[serde(skip)]
    pub accelerations: bool,
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
            certified: true,
            clearance: clearance.is_finite().then_some(clearance),
            blends: Some(Blends::of(curve)),
            duration: Some(trajectory.duration()),
            interpolation: Some(interpolation(joints)),
            trajectory: Some(trajectory),
            ..Self::bare(Status::Found, planner, joints)
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

    fn bare(status: Status, planner: &str, joints: &[Joint; 2]) -> Self {
        Self {
            status,
            name: None,
            planner: planner.to_owned(),
            joints: joints.each_ref().map(|j| j.name.clone()),
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
            search: None,
            space: None,
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
            robot: RobotJoints::planned(&joints.each_ref().map(|j| j.name.clone())),
            accelerations: false,
        }
    }

    /// How the run ended.
    #[must_use]
    pub fn status(&self) -> Status {
        self.status
    }

    /// The result as a JSON object, a line a field. Numbers have as many digits as it takes to read the same `f64` back.
    #[must_use]
    pub fn json(&self) -> String {
        line_a_field(self)
    }
}
