//! Proofs by a part of a group that the group cannot be done in any order. If some of its pairs cannot be done even
//! without all other objects, the whole group cannot be done.
//!
//! A solution for the whole group would also solve the part: the arm moves through the same configurations among fewer
//! obstacles. Where it carried another object, it now carries nothing. Link 2 may touch the objects of the part's picks
//! and places for longer.

use super::alone::whatever_the_order;
use super::heuristic::Heuristic;
use super::motion_cache::MotionCache;
use super::plan::{Found, limits};
use super::search::{Ending, Search};
use cplan_handling::{Action, Item, Task};
use cplan_model::{Outcome, Shape};
use cplan_solver::Options;
use cplan_text::listed;
use std::collections::BTreeSet;

/// Largest number of motions that are planned for one part of a group.
const MAX_PART_MOTIONS: usize = 200;

/// Largest number of pairs of a part. All orders of so few pairs can be searched quickly.
const MAX_PART_PAIRS: usize = 4;

/// Returns the answer that the group at `item` is infeasible, if that is proven. Tries the first of `pairs` alone, then
/// together with each other one, and then all of them if they are few.
pub(super) fn impossible(
    task: &Task,
    item: usize,
    pairs: &[usize],
    options: &Options,
    progress: &mut dyn FnMut(&str),
) -> Option<Found> {
    let (&first, others) = pairs.split_first()?;
    // All orders of the earlier groups would have to be searched.
    if task.items[..item].iter().any(|before| matches!(before, Item::AnyOrder(_))) {
        return None;
    }
    let together = (2..MAX_PART_PAIRS).contains(&others.len()).then(|| pairs.to_vec());
    let parts = [vec![first]].into_iter().chain(others.iter().map(|&other| vec![first, other])).chain(together);
    parts.into_iter().find_map(|part| {
        let alone = part_of(task, item, &part)?;
        let heuristic = Heuristic::new(&alone);
        // Its own cache of motions, because its objects are different.
        let mut legs = MotionCache::new(options);
        let mut search = Search::new(&alone, &heuristic, &mut legs);
        let ending = search.run(limits(&alone, MAX_PART_MOTIONS), progress);
        if ending != Ending::Exhausted {
            return None;
        }
        let mut found = Found::of(&mut search, ending, true);
        let Outcome::Infeasible(failed) = &mut found.outcome else { return None };
        let names: Vec<&str> = part.iter().map(|&pair| name(task, item, pair)).collect();
        failed.reasons.push(match names[..] {
            [object] => whatever_the_order(&failed.step, object),
            _ => {
                let all = listed(&names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>());
                format!("{all} cannot all be picked and placed, in any order, even without the other objects")
            }
        });
        // These steps were done in a world with fewer objects, so they are no part of the answer.
        found.legs.clear();
        Some(found)
    })
}

fn name(task: &Task, item: usize, pair: usize) -> &str {
    let picked = match &task.items[item] {
        Item::AnyOrder(pairs) => pairs[pair][0].action.picked(),
        _ => None,
    };
    picked.map_or("", |object| &task.objects[object].name)
}

/// Returns the task up to a group, with only some of the group's pairs. Objects that other pairs or later steps move
/// are omitted. `None` if a later step moves one of the remaining objects, because then the part ends differently from
/// the group.
fn part_of(task: &Task, item: usize, part: &[usize]) -> Option<Task> {
    let Item::AnyOrder(pairs) = &task.items[item] else { return None };
    let left: Vec<_> = part.iter().map(|&pair| pairs[pair].clone()).collect();
    let object = |action: &Action| action.picked();
    let kept: BTreeSet<usize> = left.iter().filter_map(|[pick, _]| object(&pick.action)).collect();
    let others = pairs.iter().enumerate().filter(|(pair, _)| !part.contains(pair)).map(|(_, [pick, _])| &pick.action);
    let later = Task { items: task.items[item + 1..].to_vec(), ..task.clone() };
    let mut gone: BTreeSet<usize> = later.steps().map(|step| &step.action).chain(others).filter_map(object).collect();
    gone.extend(task.items[item + 1..].iter().flat_map(|after| match after {
        Item::Renew(objects) => objects.clone(),
        _ => Vec::new(),
    }));
    if gone.intersection(&kept).next().is_some() {
        return None;
    }
    let mut alone = Task { items: task.items[..item].to_vec(), ..task.clone() };
    alone.items.push(Item::AnyOrder(left));
    for object in gone {
        (alone.objects[object].shape, alone.objects[object].pieces) = (Shape::Pieces, Vec::new());
    }
    Some(alone)
}
