//! Measures the time of each stage of planning.

use cplan_interrupt::Instant;
use cplan_solver::Stages;
use std::time::Duration;

/// The stages of a computation, in the order in which they ended. The time of a stage begins at the end of the previous one.
#[derive(Debug, Clone)]
pub struct Clock {
    last: Instant,
    stages: Vec<(&'static str, Duration)>,
}

impl Clock {
    /// Starts the clock. `stages` are stages that have already ended.
    pub fn starting_after(stages: Vec<(&'static str, Duration)>) -> Self {
        Self { last: Instant::now(), stages }
    }

    /// Ends a stage, which began at the end of the previous one.
    pub fn stage(&mut self, name: &'static str) {
        self.stages.push((name, self.last.elapsed()));
        self.last = Instant::now();
    }

    /// Adds the stages that the solver measured.
    pub fn solved(&mut self, stages: &Stages) {
        let Stages { build, query, certify, prove, bound } = *stages;
        for (name, time) in
            [("build", build), ("query", query), ("certify", certify), ("prove", prove), ("bound", bound)]
        {
            if !time.is_zero() {
                self.stages.push((name, time));
            }
        }
        self.last = Instant::now();
    }

    /// Returns all stages that have ended.
    pub fn stages(&self) -> &[(&'static str, Duration)] {
        &self.stages
    }
}
