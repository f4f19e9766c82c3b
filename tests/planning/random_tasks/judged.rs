//! The library's own judge of recorded tasks, on random tasks. Plans are free and fulfil the task. With larger objects
//! than planned for, most of them are not free.

use super::{options, record, task};
use cplan::check::{CollisionCheck, ReplayedStep};
use cplan::engine::Options;
use cplan::engine::task::plan;
use cplan::motion::Drive;
use cplan_cases::{seeds, times};

fn is_free(step: &ReplayedStep) -> bool {
    matches!(step.collision_check, CollisionCheck::Free { .. }) && step.turn.is_none_or(|turn| turn.verdict.is_ok())
}

#[test]
fn planned_tasks_are_judged_free() {
    let count = times(100);
    let options = Options { drive: Drive::default(), ..options() };
    let (mut done, mut turns, mut on_the_way, mut refuted) = (0_u64, 0_u64, 0_u64, 0_u64);
    for seed in seeds(100) {
        let mut task = match seed % 4 {
            0 => task::with_arches(seed),
            1 => task::with_turns(seed),
            _ => task::task(seed),
        };
        if seed % 3 == 0 {
            task.stroke.iter_mut().for_each(|stroke| stroke.jerk = Some(10.0 * stroke.acceleration));
            task.wrist.iter_mut().for_each(|wrist| wrist.jerk = Some(20.0 * wrist.acceleration));
        }
        let answer = plan(&task, &options, &mut |_| {});
        if answer.failed().is_some() {
            continue;
        }
        done += 1;
        let (recording, steps) = record(&answer);
        let judge = cplan::check::replay(&task, &recording, &steps);
        assert_eq!(judge.departure(), None, "seed {seed}");
        let mut clearance = f64::INFINITY;
        for (step, leg) in judge.zip(&answer.legs) {
            assert_eq!((&step.faults[..], &step.broken[..]), (&[][..], &[][..]), "seed {seed}, {:?}", step.step);
            assert!(is_free(&step), "seed {seed}: {:?}, {:?} in {:?}", step.collision_check, step.turn, step.step);
            assert_eq!(step.turn.is_some(), leg.turn.is_some(), "seed {seed}");
            turns += u64::from(step.turn.is_some());
            on_the_way += u64::from(leg.overlap.turn_seconds.is_some());
            if let CollisionCheck::Free { clearance: bound, .. } = step.collision_check {
                clearance = clearance.min(bound);
            }
        }
        assert!(clearance > 0.0, "seed {seed}");
        let mut larger = task.clone();
        larger.objects.iter_mut().flat_map(|o| &mut o.pieces).for_each(|piece| *piece = piece.grown(0.4));
        let is_refuted = !cplan::check::replay(&larger, &recording, &steps).all(|step| is_free(&step));
        refuted += u64::from(is_refuted);
    }
    println!("{done} of {count} tasks, {turns} turns, {on_the_way} on the way; {refuted} refuted with larger objects");
    assert!(done * 3 > count && turns > 0 && refuted * 2 > done, "{done} done, {turns} turns, {refuted} refuted");
    assert!(on_the_way * 25 > count, "{on_the_way} turns on the way");
}

/// Checks that the judge refuses turns that are shifted farther into motions than the plan allows: too fast for the
/// wrist, while the tool is lowered, or through an obstacle.
#[test]
fn shifted_turns_are_refused() {
    let options = Options { drive: Drive::default(), ..options() };
    let (mut shifted, mut refused) = (0, 0);
    let mut faults = std::collections::BTreeSet::new();
    for seed in seeds(60) {
        let task = task::with_turns(seed);
        let answer = plan(&task, &options, &mut |_| {});
        if answer.failed().is_some() {
            continue;
        }
        let (recording, steps) = record(&answer);
        for index in 0..steps.len() {
            for change in 0..4 {
                let mut changed = steps.clone();
                let stroke = changed[index].overlap;
                let Some(turn) = &mut changed[index].turn else { continue };
                let end = match turn.overlap.after_departure > 0.0 {
                    true => &mut turn.overlap.after_departure,
                    false => &mut turn.overlap.before_arrival,
                };
                match change {
                    // The wrist turns while the tool is lowered, or the arm must rest for longer.
                    0 if *end > 0.0 => *end = (*end - turn.seconds / 2.0).max(0.0),
                    1 if *end > 0.0 => turn.seconds *= 1.2,
                    // The wrist turns faster than planned.
                    2 if *end > 0.0 && stroke.before_arrival + stroke.after_departure == 0.0 => turn.seconds /= 1.2,
                    3 => *end += 100.0,
                    _ => continue,
                }
                shifted += 1;
                let judged: Vec<ReplayedStep> = cplan::check::replay(&task, &recording, &changed).collect();
                let is_refused = !judged.iter().all(|step| is_free(step) && step.faults.is_empty());
                assert!(is_refused, "seed {seed}, step {index}, change {change}: {:?}", changed[index]);
                refused += usize::from(is_refused);
                faults.extend(
                    judged.iter().flat_map(|step| &step.faults).map(|fault| format!("{fault:?}")[..6].to_owned()),
                );
            }
        }
    }
    println!("{refused} of {shifted} refused: {faults:?}");
    assert!(shifted > 20 && faults.len() >= 4, "{shifted}: {faults:?}");
}
