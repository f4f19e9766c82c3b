//! Answers a page's request within its time limit.

use super::blocked;
use super::contours::Contours;
use super::pace::Pace;
use super::protocol::{AnswerReply, Pair};
use super::result;
use cplan_engine::Problem;
use cplan_handling::TimedScene;
use cplan_interrupt::{Instant, Interrupt, Interrupted};
use cplan_model::Goal;
use cplan_model::space::{Configuration, Measure, Metric, Segment};
use cplan_solver::Options;
use cplan_world::{LoadedProblem, LoadedScene};
use serde::Deserialize;
use std::time::Duration;

/// Time limit of a plan during a drag. Together with the drawing, the page can then update about ten times per second.
const DRAG_TIME: Duration = Duration::from_millis(60);

/// Least and greatest time limit for the answer without a plan, after the time for a plan is up. In between, it equals
/// the time limit of a plan.
const SHOW_TIME: [Duration; 2] = [Duration::from_secs(1), Duration::from_secs(5)];

/// The part of a request's time limit that is already spent. On some hosts, slow work can be stopped only by ending the
/// whole session. The next session then continues the request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum TimeSpent {
    /// No time is spent.
    #[default]
    Nothing,
    /// The time for a plan is spent. The answer shows the world without a plan.
    Plan,
    /// All of the time is spent.
    All,
}

/// The interrupts of the parts of an answer. Each is set when its time is up, or when a newer request arrives.
pub struct Deadlines {
    /// Time limit of a plan.
    limit: Duration,
    /// Stops a plan during a drag.
    pub drag: Interrupt,
    /// Stops any other plan.
    pub plan: Interrupt,
    /// Stops the drawing of an answer without a plan.
    pub show: Interrupt,
}

impl Deadlines {
    /// Creates the deadlines of a request from now on. `spent` is the part of its time limit that is already spent.
    pub fn new(interrupt: &Interrupt, spent: TimeSpent, limit: Duration) -> Self {
        let show = limit.clamp(SHOW_TIME[0], SHOW_TIME[1]);
        let (drag, plan, show) = match spent {
            TimeSpent::Nothing => (DRAG_TIME, limit, limit + show),
            TimeSpent::Plan => (Duration::ZERO, Duration::ZERO, show),
            TimeSpent::All => (Duration::ZERO, Duration::ZERO, Duration::ZERO),
        };
        let begun = Instant::now();
        let by = |time: Duration| interrupt.clone().with_deadline(begun + time);
        Self { limit, drag: by(drag), plan: by(plan), show: by(show) }
    }

    /// Returns the answer to a request whose time is up.
    ///
    /// # Errors
    /// `stopped`, if a newer request was the cause. The page then expects only the answer to the newer one.
    pub fn timed_out(&self, stopped: Interrupted) -> Result<AnswerReply, Interrupted> {
        match stopped {
            Interrupted::TimeUp => Ok(AnswerReply {
                verdict: Some("unknown"),
                reason: Some(time_up(self.limit)),
                ..AnswerReply::default()
            }),
            Interrupted::Set => Err(stopped),
        }
    }
}

/// Returns the message that a time limit is reached.
pub fn time_up(limit: Duration) -> String {
    format!("not decided within {} s", limit.as_secs_f64())
}

/// Returns the answer to a request for which no plan is possible, with the reason.
pub fn refused(about: &'static str, error: String) -> AnswerReply {
    AnswerReply { error: Some(error), about: Some(about), ..AnswerReply::default() }
}

/// The data that answers need in addition to the problem.
pub struct Answering<'a> {
    pub options: &'a Options,
    pub contours: &'a Contours,
    pub deadlines: &'a Deadlines,
    /// True to include the replay of the planner's search.
    pub think: bool,
    /// The text of the world. `None` for answers that are not final.
    pub toml: Option<String>,
}

