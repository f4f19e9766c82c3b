//! Irreducible sets of what is in the way.

use super::change::Change;
use super::element::Element;
use super::question::Question;
use cplan_core::check::{CertifiedPath, CheckedProof, Disconnection, StuckBox};
use cplan_core::model::{Outcome, Scene, Status};
use cplan_interrupt::checkpoint;

/// Sets that are looked for at most, one after the other.
const MOST_SETS: usize = 8;

/// What is in the way, and cannot be left out of its set.
#[derive(Debug, Clone, PartialEq)]
pub struct Blocker {
    /// What it is.
    pub element: Element,
    /// A certified motion among the others of the set; none if it is not known whether there is one.
    pub without: Option<CertifiedPath>,
    /// The smallest changes of it that open a way, once they are asked for.
    pub changes: Vec<Change>,
}

/// With all of these, and nothing else in the world, there is no motion; without any one of them there is, or it is not known.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockingSet {
    /// Limits, the clearance, then obstacles in the order of the file. None where nothing can open a way, as to a tip goal out of reach.
    pub blockers: Vec<Blocker>,
    /// That there is no motion among these alone; none where the start, or all that is to be reached, is not free among them.
    pub proof: Option<CheckedProof>,
}

impl BlockingSet {
    /// What is in it.
    #[must_use]
    pub fn elements(&self) -> Vec<Element> {
        self.blockers.iter().map(|blocker| blocker.element).collect()
    }

    /// Its elements in words: `obstacle "shelf" and the lower limit of joint "elbow"`; empty if it is.
    #[must_use]
    pub fn describe(&self, scene: &Scene) -> String {
        let words: Vec<String> = self.blockers.iter().map(|blocker| blocker.element.describe(scene)).collect();
        match &words[..] {
            [all @ .., before, last] => {
                let all: String = all.iter().map(|one| format!("{one}, ")).collect();
                format!("{all}{before} and {last}")
            }
            _ => words.concat(),
        }
    }

    /// Whether every one of them was shown to be needed.
    #[must_use]
    pub fn is_irreducible(&self) -> bool {
        self.blockers.iter().all(|blocker| blocker.without.is_some())
    }

    /// Found as far as is known: whether without an element there is a motion among the others.
    #[must_use]
    pub fn without(&self, element: Element) -> Status {
        let blocker = self.blockers.iter().find(|blocker| blocker.element == element);
        if blocker.is_some_and(|b| b.without.is_some()) { Status::Found } else { Status::Unknown }
    }
}

/// An irreducible set of a question to which the answer is that there is no motion, by this proof.
///
/// A deletion filter: what the proof does not name goes at once, and of the rest each in turn if there is no motion without it, either. What is
/// kept was needed: a motion is certified without it. That holds when others go later, since fewer obstacles, wider limits and less clearance only
/// free more. Decisions by slabs and boxes, of these no more than the first number, and the second of the few that are left where else
/// something would be unknown; no optimum is asked for. `O(n)` decisions for the `n` that the proof names.
#[must_use]
pub fn blocking_set(question: &Question, proof: Option<CheckedProof>, boxes: [usize; 2]) -> BlockingSet {
    let mut filter =
        Filter { question, boxes: boxes[0], all: Element::all(question.scene()), set: Vec::new(), proof: None };
    filter.set.clone_from(&filter.all);
    filter.refine(proof);
    let (limits, others): (Vec<_>, Vec<_>) =
        filter.set.clone().into_iter().partition(|element| matches!(element, Element::Limit { .. }));
    // As a rule no limit is needed, or some of both joints are.
    let mut waiting = vec![];
    if limits.len() < 2 || filter.try_without(&limits).is_err() {
        waiting = limits;
    }
    waiting.extend(others);
    let mut kept: Vec<Blocker> = Vec::new();
    for element in waiting {
        checkpoint();
        if filter.set.contains(&element)
            && let Err(without) = filter.try_without(&[element])
        {
            kept.push(Blocker { element, without, changes: Vec::new() });
        }
    }
    // What was not decided among many may be among few.
    filter.boxes = boxes[1];
    let count = kept.len();
    for k in (0..count).rev() {
        if kept[k].without.is_none() {
            match filter.try_without(&[kept[k].element]) {
                Ok(()) => drop(kept.remove(k)),
                Err(without) => kept[k].without = without,
            }
        }
    }
    kept.retain(|blocker| filter.set.contains(&blocker.element));
    BlockingSet { blockers: kept, proof: filter.proof }
}

