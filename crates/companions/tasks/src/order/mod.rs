//! Orders for groups with too many orders to try all. An order is proposed by times without obstacles. It is then tried
//! without planning motions. If it fails, another one is proposed that satisfies conditions derived from the failure.

mod condition;
mod ends;
mod tour;
mod walk;

use super::heuristic::{Heuristic, stops};
use super::least_time::least_time;
use super::motion_cache::MotionCache;
use super::state::State;
use condition::Condition;
use cplan_handling::{Item, Step, Task};
use cplan_legs::Leg;
use cplan_model::Arm;
use std::collections::BTreeSet;
use tour::Tour;
use walk::{Layer, advance, walk};

/// Largest number of paths that the search for an order examines. They take some seconds.
const MAX_EXAMINED_PATHS: usize = 20_000;

/// Largest number of orders that are proposed for a group. If all of them fail, an order is built pair by pair.
const MAX_PROPOSALS: usize = 64;

/// Largest number of pairs of a group for which conditions are derived from the ends of motions.
const MAX_PAIRS_WITH_ENDS: usize = 64;

/// The groups of a task whose order is free, each with one order.
pub(super) struct Orders<'a> {
    task: &'a Task,
    groups: Vec<Group<'a>>,
}

/// Pairs of a pick and a place that may be done in any order.
struct Group<'a> {
    /// Index of the item in the task.
    item: usize,
    pairs: &'a [[Step; 2]],
    /// Times of motions between the stops of the pairs. `None` if the group is too large.
    tour: Option<Tour>,
    /// The order, as indices of pairs.
    order: Vec<usize>,
    conditions: Vec<Condition>,
}

/// Origin of an item in a task whose order is chosen: the group from which it comes, and the number of the group's
/// pairs before it. `None` if the item belongs to no group.
type Origin = Option<(usize, usize)>;

/// The result of a search for an order.
pub(super) enum OrderSearch {
    /// No inexpensive check rules out the order that was found.
    Promising,
    /// No order was found.
    Stuck {
        /// Index of the group among the items of the task.
        item: usize,
        /// Pairs of the group. The first could not be done in the last order. The others are those of the condition
        /// that was learned from this.
        pairs: Vec<usize>,
    },
    /// A step outside the groups cannot be done after the steps before it.
    Elsewhere,
}

impl<'a> Orders<'a> {
    /// Returns the groups with the orders of the file.
    pub fn of_file(task: &'a Task) -> Self {
        let stops = stops(task);
        let groups = task.items.iter().enumerate().filter_map(|(item, group)| match group {
            Item::AnyOrder(pairs) => Some(Group {
                item,
                pairs,
                tour: Tour::new(task, &stops, item),
                order: (0..pairs.len()).collect(),
                conditions: Vec::new(),
            }),
            _ => None,
        });
        Self { task, groups: groups.collect() }
    }

    /// Returns the task in which each group has its order.
    pub fn in_chosen_order(&self) -> Task {
        self.with_origins().0
    }

    fn with_origins(&self) -> (Task, Vec<Origin>) {
        let mut in_chosen_order = Task { items: Vec::new(), ..self.task.clone() };
        let mut origins = Vec::new();
        let mut groups = self.groups.iter().enumerate();
        for item in &self.task.items {
            let Item::AnyOrder(pairs) = item else {
                in_chosen_order.items.push(item.clone());
                origins.push(None);
                continue;
            };
            let Some((number, group)) = groups.next() else { continue };
            for (before, &pair) in group.order.iter().enumerate() {
                in_chosen_order.items.extend(pairs[pair].clone().map(Item::Step));
                origins.extend([Some((number, before)); 2]);
            }
        }
        (in_chosen_order, origins)
    }

    /// Returns the order of each group, as indices of pairs.
    pub fn order(&self) -> Vec<Vec<usize>> {
        self.groups.iter().map(|group| group.order.clone()).collect()
    }

    /// Returns a lower bound on the duration of the task in these orders, in seconds.
    pub fn least_seconds(&self) -> f64 {
        let in_chosen_order = self.in_chosen_order();
        let start = State::at_start(&in_chosen_order);
        Heuristic::new(&in_chosen_order).remaining(start.q, start.progress)
    }

