//! Decides if all configurations on a segment are blocked.

use super::{Contact, JointType, Obstruction, Pair, Scene};
use crate::space::{Configuration, Segment};
use cplan_geometry::Point;

/// Greatest number of configurations that are checked before the search gives up.
const MAX_CHECKED_CONFIGURATIONS: usize = 1000;

/// Greatest number of halvings of a segment.
const MAX_HALVINGS: u32 = 20;

/// Share of the lengths involved by which the depth of a collision must exceed the motion: far above the rounding of
/// either.
const ROUNDING: f64 = 1e-12;

/// A part of a segment on which one obstruction is proven to remain.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockedStretch {
    /// The configurations of that part.
    pub stretch: Segment,
    /// The obstruction in its middle, which persists in all of the part.
    pub obstruction: Obstruction,
}

impl Scene {
    /// Returns the proof that no configuration on a segment is free: stretches that cover the segment in order, with
    /// neighbours of the same obstruction joined. Returns `None` if there is a free configuration, or if the search
    /// cannot decide.
    ///
    /// A pair collides on a whole stretch if it is deeper in collision in the middle than a point of the arm moves from
    /// there to the ends. Other stretches are halved.
    #[must_use]
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
        let whose = |obstruction: &Obstruction| {
            let pair = obstruction.contact.pair;
            (pair.link, self.is_attached(pair), pair.obstacle)
        };
        let same = |a: &(f64, f64, Obstruction), b: &(f64, f64, Obstruction)| whose(&a.2) == whose(&b.2);
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

    /// Returns the farthest that a point of a pair's part moves while the joints move by at most `moves` from `q`, and
    /// the greatest length in that computation: joint 2 first, then joint 1 from every place that joint 2 reaches.
    fn farthest_motion(&self, pair: Pair, q: Configuration, moves: [f64; 2]) -> (f64, f64) {
        let arm = self.arm();
        let part = self.part(pair);
        let from_base = part.at(&arm.pose(pair.link, q)).reach_from(arm.base);
        let second = match arm.joints[1].joint_type {
            _ if pair.link == 0 => 0.0,
            JointType::Revolute { .. } => moves[1] * part.reach_from(Point::zeros()),
            JointType::Prismatic { .. } => moves[1],
        };
        let first = match arm.joints[0].joint_type {
            _ if pair.link == 2 => 0.0,
            JointType::Revolute { .. } => moves[0] * (from_base + second),
            JointType::Prismatic { .. } => moves[0],
        };
        let scale = from_base + self.piece(pair).reach_from(arm.base) + arm.base.norm() + first + second;
        (first + second, scale)
    }
}
