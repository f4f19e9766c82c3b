//! Proof that a group cannot be done in any order, by a part of it: if some of its pairs cannot be done even where all other
//! objects are out of the way, then the whole cannot.
//!
//! What the whole does for these pairs is a way for the part, too: the arm passes the same configurations among fewer obstacles,
//! carries nothing where it carried something else, and link 2 is free to meet what it went to, or let go of, for longer.

use super::heuristic::Heuristic;
use super::legs::Legs;
use super::plan::{Found, limits};
use super::search::{Ending, Search};
use cplan_core::model::{Outcome, Shape};
use cplan_handling::{Action, Item, Task};
use cplan_solver::Options;
use std::collections::BTreeSet;

/// Motions that are planned for one part.
const MOTIONS: usize = 200;

/// Pairs of a part: so few that all their orders are soon looked at.
const MOST_PAIRS: usize = 4;

/// The answer that group `item` cannot be done, if that is proven by the first of `pairs` alone, by it and one other, or by all if
/// they are few.
pub(super) fn impossible(
    task: &Task,
    item: usize,
    pairs: &[usize],
    options: &Options,
    progress: &mut dyn FnMut(&str),
) -> Option<Found> {
    let (&first, others) = pairs.split_first()?;
    // Groups before it would have to be looked at in all orders.
    if task.items[..item].iter().any(|before| matches!(before, Item::AnyOrder(_))) {
        return None;
    }
    let together = (2..MOST_PAIRS).contains(&others.len()).then(|| pairs.to_vec());
    let parts = [vec![first]].into_iter().chain(others.iter().map(|&other| vec![first, other])).chain(together);
    parts.into_iter().find_map(|part| {
        let alone = part_of(task, item, &part)?;
        let heuristic = Heuristic::new(&alone);
        // With legs of its own: its objects are not the same.
        let mut legs = Legs::new(options);
        let mut search = Search::new(&alone, &heuristic, &mut legs);
        let ending = search.run(limits(&alone, MOTIONS), progress);
        if ending != Ending::Dry {
            return None;
        }
        let mut found = Found::of(&mut search, ending, true);
        let Outcome::Infeasible(failed) = &mut found.outcome else { return None };
        let names: Vec<String> = part.iter().map(|&pair| name(task, item, pair)).collect();
        failed
            .reasons
            .push(format!("this holds in any order, even with no other objects than {}", names.join(" and ")));
        // They were done in a world with less in it.
        found.legs.clear();
        Some(found)
    })
}

fn name(task: &Task, item: usize, pair: usize) -> String {
    let picked = match &task.items[item] {
        Item::AnyOrder(pairs) => pairs[pair][0].action.picked(),
        _ => None,
    };
    picked.map_or_else(String::new, |object| format!("\"{}\"", task.objects[object].name))
}

/// The task up to a group of which only some pairs are left, without the objects that other pairs, or later steps, move. None if
/// one of those that are left is moved later: then the end of the part is not like that of the group.
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
