//! About the shortest path in the homotopy class of another: a string pulled taut through exact rows.
//!
//! At chosen values of `q1` the free values of `q2` are known exactly ([`Rows`]). The string passes these intervals in the
//! order in which the given way does, straight between them. Between rows the boundary may bulge by what its second
//! difference tells, so the intervals are narrowed by that: a slack of second order in the spacing. Whether the path is
//! free is for [`crate::certify`] to say; rows are added where it says no, and where the string touches.

use crate::certify::{CertifiedPath, Rejection, certify};
use crate::cspace::{Row, Rows};
use crate::geometry::Point;
use crate::model::Scene;
use crate::plan::{Passage, taut_string};
use crate::space::{Configuration, Path};

/// First distance between rows, in the unit of joint 1: some hundred rows a turn.
const SPACING: f64 = 0.04;

/// Attempts, each with more rows than the one before.
const ATTEMPTS: usize = 48;

/// Share of the second difference of a boundary by which intervals are narrowed: an eighth is the bulge of a parabola,
/// the rest is for boundaries that bend more between the rows than at them.
const BULGE: f64 = 0.2;

/// No boundary is taken to bulge by more than this times the square of the spacing: beyond, it is a jump from one
/// obstacle to another or a corner, at which rows are added should the certificate fail.
const MOST_BULGE: f64 = 2.0;

/// A free interval of one row, and where the way passes it.
#[derive(Clone, Copy)]
struct Gate {
    q1: f64,
    /// A value of `q2` on the way.
    within: f64,
    /// All free values about it, unwrapped.
    free: [f64; 2],
    /// By how many times their boundaries' bulge they are narrowed.
    slack: f64,
}

/// About the shortest path in the class of a way, given by places on it from start to goal: within `tolerance` (a share
/// of its length) of the shortest, as far as adding rows tells, and certified. It keeps the share `kept` of the arm's reach
/// beyond the clearance from obstacles: room for the certificate. None if the attempt fails, or takes more than `most_rows`.
pub(super) fn pulled_taut(
    scene: &Scene,
    way: &[Configuration],
    tolerance: f64,
    kept: f64,
    most_rows: usize,
) -> Option<CertifiedPath> {
    let (&[start, ..], &[.., goal]) = (way, way) else { return None };
    let clearance = scene.workspace().clearance;
    let mut source =
        Source { rows: Rows::new(scene), row: Row::default(), grow: clearance + kept * scene.arm().reach() };
    let mut gates = source.gates(way)?;
    let mut before = f64::INFINITY;
    for _ in 0..ATTEMPTS {
        let path = string([start, goal], &gates);
        let length = path.length();
        let settled = (before - length).abs() <= tolerance / 2.0 * length;
        before = length;
        let mut where_to: Vec<f64> = Vec::new();
        if settled {
            match certify(scene, path, clearance) {
                Ok(certified) => return Some(certified),
                Err(Rejection::TooClose(nearest) | Rejection::Undecided(nearest)) => where_to.push(nearest.at[0]),
                Err(Rejection::OutOfLimits { .. }) => return None,
            }
        } else {
            let touched = &path.waypoints()[1..path.waypoints().len().max(2) - 1];
            where_to.extend(touched.iter().map(|q| q[0]));
            where_to.sort_by(f64::total_cmp);
        }
        if gates.len() + 2 * where_to.len() > most_rows {
            return None;
        }
        // A string that is rejected keeps farther away there.
        gates = source.finer(&gates, &where_to, if settled { 2.0 } else { 1.0 })?;
    }
    None
}

/// Makes gates.
struct Source<'a> {
    rows: Rows<'a>,
    row: Row,
    grow: f64,
}

impl Source<'_> {
    /// Gates at the places and between them.
    fn gates(&mut self, places: &[Configuration]) -> Option<Vec<Gate>> {
        let mut gates = Vec::new();
        for pair in places.windows(2) {
            let step = pair[1] - pair[0];
            let n = (step[0].abs() / SPACING).ceil().max(1.0) as usize;
            for i in 0..n {
                let at = pair[0] + step * (i as f64 / n as f64);
                gates.push(self.gate(at)?);
            }
        }
        gates.push(self.gate(*places.last()?)?);
        Some(gates)
    }

    /// More gates on either side of those at the given values of `q1`, ascending; there the slack is so many times greater.
    fn finer(&mut self, gates: &[Gate], where_to: &[f64], slack: f64) -> Option<Vec<Gate>> {
        let mut finer: Vec<Gate> = Vec::with_capacity(gates.len() + 2 * where_to.len());
        finer.extend(gates.first());
        for pair in gates.windows(2) {
            let (low, high) = (pair[0].q1.min(pair[1].q1), pair[0].q1.max(pair[1].q1));
            let from = where_to.partition_point(|&q1| q1 < low);
            if low < high && where_to.get(from).is_some_and(|&q1| q1 <= high) {
                let within = (pair[0].within + pair[1].within) / 2.0;
                let between = self.gate(Configuration::new((low + high) / 2.0, within))?;
                let last = finer.len() - 1;
                finer[last].slack = finer[last].slack.max(slack * pair[0].slack);
                finer.push(Gate { slack: slack * pair[0].slack.max(pair[1].slack), ..between });
                finer.push(Gate { slack: slack * pair[1].slack, ..pair[1] });
            } else {
                finer.push(pair[1]);
            }
        }
        Some(finer)
    }

    /// The free interval about `at`; none if that is blocked.
    fn gate(&mut self, at: Configuration) -> Option<Gate> {
        let topology = self.rows.scene().arm().topology();
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
            return Some(Gate { q1: at[0], within: at[1], free: [at[1]; 2], slack: 1.0 });
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
        Some(Gate { q1: at[0], within: at[1], free: free.map(|end| end + turn), slack: 1.0 })
    }
}

/// The string through the gates, each narrowed by its slack.
fn string(ends: [Configuration; 2], gates: &[Gate]) -> Path {
    let inner = 1..gates.len().max(2) - 1;
    let passages: Vec<Passage> = inner.filter_map(|i| passage(&gates[i - 1..=i + 1])).collect();
    let string = taut_string(Point::from(ends[0]), Point::from(ends[1]), &passages);
    Path::new(string.into_iter().map(|p| p.coords).collect())
}

/// The middle one of three gates as a door; none where the way turns back, and those before and after tell.
fn passage(gates: &[Gate]) -> Option<Passage> {
    let [before, gate, after] = gates else { return None };
    let slack = gate.slack;
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
