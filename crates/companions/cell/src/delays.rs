//! Programs of both arms with signals: they keep apart for any delay of either program.

use crate::Cell;
use crate::between::Between;
use crate::curve::Curve;
use crate::judged::{Judgement, judge_legs};
use crate::stage::StagePairs;
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

/// Checks that two programs are safe for any delays. `targets` are the corners of the straight lines that each arm
/// follows. The arms keep the distance `clearance`, metres, at all pairs of places that the signals allow, and never wait for
/// each other forever.
///
/// # Errors
/// The reason, for people.
pub fn check_delays(
    cell: &Cell,
    targets: [&[Configuration]; 2],
    signals: &[SignalTargets],
    clearance: f64,
) -> Result<(), String> {
    check_progress(targets.map(|targets| targets.len().saturating_sub(1)), signals)?;
    let scenes = cell.arms.each_ref().map(|arm| arm.problem.scene());
    let pairs = StagePairs::single(Between::new(scenes, cell.is_one_robot, clearance));
    let curves = [0, 1].map(|arm| {
        let mut ends: Vec<usize> = signals.iter().map(|signal| signal.of(arm)).collect();
        ends.sort_unstable();
        Curve::of_targets(targets[arm], ends)
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
        let [one, two] = times.map(|time| time.floor() + 1.0);
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
