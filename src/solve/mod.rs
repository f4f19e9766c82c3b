//! From a problem to a verdict: build a space, plan, certify; refine and replan where that fails; and where no path is
//! found, look for a proof that there is none.
//!
//! Planners see approximations of the configuration space, so their paths are proposals. What leaves this module as
//! found has passed [`crate::certify`], what leaves it as infeasible is proven there.

mod admission;
mod ladder;
mod method;
mod shorten;
mod subdivision;
mod swift;

pub use ladder::{Effort, solve};
pub use method::Method;
pub use shorten::shorten;
pub use swift::decide;

use crate::certify::{CertifiedPath, Disconnection, StuckBox};
use crate::cspace::{Grid, Regions};
use crate::plan::Run;
use std::time::Duration;

/// The answer to a problem.
#[derive(Debug, Clone)]
pub enum Verdict {
    /// A motion that is proven free.
    Found(CertifiedPath),
    /// There is none: proven.
    Infeasible(Disconnection),
    /// Neither within the effort: why, in words.
    Unknown(String),
}

impl Verdict {
    /// The boxes that prove that there is no path; none where that is not proven.
    #[must_use]
    pub fn proof(&self) -> &[StuckBox] {
        if let Verdict::Infeasible(proof) = self { proof.stuck() } else { &[] }
    }
}

/// The representation that the last attempt worked on.
#[derive(Debug, Clone)]
pub enum Space {
    /// Polygons, with the margin that obstacles were grown by, metres.
    Regions(Box<Regions>),
    /// Cells.
    Grid(Box<Grid>),
    /// None: subdivision judges the scene itself.
    Scene,
}

/// Time spent in each stage, over all attempts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Stages {
    /// Building the configuration space, and what the planner prepares without start and goal.
    pub build: Duration,
    /// Answering the query.
    pub query: Duration,
    /// Certifying proposals.
    pub certify: Duration,
    /// Looking for a proof that there is no path.
    pub prove: Duration,
}

/// A verdict and how it came about.
#[derive(Debug, Clone)]
pub struct Answer {
    /// Which planner was asked.
    pub method: Method,
    /// The result.
    pub verdict: Verdict,
    /// What became of each attempt before the last, coarse to fine, in words.
    pub history: Vec<String>,
    /// The planner's last run.
    pub run: Run,
    /// What it worked on.
    pub space: Space,
    /// Where the time went.
    pub stages: Stages,
}
