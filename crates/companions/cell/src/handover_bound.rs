//! A lower bound on the cycle of a cell with handovers: the giver's steps up to the place, then the taker's steps from the
//! pick on.

use crate::sequence::handed_over;
use cplan_geometry::Point;
use cplan_handling::{Action, Item, Task, ToolValues};
use cplan_model::space::Configuration;
use cplan_model::{equivalent_values, inverse};
use cplan_tasks::least_duration;

/// Returns a proven lower bound on the time until both arms have done their steps, seconds. The taker begins to take an
/// object at least `skew` seconds after the giver has placed it. Returns 0 without handovers.
pub(crate) fn handover_bound(tasks: [&Task; 2], skew: f64) -> f64 {
    let of = |giver: usize, object: usize| {
        Some(before_place(tasks[giver], object)? + skew + after_arrival(tasks[1 - giver], object)?)
    };
    let handovers = (0..2).flat_map(|giver| handed_over(tasks[giver]).map(move |object| (giver, object)));
    handovers.filter_map(|(giver, object)| of(giver, object)).fold(0.0, f64::max)
}

/// Returns a lower bound on the time until an arm has placed an object. In free order, the object may be the first.
fn before_place(task: &Task, object: usize) -> Option<f64> {
    let (first, mut items) = from_pick(task, object)?;
    let is_place = |item: &Item| matches!(item, Item::Step(step) if matches!(step.action, Action::Place { .. }));
    items.truncate(items.iter().position(is_place)? + 1);
    let items = task.items[..first].iter().cloned().chain(items).collect();
    Some(least_duration(&Task { items, ..task.clone() }))
}

/// Returns a lower bound on the time that an arm needs from its arrival at an object on, over all IK solutions there. In
/// free order, the object may be the last.
fn after_arrival(task: &Task, object: usize) -> Option<f64> {
    let (_, items) = from_pick(task, object)?;
    let Some(Item::Step(pick)) = items.first() else { return None };
    let Action::Pick { grasp, .. } = pick.action else { return None };
    let start_tool = ToolValues::default();
    let from = |start| least_duration(&Task { start, start_tool, items: items.clone(), ..task.clone() });
    let solutions = solutions(task, task.objects[object].at.point(grasp))?;
    Some(solutions.into_iter().map(from).fold(f64::INFINITY, f64::min)).filter(|least| least.is_finite())
}

/// Returns the IK solutions for a position of the tip. `None` if they are more than some points.
fn solutions(task: &Task, tip: Point) -> Option<Vec<Configuration>> {
    let solved = inverse(&task.arm, tip, task.start);
    let joints = &task.arm.joints;
    let copies =
        |q: &Configuration, k: usize| equivalent_values(joints[k].range, joints[k].joint_type.is_revolute(), q[k]);
    let of_branch = |q: &Configuration| {
        let second = copies(q, 1);
        let all = copies(q, 0)
            .into_iter()
            .flat_map(|first| second.iter().map(move |second| [first, *second]).collect::<Vec<_>>());
        all.map(Configuration::from).collect::<Vec<_>>()
    };
    solved.free.is_none().then(|| solved.branches.iter().flat_map(of_branch).collect())
}

/// Returns the number of the item that picks an object, and the items from the pick on. A pair in free order counts as two
/// steps.
fn from_pick(task: &Task, object: usize) -> Option<(usize, Vec<Item>)> {
    task.items.iter().enumerate().find_map(|(number, item)| {
        let own = match item {
            Item::Step(step) if step.action.picked() == Some(object) => vec![item.clone()],
            Item::AnyOrder(pairs) => {
                let pair = pairs.iter().find(|[pick, _]| pick.action.picked() == Some(object))?;
                pair.iter().cloned().map(Item::Step).collect()
            }
            _ => return None,
        };
        Some((number, own.into_iter().chain(task.items[number + 1..].iter().cloned()).collect()))
    })
}
