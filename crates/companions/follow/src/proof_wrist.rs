//! Proofs about the range of the wrist's joint.
//!
//! At a place of the line, the IK solution determines the joint's value up to whole turns. The value is uncertain by
//! the tolerance of the tool's angle and the size of the solution's box. Between two stops, it changes continuously. So
//! a solution is excluded if its value is outside the range with every number of whole turns, or if the joint would
//! turn by more than its range.

use crate::proof::{Exclusion, Obstacle, Prover};
use crate::wrist::WristAlong;
use cplan_deviation::is_sharp;
use cplan_handling::{ToolAngle, WristJoint};
use cplan_model::space::{Configuration, JointRange};
use cplan_toolpath::wrapped;
use std::f64::consts::PI;

/// Allowance for rounding, radians.
const ROUNDING: f64 = 1e-9;

/// Greatest uncertainty of the joint's value, radians. With less, the number of whole turns cannot change between
/// neighbouring nodes.
const MAX_UNCERTAINTY: f64 = 1.0;

/// Greatest turn of the line between two nodes, radians. With less, the number of whole turns cannot change between them.
const MAX_TURN: f64 = 0.5;

/// The reason why a wrist excludes an IK solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WristExcess {
    /// The joint would have this value, radians, or one that differs by whole turns. The range follows.
    Value(f64, [f64; 2]),
    /// The joint would turn by this angle between two stops, radians. The range follows.
    Turn(f64, [f64; 2]),
}

impl WristExcess {
    /// Describes the reason in words.
    pub fn describe(&self) -> String {
        match self {
            Self::Value(value, [lower, upper]) => {
                format!("the wrist would be at {value:.3} rad, outside its limits from {lower} to {upper} rad")
            }
            Self::Turn(turn, [lower, upper]) => {
                format!("the wrist would turn by {turn:.3} rad, more than its limits from {lower} to {upper} rad allow")
            }
        }
    }
}

/// Values of the wrist's joint on one sheet since the last stop. All may differ from the true ones by the same number
/// of whole turns.
#[derive(Debug, Clone, Copy)]
struct Wound {
    middle: Configuration,
    angle: f64,
    value: f64,
    /// The least upper bound and the greatest lower bound on the values so far.
    extremes: [f64; 2],
}

/// The values of the wrist's joint on all sheets since the last stop of the line.
pub(crate) struct Winding(Vec<Option<Wound>>);

impl Winding {
    pub fn new(sheets: usize) -> Self {
        Self(vec![None; sheets])
    }

    /// Forgets all values. Called where the IK solution or the number of whole turns may change.
    pub fn forget(&mut self) {
        self.0.fill(None);
    }

    /// Adds the next node of a sheet. Returns the reason if the joint would turn by more than its range.
    pub fn add(&mut self, prover: &Prover, node: usize, sheet: usize) -> Option<Exclusion> {
        let wrist = prover.wrist?;
        let JointRange::Interval { lower, upper } = wrist.joint.range else { return None };
        let before = self.0[sheet].take();
        let [arrival, departure] = required(prover, &wrist, node);
        let (middle, half) = prover.solution_box(node, sheet)?;
        let uncertainty = uncertainty(prover, &wrist, half);
        let angle = arrival.or(departure)?;
        let value = |angle: f64| wrist.joint.value(prover.kinematics.arm, middle.into(), angle);
        let continued = before.filter(|before| {
            arrival.is_some_and(|angle| wrapped(angle - before.angle).abs() <= MAX_TURN)
                && (middle - before.middle).amax() <= 2.0 * MAX_TURN
        });
        let bounds = |value: f64| [value + uncertainty, value - uncertainty];
        let wound = match continued {
            Some(before) => {
                let weights = WristJoint::weights(prover.kinematics.arm);
                let moved = middle - before.middle;
                let by = wrapped(angle - before.angle) - weights[0] * moved[0] - weights[1] * moved[1];
                let value = before.value + wrist.joint.sign * by;
                let [least, greatest] = bounds(value);
                let extremes = [before.extremes[0].min(least), before.extremes[1].max(greatest)];
                Wound { middle, angle, value, extremes }
            }
            None => Wound { middle, angle, value: value(angle), extremes: bounds(value(angle)) },
        };
        let by = wound.extremes[1] - wound.extremes[0];
        let is_stop = is_sharp(arrival, departure, wrist.guide.tolerance);
        self.0[sheet] = match departure {
            Some(angle) if is_stop => {
                let value = value(angle);
                Some(Wound { middle, angle, value, extremes: bounds(value) })
            }
            Some(angle) => {
                let by = wrist.joint.sign * wrapped(angle - wound.angle);
                Some(Wound { angle, value: wound.value + by, ..wound })
            }
            None => None,
        }
        .filter(|_| uncertainty <= MAX_UNCERTAINTY);
        (by > upper - lower + ROUNDING)
            .then(|| prover.exclusion_at(node, sheet, Obstacle::Wrist(WristExcess::Turn(by, [lower, upper]))))?
    }
}

/// Returns the reason why the wrist excludes a sheet at a node: its value is outside the range with every number of
/// whole turns. `middle` and `half` are the box of the solution.
pub(crate) fn outside(prover: &Prover, node: usize, middle: Configuration, half: [f64; 2]) -> Option<WristExcess> {
    let wrist = prover.wrist?;
    let JointRange::Interval { lower, upper } = wrist.joint.range else { return None };
    let room = (upper - lower) / 2.0 + uncertainty(prover, &wrist, half);
    let is_outside = |value: &f64| room < PI && wrapped(value - (lower + upper) / 2.0).abs() > room;
    let values = required(prover, &wrist, node).into_iter().flatten();
    let mut values = values.map(|angle| wrist.joint.value(prover.kinematics.arm, middle.into(), angle));
    values.find(is_outside).map(|value| {
        let near = (lower + upper) / 2.0;
        WristExcess::Value(near + wrapped(value - near), [lower, upper])
    })
}

/// Returns the required angles of the tool at a node on arrival and on departure, radians. `None` on travels.
fn required(prover: &Prover, wrist: &WristAlong, node: usize) -> [Option<f64>; 2] {
    let offset = match wrist.guide.angle {
        ToolAngle::Fixed(angle) => return [Some(angle); 2],
        ToolAngle::Tangent(offset) => offset,
    };
    let heading = |part: Option<usize>, end: usize| {
        let part = prover.nodes.parts.get(part?)?;
        let piece = &prover.line.pieces[part.piece];
        if piece.is_travel { None } else { Some(piece.curve.heading(part.ends[end])? + offset) }
    };
    [heading(node.checked_sub(1), 1), heading(Some(node), 0)]
}

/// Returns the greatest difference between the joint's values in a box and at its middle, radians.
fn uncertainty(prover: &Prover, wrist: &WristAlong, half: [f64; 2]) -> f64 {
    let weights = WristJoint::weights(prover.kinematics.arm);
    wrist.guide.tolerance + weights[0].abs() * half[0] + weights[1].abs() * half[1] + ROUNDING
}
