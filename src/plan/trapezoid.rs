//! Paths by exact cell decomposition: trapezoids, a channel, a taut string.

use super::boundary::Boundary;
use super::decomposition::{Decomposition, Door};
use super::funnel::{Passage, taut_string};
use super::sight::Sight;
use super::terminals::Terminals;
use super::{Outcome, Planner, Query, Run, Size, Trace};
use crate::cspace::Regions;
use crate::geometry::Point;
use crate::space::{Configuration, Path};
use petgraph::algo::astar;
use petgraph::graph::{NodeIndex, UnGraph};
use petgraph::visit::EdgeRef;

/// The *trapezoidal decomposition*: finds a channel of cells from start to goal whenever there is one, and a path in it.
///
/// Cells are joined where they share a piece of vertical of positive length (a *door*). A* finds the channel; passing
/// from a cell to the next costs the way from the one's centre over the door's middle to the other's, with start and
/// goal for the centres of the end cells (Latombe, *Robot Motion Planning*, 1991, section 5.1). The path is free but
/// not the shortest, even when taut: another channel may hold a shorter one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Trapezoid {
    /// Whether the path is pulled taut within the channel, so that it may touch obstacles. Otherwise it leads through
    /// the middles of doors, and between two doors on one vertical through the centre of the cell.
    pub taut: bool,
}

impl Default for Trapezoid {
    fn default() -> Self {
        Self { taut: true }
    }
}

/// A decomposition and the adjacency of its cells.
#[derive(Debug, Clone)]
pub struct TrapezoidMap {
    sight: Sight,
    decomposition: Decomposition,
    /// Corners of the cells.
    corners: Vec<Vec<Configuration>>,
    /// Middles of the doors.
    middles: Vec<Point>,
    /// Nodes are numbered like the cells, arcs like the doors.
    graph: CellGraph,
}

/// Arcs carry the door that they pass; those between terminals of one cell pass none.
type CellGraph = UnGraph<Stop, Option<usize>>;

/// A place in a cell: its centre, or a start or goal in it.
#[derive(Debug, Clone, Copy)]
struct Stop {
    cell: usize,
    at: Point,
}

impl Planner for Trapezoid {
    const NAME: &'static str = "trapezoid";
    type Space = Regions;
    type Map = TrapezoidMap;

    fn build(&self, space: &Regions) -> TrapezoidMap {
        let boundary = Boundary::new(space);
        let decomposition = Decomposition::new(&boundary);
        let mut graph = CellGraph::default();
        for (cell, shape) in decomposition.cells.iter().enumerate() {
            graph.add_node(Stop { cell, at: shape.centroid(&boundary) });
        }
        for (k, door) in decomposition.doors.iter().enumerate() {
            let [left, right] = door.cells.map(NodeIndex::new);
            graph.add_edge(left, right, Some(k));
        }
        let corners_of = |points: Vec<Point>| points.into_iter().map(|p| p.coords).collect();
        let corners = decomposition.cells.iter().map(|cell| corners_of(cell.corners(&boundary))).collect();
        let middles = decomposition.doors.iter().map(|door| nalgebra::center(&door.low, &door.high)).collect();
        TrapezoidMap { sight: Sight::new(boundary), decomposition, corners, middles, graph }
    }

    fn query(&self, space: &Regions, map: &TrapezoidMap, query: &Query) -> Run {
        let (outcome, channel) = match Terminals::new(space, map.sight.boundary(), query) {
            Err(reason) => (Outcome::GaveUp(reason), Vec::new()),
            Ok(terminals) => match map.channel(&terminals) {
                None => (Outcome::NoPath, Vec::new()),
                Some(channel) => {
                    let waypoints = if self.taut { map.taut_path(&channel) } else { map.middle_path(&channel) };
                    let path = Path::new(waypoints.into_iter().map(|p| p.coords).collect());
                    (Outcome::Found(path), channel.cells)
                }
            },
        };
        Run {
            outcome,
            trace: Trace::Channel { cells: map.corners.clone(), channel },
            size: Size::Graph { nodes: map.decomposition.cells.len(), edges: map.decomposition.doors.len() },
            note: None,
        }
    }
}

/// Cells to pass, with the doors between them: one less than cells.
struct Channel {
    start: Point,
    goal: Point,
    cells: Vec<usize>,
    doors: Vec<usize>,
}

