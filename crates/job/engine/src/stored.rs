//! Serialisation of problems and plans by serde, in JSON and other self-describing formats that can represent missing values.
//!
//! A problem is stored as its model (arm, obstacles and target), without its source files. Reading uses the constructors that
//! check their arguments, so a stored problem is as valid as a loaded one. Numbers are restored bit for bit.
//!
//! A plan is stored as problem, options and result. The stored result is never trusted: [`StoredPlan`] plans again, and compares
//! the results. The same input gives the same output, so a difference shows that the file was changed, or written by another
//! version of cplan.

use super::plan::{Plan, PlanError, plan};
use super::problem::{Problem, ProblemError, motion_among};
use super::searches::Searches;
use cplan_handling::{
    Driver, MovingObstacle, ObstacleTrajectory, RobotJoints, Task, TaskError, TimedScene, TimedWorkspace, ToolJoint,
};
use cplan_model::space::{Configuration, GoalSet};
use cplan_model::{Additions, Arm, Attachment, MotionProblem, Scene};
use cplan_robot::RobotReport;
use cplan_solver::Options;
use cplan_world::LoadedProblem;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;
use std::borrow::Cow;
use thiserror::Error;

/// A problem as serde stores it.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ProblemRecord<'a> {
    asked: TargetRecord<'a>,
    robot: RobotReport,
    notes: Vec<String>,
}

/// The requested motion or task.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum TargetRecord<'a> {
    Motion(MotionRecord),
    Task(Cow<'a, Task>),
}

/// A motion problem as serde stores it.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MotionRecord {
    scene: SceneRecord,
    start: Configuration,
    goals: GoalSet,
}

/// A scene with its trajectories, as serde stores it.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneRecord {
    arm: Arm,
    workspace: TimedWorkspace,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    attachment: Option<Attachment>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    allowed_contacts: Vec<usize>,
}

impl MotionRecord {
    fn new(problem: &Problem) -> Self {
        let TimedScene { scene, trajectories } = problem.timed();
        let Additions { loose, attachment, allowed_contacts } = scene.additions().clone();
        let (arm, workspace) = scene.clone().into_parts();
        let movers = loose.into_iter().zip(trajectories.iter().cloned());
        let movers =
            movers.map(|(loose, trajectory)| MovingObstacle { obstacle: loose.obstacle, trajectory }).collect();
        let workspace = TimedWorkspace { fixed: workspace, movers };
        let scene = SceneRecord { arm, workspace, attachment, allowed_contacts };
        Self { scene, start: problem.query.start(), goals: problem.query.goals().clone() }
    }

    /// Returns the problem of a motion, and the trajectories of its loose obstacles.
    fn motion(self) -> Result<(MotionProblem, Vec<ObstacleTrajectory>), ProblemError> {
        let Self { scene: SceneRecord { arm, mut workspace, attachment, allowed_contacts }, start, goals } = self;
        workspace.restrict_shapes();
        let trajectories = workspace.trajectories();
        let (workspace, additions) = workspace.into_parts();
        let scene = Scene::with(arm, workspace, Additions { attachment, allowed_contacts, ..additions })?;
        Ok((motion_among(scene, &trajectories, start, goals)?, trajectories))
    }
}

impl Serialize for Problem {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let asked = match self.task() {
            None => TargetRecord::Motion(MotionRecord::new(self)),
            Some(task) => TargetRecord::Task(Cow::Borrowed(task)),
        };
        ProblemRecord { asked, robot: self.robot().clone(), notes: self.notes().to_vec() }.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Problem {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let ProblemRecord { asked, robot, notes } = ProblemRecord::deserialize(deserializer)?;
        if !are_joints(&robot.joints) {
            return Err(D::Error::custom(
                "invalid joints of the robot: values must be finite and within the joints' ranges, and the planned joints are 0 and 1",
            ));
        }
        let (problem, task, trajectories) = match asked {
            TargetRecord::Motion(record) => {
                let (motion, trajectories) = record.motion().map_err(D::Error::custom)?;
                (motion, None, trajectories)
            }
            TargetRecord::Task(task) => {
                let mut task = task.into_owned();
                task.restrict_shapes();
                let scene: Result<Scene, TaskError> = task.check();
                if robot.joints.stroke.is_some() && robot.joints.stroke != task.stroke {
                    return Err(D::Error::custom("robot and task have different strokes"));
                }
                let (scene, trajectories) = (scene.map_err(D::Error::custom)?, task.initial_trajectories());
                (MotionProblem::trusted(scene, task.start, GoalSet::default()), Some(task), trajectories)
            }
        };
        Ok(LoadedProblem { problem, stated_goals: Vec::new(), task, trajectories, robot, notes, errors: None }.into())
    }
}

