//! How much of a change opens a way, between a certified path and a proof.

use cplan_core::check::{CertifiedPath, CheckedProof};
use cplan_core::model::Outcome;
use cplan_interrupt::checkpoint;

/// Where a way opens as something is changed more and more.
#[derive(Debug, Clone, PartialEq)]
pub struct Threshold {
    /// With so much of the change there is a certified path: ...
    pub opens: f64,
    /// ... this one.
    pub path: CertifiedPath,
    /// With so much there is none: proven. Between both, if they are farther apart than asked for, nothing is known.
    pub closed: f64,
}

/// The threshold between `closed` and `most`, to `tolerance`; none if it is not proven that there is no path with so little, or none is known with the most
/// of it, either. Doubles the change, then halves what is left: `O(log n)` questions.
pub(super) fn threshold(
    closed: f64,
    most: f64,
    tolerance: f64,
    mut ask: impl FnMut(f64) -> Outcome<CertifiedPath, Option<CheckedProof>>,
) -> Option<Threshold> {
    if !matches!(ask(closed), Outcome::Infeasible(_)) {
        return None;
    }
    let mut known = Known { closed, below: closed, open: None };
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
    // What is not known lies in between: then as near as possible to it from below.
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

/// What is known of changes.
struct Known {
    /// The greatest with which there is no path.
    closed: f64,
    /// The greatest with which there is none, or none is known.
    below: f64,
    /// The least with which there is one.
    open: Option<(f64, CertifiedPath)>,
}

impl Known {
    fn learn(&mut self, by: f64, answer: Outcome<CertifiedPath, Option<CheckedProof>>) {
        checkpoint();
        match answer {
            Outcome::Found(path) => self.open = Some((by, path)),
            Outcome::Infeasible(_) => (self.closed, self.below) = (by, by),
            Outcome::Unknown(_) => self.below = by,
        }
    }
}
