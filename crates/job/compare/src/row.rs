//! The result of one planner on one problem.

use cplan_model::Status;
use cplan_planners::planner::{Note, PathKind, Size};
use cplan_solver::Family;

/// Length and clearance of a planner's path of the other kind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OtherPath {
    /// Length, in the unit of [`Row::length`].
    pub length: f64,
    /// Clearance, as in [`Row::clearance`].
    pub clearance: Option<f64>,
}

/// The result of one planner. A value is `None` if the planner did not get that far.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Name of the planner with its options, as on the command line.
    pub planner: String,
    /// Family that the planner belongs to.
    pub family: Family,
    /// Kind of the path.
    pub path_kind: PathKind,
    /// Status of the result.
    pub outcome: Status,
    /// Euclidean length in joint space (mixing rad and m).
    pub length: Option<f64>,
    /// Length and clearance of the planner's path of the other kind, if it has one.
    pub other_path: Option<OtherPath>,
    /// Number of straight pieces of the path.
    pub pieces: Option<usize>,
    /// Proven lower bound on the distance between arm and obstacles along the path, in metres. `None` if no obstacle is
    /// within reach.
    pub clearance: Option<f64>,
    /// Duration of the motion, in seconds.
    pub duration: Option<f64>,
    /// Size of the data structures.
    pub size: Option<Size>,
    /// Computing time to prepare the space, seconds.
    pub build: Option<f64>,
    /// Computing time to answer the query, seconds.
    pub query: Option<f64>,
    /// Computing time of the certificate, seconds.
    pub certify: Option<f64>,
    /// Computing time spent looking for a proof that there is no path, seconds.
    pub prove: Option<f64>,
    /// Computing time from the problem to the outcome, in seconds: the times above and all between them.
    pub total: Option<f64>,
    /// Greatest number of bytes allocated at the same time before the outcome was known.
    pub memory: Option<u64>,
    /// A note of the planner.
    pub note: Option<Note>,
    /// The reason why the outcome is unknown, in words.
    pub reason: Option<String>,
}

impl Row {
    /// Creates a row with only the planner's identity and status.
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

    /// Returns length and clearance of the planner's path of this kind, if both are known.
    pub fn of_kind(&self, kind: PathKind) -> Option<(f64, Option<f64>)> {
        let other = self.other_path?;
        if self.path_kind == kind {
            Some((self.length?, self.clearance))
        } else {
            Some((other.length, other.clearance))
        }
    }

    /// Returns the numbers of nodes, edges, cells, sweeps and expanded cells; `None` for a number that the planner does not have.
    pub fn counts(&self) -> [Option<usize>; 5] {
        let figures = self.size.map_or_else(Vec::new, Size::figures);
        let of = |name: &str| figures.iter().find(|figure| figure.0 == name).map(|figure| figure.1);
        [of("nodes"), of("edges"), of("cells"), of("sweeps"), of("expanded")]
    }

    /// Iterates over the remarks of this row, which are printed below a table.
    pub(super) fn remarks(&self) -> impl Iterator<Item = String> + '_ {
        let note = self.note.map(|note| format!("{}: {note}", self.planner));
        let reason = self.reason.as_ref().map(|reason| format!("{}: unknown: {reason}", self.planner));
        note.into_iter().chain(reason)
    }
}