/// Sets that have no obstacle in common, each of which is enough: one after the other, while there is none without the obstacles of those before.
#[must_use]
pub fn blocking_sets(question: &Question, proof: Option<CheckedProof>, boxes: [usize; 2]) -> Vec<BlockingSet> {
    let mut sets = vec![blocking_set(question, proof, boxes)];
    let mut gone: Vec<Element> = Vec::new();
    while sets.len() < MOST_SETS
        && let Some(last) = sets.last()
    {
        let obstacles: Vec<Element> = last.elements().into_iter().filter(|e| e.obstacle().is_some()).collect();
        if obstacles.is_empty() {
            break;
        }
        gone.extend(obstacles);
        let rest = question.without(&gone);
        let Outcome::Infeasible(proof) = rest.answer(boxes[0]) else { break };
        sets.push(blocking_set(&rest, proof, boxes));
    }
    sets
}

/// What is left of a world that still has no motion.
struct Filter<'a> {
    question: &'a Question,
    boxes: usize,
    all: Vec<Element>,
    /// What is there.
    set: Vec<Element>,
    /// That there is no motion; none where ends are not free.
    proof: Option<CheckedProof>,
}

impl Filter<'_> {
    /// The question with nothing but these.
    fn among(&self, set: &[Element]) -> Question {
        let gone: Vec<Element> = self.all.iter().filter(|element| !set.contains(element)).copied().collect();
        self.question.without(&gone)
    }

    /// Leaves some out if there is no motion without them, either; else what is known of one.
    fn try_without(&mut self, some: &[Element]) -> Result<(), Option<CertifiedPath>> {
        let set: Vec<Element> = self.set.iter().filter(|element| !some.contains(element)).copied().collect();
        match self.among(&set).answer(self.boxes) {
            Outcome::Found(path) => Err(Some(path)),
            Outcome::Unknown(_) => Err(None),
            Outcome::Infeasible(proof) => {
                self.set = set;
                self.refine(proof);
                Ok(())
            }
        }
    }

    /// Leaves out at once the obstacles that a proof does without.
    fn refine(&mut self, proof: Option<CheckedProof>) {
        self.proof = proof;
        let Some(mut slim) = self.proof.clone() else { return };
        let (question, mut set) = (self.among(&self.set), self.set.clone());
        let layer = |stuck: &StuckBox| question.scene().first_layer(stuck.pair.obstacle);
        for obstacle in self.set.iter().filter_map(|element| element.obstacle()) {
            let fewer = slim.stuck().iter().filter(|stuck| layer(stuck) != obstacle).cloned().collect::<Vec<_>>();
            if fewer.len() == slim.stuck().len() {
                set.retain(|element| element.obstacle() != Some(obstacle));
            } else if let Some(fewer) = held(&question, fewer) {
                slim = fewer;
                set.retain(|element| element.obstacle() != Some(obstacle));
            }
        }
        // Without an obstacle there may be more configurations for the tip, of which the proof says nothing.
        if let Some(slim) = held(&self.among(&set), slim.stuck().to_vec()) {
            (self.set, self.proof) = (set, Some(slim));
        }
    }
}

/// The proof by these boxes, if it holds and that is shown in time.
fn held(question: &Question, stuck: Vec<StuckBox>) -> Option<CheckedProof> {
    let scene = question.scene();
    let clearance = scene.workspace().clearance;
    let check = || Disconnection::new(stuck).checked(scene, question.start(), &question.goals(), clearance).ok();
    question.in_time(check).flatten()
}
