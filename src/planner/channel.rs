//! A* over the cells of a decomposition, petgraph's: the one search here over a graph that is there before it begins. It takes some three
//! times what a search over arrays did, less than a hundredth of what the cells take.

use super::decomposition::{CellPortal, Decomposition};
use super::terminals::Terminals;
use crate::geometry::Point;
use crate::interrupt::checkpoint;
use crate::space::{Measure, Metric, Segment};
use petgraph::algo::astar;
use petgraph::graph::{EdgeReference, NodeIndex, UnGraph};
use petgraph::visit::EdgeRef;

/// Cells to pass, with the portals between them: one less than cells.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Channel {
    pub start: Point,
    /// Any of these will do, all in the last cell.
    pub goals: Segment,
    pub cells: Vec<usize>,
    pub portals: Vec<usize>,
}

/// Which portals each cell has, and what ways through them cost.
#[derive(Debug, Clone)]
pub(super) struct Adjacency {
    /// Nodes are cells, edges are portals, by their numbers.
    cells: UnGraph<Place, Option<usize>>,
    /// Centres of the cells.
    pub centers: Vec<Point>,
    /// Middles of the portals.
    pub middles: Vec<Point>,
}

/// Where a way leads to.
#[derive(Debug, Clone, Copy)]
enum Place {
    /// The start, or a cell's centre.
    At(Point),
    /// The nearest of these goals.
    Any(Segment),
}

impl Adjacency {
    /// Linear.
    pub fn new(decomposition: &Decomposition, centers: Vec<Point>) -> Self {
        let mut cells = UnGraph::with_capacity(centers.len(), decomposition.portals.len());
        for &center in &centers {
            cells.add_node(Place::At(center));
        }
        for (number, portal) in decomposition.portals.iter().enumerate() {
            let [left, right] = portal.cells.map(NodeIndex::new);
            cells.add_edge(left, right, Some(number));
        }
        let middles = decomposition.portals.iter().map(|portal| nalgebra::center(&portal.low, &portal.high)).collect();
        Self { cells, centers, middles }
    }

    /// The cheapest channel from the start, given the cells that contain it, to any goal: passing from a cell to the
    /// next costs the way from the one's centre over the portal's middle to the other's, with the start and the nearest goal for
    /// the centres of the end cells. `O(n log n)` for `n` cells.
    pub fn channel(&self, portals: &[CellPortal], terminals: &Terminals, start_cells: &[usize]) -> Option<Channel> {
        // Beside the cells that hold them the ends are nodes of their own, with the same portals.
        let mut graph = self.cells.clone();
        let start = graph.add_node(Place::At(terminals.start));
        for &cell in start_cells {
            for portal in self.cells.edges(NodeIndex::new(cell)) {
                graph.add_edge(start, portal.target(), *portal.weight());
            }
        }
        let is_left = |cell: NodeIndex| start_cells.contains(&cell.index());
        for &(cell, goals) in &terminals.parts {
            let (cell, goal) = (NodeIndex::new(cell as usize), graph.add_node(Place::Any(goals)));
            for portal in self.cells.edges(cell) {
                graph.add_edge(portal.target(), goal, *portal.weight());
                if is_left(portal.target()) {
                    graph.add_edge(start, goal, *portal.weight());
                }
            }
            if is_left(cell) {
                graph.add_edge(start, goal, None);
            }
        }
        let cost = |[from, to]: [NodeIndex; 2], portal: Option<usize>| {
            let from = match graph[from] {
                Place::At(point) => point,
                Place::Any(goals) => goals.corners()[0],
            };
            let last = portal.map_or(from, |portal| self.middles[portal]);
            let to = match graph[to] {
                Place::At(point) => point,
                Place::Any(goals) => Point::from(goals.nearest(Measure::from(Metric::Euclidean), last.coords)),
            };
            (last - from).norm() + (to - last).norm()
        };
        let ahead = |node: NodeIndex| match graph[node] {
            Place::At(point) => terminals.straight_distance(point),
            Place::Any(_) => 0.0,
        };
        let passing = |portal: EdgeReference<'_, Option<usize>>| {
            checkpoint();
            cost([portal.source(), portal.target()], *portal.weight())
        };
        let (_, places) = astar(&graph, start, |node| node > start, passing, ahead)?;
        let cheapest = |pair: &[NodeIndex]| {
            let between = graph.edges_connecting(pair[0], pair[1]).map(|portal| *portal.weight());
            between.min_by(|&a, &b| cost([pair[0], pair[1]], a).total_cmp(&cost([pair[0], pair[1]], b))).flatten()
        };
        let passed: Vec<usize> = places.windows(2).filter_map(cheapest).collect();
        let (last, goals) = terminals.parts[places[places.len() - 1].index() - start.index() - 1];
        let mut cells = vec![last as usize];
        for &portal in passed.iter().rev() {
            let [left, right] = portals[portal].cells;
            cells.push(if left == cells[cells.len() - 1] { right } else { left });
        }
        cells.reverse();
        Some(Channel { start: terminals.start, goals, cells, portals: passed })
    }
}
