//! Strokes of the tool and turns of the wrist that overlap with a recorded motion.

use super::state::{State, lowering_seconds};
use super::{Fault, TIME_TOLERANCE};
use cplan_handling::{RecordedOverlap, RecordedStep, RecordedTurn, Recording, Task, Wrist};
use cplan_model::Scene;
use cplan_motion::recorded::{CollisionCheck, StrokeDuringMotion, TurnCover, TurnDuringMotion, seconds_to_rise};

/// A stroke that overlaps with a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PartialStroke {
    /// Depth of the lowered tool, metres.
    pub depth: f64,
    /// Duration of the overlap, seconds.
    pub overlap: f64,
}

/// The strokes and turns that overlap with a motion at its beginning and at its end.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Overlaps {
    pub raising: Option<PartialStroke>,
    pub lowering: Option<PartialStroke>,
    /// The turn of the previous step, which ends during this motion.
    pub turn_before: Option<RecordedTurn>,
    /// The turn of this step, which begins during its motion.
    pub turn_at_end: Option<RecordedTurn>,
}

impl Overlaps {
    /// Creates the overlaps of a step's motion. `raising` and `turn_before` overlap with its beginning. `depth` is the
    /// depth of the stroke at its end, in metres.
    pub fn new(
        (raising, turn_before): (Option<PartialStroke>, Option<RecordedTurn>),
        recorded: &RecordedStep,
        depth: Option<f64>,
    ) -> Self {
        let overlap = recorded.overlap.before_arrival;
        let lowering = depth.filter(|_| overlap > 0.0).map(|depth| PartialStroke { depth, overlap });
        let turn_at_end = recorded.turn.filter(|turn| turn.overlap.before_arrival > 0.0);
        Self { raising, lowering, turn_before, turn_at_end }
    }

    fn strokes(&self) -> impl Iterator<Item = PartialStroke> {
        self.raising.into_iter().chain(self.lowering)
    }

    fn turns(&self) -> impl Iterator<Item = RecordedTurn> {
        self.turn_before.into_iter().chain(self.turn_at_end)
    }

    /// Returns the faults of the overlaps: the world forbids them, the tool is lower than the world allows, or it is not
    /// raised and turned completely during the motion.
    pub fn faults(&self, task: &Task, seconds: f64) -> Vec<Fault> {
        let mut faults = Vec::new();
        let of = |stroke: Option<PartialStroke>| stroke.map_or(0.0, |stroke| stroke.overlap);
        let departure = self.turn_before.map_or(0.0, |turn| turn.overlap.after_departure).max(of(self.raising));
        let arrival = self.turn_at_end.map_or(0.0, |turn| turn.overlap.before_arrival).max(of(self.lowering));
        let shared = departure + arrival;
        if shared > seconds + TIME_TOLERANCE {
            faults.push(Fault::NotRaised { shared, seconds });
        }
        let may_turn = wrist_on_the_way(task).is_some();
        if self.turns().next().is_some() && !may_turn {
            faults.push(Fault::NoTurnOnTheWay);
        }
        let Some(arch) = task.stroke.as_ref().and_then(|stroke| stroke.arch) else {
            faults.extend(self.strokes().next().map(|_| Fault::NoArch));
            return faults;
        };
        for (stroke, height) in [(self.raising, arch.rise), (self.lowering, arch.fall)] {
            let (Some(PartialStroke { depth, overlap }), Some(tool)) = (stroke, &task.stroke) else { continue };
            let most = lowering_seconds(task, depth) - seconds_to_rise(tool, depth, height);
            if overlap > most + TIME_TOLERANCE {
                faults.push(Fault::TooLow { overlap, most: most.max(0.0) });
            }
        }
        faults
    }

