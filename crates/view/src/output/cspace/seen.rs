//! What planners see in a configuration space: roadmaps, cells, boxes and grids.

use super::Values;
use cplan_core::cspace::Proves;
use cplan_core::space::Configuration;
use cplan_engine::Space;
use schemars::JsonSchema;
use serde::{Serialize, Serializer};
use std::collections::HashMap;

/// A graph of straight motions.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Roadmap {
    /// Each once.
    pub vertices: Vec<Values>,
    /// Numbers of two vertices.
    pub edges: Vec<[usize; 2]>,
    /// Whether it is all of the graph, or what of it was looked at.
    pub whole: bool,
    /// Of a visibility graph: `reduced` to arcs that are tangent at both ends, which suffice for shortest paths, or `full`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub visibility: Option<&'static str>,
}

/// Cells of free space.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Cells {
    /// Corners of each, counter-clockwise.
    pub corners: Vec<Vec<Values>>,
    /// Numbers of those that the path passes, in order.
    pub channel: Vec<usize>,
    /// Centres of area of the channel's cells, in order; of trapezoids.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub centers: Vec<Values>,
    /// Middles of the doors between them, one less; of trapezoids.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub middles: Vec<Values>,
}

/// Boxes: least and greatest values of each.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Boxes {
    /// No collision anywhere in them.
    pub free: Vec<[Values; 2]>,
    /// Collision everywhere in them.
    pub stuck: Vec<[Values; 2]>,
    /// Neither is proven.
    pub mixed: Vec<[Values; 2]>,
}

/// Cells in rows of joint 2: cell `(i, j)` is number `i * shape[1] + j`, and its least values are `lower + (i, j) * size`.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct FieldGrid {
    /// Number of cells along each axis.
    pub shape: [usize; 2],
    /// Least values of the first cell.
    pub lower: Values,
    /// Sides of a cell.
    pub size: Values,
    /// What free and blocked prove of a cell.
    pub proves: Proves,
    /// One a cell: 1 where it is blocked, else 0.
    #[serde(serialize_with = "bits")]
    #[schemars(with = "Vec<u8>")]
    pub blocked: Vec<bool>,
    /// What `values` are: `steps` to the goal, `steps_from_start`, `ln_potential` (natural logarithm, 0 at the goal, the lower
    /// the farther), or `height` (descended by the path).
    pub quantity: &'static str,
    /// One a cell; infinite, in JSON null, where there is none. Empty where there is no field.
    #[schemars(with = "Vec<Option<f64>>")]
    pub values: Vec<f64>,
}

fn bits<S: Serializer>(flags: &[bool], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(flags.iter().map(|&flag| u8::from(flag)))
}

impl Roadmap {
    /// Vertices in the order in which edges name them first.
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
    /// The planner's grid with values for all of its cells, or for none.
    pub(super) fn of(space: &Space, quantity: &'static str, values: &[f64]) -> Option<Self> {
        let Space::Grid(grid) = space else { return None };
        let has_values = values.len() == grid.blocked.len();
        Some(Self {
            shape: grid.cells,
            lower: grid.topology.ranges.map(|range| range.domain().0),
            size: grid.step(),
            proves: grid.proves,
            blocked: grid.blocked.clone(),
            quantity,
            values: if has_values { values.to_vec() } else { Vec::new() },
        })
    }
}
