//! The outcome of a planner's search, with the steps that led to it.

use super::{Bound, Method, Space, Stages};
use cplan_judge::{CertifiedPath, CheckedProof};
use cplan_model::Outcome;
use cplan_model::space::{Configuration, Path};
use cplan_planners::planner::{PathKind, Planner as _, Run, Trace, Visibility};
use std::borrow::Cow;
use std::cmp::Ordering;
use std::fmt;

/// The outcome of planning a single motion, with the steps that led to it. `F` is what a success yields: a path from
/// [`solve`](super::solve), or a motion along the path from `plan` of the engine.
#[derive(Debug, Clone)]
pub struct Answer<F = BoundedPath> {
    /// The planner.
    pub method: Method,
    /// The path or motion, a proof that there is none, or the reason why neither is known.
    pub outcome: Outcome<F, CheckedProof, Unknown>,
    /// The requested kind of path.
    pub path_kind: PathKind,
    /// Results of all attempts except the last, from coarse to fine, in words.
    pub history: Vec<String>,
    /// The planner's last run, with its trace.
    pub run: Run,
    /// The space of the last run.
    pub space: Space,
    /// Time spent in each stage.
    pub stages: Stages,
}

/// A certified path, with a bound on its distance from the optimum.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundedPath {
    /// The path.
    pub certified: CertifiedPath,
    /// Bounds on the length of the shortest path. `None` if the planner does not minimise length, or if bounds were not
    /// requested.
    pub bound: Option<Bound>,
}

/// The reason why it is unknown whether there is a path.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    /// The reason, in words.
    pub reason: String,
    /// A certified path that slabs or boxes found. It shows that a path exists, although the requested planner found none in its
    /// own space.
    pub witness: Option<CertifiedPath>,
}

impl BoundedPath {
    /// Returns the waypoints of the path.
    pub fn path(&self) -> &Path {
        self.certified.path()
    }

    /// Returns a proven lower bound on the distance between arm and obstacles along the path, metres; infinite if no obstacle is
    /// within reach.
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

/// Largest number of corners of a visibility graph that is drawn completely. Of larger graphs, pictures show only the searched
/// part, because all lines together would be a grey area.
const MAX_DRAWN_CORNERS: usize = 5_000;

impl<F: AsRef<BoundedPath>> Answer<F> {
    /// Returns the path, if one was found.
    pub fn path(&self) -> Option<&Path> {
        self.outcome.found().map(|found| found.as_ref().path())
    }

    /// Returns the bounds on the path's length, if a path was found and the planner bounds it.
    pub fn bound(&self) -> Option<Bound> {
        self.outcome.found().and_then(|found| found.as_ref().bound)
    }
}

impl<F> Answer<F> {
    /// Returns the reason, in words, why there is no motion. `None` if there is one.
    pub fn reason(&self) -> Option<String> {
        match &self.outcome {
            Outcome::Found(_) => None,
            Outcome::Infeasible(proof) => Some(proof.describe()),
            Outcome::Unknown(unknown) => Some(unknown.reason.clone()),
        }
    }

    /// Returns the trace to draw. It is the planner's own trace; for a visibility graph, all arcs between corners are computed
    /// and added.
    pub fn drawn(&self) -> Cow<'_, Trace> {
        if let (Trace::Roadmap { edges, whole: false }, Space::Regions(regions)) = (&self.run.trace, &self.space) {
            let map = Visibility::default().build(regions);
            if map.corners() <= MAX_DRAWN_CORNERS {
                // Searched arcs may have the opposite direction, and may end at start and goals.
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
