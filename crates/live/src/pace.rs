//! Decides if plans keep up with the page.

use cplan_interrupt::Interrupted;
use std::cell::Cell;

/// Number of intermediate places without a plan, after a plan that was not finished in time.
const SKIPPED_PLANS: u32 = 7;

/// A record of whether plans keep up with the object being dragged. Plans that do not would only delay the rest of the
/// page.
#[derive(Default)]
pub struct Pace {
    untried: Cell<u32>,
}

impl Pace {
    /// Plans, unless the last plan took too long.
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
