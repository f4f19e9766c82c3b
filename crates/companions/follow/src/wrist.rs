//! The wrist's joint along a route.
//!
//! The line determines the angle of the tool up to whole turns. On a stretch between two stops, the angle is continuous, and so
//! are the joint's values. If the joint has limits, the whole turns of each stretch are chosen so that all values are within
//! them, and the joint turns least between the stretches ([`WristAlong::turns`]). At a sharp corner, the tool turns while the
//! arm rests. On travels, the joint turns evenly from its value before to the one after.

use crate::nodes::Nodes;
use crate::search::Route;
use cplan_deviation::{Line, is_sharp};
use cplan_handling::{ToolAngle, WristGuide, WristJoint};
use cplan_model::Arm;
use cplan_model::space::JointRange;
use cplan_toolpath::wrapped;
use std::f64::consts::TAU;

/// Greatest excess over a limit of the joint that is attributed to rounding, radians.
const LIMIT_ROUNDING: f64 = 1e-9;

/// Greatest number of whole turns of the joint that are considered in either direction.
const MAX_TURNS: f64 = 100.0;

/// Cost of the turn from the joint's default value to its first value on the line, relative to the same turn on the line.
const REST_SHARE: f64 = 1e-3;

/// A wrist that turns the tool along a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WristAlong {
    /// The required angle of the tool.
    pub guide: WristGuide,
    /// The joint.
    pub joint: WristJoint,
    /// Top speed of the joint, radians per second, positive.
    pub velocity: f64,
    /// Greatest acceleration of the joint, radians per second squared, positive.
    pub acceleration: f64,
}

/// The values of the wrist's joint on arrival at each waypoint of a route and on departure from it, radians. If they differ,
/// the arm rests there while the wrist turns.
pub(crate) type Turns = Vec<[f64; 2]>;

/// Returns the values at the waypoints from one to another: on departure from the first, and on arrival at each other one.
pub(crate) fn values_between(turns: &[[f64; 2]], from: usize, to: usize) -> Vec<f64> {
    let arrivals = turns[from + 1..=to].iter().map(|[arrival, _]| *arrival);
    std::iter::once(turns[from][1]).chain(arrivals).collect()
}

/// The required angles of the tool at a waypoint, on arrival and on departure, up to whole turns, radians. `None` on travels.
#[derive(Clone, Copy)]
struct Angles {
    ends: [Option<f64>; 2],
    /// True if the arm stops between arrival and departure.
    is_stop: bool,
}

/// The values of the joint at consecutive waypoints between two stops. All may differ from the true ones by the same
/// number of whole turns.
struct Stretch {
    first: usize,
    values: Vec<f64>,
}

impl WristAlong {
    /// Returns true if the required angle is valid, the limits on speed and acceleration are finite and positive, and the
    /// joint's zero is finite.
    pub(crate) fn is_valid(&self) -> bool {
        let limits = [self.velocity, self.acceleration];
        self.guide.is_valid()
            && limits.iter().all(|limit| limit.is_finite() && *limit > 0.0)
            && self.joint.zero.is_finite()
    }

