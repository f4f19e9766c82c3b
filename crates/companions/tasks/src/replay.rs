//! Replays: how the planner found each motion of a task.

use super::motion_path::{of_legs, planned_again};
use cplan_handling::{Action, Task};
use cplan_legs::{Leg, MotionReplay, TaskAnswer, TaskReplay};
use cplan_solver::{Options, Phase, Replay, Shows};
use std::sync::Arc;

/// Returns the replay of the answer to a task. Plans its motions again, with the same options.
pub fn replay(task: &Task, options: &Options, answer: &TaskAnswer) -> TaskReplay {
    let options = of_legs(options);
    let mut reported: Vec<&Leg> = Vec::new();
    let legs = answer.legs.iter().map(|leg| {
        let same = |other: &&Leg| Arc::ptr_eq(&other.timed, &leg.timed) && other.scene == leg.scene;
        reported.iter().position(same).unwrap_or_else(|| {
            reported.push(leg);
            reported.len() - 1
        })
    });
    let legs = legs.collect();
    TaskReplay { motions: reported.into_iter().map(|leg| replay_of_leg(task, &options, leg)).collect(), legs }
}

fn replay_of_leg(task: &Task, options: &Options, leg: &Leg) -> MotionReplay {
    if let Action::Follow(_) = leg.step.action {
        return without_search("The line, which the tip follows within the tolerance", leg);
    }
    let path = leg.timed.curve.curve().path();
    let ends = [path.start(), task.arm.topology().wrap(path.goal())];
    match planned_again(&leg.scene, task.workspace.fixed.obstacles.len(), ends, options) {
        Some((problem, answer)) => {
            let mut replay = Replay::new(&problem, options, &answer);
            let gone = problem.scene() != &*leg.scene;
            if let (true, Some(first)) = (gone, replay.phases.first_mut()) {
                first.caption.push_str("; objects away from the path are ignored");
            }
            MotionReplay { replay, trace: Some(answer.drawn().into_owned()) }
        }
        None => without_search("The straight path: certified, and there is no shorter one", leg),
    }
}

/// Returns the replay of a motion whose path was not searched for.
fn without_search(caption: &str, leg: &Leg) -> MotionReplay {
    let phase =
        Phase { caption: caption.to_owned(), shows: Shows::Path, events: leg.path().waypoints().len(), length: None };
    MotionReplay { replay: Replay { phases: vec![phase] }, trace: None }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan;
    use cplan_model::Outcome;
    use cplan_robot::Source;
    use cplan_world::{Overrides, Rules, scene_from};

    fn plan_task(urdf: &str, world: &str, options: &Options) -> (Task, TaskAnswer) {
        let read = |file: &str| {
            let path = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../..")).join(file);
            Source::read(&path).unwrap()
        };
        let scene = scene_from(read(urdf), read(world)).unwrap();
        let task = scene.resolve(&Overrides::default(), Rules::Plan).unwrap().task.unwrap();
        let answer = plan(&task, options, &mut |_| ());
        (task, answer)
    }

    /// Tests that each motion is planned in the same way again. The path is the same, except for the last digits of its
    /// end.
    #[test]
    fn the_replay_matches_the_run() {
        let (mut among_few, mut straight) = (0, 0);
        for (urdf, world) in [
            ("robots/rrbot_vertical.urdf", "workspaces/tasks/tower.toml"),
            ("robots/scara.urdf", "workspaces/tasks/kitting_cell.toml"),
            ("robots/rail_arm.urdf", "workspaces/tasks/sorting.toml"),
        ] {
            let options = Options::default();
            let (task, answer) = plan_task(urdf, world, &options);
            for leg in &answer.legs {
                let path = leg.timed.curve.curve().path();
                let ends = [path.start(), task.arm.topology().wrap(path.goal())];
                let own = task.workspace.fixed.obstacles.len();
                let Some((problem, again)) = planned_again(&leg.scene, own, ends, &of_legs(&options)) else {
                    straight += 1;
                    assert_eq!(path.waypoints().len(), 2, "{world}");
                    continue;
                };
                among_few += usize::from(problem.scene() != &*leg.scene);
                let Outcome::Found(found) = &again.outcome else { panic!("{world}: no path") };
                let (reported, real) = (found.path().waypoints(), path.waypoints());
                assert_eq!(reported.len(), real.len(), "{world}, step {}", leg.step.number);
                assert!(
                    reported.iter().zip(real).all(|(a, b)| (a - b).norm() < 1e-9),
                    "{world}, step {}",
                    leg.step.number
                );
            }
            let replay = replay(&task, &options, &answer);
            assert_eq!(replay.legs.len(), answer.legs.len());
            assert!(replay.legs.iter().all(|&reported| reported < replay.motions.len()));
            assert!(replay.motions.iter().all(|reported| reported.replay.phases.last().unwrap().shows == Shows::Path));
        }
        assert!(among_few > 3 && straight > 3, "{among_few} among few, {straight} straight");
    }
}
