//! Assignments of the objects that either arm may move.

use crate::Cell;
use crate::handover_bound::handover_bound;
use cplan_handling::{Item, Task};
use cplan_model::Shape;
use cplan_tasks::least_duration;
use std::collections::BTreeSet;

/// For each object that either arm may move, the arm that moves it.
pub(crate) struct Assignment {
    arms: Vec<usize>,
    /// The tasks of both arms. Objects that only the other arm moves have no shape.
    pub tasks: [Task; 2],
    /// Proven lower bound on the time until both arms have done their steps, seconds.
    pub bound: f64,
}

impl Assignment {
    /// Returns for each arm the names of its objects.
    pub fn names(&self, cell: &Cell) -> [Vec<String>; 2] {
        [0, 1].map(|arm| {
            let own = cell.shared.iter().zip(&self.arms).filter(|(_, of)| **of == arm);
            own.map(|(name, _)| name.clone()).collect()
        })
    }

    /// Describes the assignment.
    pub fn describe(&self, cell: &Cell) -> String {
        let of = |arm: usize| {
            let names = &self.names(cell)[arm];
            let all = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
            format!("{}: {all}", cell.arms[arm].name)
        };
        format!("assignment with a bound of {:.3} s: {}; {}", self.bound, of(0), of(1))
    }
}

/// Returns all assignments, in ascending order of their bounds.
pub(crate) fn assignments(cell: &Cell, tasks: [&Task; 2], skew: f64) -> Vec<Assignment> {
    let count = cell.shared.len();
    let can = |arms: &Vec<usize>| arms.iter().enumerate().all(|(pair, arm)| cell.arms[*arm].shared[pair].is_some());
    let all = (0..1_usize << count).map(|bits| (0..count).map(|pair| bits >> pair & 1).collect::<Vec<_>>());
    let mut found: Vec<Assignment> = all.filter(can).map(|arms| assigned(cell, tasks, arms, skew)).collect();
    found.sort_by(|a, b| a.bound.total_cmp(&b.bound));
    found
}

fn assigned(cell: &Cell, tasks: [&Task; 2], arms: Vec<usize>, skew: f64) -> Assignment {
    let tasks = assigned_tasks(cell, tasks, &arms);
    let handovers = handover_bound(tasks.each_ref(), skew);
    let bound = tasks.each_ref().map(least_duration).into_iter().fold(handovers, f64::max);
    Assignment { arms, tasks, bound }
}

/// Returns the tasks of both arms, if each object that either arm may move is moved by the arm in `arms`. Objects that only the
/// other arm moves have no shape.
pub(crate) fn assigned_tasks(cell: &Cell, tasks: [&Task; 2], arms: &[usize]) -> [Task; 2] {
    let reduced = [0, 1].map(|arm| {
        let mut task = tasks[arm].clone();
        let numbers = arms.iter().enumerate().filter(|(_, of)| **of == arm);
        let kept: BTreeSet<usize> = numbers.filter_map(|(pair, _)| cell.arms[arm].shared[pair]).collect();
        if let (Some(Item::AnyOrder(pairs)), true) = (task.items.first_mut(), has_shared(cell, arm)) {
            let mut number = 0..;
            pairs.retain(|_| number.next().is_some_and(|number| kept.contains(&number)));
            if pairs.is_empty() {
                task.items.remove(0);
            }
        }
        task
    });
    let picked = reduced.each_ref().map(|task| task.steps().filter_map(|step| step.action.picked()).collect());
    let mut tasks = reduced;
    for (arm, task) in tasks.iter_mut().enumerate() {
        let [own, others]: [&BTreeSet<usize>; 2] = [&picked[arm], &picked[1 - arm]];
        for object in others.difference(own) {
            (task.objects[*object].shape, task.objects[*object].pieces) = (Shape::Pieces, Vec::new());
        }
    }
    tasks
}

/// Returns true if the first steps of an arm are those that either arm may do.
fn has_shared(cell: &Cell, arm: usize) -> bool {
    cell.arms[arm].shared.iter().any(Option::is_some)
}
