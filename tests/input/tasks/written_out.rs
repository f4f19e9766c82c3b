//! Random nested groups against a plain expansion; damaged worlds, which must not crash the program.

use super::{CELL, LoadedTask, step_texts, task_of};
use cplan::input::Overrides;
use cplan::model::{Action, Item, Step};
use proptest::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

#[derive(Debug, Clone)]
enum Node {
    /// A pick of the part or the cup, and a place.
    Pair(bool),
    Move,
    Group(usize, Vec<Node>),
}

fn nodes() -> impl Strategy<Value = Vec<Node>> {
    let leaf = prop_oneof![any::<bool>().prop_map(Node::Pair), Just(Node::Move)];
    let node = leaf.prop_recursive(3, 12, 3, |inner| {
        (1..4usize, prop::collection::vec(inner, 1..4)).prop_map(|(n, nodes)| Node::Group(n, nodes))
    });
    prop::collection::vec(node, 1..4)
}

fn toml(nodes: &[Node]) -> String {
    let of = |node: &Node| match node {
        Node::Pair(part) => {
            format!("{{ pick = \"{}\" }}, {{ place = {{ at = [0.5, 1.25] }} }}", if *part { "part" } else { "cup" })
        }
        Node::Move => "{ move = { joints = [0.25, 0.5] } }".into(),
        Node::Group(repeat, inner) => format!("{{ repeat = {repeat}, steps = {} }}", toml(inner)),
    };
    format!("[{}]", nodes.iter().map(of).collect::<Vec<_>>().join(", "))
}

/// Returns true if the group picks the part, which is renewed.
fn picks_part(node: &Node) -> bool {
    match node {
        Node::Pair(part) => *part,
        Node::Move => false,
        Node::Group(_, inner) => inner.iter().any(picks_part),
    }
}

fn length(node: &Node) -> usize {
    match node {
        Node::Pair(_) => 2,
        Node::Move => 1,
        Node::Group(_, inner) => inner.iter().map(length).sum(),
    }
}

/// Returns the steps as words, without cycles. `first` is the number of the first step.
fn expanded(nodes: &[Node], first: usize) -> Vec<(Option<usize>, String)> {
    let mut words = Vec::new();
    let mut number = first;
    for node in nodes {
        match node {
            Node::Pair(part) => {
                words.push((Some(number), format!("pick \"{}\"", if *part { "part" } else { "cup" })));
                words.push((Some(number + 1), "place at (0.5, 1.25) m".into()));
            }
            Node::Move => words.push((Some(number), "move to joints (0.25, 0.5)".into())),
            Node::Group(repeat, inner) => {
                let once = expanded(inner, number);
                let renewal = picks_part(node).then(|| (None, "renew part".to_owned()));
                words.extend(once.iter().cloned());
                for _ in 1..*repeat {
                    words.extend(renewal.iter().chain(&once).cloned());
                }
            }
        }
        number += length(node);
    }
    words
}

/// Checks the guarantees of a task: valid numbers, places after picks, and that no carried object is renewed.
fn assert_sound(loaded: &LoadedTask) {
    let task = &loaded.task;
    let mut carried = None;
    let mut step = |step: &Step| {
        assert!(step.speed > 0.0 && step.speed <= 1.0 && step.dwell >= 0.0 && step.dwell.is_finite());
        match &step.action {
            Action::Pick { object, supports, .. } => {
                assert_eq!(carried.replace(*object), None);
                assert!(*object < task.objects.len());
                assert!(supports.iter().all(|s| *s < loaded.scene.workspace().obstacles.len()));
                assert!(!supports.contains(&task.obstacle_number(*object)));
            }
            Action::Place { at, angle, .. } => {
                assert!(carried.take().is_some());
                assert!(at.iter().chain(angle).all(|v| v.is_finite()));
            }
            Action::Move(_) | Action::Follow(_) => {}
        }
        carried
    };
    let mut held = None;
    for item in &task.items {
        match item {
            Item::Step(s) => held = step(s),
            Item::AnyOrder(pairs) => {
                let picked: BTreeSet<String> = pairs.iter().map(|p| p[0].action.describe(&task.objects)).collect();
                assert_eq!(picked.len(), pairs.len());
                pairs.iter().flatten().for_each(|s| held = step(s));
            }
            Item::Renew(objects) => assert!(!objects.is_empty() && held.is_none_or(|h| !objects.contains(&h))),
        }
    }
}

/// Lines that are mixed at random: lines of objects, steps and groups, correct and wrong ones.
const LINES: &[&str] = &[
    "[[step]]",
    "[[step]]",
    "[[step.steps]]",
    "[[step.steps.steps]]",
    "[[object]]",
    "[task]",
    "pick = \"part\"",
    "pick = \"cup\"",
    "place = { at = [0.5, 1.5] }",
    "place = { at = [0.5, 1.0], angle = 1.5, supports = [\"part\"] }",
    "move = { joints = [0.0, 0.5] }",
    "move = { tip = [1e300, 1.0] }",
    "grasp = [0.0, 0.01]",
    "supports = [\"cup\", \"table\"]",
    "repeat = 3",
    "repeat = 400000",
    "order = \"free\"",
    "speed = 0.5",
    "dwell = 1e7",
    "name = \"new\"",
    "circle = { center = [0, 0], radius = 1e-12 }",
    "at = [-1.5, 0]",
    "renew = true",
    "step = []",
    "steps = []",
];

proptest! {
    #![proptest_config(cplan_cases::cases(150))]

    #[test]
    fn nested_groups_are_written_out(nodes in nodes(), repeat in 1..3usize) {
        let world = format!("step = {}\n{CELL}[task]\nrepeat = {repeat}\n", toml(&nodes));
        let loaded = task_of(&world, &Overrides::default()).map_err(|e| TestCaseError::fail(e.to_string()))?;
        assert_sound(&loaded);
        let mut cycles = BTreeMap::new();
        let expected: Vec<String> = expanded(&[Node::Group(repeat, nodes)], 1).into_iter().map(|(number, words)| {
            let Some(number) = number else { return words };
            let cycle = cycles.entry(number).and_modify(|c| *c += 1).or_insert(1);
            format!("{number}.{cycle}: {words}")
        }).collect();
        prop_assert_eq!(step_texts(&loaded), expected);
    }

    #[test]
    fn any_mixture_of_lines_is_read_or_refused(lines in prop::collection::vec(prop::sample::select(LINES), 1..14)) {
        match task_of(&format!("{CELL}{}\n", lines.join("\n")), &Overrides::default()) {
            Ok(loaded) => assert_sound(&loaded),
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }

    #[test]
    fn any_steps_are_read_or_refused(steps in prop::collection::vec(prop::sample::select(&LINES[6..18]), 1..8)) {
        let steps: Vec<String> = steps.iter().map(|line| format!("[[step]]\n{line}\n")).collect();
        match task_of(&format!("{CELL}{}", steps.concat()), &Overrides::default()) {
            Ok(loaded) => assert_sound(&loaded),
            Err(error) => prop_assert!(error.to_string().contains("world.toml")),
        }
    }
}
