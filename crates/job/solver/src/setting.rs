//! The settings of planners. The descriptor of a planner lists those that it reads.

use super::{CellCounts, GridSpace};
use cplan_fields::FieldPlanner;
use cplan_model::Arm;
use cplan_model::space::Metric;
use cplan_planners::planner::{self, PathKind, RoadmapSearch, VisibilityGraph};
use cplan_planners::waves::{self, search};
use cplan_roadmaps::Prm;
use serde::ser::SerializeMap;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::ops::RangeInclusive;

/// Upper limit of margins, as a share of the arm's reach. The lower limit is 0.
pub const MAX_MARGIN: f64 = 0.1;

/// Default number of cells along an axis on the first level.
pub const DEFAULT_CELLS: usize = 256;

/// Allowed numbers of cells along an axis on the first level.
pub const ALLOWED_CELLS: RangeInclusive<usize> = 8..=2048;

/// Allowed numbers of samples on the first level.
pub const ALLOWED_SAMPLES: RangeInclusive<usize> = 1..=100_000;

/// Allowed numbers of neighbours to which each sample is connected.
pub const ALLOWED_NEIGHBORS: RangeInclusive<usize> = 1..=1000;

/// The length that planners minimise.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Criterion {
    /// Square root of the sum of squares; a radian counts like a metre.
    #[default]
    Euclidean,
    /// Square root of the sum of squares of the joints' values, multiplied by these positive weights.
    Weighted([f64; 2]),
    /// Travel time in seconds, if each joint, and the elbow's motor on the base, moves at top speed.
    Time,
    /// Square root of the sum of squares of the angles by which both motors turn, before gears.
    Motor,
}

impl Criterion {
    /// Returns the metric for an arm.
    pub fn metric(self, arm: &Arm) -> Metric {
        match self {
            Criterion::Euclidean => Metric::Euclidean,
            Criterion::Weighted(weights) => Metric::Weighted { weights },
            Criterion::Time => arm.time_metric(),
            // Unknown motors count as direct drives.
            Criterion::Motor => Metric::Motor { ratio: arm.motors.map_or(0.0, |motors| motors.ratio) },
        }
    }
}

/// Defines [`Setting`] and [`Settings`] from the table: each setting's name, its field, type and default, and its key
/// in JSON.
macro_rules! settings {
    ($($(#[$doc:meta])+ $setting:ident, $field:ident: $kind:ty = $default:expr, $key:literal;)+) => {
        /// The names of the settings.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Setting {
            $($(#[$doc])+ $setting),+
        }

        /// Values of all settings. Those that a planner does not read have their defaults.
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct Settings {
            $($(#[$doc])+ pub $field: $kind),+
        }

        impl Default for Settings {
            fn default() -> Self {
                Self { $($field: $default),+ }
            }
        }

        impl Setting {
            /// Returns the setting's key in JSON.
            pub fn key(self) -> &'static str {
                match self {
                    $(Self::$setting => $key),+
                }
            }
        }

        impl Settings {
            /// Writes the value of a setting.
            pub(super) fn write<M: SerializeMap>(&self, setting: Setting, into: &mut M) -> Result<(), M::Error> {
                match setting {
                    $(Setting::$setting => into.serialize_entry($key, &self.$field)),+
                }
            }

            /// Reads the value of a setting.
            pub(super) fn read(&mut self, setting: Setting, value: Value) -> serde_json::Result<()> {
                match setting {
                    $(Setting::$setting => self.$field = serde_json::from_value(value)?),+
                }
                Ok(())
            }
        }
    };
}

settings! {
    /// The length that the planner minimises.
    Criterion, criterion: Criterion = Criterion::Euclidean, "criterion";
    /// Largest gap: the path is refined until it is proven to be at most this share longer than the optimum. A larger gap permits
    /// faster motions. With `None`, the planner `shortest` uses 1e-4, and `visibility` accepts the gap of its first margin.
    Gap, gap: Option<f64> = None, "gap";
    /// Margin by which polygonal obstacles are grown on the first level, as a share of the arm's reach. Each finer
    /// level has a quarter of the margin before it. With 0, the first level has the exact polygons of a gantry. If a
    /// path touches them, it is planned again among grown polygons.
    Margin, margin: f64 = 1e-3, "margin";
    /// Search of a roadmap.
    Search, search: RoadmapSearch = RoadmapSearch::default(), "search";
    /// Set of arcs of the visibility graph.
    Graph, graph: VisibilityGraph = VisibilityGraph::default(), "graph";
    /// Kind of path.
    Path, path: PathKind = PathKind::Taut, "path";
    /// Number of random configurations. It doubles with each level.
    Samples, samples: usize = Prm::default().samples, "samples";
    /// Number of nearest samples to which each sample is connected.
    Nearest, nearest: usize = Prm::default().nearest, "nearest";
    /// Seed of the samples.
    Seed, seed: u64 = Prm::default().seed, "seed";
    /// Search of a grid.
    GridSearch, grid_search: planner::GridSearch = planner::GridSearch::default(), "search";
    /// Order in which A\* expands equally promising cells.
    Ties, ties: search::Ties = search::Ties::default(), "ties";
    /// True if the search of a grid begins at the start instead of the goals.
    Forward, forward: bool = false, "forward";
    /// Neighbours that a move on a grid can lead to.
    Neighborhood, neighborhood: waves::Neighborhood = waves::Neighborhood::default(), "neighborhood";
    /// Test of the cells of a grid.
    Space, space: GridSpace = GridSpace::default(), "space";
    /// Numbers of cells along the axes on the first level; finer levels double them. With `None`, the first level has
    /// about 256 x 256 cells, which are square in joint space.
    Cells, cells: Option<CellCounts> = None, "cells";
    /// The field that replaces the harmonic one. [`Settings::path`] also applies to it.
    Field, field: Option<FieldPlanner> = None, "field";
}
