//! What a planner answers, and how it came to it.

use super::{Bound, Method, Space, Stages};
use cplan_core::check::{CertifiedPath, CheckedProof};
use cplan_core::model::Outcome;
use cplan_core::planner::{PathKind, Planner as _, Run, Trace, Visibility};
use cplan_core::space::{Configuration, Path};
use std::borrow::Cow;
use std::cmp::Ordering;
use std::fmt;

/// The outcome of a single motion, and how the planner came to it. [`solve`](super::solve) finds a path (`F`);
/// the crate `engine` puts the motion along it in its place.
#[derive(Debug, Clone)]
pub struct Answer<F = BoundedPath> {
    /// The planner that was asked.
    pub method: Method,
    /// What was found, the proof that there is none, or why neither is known.
    pub outcome: Outcome<F, CheckedProof, Unknown>,
    /// Which of the method's paths was asked for.
    pub path_kind: PathKind,
    /// What became of each attempt before the last, coarse to fine, in words.
    pub history: Vec<String>,
    /// The planner's last run.
    pub run: Run,
    /// What it worked on.
    pub space: Space,
    /// Where the time went.
    pub stages: Stages,
}

/// A certified path, and how far it is from the optimum.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundedPath {
    /// The path.
    pub certified: CertifiedPath,
    /// Bounds on the optimum, of planners that look for it.
    pub bound: Option<Bound>,
}

/// Why it is not known whether there is a path.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    /// The reason, in words.
    pub reason: String,
    /// A path that slabs or boxes found, which the method's own space does not show. It settles the question, but not by the method
    /// that was asked.
    pub witness: Option<CertifiedPath>,
}

impl BoundedPath {
    /// Returns the path itself.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.certified.path()
    }

    /// Returns a proven lower bound on the distance between arm and obstacles along the path, metres; infinite if nothing can be hit.
    #[must_use]
    pub fn clearance(&self) -> f64 {
        self.certified.clearance()
    }

    /// Returns another path for the same problem, with the same lower bound.
    #[must_use]
    pub fn replaced_by(&self, certified: CertifiedPath) -> Self {
        let bound = self.bound.map(|bound| Bound { upper: bound.metric.length(certified.path()), ..bound });
        Self { certified, bound }
    }
}

impl From<CertifiedPath> for BoundedPath {
    fn from(certified: CertifiedPath) -> Self {
        Self { certified, bound: None }
    }
}

impl AsRef<Self> for BoundedPath {
    fn as_ref(&self) -> &Self {
        self
    }
}

impl fmt::Display for Unknown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.reason)
    }
}

impl From<String> for Unknown {
    fn from(reason: String) -> Self {
        Self { reason, witness: None }
    }
}

/// A visibility graph of more corners than this is drawn as far as it was searched: more lines make a grey surface.
const MOST_CORNERS: usize = 5_000;

impl<F: AsRef<BoundedPath>> Answer<F> {
    /// Returns the path, if one was found.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        self.outcome.found().map(|found| found.as_ref().path())
    }

    /// Returns how far the path is from the optimum at the most, if one was found and the planner bounds it.
    #[must_use]
    pub fn bound(&self) -> Option<Bound> {
        self.outcome.found().and_then(|found| found.as_ref().bound)
    }
}

impl<F> Answer<F> {
    /// Returns why there is no motion, in words; none if there is one.
    #[must_use]
    pub fn reason(&self) -> Option<String> {
        match &self.outcome {
            Outcome::Found(_) => None,
            Outcome::Infeasible(proof) => Some(proof.describe()),
            Outcome::Unknown(unknown) => Some(unknown.reason.clone()),
        }
    }

    /// What to draw of the planner's work: its trace; to that of a visibility graph all arcs between corners are added, which
    /// takes the time to find them.
    #[must_use]
    pub fn drawn(&self) -> Cow<'_, Trace> {
        if let (Trace::Roadmap { edges, whole: false }, Space::Regions(regions)) = (&self.run.trace, &self.space) {
            let map = Visibility::default().build(regions);
            if map.corners() <= MOST_CORNERS {
                // Those that were searched end at start and goals too, and may be directed the other way.
                let key = |[a, b]: [Configuration; 2]| [a[0], a[1], b[0], b[1]];
                let directed = |[a, b]: [Configuration; 2]| if key([a, b]) <= key([b, a]) { [a, b] } else { [b, a] };
                let mut arcs: Vec<_> = map.arcs().into_iter().chain(edges.iter().copied()).map(directed).collect();
                arcs.sort_by(|&a, &b| key(a).partial_cmp(&key(b)).unwrap_or(Ordering::Equal));
                arcs.dedup();
                return Cow::Owned(Trace::Roadmap { edges: arcs, whole: true });
            }
        }
        Cow::Borrowed(&self.run.trace)
    }
}
