//! The first answer: a certified path, or a proof, by slabs alone.

use super::ladder::Request;
use super::settle::decide;
use super::{Answer, Method, Space, Stages, Verdict};
use cplan_core::planner::{PathKind, Proposal, Run, Size, Trace};
use cplan_interrupt::Instant;

/// Answers a request by [`decide`].
pub(super) fn solve(Request { problem, options, .. }: Request) -> Answer {
    let clock = Instant::now();
    let verdict = decide(problem, options.boxes);
    let stages = Stages { query: clock.elapsed(), ..Stages::default() };
    answer(Method::First, verdict, stages)
}

/// An answer of a method that builds no space, from its verdict alone.
pub(super) fn answer(method: Method, verdict: Verdict, stages: Stages) -> Answer {
    let outcome = match &verdict {
        Verdict::Found(path) => Proposal::Found(path.path().clone()),
        Verdict::Infeasible(_) => Proposal::NoPath,
        Verdict::Unknown(reason) => Proposal::GaveUp(reason.clone()),
    };
    let run = Run { outcome, trace: Trace::Slices { free: Vec::new() }, size: Size::Nothing, note: None };
    let (history, witness, bound) = (Vec::new(), None, None);
    Answer { method, verdict, path: PathKind::Taut, witness, bound, history, run, space: Space::Scene, stages }
}
