//! Plans that are stopped. They return nothing but the interruption, and leave no state behind.

use cplan::Outcome;
use cplan::engine::task::plan;
use cplan::engine::{Answer, Method, Options, Planner, solve};
use cplan::interrupt::{Interrupt, Interrupted};
use cplan::planner::Proposal;
use cplan::proofs::{connectivity, slab_connectivity};
use cplan_testkit::shipped;
use std::time::{Duration, Instant};

fn options(method: Method) -> Options {
    Options { levels: 2, ..Planner::named(method).with_cells(64).into() }
}

/// Returns the content of an answer without the times.
fn report(answer: &Answer) -> (Proposal, String) {
    let verdict = match &answer.outcome {
        Outcome::Found(path) => format!("{:?}", path.path().waypoints()),
        Outcome::Infeasible(proof) => format!("{:?}", proof.collision_boxes()),
        Outcome::Unknown(unknown) => unknown.to_string(),
    };
    (answer.run.outcome.clone(), verdict)
}

#[test]
fn every_planner_comes_by_a_checkpoint() {
    let problem = shipped::world("crowd").motion();
    for method in Method::ALL {
        let interrupt = Interrupt::new();
        interrupt.set();
        let stopped = interrupt.run(|| solve(&problem, &options(method), &mut |_| ()));
        assert_eq!(stopped.err(), Some(Interrupted::Set), "{method}");
    }
}

/// Checks each checkpoint: a plan that is stopped there reports the stop, or is complete. The next plan is not
/// affected.
#[test]
fn a_stopped_plan_prints_and_writes_nothing() {
    for world in ["shelf", "crowd", "singular_closed"] {
        let problem = shipped::world(world).motion();
        for method in Method::ALL {
            let begun = Instant::now();
            let expected = report(&solve(&problem, &options(method), &mut |_| ()));
            let took = begun.elapsed();
            let mut stopped = 0;
            for part in 0..6 {
                let deadline = Instant::now() + took.mul_f64(f64::from(part) / 5.0);
                match Interrupt::new().with_deadline(deadline).run(|| solve(&problem, &options(method), &mut |_| ())) {
                    Ok(answer) => assert_eq!(report(&answer), expected, "{world} {method}"),
                    Err(why) => {
                        assert_eq!(why, Interrupted::TimeUp);
                        stopped += 1;
                    }
                }
            }
            assert!(stopped > 0, "{world} {method}: the first deadline has passed when the plan begins");
        }
    }
}

/// Checks that another thread can stop a search for a proof that would take minutes.
#[test]
fn proofs_and_tasks_stop_too() {
    let problem = shipped::world("thin_wall_closed").motion();
    let (scene, start, goals) = (problem.scene(), problem.start(), problem.goals());
    let stopped = |work: &mut dyn FnMut()| {
        let interrupt = Interrupt::new();
        let handle = interrupt.clone();
        let setter = std::thread::spawn(move || {
            std::thread::sleep(Duration::from_millis(20));
            handle.set();
        });
        let result = interrupt.run(|| {
            loop {
                work();
            }
        });
        setter.join().unwrap();
        result == Err::<(), _>(Interrupted::Set)
    };
    assert!(stopped(&mut || drop(slab_connectivity(scene, start, goals, 0.0, usize::MAX, usize::MAX))));
    assert!(stopped(&mut || drop(connectivity(scene, start, goals, 0.0, usize::MAX))));
    let problem = shipped::world("tasks/kitting_cell").problem();
    let task = problem.task().expect("a task");
    let drive = cplan::motion::Drive::default();
    let options = Options { drive, ..Method::Visibility.into() };
    assert!(stopped(&mut || drop(plan(task, &options, &mut |_| ()))));
}
