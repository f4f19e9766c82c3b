//! The quickest answer: a certified path, or a proof, from slabs of joint 1 alone.

use super::Verdict;
use super::ladder::explain;
use super::subdivision::certified;
use crate::certify::{Connectivity, Disconnection, connectivity, slab_connectivity};
use crate::model::Problem;

/// Slabs that decide all but contrived questions; a few thousand take some milliseconds.
pub(super) const SLABS: usize = 10_000;

/// Boxes of the search where slabs find that there is no way, but could only say so in hundreds of thousands of boxes.
const BOXES: usize = 200_000;

/// Answers `problem` by [`slab_connectivity`] with at most `slabs` slabs: a path, pulled taut in the channel of free
/// boxes that they make, or a proof. Both have passed a check that shares no code with the search.
///
/// The path is some path, seldom the shortest: the first channel that is found is good enough. Unknown is no last word:
/// [`super::solve`] knows other ways.
#[must_use]
pub fn decide(problem: &Problem, slabs: usize) -> Verdict {
    let scene = problem.scene();
    let clearance = scene.workspace().clearance;
    match slab_connectivity(scene, problem.start(), problem.goals(), clearance, slabs) {
        Connectivity::Connected(channel) => certified(problem, &channel).map_or_else(
            |rejection| Verdict::Unknown(format!("its path is not certified: {}", explain(scene, rejection))),
            Verdict::Found,
        ),
        Connectivity::Disconnected(proof) => checked(problem, proof)
            .map_or_else(|| Verdict::Unknown("the proof that there is none does not hold".into()), Verdict::Infeasible),
        Connectivity::Undecided { boxes } => {
            let proof = match connectivity(scene, problem.start(), problem.goals(), clearance, BOXES) {
                Connectivity::Disconnected(proof) => checked(problem, proof),
                _ => None,
            };
            let unknown = || Verdict::Unknown(format!("{boxes} slabs do not tell whether there is a path"));
            proof.map_or_else(unknown, Verdict::Infeasible)
        }
    }
}

/// The proof with no more boxes than it takes, if it passes the independent check: no search is trusted.
pub(super) fn checked(problem: &Problem, proof: Disconnection) -> Option<Disconnection> {
    let clearance = problem.scene().workspace().clearance;
    let holds =
        |proof: &Disconnection| proof.recheck(problem.scene(), problem.start(), problem.goals(), clearance).is_ok();
    holds(&proof).then(|| proof.slimmed(holds))
}
