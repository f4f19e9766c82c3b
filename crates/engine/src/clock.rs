//! Time per stage.

use cplan_interrupt::Instant;
use cplan_solver::Stages;
use std::time::Duration;

/// Stages in the order in which they end, each with the time since the one before.
#[derive(Debug, Clone)]
pub struct Clock {
    last: Instant,
    stages: Vec<(&'static str, Duration)>,
}

impl Clock {
    /// Begins with stages that are over.
    #[must_use]
    pub fn after(stages: Vec<(&'static str, Duration)>) -> Self {
        Self { last: Instant::now(), stages }
    }

    /// The time since the last stage ended was this one's.
    pub fn stage(&mut self, name: &'static str) {
        self.stages.push((name, self.last.elapsed()));
        self.last = Instant::now();
    }

    /// The solver's own stages.
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

    /// All stages that have ended.
    #[must_use]
    pub fn stages(&self) -> &[(&'static str, Duration)] {
        &self.stages
    }
}
