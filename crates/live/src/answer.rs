//! The answer to what a page asks, within its time.

use super::blocked;
use super::contours::Contours;
use super::pace::Pace;
use super::protocol::{About, AnswerReply, Pair};
use super::result;
use cplan_core::model::{Goal, Scene};
use cplan_core::space::{Configuration, Measure, Metric, Segment};
use cplan_engine::Problem;
use cplan_interrupt::{Instant, Interrupt, Interrupted};
use cplan_solver::Options;
use cplan_world::{Loaded, LoadedScene, Overrides};
use serde::Deserialize;
use std::time::Duration;

/// Time for a plan while something is dragged. What is shown then, with or without a plan, takes a little longer: all in all
/// a page is to follow ten times a second.
const DRAG_TIME: Duration = Duration::from_millis(60);

/// Time for the obstacles alone, once the time for a plan is up: as much again, but no less and no more than this.
const SHOW_TIME: [Duration; 2] = [Duration::from_secs(1), Duration::from_secs(5)];

/// What of the time for a request is gone already. Where work that takes too long can only be ended together with all that the
/// program remembers, the rest of the request is done by the next one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Spent {
    /// None of it.
    #[default]
    Nothing,
    /// That for a plan: what there is to see is shown without.
    Plan,
    /// All of it.
    All,
}

/// What stops the parts of an answer: its time, and a newer request.
pub struct Deadlines {
    /// Time for a plan.
    limit: Duration,
    /// Stops a plan while something is dragged.
    pub drag: Interrupt,
    /// Stops a plan.
    pub plan: Interrupt,
    /// Stops what is shown in place of a plan, which must not take much longer than that did.
    pub show: Interrupt,
}

impl Deadlines {
    /// From now on, for a request that has spent part of its time.
    pub fn new(interrupt: &Interrupt, spent: Spent, limit: Duration) -> Self {
        let show = limit.clamp(SHOW_TIME[0], SHOW_TIME[1]);
        let (drag, plan, show) = match spent {
            Spent::Nothing => (DRAG_TIME, limit, limit + show),
            Spent::Plan => (Duration::ZERO, Duration::ZERO, show),
            Spent::All => (Duration::ZERO, Duration::ZERO, Duration::ZERO),
        };
        let begun = Instant::now();
        let by = |time: Duration| interrupt.clone().by(begun + time);
        Self { limit, drag: by(drag), plan: by(plan), show: by(show) }
    }

    /// The answer where the time is up.
    ///
    /// # Errors
    /// Where something newer was asked: then there is none.
    pub fn late(&self, stopped: Interrupted) -> Result<AnswerReply, Interrupted> {
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

/// What is said where a time is up.
pub fn time_up(limit: Duration) -> String {
    format!("not decided within {} s", limit.as_secs_f64())
}

/// The answer to what cannot be planned, and why.
pub fn refused(about: About, error: String) -> AnswerReply {
    AnswerReply { error: Some(error), about: Some(about), ..AnswerReply::default() }
}

/// What an answer needs besides the problem.
pub struct Answering<'a> {
    pub options: &'a Options,
    pub contours: &'a Contours,
    pub deadlines: &'a Deadlines,
    /// Whether to say how the planner came to it.
    pub think: bool,
    /// The world as text, of final answers.
    pub toml: Option<String>,
}

impl Answering<'_> {
    /// All that can be known of a task.
    ///
    /// # Errors
    /// Where something newer was asked.
    pub fn task(self, loaded: LoadedScene) -> Result<AnswerReply, Interrupted> {
        let problem = match Problem::of_scene(loaded, &Overrides::default()) {
            Ok(problem) => problem,
            Err(error) => return Ok(refused(About::World, error.to_string())),
        };
        let Self { options, contours, deadlines, think, toml } = self;
        match deadlines.plan.run(|| result::in_full(&problem, options, contours, think)) {
            Ok(Ok(answer)) => Ok(AnswerReply { toml, ..answer }),
            Ok(Err(error)) => Ok(refused(About::Options, error)),
            Err(stopped) => Ok(AnswerReply { toml, ..deadlines.late(stopped)? }),
        }
    }

