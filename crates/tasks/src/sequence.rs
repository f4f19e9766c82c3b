//! The motions of a task as one.

use super::answer::Leg;
use cplan_motion::Trajectory;
use std::ops::RangeInclusive;

/// The whole motion of a task, standing still where steps end.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sequence {
    /// All motions, one after the other.
    pub trajectory: Trajectory,
    /// Of each step, its samples in the trajectory, from where its motion begins to where that ends. A step begins with the
    /// sample with which the one before ends if the arm does not stand still between them, else with the next one.
    pub samples: Vec<RangeInclusive<usize>>,
}

impl Sequence {
    /// The motions of these steps.
    #[must_use]
    pub fn of(legs: &[Leg]) -> Self {
        let mut sequence = Self::default();
        let mut rest = 0.0;
        for leg in legs {
            let motion = &leg.timed.trajectory;
            sequence.trajectory.then(rest, motion);
            let end = sequence.trajectory.time.len();
            sequence.samples.push(end - motion.time.len()..=end - 1);
            rest = leg.rest();
        }
        sequence.trajectory.stand(rest);
        sequence
    }

    /// Seconds from the beginning to that of a step's motion, to the end of that, and to the end of the step.
    #[must_use]
    pub fn times(&self, step: usize) -> [f64; 3] {
        let time = |sample: usize| self.trajectory.time[sample];
        let end = self.samples.get(step + 1).map_or(self.trajectory.duration(), |next| time(*next.start()));
        [time(*self.samples[step].start()), time(*self.samples[step].end()), end]
    }

    /// Of each sample, the step (from 0) that the interval which begins there belongs to. While the arm stands still it is
    /// the step that has just been done.
    #[must_use]
    pub fn steps(&self) -> Vec<usize> {
        let mut steps = Vec::with_capacity(self.trajectory.time.len());
        for step in 0..self.samples.len() {
            let next = self.samples.get(step + 1).map_or(self.trajectory.time.len(), |next| *next.start());
            // A step without a motion of its own shares its sample with the next.
            steps.resize(next, step);
        }
        steps
    }
}
