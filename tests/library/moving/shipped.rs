//! The shipped worlds with moving obstacles, each with the outcome that its file states.

use cplan::motion::{Drive, Objective};
use cplan::{Options, Outcome, plan};
use cplan_testkit::shipped;

#[test]
fn shipped_worlds_have_the_stated_outcome() {
    let worlds = shipped::worlds("moving");
    assert!(worlds.len() >= 5);
    for world in worlds {
        let (name, problem) = (&world.name, world.problem());
        let plan = plan(&problem, &Options::default()).unwrap();
        match (world.expect.as_str(), plan.outcome()) {
            ("found", Outcome::Found(_)) => {
                let timing = plan.timing().expect("something moves");
                assert!(timing.free_until.is_none() && timing.clearance.is_some_and(|kept| kept > 0.0), "{name}");
            }
            ("unknown", Outcome::Unknown(reason)) => {
                assert!(reason.contains("avoids the moving obstacles (proven)"), "{name}: {reason}")
            }
            (expected, outcome) => panic!("{name}: {outcome:?} instead of {expected}"),
        }
    }
}

/// Checks that the printed duration is that of the whole motion, including waits, if the motion is optimised for time.
#[test]
fn the_duration_beside_its_bound_is_that_of_the_motion() {
    let problem = shipped::world("moving/crossing").problem();
    let drive = Drive { optimize: Objective::Time, ..Drive::default() };
    let plan = plan(&problem, &Options { drive, ..Options::default() }).unwrap();
    let (duration, fastest) =
        (plan.trajectory().unwrap().duration(), plan.motion().unwrap().1.outcome.found().unwrap().fastest.unwrap());
    assert_eq!(fastest.duration, duration);
    assert!(duration > 2.9 && fastest.lower_bound < duration);
}
