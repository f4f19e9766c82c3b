//! The front door: from a problem and options to a plan.

use super::clock::Clock;
use super::motion_plan::MotionPlan;
use super::options::Options;
use super::problem::{Asked, Problem};
use super::result::Report;
use super::result::search_used;
use super::task::{FailedStep, MessageError, TaskAnswer, TaskReplay, plan as plan_task};
use super::{Answer, GridSpace, Kind, Replay, solve};
use cplan_core::check::CheckedProof;
use cplan_core::model::{Arm, MotionProblem, Outcome, Status};
use cplan_handling::{RobotJoints, Task};
use cplan_motion::{TimingError, Trajectory};
use cplan_text::percent;
use std::borrow::Cow;
use thiserror::Error;

/// Why there is no plan, not even one that says "unknown".
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PlanError {
    /// Options that make no sense, or not for this problem.
    #[error("{0}")]
    Options(String),
    /// Options that ask of the robot what its file does not say.
    #[error("{0}")]
    Robot(String),
    /// The trajectory cannot be made as asked.
    #[error(transparent)]
    Timing(#[from] TimingError),
    /// Joints that messages cannot name as asked, or accelerations that would mislead their readers.
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
///
/// It is data for serde: the problem, the options and the result. Nothing that such data states is believed; reading plans again, and
/// refuses a result that differs, but for the times that it took. So a plan that is read is as certified as one that was just made.
///
/// ```
/// use cplan_core::model::{Arm, Obstacle, Workspace};
/// use cplan_engine::{Options, Plan, Problem, plan};
///
/// let post = Obstacle::circle("post", [1.6, 0.0], 0.1)?;
/// let problem = Problem::new(Arm::rr([1.0, 0.8], 0.06)?, Workspace::new([post]), [1.0, 0.2], [-1.0, -0.2])?;
/// let made = plan(&problem, &Options::default())?;
/// let stored = serde_json::to_string(&made)?;
///
/// let read: Plan = serde_json::from_str(&stored)?;
/// assert_eq!(read.trajectory(), made.trajectory());
///
/// let tampered = stored.replace("\"certified\":true", "\"certified\":false");
/// let refused = serde_json::from_str::<Plan>(&tampered).expect_err("planning says otherwise");
/// assert!(refused.to_string().contains("result.certified is false, and planning gives true"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Plan {
    problem: Problem,
    options: Options,
    /// What was made, and of what. The problem is asked with the options' own limits.
    made: Kind<Box<MotionPlan>, TaskPlan>,
    report: Report,
    clock: Clock,
}

/// What became of a task.
#[derive(Debug, Clone)]
pub struct TaskPlan {
    /// The task, with the limits asked for.
    pub task: Task,
    /// The answer.
    pub answer: TaskAnswer,
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
    if let Some(lack) = options.planner.lack(&problem.scene().workspace().preferences) {
        return Err(PlanError::Options(lack));
    }
    if let Some(lack) = options.lack(problem) {
        return Err(PlanError::Robot(lack));
    }
    let mut clock = Clock::after(problem.read_in().map(|time| ("load", time)).into_iter().collect());
    let (made, mut report) = match problem.asked() {
        Asked::Motion(motion) => {
            let (motion, answer) = solve_with(motion, options, &mut clock, progress);
            let (made, mut report) = MotionPlan::timed(motion, answer, options)?;
            report.name_joints(&named(problem, options), options.accelerations)?;
            clock.stage("trajectory");
            (Kind::Motion(Box::new(made)), report)
        }
        Asked::Task((task, _)) => {
            let mut task = task.clone();
            options.override_limits(&mut task.arm);
            let answer = plan_task(&task, options, progress);
            clock.stage("plan");
            let mut report = Report::of_task(options.planner.method().name(), &task, &answer);
            report.name_all(&named(problem, options), &task, &answer, options.accelerations)?;
            clock.stage("report");
            (Kind::Task(TaskPlan { task, answer }), report)
        }
    };
    report.search = search_used(&options.planner);
    report.space = options.planner.space().and_then(GridSpace::told);
    report.assumed = problem.robot().assumed.clone();
    if options.drive.torque {
        report.assumed.acceleration.clear();
    }
    if options.timings {
        report.timings = clock.milliseconds();
    }
    Ok(Plan { problem: problem.clone(), options: *options, made, report, clock })
}

/// The problem with the limits asked for, and its answer.
fn solve_with(
    motion: &MotionProblem,
    options: &Options,
    clock: &mut Clock,
    progress: &mut dyn FnMut(&str),
) -> (MotionProblem, Answer) {
    let mut motion = motion.clone();
    options.override_limits(motion.arm_mut());
    let answer = solve(&motion, options, progress);
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
    (motion, answer)
}

/// The joints that messages name.
fn named<'a>(problem: &'a Problem, options: &Options) -> Cow<'a, RobotJoints> {
    match options.joints {
        super::NamedJoints::All => Cow::Borrowed(&problem.robot().joints),
        super::NamedJoints::Planned => {
            let names = problem.scene().arm().joints.each_ref().map(|joint| joint.name.clone());
            Cow::Owned(RobotJoints::planned(&names))
        }
    }
}

