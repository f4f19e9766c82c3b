//! Decides whether there is a path at all: by slabs of joint 1, and otherwise by boxes.

use super::ladder::explain;
use super::subdivision::certify_shortest_in_channel;
use super::thinned::ThinnedProblem;
use cplan_judge::{CertifiedPath, CheckedProof, Disconnection};
use cplan_model::{MotionProblem, Outcome, Pair};
use cplan_proofs::{Connectivity, connectivity, slab_connectivity, slimmed};

/// Largest number of slabs; enough for all but contrived questions. A few thousand slabs take some milliseconds.
const MAX_SLABS: usize = 10_000;

/// Budgets of slabs and of boxes in a first round that tries both methods. Either method may need ten times as much as
/// the other. Slabs need more along a slanted passage that is narrowly closed, and boxes need more in a narrow passage.
const INITIAL_BUDGETS: [usize; 2] = [1000, 4000];

/// Number of boxes of a proof by slabs above which subdivision into boxes is tried as well. Subdivision sometimes needs
/// fewer, for example where obstacles overlap little along a slanted line. Slabs cover such a line by boxes that are as
/// narrow as the slabs.
pub const LARGE_PROOF_BOXES: usize = 10_000;

/// Largest number of boxes of a proof by slabs, if subdivision finds no smaller proof.
const MAX_PROOF_BOXES: usize = 200_000;

/// Least budget of boxes for a subdivision that looks for a smaller proof than that of the slabs. It is twice the
/// largest number that some thousand random proofs needed.
const MIN_BOXES_FOR_SMALLER_PROOF: usize = 100_000;

/// Number of pairs of shapes above which a question is first decided with fewer pieces of obstacles.
const MANY_PAIRS: usize = 4096;

/// Spacings of the lattices that select these pieces, as shares of the arm's reach. They are tried in this order.
const LATTICE_SPACINGS: [f64; 2] = [1.0 / 128.0, 1.0 / 1024.0];

/// Largest product of pairs and slabs, and largest product of pairs and boxes, in scenes of more than [`MANY_PAIRS`]
/// pairs. Each product takes about a second of work.
const MAX_WORK_PER_SEARCH: [usize; 2] = [4_000_000, 40_000_000];

/// Decides `problem` by [`slab_connectivity`], with at most `boxes` slabs and never more than 10 000. If slabs leave it
/// undecided, decides it by [`connectivity`], with at most `boxes` boxes. The answer is a path, pulled taut in the
/// channel of free boxes, or a proof. An independent check has accepted both. It shares only kernels of geometry and
/// its bounds on distances (`Posture`, `Deviation`) with the search.
///
/// Slabs may show that there is no path, but need more than 10 000 boxes to state it. If `boxes` is at least 4000,
/// subdivision then looks for a smaller proof. Its budget is at least 100 000 boxes, or fewer in scenes of more than
/// 4096 pairs of shapes.
///
/// The path is rarely the shortest, because the search ends at the first channel. Slabs answer most questions in a
/// small part of the time. Boxes also handle shapes without thickness, and need fewer boxes for some proofs.
///
/// In scenes of more than 4096 pairs of shapes, the question is first decided with fewer pieces of obstacles. If these
/// block all paths, so do all pieces. If these leave a path, the path is checked against all pieces.
///
/// An unknown answer is not final: [`super::solve`] has other methods, and more boxes may decide it. In scenes of more
/// than 4096 pairs, more boxes do not help, because slabs and boxes get about a second of work each.
pub fn decide(problem: &MotionProblem, boxes: usize) -> Outcome<CertifiedPath, CheckedProof> {
    let pairs = |problem: &MotionProblem| problem.scene().pairs().len();
    if pairs(problem) <= MANY_PAIRS {
        let for_smaller = (boxes >= INITIAL_BUDGETS[1]).then_some(MIN_BOXES_FOR_SMALLER_PROOF.max(boxes));
        let limits = DecisionBudget { slabs: MAX_SLABS.min(boxes), boxes, for_smaller };
        return decide_within(problem, problem, &|pair| pair, limits);
    }
    let limited = |thinned: &MotionProblem| {
        let [slabs, boxes] = MAX_WORK_PER_SEARCH.map(|work| boxes.min(MAX_SLABS).min(work / pairs(thinned).max(1)));
        DecisionBudget {
            slabs,
            boxes,
            for_smaller: Some(MIN_BOXES_FOR_SMALLER_PROOF.min(MAX_WORK_PER_SEARCH[1] / pairs(thinned).max(1))),
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
    /// Budget of boxes for a smaller proof, used if slabs need more than [`LARGE_PROOF_BOXES`] boxes. `None` if the
    /// caller's own budget is too small for this.
    for_smaller: Option<usize>,
}

/// Decides `thinned` by slabs and boxes. It is `problem`, or `problem` without some pieces of obstacles.
/// `original_pair` maps pairs of `thinned` to pairs of `problem`.
fn decide_within(
    problem: &MotionProblem,
    thinned: &MotionProblem,
    original_pair: &dyn Fn(Pair) -> Pair,
    limits: DecisionBudget,
) -> Outcome<CertifiedPath, CheckedProof> {
    let (scene, start, goals) = (thinned.scene(), thinned.start(), thinned.goals());
    let clearance = scene.workspace().clearance;
    let by_boxes =
        |boxes: usize| checked_answer(problem, original_pair, connectivity(scene, start, goals, clearance, boxes));
    let by_slabs = |slabs: usize, most: usize| slab_connectivity(scene, start, goals, clearance, slabs, most);
    // A small budget also limits the proof: to four boxes for each box of the budget.
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

/// Checks an answer that was found with fewer pieces of obstacles against all pieces of `problem`.
fn checked_answer(
    problem: &MotionProblem,
    original_pair: &dyn Fn(Pair) -> Pair,
    answer: Connectivity,
) -> Outcome<CertifiedPath, CheckedProof> {
    match answer {
        Connectivity::Connected(channel) => certify_shortest_in_channel(problem, &channel).map_or_else(
            |rejection| {
                Outcome::Unknown(format!(
                    "the path of the planner is not certified: {}",
                    explain(problem.scene(), rejection)
                ))
            },
            Outcome::Found,
        ),
        Connectivity::Disconnected(proof) => accepted_smaller_proof(problem, proof.of_pairs(original_pair))
            .map_or_else(
                || Outcome::Unknown("the proposed proof of infeasibility does not hold".into()),
                Outcome::Infeasible,
            ),
        Connectivity::Undecided { boxes, .. } => {
            Outcome::Unknown(format!("{boxes} boxes were not enough to decide whether a path exists"))
        }
    }
}

/// Returns the proof if the independent check accepts it. A proof of more than 256 boxes is first reduced to fewer
/// boxes.
pub(super) fn accepted_smaller_proof(problem: &MotionProblem, proof: Disconnection) -> Option<CheckedProof> {
    slimmed(&proof, |some| accepted_proof(problem, some))
}

/// Returns the proof if the independent check accepts it.
fn accepted_proof(problem: &MotionProblem, proof: Disconnection) -> Option<CheckedProof> {
    let clearance = problem.scene().workspace().clearance;
    proof.checked(problem.scene(), problem.start(), problem.goals(), clearance).ok()
}
