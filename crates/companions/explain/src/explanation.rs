//! The complete explanation of a question.

use super::bottleneck::{Bottleneck, bottleneck};
use super::change::{Change, ChangeContext, changes};
use super::ends::{BlockedEnd, OutOfReach, blocked_ends};
use super::shaping::{Saving, savings};
use cplan_blockers::{BlockingSet, MotionQuestion, blocking_sets};
use cplan_handling::Action;
use cplan_judge::CheckedProof;
use cplan_legs::FailedStep;
use cplan_model::{Outcome, Status};
use cplan_solver::{Answer, Options, Unknown, solve};
use std::time::Duration;

/// Largest number of boxes for most decisions about a blocker or a change.
const BOXES_PER_DECISION: usize = 20_000;

/// Largest number of boxes for a blocker that is undecided with [`BOXES_PER_DECISION`]. There are few such blockers.
const BOXES_FOR_LAST_DECISIONS: usize = 1_000_000;

/// The reasons why there is no motion, or why there is no shorter one.
#[derive(Debug, Clone)]
pub struct Explanation {
    /// The question.
    pub question: MotionQuestion,
    /// If there is a motion: the elements that make it longer. Otherwise, the reasons why there is none.
    pub outcome: Outcome<FoundExplanation, InfeasibleExplanation>,
    /// The failed step that the question is about. `None` for the question of a single motion.
    pub failure: Option<StepFailure>,
    /// True if the time limit was reached. Then sets may contain unnecessary elements, and changes or savings may be missing.
    pub is_stopped: bool,
}

/// A step of a task that fails. The whole task may be unknown even if the motion of the step is infeasible, because it
/// may have other choices.
#[derive(Debug, Clone, PartialEq)]
pub struct StepFailure {
    /// The answer to the whole task: infeasible or unknown.
    pub status: Status,
    /// Sentence with that answer.
    pub verdict: String,
    /// The reasons why the step fails, with the motions that were tried.
    pub reasons: Vec<String>,
}

/// A motion that was found.
#[derive(Debug, Clone)]
pub struct FoundExplanation {
    /// The shortest path, and how it was found.
    pub answer: Box<Answer>,
    /// The elements that make the path longer, the one with the greatest saving first.
    pub savings: Vec<Saving>,
}

/// Reasons why there is no motion.
#[derive(Debug, Clone, Default)]
pub struct InfeasibleExplanation {
    /// Proof that the world has no motion. `None` if the start or all goals are blocked, which needs no proof.
    pub proof: Option<CheckedProof>,
    /// Defects of start and goals.
    pub ends: Vec<BlockedEnd>,
    /// The nearest place that the tip can reach, if the goal is out of reach.
    pub out_of_reach: Option<OutOfReach>,
    /// Blocking sets: each alone blocks all motions, and no two have an obstacle in common.
    pub sets: Vec<BlockingSet>,
    /// For each set, the smallest changes of single blockers that open a path.
    pub changes: Vec<Vec<Change>>,
    /// The narrowest place of the path that opens first when all obstacles shrink. `None` if none was found.
    pub bottleneck: Option<Bottleneck>,
}

impl Explanation {
    /// Returns found, infeasible or unknown, with the same meaning as for a plan.
    pub fn status(&self) -> Status {
        self.failure.as_ref().map_or(self.outcome.status(), |failure| failure.status)
    }
}

/// Explains a question. For a motion that is found, reports the elements that make it longer. Otherwise reports the
/// blocking elements, the smallest change of each that opens a path, and the narrowest place.
///
/// It usually takes tenths of a second. The time limit of the question begins when it is known whether there is a motion.
pub fn explain(question: &MotionQuestion, options: &Options) -> Explanation {
    let answer = question.problem().map(|problem| solve(&problem, options, &mut |_| ()));
    let started = question.started();
    let closed = |proof: Option<CheckedProof>| Outcome::Infeasible(closed(&started, proof));
    let outcome = match answer.as_ref().map(|answer| &answer.outcome) {
        None => closed(None),
        Some(Outcome::Infeasible(proof)) => closed(Some(proof.clone())),
        Some(Outcome::Unknown(Unknown { reason, .. })) => Outcome::Unknown(reason.clone()),
        Some(Outcome::Found(_)) => {
            let answer = answer.expect("it was just looked at");
            let savings = savings(&started, &answer, options);
            Outcome::Found(FoundExplanation { answer: Box::new(answer), savings })
        }
    };
    Explanation { question: question.clone(), outcome, failure: None, is_stopped: started.is_out_of_time() }
}

/// Explains why a step of a task fails. `failure` is the planner's answer, which the explanation never contradicts: if it
/// finds no obstacle that blocks the step, it states only the planner's reasons.
pub fn explain_step(failed: &FailedStep, failure: StepFailure, limit: Duration, options: &Options) -> Explanation {
    let question = MotionQuestion::of_failed_step(failed).with_time_limit(limit);
    let is_motion = !matches!(failed.step.action, Action::Follow(_)) && !failed.ik_solutions.is_empty();
    let explained = is_motion.then(|| explain(&question, options));
    match explained.filter(|explanation| matches!(explanation.outcome, Outcome::Infeasible(_))) {
        Some(explanation) => Explanation { failure: Some(failure), ..explanation },
        None => {
            let outcome = match failure.status {
                Status::Infeasible => Outcome::Infeasible(InfeasibleExplanation::default()),
                _ => Outcome::Unknown(failure.reasons.join("; ")),
            };
            Explanation { question, outcome, failure: Some(failure), is_stopped: false }
        }
    }
}

impl InfeasibleExplanation {
    /// Returns the smallest changes of single blockers, set by set.
    pub fn changes(&self) -> impl Iterator<Item = &Change> {
        self.changes.iter().flatten()
    }
}

/// Explains why there is no motion.
fn closed(question: &MotionQuestion, proof: Option<CheckedProof>) -> InfeasibleExplanation {
    let sets = blocking_sets(question, proof.clone(), [BOXES_PER_DECISION, BOXES_FOR_LAST_DECISIONS]);
    let changes = sets.iter().map(|set| changes_of_set(question, set)).collect();
    let (ends, out_of_reach) = blocked_ends(question);
    // If the arm collides at rest, a path of the motion does not show why.
    let is_moving = ends.iter().all(|end| end.standing.is_none());
    let bottleneck = if is_moving { bottleneck(question, BOXES_PER_DECISION) } else { None };
    InfeasibleExplanation { proof, ends, out_of_reach, sets, changes, bottleneck }
}

/// Returns the smallest changes of each blocker of a set.
fn changes_of_set(question: &MotionQuestion, set: &BlockingSet) -> Vec<Change> {
    let others = set.others(question);
    let of_element = |element| {
        let opens = matches!(question.without(&[element]).answer(BOXES_PER_DECISION), Outcome::Found(_));
        match opens {
            true => changes(question, element, ChangeContext::World, BOXES_PER_DECISION),
            false => changes(&question.without(&others), element, ChangeContext::Set, BOXES_PER_DECISION),
        }
    };
    set.elements().into_iter().flat_map(of_element).collect()
}
