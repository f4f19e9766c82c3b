//! Pairs of the robot's own shapes that meet in every configuration, as neighbours do at their joint.

use super::{Cell, Deviation, Posture};
use cplan_geometry::{Hits, ROUNDING};
use cplan_model::{Contacts, Joint, Pair, Scene, on_axis};
use std::collections::VecDeque;

/// Distance within which two shapes count as meeting, metres. Links often begin where others end, so the shapes only
/// touch at some values of the joint.
const TOUCHING: f64 = 2.0 * ROUNDING;

/// Largest number of boxes of configurations for the test of one pair. If they do not decide, the pair counts as not
/// permanent. For large plates around the arm, about ten boxes suffice.
const MAX_CELLS: usize = 4096;

/// Returns the pairs with links of the robot that are proven to meet in every configuration within the joints' limits.
/// The proof uses shapes that certainly lie within the real ones.
pub fn permanent_contacts(scene: &Scene) -> Vec<Pair> {
    let inner = scene.inner();
    let contacts = Contacts::new(&inner);
    let is_permanent = |&(index, pair): &(usize, &Pair)| {
        scene.self_obstacle(pair.obstacle).is_some() && meet_everywhere(&contacts, index, *pair)
    };
    inner.pairs().iter().enumerate().filter(is_permanent).map(|(_, pair)| *pair).collect()
}

/// Returns true if a pair is proven to meet in every configuration. If only one joint changes its distance, the contact
/// angles decide. Otherwise, boxes of configurations do.
fn meet_everywhere(contacts: &Contacts, index: usize, pair: Pair) -> bool {
    let joints = &contacts.scene().arm().joints;
    let mut intervals = Vec::new();
    match pair.link {
        0 => {
            let hits = contacts.first_link(index, TOUCHING, &mut intervals);
            cover(&joints[0], hits, &intervals)
        }
        1 => overlap_in_boxes(contacts.scene(), pair),
        _ => {
            let hits = contacts.second_link(index, 0.0, TOUCHING, &mut intervals);
            cover(&joints[1], hits, &intervals)
        }
    }
}

/// Returns true if intervals of a joint's values cover its whole range.
fn cover(joint: &Joint, hits: Hits, intervals: &[[f64; 2]]) -> bool {
    let mut covered: Vec<[f64; 2]> = Vec::new();
    on_axis(joint, hits, intervals, |interval| covered.push(interval));
    covered.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let (lower, upper) = joint.range.domain();
    let reached = covered.iter().try_fold(lower, |reached, [from, to]| (*from <= reached).then_some(reached.max(*to)));
    reached.is_some_and(|reached| reached >= upper)
}

/// Returns true if a pair of link 2 and a static link overlaps in every configuration. A box of configurations is
/// halved unless it passes [`Posture::greatest`]. The search ends at the first configuration without overlap.
fn overlap_in_boxes(scene: &Scene, pair: Pair) -> bool {
    let [(low1, high1), (low2, high2)] = scene.arm().joints.each_ref().map(|joint| joint.range.domain());
    let mut waiting = VecDeque::from([Cell { lower: [low1, low2], upper: [high1, high2] }]);
    for _ in 0..MAX_CELLS {
        let Some(cell) = waiting.pop_front() else { return true };
        let posture = Posture::new(scene, cell.center());
        if posture.separation(pair).distance > 0.0 {
            return false;
        }
        let half = cell.half();
        if posture.greatest(pair, Deviation::Box(half)) <= 0.0 {
            continue;
        }
        let moved = |half: [f64; 2]| posture.farthest_motion(pair, Deviation::Box(half));
        let side = usize::from(moved([0.0, half[1]]) > moved([half[0], 0.0]));
        let (mut left, mut right) = (cell, cell);
        left.upper[side] = cell.center()[side];
        right.lower[side] = left.upper[side];
        waiting.extend([left, right]);
    }
    false
}
