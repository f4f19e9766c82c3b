//! Good orders for groups that are too large to try all.

use super::super::heuristic::{Stop, Stops};
use super::super::least_time::least_time;
use super::condition::Condition;
use cplan_core::model::Arm;
use cplan_core::space::Configuration;
use cplan_geometry::Ordered;
use cplan_handling::Task;

/// Runs of up to so many pairs are moved elsewhere.
const LONGEST_RUN: usize = 3;

/// Pairs that all orders that are looked at may have together: some tenths of a second.
const MOST_VISITS: usize = 20_000_000;

/// Beyond so many pairs the table of times between them would not fit, and the order stays as it is.
const MOST_PAIRS: usize = 300;

/// The times of a group with nothing in the way, by IK solutions, and what is known beyond; an IK solution that is not known is one that takes no time.
pub(super) struct Tour {
    /// From where the group is entered to the pick of each pair.
    entry: Vec<Vec<f64>>,
    /// From the pick of each pair to its place: by the pick's IK solution, then the place's.
    carry: Vec<Vec<Vec<f64>>>,
    /// From the place of one pair to the pick of another.
    way: Vec<Vec<Vec<Vec<f64>>>>,
    /// From the place of each pair to where the group is left to.
    exit: Vec<Vec<f64>>,
    /// Seconds that motions take beyond these times, where some have been planned: carrying each pair, ...
    carry_more: Vec<f64>,
    /// ... and from the place of one to the pick of another; where that is not known, half the mean of what is.
    way_more: Vec<Vec<Option<f64>>>,
    unknown_more: f64,
}

/// How good an order is: conditions that it breaks, then seconds.
pub(super) type Merit = (usize, Ordered);

impl Tour {
    /// Of the group that is item `index` of a task with these stops; none if it is no group, or too large.
    pub fn new(task: &Task, stops: &[Stops], index: usize) -> Option<Self> {
        let Stops::Pairs(pairs) = &stops[index] else { return None };
        if pairs.len() > MOST_PAIRS {
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
            way: pairs
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

    /// A motion that carries a pair's object takes so many seconds more than with nothing in the way.
    pub fn learn_carry(&mut self, pair: usize, more: f64) {
        self.carry_more[pair] = more;
    }

    /// A motion from one pair's place to another's pick takes so many seconds more than with nothing in the way.
    pub fn learn_way(&mut self, from: usize, to: usize, more: f64) {
        self.way_more[from][to] = Some(more);
        let known = || self.way_more.iter().flatten().flatten();
        self.unknown_more = known().sum::<f64>() / (2 * known().count()) as f64;
    }

    /// Seconds for the pairs in this order: the shortest way through the layers of IK solutions, and what is known beyond.
    pub fn seconds(&self, order: &[usize]) -> f64 {
        let Some(&first) = order.first() else { return 0.0 };
        let mut times = self.entry[first].clone();
        let mut next = Vec::new();
        for (at, &pair) in order.iter().enumerate() {
            through(&mut times, &self.carry[pair], &mut next);
            if let Some(&following) = order.get(at + 1) {
                through(&mut times, &self.way[pair][following], &mut next);
            } else {
                times.iter_mut().zip(&self.exit[pair]).for_each(|(time, exit)| *time += exit);
            }
        }
        let more = |way: &[usize]| self.way_more[way[0]][way[1]].unwrap_or(self.unknown_more);
        let more = order.windows(2).map(more).chain(order.iter().map(|&pair| self.carry_more[pair]));
        times.into_iter().fold(f64::INFINITY, f64::min) + more.sum::<f64>()
    }

    /// How good an order is; seconds are not looked at where it breaks more than `most` conditions.
    fn merit(&self, order: &[usize], conditions: &[Condition], most: usize) -> Merit {
        let mut places = vec![0; order.len()];
        order.iter().enumerate().for_each(|(at, &pair)| places[pair] = at);
        let broken = conditions.iter().filter(|condition| !condition.holds(&places)).count();
        (broken, Ordered(if broken > most { f64::INFINITY } else { self.seconds(order) }))
    }

    /// The order after all changes that make it better, the first found first: of moving a run of up to [`LONGEST_RUN`] pairs
    /// elsewhere, and of reversing a run.
    pub fn improved(&self, mut order: Vec<usize>, conditions: &[Condition]) -> (Vec<usize>, Merit) {
        let count = order.len();
        let mut best = self.merit(&order, conditions, usize::MAX);
        let mut left = MOST_VISITS / count.max(1);
        let mut tried = order.clone();
        loop {
            let before = best;
            for first in 0..count {
                for last in first..count {
                    let run = last - first + 1;
                    let moves = if run <= LONGEST_RUN { count - run + 1 } else { 0 };
                    // All of these changes are of the same order.
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

/// Times after a stage, of those before it.
fn through(times: &mut Vec<f64>, stage: &[Vec<f64>], next: &mut Vec<f64>) {
    next.clear();
    next.resize(stage.first().map_or(0, Vec::len), f64::INFINITY);
    for (time, row) in times.iter().zip(stage) {
        for (least, way) in next.iter_mut().zip(row) {
            *least = least.min(time + way);
        }
    }
    std::mem::swap(times, next);
}

/// Least seconds between IK solutions; none where they are not known.
fn between(arm: &Arm, from: Option<&[Configuration]>, to: Option<&[Configuration]>, speed: f64) -> Vec<Vec<f64>> {
    let seconds = |row: usize, column: usize| match (from, to) {
        (Some(from), Some(to)) => least_time(arm, from[row], to[column], speed),
        _ => 0.0,
    };
    let count = |ik_solutions: Option<&[Configuration]>| ik_solutions.map_or(1, <[_]>::len);
    (0..count(from)).map(|row| (0..count(to)).map(|column| seconds(row, column)).collect()).collect()
}
