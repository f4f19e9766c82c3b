//! Any bytes as a world, for an arm with limits and for one that turns without end. Short tasks are planned, with
//! little effort.
#![no_main]

use cplan::Options;
use cplan::engine::Method;
use cplan::engine::task::plan;
use cplan::input::{LoadedScene, Overrides, Rules, load, load_scene};
use cplan_fuzz::{Files, shipped};
use libfuzzer_sys::fuzz_target;
use std::sync::LazyLock;

static FILES: LazyLock<Files> = LazyLock::new(Files::empty);

/// Largest number of steps of tasks that are planned. Longer tasks are only loaded.
const MAX_STEPS: usize = 4;

/// Reads the task of a world with steps. It must be refused with a message, or it can be planned and reported.
fn task(scene: LoadedScene) {
    let task = match scene.resolve(&Overrides::default(), Rules::Plan) {
        Ok(loaded) => loaded.task.expect("a world with steps"),
        Err(error) => return assert!(!error.to_string().is_empty()),
    };
    assert!(task.start.iter().all(|v| v.is_finite()));
    if task.steps().count() > MAX_STEPS {
        return;
    }
    let options = Options { levels: 1, boxes: 200, ..Method::Visibility.into() };
    let answer = plan(&task, &options, &mut |_| {});
    assert!(answer.failed().is_none() || !answer.failed().unwrap().reasons.is_empty(), "no reason");
}

fuzz_target!(|bytes: &[u8]| {
    let world = FILES.write("world.toml", bytes);
    for robot in ["robots/planar_2r_continuous.urdf", "robots/gantry.urdf"] {
        if let Some(scene) = load_scene(&shipped(robot), &world).ok().filter(LoadedScene::has_steps) {
            task(scene);
            continue;
        }
        match load(&shipped(robot), &world, &Overrides::default()) {
            Ok(loaded) => {
                let problem = loaded.problem;
                assert!(!problem.goals().is_empty());
                for q in problem.goals().points().chain([problem.start()]) {
                    assert!(q.iter().all(|v| v.is_finite()));
                    assert!(problem.scene().clearance(q) > 0.0, "an end is not free");
                }
            }
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
});
