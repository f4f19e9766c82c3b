//! The outcome of a task.

use super::failed_step::FailedStep;
use super::sequence::Sequence;
use super::stroke::ToolStroke;
use cplan_core::model::{Outcome, Scene};
use cplan_core::space::Path;
use cplan_geometry::Pose;
use cplan_handling::Step;
use cplan_motion::TimedMotion;
use cplan_motion::recorded::WristTurn;
use cplan_movers::Timing;
use std::sync::Arc;

/// An event at the end of a step's motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Event {
    /// The gripper grasps an object.
    Grasp {
        /// The number of the object in the task.
        object: usize,
    },
    /// The gripper releases an object.
    Release {
        /// The number of the object in the task.
        object: usize,
        /// Pose of the object from then on.
        pose: Pose,
    },
}

impl Event {
    /// Returns the object that is grasped or released.
    #[must_use]
    pub fn object(&self) -> usize {
        match *self {
            Event::Grasp { object } | Event::Release { object, .. } => object,
        }
    }
}

/// The arm's actions for one step: a motion from rest to rest, possibly a turn of the wrist, possibly an event, and a
/// rest.
///
/// - Pick: motion, stroke down, grasp, dwell, stroke up, turn.
/// - Place: motion, turn, stroke down, release, dwell, stroke up.
/// - Move: motion, dwell.
#[derive(Debug, Clone, PartialEq)]
pub struct Leg {
    /// The step.
    pub step: Step,
    /// The world during the motion, with the payload.
    pub scene: Arc<Scene>,
    /// The objects that still move ([`cplan_handling::Task::courses`]).
    pub moving: Arc<[usize]>,
    /// The object that is carried during the motion.
    pub carried: Option<usize>,
    /// The motion, on a clock of its own.
    pub timed: Arc<TimedMotion>,
    /// Turn of the wrist, and the seconds that it takes.
    pub turn: Option<(WristTurn, f64)>,
    /// Lowering and raising of the tool, if the world has a stroke.
    pub stroke: Option<ToolStroke>,
    /// The event while the tool is lowered.
    pub event: Option<Event>,
    /// Seconds from the beginning of the task to that of the motion.
    pub begin: f64,
}

impl Leg {
    /// Returns the path of the motion, without blends.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.timed.curve.curve().path()
    }

    /// Returns the seconds from the beginning of the task to the end of the motion.
    #[must_use]
    pub fn arrival(&self) -> f64 {
        self.begin + self.timed.trajectory.duration()
    }

    /// Returns the seconds that the arm stands still after the motion.
    #[must_use]
    pub fn rest(&self) -> f64 {
        self.step.dwell + self.turning() + 2.0 * self.lowering()
    }

    /// Returns the seconds that the wrist turns.
    #[must_use]
    pub fn turning(&self) -> f64 {
        self.turn.map_or(0.0, |(_, seconds)| seconds)
    }

    /// Returns the seconds that the tool takes to go down, which equal those to go up.
    #[must_use]
    pub fn lowering(&self) -> f64 {
        self.stroke.map_or(0.0, |stroke| stroke.seconds)
    }

    /// Returns the seconds from the end of the motion to the grasp or release, if there is one.
    #[must_use]
    pub fn event_after(&self) -> Option<f64> {
        match self.event? {
            Event::Grasp { .. } => Some(self.lowering()),
            Event::Release { .. } => Some(self.turning() + self.lowering()),
        }
    }

    /// Returns the seconds from the beginning of the task to the grasp or release, if there is one.
    #[must_use]
    pub fn event_time(&self) -> Option<f64> {
        self.event_after().map(|after| self.arrival() + after)
    }

    /// Returns the seconds from the beginning of the task to the end of the step.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.arrival() + self.rest()
    }

    /// Returns a proven lower bound on the distance to obstacles during the motion, the turn and the stroke, metres.
    /// Infinite if no obstacle is within reach.
    #[must_use]
    pub fn clearance(&self) -> f64 {
        let turn = self.turn.map_or(f64::INFINITY, |(turn, _)| turn.clearance);
        let stroke = self.stroke.map_or(f64::INFINITY, |stroke| stroke.clearance);
        turn.min(stroke).min(self.timed.curve.clearance())
    }
}

/// All steps of a task, done one after the other.
#[derive(Debug, Clone, PartialEq)]
pub struct TaskMotion {
    /// The motions of all steps, joined into one.
    pub sequence: Sequence,
    /// True if no other choice of IK solutions, turns and order is faster with the motions that this planner finds.
    pub exact: bool,
    /// How the arm passes moving obstacles, if there are any, on the clock of the task.
    pub timing: Option<Timing>,
}

impl TaskMotion {
    /// Returns the duration.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.sequence.trajectory.duration()
    }
}

/// The outcome of a task, and how the search came to it.
#[derive(Debug, Clone)]
pub struct TaskAnswer {
    /// The motion that does all steps, or the step that fails for all IK solutions and orders. Failure is either
    /// proven, or means that no solution was found within the effort.
    pub outcome: Outcome<TaskMotion, FailedStep, FailedStep>,
    /// The steps in the order in which they are done: all, or those before the one that fails.
    pub legs: Vec<Leg>,
    /// Proven lower bound on the duration of any sequence of motions that does the whole task, from rest to rest at
    /// each step, seconds.
    pub lower_bound: f64,
    /// Number of motions that were planned, including those that the answer does not use.
    pub motions: usize,
    /// Nodes of the search that were expanded.
    pub expanded: usize,
}

impl TaskAnswer {
    /// Returns the step that fails, if one does.
    #[must_use]
    pub fn failed(&self) -> Option<&FailedStep> {
        match &self.outcome {
            Outcome::Found(_) => None,
            Outcome::Infeasible(failed) | Outcome::Unknown(failed) => Some(failed),
        }
    }

    /// Returns the lower bound on the duration of the task, limited to its actual duration.
    #[must_use]
    pub fn least_seconds(&self) -> f64 {
        // Without blocking obstacles, both are sums of the same times in different order.
        self.outcome.found().map_or(self.lower_bound, |motion| motion.seconds().min(self.lower_bound))
    }

    /// Returns the largest share by which the task may take longer than the fastest: `duration / lower_bound - 1`.
    /// `None` if not all steps are done, or if the bound is 0 and the duration is not.
    #[must_use]
    pub fn gap(&self) -> Option<f64> {
        let (seconds, least) = (self.outcome.found()?.seconds(), self.least_seconds());
        let gap = if seconds == least { 0.0 } else { seconds / least - 1.0 };
        gap.is_finite().then_some(gap)
    }

    /// Returns the seconds from the beginning to the end of the last step.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.legs.last().map_or(0.0, Leg::end)
    }

    /// Returns a proven lower bound on the distance to obstacles at all times, metres. Infinite if no obstacle is
    /// within reach.
    #[must_use]
    pub fn clearance(&self) -> f64 {
        self.legs.iter().map(Leg::clearance).fold(f64::INFINITY, f64::min)
    }
}
