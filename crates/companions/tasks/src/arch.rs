//! Arch motions: the tool is raised and turned while the arm already moves, and turned and lowered before the arm
//! arrives.
//!
//! The motion of the arm stays the same. Only the strokes and turns are shifted into it, as far as all of them are proven
//! free at the heights and angles of each moment. So the joints keep their limits, and a motion that needs the raised
//! tool waits for it.

use super::end_sequence::{End, EndSequence};
use super::state::{Candidate, State, turns_on_the_way};
use cplan_handling::{ArchScene, Payload, Recording, Task};
use cplan_legs::{Overlap, ToolStroke};
use cplan_model::Grip;
use cplan_motion::recorded::{TurnCover, WristTurn};
use cplan_motion::{TimedMotion, round_down};
use cplan_movers::recordings;
use std::cell::LazyCell;

/// Number of halvings in the search for the longest overlap. The overlap is then within a 64th of the stroke's
/// duration.
const HALVINGS: usize = 6;

/// Returns the overlap of strokes and turns with the motion to a candidate's target. `stroke` and `turn` are those at the
/// target; the turn is `None` unless it comes before the stroke.
pub(super) fn overlap(
    task: &Task,
    from: &State,
    candidate: &Candidate,
    motion: &TimedMotion,
    at_target: (Option<&ToolStroke>, Option<(WristTurn, f64)>),
) -> Overlap {
    let of = |with_turns| overlap_of(task, from, candidate, motion, at_target, with_turns);
    let turn = from.turning.or(at_target.1).filter(|_| turns_on_the_way(task));
    let Some((_, at_rest)) = turn else { return of(false) };
    // In a short motion, the other stroke alone may save more than the turn.
    let saved = |overlap: &Overlap| overlap.seconds() - overlap.turn_seconds.map_or(0.0, |seconds| seconds - at_rest);
    let [with, without] = [true, false].map(of);
    if saved(&without) > saved(&with) { without } else { with }
}

