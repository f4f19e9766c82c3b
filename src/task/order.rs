//! A good order for groups that are too large to try all.

use super::least_time::least_time;
use super::outlook::{Stops, stops};
use crate::model::{Item, Task};
use crate::space::Configuration;

/// Pairs in a group up to which the best order is searched for: the table of all subsets has some thousand entries then,
/// and doubles with each pair more.
pub(super) const MOST_PAIRS: usize = 10;

/// The task with the order of groups of more than [`MOST_PAIRS`] pairs fixed to a good one: as fast as can be, by times
/// with nothing in the way, among all that come of moving a run of up to three pairs elsewhere, or of reversing a run.
/// Whether there were such groups.
pub(super) fn settled(task: &Task) -> (Task, bool) {
    let stops = stops(task);
    let mut settled = Task { items: Vec::new(), ..task.clone() };
    let mut any = false;
    for (index, item) in task.items.iter().enumerate() {
        match (item, &stops[index]) {
            (Item::AnyOrder(pairs), Stops::Pairs(known)) if pairs.len() > MOST_PAIRS => {
                any = true;
                let entry = match index.checked_sub(1).map(|before| &stops[before]) {
                    None => Some(vec![task.start]),
                    Some(Stops::One(stop)) => stop.postures().map(<[_]>::to_vec),
                    Some(_) => None,
                };
                let exit = match stops.get(index + 1) {
                    Some(Stops::One(stop)) => stop.postures().map(<[_]>::to_vec),
                    _ => None,
                };
                let tour = Tour { task, known, entry, exit };
                let order = tour.improved((0..pairs.len()).collect());
                settled.items.extend(order.iter().flat_map(|&pair| pairs[pair].clone().map(Item::Step)));
            }
            _ => settled.items.push(item.clone()),
        }
    }
    (settled, any)
}

/// A group, and where it is entered from and left to, where that is known.
struct Tour<'a> {
    task: &'a Task,
    known: &'a [[super::outlook::Stop; 2]],
    entry: Option<Vec<Configuration>>,
    exit: Option<Vec<Configuration>>,
}

impl Tour<'_> {
    /// Least seconds for the pairs in this order: the shortest way through the layers of postures.
    fn seconds(&self, order: &[usize]) -> f64 {
        let mut at = self.entry.clone();
        let mut times = vec![0.0; at.as_ref().map_or(1, Vec::len)];
        let stops = order.iter().flat_map(|&pair| &self.known[pair]).map(|stop| (stop.postures(), stop.speed()));
        for (postures, speed) in stops.chain([(self.exit.as_deref(), 1.0)]) {
            times = match (&at, postures) {
                (Some(from), Some(to)) => {
                    let reach = |&to: &Configuration| {
                        let by = |(q, time): (&Configuration, &f64)| time + least_time(&self.task.arm, *q, to, speed);
                        from.iter().zip(&times).map(by).fold(f64::INFINITY, f64::min)
                    };
                    to.iter().map(reach).collect()
                }
                (_, to) => vec![times.iter().copied().fold(f64::INFINITY, f64::min); to.map_or(1, <[_]>::len)],
            };
            at = postures.map(<[_]>::to_vec);
        }
        times.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// The order after all changes that make it faster, the first found first.
    fn improved(&self, mut order: Vec<usize>) -> Vec<usize> {
        let mut best = self.seconds(&order);
        loop {
            let before = best;
            for first in 0..order.len() {
                for last in first..order.len() {
                    let mut reversed = order.clone();
                    reversed[first..=last].reverse();
                    let run = if last - first < 3 { order.len() } else { 0 };
                    let moved = (0..run).map(|to| {
                        let mut moved = order.clone();
                        let taken: Vec<usize> = moved.drain(first..=last).collect();
                        let to = to.min(moved.len());
                        moved.splice(to..to, taken);
                        moved
                    });
                    let tried: Vec<Vec<usize>> = [reversed].into_iter().chain(moved).collect();
                    for candidate in tried {
                        let seconds = self.seconds(&candidate);
                        if seconds < best {
                            (best, order) = (seconds, candidate);
                        }
                    }
                }
            }
            if best >= before {
                return order;
            }
        }
    }
}
