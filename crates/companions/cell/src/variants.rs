//! Other sequences for the task of one arm: other IK solutions, and other orders of free steps.

use cplan_handling::{Action, Item, Step, Task};
use cplan_legs::Leg;
use cplan_model::{Elbow, JointType};

/// A change of the order of pairs of a pick and a place.
type Reorder = fn(&mut Vec<[Step; 2]>);

/// A task that fixes choices of another one.
pub(crate) struct Variant {
    /// The choice in a few words.
    pub what: String,
    pub task: Task,
}

/// Returns variants of a task. `legs` is its fastest sequence.
pub(crate) fn variants(task: &Task, legs: &[Leg]) -> Vec<Variant> {
    let has_elbow = matches!(task.arm.joints[1].joint_type, JointType::Revolute { .. });
    let sides = [Elbow::Left, Elbow::Right].into_iter().filter(|_| has_elbow);
    let elbows = sides.map(|side| Variant {
        what: format!("elbow on the {}", side.name()),
        task: changed(task, |step| {
            if matches!(step.action, Action::Pick { .. } | Action::Place { .. }) {
                step.elbow.get_or_insert(side);
            }
        }),
    });
    let orders: [(&str, Reorder); 2] = [
        ("free steps in the opposite order", |pairs| pairs.reverse()),
        ("free steps from the middle on", |pairs| {
            let middle = pairs.len() / 2;
            pairs.rotate_left(middle);
        }),
    ];
    let is_free = task.items.iter().any(|item| matches!(item, Item::AnyOrder(pairs) if pairs.len() > 1));
    let orders = orders.into_iter().filter(|_| is_free);
    let orders = orders.map(|(what, change)| Variant { what: what.into(), task: ordered(task, legs, change) });
    elbows.chain(orders).collect()
}

/// Returns a task whose steps are changed.
fn changed(task: &Task, change: impl Fn(&mut Step)) -> Task {
    let mut task = task.clone();
    for item in &mut task.items {
        match item {
            Item::Step(step) => change(step),
            Item::AnyOrder(pairs) => pairs.iter_mut().flatten().for_each(&change),
            Item::Renew(_) => {}
        }
    }
    task
}

/// Returns a task whose free steps have a fixed order: that of the legs, changed.
fn ordered(task: &Task, legs: &[Leg], change: Reorder) -> Task {
    let place = |step: &Step| legs.iter().position(|leg| leg.step == *step).unwrap_or(usize::MAX);
    let mut task = task.clone();
    task.items = task
        .items
        .into_iter()
        .flat_map(|item| match item {
            Item::AnyOrder(mut pairs) => {
                pairs.sort_by_key(|[pick, _]| place(pick));
                change(&mut pairs);
                pairs.into_iter().flatten().map(Item::Step).collect()
            }
            other => vec![other],
        })
        .collect();
    task
}
