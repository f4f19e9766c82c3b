//! Good orders for groups that are too large to try all.

use super::super::heuristic::{Stop, Stops};
use super::super::least_time::least_time;
use super::condition::Condition;
use cplan_core::model::Arm;
use cplan_core::space::Configuration;
use cplan_geometry::OrderedF64;
use cplan_handling::Task;

/// Longest run of pairs that is moved elsewhere.
const MAX_MOVED_RUN: usize = 3;

/// Largest total number of pairs in all orders that are evaluated: some tenths of a second of work.
const MAX_EVALUATED_PAIRS: usize = 20_000_000;

/// Largest number of pairs for which the table of times between them fits in memory. Larger groups keep their order.
const MAX_TABLE_PAIRS: usize = 300;

/// The times of a group without obstacles, by IK solutions, and the extra times learned since. An unknown IK solution
/// counts as one that takes no time.
pub(super) struct Tour {
    /// From the beginning of the group to the pick of each pair.
    entry: Vec<Vec<f64>>,
    /// From the pick of each pair to its place, by the IK solutions of pick and place.
    carry: Vec<Vec<Vec<f64>>>,
    /// From the place of one pair to the pick of another.
    transfer: Vec<Vec<Vec<Vec<f64>>>>,
    /// From the place of each pair to the step after the group.
    exit: Vec<Vec<f64>>,
    /// Extra seconds of motions that have been planned, beyond these times: for carrying each pair, ...
    carry_more: Vec<f64>,
    /// ... and from the place of one to the pick of another. Unknown ones count as half the mean of the known ones.
    way_more: Vec<Vec<Option<f64>>>,
    unknown_more: f64,
}

/// Merit of an order: the number of violated conditions, then seconds.
pub(super) type Merit = (usize, OrderedF64);

impl Tour {
    /// Creates the tour for the group with index `index` in a task with these stops. `None` if that item is not a
    /// group, or is too large.
    pub fn new(task: &Task, stops: &[Stops], index: usize) -> Option<Self> {
        let Stops::Pairs(pairs) = &stops[index] else { return None };
        if pairs.len() > MAX_TABLE_PAIRS {
            return None;
        }
        let entry = match index.checked_sub(1).map(|before| &stops[before]) {
            None => Some(vec![task.start]),
            Some(Stops::One(stop)) => stop.ik_solutions().map(<[_]>::to_vec),
            Some(_) => None,
        };
        let exit = match stops.get(index + 1) {
            Some(Stops::One(stop)) => stop.ik_solutions().map(<[_]>::to_vec),
            _ => None,
        };
        let arm = &task.arm;
        let to_stop = |from: Option<&[Configuration]>, to: &Stop| between(arm, from, to.ik_solutions(), to.speed());
        let least = |times: Vec<Vec<f64>>| -> Vec<f64> {
            let column = |at: usize| times.iter().map(|row| row[at]).fold(f64::INFINITY, f64::min);
            (0..times.first().map_or(0, Vec::len)).map(column).collect()
        };
        let shortest = |row: Vec<f64>| row.into_iter().fold(f64::INFINITY, f64::min);
        Some(Self {
            entry: pairs.iter().map(|[pick, _]| least(to_stop(entry.as_deref(), pick))).collect(),
            carry: pairs.iter().map(|[pick, place]| to_stop(pick.ik_solutions(), place)).collect(),
            transfer: pairs
                .iter()
                .map(|[_, place]| pairs.iter().map(|[pick, _]| to_stop(place.ik_solutions(), pick)).collect())
                .collect(),
            exit: pairs
                .iter()
                .map(|[_, place]| {
                    between(arm, place.ik_solutions(), exit.as_deref(), 1.0).into_iter().map(shortest).collect()
                })
                .collect(),
            carry_more: vec![0.0; pairs.len()],
            way_more: vec![vec![None; pairs.len()]; pairs.len()],
            unknown_more: 0.0,
        })
    }

    /// Records that the motion which carries a pair's object takes `more` seconds longer than without obstacles.
    pub fn learn_carry(&mut self, pair: usize, more: f64) {
        self.carry_more[pair] = more;
    }

