//! Decides whether plans keep up with the page while the user drags something.

use cplan_interrupt::Interrupted;
use std::cell::Cell;

/// Number of positions of a drag that get no plan after a plan that took too long.
const SKIPPED_PLANS: u32 = 7;

/// A record of whether plans keep up with the drag. Plans that are too slow would delay the rest of the page.
#[derive(Default)]
pub struct Pace {
    untried: Cell<u32>,
}

impl Pace {
    /// Runs `plan`, unless a recent plan took too long. Returns `None` if it does not run it.
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