    /// Replaces the orders by those of `other`.
    pub fn adopt(&mut self, other: &Self) {
        for (group, other) in self.groups.iter_mut().zip(&other.groups) {
            group.order.clone_from(&other.order);
        }
    }

    /// Records the durations of motions that were planned in these orders.
    pub fn learn_times(&mut self, arm: &Arm, legs: &[Leg]) {
        let (in_chosen_order, origins) = self.with_origins();
        let steps = in_chosen_order.items.iter().zip(origins).filter(|(item, _)| matches!(item, Item::Step(_)));
        let mut before = None;
        for (leg, (_, origin)) in legs.iter().zip(steps) {
            let path = leg.timed.curve.curve().path();
            let least = least_time(arm, path.start(), path.goal(), leg.step.speed);
            let more = (leg.timed.trajectory.duration() - least).max(0.0);
            if let Some((number, at)) = origin {
                let group = &mut self.groups[number];
                let pair = group.order[at];
                match (&mut group.tour, leg.step.action.picked(), before) {
                    (Some(tour), Some(_), Some((last, other))) if last == number => {
                        tour.learn_transfer(other, pair, more)
                    }
                    (Some(tour), None, _) => tour.learn_carry(pair, more),
                    _ => {}
                }
                before = Some((number, pair));
            } else {
                before = None;
            }
        }
    }

    /// Looks for orders that are faster according to the recorded times, and that no inexpensive check rules out.
    /// Returns true if it found any.
    pub fn improve(&mut self, legs: &mut MotionCache) -> bool {
        for _ in 0..MAX_PROPOSALS {
            let before = self.order();
            let meets_all = self.groups.iter_mut().filter(|group| group.tour.is_some()).all(Group::propose);
            if !meets_all || self.order() == before {
                return false;
            }
            let (in_chosen_order, origins) = self.with_origins();
            let Err(failure) = walk(&in_chosen_order, legs) else { return true };
            let Some((number, at)) = origins[failure.item] else { return false };
            self.groups[number].derive_condition(self.task, at, &failure.refusals);
        }
        false
    }

    /// Returns true if no inexpensive check rules out these orders.
    pub fn check_candidate(&self, legs: &mut MotionCache) -> bool {
        walk(&self.in_chosen_order(), legs).is_ok()
    }

    /// Looks for orders that no inexpensive check rules out.
    pub fn search(&mut self, legs: &mut MotionCache, progress: &mut dyn FnMut(&str)) -> OrderSearch {
        let most = legs.examined_paths() + MAX_EXAMINED_PATHS;
        for group in &mut self.groups {
            if group.pairs.len() <= MAX_PAIRS_WITH_ENDS {
                group.conditions = ends::conditions(self.task, group);
            }
            group.propose();
        }
        let mut proposals = vec![0; self.groups.len()];
        let mut built = vec![false; self.groups.len()];
        loop {
            let (in_chosen_order, origins) = self.with_origins();
            let Err(failure) = walk(&in_chosen_order, legs) else { return OrderSearch::Promising };
            let Some((number, before)) = origins[failure.item] else { return OrderSearch::Elsewhere };
            let group = &mut self.groups[number];
            let learned = group.derive_condition(self.task, before, &failure.refusals);
            let stuck = OrderSearch::Stuck { item: group.item, pairs: learned };
            if built[number] || legs.examined_paths() > most {
                return stuck;
            }
            proposals[number] += 1;
            if proposals[number] <= MAX_PROPOSALS && group.propose() {
                progress(&format!("{} pairs: trying order {}", group.pairs.len(), proposals[number] + 1));
                continue;
            }
            built[number] = true;
            progress("building an order pair by pair");
            let first = origins.iter().position(|origin| matches!(origin, Some((group, _)) if *group == number));
            let entry = layer_before(&in_chosen_order, legs, first.unwrap_or(0));
            let group = &mut self.groups[number];
            match entry.and_then(|layer| OrderBuilder::new(self.task, group, legs, most).order(&layer)) {
                Some(order) => group.order = order,
                None => return stuck,
            }
        }
    }
}

