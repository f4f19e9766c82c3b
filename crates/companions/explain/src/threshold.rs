//! The amount of a change at which a path opens, enclosed between a certified path and a proof.

use cplan_interrupt::checkpoint;
use cplan_judge::{CertifiedPath, CheckedProof};
use cplan_model::Outcome;

/// Bounds on the least amount of a change that opens a path.
#[derive(Debug, Clone, PartialEq)]
pub struct Threshold {
    /// An amount with which there is a certified path.
    pub opens: f64,
    /// A certified path with the amount `opens`.
    pub path: CertifiedPath,
    /// A smaller amount with which it is proven that there is no path. If it differs from `opens` by more than the
    /// tolerance, the amounts in between are undecided.
    pub closed: f64,
}

/// Finds the threshold between `closed` and `most`, to `tolerance`. `ask` decides whether an amount opens a path.
/// Returns `None` if `closed` is not proven to leave no path, or if no path is found with `most`.
///
/// Doubles the step until a path is found, then bisects: `O(log((most - closed) / tolerance))` calls of `ask`.
pub(super) fn threshold(
    closed: f64,
    most: f64,
    tolerance: f64,
    mut ask: impl FnMut(f64) -> Outcome<CertifiedPath, Option<CheckedProof>>,
) -> Option<Threshold> {
    if !matches!(ask(closed), Outcome::Infeasible(_)) {
        return None;
    }
    let mut known = KnownResults { closed, below: closed, open: None };
    let mut step = tolerance;
    loop {
        let by = (closed + step).min(most);
        known.record(by, ask(by));
        if known.open.is_some() {
            break;
        }
        if by >= most {
            return None;
        }
        step *= 2.0;
    }
    while let Some((open, _)) = &known.open
        && open - known.below > tolerance
    {
        let by = f64::midpoint(known.below, *open);
        known.record(by, ask(by));
    }
    // Undecided amounts lie between amounts without a path and those with one. Continue below the undecided ones.
    let mut unknown = known.below;
    while unknown - known.closed > tolerance {
        let by = f64::midpoint(known.closed, unknown);
        match ask(by) {
            Outcome::Infeasible(_) => known.closed = by,
            _ => unknown = by,
        }
    }
    known.open.map(|(opens, path)| Threshold { opens, path, closed: known.closed })
}

/// Results for the amounts of a change that were tried.
struct KnownResults {
    /// Greatest amount with which it is proven that there is no path.
    closed: f64,
    /// Greatest tried amount with which no path was found.
    below: f64,
    /// The least amount with which a path was found, and that path.
    open: Option<(f64, CertifiedPath)>,
}

impl KnownResults {
    fn record(&mut self, by: f64, answer: Outcome<CertifiedPath, Option<CheckedProof>>) {
        checkpoint();
        match answer {
            Outcome::Found(path) => self.open = Some((by, path)),
            Outcome::Infeasible(_) => (self.closed, self.below) = (by, by),
            Outcome::Unknown(_) => self.below = by,
        }
    }
}
