//! The planner `first`: a certified path or a proof, by [`decide`] alone.

use super::decision::decide;
use super::ladder::Request;
use super::{Answer, Method, Space, Stages};
use cplan_interrupt::Instant;
use cplan_judge::{CertifiedPath, CheckedProof};
use cplan_model::Outcome;
use cplan_planners::planner::{PathKind, Proposal, Run, Size, Trace};

/// Answers a request by [`decide`].
pub(super) fn solve(Request { problem, options, .. }: Request) -> Answer {
    let clock = Instant::now();
    let decided = decide(problem, options.boxes);
    let stages = Stages { query: clock.elapsed(), ..Stages::default() };
    answer(Method::First, decided, stages)
}

/// Creates the answer of a planner without a space: it has an outcome, but no trace and no history.
pub(super) fn answer(method: Method, decided: Outcome<CertifiedPath, CheckedProof>, stages: Stages) -> Answer {
    let (proposal, outcome) = match decided {
        Outcome::Found(path) => (Proposal::Found(path.path().clone()), Outcome::Found(path.into())),
        Outcome::Infeasible(proof) => (Proposal::NoPath, Outcome::Infeasible(proof)),
        Outcome::Unknown(reason) => (Proposal::GaveUp(reason.clone()), Outcome::Unknown(reason.into())),
    };
    let run = Run::new(proposal, Trace::Slices { free: Vec::new() }, Size::Nothing);
    Answer { method, outcome, path_kind: PathKind::Taut, history: Vec::new(), run, space: Space::Scene, stages }
}
