//! Proofs about the range of the wrist's joint.
//!
//! At a place of the line, the joint's value is known up to whole turns, the tolerance of the tool's angle, and the box of
//! the IK solution. Between two stops, the value changes continuously with the place. So a solution is excluded if its value
//! is outside the range with all whole turns, or if the joint would turn by more than its range.

use crate::proof::{Exclusion, Obstacle, Prover};
use crate::wrist::WristAlong;
use cplan_deviation::is_sharp;
use cplan_handling::{ToolAngle, WristJoint};
use cplan_model::space::{Configuration, JointRange};
use cplan_toolpath::wrapped;
use std::f64::consts::PI;

/// Allowance for rounding, radians.
const ROUNDING: f64 = 1e-9;

/// Greatest uncertainty of the joint's value, radians, with which values at two neighbouring nodes have the same number of
/// whole turns.
const MAX_UNCERTAINTY: f64 = 1.0;

/// Greatest turn of the line between two nodes, radians, for the same reason.
const MAX_TURN: f64 = 0.5;

/// The reason why a wrist excludes an IK solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WristExcess {
    /// The joint would be at this value, radians, or at one that differs by whole turns.
    Value(f64, [f64; 2]),
    /// The joint would turn by this angle along the line without a stop, radians.
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

/// Values of the wrist's joint on one sheet since the last stop, up to whole turns that are the same for all.
#[derive(Debug, Clone, Copy)]
struct Wound {
    middle: Configuration,
    angle: f64,
    value: f64,
    /// The least upper bound on a value so far, and the greatest lower bound.
    extremes: [f64; 2],
}

/// The values of the wrist's joint on all sheets since the last stop of the line.
pub(crate) struct Winding(Vec<Option<Wound>>);

impl Winding {
    pub fn new(sheets: usize) -> Self {
        Self(vec![None; sheets])
    }

    /// Forgets all values, because another IK solution or another number of whole turns is possible from here on.
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

/// Returns the reason why the wrist excludes a sheet at a node, if its value is outside the range with all whole turns.
/// `middle` and `half` are the box of the solution.
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

/// Returns the required angles of the tool on arrival at a node and on departure from it, radians. `None` on travels.
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

/// Returns the greatest difference of the joint's value from the one in the middle of a box, radians.
fn uncertainty(prover: &Prover, wrist: &WristAlong, half: [f64; 2]) -> f64 {
    let weights = WristJoint::weights(prover.kinematics.arm);
    wrist.guide.tolerance + weights[0].abs() * half[0] + weights[1].abs() * half[1] + ROUNDING
}