impl Plan {
    /// The answer: a certified motion; a proof that there is none; or why neither is known.
    #[must_use]
    pub fn outcome(&self) -> Outcome<&Trajectory, Refutation<'_>, &str> {
        let Report { trajectory, proof, task, reason, .. } = &self.report;
        let step = task.as_ref().and_then(|task| task.failed.as_ref()).map(Refutation::Step);
        match (self.status(), trajectory, proof.as_ref().map(Refutation::Motion).or(step)) {
            (Status::Found, Some(trajectory), _) => Outcome::Found(trajectory),
            (Status::Infeasible, _, Some(refutation)) => Outcome::Infeasible(refutation),
            _ => Outcome::Unknown(reason.as_deref().unwrap_or_default()),
        }
    }

    /// Which of the three answers it is.
    #[must_use]
    pub fn status(&self) -> Status {
        self.report.status()
    }

    /// The motion, if there is one.
    #[must_use]
    pub fn trajectory(&self) -> Option<&Trajectory> {
        self.report.trajectory.as_ref()
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

    /// Verdict, bound, path and trace of a single motion.
    #[must_use]
    pub fn motion(&self) -> Option<&MotionPlan> {
        self.made.motion().map(Box::as_ref)
    }

    /// How the planner came to its answer; of single motions. Some of it is computed for this alone.
    #[must_use]
    pub fn replay(&self) -> Option<Replay> {
        self.motion().map(|plan| Replay::new(&plan.problem, &self.options, &plan.answer))
    }

    /// How the planner came to the motions of a task, which are planned again for this; none among what moves, where ways are tried in time.
    #[must_use]
    pub fn task_replay(&self) -> Option<TaskReplay> {
        let standing = self.task().filter(|plan| !plan.task.has_movers());
        standing.map(|plan| TaskReplay::new(&plan.task, &self.options, &plan.answer))
    }

    /// Steps and their motions, of a task.
    #[must_use]
    pub fn task(&self) -> Option<&TaskPlan> {
        self.made.task()
    }

    /// The plan of a motion, or of a task.
    #[must_use]
    pub fn made(&self) -> &Kind<Box<MotionPlan>, TaskPlan> {
        &self.made
    }

    /// The arm, with the limits asked for.
    pub fn arm(&self) -> &Arm {
        match &self.made {
            Kind::Motion(plan) => plan.problem.scene().arm(),
            Kind::Task(plan) => &plan.task.arm,
        }
    }

    /// The result as a JSON object, a line a field, as interface and book describe it.
    #[must_use]
    pub fn to_json(&self) -> String {
        self.report.json()
    }

    /// The result's fields.
    #[must_use]
    pub fn report(&self) -> &Report {
        &self.report
    }
}
