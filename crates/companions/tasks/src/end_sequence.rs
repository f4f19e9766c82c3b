//! The stroke and the turn at one end of a motion, and the part of them that overlaps with it.

use super::arch::{clearance_of_both, longest_free};
use super::stroke::stroke_seconds;
use cplan_handling::{ArchScene, Recording, Stroke, Task, Wrist};
use cplan_motion::recorded::{StrokeDuringMotion, TurnCover, TurnDuringMotion, WristTurn, seconds_to_rise};
use cplan_motion::{TimedMotion, round_down};

/// Factors by which the duration of a turn may be stretched, so that the wrist can also compensate the rotation of link 2
/// meanwhile. A turn that is stretched by `s` needs the `s`-th part of the speed, and the `s^2`-th of the acceleration.
const STRETCHES: [f64; 5] = [1.0, 1.1, 1.25, 1.5, 2.0];

/// An end of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum End {
    /// The tool is raised, and then the payload is turned.
    Departure,
    /// The payload is turned, and then the tool is lowered.
    Arrival,
}

/// A turn that may overlap with a motion.
struct Turn<'a> {
    turn: WristTurn,
    cover: &'a TurnCover,
    wrist: Wrist,
    /// Duration at rest, in seconds.
    at_rest: f64,
    /// Duration, in seconds.
    seconds: f64,
}

/// The stroke and the turn at one end of a motion. All overlaps are the time that both together share with the motion, in
/// seconds.
pub(super) struct EndSequence<'a> {
    task: &'a Task,
    end: End,
    /// Duration of the motion, in seconds.
    seconds: f64,
    /// The stroke, the scenes during it, and the depth from or to which it leads.
    stroke: Option<(&'a Stroke, &'a ArchScene, f64)>,
    turn: Option<Turn<'a>>,
}

impl<'a> EndSequence<'a> {
    /// Creates the sequence of a stroke and a turn that may overlap with a motion. A turn comes with its duration at
    /// rest, in seconds. `seconds` is the duration of the motion.
    pub fn new(
        task: &'a Task,
        end: End,
        seconds: f64,
        stroke: Option<(&'a Stroke, &'a ArchScene, f64)>,
        turn: Option<(WristTurn, &'a TurnCover, f64)>,
    ) -> Self {
        let turn = turn.zip(task.wrist).map(|((turn, cover, at_rest), wrist)| Turn {
            turn,
            cover,
            wrist,
            at_rest,
            seconds: at_rest,
        });
        Self { task, end, seconds, stroke, turn }
    }

    /// Returns the duration of the turn, in seconds. `None` without a turn.
    pub fn turn_seconds(&self) -> Option<f64> {
        self.turn.as_ref().map(|turn| turn.seconds)
    }

    /// Returns the part of an overlap that belongs to the stroke.
    pub fn of_stroke(&self, overlap: f64) -> f64 {
        let turning = self.turn_seconds().unwrap_or(0.0);
        if self.stroke.is_some() { (overlap - turning).max(0.0) } else { 0.0 }
    }

    /// Returns true if an overlap saves time. A stretched turn takes longer than at rest.
    pub fn saves(&self, overlap: f64) -> bool {
        overlap > self.turn.as_ref().map_or(0.0, |turn| turn.seconds - turn.at_rest)
    }

    /// Returns the longest overlap at a height that the world allows.
    pub fn longest(&self) -> f64 {
        let of_stroke = self.stroke.and_then(|(stroke, _, depth)| {
            let arch = stroke.arch?;
            let least = if self.end == End::Departure { arch.rise } else { arch.fall };
            Some((stroke_seconds(stroke, depth) - seconds_to_rise(stroke, depth, least)).max(0.0))
        });
        round_down((of_stroke.unwrap_or(0.0) + self.turn_seconds().unwrap_or(0.0)).min(self.seconds))
    }

    /// Chooses the duration of the turn, by which the most time could be saved within the limits of the wrist.
    pub fn stretch_turn(&mut self, motion: &Recording) {
        let Some(Turn { at_rest, .. }) = self.turn else { return };
        let mut best = (0.0, at_rest);
        for stretch in STRETCHES {
            let seconds = round_down(at_rest * stretch);
            self.turn.iter_mut().for_each(|turn| turn.seconds = seconds);
            // No overlap can save more than the shortest turn would.
            let most = self.longest();
            if most - (seconds - at_rest) <= best.0 {
                continue;
            }
            let saved = longest_free(most, |overlap| self.keeps_limits(overlap, motion)) - (seconds - at_rest);
            if saved > best.0 {
                best = (saved, seconds);
            }
        }
        self.turn.iter_mut().for_each(|turn| turn.seconds = best.1);
    }

    /// Returns the stroke, if a part of it is in the motion.
    fn stroke_during(&self, overlap: f64) -> Option<StrokeDuringMotion<'a>> {
        let overlap = self.of_stroke(overlap);
        let (stroke, scene, depth) = self.stroke.filter(|_| overlap > 0.0)?;
        let ends = [stroke.lowered(depth), stroke.joint.rest];
        Some(match self.end {
            End::Departure => {
                StrokeDuringMotion { scene, stroke, ends, begin: overlap - stroke_seconds(stroke, depth) }
            }
            End::Arrival => {
                StrokeDuringMotion { scene, stroke, ends: [ends[1], ends[0]], begin: self.seconds - overlap }
            }
        })
    }

