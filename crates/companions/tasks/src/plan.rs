//! Planning of tasks: chooses the search and its limits.

use super::heuristic::Heuristic;
use super::least_time::least_turn;
use super::motion_cache::MotionCache;
use super::order::{OrderSearch, Orders};
use super::part;
use super::search::{Ending, Limits, Search};
use super::state::State;
use super::stroke::{least_raising_at_start, least_stroke};
use super::{alone, among_movers};
use cplan_handling::{Item, Task};
use cplan_legs::{FailedStep, Leg, Sequence, TaskAnswer, TaskMotion};
use cplan_model::Outcome;
use cplan_solver::Options;
use std::collections::BTreeSet;

/// Largest numbers of planned motions and of expanded nodes in the search for the fastest choice in a fixed order. It
/// takes some seconds. If they do not suffice, weighted A* looks for any solution.
const MAX_MOTIONS: usize = 2_000;
const MAX_EXPANDED: usize = 100_000;

/// Largest numbers of planned motions and of expanded nodes in the search over free orders. It takes about a second. If
/// they do not suffice, a single order is chosen.
const FREE_MOTIONS: usize = 500;

/// Largest numbers of further motions and of further orders in attempts to improve a chosen order. There are no such
/// attempts if its duration is within the factor `CLOSE_FACTOR` of the bound.
const IMPROVING_MOTIONS: usize = 100;
const IMPROVING_ORDERS: usize = 6;
const CLOSE_FACTOR: f64 = 1.15;

/// Number of nodes per step of a task that are added to the limits, since long tasks have more states.
const EXPANDED_PER_STEP: usize = 16;

/// Factor by which the limits of a weighted search exceed those of the first search. At these limits, it ends without
/// an answer.
const WEIGHTED_BUDGET_FACTOR: usize = 10;

/// Largest number of pairs in a group for which all orders are searched. The table of all subsets then has some
/// thousand entries, and doubles with each further pair.
const MAX_FULLY_ORDERED_PAIRS: usize = 10;

/// Plans a task. Finds the fastest sequence of motions over all IK solutions at the targets, turns of the wrist, and
/// free orders. [`TaskAnswer`] describes the guarantees. Calls `progress` during long computations.
///
/// If there are too many orders, one is chosen that is good without obstacles. It satisfies conditions that were
/// learned from orders that fail. If the file's own order is faster, it is used instead. With the real durations of
/// planned motions, a still better order may be found.
pub fn plan(task: &Task, options: &Options, progress: &mut dyn FnMut(&str)) -> TaskAnswer {
    if task.has_moving_obstacles() {
        return among_movers::plan(task, options, progress);
    }
    let heuristic = Heuristic::new(task);
    let lower_bound = bound_with(task, &heuristic);
    let mut planning = Planning { task, options, legs: MotionCache::new(options), lower_bound, expanded: 0, progress };
    if let Some(found) = alone::impossible(task) {
        return planning.answer(found);
    }
    let pairs = |item: &Item| if let Item::AnyOrder(pairs) = item { pairs.len() } else { 0 };
    match task.items.iter().map(pairs).max().unwrap_or(0) {
        0 => planning.plan_fixed_order(&heuristic),
        1..=MAX_FULLY_ORDERED_PAIRS => planning.in_any_order(&heuristic),
        _ => {
            let found = planning.in_chosen_order();
            planning.answer(found)
        }
    }
}

/// Returns a proven lower bound on the duration of a task, seconds, without planning its motions. Obstacles do not move.
pub fn least_duration(task: &Task) -> f64 {
    bound_with(task, &Heuristic::new(task))
}

fn bound_with(task: &Task, heuristic: &Heuristic) -> f64 {
    let start = State::at_start(task);
    let raising = least_raising_at_start(task, |depth| least_stroke(task, depth));
    let lower_bound = raising + heuristic.remaining(start.q, start.progress);
    let turns = task.steps().filter_map(|step| task.wrist_turn(step)).zip(&task.wrist);
    turns.map(|(angle, wrist)| least_turn(wrist, angle)).fold(lower_bound, f64::max)
}

struct Planning<'a, 'p> {
    task: &'a Task,
    options: &'a Options,
    legs: MotionCache,
    lower_bound: f64,
    /// Number of nodes that all searches have expanded.
    expanded: usize,
    progress: &'p mut dyn FnMut(&str),
}

impl Planning<'_, '_> {
    /// Plans a task without free orders.
    fn plan_fixed_order(mut self, heuristic: &Heuristic) -> TaskAnswer {
        let mut search = Search::new(self.task, heuristic, &mut self.legs);
        let mut ending = search.run(limits(self.task, MAX_MOTIONS), self.progress);
        let exact = ending != Ending::OutOfBudget;
        if !exact {
            ending = continue_weighted(&mut search, self.task, WEIGHTED_BUDGET_FACTOR * MAX_MOTIONS, self.progress);
        }
        let found = Found::of(&mut search, ending, exact);
        self.expanded += search.expanded();
        self.answer(found)
    }

    /// Plans a task all of whose orders can be searched, unless that takes too long.
    fn in_any_order(mut self, heuristic: &Heuristic) -> TaskAnswer {
        let mut search = Search::new(self.task, heuristic, &mut self.legs);
        let mut ending = search.run(limits(self.task, FREE_MOTIONS), self.progress);
        if ending != Ending::OutOfBudget {
            let found = Found::of(&mut search, ending, true);
            self.expanded += search.expanded();
            return self.answer(found);
        }
        self.expanded += search.expanded();
        let found = self.in_chosen_order();
        if !matches!(found.outcome, Outcome::Unknown(_)) {
            return self.answer(found);
        }
        // The search for a single order may have missed one, so all orders are searched.
        let mut search = Search::new(self.task, heuristic, &mut self.legs);
        ending = continue_weighted(&mut search, self.task, MAX_MOTIONS, self.progress);
        let last = Found::of(&mut search, ending, ending == Ending::Exhausted);
        self.expanded += search.expanded();
        self.answer(if ending == Ending::OutOfBudget { found } else { Found { exact: false, ..last } })
    }