impl TrapezoidMap {
    /// The cheapest channel from the start to any goal.
    fn channel(&self, terminals: &Terminals) -> Option<Channel> {
        let mut graph = self.graph.clone();
        let starts = self.connect(&mut graph, terminals.start);
        let first_goal = graph.node_count();
        for &goal in &terminals.goals {
            for node in self.connect(&mut graph, goal) {
                for &start in &starts {
                    self.join_terminals(&mut graph, start, node);
                }
            }
        }
        // A start on a vertical is in several cells, which are alternatives: a root with free arcs to all of them.
        let root = graph.add_node(graph[*starts.first()?]);
        for &start in &starts {
            graph.add_edge(root, start, None);
        }
        let cost = |from: Point, to: Point, door: Option<usize>| match door {
            Some(door) => (self.middles[door] - from).norm() + (to - self.middles[door]).norm(),
            None => (to - from).norm(),
        };
        let (_, nodes) = astar(
            &graph,
            root,
            |node| (first_goal..root.index()).contains(&node.index()),
            |arc| cost(graph[arc.source()].at, graph[arc.target()].at, *arc.weight()),
            |node| terminals.straight_distance(graph[node].at),
        )?;
        let goal = graph[*nodes.last()?].at;
        let mut cells: Vec<usize> = nodes.iter().skip(1).map(|&node| graph[node].cell).collect();
        cells.dedup();
        let doors = nodes.windows(2).filter_map(|pair| graph[graph.find_edge(pair[0], pair[1])?]).collect();
        Some(Channel { start: terminals.start, goal, cells, doors })
    }

    /// Adds a stop at `p` in each cell that contains it, joined to the cells next to that.
    fn connect(&self, graph: &mut CellGraph, p: Point) -> Vec<NodeIndex> {
        let cells = self.decomposition.cells.iter().enumerate();
        let around = cells.filter(|(_, shape)| shape.contains(self.sight.boundary(), p)).map(|(cell, _)| cell);
        around
            .map(|cell| {
                let node = graph.add_node(Stop { cell, at: p });
                for arc in self.graph.edges(NodeIndex::new(cell)) {
                    graph.add_edge(node, arc.target(), *arc.weight());
                }
                node
            })
            .collect()
    }

    /// Joins a start and a goal in the same cell or in neighbouring cells.
    fn join_terminals(&self, graph: &mut CellGraph, start: NodeIndex, goal: NodeIndex) {
        let (from, to) = (graph[start].cell, graph[goal].cell);
        if from == to {
            graph.add_edge(start, goal, None);
        } else if let Some(arc) = self.graph.find_edge(NodeIndex::new(from), NodeIndex::new(to)) {
            graph.add_edge(start, goal, self.graph[arc]);
        }
    }

    /// Through the middles of the doors, and the centre of a cell that is left on the vertical on which it was entered.
    fn middle_path(&self, channel: &Channel) -> Vec<Point> {
        let mut waypoints = vec![channel.start];
        for (k, &door) in channel.doors.iter().enumerate() {
            let middle = self.middles[door];
            if k > 0 && self.middles[channel.doors[k - 1]].x == middle.x {
                waypoints.push(self.graph[NodeIndex::new(channel.cells[k])].at);
            }
            waypoints.push(middle);
        }
        waypoints.push(channel.goal);
        waypoints
    }

    /// The shortest way within the channel.
    fn taut_path(&self, channel: &Channel) -> Vec<Point> {
        let passages: Vec<Passage> = channel
            .doors
            .iter()
            .zip(&channel.cells)
            .map(|(&door, &cell)| {
                let Door { cells: [from, _], low, high } = self.decomposition.doors[door];
                if from == cell { Passage { left: high, right: low } } else { Passage { left: low, right: high } }
            })
            .collect();
        let string = taut_string(channel.start, channel.goal, &passages);
        // Where a door ends in the middle of a side, its end is rounded into free space, and a string along the side
        // turns there by a rounding error. A taut string turns at vertices only: leave such turns out.
        let mut waypoints = vec![channel.start];
        for turn in string.windows(3) {
            let is_vertex = self.sight.boundary().vertex_at(turn[1]).is_some();
            if is_vertex || !self.sight.sees(waypoints[waypoints.len() - 1], turn[2]) {
                waypoints.push(turn[1]);
            }
        }
        waypoints.push(channel.goal);
        waypoints
    }
}
