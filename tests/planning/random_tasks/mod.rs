//! Random pick-and-place tasks, compared with a replay by brute force. The replay repeats each plan step by step, with
//! its own kinematics, distances and rules, and checks dense samples.
//!
//! `CPLAN_TIMES=30 cargo test --test planning random_tasks -- --nocapture` tries thirty times as many.

mod flood;
mod judged;
mod pressed;
pub mod task;

use cplan::Outcome;
use cplan::engine::task::{TaskAnswer, plan, rest_to_rest};
use cplan::engine::{Method, Options};
use cplan::model::{RecordedOverlap, RecordedStep, RecordedTurn, Task};
use cplan::motion::Drive;
use cplan::space::{Configuration, Recording};
use cplan_cases::seeds;
use cplan_testkit::replay;

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

impl Count {
    /// Plans a task. Checks the answer by a replay, and by its lower bound.
    fn plan(&mut self, task: &Task, seed: u64) -> TaskAnswer {
        let answer = plan(task, &options(), &mut |_| {});
        match &answer.outcome {
            Outcome::Found(_) => self.done += 1,
            Outcome::Infeasible(_) => self.infeasible += 1,
            Outcome::Unknown(_) => self.unknown += 1,
        }
        self.legs += answer.legs.len();
        let all = answer.failed().is_none();
        if let Err(violation) = replay::replay(task, &answer, all) {
            panic!("seed {seed}: {violation}");
        }
        assert!(!all || answer.lower_bound <= answer.duration(), "seed {seed}: faster than the bound");
        answer
    }
}

/// Checks that an answer equals that of the task at rest, and is not slower. Returns the time that it saves.
fn seconds_saved(answer: &TaskAnswer, resting: &Task, seed: u64) -> f64 {
    let slower = plan(resting, &options(), &mut |_| {});
    assert_eq!(answer.outcome.status(), slower.outcome.status(), "seed {seed}");
    if answer.failed().is_some() {
        return 0.0;
    }
    let saved = slower.duration() - answer.duration();
    assert!(saved > -1e-6, "seed {seed}: slower than at rest by {} s", -saved);
    saved
}

/// Returns the content of a result file of a feasible task.
pub fn record(answer: &TaskAnswer) -> (Recording, Vec<RecordedStep>) {
    let sequence = &answer.outcome.found().expect("a motion").sequence;
    let trajectory = &sequence.trajectory;
    let rows = |rows: &[[f64; 2]]| rows.iter().map(|q| Configuration::from(*q)).collect::<Vec<_>>();
    let (position, velocity) = (rows(&trajectory.position), rows(&trajectory.velocity));
    let recording = Recording::new(position, Some(trajectory.time.clone()), Some(velocity)).unwrap();
    let steps = answer.legs.iter().enumerate().zip(&sequence.samples).map(|((index, leg), samples)| {
        let next = answer.legs.get(index + 1).map(|next| &next.overlap);
        let turned = RecordedOverlap {
            before_arrival: leg.overlap.turn_before_arrival,
            after_departure: next.map_or(0.0, |next| next.turn_after_departure),
        };
        RecordedStep {
            number: leg.step.number,
            cycle: leg.step.cycle,
            samples: samples.clone(),
            turn: leg.turn.map(|(turn, seconds)| RecordedTurn {
                from: turn.from,
                to: turn.to,
                seconds,
                overlap: turned,
            }),
            overlap: RecordedOverlap {
                before_arrival: leg.overlap.lowering,
                after_departure: next.map_or(0.0, |next| next.raising),
            },
            raising: 0.0,
            lowered: [None; 2],
            wrist: None,
            wrist_motion: leg.tool_deviation.map(|_| leg.timed.trajectory.wrist.clone()),
        }
    });
    (recording, steps.collect())
}

#[test]
fn planned_tasks_are_feasible() {
    let mut found = Count::default();
    for seed in seeds(200) {
        found.plan(&task::task(seed), seed);
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
        let mut task = task::with_arches(seed);
        let answer = found.plan(&task, seed);
        for leg in &answer.legs {
            overlaps += usize::from(leg.overlap.seconds() > 0.0);
            let seconds = leg.stroke.map_or(0.0, |stroke| stroke.seconds);
            partial += usize::from(0.0 < leg.overlap.lowering && leg.overlap.lowering < 0.9 * seconds);
        }
        task.stroke.iter_mut().for_each(|stroke| stroke.arch = None);
        saved += seconds_saved(&answer, &task, seed);
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
        let mut task = task::with_turns(seed);
        let answer = found.plan(&task, seed);
        let wrist = task.wrist.unwrap();
        for leg in &answer.legs {
            let [after, before] = [leg.overlap.turn_after_departure, leg.overlap.turn_before_arrival];
            departures += usize::from(after > 0.0);
            arrivals += usize::from(before > 0.0);
            partial += usize::from(leg.overlap.turn_seconds.is_some_and(|seconds| after.max(before) < 0.9 * seconds));
            if let Some((turn, seconds)) = leg.turn {
                let least = rest_to_rest((turn.to - turn.from).abs(), wrist.velocity, wrist.acceleration);
                stretched += usize::from(seconds > 1.01 * least);
            }
        }
        task.wrist.iter_mut().for_each(|wrist| wrist.turns_on_the_way = false);
        saved += seconds_saved(&answer, &task, seed);
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