    /// Plans the task in an order that this function chooses.
    fn in_chosen_order(&mut self) -> Found {
        let mut orders = Orders::of_file(self.task);
        let search = orders.search(&mut self.legs, self.progress);
        let mut best = match search {
            OrderSearch::Promising => Some(self.best_in_orders(&orders, f64::INFINITY)).filter(Found::is_done),
            OrderSearch::Stuck { .. } | OrderSearch::Elsewhere => None,
        };
        // The file's own order is tried, unless it takes longer or hardly less time, or is known to fail.
        let file = Orders::of_file(self.task);
        let below = best.as_ref().map_or(f64::INFINITY, |best| best.seconds);
        if below > CLOSE_FACTOR * self.lower_bound
            && file.order() != orders.order()
            && file.least_seconds() < below
            && file.check_candidate(&mut self.legs)
        {
            let own = self.best_in_orders(&file, below);
            if own.is_done() {
                orders.adopt(&file);
                best = Some(own);
            }
        }
        if let Some(best) = best {
            return self.improve_orders(orders, best);
        }
        let proof = match &search {
            OrderSearch::Stuck { item, pairs } => {
                part::impossible(self.task, *item, pairs, self.options, self.progress)
            }
            OrderSearch::Promising | OrderSearch::Elsewhere => None,
        };
        proof.unwrap_or_else(|| self.best_in_orders(&orders, f64::INFINITY))
    }

    /// Looks for better orders, by the real durations of motions, and returns the best result.
    fn improve_orders(&mut self, mut orders: Orders, mut best: Found) -> Found {
        let most = self.legs.planned() + IMPROVING_MOTIONS;
        let mut tried = BTreeSet::from([orders.order()]);
        orders.learn_times(&self.task.arm, &best.legs);
        while tried.len() <= IMPROVING_ORDERS
            && best.seconds > CLOSE_FACTOR * self.lower_bound
            && self.legs.planned() < most
            && orders.improve(&mut self.legs)
        {
            if !tried.insert(orders.order()) {
                break;
            }
            let next = self.best_in_orders(&orders, best.seconds);
            orders.learn_times(&self.task.arm, &next.legs);
            if next.is_done() {
                best = next;
            }
        }
        best
    }

    /// Returns the fastest choice in these orders that takes less than `below` seconds.
    fn best_in_orders(&mut self, orders: &Orders, below: f64) -> Found {
        let in_chosen_order = orders.in_chosen_order();
        let heuristic = Heuristic::new(&in_chosen_order);
        let mut search = Search::new(&in_chosen_order, &heuristic, &mut self.legs);
        let limits = Limits { below, ..limits(&in_chosen_order, MAX_MOTIONS) };
        let mut ending = search.run(limits, self.progress);
        if ending == Ending::OutOfBudget && below.is_infinite() {
            ending = continue_weighted(&mut search, &in_chosen_order, MAX_MOTIONS, self.progress);
        }
        let found = Found::of(&mut search, ending, false);
        self.expanded += search.expanded();
        found
    }

    fn answer(self, Found { outcome, legs, exact, .. }: Found) -> TaskAnswer {
        let outcome = outcome.map(|()| TaskMotion { sequence: Sequence::of(&legs), exact, timing: None });
        let (motions, expanded) = (self.legs.planned(), self.expanded);
        TaskAnswer { outcome, legs, lower_bound: self.lower_bound, motions, expanded }
    }
}

/// The result of a search.
pub(super) struct Found {
    pub outcome: Outcome<(), FailedStep, FailedStep>,
    pub legs: Vec<Leg>,
    /// True if no other choice is faster. Without a solution: true if no other choice is possible.
    pub exact: bool,
    /// Duration in seconds. Infinite if not all steps can be done.
    pub seconds: f64,
}

impl Found {
    /// Converts the end of a search to a result. `exact` is true if the search was exhaustive.
    pub fn of(search: &mut Search, ending: Ending, exact: bool) -> Self {
        if let Ending::Done(node) = ending {
            let (legs, seconds) = (search.legs(node), search.seconds(node));
            return Self { outcome: Outcome::Found(()), legs, exact, seconds };
        }
        if ending == Ending::OutOfBudget {
            search.give_up();
        }
        let (failed, node, proven) = search.failure();
        let outcome = match proven && exact {
            true => Outcome::Infeasible(failed),
            false => Outcome::Unknown(failed),
        };
        Self { outcome, legs: search.legs(node), exact, seconds: f64::INFINITY }
    }

    fn is_done(&self) -> bool {
        matches!(self.outcome, Outcome::Found(()))
    }
}

/// Returns the limits of a search for the fastest choice.
pub(super) fn limits(task: &Task, motions: usize) -> Limits {
    let expanded = MAX_EXPANDED + EXPANDED_PER_STEP * task.steps().count();
    Limits { motions, expanded, below: f64::INFINITY }
}

/// Continues the search as weighted A*, which looks for any solution.
fn continue_weighted(search: &mut Search, task: &Task, motions: usize, progress: &mut dyn FnMut(&str)) -> Ending {
    search.use_weighted_astar();
    let once = limits(task, motions);
    search.run(Limits { expanded: WEIGHTED_BUDGET_FACTOR * once.expanded, ..once }, progress)
}
