//! Searches of a grid: the wavefront, which labels cells with their distance from the goal, and classical searches.

use super::attach::JoinedQuery;
use super::{PathKind, Planner, Proposal, Query, Run, Size, Trace, grid_path};
use crate::cspace::Grid;
use crate::waves::search::{Estimates, Order, Search, Ties};
use crate::waves::{FreeCells, Neighborhood, StepLabels, UNREACHED};
use serde::{Deserialize, Serialize};
use std::fmt;

/// The search method on a grid. All methods begin at the goals; those other than the wave can also begin at the start.
/// The label of a cell counts the moves to the cells where the search began.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GridSearch {
    /// Labels all cells connected with the goals, and then descends. Finds a path with the fewest moves, where diagonal
    /// moves count as one.
    #[default]
    Wave,
    /// Breadth-first search, until it meets the start. Finds a path with the fewest moves.
    BreadthFirst,
    /// Depth-first search. Finds any path.
    DepthFirst,
    /// Expands the cell of least cost first. A diagonal move costs the square root of 2 straight ones. Finds a path of
    /// least cost.
    Dijkstra,
    /// Expands the cell with the least sum of cost and distance from the target first. Finds a path of least cost.
    AStar,
    /// Expands the cell nearest to the target first. Finds some path fast.
    Greedy,
    /// Depth-first within a limit of moves, which grows until the search meets its target. Finds a path with the
    /// fewest moves.
    IterativeDeepening,
}

impl GridSearch {
    /// All methods, in the order of the command line's help.
    pub const ALL: [Self; 7] = [
        Self::Wave,
        Self::BreadthFirst,
        Self::DepthFirst,
        Self::Dijkstra,
        Self::AStar,
        Self::Greedy,
        Self::IterativeDeepening,
    ];

    /// Returns the name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wave => "wave",
            Self::BreadthFirst => "bfs",
            Self::DepthFirst => "dfs",
            Self::Dijkstra => "dijkstra",
            Self::AStar => "astar",
            Self::Greedy => "greedy",
            Self::IterativeDeepening => "deepening",
        }
    }

    /// Returns the order in which cells are expanded. `None` for the wave, which labels whole levels at once.
    pub fn order(self, ties: Ties) -> Option<Order> {
        match self {
            Self::Wave => None,
            Self::BreadthFirst => Some(Order::BreadthFirst),
            Self::DepthFirst => Some(Order::DepthFirst),
            Self::Dijkstra => Some(Order::Dijkstra),
            Self::AStar => Some(Order::AStar(ties)),
            Self::Greedy => Some(Order::Greedy),
            Self::IterativeDeepening => Some(Order::IterativeDeepening),
        }
    }
}

impl fmt::Display for GridSearch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Labels cells with the number of moves to the nearest goal, then descends the labels from the start to a goal.
/// Moves lead to cells that share a side, or also to those that share a corner. With the default settings the result
/// is a path of cells that is shortest in the `L1` metric (Latombe 1991, the navigation function in that metric).
///
/// Linear in the number of cells. Dijkstra and A\* take an additional logarithmic factor for the cells that they visit,
/// and iterative deepening takes an additional factor, the number of moves. Every search is complete on the grid: if it
/// finds no path, none exists between the cells. A diagonal move is allowed only if both cells beside it are free, so
/// eight neighbours connect no more cells than four.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wavefront {
    /// The search method for cells.
    pub search: GridSearch,
    /// The rule by which A\* chooses among cells with equal estimates.
    pub ties: Ties,
    /// True to search from the start to a goal. False to search from the goals to the start. Ignored by the wave.
    pub forward: bool,
    /// The neighbours to which a move may lead.
    pub neighborhood: Neighborhood,
    /// The kind of path. [`PathKind::Own`] leads from cell to cell like a staircase.
    pub path: PathKind,
}

impl Default for Wavefront {
    fn default() -> Self {
        Self {
            search: GridSearch::Wave,
            ties: Ties::default(),
            forward: false,
            neighborhood: Neighborhood::Four,
            path: PathKind::Taut,
        }
    }
}