impl Group<'_> {
    /// Returns the objects that the group moves.
    fn objects(&self) -> impl Iterator<Item = usize> + '_ {
        self.pairs.iter().filter_map(|[pick, _]| pick.action.picked())
    }

    /// Returns the pair that moves an obstacle.
    fn pair_of(&self, task: &Task, obstacle: usize) -> Option<usize> {
        let object = obstacle.checked_sub(task.workspace.fixed.obstacles.len())?;
        self.pairs.iter().position(|[pick, _]| pick.action.picked() == Some(object))
    }

    /// Replaces the order by another one: one that violates fewer conditions, or one that violates as many and is
    /// faster. Returns true if it satisfies all conditions.
    fn propose(&mut self) -> bool {
        let Some(tour) = &self.tour else { return false };
        let (order, (broken, _)) = tour.improved(self.order.clone(), &self.conditions);
        self.order = order;
        broken == 0
    }

    /// Learns a condition from the reasons why a pair cannot be done after the first `before` pairs. Returns this pair,
    /// followed by the other pairs of the condition.
    fn derive_condition(&mut self, task: &Task, before: usize, refusals: &[super::refusal::Refusal]) -> Vec<usize> {
        let pair = self.order[before];
        let mut done = vec![false; self.pairs.len()];
        self.order[..before].iter().for_each(|&pair| done[pair] = true);
        let condition = Condition::from_refusals(pair, &done, refusals, |obstacle| self.pair_of(task, obstacle));
        let others: BTreeSet<usize> = condition.pairs().filter(|&other| other != pair).collect();
        if !self.conditions.contains(&condition) {
            self.conditions.push(condition);
        }
        [pair].into_iter().chain(others).collect()
    }
}

/// Returns the states before an item of a task in a fixed order. `None` if the items before it cannot be done.
fn layer_before(task: &Task, legs: &mut MotionCache, item: usize) -> Option<Layer> {
    let mut layer = vec![(0.0, State::at_start(task))];
    while layer[0].1.progress.item < item {
        layer = advance(task, legs, &layer).ok()?;
    }
    Some(layer)
}

/// A search that builds an order pair by pair. It tries pairs in the sequence of the proposed order.
struct OrderBuilder<'a, 'g> {
    group: &'a mut Group<'g>,
    legs: &'a mut MotionCache,
    most: usize,
    /// Dead ends of the search. Each is given by the set of pairs that are done, and by the pair that was done last.
    dead_ends: BTreeSet<(Vec<bool>, Option<usize>)>,
    /// A task with a single pair, and another step after it.
    single_pair_task: Task,
}

impl<'a, 'g> OrderBuilder<'a, 'g> {
    fn new(task: &'a Task, group: &'a mut Group<'g>, legs: &'a mut MotionCache, most: usize) -> Self {
        let single_pair_task = Task { items: Vec::new(), ..task.clone() };
        Self { group, legs, most, dead_ends: BTreeSet::new(), single_pair_task }
    }

    fn order(mut self, entry: &Layer) -> Option<Vec<usize>> {
        let mut order = Vec::new();
        let mut done = vec![false; self.group.pairs.len()];
        self.build(entry, &mut order, &mut done).then_some(order)
    }

    fn build(&mut self, layer: &Layer, order: &mut Vec<usize>, done: &mut Vec<bool>) -> bool {
        if order.len() == done.len() {
            return true;
        }
        let key = (done.clone(), order.last().copied());
        if self.dead_ends.contains(&key) {
            return false;
        }
        let preferred = self.group.order.clone();
        for pair in preferred.into_iter().filter(|&pair| !done[pair]).collect::<Vec<_>>() {
            if self.legs.examined_paths() > self.most {
                return false;
            }
            let Some(next) = self.add_pair(layer, pair) else { continue };
            order.push(pair);
            done[pair] = true;
            if self.build(&next, order, done) {
                return true;
            }
            order.pop();
            done[pair] = false;
        }
        self.dead_ends.insert(key);
        false
    }

    /// Returns the states after a pair. `None` if it cannot be done.
    fn add_pair(&mut self, layer: &Layer, pair: usize) -> Option<Layer> {
        let [pick, place] = &self.group.pairs[pair];
        self.single_pair_task.items = [pick, place, place].map(|step| Item::Step(step.clone())).into();
        let mut layer = layer.clone();
        layer.iter_mut().for_each(|(_, state)| state.progress.item = 0);
        for _ in 0..2 {
            layer = advance(&self.single_pair_task, self.legs, &layer).ok()?;
        }
        Some(layer)
    }
}
