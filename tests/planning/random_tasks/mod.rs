//! Random pick-and-place tasks, compared with a replay by brute force. The replay repeats each plan step by step, with
//! its own kinematics, distances and rules, and checks dense samples.
//!
//! `CPLAN_TIMES=30 cargo test --test planning random_tasks -- --nocapture` tries thirty times as many.

mod flood;
mod judged;
mod pressed;
pub mod replay;
pub mod task;

use cplan::Outcome;
use cplan::engine::task::plan;
use cplan::engine::{Method, Options};
use cplan::motion::Drive;
use cplan_cases::seeds;

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

/// Checks tasks in which the tool is lowered and raised while the arm moves: free at the heights of each moment, and
/// faster than with strokes at rest.
#[test]
fn planned_arches_are_feasible() {
    let (mut found, mut overlaps, mut partial, mut saved) = (Count::default(), 0, 0, 0.0);
    for seed in seeds(120) {
        let task = task::with_arches(seed);
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
        for leg in &answer.legs {
            overlaps += usize::from(leg.overlap.seconds() > 0.0);
            let seconds = leg.stroke.map_or(0.0, |stroke| stroke.seconds);
            partial += usize::from(0.0 < leg.overlap.lowering && leg.overlap.lowering < 0.9 * seconds);
            saved += leg.overlap.seconds();
        }
        let mut resting = task.clone();
        resting.stroke.iter_mut().for_each(|stroke| stroke.arch = None);
        let slower = plan(&resting, &options(), &mut |_| {});
        assert_eq!(answer.outcome.status(), slower.outcome.status(), "seed {seed}");
        assert!(!all || answer.duration() < slower.duration() + 1e-6, "seed {seed}: slower than with strokes at rest");
    }
    println!("{found:?}, {overlaps} motions with overlaps, {partial} with a part of the lowering, {saved} s saved");
    assert!(found.done > 20 && overlaps > 50 && partial > 5, "{found:?}, {overlaps} overlaps, {partial} partial");
}

/// Checks tasks in which the wrist turns objects while the arm moves: free at the heights and angles of each moment,
/// within the limits of the wrist, and never slower than with turns at rest.
#[test]
fn turns_during_motions_are_feasible() {
    let (mut found, mut departures, mut arrivals, mut stretched, mut partial, mut saved) =
        (Count::default(), 0, 0, 0, 0, 0.0);
    for seed in seeds(120) {
        let task = task::with_turns(seed);
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
        let mut resting = task.clone();
        resting.wrist.iter_mut().for_each(|wrist| wrist.turns_on_the_way = false);
        for leg in &answer.legs {
            departures += usize::from(leg.overlap.turn_after_departure > 0.0);
            arrivals += usize::from(leg.overlap.turn_before_arrival > 0.0);
            partial += usize::from(leg.overlap.turn_seconds.is_some_and(|seconds| {
                leg.overlap.turn_after_departure.max(leg.overlap.turn_before_arrival) < 0.9 * seconds
            }));
            if let Some((turn, seconds)) = leg.turn {
                let wrist = task.wrist.unwrap();
                let least =
                    cplan::engine::task::rest_to_rest((turn.to - turn.from).abs(), wrist.velocity, wrist.acceleration);
                stretched += usize::from(seconds > 1.01 * least);
            }
        }
        let slower = plan(&resting, &options(), &mut |_| {});
        assert_eq!(answer.outcome.status(), slower.outcome.status(), "seed {seed}");
        assert!(!all || answer.duration() < slower.duration() + 1e-6, "seed {seed}: slower than with turns at rest");
        saved += if all { slower.duration() - answer.duration() } else { 0.0 };
    }
    println!(
        "{found:?}, {departures} turns after departures and {arrivals} before arrivals, {partial} partial, \
         {stretched} stretched, {saved} s saved"
    );
    assert!(found.done > 20 && departures > 5 && arrivals > 50, "{found:?}, {departures}, {arrivals}");
    assert!(partial > 3 && stretched > 3, "{partial} partial, {stretched} stretched");
}

/// Checks that the oracle sees collisions during strokes: a tool that is lowered earlier than planned hits something.
#[test]
fn a_tool_that_is_lowered_too_early_is_refused() {
    let mut hits = 0;
    for seed in seeds(120) {
        let task = task::with_arches(seed);
        let answer = plan(&task, &options(), &mut |_| {});
        for index in 0..answer.legs.len() {
            let leg = &answer.legs[index];
            let Some(stroke) = leg.stroke else { continue };
            let most = stroke.seconds.min(leg.timed.trajectory.duration() - leg.overlap.raising);
            let earlier = most - leg.overlap.lowering;
            if leg.overlap.lowering == 0.0 || earlier < 0.01 {
                continue;
            }
            let mut changed = answer.clone();
            changed.legs[index].overlap.lowering = most;
            changed.legs[index + 1..].iter_mut().for_each(|leg| leg.begin -= earlier);
            let refused = replay::replay(&task, &changed, answer.failed().is_none());
            hits += usize::from(refused.is_err_and(|why| why.contains(" from ")));
        }
    }
    assert!(hits >= 3, "only {hits} are refused");
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
