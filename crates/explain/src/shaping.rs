//! What shapes the shortest path.

use super::element::Element;
use super::question::Question;
use cplan_interrupt::checkpoint;
use cplan_solver::{Answer, Bound, Options, solve};

/// What makes the shortest path longer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Saving {
    /// What it is.
    pub element: Element,
    /// Without it this length was found.
    pub length: f64,
    /// Without it the shortest path is shorter by so much at least, ...
    pub at_least: f64,
    /// ... and at most.
    pub at_most: f64,
}

/// What shapes the shortest path of which `answer` knows: all without which it is proven to be shorter, the greatest savings first. A shortest
/// path is looked for without each in turn, until the question's time is up.
#[must_use]
pub fn savings(question: &Question, answer: &Answer, options: &Options) -> Vec<Saving> {
    let Some(whole) = answer.bound() else { return Vec::new() };
    let mut savings = Vec::new();
    for element in Element::all(question.scene()) {
        checkpoint();
        let Some(problem) = question.just_without(&[element]).problem() else { continue };
        let Some(without) = question.in_time(|| solve(&problem, options, &mut |_| ())) else { break };
        if let Some(Bound { lower, upper, .. }) = without.bound() {
            let (at_least, at_most) = (whole.lower - upper, whole.upper - lower);
            if at_least > 0.0 {
                savings.push(Saving { element, length: upper, at_least, at_most });
            }
        }
    }
    savings.sort_by(|a, b| b.at_least.total_cmp(&a.at_least));
    savings
}