    /// Of a world whose start or goal cannot be taken: why, and where the arm is then.
    ///
    /// # Errors
    /// Where something newer was asked.
    pub fn blocked(
        self,
        loaded: &LoadedScene,
        error: &cplan_robot::InputError,
        start: Option<Pair>,
    ) -> Result<AnswerReply, Interrupted> {
        let at = start.map_or_else(Configuration::zeros, Configuration::from);
        let goal: Vec<_> = match loaded.given() {
            [_, Some(Goal::Joints(q))] => vec![Segment::point(q)],
            _ => Vec::new(),
        };
        let shown = self.bare(&loaded.scene, (at, &goal), "not planned")?;
        let refusal = blocked::refusal(loaded, error, at);
        Ok(AnswerReply { toml: self.toml, start, view: shown.view, ..refusal })
    }

    /// A path, as far as that is found while something is dragged.
    ///
    /// # Errors
    /// Where something newer was asked.
    pub fn quick(self, loaded: Loaded, pace: &Pace) -> Result<AnswerReply, Interrupted> {
        let (ends, problem) = (Ends::of(&loaded), Problem::from(loaded));
        let plan = || result::quick(&problem, self.options, self.contours);
        match pace.tries(|| self.deadlines.drag.run(plan)) {
            Some(Ok(Ok(answer))) => Ok(ends.put_into(answer)),
            Some(Ok(Err(error))) => Ok(refused(About::Options, error)),
            Some(Err(Interrupted::Set)) => Err(Interrupted::Set),
            None | Some(Err(Interrupted::TimeUp)) => {
                let reason = Some("not decided while something moves".into());
                let shown = self.bare(problem.scene(), ends.both(), "planning")?;
                Ok(ends.put_into(AnswerReply { reason, ..shown }))
            }
        }
    }

    /// All that can be known of a motion. Tells the configuration space before it looks for a path, which may take long.
    ///
    /// # Errors
    /// Where something newer was asked.
    pub fn in_full(self, loaded: Loaded, tell: &mut dyn FnMut(AnswerReply)) -> Result<AnswerReply, Interrupted> {
        let (ends, problem) = (Ends::of(&loaded), Problem::from(loaded));
        let Self { options, contours, deadlines, think, .. } = self;
        match deadlines.plan.run(|| result::bare(problem.scene(), ends.both(), "planning", contours)) {
            Ok(shown) => tell(ends.put_into(shown)),
            Err(Interrupted::TimeUp) => {}
            Err(Interrupted::Set) => return Err(Interrupted::Set),
        }
        match deadlines.plan.run(|| result::in_full(&problem, options, contours, think)) {
            Ok(Ok(answer)) => Ok(AnswerReply { toml: self.toml, ..ends.put_into(answer) }),
            Ok(Err(error)) => Ok(refused(About::Options, error)),
            Err(stopped) => {
                let AnswerReply { verdict, reason, .. } = deadlines.late(stopped)?;
                let shown = self.bare(problem.scene(), ends.both(), "unknown")?;
                Ok(ends.put_into(AnswerReply { verdict, reason, toml: self.toml, ..shown }))
            }
        }
    }

    /// The configuration space without a path, if there is time for it.
    fn bare(&self, scene: &Scene, ends: (Configuration, &[Segment]), status: &str) -> Result<AnswerReply, Interrupted> {
        match self.deadlines.show.run(|| result::bare(scene, ends, status, self.contours)) {
            Err(Interrupted::TimeUp) => Ok(AnswerReply::default()),
            shown => shown,
        }
    }
}

/// Where a motion begins, and where it may end.
struct Ends {
    start: Configuration,
    goals: Vec<Segment>,
}

impl Ends {
    fn of(loaded: &Loaded) -> Self {
        Self { start: loaded.problem.start(), goals: loaded.problem.goals().pieces().to_vec() }
    }

    fn both(&self) -> (Configuration, &[Segment]) {
        (self.start, &self.goals)
    }

    /// An answer that says them.
    fn put_into(&self, answer: AnswerReply) -> AnswerReply {
        let nearest = |goal: &Segment| goal.nearest(Measure::from(Metric::Euclidean), self.start).into();
        AnswerReply { start: Some(self.start.into()), goals: self.goals.iter().map(nearest).collect(), ..answer }
    }
}
