//! The amount of a change that opens a path, enclosed between a certified path and a proof.

use cplan_core::check::{CertifiedPath, CheckedProof};
use cplan_core::model::Outcome;
use cplan_interrupt::checkpoint;

/// The amount of a change at which a path opens.
#[derive(Debug, Clone, PartialEq)]
pub struct Threshold {
    /// An amount with which there is a certified path: ...
    pub opens: f64,
    /// ... this one.
    pub path: CertifiedPath,
    /// An amount with which there is provably no path. If the two amounts differ by more than the tolerance, nothing is
    /// known for the amounts between them.
    pub closed: f64,
}

/// Finds the threshold between `closed` and `most`, to `tolerance`. `None` if it is not proven that `closed` leaves no
/// path, or if no path is known with `most`. Doubles the change, then bisects: `O(log n)` questions.
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
        known.learn(by, ask(by));
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
        known.learn(by, ask(by));
    }
    // The undecided amounts lie in between. Approaches them from below.
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
    /// The greatest amount with which there is provably no path.
    closed: f64,
    /// The greatest amount with which no path is known.
    below: f64,
    /// The least amount with which there is a path, and that path.
    open: Option<(f64, CertifiedPath)>,
}

impl KnownResults {
    fn learn(&mut self, by: f64, answer: Outcome<CertifiedPath, Option<CheckedProof>>) {
        checkpoint();
        match answer {
            Outcome::Found(path) => self.open = Some((by, path)),
            Outcome::Infeasible(_) => (self.closed, self.below) = (by, by),
            Outcome::Unknown(_) => self.below = by,
        }
    }
}
