//! The answer to a motion problem.

use super::{CertifiedPath, CheckedProof};
use crate::model::Outcome;
use cplan_text::counted;

/// The answer to a problem: a motion that is proven free, a proof that there is none, or why neither is known within the effort.
pub type Verdict = Outcome<CertifiedPath, CheckedProof>;

impl Verdict {
    /// The proof that there is no path, if that is the answer.
    #[must_use]
    pub fn proof(&self) -> Option<&CheckedProof> {
        if let Verdict::Infeasible(proof) = self { Some(proof) } else { None }
    }

    /// Why there is no motion, if there is none.
    #[must_use]
    pub fn reason(&self) -> Option<String> {
        match self {
            Verdict::Found(_) => None,
            Verdict::Infeasible(proof) => {
                let boxes = counted(proof.stuck().len(), "box");
                Some(format!("proven: colliding configurations separate start and goal ({boxes})"))
            }
            Verdict::Unknown(reason) => Some(reason.clone()),
        }
    }
}