impl Answering<'_> {
    /// Returns the complete answer about a task.
    ///
    /// # Errors
    /// A newer request has arrived.
    pub fn task(self, problem: &Problem) -> Result<AnswerReply, Interrupted> {
        let Self { options, contours, deadlines, think, toml } = self;
        match deadlines.plan.run(|| result::full_answer(problem, options, contours, think)) {
            Ok(Ok(answer)) => Ok(AnswerReply { toml, ..answer }),
            Ok(Err(error)) => Ok(refused("options", error)),
            Err(stopped) => Ok(AnswerReply { toml, ..deadlines.timed_out(stopped)? }),
        }
    }

    /// Returns the answer for a world with an unusable start or goal. It has the reason, and the arm's configuration
    /// there.
    ///
    /// # Errors
    /// A newer request has arrived.
    pub fn blocked(
        self,
        loaded: &LoadedScene,
        error: &cplan_robot::InputError,
        start: Option<Pair>,
    ) -> Result<AnswerReply, Interrupted> {
        let at = start.map_or_else(Configuration::zeros, Configuration::from);
        let goal: Vec<_> = match loaded.stated_ends() {
            [_, Some(Goal::Joints(q))] => vec![Segment::point(q)],
            _ => Vec::new(),
        };
        let shown = self.without_path(loaded.timed(), (at, &goal), "not planned")?;
        let refusal = blocked::refusal(loaded, error, at);
        Ok(AnswerReply { toml: self.toml, start, view: shown.view, ..refusal })
    }

    /// Returns the answer during a drag, with a path if one is found in time.
    ///
    /// # Errors
    /// A newer request has arrived.
    pub fn quick_answer(self, loaded: LoadedProblem, pace: &Pace) -> Result<AnswerReply, Interrupted> {
        let (ends, problem) = (Ends::of(&loaded), Problem::from(loaded));
        let plan = || result::quick_answer(&problem, self.options, self.contours);
        match pace.tries(|| self.deadlines.drag.run(plan)) {
            Some(Ok(Ok(answer))) => Ok(ends.insert_into(answer)),
            Some(Ok(Err(error))) => Ok(refused("options", error)),
            Some(Err(Interrupted::Set)) => Err(Interrupted::Set),
            None | Some(Err(Interrupted::TimeUp)) => {
                let reason = Some("not decided in the available time, because obstacles move".into());
                let shown = self.without_path(problem.timed(), ends.start_and_goals(), "planning")?;
                Ok(ends.insert_into(AnswerReply { reason, ..shown }))
            }
        }
    }

    /// Returns the complete answer about a motion. The search for a path may take long, so the configuration space is
    /// sent first.
    ///
    /// # Errors
    /// A newer request has arrived.
    pub fn full_answer(
        self,
        loaded: LoadedProblem,
        send: &mut dyn FnMut(AnswerReply),
    ) -> Result<AnswerReply, Interrupted> {
        let (ends, problem) = (Ends::of(&loaded), Problem::from(loaded));
        let Self { options, contours, deadlines, think, .. } = self;
        match deadlines.plan.run(|| result::without_path(problem.timed(), ends.start_and_goals(), "planning", contours))
        {
            Ok(shown) => send(ends.insert_into(shown)),
            Err(Interrupted::TimeUp) => {}
            Err(Interrupted::Set) => return Err(Interrupted::Set),
        }
        match deadlines.plan.run(|| result::full_answer(&problem, options, contours, think)) {
            Ok(Ok(answer)) => Ok(AnswerReply { toml: self.toml, ..ends.insert_into(answer) }),
            Ok(Err(error)) => Ok(refused("options", error)),
            Err(stopped) => {
                let AnswerReply { verdict, reason, .. } = deadlines.timed_out(stopped)?;
                let shown = self.without_path(problem.timed(), ends.start_and_goals(), "unknown")?;
                Ok(ends.insert_into(AnswerReply { verdict, reason, toml: self.toml, ..shown }))
            }
        }
    }

    /// Returns the answer with the configuration space but without a path, if there is enough time.
    fn without_path(
        &self,
        scene: TimedScene,
        ends: (Configuration, &[Segment]),
        status: &str,
    ) -> Result<AnswerReply, Interrupted> {
        match self.deadlines.show.run(|| result::without_path(scene, ends, status, self.contours)) {
            Err(Interrupted::TimeUp) => Ok(AnswerReply::default()),
            shown => shown,
        }
    }
}

/// The start of a motion, and its possible goals.
struct Ends {
    start: Configuration,
    goals: Vec<Segment>,
}

impl Ends {
    fn of(loaded: &LoadedProblem) -> Self {
        Self { start: loaded.problem.start(), goals: loaded.problem.goals().pieces().to_vec() }
    }

    fn start_and_goals(&self) -> (Configuration, &[Segment]) {
        (self.start, &self.goals)
    }

    /// Adds the start and the goals to an answer.
    fn insert_into(&self, answer: AnswerReply) -> AnswerReply {
        let nearest = |goal: &Segment| goal.nearest(Measure::from(Metric::Euclidean), self.start).into();
        AnswerReply { start: Some(self.start.into()), goals: self.goals.iter().map(nearest).collect(), ..answer }
    }
}
