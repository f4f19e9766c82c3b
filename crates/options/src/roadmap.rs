//! Words for roadmaps.

use super::names::word;
use super::planner::whole;
use clap::Args;
use cplan_core::planner::{GridSearch, RoadmapSearch, SearchOrder, VisibilityGraph};
use cplan_engine::{Method, NEAREST, Planner, SAMPLES};
use cplan_roadmaps::Prm;

/// How roadmaps are made and searched; `--search` stands with the paths.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Roadmaps (planners visibility, trapezoid, triangles, voronoi, prm)")]
pub struct RoadmapArgs {
    /// Search from the goals to the start, which planner wavefront does anyway.
    #[arg(long)]
    pub backward: bool,
    /// Which visibility graph (planner visibility) [default: reduced].
    #[arg(long, value_parser = word::<VisibilityGraph>(), value_name = "KIND")]
    pub graph: Option<VisibilityGraph>,
    /// Random free configurations (planner prm), twice as many with each attempt [default: 500].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(whole(&SAMPLES)))]
    pub samples: Option<u32>,
    /// To how many of the nearest samples each is joined, if it sees them (planner prm) [default: 12].
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(whole(&NEAREST)))]
    pub nearest: Option<u32>,
    /// What samples follow from (planner prm): the same seed gives the same roadmap [default: 1].
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
}

impl RoadmapArgs {
    /// How a planner searches its roadmap; as usual, if it has none.
    ///
    /// # Errors
    /// What the planner does not have, in words.
    pub fn search(&self, planner: Method, search: Option<GridSearch>) -> Result<RoadmapSearch, String> {
        let given = [
            ("--samples", self.samples.is_some()),
            ("--nearest", self.nearest.is_some()),
            ("--seed", self.seed.is_some()),
        ];
        if let Some((name, _)) = given.iter().find(|option| option.1 && planner != Method::Prm) {
            return Err(format!("{name} needs --planner prm: {planner} draws no samples"));
        }
        if self.graph.is_some() && planner != Method::Visibility {
            return Err(format!("--graph needs --planner visibility: {planner} searches no visibility graph"));
        }
        if !planner.has_roadmap() {
            let needs = "--backward needs --planner visibility, trapezoid, triangles, voronoi, prm or wavefront";
            return if self.backward && planner != Method::Wavefront {
                Err(format!("{needs}: {planner} has no roadmap"))
            } else {
                Ok(RoadmapSearch::default())
            };
        }
        let order = match search.unwrap_or(GridSearch::AStar) {
            GridSearch::Wave => {
                return Err(format!("--search wave labels the cells of a grid: {planner} has a roadmap"));
            }
            GridSearch::IterativeDeepening => {
                return Err(format!("--search deepening goes over the cells of a grid: {planner} has a roadmap"));
            }
            GridSearch::BreadthFirst => SearchOrder::BreadthFirst,
            GridSearch::DepthFirst => SearchOrder::DepthFirst,
            GridSearch::Dijkstra => SearchOrder::Dijkstra,
            GridSearch::AStar => SearchOrder::AStar,
            GridSearch::Greedy => SearchOrder::Greedy,
        };
        Ok(RoadmapSearch { order, backward: self.backward })
    }

    /// The planner with what of these options is its.
    pub fn put_into(&self, mut planner: Planner) -> Planner {
        if let Planner::Visibility { graph, .. } = &mut planner {
            *graph = self.graph.unwrap_or_default();
        }
        if let Planner::Prm { samples, nearest, seed, .. } = &mut planner {
            let usual = Prm::default();
            *samples = self.samples.map_or(usual.samples, |n| n as usize);
            *nearest = self.nearest.map_or(usual.nearest, |n| n as usize);
            *seed = self.seed.unwrap_or(usual.seed);
        }
        planner
    }
}
