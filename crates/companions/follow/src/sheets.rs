//! IK solutions as sheets. A sheet is a continuous function of the place on the line, for one solution and one number
//! of whole turns.

use crate::nodes::{Node, Nodes};
use cplan_deviation::Kinematics;
use cplan_model::Elbow;
use cplan_model::space::{Configuration, JointRange};
use std::f64::consts::TAU;
use std::ops::Range;

/// Greatest excess over a limit that is attributed to rounding, radians or metres. Such a value is set to the limit.
const LIMIT_ROUNDING: f64 = 1e-9;

/// Distance of nodes from the ends of the range of the sum of joint values, radians. It covers the motion between nodes.
const SUM_INSET: f64 = 1e-4;

/// Greatest distance of a listed sheet beyond the limits, radians. Values near such a sheet may be within the limits,
/// so proofs must exclude it, too.
pub(crate) const LISTED_BEYOND_LIMITS: f64 = 1.5;

/// Greatest number of whole turns of a joint that are considered in either direction.
const MAX_TURNS: i64 = 100;

/// An IK solution with whole turns added to its joints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sheet {
    /// Number of the IK solution, 0 or 1.
    pub solution: usize,
    /// Displacement by whole turns.
    pub turns: Configuration,
}

/// All sheets that are within the joint limits at some node, or near them.
pub(crate) struct Sheets<'a> {
    kinematics: &'a Kinematics<'a>,
    nodes: &'a [Node],
    /// Numbers of the IK solutions that may be used.
    pub solutions: Range<usize>,
    pub sheets: Vec<Sheet>,
    /// True if the list has all such sheets.
    pub is_complete: bool,
}

impl<'a> Sheets<'a> {
    /// Lists the sheets with the elbow on a side, or on both sides if `elbow` is `None`.
    pub fn new(kinematics: &'a Kinematics<'a>, nodes: &'a Nodes, elbow: Option<Elbow>) -> Self {
        let nodes = &nodes.nodes[..];
        let solutions = match elbow.filter(|_| kinematics.arm.only_turns()) {
            Some(elbow) => elbow.solution()..elbow.solution() + 1,
            None if kinematics.has_two_solutions() => 0..2,
            None => 0..1,
        };
        let mut list = Self { kinematics, nodes, solutions: solutions.clone(), sheets: Vec::new(), is_complete: true };
        for solution in solutions {
            let [first, second] = [0, 1].map(|joint| list.turns(joint, solution));
            let pairs = first.iter().flat_map(|a| second.iter().map(move |b| Configuration::new(*a, *b)));
            list.sheets.extend(pairs.map(|turns| Sheet { solution, turns }));
        }
        list
    }

    /// Returns the whole turns with which a joint's value is within its limits, or near them, at some node.
    fn turns(&mut self, joint: usize, solution: usize) -> Vec<f64> {
        let own = &self.kinematics.arm.joints[joint];
        let JointRange::Interval { lower, upper } = own.range else { return vec![0.0] };
        if !own.joint_type.is_revolute() {
            return vec![0.0];
        }
        let values = self.nodes.iter().filter_map(|node| Some(node.solutions?[solution][joint]));
        let (least, greatest) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, g), v| (l.min(v), g.max(v)));
        if least > greatest {
            return Vec::new();
        }
        let first = ((lower - LISTED_BEYOND_LIMITS - greatest) / TAU).ceil() as i64;
        let last = ((upper + LISTED_BEYOND_LIMITS - least) / TAU).floor() as i64;
        self.is_complete &= first >= -MAX_TURNS && last <= MAX_TURNS;
        (first.max(-MAX_TURNS)..=last.min(MAX_TURNS)).map(|turns| turns as f64 * TAU).collect()
    }

    /// Returns the joint values of a sheet at a node, ignoring limits. `None` if the place is out of reach.
    pub fn unlimited(&self, node: usize, sheet: usize) -> Option<Configuration> {
        let Sheet { solution, turns } = self.sheets[sheet];
        Some(self.nodes[node].solutions?[solution] + turns)
    }

    /// Returns the joint values of a sheet at a node, if they are within the limits.
    pub fn at(&self, node: usize, sheet: usize) -> Option<Configuration> {
        let q = self.unlimited(node, sheet)?;
        let limited = |k: usize| match self.kinematics.arm.joints[k].range {
            JointRange::Circle => Some(q[k]),
            JointRange::Interval { lower, upper } => {
                let inside = lower - LIMIT_ROUNDING <= q[k] && q[k] <= upper + LIMIT_ROUNDING;
                inside.then(|| q[k].clamp(lower, upper))
            }
        };
        let q = Configuration::new(limited(0)?, limited(1)?);
        let sum = self.kinematics.arm.topology().sum;
        sum.is_none_or(|sum| sum.narrowed(SUM_INSET).contains(q)).then_some(q)
    }
}
