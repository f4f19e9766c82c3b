//! Other sequences for the task of one arm: other IK solutions, and other orders of free steps.

use cplan_handling::{Action, Item, Presence, Step, Task, ToolValues};
use cplan_legs::Leg;
use cplan_model::{Elbow, Goal, JointType};

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
    let retreats = retreating(task).map(|task| Variant { what: "at its start between handovers".into(), task });
    elbows.chain(orders).chain(retreats).collect()
}

/// Returns a task in which the arm returns to its start before it takes an object, and after it has given one. There, it can
/// wait out of the way. Returns `None` if there are no such steps in fixed order.
fn retreating(task: &Task) -> Option<Task> {
    let is = |step: &Step, role: Presence, held: Option<usize>| {
        let object = if role == Presence::FromPick { step.action.picked() } else { held };
        object.is_some_and(|object| task.objects[object].presence == Some(role))
    };
    let retreat = |step: &Step| {
        let action = Action::Move(Goal::Joints(task.start));
        Item::Step(Step {
            action,
            dwell: 0.0,
            tool: ToolValues::default(),
            elevation: 0.0,
            elbow: None,
            ..step.clone()
        })
    };
    let (mut items, mut held, mut is_there) = (Vec::new(), None, true);
    for item in &task.items {
        let Item::Step(step) = item else {
            items.push(item.clone());
            is_there = false;
            continue;
        };
        if !is_there && is(step, Presence::FromPick, None) {
            items.push(retreat(step));
        }
        held = step.action.picked().or(held);
        items.push(item.clone());
        is_there = matches!(step.action, Action::Place { .. }) && is(step, Presence::UntilPlaced, held);
        if is_there {
            items.push(retreat(step));
        }
    }
    (items.len() > task.items.len()).then(|| Task { items, ..task.clone() })
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
