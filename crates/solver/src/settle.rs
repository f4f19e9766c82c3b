//! Whether there is a path at all: by slabs of joint 1, else by boxes.

use super::ladder::explain;
use super::subdivision::certified;
use super::thinned::Thinned;
use cplan_core::check::{CertifiedPath, CheckedProof, Disconnection};
use cplan_core::model::{MotionProblem, Outcome, Pair};
use cplan_proofs::{Connectivity, connectivity, slab_connectivity, slimmed};

/// Slabs that decide all but contrived questions; a few thousand take some milliseconds.
const SLABS: usize = 10_000;

/// What slabs and boxes may take before the other is asked. Either may need ten times as many where the other is done soon: slabs
/// along a slanted way that is closed by little, boxes in a narrow passage.
const AT_FIRST: [usize; 2] = [1000, 4000];

/// A proof of more boxes than this is large: where slabs have only such a one, boxes that are halved need fewer, as where obstacles overlap little all
/// along a slanted line, which slabs tile with boxes as narrow as themselves.
pub const LARGE_PROOF: usize = 10_000;

/// Boxes of a proof at most, where no smaller one is found.
const LARGEST_PROOF: usize = 200_000;

/// Boxes that are looked at for a smaller proof than slabs have, at least: the most that any of some thousand random proofs
/// took, twice.
const BOXES_FOR_SMALLER: usize = 100_000;

/// With more pairs of shapes what is known of fewer of them is asked for first, ...
const MANY_PAIRS: usize = 4096;

/// ... of as few as a lattice of this share of the arm's reach leaves, one after the other.
const LATTICES: [f64; 2] = [1.0 / 128.0, 1.0 / 1024.0];

/// Pairs times slabs, and times boxes, that are looked at in such a scene: a second's worth each, or some.
const LOOKS: [usize; 2] = [4_000_000, 40_000_000];

/// Answers `problem` by [`slab_connectivity`], and where slabs do not tell by [`connectivity`], with at most so many `boxes`
/// (and no more slabs): a path, pulled taut in the channel of free boxes, or a proof. Both have passed a check that shares no
/// code with the search. Where slabs show that there is no path, but state it in no small number of boxes, up to 100 000 are
/// looked at even if `boxes` is less, unless it is less than 4000.
///
/// The path is some path, seldom the shortest: the first channel that is found is good enough. Slabs answer most questions in
/// a small part of the time; boxes know about shapes without thickness, too, and need fewer for some proofs. Among thousands of
/// pieces the questions are put to some of them first: what these close is closed, and a path among them is judged among all.
/// Unknown is no last word: [`super::solve`] knows other ways, and more boxes may tell, but among thousands of pieces: there no more
/// than a second's worth of each are looked at.
#[must_use]
pub fn decide(problem: &MotionProblem, boxes: usize) -> Outcome<CertifiedPath, CheckedProof> {
    let pairs = |problem: &MotionProblem| problem.scene().pairs().len();
    if pairs(problem) <= MANY_PAIRS {
        let for_smaller = (boxes >= AT_FIRST[1]).then_some(BOXES_FOR_SMALLER.max(boxes));
        let limits = Limits { slabs: SLABS.min(boxes), boxes, for_smaller };
        return asked(problem, problem, &|pair| pair, limits);
    }
    let limited = |asked: &MotionProblem| {
        let [slabs, boxes] = LOOKS.map(|looks| boxes.min(SLABS).min(looks / pairs(asked).max(1)));
        Limits { slabs, boxes, for_smaller: Some(BOXES_FOR_SMALLER.min(LOOKS[1] / pairs(asked).max(1))) }
    };
    for lattice in LATTICES {
        let thinned = Thinned::new(problem, lattice * problem.scene().arm().reach());
        let decided = asked(problem, &thinned.problem, &|pair| thinned.in_truth(pair), limited(&thinned.problem));
        if !matches!(decided, Outcome::Unknown(_)) {
            return decided;
        }
    }
    asked(problem, problem, &|pair| pair, limited(problem))
}

/// How much is looked at.
#[derive(Clone, Copy)]
struct Limits {
    slabs: usize,
    boxes: usize,
    /// Boxes, where slabs show that there is no path, but with a large proof; none if whoever asks cannot wait for that.
    for_smaller: Option<usize>,
}

/// What slabs and boxes say of `some`, which is `problem` or some of it; `in_truth` names its pairs in `problem`.
fn asked(
    problem: &MotionProblem,
    some: &MotionProblem,
    in_truth: &dyn Fn(Pair) -> Pair,
    limits: Limits,
) -> Outcome<CertifiedPath, CheckedProof> {
    let (scene, start, goals) = (some.scene(), some.start(), some.goals());
    let clearance = scene.workspace().clearance;
    let by_boxes = |boxes: usize| judged(problem, in_truth, connectivity(scene, start, goals, clearance, boxes));
    let by_slabs = |slabs: usize, most: usize| slab_connectivity(scene, start, goals, clearance, slabs, most);
    let proof = if limits.for_smaller.is_some() { LARGE_PROOF } else { LARGE_PROOF.min(4 * limits.boxes) };
    let either = |slabs: usize, boxes: usize| match (by_slabs(slabs, proof), limits.for_smaller) {
        // There is none, but slabs take no end of boxes to state it.
        (Connectivity::Undecided { closed: true, .. }, Some(for_smaller)) => match by_boxes(for_smaller) {
            Outcome::Unknown(_) => judged(problem, in_truth, by_slabs(slabs, LARGEST_PROOF)),
            known => known,
        },
        (answer, _) => match judged(problem, in_truth, answer) {
            Outcome::Unknown(_) => by_boxes(boxes),
            known => known,
        },
    };
    let [slabs, boxes] = AT_FIRST;
    match either(limits.slabs.min(slabs), limits.boxes.min(boxes)) {
        Outcome::Unknown(_) if limits.slabs > slabs || limits.boxes > boxes => either(limits.slabs, limits.boxes),
        decided => decided,
    }
}

/// What a search's answer is worth.
fn judged(
    problem: &MotionProblem,
    in_truth: &dyn Fn(Pair) -> Pair,
    answer: Connectivity,
) -> Outcome<CertifiedPath, CheckedProof> {
    match answer {
        Connectivity::Connected(channel) => certified(problem, &channel).map_or_else(
            |rejection| Outcome::Unknown(format!("its path is not certified: {}", explain(problem.scene(), rejection))),
            Outcome::Found,
        ),
        Connectivity::Disconnected(proof) => checked(problem, proof.of_pairs(in_truth))
            .map_or_else(|| Outcome::Unknown("the proof that there is none does not hold".into()), Outcome::Infeasible),
        Connectivity::Undecided { boxes, .. } => {
            Outcome::Unknown(format!("{boxes} boxes do not tell whether there is a path"))
        }
    }
}

/// The proof with no more boxes than it takes, if it passes the independent check.
pub(super) fn checked(problem: &MotionProblem, proof: Disconnection) -> Option<CheckedProof> {
    slimmed(&proof, |some| held(problem, some))
}

/// The proof, if it passes the independent check.
fn held(problem: &MotionProblem, proof: Disconnection) -> Option<CheckedProof> {
    let clearance = problem.scene().workspace().clearance;
    proof.checked(problem.scene(), problem.start(), problem.goals(), clearance).ok()
}
