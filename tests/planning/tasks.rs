//! Checks that every shipped task has the outcome that its file states, and that its plan can be executed.
//!
//! The first comment of a task's world names its robot (`# robot: scara`) and the outcome (`# expect: done` or `#
//! expect: infeasible`).

use cplan::Outcome;
use cplan::engine::task::{TaskAnswer, plan};
use cplan::engine::{Method, Options};
use cplan::model::{
    Action, Goal, Holding, Item, Object, Step, Task, TimedWorkspace, Workspace, equivalent_values, inverse,
};
use cplan::space::Configuration;
use cplan_testkit::problems::recheck;
use cplan_testkit::replay;
use cplan_testkit::shipped::{self, Shipped};

fn options() -> Options {
    Method::Visibility.into()
}

fn task_of(world: &Shipped) -> Task {
    world.problem().task().expect("a world with steps").clone()
}

fn shipped_task(name: &str) -> Task {
    task_of(&shipped::world(&format!("tasks/{name}")))
}

fn plan_task(task: &Task) -> TaskAnswer {
    plan(task, &options(), &mut |_| {})
}

#[test]
fn every_task_gives_its_stated_outcome() {
    let worlds = shipped::worlds("tasks");
    assert!(worlds.len() >= 8, "only {} tasks", worlds.len());
    for world in worlds {
        let (task, name) = (task_of(&world), &world.name);
        let answer = plan_task(&task);
        let outcome = match &answer.outcome {
            Outcome::Found(_) => "done",
            Outcome::Infeasible(_) => "infeasible",
            Outcome::Unknown(_) => "unknown",
        };
        assert_eq!(outcome, world.expect, "{name}: {:?}", answer.outcome);
        replay::replay(&task, &answer, outcome == "done").unwrap_or_else(|what| panic!("{name}: {what}"));
        if outcome == "done" {
            assert_eq!(answer.legs.len(), task.steps().count(), "{name}");
            assert!(answer.lower_bound <= answer.duration(), "{name}");
            assert!(answer.duration() <= 1.35 * answer.lower_bound, "{name}: {answer:?}");
        }
    }
}

/// Checks a level and a rigid payload in the same world, which differ only in the key for that.
#[test]
fn holding_level_or_rigid_makes_the_difference() {
    let [level, rigid] = ["slot_level", "slot_rigid"].map(shipped_task);
    let unnamed = |workspace: &TimedWorkspace| TimedWorkspace {
        fixed: Workspace { name: String::new(), ..workspace.fixed.clone() },
        movers: workspace.movers.clone(),
    };
    let differ = |task: &Task| Task {
        objects: task.objects.iter().map(|o| Object { holding: Holding::Rigid, ..o.clone() }).collect(),
        workspace: unnamed(&task.workspace),
        items: Vec::new(),
        ..task.clone()
    };
    assert_eq!(differ(&level), differ(&rigid));
    assert!(level.objects.iter().all(|o| o.holding == Holding::Level));
    assert_eq!(plan_task(&level).failed(), None);
    assert!(matches!(plan_task(&rigid).outcome, Outcome::Infeasible(_)));
}

/// Checks a passage through which the arm can move empty-handed, but not with the board.
#[test]
fn carrying_closes_a_passage() {
    let task = shipped_task("board_and_gate");
    let answer = plan_task(&task);
    let Outcome::Infeasible(impossible) = &answer.outcome else { panic!("{:?}", answer.outcome) };
    assert_eq!(impossible.step.number, 3, "the board is what does not pass");
    assert_eq!(answer.legs.len(), 2, "the way there and back is done before");
    // The report about the failed motion must be true. A gantry has one IK solution for a place: its coordinates.
    let [to] = &impossible.ik_solutions[..] else { panic!("{:?}", impossible.ik_solutions) };
    assert_eq!((impossible.from, to.ik_solution), (Configuration::new(0.4, 1.1), Configuration::new(1.6, 0.9)));
    assert!(impossible.reasons[0].starts_with("to joints (1.6, 0.9) m: there is no path"), "{:?}", impossible.reasons);
    let clearance = impossible.scene.workspace().clearance;
    let stuck = to.proof.as_ref().expect("a proof").collision_boxes();
    assert_eq!(recheck(stuck, &impossible.scene, impossible.from, &to.ik_solution.into(), clearance), Ok(()));
    assert!(!stuck.is_empty());
}

