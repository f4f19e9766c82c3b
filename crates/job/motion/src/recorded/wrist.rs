//! A turn of a payload by a wrist while the arm is at rest.

use cplan_geometry::{Features, Hits, Point, Pose, ROUNDING, Vector, turning_from};
use cplan_handling::{Payload, Task};
use cplan_model::space::{Configuration, JointRange};
use cplan_model::{Arm, Workspace};
use std::f64::consts::TAU;

/// A turn of a payload about the tip, proven free.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WristTurn {
    /// The payload's orientation at the beginning, radians.
    pub from: f64,
    /// The payload's orientation at the end, radians. It differs from `from` by less than a turn; the sign of the difference is
    /// the direction.
    pub to: f64,
    /// Proven lower bound on the distance between the payload and obstacles other than its supports, metres; infinite
    /// if nothing can meet.
    pub clearance: f64,
}

/// The first place where a turn touches an obstacle, or comes too close to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurnContact {
    /// The payload's orientation at the contact, radians. It lies between both ends of the turn.
    pub angle: f64,
    /// The obstacle's index in the workspace.
    pub obstacle: usize,
}

/// Number of halvings in the search for the clearance of a turn.
const CLEARANCE_HALVINGS: usize = 16;

/// Returns the resolution, metres, of the clearance of a free turn, if the clearance is below the arm's reach.
pub fn turn_resolution(arm: &Arm, clearance: f64) -> f64 {
    (clearance + arm.reach()) / f64::from(1u32 << (CLEARANCE_HALVINGS - 1))
}

/// A payload that turns about the tip while the arm rests, and the obstacles that it can touch.
#[derive(Debug)]
pub struct TurnAtRest {
    tip: Point,
    /// The pairs of a piece of the payload, relative to the tip, and a piece of an obstacle, with the obstacle's index.
    pairs: Vec<(Features, Features, usize)>,
    clearance: f64,
    reach: f64,
}

impl TurnAtRest {
    /// Collects the obstacles that can be touched while the arm rests at `q`. The payload's point `point` is at the tip.
    pub fn new(task: &Task, workspace: &Workspace, payload: &Payload, point: Point, q: Configuration) -> Self {
        let arm = &task.arm;
        let attachment = payload.attachment(task, arm, task.objects[payload.object].carried_heights());
        let about = Pose::translation(-point);
        let features: Vec<_> = attachment.parts.iter().map(|part| Features::new(&part.shape.at(&about))).collect();
        let mut pairs = Vec::new();
        for (number, obstacle) in workspace.obstacles.iter().enumerate() {
            if !attachment.heights.object_may_meet(obstacle.heights) {
                continue;
            }
            for (attached, part) in attachment.parts.iter().zip(&features) {
                let Some(nearer) = attachment.nearer(attached, number, workspace.clearance) else { continue };
                let pieces = obstacle.pieces.iter().map(|piece| Features::new(&piece.with_distances_increased(nearer)));
                pairs.extend(pieces.map(|piece| (part.clone(), piece, number)));
            }
        }
        Self { tip: arm.tip_at(q), pairs, clearance: workspace.clearance, reach: arm.reach() }
    }

    /// Returns a free turn from one orientation to another: in the shorter direction if it is free, otherwise in the longer one.
    /// `None` if neither is free.
    pub fn free(&self, [from, to]: [f64; 2]) -> Option<WristTurn> {
        let displacement = JointRange::Circle.displacement(from, to);
        let ahead = if displacement < 0.0 { displacement + TAU } else { displacement };
        let mut ends = [from + ahead, from + ahead - TAU];
        if ahead > TAU / 2.0 {
            ends.reverse();
        }
        ends.into_iter().find_map(|end| self.judge([from, end]).ok())
    }

