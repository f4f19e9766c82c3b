//! The planner's trace.

use super::flow;
use super::numbers::{Chain, RoundingSteps, number};
use super::slope::Slope;
use super::waves::Waves;
use cplan_model::space::{Configuration, Topology};
use cplan_planners::planner::{FieldQuantity, Trace, VisibilityGraph};
use serde::Serialize;

/// Lines on which a field has one value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LevelView {
    /// Position of the value between that at the goal (0) and that at the far end (1).
    pub part: f64,
    pub lines: Vec<Chain>,
}

/// Scale of colours: its title, and the values at its dark end and at its light end.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScaleView {
    pub title: &'static str,
    pub ends: [String; 2],
    /// True if the colours fill surfaces that have lines on them. Such colours are paler, so that the lines stay legible.
    pub soft: bool,
}

/// A planner's trace.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum TraceView {
    /// Arcs of the visibility graph: both ends of each.
    Roadmap { edges: Chain, whole: bool },
    /// Free stretches of slices: both ends of each.
    #[serde(rename = "rows")]
    Slices { free: Chain },
    /// Cells of the decomposition, and the cells of the channel.
    Channel {
        cells: Vec<Chain>,
        channel: Vec<usize>,
        /// Centres of the channel's cells, and middles of the portals between them.
        #[serde(skip_serializing_if = "Chain::is_empty")]
        centers: Chain,
        #[serde(skip_serializing_if = "Chain::is_empty")]
        middles: Chain,
        /// Places that the search expanded, in order.
        #[serde(skip_serializing_if = "Chain::is_empty")]
        expanded: Chain,
        /// Position of the sweep line (a value of joint 1) during the replay.
        #[serde(skip)]
        sweep: Option<f64>,
    },
    /// A roadmap: both ends of each edge, and the places that the search expanded, in order.
    Roads {
        edges: Chain,
        expanded: Chain,
        /// Kind of the visibility graph; `None` for other roadmaps.
        #[serde(skip_serializing_if = "Option::is_none")]
        visibility: Option<&'static str>,
    },
    /// Boxes of a subdivision: least and greatest values of each.
    Boxes {
        free: Chain,
        stuck: Chain,
        mixed: Chain,
        /// During the replay, the boxes that are not decided yet. They are drawn without sides.
        #[serde(skip)]
        rest: Chain,
    },
    /// Distances to the goal.
    Wavefront(Waves),
    /// A field, with equipotentials and lines of steepest ascent.
    Field {
        levels: Vec<LevelView>,
        flow: Vec<Chain>,
        /// True if values are logarithms.
        logarithmic: bool,
        /// Values at the far end and at the goal.
        span: [f64; 2],
        /// Values after the current sweep, during the replay.
        #[serde(skip)]
        values: Option<Waves>,
    },
}

impl TraceView {
    /// Returns the scale of the colours. `None` if there are no colours.
    pub fn scale(&self) -> Option<ScaleView> {
        let whole = |value: f64| format!("{value:.0}").replace('-', "\u{2212}").replace("\u{2212}0", "0");
        let (title, ends, soft) = match self {
            Self::Wavefront(waves) if waves.levels().any(|level| level.is_some()) => {
                let title = if waves.from_start { "steps from the start" } else { "steps to the goal" };
                (title, [waves.farthest.to_string(), "0".to_owned()], true)
            }
            Self::Field { logarithmic: true, span, .. } => ("ln of the potential", span.map(whole), false),
            Self::Field { span, .. } => ("potential", span.map(|value| format!("{value:.2}")), false),
            _ => return None,
        };
        Some(ScaleView { title, ends, soft })
    }

    /// Adds a number to the labels of a wavefront.
    pub fn shift_labels(&mut self, by: u32) {
        if let Self::Wavefront(waves) = self {
            waves.numbers.iter_mut().flatten().for_each(|label| *label = label.saturating_add(by));
        }
    }

    /// Returns the trace for pictures and pages. `None` if there is nothing to show.
    pub fn new(trace: &Trace, topology: &Topology, grain: RoundingSteps) -> Option<Self> {
        let pairs = |pairs: &[[Configuration; 2]]| grain.configurations(pairs.iter().flatten());
        Some(match trace {
            Trace::Roadmap { edges, whole } => Self::Roadmap { edges: pairs(edges), whole: *whole },
            // If no path was found, there are no slices to show.
            Trace::Slices { free } if free.is_empty() => return None,
            Trace::Slices { free } => Self::Slices { free: pairs(free) },
            Trace::Channel { cells, channel, points, expanded, .. } => Self::Channel {
                cells: cells.iter().map(|cell| grain.configurations(cell)).collect(),
                channel: channel.clone(),
                centers: grain.configurations(&points.centers),
                middles: grain.configurations(&points.middles),
                expanded: grain.configurations(expanded),
                sweep: None,
            },
            Trace::Roads { edges, expanded, kind } => Self::Roads {
                edges: pairs(edges),
                expanded: grain.configurations(expanded),
                visibility: kind.visibility().map(VisibilityGraph::name),
            },
            Trace::Boxes { free, stuck, mixed } => {
                Self::Boxes { free: pairs(free), stuck: pairs(stuck), mixed: pairs(mixed), rest: Chain::default() }
            }
            Trace::Wavefront { cells, labels, expanded, forward, .. } => {
                let mut waves = Waves::new(*cells, labels, expanded)?;
                waves.from_start = *forward;
                Self::Wavefront(waves)
            }
            Trace::Field { quantity, .. } => {
                let slope = Slope::new(trace, topology)?;
                let chain =
                    |line: &Vec<[f64; 2]>| Chain(line.iter().map(|&q| grain.configuration(q.into()).into()).collect());
                let levels = slope
                    .equipotentials()
                    .map(|(part, lines)| LevelView { part: number(part), lines: lines.iter().map(chain).collect() });
                let logarithmic = *quantity != FieldQuantity::Height;
                let sign = if logarithmic { 1.0 } else { -1.0 };
                Self::Field {
                    levels: levels.collect(),
                    flow: flow::lines(&slope.samples, topology).iter().map(chain).collect(),
                    logarithmic,
                    span: [slope.span.0, slope.span.1].map(|value| number(sign * value)),
                    values: None,
                }
            }
        })
    }
}
