//! Channels of cells, found by a graph search over the cells of a decomposition with costs on the portals.

use super::decomposition::{CellPortal, Decomposition};
use super::roadmap::{RoadmapSearch, SearchProblem, SearchResult, search};
use super::terminals::Terminals;
use cplan_geometry::Point;
use cplan_model::space::{Configuration, Measure, Metric, Segment};
use petgraph::graph::{NodeIndex, UnGraph};
use petgraph::visit::EdgeRef;

/// A sequence of cells to a goal, with the portals between consecutive cells.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Channel {
    pub start: Point,
    /// Alternative goals, all in the last cell.
    pub goals: Segment,
    pub cells: Vec<usize>,
    pub portals: Vec<usize>,
}

/// The graph of cells and portals, with the costs of passages.
#[derive(Debug, Clone)]
pub(super) struct Adjacency {
    /// Nodes are cells, edges are portals.
    cells: UnGraph<PassageEnd, Passage>,
    /// Centres of the cells.
    pub centers: Vec<Point>,
    /// Middles of the portals.
    pub middles: Vec<Point>,
}

#[derive(Debug, Clone, Copy)]
enum PassageEnd {
    /// The start, or the centre of a cell.
    At(Point),
    /// Alternative goals. The nearest one counts.
    Any(Segment),
}

impl PassageEnd {
    /// Returns the point of this end nearest to `p`.
    fn nearest(self, p: Point) -> Point {
        match self {
            PassageEnd::At(point) => point,
            PassageEnd::Any(goals) => goals.nearest(Measure::from(Metric::Euclidean), p),
        }
    }
}

/// A connection between two ends, through a portal or within a cell.
#[derive(Debug, Clone, Copy)]
struct Passage {
    /// Index of the portal; `None` for a connection within a cell.
    portal: Option<usize>,
    /// Length of the path through the portal's middle.
    cost: f64,
}

impl Adjacency {
    /// Builds the graph in linear time.
    pub fn new(decomposition: &Decomposition, centers: Vec<Point>) -> Self {
        let middles = decomposition.portals.iter().map(|portal| (portal.low + portal.high) * 0.5).collect();
        let cells = UnGraph::with_capacity(centers.len(), decomposition.portals.len());
        let mut adjacency = Self { cells, centers, middles };
        for &center in &adjacency.centers {
            adjacency.cells.add_node(PassageEnd::At(center));
        }
        for (number, portal) in decomposition.portals.iter().enumerate() {
            let [left, right] = portal.cells;
            let passage = adjacency
                .passage([adjacency.centers[left], adjacency.centers[right]].map(PassageEnd::At), Some(number));
            adjacency.cells.add_edge(NodeIndex::new(left), NodeIndex::new(right), passage);
        }
        adjacency
    }

    /// Returns the passage between two ends, through a portal or within a cell.
    fn passage(&self, [from, to]: [PassageEnd; 2], portal: Option<usize>) -> Passage {
        let from = from.nearest(Point::zeros());
        let last = portal.map_or(from, |portal| self.middles[portal]);
        Passage { portal, cost: (last - from).norm() + (to.nearest(last) - last).norm() }
    }

    /// Returns a channel from the start to any goal, and the centres of the cells that the search expanded, in order.
    /// `start_cells` are the cells that contain the start.
    ///
    /// The cost of a passage between two cells is the distance between their centres through the portal's middle. In
    /// the first and the last cell, the start and the nearest goal replace the centre. The default search finds the
    /// cheapest channel, in `O(n log n)` for `n` cells.
    pub fn channel(
        &self,
        portals: &[CellPortal],
        terminals: &Terminals,
        start_cells: &[usize],
        how: RoadmapSearch,
    ) -> (Option<Channel>, Vec<Configuration>) {
        // The start and the goals are additional nodes, joined through the portals of the cells that contain them.
        let mut graph = self.cells.clone();
        let at_start = PassageEnd::At(terminals.start);
        let start = graph.add_node(at_start);
        for &cell in start_cells {
            for portal in self.cells.edges(NodeIndex::new(cell)) {
                let passage = self.passage([at_start, graph[portal.target()]], portal.weight().portal);
                graph.add_edge(start, portal.target(), passage);
            }
        }
        let is_left = |cell: NodeIndex| start_cells.contains(&cell.index());
        for &(cell, goals) in &terminals.parts {
            let any = PassageEnd::Any(goals);
            let (cell, goal) = (NodeIndex::new(cell as usize), graph.add_node(any));
            for portal in self.cells.edges(cell) {
                let number = portal.weight().portal;
                graph.add_edge(portal.target(), goal, self.passage([graph[portal.target()], any], number));
                if is_left(portal.target()) {
                    graph.add_edge(start, goal, self.passage([at_start, any], number));
                }
            }
            if is_left(cell) {
                graph.add_edge(start, goal, self.passage([at_start, any], None));
            }
        }
        let euclid = Measure::from(Metric::Euclidean);
        let question = SearchProblem {
            start,
            is_goal: |node: NodeIndex| node > start,
            cost: |passage: &Passage| passage.cost,
            ahead: |node: NodeIndex| terminals.distance(euclid, graph[node].nearest(terminals.start)),
            behind: |node: NodeIndex| (graph[node].nearest(terminals.start) - terminals.start).norm(),
        };
        let SearchResult { path, expanded } = search(&graph, how, &question);
        let expanded = expanded.into_iter().map(|node| graph[node].nearest(terminals.start)).collect();
        (path.map(|places| self.channel_along_route(portals, terminals, &graph, start, &places)), expanded)
    }

    /// Returns the channel for the route that the search found.
    fn channel_along_route(
        &self,
        portals: &[CellPortal],
        terminals: &Terminals,
        graph: &UnGraph<PassageEnd, Passage>,
        start: NodeIndex,
        places: &[NodeIndex],
    ) -> Channel {
        let cheapest = |pair: &[NodeIndex]| {
            let between = graph.edges_connecting(pair[0], pair[1]).map(|portal| *portal.weight());
            between.min_by(|a, b| a.cost.total_cmp(&b.cost))?.portal
        };
        let passed: Vec<usize> = places.windows(2).filter_map(cheapest).collect();
        let (last, goals) = terminals.parts[places[places.len() - 1].index() - start.index() - 1];
        let mut cells = vec![last as usize];
        for &portal in passed.iter().rev() {
            let [left, right] = portals[portal].cells;
            cells.push(if left == cells[cells.len() - 1] { right } else { left });
        }
        cells.reverse();
        Channel { start: terminals.start, goals, cells, portals: passed }
    }
}
