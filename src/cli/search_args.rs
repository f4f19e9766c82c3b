//! The command line's words for the search of a grid.

use crate::engine::Method;
use crate::field::Neighborhood;
use crate::planner::{GridSearch, Wavefront};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};

/// How the wavefront planner searches its grid.
#[derive(Debug, Clone, Args)]
pub struct SearchArgs {
    /// How the grid is searched, from the goal (planner wavefront). [default: wave]
    #[arg(long, value_enum, value_name = "NAME")]
    pub search: Option<GridSearch>,
    /// Cells that a move can lead to: 4 share a side, 8 a corner too, though no move cuts the corner of a blocked cell
    /// (planner wavefront). wave and bfs count moves; dijkstra and astar take a diagonal one for 1.414. [default: 4]
    #[arg(long, value_name = "N", value_parser = neighbors())]
    pub neighbors: Option<Neighborhood>,
}

impl SearchArgs {
    /// The same for the planner.
    pub fn wavefront(&self) -> Wavefront {
        Wavefront {
            search: self.search.unwrap_or_default(),
            neighborhood: self.neighbors.unwrap_or_default(),
            ..Wavefront::default()
        }
    }

    /// What of it the planner cannot do, if there is something.
    pub fn conflict(&self, planner: Method) -> Option<String> {
        let asked = if self.search.is_some() { "--search" } else { "--neighbors" };
        let is_asked = self.search.is_some() || self.neighbors.is_some();
        (is_asked && planner != Method::Wavefront)
            .then(|| format!("{asked} needs --planner wavefront: {planner} searches no grid from cell to cell"))
    }
}

fn neighbors() -> impl TypedValueParser<Value = Neighborhood> {
    PossibleValuesParser::new(["4", "8"])
        .map(|count| if count == "4" { Neighborhood::Four } else { Neighborhood::Eight })
}
