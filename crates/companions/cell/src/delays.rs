//! Programs of both arms with signals: they keep apart for any delay of either program.

use crate::Cell;
use crate::between::Between;
use crate::coordinate::PlannedSteps;
use crate::curve::Curve;
use crate::judged::{Judgement, judge_legs};
use crate::legs::Legs;
use crate::sequence::Sequence;
use crate::stage::{Stage, StagePairs, StageTime};
use cplan_model::space::Configuration;

/// A signal between two programs of joint moves. Targets are numbered from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SignalTargets {
    /// The arm that waits, 0 or 1. The other arm sets the signal.
    pub waits: usize,
    /// The target at which it waits.
    pub at: usize,
    /// The target of the other arm at which that arm sets the signal.
    pub set: usize,
}

impl SignalTargets {
    /// Returns the target of an arm at which it uses the signal.
    pub fn of(&self, arm: usize) -> usize {
        if arm == self.waits { self.at } else { self.set }
    }
}

/// The part of a step to which a move of a program belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StepPart {
    /// The tool is raised before the arm moves.
    Raising,
    /// The arm moves.
    Motion,
    /// The arm rests while the tool acts.
    Acts,
}

/// The steps of two programs.
#[derive(Debug, Clone, Copy)]
pub struct ProgramSteps<'a> {
    /// The planned steps of each arm.
    pub planned: &'a [PlannedSteps; 2],
    /// For each arm and each target except the first, the index of the step and its part in which the arm moves there.
    pub parts: [&'a [(usize, StepPart)]; 2],
    /// Distance by which the heights of each arm's tool may deviate, metres.
    pub height_tolerance: f64,
}

/// The straight lines of one program. Line `k` begins at target `k`.
struct Lines {
    stages: Vec<Stage>,
    /// The stage of each line. The last one is the rest after the program.
    of_line: Vec<usize>,
}

impl Lines {
    /// Returns the target at which a stage begins or ends.
    fn target(&self, time: StageTime) -> Option<usize> {
        match time {
            StageTime::Begin(stage) => self.of_line.iter().position(|known| *known == stage),
            StageTime::End(stage) => self.of_line.iter().rposition(|known| *known == stage).map(|line| line + 1),
        }
    }
}

/// Returns the lines of both programs, and the handovers, each as the signal that suffices for it.
fn lines(cell: &Cell, steps: Option<ProgramSteps>, counts: [usize; 2]) -> Option<([Lines; 2], Vec<SignalTargets>)> {
    let Some(ProgramSteps { planned, parts, height_tolerance }) = steps else {
        let of = |arm: usize| {
            let stages = vec![Stage { bodies: Between::links(cell.arms[arm].problem.scene()), ..Stage::default() }];
            Lines { stages, of_line: vec![0; counts[arm] + 1] }
        };
        return Some(([of(0), of(1)], Vec::new()));
    };
    let sequence = |arm: usize| {
        let PlannedSteps { task, legs } = &planned[arm];
        Sequence::with_height_tolerance(task, legs, height_tolerance)
    };
    let both = [sequence(0)?, sequence(1)?];
    let [one, two] = [0, 1].map(|arm| {
        let Legs { legs, steps } = &both[arm].legs;
        let stage = |(step, part): &(usize, StepPart)| {
            let step = steps.get(*step)?;
            match part {
                StepPart::Raising => step.raises,
                StepPart::Motion => Some(step.moves),
                StepPart::Acts => step.acts,
            }
        };
        let last = legs.last().map(|leg| leg.stage);
        let of_line = parts[arm].iter().map(stage).chain([last]).collect::<Option<_>>()?;
        Some(Lines { stages: both[arm].stages.clone(), of_line })
    });
    let lines = [one?, two?];
    let precedences = Sequence::precedences(both.each_ref(), planned.each_ref().map(|own| &own.task));
    let handovers = precedences.iter().map(|precedence| {
        let (giver, taker) = (precedence.giver, 1 - precedence.giver);
        let (set, at) = (lines[giver].target(precedence.placed)?, lines[taker].target(precedence.taken)?);
        Some(SignalTargets { waits: taker, at, set })
    });
    let handovers = handovers.collect::<Option<Vec<_>>>()?;
    Some((lines, handovers))
}

