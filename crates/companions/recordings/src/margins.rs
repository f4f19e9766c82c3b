//! The margins of a recorded motion to obstacles and limits.

use cplan_handling::{HeldMotion, Recording, TimedScene};
use cplan_motion::recorded::swept_by_tool;
use cplan_motion::{BodyNames, MarginSearch, Margins, MotionStretch};
use cplan_world::LoadedScene;

/// Returns the margins of a motion that is proven free with this clearance, in metres. If a tool moves, each part of
/// the arm counts with all heights and angles that it takes during the motion.
pub(super) fn margins(
    loaded: &LoadedScene,
    recording: &Recording,
    held: &[HeldMotion],
    clearance: Option<f64>,
) -> Margins {
    let fixed = loaded.without_objects();
    let obstacles = loaded.scene.workspace().obstacles.iter();
    let objects = obstacles.skip(fixed.0.workspace().obstacles.len()).map(|object| object.name.clone());
    let loose = |timed: TimedScene| timed.scene.loose_obstacles().len();
    let moving_objects = loaded.scene.loose_obstacles().iter().skip(loose(TimedScene::from(&fixed.0)));
    let objects = objects.chain(moving_objects.map(|object| object.obstacle.name.clone())).collect();
    let names = BodyNames { fixed: fixed.0.workspace().obstacles.len(), objects };
    let mut search = MarginSearch::new(loaded.scene.arm(), names);
    let (pieces, begin) = (recording.pieces(), 0.0);
    let mut examine = |scene: TimedScene, known: f64| {
        search.examine(&MotionStretch { scene, pieces: &pieces, begin, beside: 0.0, known });
    };
    if held.is_empty() || loaded.has_steps() {
        examine(loaded.timed(), 0.0);
    }
    if !held.is_empty() {
        let (scene, trajectories) =
            if loaded.has_steps() { (&fixed.0, &fixed.1) } else { (&loaded.scene, &loaded.trajectories) };
        let swept = swept_by_tool(scene, held);
        examine(TimedScene { scene: &swept, trajectories }, clearance.unwrap_or(f64::MAX));
    }
    Margins { lacks_times: recording.times().is_none(), ..search.margins() }
}