    /// Returns the values of the joint along a route.
    ///
    /// # Errors
    /// The waypoint at which the joint leaves its range with every choice of whole turns.
    pub(crate) fn turns(&self, arm: &Arm, line: &Line, nodes: &Nodes, route: &Route) -> Result<Turns, usize> {
        let q = route.path.path().waypoints();
        let mut before = None;
        let angles: Vec<Angles> = (0..q.len())
            .map(|waypoint| {
                let last = route.nodes[waypoint];
                // At a change of the IK solution, two waypoints have the same node.
                let first = before.map_or(0, |node: usize| node + 1);
                before = Some(last);
                self.angles(line, nodes, [first, last])
            })
            .collect();
        let value = |waypoint: usize, angle: f64| self.joint.value(arm, q[waypoint].into(), angle);
        let stretches = stretches(&angles, &value);
        let shifts = self.shifts(&stretches)?;
        let mut values: Vec<[Option<f64>; 2]> = vec![[None; 2]; q.len()];
        for (stretch, shift) in stretches.iter().zip(shifts) {
            let last = stretch.values.len() - 1;
            for (k, value) in stretch.values.iter().enumerate() {
                let own = &mut values[stretch.first + k];
                let value = self.joint.range.clamp(value + shift);
                // The ends of a stretch may be stops.
                if k > 0 || stretch.first == 0 || last == 0 {
                    own[0] = Some(value);
                }
                if k < last || stretch.first + k + 1 == q.len() || last == 0 {
                    own[1] = Some(value);
                }
            }
        }
        let lengths: Vec<f64> = q.windows(2).map(|leg| (leg[1] - leg[0]).norm()).collect();
        Ok(joined(&values, &lengths, self.joint.rest))
    }

    /// Returns the required angles at a waypoint that represents these nodes.
    fn angles(&self, line: &Line, nodes: &Nodes, [first, last]: [usize; 2]) -> Angles {
        let offset = match self.guide.angle {
            ToolAngle::Fixed(angle) => return Angles { ends: [Some(angle); 2], is_stop: false },
            ToolAngle::Tangent(offset) => offset,
        };
        let heading = |part: Option<usize>, end: usize| {
            let part = part.and_then(|part| nodes.parts.get(part))?;
            let piece = &line.pieces[part.piece];
            if piece.is_travel { None } else { piece.curve.heading(part.ends[end]) }
        };
        let is_repeated = first > last;
        let ends = [heading(first.min(last).checked_sub(1), 1), heading(Some(last), 0)];
        let is_end = first == 0 || last + 1 == nodes.nodes.len();
        let is_sharp = !is_end && (first < last || is_sharp(ends[0], ends[1], self.guide.tolerance));
        let is_stop = is_sharp && !is_repeated;
        let ends = match ends {
            _ if is_stop => ends,
            [_, after] if is_sharp => [after; 2],
            [Some(before), Some(after)] => [Some(before + wrapped(after - before) / 2.0); 2],
            [before, after] => [before.or(after); 2],
        };
        Angles { ends: ends.map(|angle| Some(angle? + offset)), is_stop }
    }

    /// Returns the whole turns to add to the values of each stretch, radians. They minimise the turns between stretches.
    fn shifts(&self, stretches: &[Stretch]) -> Result<Vec<f64>, usize> {
        // For each stretch, its possible shifts. Each has the least cost so far, and the choice for the previous stretch.
        let mut table: Vec<Vec<(f64, f64, usize)>> = Vec::new();
        for (k, stretch) in stretches.iter().enumerate() {
            let ends = |k: usize| [stretches[k].values[0], stretches[k].values[stretches[k].values.len() - 1]];
            let from: Vec<(f64, f64)> = match table.last() {
                None => vec![(self.joint.rest, 0.0)],
                Some(row) => row.iter().map(|(shift, cost, _)| (ends(k - 1)[1] + shift, *cost)).collect(),
            };
            let near = from.iter().map(|(value, _)| ((value - ends(k)[0]) / TAU).round());
            let candidates = self.candidates(stretch, near.collect())?;
            let weight = if k == 0 { REST_SHARE } else { 1.0 };
            let best = |shift: f64| {
                let cost = |(value, cost): &(f64, f64)| cost + weight * (ends(k)[0] + shift - value).abs();
                let costs = from.iter().map(cost).enumerate();
                let (before, cost) = costs.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0));
                (shift, cost, before)
            };
            table.push(candidates.into_iter().map(best).collect());
        }
        let mut shifts = Vec::new();
        let last = table.last().into_iter().flat_map(|row| row.iter().enumerate());
        let mut choice = last.min_by(|a, b| a.1.1.total_cmp(&b.1.1)).map_or(0, |(k, _)| k);
        for row in table.iter().rev() {
            let (shift, _, before) = row[choice];
            shifts.push(shift);
            choice = before;
        }
        shifts.reverse();
        Ok(shifts)
    }

    /// Returns the whole turns that bring all values of a stretch into the range, radians. Without limits, returns `near`.
    fn candidates(&self, stretch: &Stretch, mut near: Vec<f64>) -> Result<Vec<f64>, usize> {
        let JointRange::Interval { lower, upper } = self.joint.range else {
            near.dedup();
            return Ok(near.into_iter().map(|turns| turns * TAU).collect());
        };
        let [lower, upper] = [lower - LIMIT_ROUNDING, upper + LIMIT_ROUNDING];
        let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut turns = [0.0; 2];
        for (k, value) in stretch.values.iter().enumerate() {
            (least, greatest) = (least.min(*value), greatest.max(*value));
            turns = [((lower - least) / TAU).ceil(), ((upper - greatest) / TAU).floor()];
            if turns[0] > turns[1] {
                return Err(stretch.first + k);
            }
        }
        let [first, last] = turns.map(|turns| turns.clamp(-MAX_TURNS, MAX_TURNS));
        Ok((0..=(last - first) as u32).map(|k| (first + f64::from(k)) * TAU).collect())
    }
}

