//! Decides if all configurations on a segment are blocked.

use super::{Contact, Obstruction, Pair, Scene};
use crate::space::{Configuration, Segment};
use cplan_geometry::Point;

/// Largest number of configurations that one search checks before it gives up.
const MAX_CHECKED_CONFIGURATIONS: usize = 1000;

/// Largest number of times that a segment is halved.
const MAX_HALVINGS: u32 = 20;

/// Margin by which a collision's depth must exceed the arm's motion, as a fraction of the lengths in their comparison.
/// It is far above the rounding of the two values.
const ROUNDING: f64 = 1e-12;

/// A part of a segment on which one obstruction is proven to remain.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockedStretch {
    /// The configurations of the blocked part.
    pub stretch: Segment,
    /// The deepest obstruction found. Its link and obstacle collide on all of the stretch.
    pub obstruction: Obstruction,
}

impl Scene {
    /// Proves that no configuration on a segment is free. Returns stretches that cover the segment in order;
    /// neighbours with the same link and obstacle are joined. Returns `None` if a configuration is free, or if the
    /// search cannot decide.
    ///
    /// A pair collides on a whole stretch if its depth in the middle exceeds the motion of every point of the arm
    /// from there to the ends. Stretches without such a pair are halved.
    pub fn blocked_along(&self, segment: &Segment) -> Option<Vec<BlockedStretch>> {
        let mut waiting = vec![(0.0, 1.0, 0)];
        let mut blocked: Vec<(f64, f64, Obstruction)> = Vec::new();
        let mut looks = 0;
        while let Some((from, to, halvings)) = waiting.pop() {
            let middle = f64::midpoint(from, to);
            let q = segment.at(middle);
            let obstructions = self.obstructions(q);
            looks += 1;
            if obstructions.is_empty() || looks > MAX_CHECKED_CONFIGURATIONS {
                return None;
            }
            let [a, b] = [from, to].map(|share| segment.at(share) - q);
            let moves = [0, 1].map(|k| a[k].abs().max(b[k].abs()));
            let lasting = obstructions.into_iter().find(|obstruction| {
                let Contact { pair, separation } = obstruction.contact;
                let (motion, scale) = self.farthest_motion(pair, q, moves);
                separation.distance + motion + ROUNDING * scale < self.workspace().clearance
            });
            match lasting {
                Some(lasting) => blocked.push((from, to, lasting)),
                None if halvings == MAX_HALVINGS => return None,
                None => waiting.extend([(middle, to, halvings + 1), (from, middle, halvings + 1)]),
            }
        }
        let same = |a: &(f64, f64, Obstruction), b: &(f64, f64, Obstruction)| self.bodies(&a.2) == self.bodies(&b.2);
        let joined = blocked.chunk_by(same).map(|run| {
            let deepest = run
                .iter()
                .map(|stretch| stretch.2)
                .min_by(|a, b| a.contact.separation.distance.total_cmp(&b.contact.separation.distance));
            let [from, to] = [run[0].0, run[run.len() - 1].1].map(|share| segment.at(share));
            BlockedStretch { stretch: Segment::new(from, to), obstruction: deepest.unwrap_or(run[0].2) }
        });
        Some(joined.collect())
    }

    /// Returns how far a point of a pair's part can move, metres, while each joint moves by at most `moves` from
    /// `q`. Also returns a bound on all lengths in that computation, for its rounding. Joint 2 moves first, then
    /// joint 1 from every place that joint 2 reaches.
    fn farthest_motion(&self, pair: Pair, q: Configuration, moves: [f64; 2]) -> (f64, f64) {
        let arm = self.arm();
        let part = self.part(pair);
        let from_base = part.at(&arm.pose(pair.link, q)).reach_from(arm.base);
        let [first, second] = arm.joints.each_ref().map(|joint| joint.joint_type);
        let second = if pair.link == 0 { 0.0 } else { moves[1] * second.lever(part.reach_from(Point::zeros())) };
        let first = if pair.link == 2 { 0.0 } else { moves[0] * first.lever(from_base + second) };
        let scale = from_base + self.piece(pair).reach_from(arm.base) + arm.base.norm() + first + second;
        (first + second, scale)
    }
}
