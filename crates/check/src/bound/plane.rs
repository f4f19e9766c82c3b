//! Copies of walls on all turns, and the legs that they block.

use super::places::{COARSE_SHIFT, Line, Place, WallCopy, WallRun, is_less, runs};
use crate::certificate::{Bound, Metric};
use crate::decimal::Decimal;
use crate::domain::{Axis, Rectangle};
use crate::error::CheckError;
use crate::interval::{Interval, double};
use num_bigint::{BigInt, Sign};
use std::cell::Cell;
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

/// Maximum number of copies of walls, on all turns, that a path of the certified length can reach.
const MAX_COPIES: usize = 200_000;

/// An end of a wall at which shortest paths may turn.
pub(super) struct Corner {
    name: (usize, usize, [i64; 2]),
    at: Place,
    /// Lower bound on the length of paths from the corner to a goal.
    rest: BigInt,
    /// Claimed lower bound on the length of paths from the start to the corner. `None` stands for the certified length
    /// minus `rest`.
    potential: Option<BigInt>,
}

/// Copies of walls and goals that paths of the certified length can reach.
pub(super) struct Plane<'a> {
    metric: &'a Metric,
    length: Interval,
    start: Place,
    /// Copies of walls, sorted by their least value of joint 1.
    copies: Vec<WallCopy>,
    /// Greatest extent of a wall along joint 1, in coarse units.
    widest: i64,
    runs: BTreeMap<Line, Vec<WallRun>>,
    goals: Vec<Place>,
}

impl<'a> Plane<'a> {
    pub(super) fn new(
        bound: &'a Bound,
        axes: [&Axis; 2],
        start: &Rectangle,
        goals: &[Rectangle],
    ) -> Result<Self, CheckError> {
        let metric = &bound.metric;
        let length = Interval::from(&bound.length);
        let too_long = || {
            CheckError::Fails(format!(
                "the length {} is too large: the checker would have too many cases",
                bound.length
            ))
        };
        let from = Place::new(metric, start, [0, 0]).ok_or_else(too_long)?;
        // The copies of a rectangle that paths of the certified length can reach.
        let copies = |rectangle: &Rectangle| -> Option<Vec<([i64; 2], Place)>> {
            let turns = [0, 1].map(|k| {
                let Axis::Circle = axes[k] else { return Some(0..=0) };
                let (turn, value) =
                    (metric.scaled(k, &double(Interval::pi())), metric.scaled(k, &Interval::enclosing(&rectangle[k])));
                // One more turn on either side covers rounding.
                let reach = metric.reach(k, &length.upper);
                let least = (&from.at[k].lower - &reach - &value.upper) / &turn.lower - 1;
                let most = (&from.at[k].upper + &reach - &value.lower) / &turn.lower + 1;
                Some(i64::from(i32::try_from(least).ok()?)..=i64::from(i32::try_from(most).ok()?))
            });
            let [first, second] = turns;
            let (first, second) = (first?, second?);
            let count = |range: &RangeInclusive<i64>| range.end().abs_diff(*range.start()).saturating_add(1);
            if count(&first).saturating_mul(count(&second)) > MAX_COPIES as u64 {
                return None;
            }
            let pairs = first.flat_map(|a| second.clone().map(move |b| [a, b]));
            pairs.map(|turns| Some((turns, Place::new(metric, rectangle, turns)?))).collect()
        };
        let mut walls = Vec::new();
        for (number, wall) in bound.walls.iter().enumerate() {
            let whole =
                [0, 1].map(|k| [(&wall.from[k]).min(&wall.to[k]).clone(), (&wall.from[k]).max(&wall.to[k]).clone()]);
            for (turns, _) in copies(&whole).ok_or_else(too_long)? {
                let end = |at: &[Decimal; 2]| Place::new(metric, &at.each_ref().map(|v| [v.clone(), v.clone()]), turns);
                let (Some(a), Some(b)) = (end(&wall.from), end(&wall.to)) else { return Err(too_long()) };
                walls.push(WallCopy { wall: number, turns, ends: [a, b] });
            }
            if walls.len() > MAX_COPIES {
                return Err(too_long());
            }
        }
        let mut everywhere = Vec::new();
        for goal in goals {
            everywhere.extend(copies(goal).ok_or_else(too_long)?.into_iter().map(|(_, place)| place));
        }
        walls.sort_by_key(WallCopy::begins);
        let widest = walls.iter().map(|copy| copy.stops() - copy.begins()).max().unwrap_or(0);
        let runs = runs(&walls);
        Ok(Self { metric, length, start: from, copies: walls, widest, runs, goals: everywhere })
    }

