//! The result of a step, from the checks of its motion and of the arm at rest.

use cplan_handling::{ObstacleTrajectory, Recording, Task, TimedScene};
use cplan_model::Scene;
use cplan_motion::recorded::{CollisionCheck, check_collision};
use std::ops::RangeInclusive;

/// A scene in which a part of the recording was judged, and the result. Its samples count from the beginning of the
/// recording.
pub(super) struct Judged {
    pub scene: Scene,
    pub trajectories: Vec<ObstacleTrajectory>,
    pub check: CollisionCheck,
}

impl Judged {
    /// Judges a part of the recording. `None` if the recording lacks these samples.
    pub fn of(
        task: &Task,
        recording: &Recording,
        samples: RangeInclusive<usize>,
        scene: Scene,
        trajectories: Vec<ObstacleTrajectory>,
    ) -> Option<Self> {
        let (first, motion) = (*samples.start(), recording.part(samples)?);
        let timed = TimedScene { scene: &scene, trajectories: &trajectories };
        let mut check = check_collision(timed, &motion, task.workspace.fixed.clearance);
        check.moments_mut().for_each(|moment| moment.sample += first);
        Some(Self { scene, trajectories, check })
    }

    /// Adds the result of a further check. The first result that is not free stays; of two free ones, the smaller clearance.
    pub fn add(&mut self, other: Self) {
        match (&mut self.check, &other.check) {
            (CollisionCheck::Free { clearance, .. }, CollisionCheck::Free { clearance: least, .. }) => {
                *clearance = clearance.min(*least);
            }
            (CollisionCheck::Free { .. }, _) => *self = other,
            _ => {}
        }
    }

    /// Adds the result of a further check of the same motion in another scene. Its samples count from `first`.
    pub fn add_in(&mut self, (scene, mut check): (Scene, CollisionCheck), first: usize) {
        check.moments_mut().for_each(|moment| moment.sample += first);
        self.add(Self { scene, check, trajectories: self.trajectories.clone() });
    }
}
