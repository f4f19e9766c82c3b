//! Decides whether plans are fast enough for the page during a drag.

use cplan_interrupt::Interrupted;
use std::cell::Cell;

/// Number of positions of a drag that are not planned after a plan that took too long.
const SKIPPED_PLANS: u32 = 7;

/// Remembers whether recent plans were fast enough for a drag. Slow plans would delay the rest of the page.
#[derive(Default)]
pub struct Pace {
    untried: Cell<u32>,
}

impl Pace {
    /// Runs `plan`, unless a recent plan took too long. `None` if it was not run.
    pub fn tries<T>(&self, plan: impl FnOnce() -> Result<T, Interrupted>) -> Option<Result<T, Interrupted>> {
        if self.untried.get() > 0 {
            self.untried.update(|left| left - 1);
            return None;
        }
        let result = plan();
        if matches!(result, Err(Interrupted::TimeUp)) {
            self.untried.set(SKIPPED_PLANS);
        }
        Some(result)
    }
}