/// Checks that two programs are safe for any delays. `targets` are the corners of the straight lines that each arm
/// follows, and `steps` are those of the programs, if the cell has steps. The arms keep the distance `clearance`, metres, at
/// all pairs of places that the signals allow, take objects only after they have been placed, and never wait for each other
/// forever.
///
/// # Errors
/// The reason, for people.
pub fn check_delays(
    cell: &Cell,
    targets: [&[Configuration]; 2],
    signals: &[SignalTargets],
    clearance: f64,
    steps: Option<ProgramSteps>,
) -> Result<(), String> {
    let counts = targets.map(|targets| targets.len().saturating_sub(1));
    check_progress(counts, signals)?;
    let scenes = cell.arms.each_ref().map(|arm| arm.problem.scene());
    let (lines, handovers) = lines(cell, steps, counts).ok_or("the steps of the programs are not those of the plan")?;
    for handover in &handovers {
        let is_enough = |signal: &SignalTargets| {
            signal.waits == handover.waits && signal.at <= handover.at && signal.set >= handover.set
        };
        if !signals.iter().any(is_enough) {
            let names = cell.arms.each_ref().map(|arm| &arm.name);
            let [takes, gives] = [handover.waits, 1 - handover.waits].map(|arm| names[arm]);
            let [at, set] = [handover.at, handover.set].map(|target| target + 1);
            return Err(format!(
                "no signal keeps {takes} from taking an object after target {at} before {gives} has placed it at target {set}"
            ));
        }
    }
    let stages = lines.each_ref().map(|lines| &lines.stages[..]);
    let pairs = StagePairs::new(scenes, stages, cell.is_one_robot, clearance, Vec::new());
    let curves = [0, 1].map(|arm| {
        let Lines { of_line, .. } = &lines[arm];
        let changes = (1..of_line.len()).filter(|line| of_line[*line] != of_line[line - 1]);
        let mut ends: Vec<usize> = signals.iter().map(|signal| signal.of(arm)).chain(changes).collect();
        ends.sort_unstable();
        let targets: Vec<Configuration> = targets[arm].iter().chain(targets[arm].last()).copied().collect();
        Curve::of_targets(&targets, ends).with_stages_of(|line| of_line[line])
    });
    // A signal keeps the waiting arm before its target while the other arm is before the target that sets the signal.
    let is_excluded = |times: [[f64; 2]; 2]| {
        let excludes = |signal: &SignalTargets| {
            let [waits, sets] = [signal.waits, 1 - signal.waits].map(|arm| times[arm]);
            waits[0] >= signal.at as f64 && sets[1] <= signal.set as f64
        };
        signals.iter().any(excludes)
    };
    let legs = (0..curves[0].legs()).flat_map(|one| (0..curves[1].legs()).map(move |two| [one, two]));
    let times = |legs: [usize; 2]| [0, 1].map(|arm| curves[arm].times(curves[arm].leg(legs[arm])));
    let open = legs.filter(|legs| !is_excluded(times(*legs)));
    let place = |times: [f64; 2]| {
        let names = cell.arms.each_ref().map(|arm| &arm.name);
        let [one, two] = [0, 1].map(|arm| (times[arm].floor() as usize).min(counts[arm]) + 1);
        format!("{} after target {one}, and {} after target {two}", names[0], names[1])
    };
    match judge_legs(&pairs, &curves, f64::INFINITY, open, None) {
        Judgement::Apart { .. } => Ok(()),
        Judgement::TooClose(nearest) => {
            Err(format!("the arms may be too near to each other: {}", place(nearest.times)))
        }
        Judgement::Undecided => Err("the arms are not proven to keep apart for all delays".into()),
    }
}

/// Checks that both programs end, whichever is late. `last` has the last target of each arm.
fn check_progress(last: [usize; 2], signals: &[SignalTargets]) -> Result<(), String> {
    let mut reached = [0; 2];
    while reached != last {
        let next = [0, 1].map(|arm| {
            let waits = signals.iter().filter(|signal| signal.waits == arm && reached[1 - arm] < signal.set);
            waits.map(|signal| signal.at).fold(last[arm], usize::min)
        });
        if next == reached {
            return Err("the programs wait for each other forever".into());
        }
        reached = next;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_that_wait_for_each_other_do_not_end() {
        let first = SignalTargets { waits: 0, at: 1, set: 2 };
        assert!(check_progress([3, 3], &[first, SignalTargets { waits: 1, at: 2, set: 3 }]).is_ok());
        assert!(check_progress([3, 3], &[first, SignalTargets { waits: 1, at: 1, set: 2 }]).is_err());
        assert!(check_progress([0, 0], &[]).is_ok());
    }
}
