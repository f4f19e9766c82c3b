//! Time per stage.

use cplan_interrupt::Instant;
use cplan_solver::Stages;
use std::time::Duration;

/// Stages in the order in which they ended, each with the time since the previous one.
#[derive(Debug, Clone)]
pub struct Clock {
    last: Instant,
    stages: Vec<(&'static str, Duration)>,
}

impl Clock {
    /// Starts the clock after these completed stages.
    #[must_use]
    pub fn after(stages: Vec<(&'static str, Duration)>) -> Self {
        Self { last: Instant::now(), stages }
    }

    /// Ends a stage: adds the time since the last stage ended.
    pub fn stage(&mut self, name: &'static str) {
        self.stages.push((name, self.last.elapsed()));
        self.last = Instant::now();
    }

    /// Adds the solver's own stages.
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
    #[must_use]
    pub fn stages(&self) -> &[(&'static str, Duration)] {
        &self.stages
    }
}
