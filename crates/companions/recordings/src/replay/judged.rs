//! Results of the checks of a step: of its motion, and of the arm at rest.

use cplan_handling::{ObstacleTrajectory, Recording, Task, TimedScene};
use cplan_model::Scene;
use cplan_motion::recorded::{CollisionCheck, check_collision};
use std::ops::RangeInclusive;

/// The result of the collision check of a part of the recording, with its scene. Samples count from the beginning of
/// the whole recording.
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

    /// Combines two results. A result that is not free takes precedence, the earlier one first. If both are free, the
    /// smaller clearance remains.
    pub fn add(&mut self, other: Self) {
        match (&mut self.check, &other.check) {
            (CollisionCheck::Free { clearance, .. }, CollisionCheck::Free { clearance: least, .. }) => {
                *clearance = clearance.min(*least);
            }
            (CollisionCheck::Free { .. }, _) => *self = other,
            _ => {}
        }
    }

    /// Adds the result of a check of the same motion in another scene. Its samples count from `first`.
    pub fn add_in(&mut self, (scene, mut check): (Scene, CollisionCheck), first: usize) {
        check.moments_mut().for_each(|moment| moment.sample += first);
        self.add(Self { scene, check, trajectories: self.trajectories.clone() });
    }
}
