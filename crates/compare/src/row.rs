//! What one planner did on one problem.

use cplan_core::model::Status;
use cplan_core::planner::{Note, PathKind, Size};
use cplan_engine::Family;

/// Figures of a planner's path of the other kind than the row is about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OtherPath {
    /// Its length, in the unit of [`Row::length`].
    pub length: f64,
    /// Its clearance, as in [`Row::clearance`].
    pub clearance: Option<f64>,
}

/// What one planner did. What it did not come to is missing.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Name on the command line.
    pub planner: String,
    /// What kind of planner it is.
    pub family: Family,
    /// Which of its paths.
    pub path_kind: PathKind,
    /// How it ended.
    pub outcome: Status,
    /// Euclidean length in joint space (rad and m as they come).
    pub length: Option<f64>,
    /// Its path of the other kind, if it has one.
    pub other_path: Option<OtherPath>,
    /// Straight pieces of the path.
    pub pieces: Option<usize>,
    /// Proven least distance between arm and obstacles along the path, metres; none where nothing can be hit.
    pub clearance: Option<f64>,
    /// Time that the motion takes, seconds.
    pub duration: Option<f64>,
    /// How much was built.
    pub size: Option<Size>,
    /// Computing time to prepare the space, seconds.
    pub build: Option<f64>,
    /// Computing time to answer the query, seconds.
    pub query: Option<f64>,
    /// Computing time of the certificate, seconds.
    pub certify: Option<f64>,
    /// Computing time spent looking for a proof that there is no path, seconds.
    pub prove: Option<f64>,
    /// Computing time from the problem to the verdict, seconds: all of these, and what lies between them.
    pub total: Option<f64>,
    /// Bytes that were allocated at the same time on the way to the verdict, at the most.
    pub memory: Option<u64>,
    /// What the planner has to add.
    pub note: Option<Note>,
    /// Why the outcome is unknown, in words.
    pub reason: Option<String>,
}

impl Row {
    /// A row that knows nothing yet but who it is about.
    #[must_use]
    pub fn new(planner: impl Into<String>, family: Family, outcome: Status) -> Self {
        Self {
            planner: planner.into(),
            family,
            path_kind: PathKind::Taut,
            other_path: None,
            outcome,
            length: None,
            pieces: None,
            clearance: None,
            duration: None,
            size: None,
            build: None,
            query: None,
            certify: None,
            prove: None,
            total: None,
            memory: None,
            note: None,
            reason: None,
        }
    }

    /// Length and clearance of the planner's path of this kind, if both are known.
    #[must_use]
    pub fn of_kind(&self, kind: PathKind) -> Option<(f64, Option<f64>)> {
        let other = self.other_path?;
        if self.path_kind == kind {
            Some((self.length?, self.clearance))
        } else {
            Some((other.length, other.clearance))
        }
    }

    /// Nodes, edges, cells, sweeps, expanded cells: each where it has a meaning.
    #[must_use]
    pub fn counts(&self) -> [Option<usize>; 5] {
        let figures = self.size.map_or_else(Vec::new, Size::figures);
        let of = |name: &str| figures.iter().find(|figure| figure.0 == name).map(|figure| figure.1);
        [of("nodes"), of("edges"), of("cells"), of("sweeps"), of("expanded")]
    }

    /// What there is to say below a table, a line each.
    pub(super) fn remarks(&self) -> impl Iterator<Item = String> + '_ {
        let note = self.note.map(|note| format!("{}: {note}", self.planner));
        let reason = self.reason.as_ref().map(|reason| format!("{}: unknown: {reason}", self.planner));
        note.into_iter().chain(reason)
    }
}