    /// Records that the motion from one pair's place to another's pick takes `more` seconds longer than without
    /// obstacles.
    pub fn learn_transfer(&mut self, from: usize, to: usize, more: f64) {
        self.way_more[from][to] = Some(more);
        let known = || self.way_more.iter().flatten().flatten();
        self.unknown_more = known().sum::<f64>() / (2 * known().count()) as f64;
    }

    /// Returns the seconds for the pairs in this order: the shortest path through the layers of IK solutions, plus the
    /// learned extra times.
    pub fn seconds(&self, order: &[usize]) -> f64 {
        let Some(&first) = order.first() else { return 0.0 };
        let mut times = self.entry[first].clone();
        let mut next = Vec::new();
        for (at, &pair) in order.iter().enumerate() {
            through(&mut times, &self.carry[pair], &mut next);
            if let Some(&following) = order.get(at + 1) {
                through(&mut times, &self.transfer[pair][following], &mut next);
            } else {
                times.iter_mut().zip(&self.exit[pair]).for_each(|(time, exit)| *time += exit);
            }
        }
        let more = |transfer: &[usize]| self.way_more[transfer[0]][transfer[1]].unwrap_or(self.unknown_more);
        let more = order.windows(2).map(more).chain(order.iter().map(|&pair| self.carry_more[pair]));
        times.into_iter().fold(f64::INFINITY, f64::min) + more.sum::<f64>()
    }

    /// Returns the merit of an order. Seconds are not computed if it violates more than `most` conditions.
    fn merit(&self, order: &[usize], conditions: &[Condition], most: usize) -> Merit {
        let mut places = vec![0; order.len()];
        order.iter().enumerate().for_each(|(at, &pair)| places[pair] = at);
        let broken = conditions.iter().filter(|condition| !condition.holds(&places)).count();
        (broken, OrderedF64(if broken > most { f64::INFINITY } else { self.seconds(order) }))
    }

    /// Improves the order until no change helps, taking the first improvement found. A change moves a run of up to
    /// [`MAX_MOVED_RUN`] pairs elsewhere, or reverses a run.
    pub fn improved(&self, mut order: Vec<usize>, conditions: &[Condition]) -> (Vec<usize>, Merit) {
        let count = order.len();
        let mut best = self.merit(&order, conditions, usize::MAX);
        let mut left = MAX_EVALUATED_PAIRS / count.max(1);
        let mut tried = order.clone();
        loop {
            let before = best;
            for first in 0..count {
                for last in first..count {
                    let run = last - first + 1;
                    let moves = if run <= MAX_MOVED_RUN { count - run + 1 } else { 0 };
                    // All of these changes start from the same order.
                    let from = order.clone();
                    for change in 0..=moves {
                        if left == 0 {
                            return (order, best);
                        }
                        tried.clone_from(&from);
                        match change.checked_sub(1) {
                            None => tried[first..=last].reverse(),
                            Some(to) if to <= first => tried[to..=last].rotate_right(run),
                            Some(to) => tried[first..to + run].rotate_left(run),
                        }
                        if tried == from {
                            continue;
                        }
                        left -= 1;
                        let merit = self.merit(&tried, conditions, best.0);
                        if merit < best {
                            best = merit;
                            order.clone_from(&tried);
                        }
                    }
                }
            }
            if best >= before {
                return (order, best);
            }
        }
    }
}

/// Computes the times after a stage from those before it.
fn through(times: &mut Vec<f64>, stage: &[Vec<f64>], next: &mut Vec<f64>) {
    next.clear();
    next.resize(stage.first().map_or(0, Vec::len), f64::INFINITY);
    for (time, row) in times.iter().zip(stage) {
        for (least, transfer) in next.iter_mut().zip(row) {
            *least = least.min(time + transfer);
        }
    }
    std::mem::swap(times, next);
}

/// Returns the least seconds between IK solutions; zero if they are unknown.
fn between(arm: &Arm, from: Option<&[Configuration]>, to: Option<&[Configuration]>, speed: f64) -> Vec<Vec<f64>> {
    let seconds = |row: usize, column: usize| match (from, to) {
        (Some(from), Some(to)) => least_time(arm, from[row], to[column], speed),
        _ => 0.0,
    };
    let count = |ik_solutions: Option<&[Configuration]>| ik_solutions.map_or(1, <[_]>::len);
    (0..count(from)).map(|row| (0..count(to)).map(|column| seconds(row, column)).collect()).collect()
}
