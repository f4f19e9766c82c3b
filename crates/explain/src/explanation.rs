//! All that there is to say of a question.

use super::blockers::{BlockingSet, blocking_sets};
use super::bottleneck::{Bottleneck, bottleneck};
use super::change::{Among, Change, changes};
use super::ends::{BlockedEnd, OutOfReach, blocked_ends};
use super::question::Question;
use super::shaping::{Saving, savings};
use cplan_core::check::CheckedProof;
use cplan_core::model::{Outcome, Status};
use cplan_solver::{Answer, Options, Unknown, solve};

/// Boxes that are looked at for each of the many decisions.
const BOXES: usize = 20_000;

/// And for those of the few that are in the way which would else be unknown.
const BOXES_AT_LAST: usize = 1_000_000;

/// Why there is no motion, or what shapes the one that there is.
#[derive(Debug, Clone)]
pub struct Explanation {
    /// What was asked.
    pub question: Question,
    /// What there is to say of the answer.
    pub outcome: Outcome<Shaped, Closed>,
    /// Whether the time was up before all was looked at: then sets may not be irreducible, and changes and savings may be missing.
    pub is_stopped: bool,
}

/// A motion that was found.
#[derive(Debug, Clone)]
pub struct Shaped {
    /// The shortest path, and how it was found.
    pub answer: Box<Answer>,
    /// What it would be shorter without, the greatest savings first.
    pub savings: Vec<Saving>,
}

/// That there is no motion.
#[derive(Debug, Clone)]
pub struct Closed {
    /// That the whole world has none; none where start or goals are not free.
    pub proof: Option<CheckedProof>,
    /// What is wrong with start and goals, if the arm cannot be there.
    pub ends: Vec<BlockedEnd>,
    /// Where the tip can get, if not to its goal.
    pub out_of_reach: Option<OutOfReach>,
    /// What is in the way: each set is enough, and they have no obstacle in common.
    pub sets: Vec<BlockingSet>,
    /// Where the motion gets stuck.
    pub bottleneck: Option<Bottleneck>,
}

impl Explanation {
    /// Found, infeasible or unknown, as planning has it.
    #[must_use]
    pub fn status(&self) -> Status {
        self.outcome.status()
    }
}

/// Explains a question: of a motion that is found, what shapes it; of one that there is none of, what is in the way, the smallest change
/// of each that opens a way, and where it gets stuck. Tenths of a second, as a rule; once it is known whether there is a motion, no longer than the
/// question's time limit.
#[must_use]
pub fn explain(question: &Question, options: &Options) -> Explanation {
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
            Outcome::Found(Shaped { answer: Box::new(answer), savings })
        }
    };
    Explanation { question: question.clone(), outcome, is_stopped: started.is_out_of_time() }
}

impl Closed {
    /// The smallest changes of single blockers, set by set.
    pub fn changes(&self) -> impl Iterator<Item = &Change> {
        self.sets.iter().flat_map(|set| &set.blockers).flat_map(|blocker| &blocker.changes)
    }
}

/// Why there is none.
fn closed(question: &Question, proof: Option<CheckedProof>) -> Closed {
    let mut sets = blocking_sets(question, proof.clone(), [BOXES, BOXES_AT_LAST]);
    let all = super::Element::all(question.scene());
    for set in &mut sets {
        let elements = set.elements();
        let others: Vec<_> = all.iter().filter(|element| !elements.contains(element)).copied().collect();
        for blocker in &mut set.blockers {
            let element = blocker.element;
            let opens = matches!(question.without(&[element]).answer(BOXES), Outcome::Found(_));
            blocker.changes = match opens {
                true => changes(question, element, Among::World, BOXES),
                false => changes(&question.without(&others), element, Among::Set, BOXES),
            };
        }
    }
    let (ends, out_of_reach) = blocked_ends(question);
    Closed { proof, ends, out_of_reach, sets, bottleneck: bottleneck(question, BOXES) }
}
