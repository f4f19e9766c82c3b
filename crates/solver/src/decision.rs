//! Decides whether there is a path at all: by slabs of joint 1, and otherwise by boxes.

use super::ladder::explain;
use super::subdivision::certified;
use super::thinned::ThinnedProblem;
use cplan_core::check::{CertifiedPath, CheckedProof, Disconnection};
use cplan_core::model::{MotionProblem, Outcome, Pair};
use cplan_proofs::{Connectivity, connectivity, slab_connectivity, slimmed};

/// Number of slabs that decide all but contrived questions. A few thousand take some milliseconds.
const MAX_SLABS: usize = 10_000;

/// Initial budgets of slabs and boxes, before both get their full budgets. Either may need ten times as many where the
/// other succeeds soon: slabs along a slanted passage that is narrowly closed, boxes in a narrow passage.
const INITIAL_BUDGETS: [usize; 2] = [1000, 4000];

/// A proof of more boxes than this is large: where slabs have only such a one, boxes that are halved need fewer, as where obstacles overlap little all
/// along a slanted line, which slabs tile with boxes as narrow as themselves.
pub const LARGE_PROOF_BOXES: usize = 10_000;

/// Largest number of boxes of a proof, if no smaller proof is found.
const MAX_PROOF_BOXES: usize = 200_000;

/// Least number of boxes in the search for a smaller proof than that of slabs: twice the most that any of some thousand
/// random proofs took.
const MIN_BOXES_FOR_SMALLER_PROOF: usize = 100_000;

/// With more pairs of shapes than this, questions are first decided with fewer of them: ...
const MANY_PAIRS: usize = 4096;

/// ... with those that a lattice leaves whose spacing is this share of the arm's reach, one lattice after the other.
const LATTICE_SPACINGS: [f64; 2] = [1.0 / 128.0, 1.0 / 1024.0];

/// Largest product of pairs and slabs, and of pairs and boxes, in such a scene: about a second of work each.
const MAX_WORK_PER_SEARCH: [usize; 2] = [4_000_000, 40_000_000];

/// Decides `problem` by [`slab_connectivity`], and if slabs leave it undecided by [`connectivity`], with at most
/// `boxes` boxes and no more slabs. The answer is a path, pulled taut in the channel of free boxes, or a proof. Both
/// have passed a check that shares no code with the search.
///
/// Slabs may show that there is no path, but need too many boxes to state it. Then up to 100 000 boxes are tried, even
/// if `boxes` is less, unless it is less than 4000.
///
/// The path is rarely the shortest: the first channel that is found suffices. Slabs answer most questions in a small
/// part of the time. Boxes also handle shapes without thickness, and need fewer boxes for some proofs.
///
/// Among thousands of pieces, the question is first decided with some of them: if these block all paths, so do all
/// pieces, and a path among them is judged among all.
///
/// An unknown answer is not final: [`super::solve`] has other methods, and more boxes may decide it. With thousands of
/// pieces more boxes do not help, because no more than a second's work of each is done.
#[must_use]
pub fn decide(problem: &MotionProblem, boxes: usize) -> Outcome<CertifiedPath, CheckedProof> {
    let pairs = |problem: &MotionProblem| problem.scene().pairs().len();
    if pairs(problem) <= MANY_PAIRS {
        let for_smaller = (boxes >= INITIAL_BUDGETS[1]).then_some(MIN_BOXES_FOR_SMALLER_PROOF.max(boxes));
        let limits = DecisionBudget { slabs: MAX_SLABS.min(boxes), boxes, for_smaller };
        return decide_within(problem, problem, &|pair| pair, limits);
    }
    let limited = |decide_within: &MotionProblem| {
        let [slabs, boxes] =
            MAX_WORK_PER_SEARCH.map(|looks| boxes.min(MAX_SLABS).min(looks / pairs(decide_within).max(1)));
        DecisionBudget {
            slabs,
            boxes,
            for_smaller: Some(MIN_BOXES_FOR_SMALLER_PROOF.min(MAX_WORK_PER_SEARCH[1] / pairs(decide_within).max(1))),
        }
    };
    for lattice in LATTICE_SPACINGS {
        let thinned = ThinnedProblem::new(problem, lattice * problem.scene().arm().reach());
        let decided =
            decide_within(problem, &thinned.problem, &|pair| thinned.original_pair(pair), limited(&thinned.problem));
        if !matches!(decided, Outcome::Unknown(_)) {
            return decided;
        }
    }
    decide_within(problem, problem, &|pair| pair, limited(problem))
}

