//! The settings of planners. Each planner reads some of them, as its descriptor says.

use super::{CellCounts, GridSpace};
use cplan_core::model::Arm;
use cplan_core::planner::{self, PathKind, RoadmapSearch, VisibilityGraph};
use cplan_core::space::Metric;
use cplan_core::waves::{self, search};
use cplan_fields::FieldPlanner;
use cplan_roadmaps::Prm;
use serde::ser::SerializeMap;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::ops::RangeInclusive;

/// Upper limit of margins, a share of the arm's reach; the lower one is 0.
pub const MOST_MARGIN: f64 = 0.1;

/// The first number of cells along an axis, if none is given.
pub const FIRST_CELLS: usize = 256;

/// Numbers of cells along an axis to begin with.
pub const CELLS: RangeInclusive<usize> = 8..=2048;

/// Numbers of samples to begin with.
pub const SAMPLES: RangeInclusive<usize> = 1..=100_000;

/// Numbers of samples to which each is joined.
pub const NEAREST: RangeInclusive<usize> = 1..=1000;

/// What makes a path short.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Criterion {
    /// Square root of the sum of squares, radians and metres as they come.
    #[default]
    Euclidean,
    /// The same with the joints' values multiplied by these weights, both positive.
    Weighted([f64; 2]),
    /// Seconds at the joints' top speeds.
    Time,
}

impl Criterion {
    /// The metric for an arm.
    #[must_use]
    pub fn metric(self, arm: &Arm) -> Metric {
        match self {
            Criterion::Euclidean => Metric::Euclidean,
            Criterion::Weighted(weights) => Metric::Weighted { weights },
            Criterion::Time => Metric::Time { speeds: arm.joints.each_ref().map(|joint| joint.velocity) },
        }
    }
}

/// Makes [`Setting`] and [`Settings`] of the table: the setting's name, its field, type and default, and its key in JSON.
macro_rules! settings {
    ($($(#[$doc:meta])+ $setting:ident, $field:ident: $kind:ty = $default:expr, $key:literal;)+) => {
        /// The name of a setting.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Setting {
            $($(#[$doc])+ $setting),+
        }

        /// Values of all settings. A planner has the defaults of those that it does not read.
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
            /// Returns its key in JSON.
            #[must_use]
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
    /// What makes a path short.
    Criterion, criterion: Criterion = Criterion::Euclidean, "criterion";
    /// Refine until the path is proven to be longer than the optimum by no more than this share of it. A larger one leaves room in
    /// which motions are faster. None for 1e-4 of the planner `shortest`, and for what the first margin gives of `visibility`.
    Gap, gap: Option<f64> = None, "gap";
    /// First margin by which polygonal obstacles are grown, as a share of the arm's reach; quartered where needed. 0 for the exact
    /// polygons of a gantry, which have the first attempt; paths that touch them are sought among grown ones.
    Margin, margin: f64 = 1e-3, "margin";
    /// How a roadmap is searched.
    Search, search: RoadmapSearch = RoadmapSearch::default(), "search";
    /// Which arcs the visibility graph has.
    Graph, graph: VisibilityGraph = VisibilityGraph::default(), "graph";
    /// Which path.
    Path, path: PathKind = PathKind::Taut, "path";
    /// Number of random configurations, twice as many with each level.
    Samples, samples: usize = Prm::default().samples, "samples";
    /// To how many of the nearest each sample is joined.
    Nearest, nearest: usize = Prm::default().nearest, "nearest";
    /// Seed of the samples.
    Seed, seed: u64 = Prm::default().seed, "seed";
    /// How a grid is searched.
    GridSearch, grid_search: planner::GridSearch = planner::GridSearch::default(), "search";
    /// Which of equally promising cells A\* expands.
    Ties, ties: search::Ties = search::Ties::default(), "ties";
    /// Whether the search of a grid begins at the start, not at the goals.
    Forward, forward: bool = false, "forward";
    /// Where a move on a grid can lead.
    Neighborhood, neighborhood: waves::Neighborhood = waves::Neighborhood::default(), "neighborhood";
    /// How the cells of a grid are decided.
    Space, space: GridSpace = GridSpace::default(), "space";
    /// First numbers of cells along the axes; doubled where needed. None for 256 x 256 cells' worth of cells that are square in
    /// joint space.
    Cells, cells: Option<CellCounts> = None, "cells";
    /// The field in place of the harmonic one; [`Settings::path`] stands for its path.
    Field, field: Option<FieldPlanner> = None, "field";
}
