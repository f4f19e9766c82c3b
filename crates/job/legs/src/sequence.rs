//! Joins the motions of a task into one.

use super::leg::Leg;
use cplan_motion::Trajectory;
use std::ops::RangeInclusive;

/// The whole motion of a task, with the rests at the ends of steps and before the first one.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sequence {
    /// All motions in sequence.
    pub trajectory: Trajectory,
    /// For each step, the range of its samples in the trajectory, from the beginning to the end of its motion. The range begins
    /// with the last sample of the previous step, or with the next sample if the arm stands still in between.
    pub samples: Vec<RangeInclusive<usize>>,
}

impl Sequence {
    /// Joins the motions of these steps.
    pub fn of(legs: &[Leg]) -> Self {
        let mut sequence = Self::default();
        let mut rest = 0.0;
        for leg in legs {
            let motion = &leg.timed.trajectory;
            let raising = leg.raising.map_or(0.0, |raising| raising.seconds);
            if sequence.samples.is_empty() && raising > 0.0 {
                sequence.trajectory = Trajectory::at_rest(&leg.scene, leg.path().start());
            }
            sequence.trajectory.then(rest + raising - leg.overlap.departure(), motion);
            let end = sequence.trajectory.time.len();
            sequence.samples.push(end - motion.time.len()..=end - 1);
            rest = leg.rest();
        }
        sequence.trajectory.append_rest(rest);
        // Only some motions have the values of a wrist. All of these values are in messages and steps.
        sequence.trajectory.wrist.clear();
        sequence
    }

    /// Returns the times at which a step's motion begins and ends, and at which the step ends, in seconds from the
    /// beginning of the task.
    pub fn times(&self, step: usize) -> [f64; 3] {
        let time = |sample: usize| self.trajectory.time[sample];
        let end = self.samples.get(step + 1).map_or(self.trajectory.duration(), |next| time(*next.start()));
        [time(*self.samples[step].start()), time(*self.samples[step].end()), end]
    }

    /// Returns, for each sample, the index of the step to which the interval until the next sample belongs. While the arm stands
    /// still, it is the step that has just ended.
    pub fn steps(&self) -> Vec<usize> {
        let mut steps = Vec::with_capacity(self.trajectory.time.len());
        for step in 0..self.samples.len() {
            let next = self.samples.get(step + 1).map_or(self.trajectory.time.len(), |next| *next.start());
            // A step without a motion shares its sample with the next step.
            steps.resize(next, step);
        }
        steps
    }
}
