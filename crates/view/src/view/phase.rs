//! Phases of the planner's search, in the document for pages.

use super::numbers::Chain;
use super::trace::{ScaleView, TraceView};
use super::waves::Waves;
use serde::Serialize;

/// The planner's search for a motion of a task, with its trace.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MotionReplayView {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trace: Option<TraceView>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<ScaleView>,
    pub phases: Vec<PhaseView>,
}

/// A phase of a run; without data of its own it shows a part of the trace.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PhaseView {
    pub caption: String,
    /// Number of things shown one after the other.
    pub events: usize,
    /// Time in which they are shown.
    pub seconds: f64,
    #[serde(flatten)]
    pub shows: ShowsView,
}

/// The content of a phase: see [`Shows`](cplan_solver::Shows).
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum ShowsView {
    Nodes,
    Edges,
    Cells {
        swept: bool,
    },
    Channel,
    Expanded,
    Slices,
    Wave,
    Levels,
    /// Boxes of the trace, by their numbers among the free, the stuck and the undecided ones, in the order of their
    /// display.
    Boxes {
        order: Vec<usize>,
    },
    /// Boxes of slabs, in the same form.
    Slabs {
        free: Chain,
        stuck: Chain,
        mixed: Chain,
        order: Vec<usize>,
    },
    /// A field after this many sweeps, as levels.
    Sweeps {
        frames: Vec<(usize, Waves)>,
    },
    /// A path that differs from the answer's.
    Own {
        points: Chain,
    },
    Path,
    Proof,
}