/// Returns true if ROS messages can have values of all joints of a robot.
fn are_joints(robot: &RobotJoints) -> bool {
    let is_driven = |driver: Driver| match driver {
        Driver::Planned(joint) => joint < 2,
        Driver::Held(value) => value.is_finite(),
        Driver::Stroke | Driver::Wrist => true,
    };
    robot.joints.iter().all(|j| is_driven(j.driver) && j.factor.is_finite() && j.offset.is_finite())
        && robot.wrist.iter().all(ToolJoint::is_sound)
        && robot.stroke.iter().all(|stroke| stroke.joint.is_sound())
}

/// A plan as serde reads it. Its result is never trusted.
///
/// ```
/// use cplan_engine::{Problem, Searches, StoredPlan, plan};
/// use cplan_model::{Arm, Obstacle, Workspace};
/// use cplan_solver::Options;
///
/// let post = Obstacle::circle("post", [1.6, 0.0], 0.1)?;
/// let problem = Problem::new(Arm::rr([1.0, 0.8], 0.06)?, Workspace::new([post]), [1.0, 0.2], [-1.0, -0.2])?;
/// let made = plan(&problem, &Options::default(), Searches::NONE, &mut |_| ())?;
/// let stored = serde_json::to_string(&made)?;
///
/// let read: StoredPlan = serde_json::from_str(&stored)?;
/// assert_eq!(read.planned_again(Searches::NONE)?.trajectory(), made.trajectory());
///
/// let tampered = stored.replace("\"certified\":true", "\"certified\":false");
/// let read: StoredPlan = serde_json::from_str(&tampered)?;
/// let refused = read.planned_again(Searches::NONE).expect_err("planning says otherwise");
/// assert!(refused.to_string().contains("result.certified is false, but planning gives true"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoredPlan {
    problem: Problem,
    options: Options,
    result: Value,
}

/// The reason why a stored plan is refused.
#[derive(Debug, Error)]
pub enum StoredPlanError {
    /// The problem cannot be planned.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The result cannot be written.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    /// Planning gives another result. The text is the first difference.
    #[error("the stored result differs from planning: {0}; plan the problem again")]
    Differs(String),
}

impl StoredPlan {
    /// Plans the problem again, and compares the results, except measured times. So the returned plan is as certified as any
    /// other.
    ///
    /// # Errors
    /// A problem that cannot be planned, and a result that differs.
    pub fn planned_again(&self, searches: Searches) -> Result<Plan, StoredPlanError> {
        let planned = plan(&self.problem, &self.options, searches, &mut |_| ())?;
        match difference("result", &self.result, &result(&planned)?) {
            Some(what) => Err(StoredPlanError::Differs(what)),
            None => Ok(planned),
        }
    }
}

/// A plan as serde writes it.
#[derive(Serialize)]
struct PlanRecord<'a> {
    problem: &'a Problem,
    options: &'a Options,
    result: Value,
}

impl Serialize for Plan {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let result = result(self).map_err(serde::ser::Error::custom)?;
        PlanRecord { problem: self.problem(), options: self.options(), result }.serialize(serializer)
    }
}

/// Returns the result of a plan without measured times, which differ from run to run.
fn result(plan: &Plan) -> serde_json::Result<Value> {
    let mut result = serde_json::to_value(plan.result(&[]))?;
    if let Value::Object(fields) = &mut result {
        fields.remove("timings");
    }
    Ok(result)
}

/// Returns the first difference between a stored result and the planned one, in the order of names. `None` if they are
/// equal.
fn difference(at: &str, stated: &Value, planned: &Value) -> Option<String> {
    match (stated, planned) {
        (Value::Object(theirs), Value::Object(ours)) => {
            let missing = ours
                .iter()
                .find(|(name, _)| !theirs.contains_key(*name))
                .map(|(name, _)| format!("{at}.{name} is missing"));
            missing.or_else(|| {
                theirs.iter().find_map(|(name, value)| match ours.get(name) {
                    Some(own) => difference(&format!("{at}.{name}"), value, own),
                    None => Some(format!("{at}.{name} is stated, but planning gives no such value")),
                })
            })
        }
        (Value::Array(theirs), Value::Array(ours)) if theirs.len() == ours.len() => {
            theirs.iter().zip(ours).enumerate().find_map(|(k, (a, b))| difference(&format!("{at}[{k}]"), a, b))
        }
        _ if stated == planned => None,
        (Value::Array(theirs), Value::Array(ours)) => {
            Some(format!("{at} has {} entries, but planning gives {}", theirs.len(), ours.len()))
        }
        _ => Some(format!("{at} is {}, but planning gives {}", format_value(stated), format_value(planned))),
    }
}

/// Largest number of characters of a value that a message prints.
const MAX_SHOWN_CHARACTERS: usize = 60;

fn format_value(value: &Value) -> String {
    let text = value.to_string();
    if text.chars().count() <= MAX_SHOWN_CHARACTERS {
        text
    } else {
        text.chars().take(MAX_SHOWN_CHARACTERS).chain("...".chars()).collect()
    }
}
