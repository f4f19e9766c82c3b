//! The planners' data in a configuration space: roadmaps, cells, boxes and grids.

use super::Values;
use cplan_model::space::Configuration;
use cplan_planners::cspace::Proves;
use cplan_solver::Space;
#[cfg(test)]
use schemars::JsonSchema;
use serde::{Serialize, Serializer};
use std::collections::HashMap;

/// A graph of straight motions.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Roadmap {
    /// Vertices, each once.
    pub vertices: Vec<Values>,
    /// Indices of the two vertices of each edge.
    pub edges: Vec<[usize; 2]>,
    /// True if this is the whole graph, false if it is only the part that the search examined.
    pub whole: bool,
    /// Kind of a visibility graph: `reduced` to arcs that are tangent at both ends, which suffice for shortest paths,
    /// or `full`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub visibility: Option<&'static str>,
}

/// Cells of free space.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Cells {
    /// Corners of each cell, counter-clockwise.
    pub corners: Vec<Vec<Values>>,
    /// Indices of the cells that the path passes, in order.
    pub channel: Vec<usize>,
    /// Centres of area of the channel's cells, in order; only for trapezoids.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub centers: Vec<Values>,
    /// Middles of the portals between them, one fewer; only for trapezoids.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub middles: Vec<Values>,
}

/// Boxes: least and greatest values of each.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Boxes {
    /// Boxes without any collision.
    pub free: Vec<[Values; 2]>,
    /// Boxes in which every configuration collides.
    pub stuck: Vec<[Values; 2]>,
    /// Undecided boxes.
    pub mixed: Vec<[Values; 2]>,
}

/// Cells in rows of joint 2: cell `(i, j)` is number `i * shape[1] + j`, and its least values are `lower + (i, j) * size`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct FieldGrid {
    /// Number of cells along each axis.
    pub shape: [usize; 2],
    /// Least values of the first cell.
    pub lower: Values,
    /// Sides of a cell.
    pub size: Values,
    /// Guarantee of free and blocked for a cell.
    pub proves: Proves,
    /// The part of a free cell that is known to be free: `whole` or `center`.
    pub free: &'static str,
    /// One value per cell: 1 if it is blocked, otherwise 0.
    #[serde(serialize_with = "bits")]
    #[cfg_attr(test, schemars(with = "Vec<u8>"))]
    pub blocked: Vec<bool>,
    /// The meaning of `values`: `steps` to the goal, `steps_from_start`, `ln_potential` (the natural logarithm `ln(1 -
    /// p)` of a potential `p` that is 0 at the goals and 1 at obstacles), or `height` (descended by the path). Steps
    /// begin at 0, or at the number of `--labels-from`.
    pub quantity: &'static str,
    /// One value per cell; infinite (null in JSON) if there is no value. Empty if there is no field.
    #[cfg_attr(test, schemars(with = "Vec<Option<f64>>"))]
    pub values: Vec<f64>,
    /// Estimated cost from each cell to the end of the search, without obstacles. Only for A\* and greedy searches.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub heuristic: Vec<f64>,
}

fn bits<S: Serializer>(flags: &[bool], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(flags.iter().map(|&flag| u8::from(flag)))
}

impl Roadmap {
    /// Creates a roadmap. Its vertices are in the order in which the edges first name them.
    pub(super) fn of(edges: &[[Configuration; 2]], whole: bool, visibility: Option<&'static str>) -> Self {
        let mut numbers: HashMap<[u64; 2], usize> = HashMap::new();
        let mut vertices = Vec::new();
        let mut number = |q: &Configuration| {
            *numbers.entry([q[0].to_bits(), q[1].to_bits()]).or_insert_with(|| {
                vertices.push(Values::from(*q));
                vertices.len() - 1
            })
        };
        let edges = edges.iter().map(|edge| edge.each_ref().map(&mut number)).collect();
        Self { edges, vertices, whole, visibility }
    }
}

impl FieldGrid {
    /// Returns the planner's grid. It needs a value for each cell, or no values.
    pub(super) fn of(space: &Space, quantity: &'static str, values: &[f64]) -> Option<Self> {
        let Space::Grid(grid) = space else { return None };
        let has_values = values.len() == grid.blocked.len();
        Some(Self {
            shape: grid.cells,
            lower: grid.topology.ranges.map(|range| range.domain().0),
            size: grid.step(),
            proves: grid.proves,
            free: if grid.proves == Proves::Sampled { "center" } else { "whole" },
            blocked: grid.blocked.clone(),
            quantity,
            values: if has_values { values.to_vec() } else { Vec::new() },
            heuristic: Vec::new(),
        })
    }

    /// Adds the estimates of a search, one per cell.
    pub(super) fn with_estimates(self, heuristic: Vec<f64>) -> Self {
        Self { heuristic, ..self }
    }

    /// Adds a number to the labels of steps; other values stay the same.
    pub(super) fn shift_labels(&mut self, by: u32) {
        if self.quantity.starts_with("steps") {
            self.values.iter_mut().for_each(|value| *value += f64::from(by));
        }
    }
}
