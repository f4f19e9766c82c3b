//! Motions that are found are free at all times, and end as early as those that brute force finds.

use cplan::{Options, Outcome, plan};
use cplan_cases::{seeds, uses_default_cases};
use cplan_testkit::moving::{Moving, position};

/// Number of moments between two samples that are checked.
const BETWEEN: usize = 3;

/// Step between the waiting times at the start that brute force tries, in seconds.
const STEP: f64 = 0.02;

/// Distance that brute force keeps from moving obstacles, in metres. It is nearly the greatest distance that anything
/// moves in one step.
const APART: f64 = 2e-2;

#[test]
fn motions_are_free_at_all_times_and_early() {
    let (mut found, mut waited, mut detours) = (0, 0, 0);
    for world in Moving::all(seeds(16)) {
        let plan = plan(&world.problem(), &Options { bounded: false, ..Options::default() }).expect("a plan");
        let Outcome::Found(trajectory) = plan.outcome() else { continue };
        let timing = plan.timing().expect("of a world in which something moves");
        found += 1;
        waited += usize::from(!timing.waits.is_empty());
        detours += usize::from(timing.ways > 1);
        let goal = trajectory.position[trajectory.position.len() - 1].into();
        for sample in 0..trajectory.time.len() - 1 {
            for k in 0..BETWEEN {
                let (time, q) = position(trajectory, sample, k as f64 / BETWEEN as f64);
                assert!(world.room(q, time) > -1e-9, "{}: in contact at {time} s", world.name);
            }
        }
        let end = trajectory.duration();
        let until = timing.free_until.unwrap_or(world.horizon());
        for k in 0..=50 {
            let time = end + (until - end) * f64::from(k) / 50.0;
            assert!(world.room(goal, time) > -1e-6, "{}: at the goal in contact at {time} s of {until}", world.name);
        }
        if let Some(until) = timing.free_until {
            let after = world.movers_at(until + 5e-3).room(goal);
            assert!(after < 0.02, "{}: free at the goal after {until} s, too", world.name);
        }
        for wait in &timing.waits {
            let middle = trajectory.time.partition_point(|&time| time <= (wait.from + wait.to) / 2.0);
            assert_eq!(trajectory.position[middle], wait.at, "{}", world.name);
        }
        if timing.free_until.is_none()
            && let Some(least) = waiting_at_the_start(&world)
        {
            assert!(end <= least + 2.0 * STEP, "{}: {end} s, waiting at the start {least}", world.name);
        }
    }
    println!("{found} found, {waited} with waits, {detours} after more than one way");
    assert!(!uses_default_cases() || (found > 10 && waited > 1), "{found} found, {waited} with waits");
}

/// Returns the earliest end of a motion that begins as soon as the path is free and stays at the goal. Returns `None`
/// if the arm cannot wait at the start, or if there is no motion.
fn waiting_at_the_start(world: &Moving) -> Option<f64> {
    let standing = plan(&world.static_problem(), &Options { bounded: false, ..Options::default() }).expect("a plan");
    let trajectory = standing.trajectory()?;
    let last = trajectory.time.len() - 1;
    let steps: Vec<_> = (0..last).map(|sample| position(trajectory, sample, 0.0)).collect();
    let (start, goal) = (trajectory.position[0].into(), trajectory.position[last].into());
    // The moving obstacles at each step of time.
    let horizon = world.horizon() + trajectory.duration();
    let movers: Vec<_> = (0..(horizon / STEP) as usize).map(|k| world.movers_at(k as f64 * STEP)).collect();
    let is_clear =
        |q, time: f64| movers.get((time / STEP).round() as usize).is_none_or(|movers| movers.room(q) > APART);
    let lasts = (trajectory.duration() / STEP).ceil() as usize;
    for k in 0..movers.len() - lasts {
        let delay = k as f64 * STEP;
        if !is_clear(start, delay) {
            return None;
        }
        if steps.iter().all(|&(time, q)| is_clear(q, delay + time))
            && movers[k + lasts..].iter().all(|m| m.room(goal) > APART)
        {
            return Some(delay + trajectory.duration());
        }
    }
    None
}
