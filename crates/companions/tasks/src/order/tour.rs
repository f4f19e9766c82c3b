//! Good orders for groups that have too many orders to try all.

use super::super::heuristic::{Stop, Stops};
use super::super::least_time::least_time;
use super::condition::Condition;
use cplan_geometry::OrderedF64;
use cplan_handling::Task;
use cplan_model::Arm;
use cplan_model::space::Configuration;

/// Greatest length of a run of pairs that is moved to another position when an order is improved.
const MAX_MOVED_RUN: usize = 3;

/// Largest number of pairs in all orders that are evaluated, counted together. Their evaluation takes some tenths of a
/// second.
const MAX_EVALUATED_PAIRS: usize = 20_000_000;

/// Largest number of pairs for which the table of times between them is computed. A larger table would not fit into
/// memory. Larger groups keep their order.
const MAX_TABLE_PAIRS: usize = 300;

/// Times of motions between the stops of a group, in seconds. For each IK solution they are lower bounds without
/// obstacles; learned times are added to them. If the IK solutions of a stop are unknown, times to and from it are 0.
pub(super) struct Tour {
    /// Times from the beginning of the group to the pick of each pair.
    entry: Vec<Vec<f64>>,
    /// Times from the pick of each pair to its place, for the IK solutions of both.
    carry: Vec<Vec<Vec<f64>>>,
    /// Times from the place of one pair to the pick of another, for the IK solutions of both.
    transfer: Vec<Vec<Vec<Vec<f64>>>>,
    /// Times from the place of each pair to the step after the group.
    exit: Vec<Vec<f64>>,
    /// Learned times, in seconds. They state, for the motion that carries each pair's object, how much longer than in
    /// `carry` the planned motion takes.
    extra_carry_times: Vec<f64>,
    /// Learned times, in seconds. They state, for the motion between two pairs, how much longer than in `transfer` the
    /// planned motion takes. A time that is not known counts as half the mean of the known times.
    extra_transfer_times: Vec<Vec<Option<f64>>>,
    unknown_extra_time: f64,
}

/// Merit of an order, where less is better: the number of violated conditions, then the duration in seconds.
pub(super) type Merit = (usize, OrderedF64);

impl Tour {
    /// Creates the times for the group at the item `index` of a task with these stops. `None` if the item is no group
    /// or is too large.
    pub fn new(task: &Task, stops: &[Stops], index: usize) -> Option<Self> {
        let Stops::Pairs(pairs) = &stops[index] else { return None };
        if pairs.len() > MAX_TABLE_PAIRS {
            return None;
        }
        let entry = match index.checked_sub(1).map(|before| &stops[before]) {
            None => Some(vec![task.start]),
            Some(Stops::One(stop)) => stop.ik_solutions.clone(),
            Some(_) => None,
        };
        let exit = match stops.get(index + 1) {
            Some(Stops::One(stop)) => stop.ik_solutions.clone(),
            _ => None,
        };
        let arm = &task.arm;
        let to_stop =
            |from: Option<&[Configuration]>, to: &Stop| bounds_between(arm, from, to.ik_solutions.as_deref(), to.speed);
        let least = |times: Vec<Vec<f64>>| -> Vec<f64> {
            let column = |at: usize| times.iter().map(|row| row[at]).fold(f64::INFINITY, f64::min);
            (0..times.first().map_or(0, Vec::len)).map(column).collect()
        };
        let shortest = |row: Vec<f64>| row.into_iter().fold(f64::INFINITY, f64::min);
        Some(Self {
            entry: pairs.iter().map(|[pick, _]| least(to_stop(entry.as_deref(), pick))).collect(),
            carry: pairs.iter().map(|[pick, place]| to_stop(pick.ik_solutions.as_deref(), place)).collect(),
            transfer: pairs
                .iter()
                .map(|[_, place]| pairs.iter().map(|[pick, _]| to_stop(place.ik_solutions.as_deref(), pick)).collect())
                .collect(),
            exit: pairs
                .iter()
                .map(|[_, place]| {
                    bounds_between(arm, place.ik_solutions.as_deref(), exit.as_deref(), 1.0)
                        .into_iter()
                        .map(shortest)
                        .collect()
                })
                .collect(),
            extra_carry_times: vec![0.0; pairs.len()],
            extra_transfer_times: vec![vec![None; pairs.len()]; pairs.len()],
            unknown_extra_time: 0.0,
        })
    }