    /// Checks the turn from the first orientation to the second, without wrapping. `O(n m)` for each pair of pieces. Exact up to
    /// rounding errors, which are added to the required distance.
    ///
    /// # Errors
    /// The first place where the payload touches an obstacle, or comes closer than the workspace's clearance.
    pub fn judge(&self, [from, to]: [f64; 2]) -> Result<WristTurn, TurnContact> {
        // Contact angles are known near zero, so the turn is shifted there. Shifting contact angles instead would cause more
        // rounding than the margin covers.
        let near = JointRange::Circle.wrap(from);
        match self.judge_near([near, near + (to - from)]) {
            Ok(free) => Ok(WristTurn { from, to, ..free }),
            Err(contact) => {
                let angle = (contact.angle + (from - near)).clamp(from.min(to), from.max(to));
                Err(TurnContact { angle, ..contact })
            }
        }
    }

    fn judge_near(&self, turn @ [from, to]: [f64; 2]) -> Result<WristTurn, TurnContact> {
        let first =
            |a: TurnContact, b: TurnContact| if (b.angle - from).abs() < (a.angle - from).abs() { b } else { a };
        if let Some(contact) = self.contacts(turn, self.clearance).reduce(first) {
            return Err(contact);
        }
        if self.pairs.is_empty() {
            return Ok(WristTurn { from, to, clearance: f64::INFINITY });
        }
        let (mut kept, mut refused) = (self.clearance + ROUNDING, self.clearance + self.reach);
        for _ in 0..CLEARANCE_HALVINGS {
            let between = (kept + refused) / 2.0;
            if self.contacts(turn, between).next().is_none() { kept = between } else { refused = between }
        }
        Ok(WristTurn { from, to, clearance: kept })
    }

    /// Iterates over the pairs that come nearer than `distance` somewhere, each with the first place where it does.
    fn contacts(&self, turn: [f64; 2], distance: f64) -> impl Iterator<Item = TurnContact> {
        let mut arcs = Vec::new();
        self.pairs.iter().filter_map(move |(part, piece, obstacle)| {
            arcs.clear();
            let angle = match turning_from(part, self.tip, Vector::x(), piece, distance + 2.0 * ROUNDING, &mut arcs) {
                Hits::Never => None,
                Hits::Always => Some(turn[0]),
                Hits::Within => {
                    let first = |a: f64, b: f64| if (b - turn[0]).abs() < (a - turn[0]).abs() { b } else { a };
                    arcs.iter().filter_map(|&arc| entry(arc, turn)).reduce(first)
                }
            }?;
            Some(TurnContact { angle, obstacle: *obstacle })
        })
    }
}

/// Returns the value at which a turn first meets an arc, or a copy of it shifted by whole turns. `None` if it meets none.
fn entry([start, end]: [f64; 2], [from, to]: [f64; 2]) -> Option<f64> {
    if to < from {
        return entry([-end, -start], [-from, -to]).map(|angle| -angle);
    }
    let shift = ((from - end) / TAU).ceil() * TAU;
    Some((start + shift).max(from)).filter(|angle| *angle <= to)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        /// Compares the result with 4000 sampled angles of the turn.
        #[test]
        fn a_turn_meets_an_arc_where_it_first_is_in_it(
            start in -9.0..9.0_f64, width in 0.01..6.2_f64, from in -9.0..9.0_f64, displacement in -6.2..6.2_f64,
        ) {
            let is_in = |angle: f64| (angle - start).rem_euclid(TAU) <= width;
            let at = |i: u32| from + displacement * f64::from(i) / 4000.0;
            let seen = (0..=4000).map(at).find(|angle| is_in(*angle));
            let step = displacement.abs() / 4000.0 + 1e-9;
            match (entry([start, start + width], [from, from + displacement]), seen) {
                (Some(found), Some(seen)) => prop_assert!((found - seen).abs() <= step, "{found} {seen}"),
                // At the very end, or within an arc between two samples.
                (Some(found), None) => {
                    prop_assert!(width <= step || (found - from - displacement).abs() <= step, "{found}");
                }
                (None, seen) => prop_assert!(seen.is_none_or(|seen| (seen - from - displacement).abs() <= step), "{seen:?}"),
            }
        }
    }
}
