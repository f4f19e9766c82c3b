//! What a planner saw, for the layers of a page.

use super::flow;
use super::round::Grain;
use crate::draw::trace::{Slope, Waves};
use crate::planner::Trace;
use crate::space::{Configuration, Topology};
use serde::Serialize;

/// Levels of a wavefront are written as letters, one a block of cells: so many of them, and one for none.
const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
const NONE: char = '.';

/// Lines of one value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LevelView {
    /// 0 at the goal, 1 at the far end.
    part: f64,
    lines: Vec<Vec<f64>>,
}

/// A trace; lists of numbers hold one value after the other.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum TraceView {
    /// Arcs of the visibility graph: both ends of each.
    Roadmap { edges: Vec<f64>, whole: bool },
    /// Free stretches of slices: both ends of each.
    #[serde(rename = "rows")]
    Slices { free: Vec<f64> },
    /// Cells of the decomposition, and which of them make the channel.
    Channel { cells: Vec<Vec<f64>>, channel: Vec<usize> },
    /// Boxes of a subdivision: least and greatest values of each.
    Boxes { free: Vec<f64>, stuck: Vec<f64>, mixed: Vec<f64> },
    /// Distances to the goal in columns of joint 1, each from the least value of joint 2 on.
    Wavefront { blocks: [usize; 2], extent: [f64; 2], levels: String, farthest: u32 },
    /// A field: its equipotentials, and lines of steepest ascent.
    Field {
        levels: Vec<LevelView>,
        flow: Vec<Vec<f64>>,
        /// Whether values are logarithms.
        logarithmic: bool,
        /// At the far end, and at the goal.
        span: [f64; 2],
    },
}

impl TraceView {
    /// The trace; none where there is nothing to show.
    pub fn new(trace: &Trace, topology: &Topology, grain: Grain) -> Option<Self> {
        let boxes = |boxes: &[[Configuration; 2]]| grain.configurations(boxes.iter().flatten());
        Some(match trace {
            Trace::Roadmap { edges, whole } => {
                Self::Roadmap { edges: grain.configurations(edges.iter().flatten()), whole: *whole }
            }
            Trace::Slices { free } => Self::Slices { free: boxes(free) },
            Trace::Channel { cells, channel } => Self::Channel {
                cells: cells.iter().map(|cell| grain.configurations(cell)).collect(),
                channel: channel.clone(),
            },
            Trace::Boxes { free, stuck, mixed } => {
                Self::Boxes { free: boxes(free), stuck: boxes(stuck), mixed: boxes(mixed) }
            }
            Trace::Wavefront { cells, labels } => {
                let Waves { blocks, extent, parts, farthest } = Waves::new(*cells, labels)?;
                let letter = |part: f64| char::from(LETTERS[(part * (LETTERS.len() - 1) as f64).round() as usize]);
                let levels = parts.into_iter().map(|part| part.map_or(NONE, letter)).collect();
                Self::Wavefront { blocks, extent: extent.map(|x| grain.number(x)), levels, farthest }
            }
            Trace::Field { .. } | Trace::Harmonic { .. } | Trace::Potential { .. } => {
                let slope = Slope::new(trace, topology)?;
                let flat = |line: &Vec<[f64; 2]>| {
                    line.iter().flat_map(|&q| grain.configuration(Configuration::from(q))).collect()
                };
                let levels = slope.equipotentials().map(|(part, lines)| LevelView {
                    part: grain.number(part),
                    lines: lines.iter().map(flat).collect(),
                });
                let logarithmic = !matches!(trace, Trace::Potential { .. });
                let sign = if logarithmic { 1.0 } else { -1.0 };
                Self::Field {
                    levels: levels.collect(),
                    flow: flow::lines(&slope.samples, topology).iter().map(flat).collect(),
                    logarithmic,
                    span: [slope.span.0, slope.span.1].map(|value| grain.number(sign * value)),
                }
            }
        })
    }
}
