//! Proofs that no timing along a path avoids the moving obstacles.

use super::blocked::{MovingObstacles, PartDeviation, complement};
use cplan_geometry::{Interval, OrderedF64, merge_in_place};
use cplan_interrupt::checkpoint;
use cplan_judge::{Deviation, Posture};
use cplan_model::Arm;
use cplan_model::space::{Configuration, Path};
use std::cell::OnceCell;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// Least number of stretches into which a path is cut.
const MIN_STRETCHES: usize = 64;

/// Accuracy of the times of overlap, in seconds.
const OVERLAP_TIME_STEP: f64 = 1e-3;

/// Relative reduction of the least duration of a stretch. It covers rounding errors.
const ROUNDING: f64 = 1e-9;

struct Stretch {
    /// The middle of the stretch, and half of its extent.
    middle: Configuration,
    half: Configuration,
    /// Lower bound on the duration of a motion from one end of the stretch to the other, seconds.
    takes: f64,
    /// Times at which the arm may be in the stretch. Computed when first needed. At all other times, every posture of
    /// the stretch overlaps a moving obstacle.
    left: OnceCell<Vec<Interval>>,
}

impl Stretch {
    fn remaining_times(&self, movers: &MovingObstacles) -> &[Interval] {
        self.left.get_or_init(|| {
            let posture = Posture::new(movers.scene(), self.middle);
            let (mut met, mut known) = (Vec::new(), None);
            for &meeting in &movers.meetings {
                let around = PartDeviation::of(&mut known, movers, &posture, Deviation::Along(self.half), meeting);
                movers.collision_times(around, meeting, OVERLAP_TIME_STEP, &mut met);
            }
            merge_in_place(&mut met);
            complement(&met)
        })
    }
}

/// Returns true if it is proven that no motion along a path reaches its end while keeping the clearance from moving
/// obstacles. The motion may go forwards and backwards, at any speed that the joints allow.
///
/// Each stretch of the path is blocked while all its postures overlap a moving obstacle, more deeply than the arm moves
/// within the stretch. A search over position and time begins at the start of the path at time 0. From a stretch, it
/// enters the neighbouring stretches at times when neither is blocked, at no more than the top speeds of the joints.
/// Blocked times are computed only for the stretches that the search reaches.
pub fn has_no_timing(movers: &MovingObstacles, path: &Path) -> bool {
    let stretches = stretches(path, movers.scene().arm());
    let Some(first) = stretches.first() else { return false };
    if first.remaining_times(movers).first().is_none_or(|left| left[0] > 0.0) {
        return true;
    }
    // Earliest time at which each end (0 or 1) of a stretch can be reached, in each of its open intervals.
    let mut known: BTreeMap<(usize, usize, usize), f64> = BTreeMap::new();
    let mut open = BinaryHeap::from([Reverse((OrderedF64(0.0), 0, 0, 0))]);
    known.insert((0, 0, 0), 0.0);
    while let Some(Reverse((OrderedF64(time), stretch, gap, end))) = open.pop() {
        checkpoint();
        if known[&(stretch, gap, end)] < time {
            continue;
        }
        if stretch + 1 == stretches.len() && end == 1 {
            return false;
        }
        let takes = stretches[stretch].takes;
        let until = stretches[stretch].remaining_times(movers)[gap][1];
        let mut reach = |stretch: usize, gap: usize, end: usize, time: f64| {
            if known.get(&(stretch, gap, end)).is_none_or(|known| time < *known) {
                known.insert((stretch, gap, end), time);
                open.push(Reverse((OrderedF64(time), stretch, gap, end)));
            }
        };
        if time + takes <= until {
            reach(stretch, gap, 1 - end, time + takes);
        }
        let beyond = if end == 1 { stretch + 1 } else { stretch.wrapping_sub(1) };
        for (other, &[begins, ends]) in
            stretches.get(beyond).iter().flat_map(|next| next.remaining_times(movers).iter().enumerate())
        {
            let at = time.max(begins);
            if at <= until.min(ends) {
                reach(beyond, other, 1 - end, at);
            }
        }
    }
    true
}

fn stretches(path: &Path, arm: &Arm) -> Vec<Stretch> {
    let length = path.length();
    let speeds = arm.joints.each_ref().map(|joint| joint.velocity);
    let mut stretches = Vec::new();
    for (a, b) in path.segments() {
        let parts = ((b - a).norm() / length * MIN_STRETCHES as f64).ceil().max(1.0) as usize;
        for part in 0..parts {
            let at = |k: usize| a + (b - a) * (k as f64 / parts as f64);
            let half: Configuration = (at(part + 1) - at(part)) / 2.0;
            let takes = (0..2).map(|k| 2.0 * half[k].abs() / speeds[k]).fold(0.0, f64::max) * (1.0 - ROUNDING);
            stretches.push(Stretch { middle: at(part) + half, half, takes, left: OnceCell::new() });
        }
    }
    stretches
}
