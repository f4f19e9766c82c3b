//! The motion along a path that was found.

use super::fastest::fastest;
use super::searches::MoverSearch;
use cplan_handling::ObstacleTrajectory;
use cplan_model::{MotionProblem, Outcome};
use cplan_motion::{DurationOptimality, Objective, TimedMotion, Timing, TimingError};
use cplan_solver::{Answer, BoundedPath, Options};

/// A motion that is certified free of collision.
#[derive(Debug, Clone)]
pub struct Motion {
    /// The path of the motion, before its corners are rounded.
    pub path: BoundedPath,
    /// The path with rounded corners, and its timing.
    pub timed: TimedMotion,
    /// The duration, with a proven lower bound on the duration of every motion. `None` if no bound was requested.
    pub fastest: Option<DurationOptimality>,
    /// How the motion passes moving obstacles. `None` if no obstacle moves.
    pub timing: Option<Timing>,
}

impl AsRef<BoundedPath> for Motion {
    fn as_ref(&self) -> &BoundedPath {
        &self.path
    }
}

impl Motion {
    /// Times the motion along a path. If no timing avoids moving obstacles, returns the reason in words as the error.
    fn along(
        problem: &MotionProblem,
        (trajectories, movers): (&[ObstacleTrajectory], Option<&dyn MoverSearch>),
        path: BoundedPath,
        options: &Options,
    ) -> Result<Result<Self, String>, TimingError> {
        let (mut timed, mut fastest) = match options.drive.optimize {
            Objective::Length => (options.drive.along(problem.scene(), &path.certified, 1.0)?, None),
            Objective::Time => fastest(problem, &path, options)?,
        };
        let mut timing = None;
        if let Some(movers) = movers.filter(|_| !trajectories.is_empty()) {
            // The fastest motion may follow another path, to another goal, than the shortest one.
            let taken = timed.curve.straight().clone();
            match movers.plan(problem, trajectories, &taken, timed, options)? {
                Ok((waiting, figures)) => {
                    // The bound stays the same, but the duration includes waits now.
                    let duration = waiting.trajectory.duration();
                    fastest = fastest.map(|fastest| DurationOptimality::new(duration, fastest.lower_bound));
                    (timed, timing) = (waiting, Some(figures));
                }
                Err(reason) => return Ok(Err(reason)),
            }
        }
        let is_same = timed.curve.curve().path() == path.path();
        let path = if is_same { path } else { path.replaced_by(timed.curve.straight().clone()) };
        Ok(Ok(Self { path, timed, fastest, timing }))
    }
}

/// Times the motion along the path of an answer, by `search` if obstacles move on these trajectories. Returns an answer without a
/// path unchanged.
///
/// # Errors
/// A motion that lasts too long, or has too many samples.
pub(super) fn driven(
    problem: &MotionProblem,
    movers: (&[ObstacleTrajectory], Option<&dyn MoverSearch>),
    answer: Answer,
    options: &Options,
) -> Result<Answer<Motion>, TimingError> {
    let Answer { method, outcome, path_kind, history, run, space, stages } = answer;
    let outcome = match outcome {
        Outcome::Found(path) => match Motion::along(problem, movers, path, options)? {
            Ok(motion) => Outcome::Found(motion),
            Err(reason) => Outcome::Unknown(reason.into()),
        },
        Outcome::Infeasible(proof) => Outcome::Infeasible(proof),
        Outcome::Unknown(unknown) => Outcome::Unknown(unknown),
    };
    Ok(Answer { method, outcome, path_kind, history, run, space, stages })
}
