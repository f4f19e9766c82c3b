//! The main entry point: makes a plan from a problem and options.

use super::clock::Clock;
use super::motion::{Motion, driven};
use super::problem::Problem;
use super::result::{MessageError, Messages};
use super::searches::{MoverSearch, Searches, TaskSearch};
use cplan_handling::{ObstacleTrajectory, RobotJoints, Task, TimedScene};
use cplan_judge::CheckedProof;
use cplan_legs::{Event, FailedStep, Leg, TaskAnswer, TaskMotion, TaskReplay};
use cplan_model::space::Path;
use cplan_model::{Arm, MotionProblem, Outcome, Scene, Status};
use cplan_motion::{BlockedTimes, Margins, MotionPart, PlaceTime, Timing, TimingError, Trajectory};
use cplan_planners::cspace::{NotPolygons, not_polygons};
use cplan_solver::{Answer, Criterion, NamedJoints, Options, Replay, solve};
use cplan_text::{length, percent};
use std::borrow::Cow;
use std::sync::{Arc, OnceLock};
use thiserror::Error;

/// The reason why planning is refused. (An unknown answer is no error.)
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PlanError {
    /// The program has no search for problems of this kind.
    #[error("this program was built without {0}")]
    Missing(&'static str),
    /// Options that are invalid, or unsuitable for this problem.
    #[error("{0}")]
    Options(String),
    /// The robot's file does not state properties that the options need.
    #[error("{0}")]
    Robot(String),
    /// The trajectory cannot be made as requested.
    #[error(transparent)]
    Timing(#[from] TimingError),
    /// ROS messages cannot name the joints as requested, or would contain accelerations that mislead their readers.
    #[error(transparent)]
    Joints(#[from] MessageError),
}

/// Proof that a problem has no solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Refutation<'a> {
    /// For a motion: collision boxes that separate the start from the goals.
    Motion(&'a CheckedProof),
    /// For a task: a step that cannot be performed, whatever the choices in earlier steps.
    Step(&'a FailedStep),
}

/// The result of planning a problem: the outcome, and all that can be printed, written and drawn.
///
/// [`plan`] creates it, and it is immutable. [`Plan::outcome`] returns the answer itself; `to_json`, `svg`, `html`, `bytes`,
/// `save` and `summary` give the program's output.
///
/// Serde writes a plan as problem, options and result. It reads it as a [`StoredPlan`](super::stored::StoredPlan), whose result
/// is never trusted.
#[derive(Debug, Clone)]
pub struct Plan {
    problem: Problem,
    options: Options,
    searches: Searches,
    detail: Box<Detail>,
    clock: Clock,
    pub(super) margins: OnceLock<Margins>,
    /// The status for the robot and the world without errors, if the motion must be free for errors.
    drawn: OnceLock<Option<Status>>,
}

/// The planned problem and its answer. Limits that the options override have the options' values.
#[derive(Debug, Clone)]
#[expect(clippy::large_enum_variant, reason = "a plan has one, in a box")]
pub enum Detail {
    /// A single motion.
    Motion {
        /// The problem.
        problem: Arc<MotionProblem>,
        /// The answer.
        answer: Answer<Motion>,
    },
    /// A sequence of steps.
    Task {
        /// The task.
        task: Arc<Task>,
        /// The answer.
        answer: TaskAnswer,
    },
}

/// The motion of a plan.
pub(super) struct Found<'a> {
    pub trajectory: &'a Trajectory,
    /// The paths of the motion from stop to stop, before corners are rounded.
    pub paths: Vec<&'a Path>,
    /// Proven lower bound on the distance to obstacles at all times, in metres. Infinite if no obstacle is within reach.
    pub clearance: f64,
    pub timing: Option<&'a Timing>,
}

/// Plans a problem. The result is a certified motion, a proof that there is none, or neither if the effort that the options allow
/// does not suffice. Usually takes milliseconds. Reports long computations and surprising results as lines of text to `progress`.
///
/// # Errors
/// A problem for which the program has no search, invalid options, a motion that is too long to be sampled, and requested
/// accelerations that jump.
pub fn plan(
    problem: &Problem,
    options: &Options,
    searches: Searches,
    progress: &mut dyn FnMut(&str),
) -> Result<Plan, PlanError> {
    if let Some(error) = options.error(problem.task().is_some()) {
        return Err(PlanError::Options(error));
    }
    if let Some(lack) = options.planner.missing_preference(&problem.scene().workspace().preferences) {
        return Err(PlanError::Options(lack));
    }
    if let Some(lack) = unsuitable_options(options, problem) {
        return Err(PlanError::Robot(lack));
    }
    let mut clock = Clock::starting_after(problem.read_in().map(|time| ("load", time)).into_iter().collect());
    let problem = problem.clone().with_limits(options);
    let detail = match &problem.task {
        None => plan_motion(&problem, options, searches.movers, &mut clock, progress)?,
        Some(task) => {
            let search = searches.tasks.ok_or(PlanError::Missing("tasks"))?;
            plan_task((task, search), &joints_in_messages(&problem, options), options, &mut clock, progress)?
        }
    };
    Ok(Plan {
        problem,
        options: *options,
        searches,
        detail: Box::new(detail),
        clock,
        margins: OnceLock::new(),
        drawn: OnceLock::new(),
    })
}

/// Returns the reason why the options do not suit the robot. `None` if they do.
fn unsuitable_options(options: &Options, problem: &Problem) -> Option<String> {
    let curved = options.planner.is_exact().then(|| not_polygons(problem.scene())).flatten();
    if let Some(curved) = curved {
        let why = curved_because(curved, problem.scene());
        return Some(format!(
            "--margin 0 needs C-obstacles that are polygons, but {why}; use a small margin, such as --margin 1e-5"
        ));
    }
    if options.planner.settings().criterion == Criterion::Motor && problem.scene().arm().motors.is_none() {
        return Some("--metric motor needs two joints that turn, with motors: [robot] drives in the world".into());
    }
    if !options.drive.torque || problem.scene().arm().dynamics.is_some() {
        return None;
    }
    let why = problem.robot().no_dynamics.as_deref().unwrap_or("the arm has none of these");
    Some(format!("--torque needs masses, inertias and efforts: {why}"))
}

/// Describes why C-obstacles are not polygons.
fn curved_because(curved: NotPolygons, scene: &Scene) -> String {
    match curved {
        NotPolygons::Arm => format!("only gantries (PP) have polygons, and this arm is {}", scene.arm().kind()),
        NotPolygons::Clearance => {
            format!("a clearance of {} rounds the corners of C-obstacles", length(scene.workspace().clearance))
        }
        NotPolygons::RoundLink(pair) => {
            format!("{} is round, which rounds the corners of C-obstacles", scene.describe_part(pair))
        }
        NotPolygons::RoundObstacle(pair) => {
            format!("{} is round, which rounds the corners of C-obstacles", scene.describe_obstacle(pair.obstacle))
        }
    }
}

/// Plans a single motion.
fn plan_motion(
    problem: &Problem,
    options: &Options,
    movers: Option<&dyn MoverSearch>,
    clock: &mut Clock,
    progress: &mut dyn FnMut(&str),
) -> Result<Detail, PlanError> {
    let motion = &problem.query;
    let trajectories = problem.timed().trajectories;
    if !trajectories.is_empty() && movers.is_none() {
        return Err(PlanError::Missing("moving obstacles"));
    }
    let answer = solve(motion, options, progress);
    clock.solved(&answer.stages);
    if let (Some(bound), Some(gap)) = (answer.bound(), options.planner.gap())
        && bound.gap() > gap
    {
        progress(&format!(
            "warning: the requested gap of {} is not reached: {} is proven at the finest level ({}); more --levels or \
             a smaller --margin may reach it",
            percent(gap),
            percent(bound.gap()),
            options.levels
        ));
    }
    let answer = driven(motion, (trajectories, movers), answer, options)?;
    if let Some(motion) = answer.outcome.found().filter(|_| options.accelerations) {
        motion.timed.trajectory.check_accelerations().map_err(MessageError::from)?;
    }
    clock.stage("trajectory");
    Ok(Detail::Motion { problem: motion.clone(), answer })
}

/// Plans the steps of a task. Checks that ROS messages can name the robot's joints.
fn plan_task(
    (task, search): (&Arc<Task>, &dyn TaskSearch),
    robot: &RobotJoints,
    options: &Options,
    clock: &mut Clock,
    progress: &mut dyn FnMut(&str),
) -> Result<Detail, PlanError> {
    let answer = search.plan(task, options, progress);
    clock.stage("plan");
    if let Some(TaskMotion { sequence, .. }) = answer.outcome.found() {
        let messages = Messages::new(robot, task, &answer.legs, sequence)?;
        if options.accelerations {
            sequence.trajectory.check_accelerations().map_err(MessageError::from)?;
            messages.check_accelerations(robot)?;
        }
    }
    clock.stage("report");
    Ok(Detail::Task { task: task.clone(), answer })
}

/// Returns the joints that ROS messages name.
pub(super) fn joints_in_messages<'a>(problem: &'a Problem, options: &Options) -> Cow<'a, RobotJoints> {
    match options.joints {
        NamedJoints::All => Cow::Borrowed(&problem.robot().joints),
        NamedJoints::Planned => {
            let names = problem.scene().arm().joints.each_ref().map(|joint| joint.name.clone());
            Cow::Owned(RobotJoints::only_planned(&names))
        }
    }
}

impl Plan {
    /// Returns the answer: a certified motion, a proof that there is no motion, or the reason why neither is known.
    pub fn outcome(&self) -> Outcome<&Trajectory, Refutation<'_>> {
        match (self.found(), &*self.detail) {
            (Some(found), _) => Outcome::Found(found.trajectory),
            (None, Detail::Motion { answer: Answer { outcome: Outcome::Infeasible(proof), .. }, .. }) => {
                Outcome::Infeasible(Refutation::Motion(proof))
            }
            (None, Detail::Task { answer: TaskAnswer { outcome: Outcome::Infeasible(failed), .. }, .. }) => {
                Outcome::Infeasible(Refutation::Step(failed))
            }
            _ => Outcome::Unknown(self.reason().unwrap_or_default()),
        }
    }

    /// Returns the status: found, infeasible or unknown.
    pub fn status(&self) -> Status {
        match &*self.detail {
            Detail::Motion { answer, .. } => answer.outcome.status(),
            Detail::Task { answer, .. } => answer.outcome.status(),
        }
    }

    /// Returns the status of the problem without the errors for which the motion must be free; `None` if there are no errors. A
    /// motion that was found also solves that problem. Otherwise, the first call plans that problem.
    pub fn status_as_drawn(&self) -> Option<Status> {
        *self.drawn.get_or_init(|| {
            let errors = self.problem.errors()?;
            if self.status() == Status::Found {
                return Some(Status::Found);
            }
            let drawn = errors.drawn.as_ref()?;
            Some(solve(drawn, &self.options, &mut |_| ()).outcome.status())
        })
    }

    /// Returns the motion of the arm, if there is one.
    pub(super) fn found(&self) -> Option<Found<'_>> {
        Some(match &*self.detail {
            Detail::Motion { answer, .. } => {
                let Motion { path, timed, timing, .. } = answer.outcome.found()?;
                let (trajectory, clearance) = (&timed.trajectory, timed.curve.clearance());
                Found { trajectory, paths: vec![path.path()], clearance, timing: timing.as_ref() }
            }
            Detail::Task { answer, .. } => {
                let TaskMotion { sequence, timing, .. } = answer.outcome.found()?;
                let (trajectory, paths) = (&sequence.trajectory, answer.legs.iter().map(Leg::path).collect());
                Found { trajectory, paths, clearance: answer.clearance(), timing: timing.as_ref() }
            }
        })
    }

    /// Returns the motion, if there is one.
    pub fn trajectory(&self) -> Option<&Trajectory> {
        self.found().map(|found| found.trajectory)
    }

    /// Returns the problem. Limits that the options override have the options' values.
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// Returns the options.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// Returns the stages with their times, in the order in which they ended.
    pub fn timings(&self) -> &[(&'static str, std::time::Duration)] {
        self.clock.stages()
    }

    /// Returns the problem of a single motion, and its answer. `None` for a task.
    pub fn motion(&self) -> Option<(&MotionProblem, &Answer<Motion>)> {
        if let Detail::Motion { problem, answer } = &*self.detail { Some((problem, answer)) } else { None }
    }

    /// Returns the task, and its answer. `None` for a single motion.
    pub fn task(&self) -> Option<(&Task, &TaskAnswer)> {
        if let Detail::Task { task, answer } = &*self.detail { Some((task, answer)) } else { None }
    }

    /// Returns the problem of the motion or the task, and its answer.
    pub fn detail(&self) -> &Detail {
        &self.detail
    }

    /// Returns the replay of how the planner found its answer. `None` for tasks. Computes some data that only the
    /// replay needs.
    pub fn replay(&self) -> Option<Replay> {
        self.motion().map(|(problem, answer)| Replay::new(problem, &self.options, answer))
    }

    /// Returns the replay of how the planner found the motions of a task, which it plans again. `None` for single motions and
    /// with moving obstacles.
    pub fn task_replay(&self) -> Option<TaskReplay> {
        let (task, answer) = self.task().filter(|(task, _)| !task.has_moving_obstacles())?;
        self.searches.tasks.map(|search| search.replay(task, &self.options, answer))
    }

    /// Returns the times at which moving obstacles block places on the motion. If a step fails, the motion is that of the steps
    /// before it. `None` without a motion, or if no obstacle moves. Computed at each call.
    pub fn place_time(&self) -> Option<PlaceTime> {
        let movers = self.searches.movers?;
        let blocked_times: &BlockedTimes = &|timed, configurations| movers.blocked_times(timed, configurations);
        match &*self.detail {
            Detail::Motion { .. } => {
                let (timed, trajectory) = (self.problem.timed(), self.trajectory()?);
                PlaceTime::of(&[MotionPart { timed, trajectory, begin: 0.0, awaited: None }], blocked_times)
            }
            Detail::Task { task, answer } => place_time_of_task(task, &answer.legs, blocked_times),
        }
    }

    /// Returns the arm. Limits that the options override have the options' values.
    pub fn arm(&self) -> &Arm {
        self.problem.scene().arm()
    }
}

fn place_time_of_task(task: &Task, legs: &[Leg], blocked_times: &BlockedTimes) -> Option<PlaceTime> {
    let trajectories: Vec<Vec<ObstacleTrajectory>> = legs.iter().map(|leg| task.trajectories(&leg.moving)).collect();
    let parts = legs.iter().zip(&trajectories).map(|(leg, trajectories)| MotionPart {
        timed: TimedScene { scene: &leg.scene, trajectories },
        trajectory: &leg.timed.trajectory,
        begin: leg.begin,
        awaited: match leg.event {
            Some(Event::Grasp { object }) if leg.moving.contains(&object) => Some(&task.objects[object].name),
            _ => None,
        },
    });
    PlaceTime::of(&parts.collect::<Vec<_>>(), blocked_times)
}
