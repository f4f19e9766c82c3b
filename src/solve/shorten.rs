//! About the shortest path in the homotopy class of a channel: a string pulled taut through exact rows.
//!
//! At chosen values of `q1` the free values of `q2` are known exactly ([`Rows`]). The string passes these intervals in the
//! order in which the channel does, straight between them. Between rows the boundary may bulge by what its second
//! difference tells, so the intervals are narrowed by that: a slack of second order in the spacing. Whether the path is
//! free is for [`crate::certify`] to say; rows are added where it says no, and where the string touches.

use super::Verdict;
use super::swift::{checked, decide};
use crate::certify::{CertifiedPath, Channel, Connectivity, Rejection, certify, short_slab_channel};
use crate::cspace::{Row, Rows};
use crate::geometry::Point;
use crate::model::{Problem, Scene};
use crate::plan::{Passage, taut_string};
use crate::space::{Configuration, Path};

/// First distance between rows, in the unit of joint 1: some hundred rows a turn.
const SPACING: f64 = 0.04;

/// Attempts, each with more rows than the one before.
const ATTEMPTS: usize = 12;

/// Rows at most.
const MOST_ROWS: usize = 20_000;

/// Share of the second difference of a boundary by which intervals are narrowed: an eighth is the bulge of a parabola,
/// the rest is for boundaries that bend more between the rows than at them.
const BULGE: f64 = 0.2;

/// No boundary is taken to bulge by more than this times the square of the spacing: beyond, it is a jump from one
/// obstacle to another or a corner, at which rows are added should the certificate fail.
const MOST_BULGE: f64 = 2.0;

/// Distance from obstacles that rows keep beyond the clearance asked for, as a share of the arm's reach: room for the
/// certificate.
const KEPT: f64 = 1e-5;

/// A free interval of one row, and where the channel passes it.
#[derive(Clone, Copy)]
struct Gate {
    q1: f64,
    /// A value of `q2` in the channel.
    within: f64,
    /// All free values about it, unwrapped.
    free: [f64; 2],
}

/// Answers `problem` with about the shortest path: within `tolerance` (a share of its length) of the shortest in its
/// class, as far as adding rows tells, and in the class that looks shortest at the slabs' resolution. Certified; a proof
/// where there is none; and whatever [`decide`] says where the attempt fails.
#[must_use]
pub fn shorten(problem: &Problem, tolerance: f64, slabs: usize) -> Verdict {
    let scene = &problem.scene;
    let clearance = scene.workspace.clearance;
    let found = match short_slab_channel(scene, problem.start, &problem.goals, clearance, slabs) {
        Connectivity::Connected(channel) => pulled_taut(scene, &channel, clearance, tolerance).map(Verdict::Found),
        Connectivity::Disconnected(proof) => checked(problem, proof).map(Verdict::Infeasible),
        Connectivity::Undecided { .. } => None,
    };
    found.unwrap_or_else(|| decide(problem, slabs))
}

fn pulled_taut(scene: &Scene, channel: &Channel, clearance: f64, tolerance: f64) -> Option<CertifiedPath> {
    let mut source = Source { rows: Rows::new(scene), row: Row::default(), grow: clearance + KEPT * scene.arm.reach() };
    let mut gates = source.gates(channel)?;
    let mut best: Option<CertifiedPath> = None;
    let (mut before, mut slack) = (f64::INFINITY, 1.0);
    for _ in 0..ATTEMPTS {
        let path = string(channel, &gates, slack);
        let length = path.length();
        let settled = (before - length).abs() <= tolerance / 2.0 * length;
        before = length;
        let mut where_to: Vec<f64> = Vec::new();
        if settled {
            match certify(scene, path.clone(), clearance) {
                Ok(certified) => {
                    best = Some(certified);
                    break;
                }
                Err(Rejection::TooClose(nearest) | Rejection::Undecided(nearest)) => where_to.push(nearest.at[0]),
                Err(Rejection::OutOfLimits { .. }) => break,
            }
            slack *= 2.0;
        } else {
            let touched = &path.waypoints()[1..path.waypoints().len().max(2) - 1];
            where_to.extend(touched.iter().map(|q| q[0]));
            where_to.sort_by(f64::total_cmp);
        }
        if gates.len() + 2 * where_to.len() > MOST_ROWS {
            break;
        }
        gates = source.finer(&gates, &where_to)?;
    }
    best
}

/// Makes gates.
struct Source<'a> {
    rows: Rows<'a>,
    row: Row,
    grow: f64,
}

