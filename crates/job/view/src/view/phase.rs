//! Phases of the planner's search, in the document for pages.

use super::numbers::Chain;
use super::trace::{ScaleView, TraceView};
use super::waves::Waves;
use serde::Serialize;

/// The phases of the search for one motion of a task, and the planner's trace.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MotionReplayView {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trace: Option<TraceView>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<ScaleView>,
    pub phases: Vec<PhaseView>,
}

/// A phase of the planner's run. Unless `shows` contains data, the phase shows a part of the trace.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PhaseView {
    pub caption: String,
    /// Number of items that the phase shows one by one.
    pub events: usize,
    /// Duration of the phase, in seconds.
    pub seconds: f64,
    /// Length of the certified path that is known at the end of the phase.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    #[serde(flatten)]
    pub shows: ShowsView,
}

/// A round of the lower bound: see [`BoundRound`](cplan_solver::BoundRound).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RoundView {
    pub lower: f64,
    pub points: Chain,
    pub slices: Vec<f64>,
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
    /// The first certified path.
    First {
        points: Chain,
    },
    /// Rounds of the lower bound, and the unit of the lengths.
    Bound {
        unit: &'static str,
        rounds: Vec<RoundView>,
    },
    Slices,
    Wave,
    Levels,
    /// Boxes of the trace. `order` has their indices in the order of display. In it, free boxes have the lowest indices, then
    /// colliding ones, then undecided ones.
    Boxes {
        order: Vec<usize>,
    },
    /// Boxes of slabs: least and greatest values of each box, and `order` as for [`ShowsView::Boxes`].
    Slabs {
        free: Chain,
        stuck: Chain,
        mixed: Chain,
        order: Vec<usize>,
    },
    /// A field during its relaxation. Each frame has the number of a sweep, and the values after it as levels.
    Sweeps {
        frames: Vec<(usize, Waves)>,
    },
    /// The planner's own path, if it differs from the path of the answer.
    Own {
        points: Chain,
    },
    Path,
    Proof,
}
