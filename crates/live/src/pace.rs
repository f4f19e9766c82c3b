//! Whether plans keep up with the page.

use cplan_interrupt::Interrupted;
use std::cell::Cell;

/// Places on the way for which no plan is tried, after one that was not made in time.
const UNTRIED: u32 = 7;

/// Whether plans keep up with what is dragged. Those that do not would only keep the rest of the page waiting.
#[derive(Default)]
pub struct Pace {
    untried: Cell<u32>,
}

impl Pace {
    /// Plans, unless it is of no use to try.
    pub fn tries<T>(&self, plan: impl FnOnce() -> Result<T, Interrupted>) -> Option<Result<T, Interrupted>> {
        if self.untried.get() > 0 {
            self.untried.update(|left| left - 1);
            return None;
        }
        let result = plan();
        if matches!(result, Err(Interrupted::TimeUp)) {
            self.untried.set(UNTRIED);
        }
        Some(result)
    }
}
