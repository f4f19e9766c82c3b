//! The front door: from a problem and options to a plan.

use super::clock::Clock;
use super::motion_plan::MotionPlan;
use super::options::Options;
use super::problem::{Asked, Problem};
use super::task::{FailedStep, MessageError, TaskAnswer, TaskReport, plan as plan_task};
use super::{GridSpace, Verdict, percent, solve};
use crate::check::CheckedProof;
use crate::model::{MotionProblem, Outcome, RobotJoints, Status, Task};
use crate::motion::{AccelerationJump, Report, SearchUsed, TimingError, Trajectory};
use std::borrow::Cow;
use thiserror::Error;

/// Why there is no plan, not even one that says "unknown".
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PlanError {
    /// Options that make no sense, or not for this problem.
    #[error("{0}")]
    Options(String),
    /// The trajectory cannot be made as asked.
    #[error(transparent)]
    Timing(#[from] TimingError),
    /// Accelerations that would mislead their readers.
    #[error(transparent)]
    Accelerations(#[from] AccelerationJump),
    /// Joints that messages cannot name as asked.
    #[error(transparent)]
    Joints(#[from] MessageError),
}

/// Why something cannot be done: proven.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Refutation<'a> {
    /// Of a motion: boxes of configurations that collide separate start and goals.
    Motion(&'a CheckedProof),
    /// Of a task: a step that cannot be done, nor can the task in any other way.
    Step(&'a FailedStep),
}

/// All that is known of a problem: the outcome, and what can be printed, written and drawn of it.
///
/// It is made by [`plan`] and immutable. [`Plan::outcome`] has the answer itself; `to_json`, `svg`, `html`, `bytes`, `save` and
/// `summary` are what the program writes.
#[derive(Debug, Clone)]
pub struct Plan {
    problem: Problem,
    options: Options,
    made: Made,
    clock: Clock,
}

/// What was made, and of what. The problem is asked with the options' own limits.
#[derive(Debug, Clone)]
pub(crate) enum Made {
    /// A single motion.
    Motion(Box<MotionPlan>),
    /// A sequence of them.
    Task(Box<TaskPlan>),
}

/// What became of a task.
#[derive(Debug, Clone)]
pub struct TaskPlan {
    /// The task, with the limits asked for.
    pub task: Task,
    /// The answer.
    pub answer: TaskAnswer,
    /// What is to be said of it.
    pub report: TaskReport,
}

/// Plans: a certified motion, a proof that there is none, or neither within the options' effort. Milliseconds, as a rule.
///
/// # Errors
/// Options that make no sense; a motion that lasts too long for its samples; accelerations that were asked for and jump.
pub fn plan(problem: &Problem, options: &Options) -> Result<Plan, PlanError> {
    plan_with(problem, options, &mut |_| ())
}

/// The same; `progress` hears of long work, and of what may surprise, in lines of text.
///
/// # Errors
/// As [`plan`].
pub fn plan_with(problem: &Problem, options: &Options, progress: &mut dyn FnMut(&str)) -> Result<Plan, PlanError> {
    if let Some(error) = options.error(problem.task().is_some()) {
        return Err(PlanError::Options(error));
    }
    let mut clock = Clock::after(problem.read_in().map(|time| ("load", time)).into_iter().collect());
    let made = match problem.asked() {
        Asked::Motion(motion) => {
            let plan = plan_motion(problem, motion, options, &mut clock, progress)?;
            Made::Motion(Box::new(plan))
        }
        Asked::Task(asked) => Made::Task(Box::new(plan_steps(problem, &asked.0, options, &mut clock, progress)?)),
    };
    Ok(Plan { problem: problem.clone(), options: *options, made, clock })
}

fn plan_motion(
    problem: &Problem,
    motion: &MotionProblem,
    options: &Options,
    clock: &mut Clock,
    progress: &mut dyn FnMut(&str),
) -> Result<MotionPlan, PlanError> {
    let mut asked = Cow::Borrowed(motion);
    if options.jerk.is_some() {
        options.override_limits(asked.to_mut().joints_mut());
    }
    let answer = solve(&asked, options, progress);
    clock.solved(&answer.stages);
    if let (Some(bound), Some(gap)) = (&answer.bound, options.planner.gap())
        && bound.gap() > gap
    {
        progress(&format!(
            "warning: the gap of {} asked for is not reached: {} is proven at the finest level ({}); more --levels or a \
             smaller --margin may do",
            percent(gap),
            percent(bound.gap()),
            options.levels
        ));
    }
    let mut plan = MotionPlan::timed(asked.into_owned(), answer, options)?;
    plan.report.assumed = problem.robot().assumed.clone();
    plan.report.robot = named(problem, options, &plan.report.joints).into_owned();
    plan.report.accelerations = options.accelerations;
    if let Some(trajectory) = plan.report.trajectory.as_ref().filter(|_| options.accelerations) {
        trajectory.check_accelerations()?;
    }
    clock.stage("trajectory");
    if options.timings {
        plan.report.timings = clock.milliseconds();
    }
    Ok(plan)
}

fn plan_steps(
    problem: &Problem,
    task: &Task,
    options: &Options,
    clock: &mut Clock,
    progress: &mut dyn FnMut(&str),
) -> Result<TaskPlan, PlanError> {
    let mut task = task.clone();
    options.override_limits(&mut task.arm.joints);
    let answer = plan_task(&task, options, progress);
    clock.stage("plan");
    let mut report = TaskReport::new(options.planner.method().name(), &task, &answer);
    let robot = named(problem, options, report.joints()).into_owned();
    report.name_joints(&robot, &task, &answer, options.accelerations)?;
    report.search = SearchUsed::of(&options.planner);
    report.space = options.planner.space().and_then(GridSpace::told);
    report.assumed = problem.robot().assumed.clone();
    clock.stage("report");
    if options.timings {
        report.timings = clock.milliseconds();
    }
    Ok(TaskPlan { task, answer, report })
}

/// The joints that messages name.
fn named<'a>(problem: &'a Problem, options: &Options, planned: &[String; 2]) -> Cow<'a, RobotJoints> {
    match options.joints {
        super::NamedJoints::All => Cow::Borrowed(&problem.robot().joints),
        super::NamedJoints::Planned => Cow::Owned(RobotJoints::planned(planned)),
    }
}

impl Plan {
    /// The answer: a certified motion; a proof that there is none; or why neither is known.
    #[must_use]
    pub fn outcome(&self) -> Outcome<&Trajectory, Refutation<'_>, &str> {
        match &self.made {
            Made::Motion(plan) => match (&plan.answer.verdict, &plan.report.trajectory) {
                (Verdict::Found(_), Some(trajectory)) => Outcome::Found(trajectory),
                (Verdict::Infeasible(proof), _) => Outcome::Infeasible(Refutation::Motion(proof)),
                (Verdict::Unknown(why), _) => Outcome::Unknown(why),
                (Verdict::Found(_), None) => unreachable!("what is found is timed before it is a plan"),
            },
            Made::Task(plan) => match (plan.answer.verdict.status(), plan.report.trajectory(), plan.report.failed()) {
                (Status::Found, Some(trajectory), _) => Outcome::Found(trajectory),
                (Status::Infeasible, _, Some(step)) => Outcome::Infeasible(Refutation::Step(step)),
                _ => Outcome::Unknown(plan.report.reason().unwrap_or_default()),
            },
        }
    }

    /// Which of the three answers it is.
    #[must_use]
    pub fn status(&self) -> Status {
        match &self.made {
            Made::Motion(plan) => plan.answer.verdict.status(),
            Made::Task(plan) => plan.answer.verdict.status(),
        }
    }

    /// The motion, if there is one.
    #[must_use]
    pub fn trajectory(&self) -> Option<&Trajectory> {
        match &self.made {
            Made::Motion(plan) => plan.report.trajectory.as_ref(),
            Made::Task(plan) => plan.report.trajectory(),
        }
    }

    /// What was asked.
    #[must_use]
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// How it was asked.
    #[must_use]
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// The time that each stage took, in the order in which they ended.
    #[must_use]
    pub fn timings(&self) -> &[(&'static str, std::time::Duration)] {
        self.clock.stages()
    }

    /// Verdict, bound, path, trace and figures of a single motion.
    #[must_use]
    pub fn motion(&self) -> Option<&MotionPlan> {
        if let Made::Motion(plan) = &self.made { Some(plan) } else { None }
    }

    /// Steps, events and figures of a task.
    #[must_use]
    pub fn task(&self) -> Option<&TaskPlan> {
        if let Made::Task(plan) = &self.made { Some(plan) } else { None }
    }

    pub(crate) fn made(&self) -> &Made {
        &self.made
    }

    /// The result as a JSON object, a line a field, as interface and book describe it.
    #[must_use]
    pub fn to_json(&self) -> String {
        match &self.made {
            Made::Motion(plan) => plan.report.json(),
            Made::Task(plan) => plan.report.json(),
        }
    }

    /// The same as a value.
    pub(super) fn result_value(&self) -> serde_json::Result<serde_json::Value> {
        match &self.made {
            Made::Motion(plan) => serde_json::to_value(&plan.report),
            Made::Task(plan) => serde_json::to_value(&plan.report),
        }
    }

    /// The result's fields, of a single motion.
    #[must_use]
    pub fn report(&self) -> Option<&Report> {
        self.motion().map(|plan| &plan.report)
    }
}
