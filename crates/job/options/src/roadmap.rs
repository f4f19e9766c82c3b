//! Options for roadmaps.

use super::names::{visibility_graphs, word};
use super::planner::to_i64_range;
use super::readers::readers;
use clap::Args;
use cplan_planners::planner::{GridSearch, RoadmapSearch, SearchOrder, VisibilityGraph};
use cplan_solver::{ALLOWED_NEIGHBORS, ALLOWED_SAMPLES, Method, Planner, Setting};
use std::sync::LazyLock;

static HEADING: LazyLock<String> =
    LazyLock::new(|| format!("Roadmaps (planners {})", readers(&[Setting::Search], ", ")));

/// Options for the construction and the search of roadmaps, except `--search`, which also applies to grids.
#[derive(Debug, Clone, PartialEq, Args)]
#[command(next_help_heading = HEADING.as_str())]
pub struct RoadmapArgs {
    /// Search from the goals to the start. Planner wavefront searches in this direction by default.
    #[arg(long)]
    pub backward: bool,
    /// Kind of visibility graph (planner visibility) [default: reduced].
    #[arg(long, value_parser = word(visibility_graphs()), value_name = "KIND")]
    pub graph: Option<VisibilityGraph>,
    /// Number of random free configurations (planner prm); doubled with each attempt [default: 500].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(to_i64_range(&ALLOWED_SAMPLES)))]
    pub samples: Option<u32>,
    /// Number of nearest samples to which each sample is joined, if the segment between them is free (planner prm)
    /// [default: 12].
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(to_i64_range(&ALLOWED_NEIGHBORS)))]
    pub nearest: Option<u32>,
    /// Seed of the samples (planner prm): the same seed gives the same roadmap [default: 1].
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
}

impl RoadmapArgs {
    /// Returns the search of a planner's roadmap; the default if it has none.
    ///
    /// # Errors
    /// A search that is possible only on grids.
    pub fn search(&self, planner: Method, search: Option<GridSearch>) -> Result<RoadmapSearch, String> {
        if !planner.reads(Setting::Search) {
            return Ok(RoadmapSearch::default());
        }
        let order = match search.unwrap_or(GridSearch::AStar) {
            search @ (GridSearch::Wave | GridSearch::IterativeDeepening) => {
                return Err(format!("--search {} needs a planner with a grid: {planner} has a roadmap", search.name()));
            }
            GridSearch::BreadthFirst => SearchOrder::BreadthFirst,
            GridSearch::DepthFirst => SearchOrder::DepthFirst,
            GridSearch::Dijkstra => SearchOrder::Dijkstra,
            GridSearch::AStar => SearchOrder::AStar,
            GridSearch::Greedy => SearchOrder::Greedy,
        };
        Ok(RoadmapSearch { order, backward: self.backward })
    }

    /// Sets those of these options that the planner reads.
    pub fn apply_to(&self, planner: Planner) -> Planner {
        planner.with(Setting::Graph, |settings| settings.graph = self.graph.unwrap_or_default()).with(
            Setting::Samples,
            |settings| {
                settings.samples = self.samples.map_or(settings.samples, |n| n as usize);
                settings.nearest = self.nearest.map_or(settings.nearest, |n| n as usize);
                settings.seed = self.seed.unwrap_or(settings.seed);
            },
        )
    }
}
