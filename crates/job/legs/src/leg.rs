//! The arm's actions for one step of a task.

use super::tool::{Overlap, ToolStroke, WristMotion};
use cplan_geometry::Pose;
use cplan_handling::Step;
use cplan_model::Scene;
use cplan_model::space::Path;
use cplan_motion::TimedMotion;
use cplan_motion::recorded::WristTurn;
use std::sync::Arc;

/// An event at the end of a step's motion, while the tool is lowered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Event {
    /// The gripper grasps an object.
    Grasp {
        /// The index of the object in the task.
        object: usize,
    },
    /// The gripper releases an object.
    Release {
        /// The index of the object in the task.
        object: usize,
        /// Pose of the object from then on.
        pose: Pose,
    },
}

impl Event {
    /// Returns the object that is grasped or released.
    pub fn object(&self) -> usize {
        match *self {
            Event::Grasp { object } | Event::Release { object, .. } => object,
        }
    }
}

/// The arm's actions for one step: a motion from rest to rest, a turn of the wrist or an event if the step needs them,
/// and a rest.
///
/// - Pick: motion, stroke down, grasp, dwell, stroke up, turn.
/// - Place: motion, turn, stroke down, release, dwell, stroke up.
/// - Move: stroke up if the tool is lowered, motion, stroke down if the step asks for it, dwell.
///
/// A turn or a stroke down may begin before the motion ends, and the next motion may begin before a stroke up or a turn
/// ends: see [`Overlap`].
#[derive(Debug, Clone, PartialEq)]
pub struct Leg {
    /// The step.
    pub step: Step,
    /// The world during the motion, with the payload.
    pub scene: Arc<Scene>,
    /// The indices of the objects that still move by themselves ([`cplan_handling::Task::trajectories`]).
    pub moving: Arc<[usize]>,
    /// The object that is carried during the motion. `None` if the gripper is empty.
    pub carried: Option<usize>,
    /// The motion. Its times count from its own beginning.
    pub timed: Arc<TimedMotion>,
    /// Turn of the wrist, and its duration in seconds.
    pub turn: Option<(WristTurn, f64)>,
    /// Raising of the tool before the motion. `None` unless the tool is lowered where the task or the step before ends.
    pub raising: Option<ToolStroke>,
    /// Lowering of the tool, and raising after an event. `None` if the tool stays raised.
    pub stroke: Option<ToolStroke>,
    /// The turn of the wrist to the value of its joint that the step states.
    pub wrist: Option<WristMotion>,
    /// The parts of the motion during which the tool is raised or turned after the step before, or turned or lowered for
    /// this step.
    pub overlap: Overlap,
    /// Proven upper bound on the distance between the tip's path and the line, in metres, if the step follows one.
    pub deviation: Option<f64>,
    /// Proven upper bound on the difference between the tool's angle and the angle that the line asks for, in radians.
    /// `None` if the step follows no such line.
    pub tool_deviation: Option<f64>,
    /// The event while the tool is lowered.
    pub event: Option<Event>,
    /// Time from the beginning of the task to the beginning of the motion, in seconds.
    pub begin: f64,
}

impl Leg {
    /// Returns the path of the motion, before its corners are rounded.
    pub fn path(&self) -> &Path {
        self.timed.curve.curve().path()
    }

    /// Returns the time from the beginning of the task to the end of the motion, in seconds.
    pub fn arrival(&self) -> f64 {
        self.begin + self.timed.trajectory.duration()
    }

    /// Returns the time from the end of the motion to the end of the step, when the tool is raised and turned, in
    /// seconds. The next motion may begin earlier: see [`Overlap::departure`].
    pub fn rest(&self) -> f64 {
        let strokes = if self.event.is_some() { 2.0 } else { 1.0 };
        let waiting = self.wrist.map_or(0.0, |wrist| wrist.waiting);
        self.step.dwell + self.turning() + strokes * self.lowering() - self.overlap.arrival() + waiting
    }

    /// Returns the time from the beginning of the task at which the wrist begins to turn, in seconds. `None` if it does
    /// not turn.
    pub fn turn_begins(&self) -> Option<f64> {
        let (_, seconds) = self.turn?;
        let is_before = matches!(self.event, Some(Event::Release { .. }));
        Some(if is_before { self.arrival() - self.overlap.arrival() } else { self.end() - seconds })
    }

    /// Returns how long the wrist turns, in seconds.
    pub fn turning(&self) -> f64 {
        self.turn.map_or(0.0, |(_, seconds)| seconds)
    }

    /// Returns the strokes of the step in chronological order: for each, the time from the beginning of the task at which it
    /// begins, in seconds, and the joint's values at both ends, in metres.
    pub fn strokes(&self) -> Vec<(f64, [f64; 2])> {
        let mut strokes = Vec::new();
        if let Some(ToolStroke { raised, lowered, seconds, .. }) = self.raising {
            strokes.push((self.begin + self.overlap.raising - seconds, [lowered, raised]));
        }
        if let Some(ToolStroke { raised, lowered, seconds, .. }) = self.stroke {
            let turned = if matches!(self.event, Some(Event::Release { .. })) { self.turning() } else { 0.0 };
            let begin = self.arrival() + turned - self.overlap.arrival();
            strokes.push((begin, [raised, lowered]));
            if self.event.is_some() {
                strokes.push((begin + seconds + self.step.dwell, [lowered, raised]));
            }
        }
        strokes
    }

    /// Returns the time from the beginning of the raising to the beginning of the motion after it, in seconds. 0 if the
    /// tool is raised, or if it is raised while the arm already moves.
    pub fn raising_at_rest(&self) -> f64 {
        self.raising.map_or(0.0, |raising| raising.seconds - self.overlap.raising)
    }

    /// Returns how long the tool takes to go down, in seconds. It takes as long to go up.
    pub fn lowering(&self) -> f64 {
        self.stroke.map_or(0.0, |stroke| stroke.seconds)
    }

    /// Returns the time from the end of the motion to the grasp or release, in seconds. `None` if there is neither.
    pub fn event_after(&self) -> Option<f64> {
        match self.event? {
            Event::Grasp { .. } => Some(self.lowering() - self.overlap.arrival()),
            Event::Release { .. } => Some(self.turning() + self.lowering() - self.overlap.arrival()),
        }
    }

    /// Returns the time from the beginning of the task to the grasp or release, in seconds. `None` if there is neither.
    pub fn event_time(&self) -> Option<f64> {
        self.event_after().map(|after| self.arrival() + after)
    }

    /// Returns the time from the beginning of the task to the end of the step, in seconds.
    pub fn end(&self) -> f64 {
        self.arrival() + self.rest()
    }

    /// Returns a proven lower bound on the distance to obstacles during the motion, the turn and the stroke, in metres.
    /// Infinite if no obstacle is within reach.
    pub fn clearance(&self) -> f64 {
        let turn = self.turn.map_or(f64::INFINITY, |(turn, _)| turn.clearance);
        let stroke =
            self.stroke.iter().chain(&self.raising).map(|stroke| stroke.clearance).fold(f64::INFINITY, f64::min);
        turn.min(stroke).min(self.overlap.clearance).min(self.timed.curve.clearance())
    }
}