    /// Records that a motion takes `more` seconds longer than without obstacles. It is the motion that carries a pair's
    /// object.
    pub fn learn_carry(&mut self, pair: usize, more: f64) {
        self.extra_carry_times[pair] = more;
    }

    /// Records that the motion from one pair's place to another's pick takes `more` seconds longer than without
    /// obstacles.
    pub fn learn_transfer(&mut self, from: usize, to: usize, more: f64) {
        self.extra_transfer_times[from][to] = Some(more);
        let known = || self.extra_transfer_times.iter().flatten().flatten();
        self.unknown_extra_time = known().sum::<f64>() / (2 * known().count()) as f64;
    }

    /// Returns the duration of the pairs in this order, in seconds: the shortest path through the layers of IK
    /// solutions, plus the learned times.
    pub fn seconds(&self, order: &[usize]) -> f64 {
        let Some(&first) = order.first() else { return 0.0 };
        let mut times = self.entry[first].clone();
        let mut next = Vec::new();
        for (at, &pair) in order.iter().enumerate() {
            propagate_times(&mut times, &self.carry[pair], &mut next);
            if let Some(&following) = order.get(at + 1) {
                propagate_times(&mut times, &self.transfer[pair][following], &mut next);
            } else {
                times.iter_mut().zip(&self.exit[pair]).for_each(|(time, exit)| *time += exit);
            }
        }
        let more =
            |transfer: &[usize]| self.extra_transfer_times[transfer[0]][transfer[1]].unwrap_or(self.unknown_extra_time);
        let more = order.windows(2).map(more).chain(order.iter().map(|&pair| self.extra_carry_times[pair]));
        times.into_iter().fold(f64::INFINITY, f64::min) + more.sum::<f64>()
    }

    /// Returns the merit of an order. If it violates more than `most` conditions, the duration is not computed.
    fn merit(&self, order: &[usize], conditions: &[Condition], most: usize) -> Merit {
        let mut places = vec![0; order.len()];
        order.iter().enumerate().for_each(|(at, &pair)| places[pair] = at);
        let broken = conditions.iter().filter(|condition| !condition.holds(&places)).count();
        (broken, OrderedF64(if broken > most { f64::INFINITY } else { self.seconds(order) }))
    }

    /// Improves an order until no change helps. It makes the first change that helps, again and again. A change moves a
    /// run of up to [`MAX_MOVED_RUN`] pairs to another position, or reverses a run of any length.
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
                    // All changes of this round start from the same order.
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

/// Computes the least times after a stage of the order from those before it.
fn propagate_times(times: &mut Vec<f64>, stage: &[Vec<f64>], next: &mut Vec<f64>) {
    next.clear();
    next.resize(stage.first().map_or(0, Vec::len), f64::INFINITY);
    for (time, row) in times.iter().zip(stage) {
        for (least, transfer) in next.iter_mut().zip(row) {
            *least = least.min(time + transfer);
        }
    }
    std::mem::swap(times, next);
}

/// Returns lower bounds on the times between IK solutions, in seconds; 0 if they are unknown.
fn bounds_between(
    arm: &Arm,
    from: Option<&[Configuration]>,
    to: Option<&[Configuration]>,
    speed: f64,
) -> Vec<Vec<f64>> {
    let seconds = |row: usize, column: usize| match (from, to) {
        (Some(from), Some(to)) => least_time(arm, from[row], to[column], speed),
        _ => 0.0,
    };
    let count = |ik_solutions: Option<&[Configuration]>| ik_solutions.map_or(1, <[_]>::len);
    (0..count(from)).map(|row| (0..count(to)).map(|column| seconds(row, column)).collect()).collect()
}