impl Planner for Wavefront {
    const NAME: &'static str = "wavefront";
    type Space = Grid;
    type Map = FreeCells;

    fn build(&self, space: &Grid) -> FreeCells {
        FreeCells::new(space)
    }

    fn query(&self, space: &Grid, map: &FreeCells, query: &Query) -> Run {
        let joined = match JoinedQuery::new(space, query) {
            Ok(joined) => joined,
            Err(reason) => {
                let (labels, expanded) = (vec![UNREACHED; space.blocked.len()], Vec::new());
                let (cells, forward) = (space.cells, self.forward);
                let trace = Trace::Wavefront { cells, labels, expanded, forward, estimates: None };
                return Run::new(Proposal::GaveUp(reason), trace, Size::Grid { cells: 0, sweeps: 0 });
            }
        };
        let (cells, trace, size) = self.cells(map, &joined);
        let path = cells.and_then(|cells| grid_path::path(space, query, &joined, &cells, self.path));
        Run::new(path.map_or(Proposal::NoPath, Proposal::Found), trace, size)
    }
}

impl Wavefront {
    /// Returns the cells of a path, the record of the search, and the number of visited cells. The path begins at the
    /// nearest cell of the start that is connected with a goal. `None` without such a cell.
    fn cells(&self, map: &FreeCells, joined: &JoinedQuery) -> (Option<Vec<usize>>, Trace, Size) {
        let sources = joined.sources();
        let Some(order) = self.search.order(self.ties) else {
            let wave = StepLabels::new(map, &sources, self.neighborhood);
            let cells = joined.start.cells.iter().find_map(|&cell| wave.descend(map, cell));
            let size = Size::Grid { cells: wave.reached(), sweeps: wave.levels() };
            let (labels, expanded) = (wave.into_labels(), Vec::new());
            let trace = Trace::Wavefront { cells: map.cells(), labels, expanded, forward: false, estimates: None };
            return (cells, trace, size);
        };
        let (cells, search) = if self.forward {
            self.search_forward(map, joined, order)
        } else {
            self.search_backward(map, joined, order)
        };
        let labeled = search.labeled;
        let size = match self.search {
            GridSearch::IterativeDeepening => {
                Size::Deepening { rounds: search.rounds, expansions: search.expansions, labeled }
            }
            _ => Size::Search { expanded: search.expanded.len(), labeled },
        };
        let (labels, expanded) = (search.labels(), search.expanded);
        let targets = if self.forward { sources } else { joined.start.cells[..1].to_vec() };
        let estimates = order.estimates().then_some(Estimates { targets, neighborhood: self.neighborhood });
        let trace = Trace::Wavefront { cells: map.cells(), labels, expanded, forward: self.forward, estimates };
        (cells, trace, size)
    }

    /// Returns the cells of a path by a search that begins at the goals.
    fn search_backward(&self, map: &FreeCells, joined: &JoinedQuery, order: Order) -> (Option<Vec<usize>>, Search) {
        // A search that does not meet its target has labelled all cells that are connected with a goal. These may
        // include another cell of the start.
        let search = Search::new(map, self.neighborhood, order, &joined.sources(), joined.start.cells[0]);
        (joined.start.cells.iter().find_map(|&cell| search.path_back(cell)), search)
    }

    /// Returns the cells of a path by a search that begins at the nearest cell of the start that is connected with a
    /// goal. If there is none, returns the search from the nearest cell.
    fn search_forward(&self, map: &FreeCells, joined: &JoinedQuery, order: Order) -> (Option<Vec<usize>>, Search) {
        let goals = joined.sources();
        let from = |&cell: &usize| Search::to_any(map, self.neighborhood, order, &[cell], &goals);
        let first = from(&joined.start.cells[0]);
        let others = joined.start.cells[1..].iter().filter(|&&cell| first.cost(cell).is_none());
        let search = match first.met {
            None => others.map(from).find(|search| search.met.is_some()).unwrap_or(first),
            Some(_) => first,
        };
        let cells = search.met.and_then(|goal| search.path_back(goal));
        (cells.map(|cells| cells.into_iter().rev().collect()), search)
    }
}
