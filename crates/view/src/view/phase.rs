//! Phases of how the planner came to its answer, as pages read them.

use super::numbers::Chain;
use super::trace::{ScaleView, TraceView};
use super::waves::Waves;
use serde::Serialize;

/// How the planner came to a motion of a task, and what it saw.
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
    /// How many things are shown, one after the other.
    pub events: usize,
    /// How long it takes to show them.
    pub seconds: f64,
    #[serde(flatten)]
    pub shows: ShowsView,
}

/// What a phase shows: see [`Shows`](cplan_solver::Shows).
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
    /// Boxes of the trace by their places among the free, the stuck and the mixed ones, in the order in which they are shown.
    Boxes {
        order: Vec<usize>,
    },
    /// Boxes of slabs, the same way.
    Slabs {
        free: Chain,
        stuck: Chain,
        mixed: Chain,
        order: Vec<usize>,
    },
    /// A field after so many sweeps, as levels.
    Sweeps {
        frames: Vec<(usize, Waves)>,
    },
    /// A path that is not the answer's.
    Own {
        points: Chain,
    },
    Path,
    Proof,
}
