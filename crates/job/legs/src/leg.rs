//! The arm's actions for one step of a task.

use super::tool::{Overlap, ToolStroke, WristMotion};
use cplan_geometry::Pose;
use cplan_handling::Step;
use cplan_model::Scene;
use cplan_model::space::Path;
use cplan_motion::TimedMotion;
use cplan_motion::recorded::WristTurn;
use std::sync::Arc;

/// An event at the end of a step's motion, with the tool lowered.
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

/// The arm's actions for one step: a motion from rest to rest, if necessary a turn of the wrist or an event, and a rest.
///
/// - Pick: motion, stroke down, grasp, dwell, stroke up, turn.
/// - Place: motion, turn, stroke down, release, dwell, stroke up.
/// - Move: stroke up if the tool is lowered, motion, stroke down if the step asks for it, dwell.
///
/// A turn or a stroke down may begin before the motion ends, and the next motion may begin before a stroke up or a turn ends. See
/// [`Overlap`].
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
    /// Stroke up before the motion. `None` unless the tool is lowered where the task begins or the previous step ends.
    pub raising: Option<ToolStroke>,
    /// Stroke down, and stroke up after an event. `None` if the tool stays raised.
    pub stroke: Option<ToolStroke>,
    /// Turn of the wrist to the joint value that the step states.
    pub wrist: Option<WristMotion>,
    /// The overlaps of the motion with the stroke up or the turn after the previous step, and with the turn or the stroke down of
    /// this step.
    pub overlap: Overlap,
    /// Proven upper bound on the distance between the tip's path and the line, in metres, if the step follows one.
    pub deviation: Option<f64>,
    /// Proven upper bound on the difference between the tool's angle and the angle that the line requires, in radians. `None` if
    /// the step follows no line with an angle.
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

    /// Returns the time, in seconds, from the end of the motion to the end of the step, when the tool is raised and turned. The
    /// next motion may begin earlier: see [`Overlap::departure`].
    pub fn rest(&self) -> f64 {
        let strokes = if self.event.is_some() { 2.0 } else { 1.0 };
        let waiting = self.wrist.map_or(0.0, |wrist| wrist.waiting);
        self.step.dwell + self.turning() + strokes * self.lowering() - self.overlap.arrival() + waiting
    }

    /// Returns the time from the beginning of the task to the beginning of the wrist's turn, in seconds. `None` without a turn.
    pub fn turn_begins(&self) -> Option<f64> {
        let (_, seconds) = self.turn?;
        let is_before = matches!(self.event, Some(Event::Release { .. }));
        Some(if is_before { self.arrival() - self.overlap.arrival() } else { self.end() - seconds })
    }

    /// Returns the duration of the wrist's turn, in seconds.
    pub fn turning(&self) -> f64 {
        self.turn.map_or(0.0, |(_, seconds)| seconds)
    }

    /// Returns the strokes of the step in chronological order. Each has its beginning, in seconds from the beginning of the task,
    /// and the joint's values at both ends, in metres.
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

    /// Returns the time from the beginning of the stroke up to the beginning of the motion after it, in seconds; 0 if there is no
    /// such stroke, or if it happens while the arm moves.
    pub fn raising_at_rest(&self) -> f64 {
        self.raising.map_or(0.0, |raising| raising.seconds - self.overlap.raising)
    }

    /// Returns the duration of the stroke down, in seconds. The stroke up takes as long.
    pub fn lowering(&self) -> f64 {
        self.stroke.map_or(0.0, |stroke| stroke.seconds)
    }

    /// Returns the time from the end of the motion to the grasp or release, in seconds. `None` without an event.
    pub fn event_after(&self) -> Option<f64> {
        match self.event? {
            Event::Grasp { .. } => Some(self.lowering() - self.overlap.arrival()),
            Event::Release { .. } => Some(self.turning() + self.lowering() - self.overlap.arrival()),
        }
    }

    /// Returns the time from the beginning of the task to the grasp or release, in seconds. `None` without an event.
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