/// Budgets of a decision.
#[derive(Clone, Copy)]
struct DecisionBudget {
    slabs: usize,
    boxes: usize,
    /// Number of boxes for a smaller proof, if slabs find a large one. `None` if the caller cannot wait for that.
    for_smaller: Option<usize>,
}

/// Decides `some`, which is `problem` or has some of its pieces, by slabs and boxes. `original_pair` maps its pairs to those
/// of `problem`.
fn decide_within(
    problem: &MotionProblem,
    some: &MotionProblem,
    original_pair: &dyn Fn(Pair) -> Pair,
    limits: DecisionBudget,
) -> Outcome<CertifiedPath, CheckedProof> {
    let (scene, start, goals) = (some.scene(), some.start(), some.goals());
    let clearance = scene.workspace().clearance;
    let by_boxes =
        |boxes: usize| checked_answer(problem, original_pair, connectivity(scene, start, goals, clearance, boxes));
    let by_slabs = |slabs: usize, most: usize| slab_connectivity(scene, start, goals, clearance, slabs, most);
    let proof = if limits.for_smaller.is_some() { LARGE_PROOF_BOXES } else { LARGE_PROOF_BOXES.min(4 * limits.boxes) };
    let either = |slabs: usize, boxes: usize| match (by_slabs(slabs, proof), limits.for_smaller) {
        // There is no path, but slabs need too many boxes to state it.
        (Connectivity::Undecided { closed: true, .. }, Some(for_smaller)) => match by_boxes(for_smaller) {
            Outcome::Unknown(_) => checked_answer(problem, original_pair, by_slabs(slabs, MAX_PROOF_BOXES)),
            known => known,
        },
        (answer, _) => match checked_answer(problem, original_pair, answer) {
            Outcome::Unknown(_) => by_boxes(boxes),
            known => known,
        },
    };
    let [slabs, boxes] = INITIAL_BUDGETS;
    match either(limits.slabs.min(slabs), limits.boxes.min(boxes)) {
        Outcome::Unknown(_) if limits.slabs > slabs || limits.boxes > boxes => either(limits.slabs, limits.boxes),
        decided => decided,
    }
}

/// Checks a search's answer.
fn checked_answer(
    problem: &MotionProblem,
    original_pair: &dyn Fn(Pair) -> Pair,
    answer: Connectivity,
) -> Outcome<CertifiedPath, CheckedProof> {
    match answer {
        Connectivity::Connected(channel) => certified(problem, &channel).map_or_else(
            |rejection| Outcome::Unknown(format!("its path is not certified: {}", explain(problem.scene(), rejection))),
            Outcome::Found,
        ),
        Connectivity::Disconnected(proof) => checked(problem, proof.of_pairs(original_pair)).map_or_else(
            || Outcome::Unknown("the proposed proof of infeasibility does not hold".into()),
            Outcome::Infeasible,
        ),
        Connectivity::Undecided { boxes, .. } => {
            Outcome::Unknown(format!("{boxes} boxes do not decide whether a path exists"))
        }
    }
}

/// Returns the proof without superfluous boxes, if it passes the independent check.
pub(super) fn checked(problem: &MotionProblem, proof: Disconnection) -> Option<CheckedProof> {
    slimmed(&proof, |some| if_checked(problem, some))
}

/// Returns the proof, if it passes the independent check.
fn if_checked(problem: &MotionProblem, proof: Disconnection) -> Option<CheckedProof> {
    let clearance = problem.scene().workspace().clearance;
    proof.checked(problem.scene(), problem.start(), problem.goals(), clearance).ok()
}