impl Source<'_> {
    /// Gates where the channel's doors are, and between them.
    fn gates(&mut self, channel: &Channel) -> Option<Vec<Gate>> {
        // Doors across the seam of joint 2 lie within a slab; rows know no seam.
        let doors = channel.doors().iter().filter(|[left, right]| left[0] == right[0]);
        let middles = doors.map(|[left, right]| (left + right) / 2.0);
        let mut places = vec![channel.start()];
        places.extend(middles);
        places.push(channel.goal());
        let mut gates = Vec::new();
        for pair in places.windows(2) {
            let step = pair[1] - pair[0];
            let n = (step[0].abs() / SPACING).ceil().max(1.0) as usize;
            for i in 0..n {
                let at = pair[0] + step * (i as f64 / n as f64);
                gates.push(self.gate(at)?);
            }
        }
        gates.push(self.gate(channel.goal())?);
        Some(gates)
    }

    /// More gates on either side of those at the given values of `q1`, ascending.
    fn finer(&mut self, gates: &[Gate], where_to: &[f64]) -> Option<Vec<Gate>> {
        let mut finer = Vec::with_capacity(gates.len() + 2 * where_to.len());
        for pair in gates.windows(2) {
            finer.push(pair[0]);
            let (low, high) = (pair[0].q1.min(pair[1].q1), pair[0].q1.max(pair[1].q1));
            let from = where_to.partition_point(|&q1| q1 < low);
            if low < high && where_to.get(from).is_some_and(|&q1| q1 <= high) {
                let within = (pair[0].within + pair[1].within) / 2.0;
                finer.push(self.gate(Configuration::new((low + high) / 2.0, within))?);
            }
        }
        finer.extend(gates.last());
        Some(finer)
    }

    /// The free interval about `at`; none if that is blocked.
    fn gate(&mut self, at: Configuration) -> Option<Gate> {
        let topology = self.rows.scene().arm.topology();
        let (q1, axis) = (topology.axes[0].wrap(at[0]), topology.axes[1]);
        self.rows.row(q1, self.grow, &mut self.row);
        let value = axis.wrap(at[1]);
        let turn = at[1] - value;
        let forbidden = &self.row.merged;
        let after = forbidden.partition_point(|i| i[0] <= value);
        let below = after.checked_sub(1).map(|i| forbidden[i][1]);
        let above = forbidden.get(after).map(|i| i[0]);
        if below.is_some_and(|b| b >= value) {
            // A start or goal nearer than what rows keep: passed where it is.
            return Some(Gate { q1: at[0], within: at[1], free: [at[1]; 2] });
        }
        let (lower, upper) = axis.domain();
        let round = if axis.is_circle() { axis.extent() } else { f64::INFINITY };
        let first = forbidden.first().map(|i| i[0]);
        let last = forbidden.last().map(|i| i[1]);
        let free = match (below, above) {
            (Some(b), Some(a)) => [b, a],
            (None, Some(a)) if axis.is_circle() => [last.map_or(value - round, |l| l - round), a],
            (Some(b), None) if axis.is_circle() => [b, first.map_or(value + round, |f| f + round)],
            (None, None) if axis.is_circle() => [value - round, value + round],
            (b, a) => [b.unwrap_or(lower), a.unwrap_or(upper)],
        };
        Some(Gate { q1: at[0], within: at[1], free: free.map(|end| end + turn) })
    }
}

/// The string through the gates, each narrowed by `slack` times its boundaries' bulge.
fn string(channel: &Channel, gates: &[Gate], slack: f64) -> Path {
    let inner = 1..gates.len().max(2) - 1;
    let passages: Vec<Passage> = inner.filter_map(|i| passage(&gates[i - 1..=i + 1], slack)).collect();
    let string = taut_string(Point::from(channel.start()), Point::from(channel.goal()), &passages);
    Path::new(string.into_iter().map(|p| p.coords).collect())
}

/// The middle one of three gates as a door; none where the channel turns back, and the boxes before and after tell.
fn passage(gates: &[Gate], slack: f64) -> Option<Passage> {
    let [before, gate, after] = gates else { return None };
    let (step, next) = (gate.q1 - before.q1, after.q1 - gate.q1);
    let ahead = if step == 0.0 { next } else { step };
    if ahead == 0.0 {
        return None;
    }
    // How far the boundary at the gate lies beyond the chord of its neighbours.
    let bulge = |k: usize| {
        if step * next <= 0.0 {
            return 0.0;
        }
        let share = step / (step + next);
        let chord = before.free[k] + (after.free[k] - before.free[k]) * share;
        4.0 * slack * (gate.free[k] - chord)
    };
    let [lower, upper] = gate.free;
    let room = ((upper - lower) / 4.0).max(0.0).min(slack * MOST_BULGE * (step * next).abs());
    let low = lower + (BULGE * bulge(0)).clamp(0.0, room);
    let high = upper - (BULGE * -bulge(1)).clamp(0.0, room);
    let at = |q2: f64| Point::new(gate.q1, q2);
    Some(if ahead > 0.0 {
        Passage { left: at(high), right: at(low) }
    } else {
        Passage { left: at(low), right: at(high) }
    })
}
