//! The elements that make the shortest path longer.

use cplan_blockers::{Element, MotionQuestion};
use cplan_interrupt::checkpoint;
use cplan_model::space::Path;
use cplan_solver::{Answer, Bound, Options, solve};

/// An element that makes the shortest path longer.
#[derive(Debug, Clone, PartialEq)]
pub struct Saving {
    /// The element.
    pub element: Element,
    /// A certified path that is found when the element is removed.
    pub path: Path,
    /// Length of that path.
    pub length: f64,
    /// Lower bound on the saving: the shortest path is shorter by at least this without the element.
    pub at_least: f64,
    /// Upper bound on the saving.
    pub at_most: f64,
}

/// Returns the elements whose removal is proven to shorten the shortest path, the one with the greatest saving first.
/// Plans a shortest path without each element in turn, until the question's time is up.
pub fn savings(question: &MotionQuestion, answer: &Answer, options: &Options) -> Vec<Saving> {
    let Some(whole) = answer.bound() else { return Vec::new() };
    let mut savings = Vec::new();
    for element in question.elements() {
        checkpoint();
        let Some(problem) = question.without_at_clearance(&[element]).problem() else { continue };
        let Some(without) = question.within_time_limit(|| solve(&problem, options, &mut |_| ())) else { break };
        if let (Some(Bound { lower, upper, .. }), Some(path)) = (without.bound(), without.path()) {
            let (at_least, at_most) = (whole.lower - upper, whole.upper - lower);
            if at_least > 0.0 {
                savings.push(Saving { element, path: path.clone(), length: upper, at_least, at_most });
            }
        }
    }
    savings.sort_by(|a, b| b.at_least.total_cmp(&a.at_least));
    savings
}
