//! The outcome of a task.

use super::failed_step::FailedStep;
use super::leg::Leg;
use super::sequence::Sequence;
use cplan_model::Outcome;
use cplan_motion::Timing;

/// The motion that performs all steps of a task.
#[derive(Debug, Clone, PartialEq)]
pub struct TaskMotion {
    /// The motions of all steps, joined into one.
    pub sequence: Sequence,
    /// True if no other choice of IK solutions, turns and order is faster, among the motions that this planner finds.
    pub exact: bool,
    /// How the arm passes moving obstacles, with times from the beginning of the task. `None` if no obstacle moves.
    pub timing: Option<Timing>,
}

impl TaskMotion {
    /// Returns the duration, in seconds.
    pub fn seconds(&self) -> f64 {
        self.sequence.trajectory.duration()
    }
}

/// The outcome of a task, with figures about the search.
#[derive(Debug, Clone)]
pub struct TaskAnswer {
    /// The motion that performs all steps, or the step that fails with all IK solutions and orders. The failure is proven
    /// (infeasible), or the search merely found no solution (unknown).
    pub outcome: Outcome<TaskMotion, FailedStep, FailedStep>,
    /// The steps in the order of execution: all of them, or those before the failed step.
    pub legs: Vec<Leg>,
    /// Proven lower bound, in seconds, on the duration of every motion that performs the whole task: it stops at each target, and
    /// lowers and raises the tool there.
    pub lower_bound: f64,
    /// Number of motions that were planned, including those that the answer does not use.
    pub motions: usize,
    /// Number of nodes that the search expanded.
    pub expanded: usize,
}

impl TaskAnswer {
    /// Returns the step that fails. `None` if all steps are done.
    pub fn failed(&self) -> Option<&FailedStep> {
        match &self.outcome {
            Outcome::Found(_) => None,
            Outcome::Infeasible(failed) | Outcome::Unknown(failed) => Some(failed),
        }
    }

    /// Returns the lower bound on the duration of the task, in seconds. It never exceeds the actual duration.
    pub fn least_seconds(&self) -> f64 {
        // Without obstacles in the way, both are sums of the same times in different orders, so rounding may make the bound
        // larger.
        self.outcome.found().map_or(self.lower_bound, |motion| motion.seconds().min(self.lower_bound))
    }

    /// Returns an upper bound on the relative excess over the fastest solution: `duration / lower_bound - 1`. `None` if not all
    /// steps are performed, or if only the bound is 0.
    pub fn gap(&self) -> Option<f64> {
        let (seconds, least) = (self.outcome.found()?.seconds(), self.least_seconds());
        let gap = if seconds == least { 0.0 } else { seconds / least - 1.0 };
        gap.is_finite().then_some(gap)
    }

    /// Returns the time from the beginning to the end of the last step, in seconds.
    pub fn duration(&self) -> f64 {
        self.legs.last().map_or(0.0, Leg::end)
    }

    /// Returns a proven lower bound on the distance to obstacles at all times, in metres. Infinite if no obstacle is
    /// within reach.
    pub fn clearance(&self) -> f64 {
        self.legs.iter().map(Leg::clearance).fold(f64::INFINITY, f64::min)
    }
}