    /// Returns the turn, if a part of it is in the motion.
    fn turn_during(&self, overlap: f64) -> Option<TurnDuringMotion<'a>> {
        let Turn { turn, cover, wrist, seconds, .. } = self.turn.as_ref().filter(|_| overlap > 0.0)?;
        let (cover, wrist, seconds) = (*cover, *wrist, *seconds);
        let (begin, is_before_place) = match self.end {
            End::Departure => (overlap - seconds, false),
            End::Arrival => (self.seconds - overlap, true),
        };
        Some(TurnDuringMotion { cover, wrist, ends: [turn.from, turn.to], seconds, begin, is_before_place })
    }

    /// Returns true if the wrist keeps its limits during the part of the turn in the motion.
    fn keeps_limits(&self, overlap: f64, motion: &Recording) -> bool {
        self.turn_during(overlap).is_none_or(|turn| turn.keeps_limits(&self.task.arm, motion))
    }

    /// Returns true if an overlap is quickly proven free of collisions, and within the limits of the wrist.
    pub fn is_free(&self, overlap: f64, motion: &Recording) -> bool {
        let required = self.task.workspace.fixed.clearance;
        self.keeps_limits(overlap, motion)
            && self.turn_during(overlap).is_none_or(|turn| turn.keeps(motion, required))
            && self.stroke_during(overlap).is_none_or(|stroke| stroke.keeps(motion, required))
    }

    /// Returns a proven lower bound on the distance to obstacles during an overlap, in metres, for both interpolations
    /// of the motion. Infinite if no obstacle is within reach. `None` if a collision or a limit of the wrist is not ruled
    /// out.
    pub fn clearance(&self, overlap: f64, motion: &TimedMotion, recordings: &[&Recording; 2]) -> Option<f64> {
        if !recordings.iter().all(|recording| self.keeps_limits(overlap, recording)) {
            return None;
        }
        let of_stroke = match self.stroke_during(overlap) {
            None => f64::INFINITY,
            Some(stroke) => clearance_of_both(
                motion,
                recordings,
                |recording, clearance| stroke.keeps(recording, clearance),
                |recording| stroke.check(recording).map_or(Some(f64::INFINITY), |check| check.clearance()),
            )?,
        };
        let (required, of_motion) = (self.task.workspace.fixed.clearance, motion.curve.clearance());
        let of_turn = match self.turn_during(overlap) {
            None => f64::INFINITY,
            Some(turn) => clearance_of_both(
                motion,
                recordings,
                |_, _| false,
                |recording| turn.clearance(recording, required, of_motion),
            )?,
        };
        Some(of_stroke.min(of_turn))
    }
}