    /// Returns the turns during a motion, each with the payload's covers. `None` if the wrist may not turn while the arm moves.
    fn turns_during<'a>(
        &self,
        task: &Task,
        cover: &'a TurnCover,
        [departure, arrival]: [f64; 2],
    ) -> Option<Vec<TurnDuringMotion<'a>>> {
        let wrist = wrist_on_the_way(task)?;
        let during = |RecordedTurn { from, to, seconds, overlap }: RecordedTurn, is_before_place: bool| {
            let begin = match is_before_place {
                true => arrival - overlap.before_arrival,
                false => departure + overlap.after_departure - seconds,
            };
            TurnDuringMotion { cover, wrist, ends: [from, to], seconds, begin, is_before_place }
        };
        let before = self.turn_before.map(|turn| during(turn, false));
        Some(before.into_iter().chain(self.turn_at_end.map(|turn| during(turn, true))).collect())
    }

    /// Checks the turns during a motion: the limits of the wrist, and collisions of the payload. Returns the worst collision
    /// check, with its scene. `None` if no turn overlaps. Bounds on the clearance are improved up to `sought`.
    pub fn check_turns(
        &self,
        task: &Task,
        scene: &Scene,
        motion: &Recording,
        (required, sought): (f64, f64),
        faults: &mut Vec<Fault>,
    ) -> Option<(Scene, CollisionCheck)> {
        self.turns().next()?;
        let times = motion.times()?;
        let cover = TurnCover::new(scene)?;
        let turns = self.turns_during(task, &cover, [times[0], times[times.len() - 1]])?;
        if turns.iter().any(|turn| !turn.keeps_limits(&task.arm, motion)) {
            faults.push(Fault::WristLimits);
        }
        let worse =
            |a: (Scene, CollisionCheck), b: (Scene, CollisionCheck)| if b.1.is_worse_than(&a.1) { b } else { a };
        turns.iter().map(|turn| turn.check(motion, required, sought)).reduce(worse)
    }

    /// Checks a motion during which the tool is raised or lowered. Returns the worst collision check, with its scene.
    /// `None` if nothing overlaps, or if the motion keeps `clearance` during the overlaps, too. `clearance` is that of
    /// the motion with the raised tool.
    pub fn check(
        &self,
        task: &Task,
        state: &State,
        motion: &Recording,
        picked: Option<usize>,
        clearance: f64,
    ) -> Option<(Scene, CollisionCheck)> {
        let tool = task.stroke.as_ref()?;
        let times = motion.times()?;
        let depths: Vec<f64> = self.strokes().map(|stroke| stroke.depth).collect();
        // The payload has another orientation before a turn that follows a pick, and after a turn that precedes a place.
        let scenes = [self.turn_before.map(|turn| turn.from), self.turn_at_end.map(|turn| turn.to)]
            .map(|angle| state.arch_scene(task, (tool, &depths), picked, angle));
        let during = |stroke: PartialStroke, is_raising: bool| {
            let lowered = tool.lowered(stroke.depth);
            let seconds = lowering_seconds(task, stroke.depth);
            let (ends, begin) = match is_raising {
                true => ([lowered, tool.joint.rest], times[0] + stroke.overlap - seconds),
                false => ([tool.joint.rest, lowered], times[times.len() - 1] - stroke.overlap),
            };
            let scene = &scenes[usize::from(!is_raising)];
            let stroke = StrokeDuringMotion { scene, stroke: tool, ends, begin };
            let keeps = clearance.is_finite() && stroke.keeps(motion, clearance);
            if keeps { None } else { stroke.check(motion) }
        };
        let of = |stroke: Option<PartialStroke>, is_raising| stroke.and_then(|stroke| during(stroke, is_raising));
        let checks = of(self.raising, true).into_iter().chain(of(self.lowering, false));
        let worse = |a: CollisionCheck, b: CollisionCheck| if b.is_worse_than(&a) { b } else { a };
        let mut check = checks.reduce(worse)?;
        // The moments of the check count its own samples, which are more than those of the recording.
        let number = |time: f64| times.partition_point(|sample| *sample <= time).saturating_sub(1);
        check.moments_mut().for_each(|moment| moment.sample = number(moment.time));
        let [scene, _] = scenes;
        Some((scene.swept, check))
    }
}

/// Returns the wrist, if it may turn objects while the arm moves.
fn wrist_on_the_way(task: &Task) -> Option<Wrist> {
    task.wrist.filter(|wrist| wrist.turns_on_the_way && !task.has_moving_obstacles())
}

/// Returns the faults of a step's turn that overlaps with a motion: that motion neither follows a pick nor precedes a
/// place, or the tool is not raised during the turn.
pub(super) fn turn_faults(recorded: &RecordedStep, is_pick: bool, is_place: bool) -> Vec<Fault> {
    let Some(RecordedTurn { seconds, overlap: turn, .. }) = recorded.turn else { return Vec::new() };
    let RecordedOverlap { before_arrival, after_departure } = recorded.overlap;
    let mut faults = Vec::new();
    if (turn.before_arrival > 0.0 && !is_place) || (turn.after_departure > 0.0 && !is_pick) {
        faults.push(Fault::TurnElsewhere);
    }
    let (stroke, turn) =
        if is_pick { (after_departure, turn.after_departure) } else { (before_arrival, turn.before_arrival) };
    if stroke > 0.0 && stroke > turn - seconds + TIME_TOLERANCE {
        faults.push(Fault::TurnsLowered);
    }
    faults
}

/// Returns the part of a turn during which the arm rests, seconds.
pub(super) fn turning_at_rest(turn: &RecordedTurn) -> f64 {
    (turn.seconds - turn.overlap.before_arrival.max(turn.overlap.after_departure)).max(0.0)
}
