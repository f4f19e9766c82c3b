//! Orientations, over time, of payloads that the wrist turns.

use super::leg::{Event, Leg};
use cplan_handling::Task;
use cplan_motion::recorded::{turn_angle, turn_profile};

/// A turn of the wrist, on the clock of a task.
#[derive(Debug, Clone, PartialEq)]
pub struct TimedTurn {
    /// The index of the object in the task.
    pub object: usize,
    /// Times, in seconds, between which the object's orientation may differ from that in the scenes of the motions: from the
    /// grasp to the end of the turn, or from the beginning of the turn to the release.
    pub span: [f64; 2],
    /// Time at which the turn begins, in seconds.
    pub begin: f64,
    /// The object's orientations at both ends, in radians, without wrapping.
    pub ends: [f64; 2],
    /// Ends of phases of constant jerk: seconds since the beginning, angle so far and speed.
    pub phases: Vec<[f64; 3]>,
}

impl TimedTurn {
    /// Returns the turns of all steps, in chronological order.
    pub fn all(task: &Task, legs: &[Leg]) -> Vec<Self> {
        let turn = |leg: &Leg| {
            let ((turn, seconds), begin, wrist) = (leg.turn?, leg.turn_begins()?, task.wrist?);
            let (event, time) = (leg.event?, leg.event_time()?);
            let span = if matches!(event, Event::Grasp { .. }) { [time, begin + seconds] } else { [begin, time] };
            let phases = turn_profile(&wrist, (turn.to - turn.from).abs(), seconds);
            Some(Self { object: event.object(), span, begin, ends: [turn.from, turn.to], phases })
        };
        legs.iter().filter_map(turn).collect()
    }

    /// Returns the object's orientation at a time, in radians and seconds.
    pub fn angle(&self, time: f64) -> f64 {
        turn_angle(&self.phases, self.ends, time - self.begin)
    }

    /// Returns the orientation of an object at a time during one of these turns. `None` outside their spans.
    pub fn angle_of(turns: &[Self], object: usize, time: f64) -> Option<f64> {
        let turn = turns.iter().find(|turn| turn.object == object && turn.span[0] <= time && time <= turn.span[1])?;
        Some(turn.angle(time))
    }
}