/// Splits the waypoints into stretches between stops and travels, with the joint's values up to whole turns of each stretch.
fn stretches(angles: &[Angles], value: &dyn Fn(usize, f64) -> f64) -> Vec<Stretch> {
    let mut stretches = Vec::new();
    let mut open: Option<(Stretch, f64)> = None;
    for (waypoint, Angles { ends: [arrival, departure], is_stop }) in angles.iter().enumerate() {
        let is_first = waypoint == 0;
        if let Some((mut stretch, before)) = open.take() {
            let Some(arrival) = *arrival else {
                stretches.push(stretch);
                open = departure.map(|angle| (begun(waypoint, angle, value), angle));
                continue;
            };
            let angle = before + wrapped(arrival - before);
            stretch.values.push(value(waypoint, angle));
            if *is_stop || departure.is_none() {
                stretches.push(stretch);
                open = departure.map(|angle| (begun(waypoint, angle, value), angle));
            } else {
                open = Some((stretch, angle));
            }
        } else if let Some(angle) = departure.or(arrival.filter(|_| is_first)) {
            open = Some((begun(waypoint, angle, value), angle));
        }
    }
    stretches.extend(open.map(|(stretch, _)| stretch).filter(|stretch| stretch.values.len() > 1 || angles.len() == 1));
    stretches
}

fn begun(first: usize, angle: f64, value: &dyn Fn(usize, f64) -> f64) -> Stretch {
    Stretch { first, values: vec![value(first, angle)] }
}

/// Fills in the values on travels: the joint turns evenly over the length of the legs. Without any value, it stays at `rest`.
fn joined(values: &[[Option<f64>; 2]], lengths: &[f64], rest: f64) -> Vec<[f64; 2]> {
    let mut distance = vec![0.0];
    lengths.iter().for_each(|length| distance.push(distance[distance.len() - 1] + length));
    let flat: Vec<(f64, Option<f64>)> =
        values.iter().zip(&distance).flat_map(|(ends, at)| ends.map(|value| (*at, value))).collect();
    let filled = |k: usize| {
        let (at, own) = flat[k];
        let known = |(at, value): &(f64, Option<f64>)| Some((*at, (*value)?));
        let before = flat[..k].iter().rev().find_map(known);
        let after = flat[k..].iter().find_map(known);
        match (own, before, after) {
            (Some(value), ..) => value,
            (None, Some((from, a)), Some((to, b))) if to > from => a + (b - a) * ((at - from) / (to - from)),
            (None, Some((_, value)), _) | (None, None, Some((_, value))) => value,
            (None, None, None) => rest,
        }
    };
    (0..values.len()).map(|waypoint| [filled(2 * waypoint), filled(2 * waypoint + 1)]).collect()
}
