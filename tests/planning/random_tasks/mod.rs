//! Random pick-and-place tasks, compared with a replay by brute force. The replay repeats each plan step by step, with
//! its own kinematics, distances and rules, and checks dense samples.
//!
//! `CPLAN_TIMES=30 cargo test --test planning random_tasks -- --nocapture` tries thirty times as many.

mod flood;
mod judged;
mod pressed;
pub mod replay;
pub mod task;

use crate::common::random::seeds;
use cplan::Outcome;
use cplan::engine::task::plan;
use cplan::engine::{Method, Options};
use cplan::motion::Drive;

/// Numbers of tasks that are planned, proven infeasible, and unknown.
#[derive(Debug, Default, PartialEq)]
struct Count {
    done: usize,
    infeasible: usize,
    unknown: usize,
    legs: usize,
}

fn options() -> Options {
    // Samples need not be dense: the replay interpolates.
    let drive = Drive { period: 0.05, ..Drive::default() };
    Options { levels: 4, boxes: 20_000, drive, ..Method::Visibility.into() }
}

#[test]
fn planned_tasks_are_feasible() {
    let mut found = Count::default();
    for seed in seeds(200) {
        let task = task::task(seed);
        let answer = plan(&task, &options(), &mut |_| {});
        match &answer.outcome {
            Outcome::Found(_) => found.done += 1,
            Outcome::Infeasible(_) => found.infeasible += 1,
            Outcome::Unknown(_) => found.unknown += 1,
        }
        found.legs += answer.legs.len();
        let all = answer.failed().is_none();
        if let Err(violation) = replay::replay(&task, &answer, all) {
            panic!("seed {seed}: {violation}");
        }
        assert!(!all || answer.lower_bound <= answer.duration(), "seed {seed}: faster than the bound");
    }
    println!("{found:?}");
    assert!(found.done * 2 > found.infeasible + found.unknown, "hardly any task can be done: {found:?}");
}

/// Checks that the oracle refuses recordings of other tasks: those for smaller objects are not valid for larger ones,
/// nor for other targets.
#[test]
fn recordings_of_another_task_are_refused() {
    let (mut larger, mut elsewhere, mut done) = (0, 0, 0);
    for seed in seeds(40) {
        let task = task::task(seed);
        let answer = plan(&task, &options(), &mut |_| {});
        if answer.failed().is_some() {
            continue;
        }
        done += 1;
        let mut changed = task.clone();
        changed.objects.iter_mut().flat_map(|o| &mut o.pieces).for_each(|piece| *piece = piece.grown(0.4));
        larger += usize::from(replay::replay(&changed, &answer, true).is_err());
        let mut changed = task.clone();
        changed.objects[0].at.translation.x += 1e-6;
        elsewhere += usize::from(replay::replay(&changed, &answer, true).is_err());
    }
    assert!(done > 0 && elsewhere == done, "{elsewhere} of {done}");
    assert!(larger * 2 > done, "{larger} of {done}");
}
