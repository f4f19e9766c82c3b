//! A wrist that turns a payload while the arm stands still.

use crate::geometry::{Features, Hits, Point, ROUNDING, Vector, turning_from};
use crate::model::{Arm, Payload, Workspace};
use crate::space::Configuration;
use nalgebra::Translation2;
use std::f64::consts::TAU;

/// A turn of a payload about the tip, proven free.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WristTurn {
    /// The payload's orientation at the beginning, radians.
    pub from: f64,
    /// At the end; less than a turn from the beginning, and beyond it in the direction of the turn.
    pub to: f64,
    /// Proven lower bound on the distance between payload and obstacles, metres, supports aside; infinite if nothing can
    /// be met.
    pub clearance: f64,
}

/// Halvings of the interval in which the clearance of a turn is sought.
const HALVINGS: usize = 16;

/// A turn about the tip from one orientation to another while the arm stands at `q`: the shorter way if that is free, else
/// the longer; none if neither is. The payload's point `point` is at the tip. `O(n m)` for each pair of pieces, exact up to rounding, which is
/// added to what is to be kept.
#[must_use]
pub fn wrist_turn(
    arm: &Arm,
    workspace: &Workspace,
    payload: &Payload,
    point: Point,
    q: Configuration,
    [from, to]: [f64; 2],
) -> Option<WristTurn> {
    let about = Translation2::from(-point.coords);
    let parts: Vec<_> = payload
        .parts(arm, workspace.clearance)
        .into_iter()
        .map(|(shape, kind)| (Features::new(&shape.at(&about.into())), kind))
        .collect();
    let mut pairs = Vec::new();
    for (number, obstacle) in workspace.obstacles.iter().enumerate() {
        if !payload.heights.meet(obstacle.heights) {
            continue;
        }
        let pieces = obstacle.pieces.iter().map(Features::new);
        pairs.extend(pieces.flat_map(|piece| {
            let meeting = parts.iter().filter(|(_, kind)| payload.meets(*kind, number));
            meeting.map(|(part, _)| (part.clone(), piece.clone())).collect::<Vec<_>>()
        }));
    }
    let tip = arm.tip_at(q);
    let mut arcs = Vec::new();
    // Whether all angles from `from` to `end` keep more than `distance`.
    let mut free = |end: f64, distance: f64| {
        pairs.iter().all(|(part, piece)| {
            arcs.clear();
            match turning_from(part, tip, Vector::x(), piece, distance + 2.0 * ROUNDING, &mut arcs) {
                Hits::Never => true,
                Hits::Always => false,
                Hits::Within => arcs.iter().all(|&arc| apart(arc, [from.min(end), from.max(end)])),
            }
        })
    };
    let ahead = (to - from).rem_euclid(TAU);
    let mut ways = [from + ahead, from + ahead - TAU];
    if ahead > TAU / 2.0 {
        ways.reverse();
    }
    let to = ways.into_iter().find(|&end| free(end, workspace.clearance))?;
    if pairs.is_empty() {
        return Some(WristTurn { from, to, clearance: f64::INFINITY });
    }
    let (mut kept, mut refused) = (workspace.clearance + ROUNDING, workspace.clearance + arm.reach());
    for _ in 0..HALVINGS {
        let between = (kept + refused) / 2.0;
        if free(to, between) { kept = between } else { refused = between }
    }
    Some(WristTurn { from, to, clearance: kept })
}

/// Whether no copy of an arc by whole turns meets an interval shorter than a turn.
fn apart([start, end]: [f64; 2], [lower, upper]: [f64; 2]) -> bool {
    let shift = ((lower - end) / TAU).ceil() * TAU;
    start + shift > upper
}