/// Returns the overlap of strokes with a motion, and of turns if `with_turns`. Otherwise the arm rests during turns.
fn overlap_of(
    task: &Task,
    from: &State,
    candidate: &Candidate,
    motion: &TimedMotion,
    (stroke, turn): (Option<&ToolStroke>, Option<(WristTurn, f64)>),
    with_turns: bool,
) -> Overlap {
    let arch = task.stroke.as_ref().filter(|tool| tool.arch.is_some());
    if arch.is_none() && !with_turns {
        return Overlap::NONE;
    }
    let may_rise = from.turning.is_none() || with_turns;
    let may_lower = stroke.is_some() && (turn.is_none() || with_turns);
    let depths = [from.rising.filter(|_| may_rise), candidate.depth(task).filter(|_| may_lower)]
        .map(|depth| depth.filter(|_| arch.is_some()));
    let turns = [from.turning, turn].map(|turn| turn.filter(|_| with_turns));
    if depths.iter().all(Option::is_none) && turns.iter().all(Option::is_none) {
        return Overlap::NONE;
    }
    let all_depths: Vec<f64> = depths.into_iter().flatten().collect();
    let touched = || from.released.into_iter().chain(candidate.step.action.picked());
    let scene = |payload: Option<&Payload>| {
        arch.map(|tool| task.arch_scene((tool, &all_depths), &from.poses, payload, touched()))
    };
    // The payload at an orientation that it does not have during the rest of the motion.
    let turned = |angle: f64| {
        let mut payload = from.held.clone()?;
        if let Grip::Level { angle: own, .. } = &mut payload.grip {
            *own = angle;
        }
        Some(payload)
    };
    let unturned = LazyCell::new(|| scene(from.held.as_ref()));
    let angles = [turns[0].map(|(turn, _)| turn.from), turns[1].map(|(turn, _)| turn.to)];
    let own_scenes: [Option<ArchScene>; 2] = [0, 1].map(|end| {
        depths[end]?;
        angles[end].and_then(|angle| scene(turned(angle).as_ref()))
    });
    let is_turned = turns.iter().any(Option::is_some);
    let cover =
        is_turned.then(|| TurnCover::new(&task.scene(&from.poses, &[], from.held.as_ref(), touched()))).flatten();
    let Some([cubic, quartic]) = recordings(&motion.trajectory) else { return Overlap::NONE };
    let sequence = |end: End| {
        let index = end as usize;
        let strokes = depths[index].zip(arch).and_then(|(depth, tool)| {
            let scene = if angles[index].is_some() { own_scenes[index].as_ref() } else { unturned.as_ref() };
            scene.map(|scene| (tool, scene, depth))
        });
        let turn = turns[index].zip(cover.as_ref()).map(|((turn, seconds), cover)| (turn, cover, seconds));
        EndSequence::new(task, end, motion.trajectory.duration(), strokes, turn)
    };
    let mut ends = [sequence(End::Departure), sequence(End::Arrival)];
    let mut overlaps = [0, 1].map(|end| {
        ends[end].stretch_turn(&cubic);
        longest_free(ends[end].longest(), |overlap| ends[end].is_free(overlap, &cubic))
    });
    let excess = overlaps[0] + overlaps[1] - motion.trajectory.duration();
    if excess > 0.0 {
        // The sequence after the departure is complete before that at the arrival begins.
        let [departure, arrival] = overlaps;
        let most = round_down(departure - excess * departure / (departure + arrival)).max(0.0);
        overlaps[0] = longest_free(most, |overlap| ends[0].is_free(overlap, &cubic));
        let most = round_down(motion.trajectory.duration() - overlaps[0]).min(arrival);
        overlaps[1] = longest_free(most, |overlap| ends[1].is_free(overlap, &cubic));
    }
    let mut clearance = f64::INFINITY;
    for (end, overlap) in ends.iter().zip(&mut overlaps) {
        match end.clearance(*overlap, motion, &[&cubic, &quartic]).filter(|_| end.saves(*overlap)) {
            Some(found) => clearance = clearance.min(found),
            None => *overlap = 0.0,
        }
    }
    let [departure, arrival] = overlaps;
    let turn_of = |end: usize| Some(ends[end].turn_seconds()?).filter(|_| overlaps[end] > 0.0);
    Overlap {
        raising: ends[0].of_stroke(departure),
        lowering: ends[1].of_stroke(arrival),
        turn_after_departure: turn_of(0).map_or(0.0, |_| departure),
        turn_before_arrival: turn_of(1).map_or(0.0, |_| arrival),
        turn_seconds: turn_of(0).or(turn_of(1)),
        clearance,
    }
}

/// Returns the longest overlap up to `most` seconds that is free, within the accuracy of [`HALVINGS`].
pub(super) fn longest_free(most: f64, is_free: impl Fn(f64) -> bool) -> f64 {
    if most <= 0.0 || is_free(most) {
        return most.max(0.0);
    }
    let (mut free, mut blocked) = (0.0, most);
    for _ in 0..HALVINGS {
        let middle = round_down((free + blocked) / 2.0);
        if is_free(middle) { free = middle } else { blocked = middle }
    }
    free
}

/// Returns a proven lower bound, in metres, on the distance to obstacles in the part of a motion that `keeps` and
/// `exactly` examine, for both interpolations of the motion. `None` if it is not proven free. `keeps` is true if a
/// distance is quickly proven; `exactly` finds the bound.
pub(super) fn clearance_of_both(
    motion: &TimedMotion,
    [cubic, quartic]: &[&Recording; 2],
    keeps: impl Fn(&Recording, f64) -> bool,
    exactly: impl Fn(&Recording) -> Option<f64>,
) -> Option<f64> {
    // Usually the strokes keep as far from obstacles as the raised tool, which is quick to prove.
    let of_motion = motion.curve.clearance();
    let clearance = |recording: &Recording| {
        if of_motion.is_finite() && keeps(recording, of_motion) {
            return Some(of_motion);
        }
        exactly(recording)
    };
    // Along straight lines, both interpolations are the same motion.
    let is_curved = motion.curve.curve().is_curved();
    let of_cubic = clearance(cubic)?;
    if is_curved { Some(of_cubic.min(clearance(quartic)?)) } else { Some(of_cubic) }
}