    /// Returns the corners at which a path shorter than the certified length may turn.
    pub(super) fn corners(&self, bound: &Bound, axes: [&Axis; 2]) -> Result<Vec<Corner>, CheckError> {
        let mut potentials = BTreeMap::new();
        for (number, potential) in bound.potentials.iter().enumerate() {
            let value = Interval::from(&potential.value).upper;
            if potential.wall >= bound.walls.len() || potential.end > 1 {
                return CheckError::fails(format!("potential {number}: the wall or the end does not exist"));
            }
            if potentials.insert((potential.wall, potential.end, potential.turns), value).is_some() {
                return CheckError::fails(format!("potential {number}: this corner already has a potential"));
            }
        }
        let mut corners = Vec::new();
        for copy in &self.copies {
            let wall = &bound.walls[copy.wall];
            for (end, values) in [&wall.from, &wall.to].into_iter().enumerate() {
                let at = &copy.ends[end];
                let is_outside = |k: usize| match axes[k] {
                    Axis::Line([low, high]) => values[k] <= *low || values[k] >= *high,
                    Axis::Circle => false,
                };
                let runs = at.line.as_ref().and_then(|line| self.runs.get(line));
                let is_within = |run: &WallRun| is_less(&run.ends[0], &at.at[1]) && is_less(&at.at[1], &run.ends[1]);
                if is_outside(0) || is_outside(1) || runs.is_some_and(|runs| runs.iter().any(is_within)) {
                    continue;
                }
                let rest = self.goals.iter().map(|goal| self.metric.length_bound(&at.at, &goal.at)).min();
                let Some(rest) = rest else { continue };
                if self.metric.length_bound(&self.start.at, &at.at) + &rest >= self.length.upper {
                    continue;
                }
                let name = (copy.wall, end, copy.turns);
                let potential = potentials.remove(&name).filter(|value| value + &rest < self.length.lower);
                corners.push(Corner { name, at: at.clone(), rest, potential });
            }
        }
        Ok(corners)
    }

    /// Checks that the potential grows along each leg by at most the leg's length, unless walls block the leg.
    ///
    /// # Errors
    /// A leg along which the potential grows too much.
    pub(super) fn check_potentials(&self, corners: &[Corner]) -> Result<(), CheckError> {
        let claimed: Vec<BigInt> = corners
            .iter()
            .map(|corner| corner.potential.clone().unwrap_or_else(|| &self.length.upper - &corner.rest))
            .collect();
        let sources = corners.iter().filter_map(|c| Some((&c.at, c.potential.as_ref()?, Some(c.name))));
        let none = BigInt::ZERO;
        for (at, potential, name) in sources.chain([(&self.start, &none, None)]) {
            // A wall that blocks one leg often blocks other legs from the same place.
            let latest = Cell::new(0);
            let bars = |to: &Place| self.bars(at, to, &latest);
            let from = || name.map_or_else(|| "the start".to_owned(), end_name);
            for goal in &self.goals {
                if !self.is_long(at, goal, &(&self.length.upper - potential)) && !bars(goal) {
                    return CheckError::fails(format!("no wall blocks the straight path from {} to a goal", from()));
                }
            }
            for (corner, claimed) in corners.iter().zip(&claimed) {
                if !self.is_long(at, &corner.at, &(claimed - potential)) && !bars(&corner.at) {
                    let message = "no wall blocks the straight path, but the potential grows by more than its length";
                    return CheckError::fails(format!("from {} to {}: {message}", from(), end_name(corner.name)));
                }
            }
        }
        Ok(())
    }

    /// Returns true if a leg has at least the given length.
    fn is_long(&self, from: &Place, to: &Place, length: &BigInt) -> bool {
        if length.sign() != Sign::Plus {
            return true;
        }
        // Compare in coarse units first, which suffices for most legs.
        let Ok(coarse) = i64::try_from((length >> COARSE_SHIFT) + 1) else { return false };
        let [x, y] = [0, 1].map(|k| {
            let ([a, b], [c, d]) = (from.coarse[k], to.coarse[k]);
            i128::from((c - b).max(a - d).max(0))
        });
        let square = i128::from(coarse).saturating_mul(coarse.into());
        let is_long = if self.metric.is_greatest() { x.max(y) >= coarse.into() } else { x * x + y * y >= square };
        is_long && self.metric.is_of_entries() || self.metric.is_at_least(&from.at, &to.at, length)
    }

    /// Returns true if walls block every straight leg from `from` to any point of `to`. A wall blocks a leg that
    /// crosses it. Walls along a leg block it if other walls touch them from both sides.
    fn bars(&self, from: &Place, to: &Place, latest: &Cell<usize>) -> bool {
        if self.copies.get(latest.get()).is_some_and(|copy| copy.crosses(from, to)) {
            return true;
        }
        let [low, high] = [from.coarse[0][0].min(to.coarse[0][0]), from.coarse[0][1].max(to.coarse[0][1])];
        let first = self.copies.partition_point(|copy| copy.begins() < low - self.widest);
        let last = self.copies.partition_point(|copy| copy.begins() <= high);
        let near = &self.copies[first..last.max(first)];
        // A wall that blocks a leg is usually near the beginning of the leg.
        let crosses = |copy: &WallCopy| copy.crosses(from, to);
        let is_onward = from.coarse[0][0] <= to.coarse[0][0];
        if let Some(at) = if is_onward { near.iter().position(crosses) } else { near.iter().rposition(crosses) } {
            latest.set(first + at);
            return true;
        }
        let Some(runs) = from.line.as_ref().filter(|_| from.line == to.line).and_then(|line| self.runs.get(line))
        else {
            return false;
        };
        let [a, b] = [&from.at[1], &to.at[1]];
        let is_passed = |y: &&Interval| is_less(a, y) && is_less(y, b) || is_less(b, y) && is_less(y, a);
        runs.iter().any(|run| run.beside.iter().all(|side| side.iter().any(|y| is_passed(&y))))
    }
}

/// Returns the name of a wall's end for messages.
fn end_name((wall, end, turns): (usize, usize, [i64; 2])) -> String {
    let end = ["begins", "ends"][end];
    match turns {
        [0, 0] => format!("where wall {wall} {end}"),
        [first, second] => format!("where wall {wall} {end}, shifted by {first} and {second} turns"),
    }
}