/// Checks a rail that can be picked with two grips, each of which leaves two IK solutions to reach the slot.
#[test]
fn reasons_name_the_motions_that_were_tried() {
    let task = shipped_task("slot_rigid");
    let answer = plan_task(&task);
    let Outcome::Infeasible(impossible) = &answer.outcome else { panic!("{:?}", answer.outcome) };
    assert_eq!((impossible.ik_solutions.len(), impossible.reasons.len()), (2, 4));
    let from = format!("from joints ({:.4}, {:.4}) rad to (", impossible.from[0], impossible.from[1]);
    assert_eq!(impossible.reasons.iter().filter(|reason| reason.starts_with(&from)).count(), 2);
    assert!(impossible.reasons.iter().all(|reason| reason.starts_with("from joints (")));
    for to in &impossible.ik_solutions {
        assert!(!impossible.scene.obstructions(to.ik_solution).is_empty() && to.proof.is_none(), "{to:?}");
    }
}

/// Returns all IK solutions within the limits that put the tip at a step's target, from the closed form.
fn ik_solutions(task: &Task, step: &Step) -> Vec<Configuration> {
    let target = match &step.action {
        Action::Pick { object, .. } => task.objects[*object].at.translation,
        Action::Place { at, .. } => *at,
        Action::Move(_) | Action::Follow(_) => panic!("picks and places only"),
    };
    let branches = inverse(&task.arm, target, task.start).branches;
    let copies = |q: &Configuration| {
        let [a, b] = [0, 1].map(|k| equivalent_values(task.arm.joints[k].range, true, q[k]));
        a.into_iter()
            .flat_map(move |a| b.clone().into_iter().map(move |b| Configuration::new(a, b)))
            .collect::<Vec<_>>()
    };
    branches.iter().flat_map(copies).collect()
}

/// Checks that always choosing the IK solution that is nearest in time makes the task at least a fifth slower.
#[test]
fn the_greedy_choice_of_ik_solutions_is_slower() {
    let task = shipped_task("elbow_choice");
    let mut taken: Vec<Item> = Vec::new();
    let mut greedy = 0.0;
    for step in task.steps() {
        // A move to an IK solution, with the step done there, forces that IK solution. Objects lie below the arm.
        let forced = |q: &Configuration| {
            let there = Step { action: Action::Move(Goal::Joints(*q)), dwell: 0.0, ..step.clone() };
            let items = taken.iter().cloned().chain([Item::Step(there), Item::Step(step.clone())]).collect();
            let answer = plan_task(&Task { items, ..task.clone() });
            (answer.failed().is_none()).then(|| (answer.duration(), *q))
        };
        let all = ik_solutions(&task, step);
        let (seconds, q) =
            all.iter().filter_map(forced).min_by(|a, b| a.0.total_cmp(&b.0)).expect("an IK solution that can be taken");
        let there = Step { action: Action::Move(Goal::Joints(q)), dwell: 0.0, ..step.clone() };
        taken.extend([Item::Step(there), Item::Step(step.clone())]);
        greedy = seconds;
    }
    let ours = plan_task(&task).duration();
    assert!(greedy >= 1.2 * ours, "greedy {greedy} s, ours {ours} s");
}

/// Checks that cycles which end with the same world are planned once, even if the orientation of a rigid payload
/// depends on that of the arm.
#[test]
fn identical_cycles_are_planned_once() {
    let once = plan_task(&shipped_task("feeder"));
    assert_eq!(once.legs.len(), 300);
    assert!(once.motions < 40, "{} motions", once.motions);
    let mut task = shipped_task("elbow_choice");
    let first: Vec<Step> = task.steps().cloned().collect();
    let home = Step { action: Action::Move(Goal::Joints(task.start)), number: 3, ..first[0].clone() };
    let cycle = |cycle| first.iter().chain([&home]).map(move |step| Item::Step(Step { cycle, ..step.clone() }));
    task.items = (1..=50).flat_map(cycle).collect();
    let answer = plan_task(&task);
    assert_eq!(answer.failed(), None);
    assert_eq!(answer.legs.len(), 150);
    assert!(answer.motions < 60, "{} motions", answer.motions);
}
