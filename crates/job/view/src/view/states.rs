//! Payload states: motions with one payload state and the same C-obstacles share a panel.

use super::steps::Order;
use cplan_legs::Leg;
use cplan_model::space::{Configuration, Topology};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Configurations count as equal within this distance, in radians or metres. It covers rounding.
const EQUALITY_TOLERANCE: f64 = 1e-6;

/// Consecutive motions with the same payload in the same world.
#[derive(Debug, Clone)]
pub struct PayloadState<'a> {
    /// Motions, with their indices among all motions of the task. Repeated motions are listed once.
    pub motions: Vec<(usize, &'a Leg)>,
    /// Number of times that the motions are executed.
    pub times: usize,
}

/// Returns the payload states in the order of their first occurrence. Repetitions that look the same are merged. `O(n)` for `n`
/// motions if all repetitions of a step look the same, otherwise up to `O(n^2)`.
pub fn payload_states<'a>(legs: &'a [Leg], topology: &Topology) -> Vec<PayloadState<'a>> {
    let mut states: Vec<PayloadState> = Vec::new();
    let numbered: Vec<(usize, &Leg)> = legs.iter().enumerate().collect();
    for run in numbered.chunk_by(|a, b| same_world(a.1, b.1)) {
        let mut motions: Vec<(usize, &Leg)> = Vec::new();
        for &(index, leg) in run {
            if !motions.iter().any(|known| same_motion(known.1, leg, topology)) {
                motions.push((index, leg));
            }
        }
        let rounds = |number| run.iter().filter(|(_, leg)| leg.step.number == number).count();
        let times = motions.iter().map(|(_, leg)| rounds(leg.step.number)).max().unwrap_or(0);
        let same = |a: &Leg, b: &Leg| same_motion(a, b, topology) && same_world(a, b);
        let known = states.iter_mut().find(|state| {
            state.motions.len() == motions.len() && state.motions.iter().zip(&motions).all(|(a, b)| same(a.1, b.1))
        });
        match known {
            Some(state) => state.times += times,
            None => states.push(PayloadState { motions, times }),
        }
    }
    states
}

fn same_world(a: &Leg, b: &Leg) -> bool {
    let same = || a.scene.attachment() == b.scene.attachment() && a.scene.workspace() == b.scene.workspace();
    Arc::ptr_eq(&a.scene, &b.scene) || same()
}

/// Returns true if both motions belong to the same step and move the joints in the same way.
fn same_motion(a: &Leg, b: &Leg, topology: &Topology) -> bool {
    let paths = [a, b].map(|leg| leg.timed.curve.curve().path().waypoints());
    let same = || {
        let near = |(a, b): (&Configuration, &Configuration)| topology.distance(*a, *b) <= EQUALITY_TOLERANCE;
        paths[0].len() == paths[1].len() && paths[0].iter().zip(paths[1]).all(near)
    };
    a.step.number == b.step.number && (Arc::ptr_eq(&a.timed, &b.timed) || same())
}

/// Groups payload states that are alike, in the order of each group's first state.
pub fn grouped<'a>(
    states: Vec<PayloadState<'a>>,
    is_alike: impl Fn(&PayloadState, &PayloadState) -> bool,
) -> Vec<Vec<PayloadState<'a>>> {
    let mut groups: Vec<Vec<PayloadState>> = Vec::new();
    for state in states {
        match groups.iter_mut().find(|group| is_alike(&group[0], &state)) {
            Some(group) => group.push(state),
            None => groups.push(vec![state]),
        }
    }
    groups
}
/// Returns two titles: the payload, such as `Carrying part`, and steps with repetitions, such as `steps 1–2, 5` or
/// `step 3 (×100)`. If the task has several `rounds`, the second can be `step 4, round 2`.
pub fn titles(group: &[PayloadState], rounds: usize, order: &Order) -> [String; 2] {
    let mut payloads: Vec<&str> = Vec::new();
    // The number of executions of each step.
    let mut times: BTreeMap<usize, usize> = BTreeMap::new();
    for state in group {
        let numbers: BTreeSet<usize> = state.motions.iter().map(|(_, leg)| order.number(&leg.step)).collect();
        numbers.into_iter().for_each(|number| *times.entry(number).or_default() += state.times);
        let payload = state.motions.first().and_then(|(_, leg)| leg.scene.attachment());
        let name = payload.map(|payload| payload.name.as_str()).filter(|name| !payloads.contains(name));
        payloads.extend(name);
    }
    let numbers: Vec<usize> = times.keys().copied().collect();
    let steps = format!("step{} {}", if numbers.len() == 1 { "" } else { "s" }, ranges(&numbers));
    let repeated = match (times.values().max(), group[0].motions.first()) {
        (Some(&times), _) if times > 1 => format!(" (\u{d7}{times})"),
        (_, Some((_, leg))) if rounds > 1 => format!(", round {}", leg.step.cycle),
        _ => String::new(),
    };
    [hand(&payloads), steps + &repeated]
}

/// Describes the hand, as a title. `payloads` are the names of the objects that it carries in turn.
pub fn hand(payloads: &[&str]) -> String {
    match payloads {
        [] => "Empty hand".to_owned(),
        [one] => format!("Carrying {one}"),
        [one, other] => format!("Carrying {one} or {other}"),
        [one, ..] => format!("Carrying {one} or others"),
    }
}

/// Returns the payload in words.
pub fn describe(object: Option<&str>) -> String {
    object.map_or("empty-handed".to_owned(), |object| format!("carrying \"{object}\""))
}

/// Formats numbers, with ranges for consecutive ones: `1–3, 5`.
pub fn ranges(numbers: &[usize]) -> String {
    let runs = numbers.chunk_by(|a, b| a + 1 == *b).map(|run| match run {
        [one] => one.to_string(),
        [first, .., last] => format!("{first}\u{2013}{last}"),
        [] => String::new(),
    });
    runs.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_joined_to_ranges() {
        assert_eq!(ranges(&[1, 2, 3, 5, 7, 8]), "1\u{2013}3, 5, 7\u{2013}8");
        assert_eq!(ranges(&[4]), "4");
        assert_eq!(ranges(&[3, 2, 9, 10]), "3, 2, 9\u{2013}10");
        assert_eq!(ranges(&[]), "");
    }
}
