//! Decides whether a path exists: by slabs of joint 1, otherwise by boxes.

use super::ladder::explain;
use super::subdivision::certify_shortest_in_channel;
use super::thinned::ThinnedProblem;
use cplan_judge::{CertifiedPath, CheckedProof, Disconnection};
use cplan_model::{MotionProblem, Outcome, Pair};
use cplan_proofs::{Connectivity, connectivity, slab_connectivity, slimmed};

/// Largest number of slabs. Only contrived problems need more. A few thousand slabs take some milliseconds.
const MAX_SLABS: usize = 10_000;

/// Numbers of slabs and of boxes in a first round, which tries both methods, because either may need ten times as much as the
/// other: slabs along a slanted passage that is barely closed, boxes in a narrow passage.
const INITIAL_BUDGETS: [usize; 2] = [1000, 4000];

/// If a proof by slabs has more boxes than this, subdivision looks for a smaller proof. Slabs cover a slanted line, along which
/// obstacles overlap little, by boxes as narrow as the slabs; there, subdivision needs fewer.
pub const LARGE_PROOF_BOXES: usize = 10_000;

/// Largest number of boxes of a proof by slabs, if subdivision finds no smaller one.
const MAX_PROOF_BOXES: usize = 200_000;

/// Least number of boxes for a subdivision that seeks a smaller proof than that of the slabs: twice the most that any of some
/// thousand random proofs needed.
const MIN_BOXES_FOR_SMALLER_PROOF: usize = 100_000;

/// With more pairs of shapes than this, a question is first decided with fewer pieces of obstacles.
const MANY_PAIRS: usize = 4096;

/// Spacings of the lattices that select these pieces, as shares of the arm's reach, in the order of the attempts.
const LATTICE_SPACINGS: [f64; 2] = [1.0 / 128.0, 1.0 / 1024.0];

/// In scenes of more than [`MANY_PAIRS`] pairs: largest product of pairs and slabs, and of pairs and boxes. Each product stands
/// for about a second of work.
const MAX_WORK_PER_SEARCH: [usize; 2] = [4_000_000, 40_000_000];

/// Decides `problem` by [`slab_connectivity`], with at most `boxes` slabs and never more than 10 000. If slabs leave it
/// undecided, decides it by [`connectivity`], with at most `boxes` boxes. The answer is a path, pulled taut in the channel of
/// free boxes, or a proof. Either has passed an independent check, which shares with the search only kernels of geometry and
/// bounds on distances (`Posture`, `Deviation`).
///
/// If the proof of the slabs needs more than 10 000 boxes, and `boxes` is at least 4000, subdivision looks for a smaller proof.
/// It may use at least 100 000 boxes, or fewer in scenes of more than 4096 pairs of shapes.
///
/// The path is rarely the shortest, because the search ends at the first channel. Slabs answer most questions in a fraction of
/// the time that boxes need. Boxes also handle shapes without thickness, and give smaller proofs in some cases.
///
/// In scenes of more than 4096 pairs of shapes, the question is first decided with fewer pieces of obstacles. If the fewer pieces
/// block all paths, so do all pieces. Otherwise the path is checked against all pieces.
///
/// An unknown answer is not final: [`super::solve`] has other methods, and more boxes may help, except in scenes of more than
/// 4096 pairs, where slabs and boxes get about a second of work each.
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
    /// Number of boxes for a smaller proof, if slabs need more than [`LARGE_PROOF_BOXES`]. `None` if the caller's own budget is
    /// too small.
    for_smaller: Option<usize>,
}

/// Decides `thinned` by slabs and boxes. `thinned` is `problem`, or `problem` without some pieces of obstacles. `original_pair`
/// maps pairs of `thinned` to pairs of `problem`.
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
    // A small budget also limits the proof: to four boxes for each box in the budget.
    let proof = if limits.for_smaller.is_some() { LARGE_PROOF_BOXES } else { LARGE_PROOF_BOXES.min(4 * limits.boxes) };
    let either = |slabs: usize, boxes: usize| match (by_slabs(slabs, proof), limits.for_smaller) {
        // Slabs show that there is no path, but would need too many boxes to prove it.
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

/// Checks an answer for fewer pieces of obstacles against all pieces of `problem`.
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

/// Returns the proof if the independent check accepts it. A proof of more than 256 boxes is first reduced.
pub(super) fn accepted_smaller_proof(problem: &MotionProblem, proof: Disconnection) -> Option<CheckedProof> {
    slimmed(&proof, |some| accepted_proof(problem, some))
}

fn accepted_proof(problem: &MotionProblem, proof: Disconnection) -> Option<CheckedProof> {
    let clearance = problem.scene().workspace().clearance;
    proof.checked(problem.scene(), problem.start(), problem.goals(), clearance).ok()
}
