//! Irreducible sets of elements: they block all motions, but would not without any one of their elements.

use super::element::Element;
use super::question::MotionQuestion;
use cplan_interrupt::checkpoint;
use cplan_judge::{CertifiedPath, CheckedProof, CollisionBox, Disconnection};
use cplan_model::{Outcome, Scene, Status};
use cplan_text::joined;

/// Largest number of blocking sets. Each set is computed in a world without the obstacles of the previous ones.
const MAX_SETS: usize = 8;

/// An element of a blocking set that the set needs.
#[derive(Debug, Clone, PartialEq)]
pub struct Blocker {
    /// The element.
    pub element: Element,
    /// A certified motion past the other elements of the set. `None` if no such motion is known.
    pub without: Option<CertifiedPath>,
}

/// A set of elements that block all motions even if the world contains nothing else. Without any one of them, there is a motion,
/// or it is not known whether there is one.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockingSet {
    /// The elements: first limits, then the clearance, then obstacles in the order of the file. Empty if no change can open a
    /// path, as for a tip goal out of reach.
    pub blockers: Vec<Blocker>,
    /// Proof that these elements alone block all motions. `None` if they block the start or every goal, which needs no proof.
    pub proof: Option<CheckedProof>,
}

impl BlockingSet {
    /// Returns the elements of the set.
    pub fn elements(&self) -> Vec<Element> {
        self.blockers.iter().map(|blocker| blocker.element).collect()
    }

    /// Returns the elements of the question that are not in the set.
    pub fn others(&self, question: &MotionQuestion) -> Vec<Element> {
        let elements = self.elements();
        question.elements().into_iter().filter(|element| !elements.contains(element)).collect()
    }

    /// Describes the elements: `obstacle "shelf" and the lower limit of joint "elbow"`. Empty for an empty set.
    pub fn describe(&self, scene: &Scene) -> String {
        let words: Vec<String> = self.blockers.iter().map(|blocker| blocker.element.describe(scene)).collect();
        joined(&words)
    }

    /// Returns true if each element of the set is known to be needed.
    pub fn is_irreducible(&self) -> bool {
        self.blockers.iter().all(|blocker| blocker.without.is_some())
    }

    /// Returns [`Status::Found`] if a motion past the other elements of the set is certified, otherwise
    /// [`Status::Unknown`].
    pub fn without(&self, element: Element) -> Status {
        let blocker = self.blockers.iter().find(|blocker| blocker.element == element);
        if blocker.is_some_and(|b| b.without.is_some()) { Status::Found } else { Status::Unknown }
    }
}

/// Returns an irreducible blocking set for an infeasible question, starting from its proof.
///
/// This is a deletion filter. Elements that the proof does not name are removed at once. Then each of the others is removed
/// unless a motion becomes possible. A remaining element is needed, because a motion without it is certified. This stays true
/// when other elements are removed later: fewer obstacles, wider limits and less clearance can only free more configurations.
///
/// Slabs and boxes decide, without computing an optimum. `boxes` limits the number of boxes per decision: the first number
/// applies to each element, the second one to the few remaining elements for which the first gave no result. Makes `O(n)`
/// decisions for the `n` elements that the proof names.
pub fn blocking_set(question: &MotionQuestion, proof: Option<CheckedProof>, boxes: [usize; 2]) -> BlockingSet {
    let mut filter = Filter { question, boxes: boxes[0], all: question.elements(), set: Vec::new(), proof: None };
    filter.set.clone_from(&filter.all);
    filter.refine(proof);
    let (limits, others): (Vec<_>, Vec<_>) =
        filter.set.clone().into_iter().partition(|element| matches!(element, Element::Limit { .. }));
    // Usually, either no limit is needed, or limits of both joints are.
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
            kept.push(Blocker { element, without });
        }
    }
    // A question that stayed undecided among many elements may be decided among few.
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

/// Returns blocking sets that have no obstacle in common. After each set, its obstacles are removed from the world, until the
/// remaining world has a motion.
pub fn blocking_sets(question: &MotionQuestion, proof: Option<CheckedProof>, boxes: [usize; 2]) -> Vec<BlockingSet> {
    let mut sets = vec![blocking_set(question, proof, boxes)];
    let mut gone: Vec<Element> = Vec::new();
    while sets.len() < MAX_SETS
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

/// A blocking set from which unnecessary elements are removed.
struct Filter<'a> {
    question: &'a MotionQuestion,
    boxes: usize,
    all: Vec<Element>,
    /// The elements that remain.
    set: Vec<Element>,
    /// Proof that the set blocks all motions. `None` if it blocks the start or all goals.
    proof: Option<CheckedProof>,
}

impl Filter<'_> {
    /// Returns the question in a world with only these elements.
    fn question_with(&self, set: &[Element]) -> MotionQuestion {
        let gone: Vec<Element> = self.all.iter().filter(|element| !set.contains(element)).copied().collect();
        self.question.without(&gone)
    }

    /// Removes some elements from the set if the others still block all motions. Otherwise, the error is the motion that was
    /// found, if any.
    fn try_without(&mut self, some: &[Element]) -> Result<(), Option<CertifiedPath>> {
        let set: Vec<Element> = self.set.iter().filter(|element| !some.contains(element)).copied().collect();
        match self.question_with(&set).answer(self.boxes) {
            Outcome::Found(path) => Err(Some(path)),
            Outcome::Unknown(_) => Err(None),
            Outcome::Infeasible(proof) => {
                self.set = set;
                self.refine(proof);
                Ok(())
            }
        }
    }

    /// Removes all obstacles that a proof does not need.
    fn refine(&mut self, proof: Option<CheckedProof>) {
        self.proof = proof;
        let Some(mut slim) = self.proof.clone() else { return };
        let (question, mut set) = (self.question_with(&self.set), self.set.clone());
        let layer = |stuck: &CollisionBox| question.scene().first_layer(stuck.pair.obstacle);
        for obstacle in self.set.iter().filter_map(|element| element.obstacle()) {
            let fewer =
                slim.collision_boxes().iter().filter(|stuck| layer(stuck) != obstacle).cloned().collect::<Vec<_>>();
            if fewer.len() == slim.collision_boxes().len() {
                set.retain(|element| element.obstacle() != Some(obstacle));
            } else if let Some(fewer) = proof_of_boxes(&question, fewer) {
                slim = fewer;
                set.retain(|element| element.obstacle() != Some(obstacle));
            }
        }
        // Without an obstacle, more configurations may reach the tip goal, which the proof does not cover.
        if let Some(slim) = proof_of_boxes(&self.question_with(&set), slim.collision_boxes().to_vec()) {
            (self.set, self.proof) = (set, Some(slim));
        }
    }
}

/// Returns the proof that consists of these boxes. `None` unless it is shown to be valid before the time is up.
fn proof_of_boxes(question: &MotionQuestion, stuck: Vec<CollisionBox>) -> Option<CheckedProof> {
    let scene = question.scene();
    let clearance = scene.workspace().clearance;
    let check = || Disconnection::new(stuck).checked(scene, question.start(), &question.goals(), clearance).ok();
    question.within_time_limit(check).flatten()
}
