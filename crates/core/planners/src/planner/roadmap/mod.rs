//! Roadmaps: graphs whose nodes are configurations and whose edges are straight motions between them.
//!
//! A planner builds a [`Roadmap`] of a space once. For a query, it adds the start and the goals as nodes
//! ([`QueryGraph`]), joins them with other nodes, and searches the graph.

mod nearby;
mod search;

pub use nearby::Nearby;
pub use search::{RoadmapSearch, SearchOrder, SearchProblem, SearchResult, search};

use super::terminals::Terminals;
use super::{GraphKind, Proposal, Run, Size, Trace};
use cplan_geometry::Point;
use cplan_model::space::{Configuration, Measure};
use petgraph::graph::{NodeIndex, UnGraph};
use petgraph::unionfind::UnionFind;
use petgraph::visit::EdgeRef;
use std::collections::{BTreeMap, BTreeSet};

/// A straight motion between two configurations.
#[derive(Debug, Clone, Copy)]
struct RoadmapEdge {
    length: f64,
    /// Least distance from the boundary of free space. Infinite if the planner does not use widths.
    width: f64,
}

/// Configurations, and straight motions between them. A measure determines the lengths.
#[derive(Debug, Clone)]
pub struct Roadmap {
    graph: UnGraph<Point, RoadmapEdge>,
    measure: Measure,
}

impl Roadmap {
    /// Creates a roadmap without nodes.
    pub fn new(measure: Measure) -> Self {
        Self { graph: UnGraph::new_undirected(), measure }
    }

    /// Adds a node. Nodes are numbered in the order in which they are added.
    pub fn add(&mut self, at: Point) -> NodeIndex {
        self.graph.add_node(at)
    }

    /// Joins two nodes by a straight motion, unless they are joined already.
    pub fn join(&mut self, a: NodeIndex, b: NodeIndex) {
        self.join_of_width(a, b, f64::INFINITY);
    }

    /// Joins two nodes by a straight motion with this least distance from the boundary of free space, unless they
    /// are joined already.
    pub fn join_of_width(&mut self, a: NodeIndex, b: NodeIndex, width: f64) {
        if self.graph.find_edge(a, b).is_none() {
            let length = self.measure.norm(self.graph[b] - self.graph[a]);
            self.graph.add_edge(a, b, RoadmapEdge { length, width });
        }
    }

    /// Adds the start of a query.
    pub fn query_graph(mut self, start: Point) -> QueryGraph {
        let start = self.add(start);
        QueryGraph { roadmap: self, start, goals: BTreeMap::new(), ends: BTreeSet::new() }
    }
}

/// Returns the run of a search over a roadmap. `query_graph` is `None` if the planner gave up before the search.
pub fn run(kind: GraphKind, outcome: Proposal, query_graph: Option<&QueryGraph>, expanded: Vec<Configuration>) -> Run {
    let [nodes, edges] = query_graph.map_or([0; 2], QueryGraph::size);
    let drawn = query_graph.map_or_else(Vec::new, QueryGraph::edges);
    let trace = Trace::Roads { edges: drawn, expanded, kind };
    Run::new(outcome, trace, Size::Graph { nodes, edges })
}

/// A roadmap with the start and the goals of a query.
#[derive(Debug, Clone)]
pub struct QueryGraph {
    roadmap: Roadmap,
    /// The node of the start.
    pub start: NodeIndex,
    /// The nodes of the goals, by the bits of the goal's coordinates.
    goals: BTreeMap<[u64; 2], NodeIndex>,
    /// The nodes of the goals.
    ends: BTreeSet<NodeIndex>,
}

impl QueryGraph {
    /// Returns the node of a goal at this point, or adds one. A goal has its own node even if another node is at the same point.
    pub fn goal(&mut self, at: Point) -> NodeIndex {
        let roadmap = &mut self.roadmap;
        let goal = *self.goals.entry([at.x.to_bits(), at.y.to_bits()]).or_insert_with(|| roadmap.add(at));
        self.ends.insert(goal);
        goal
    }

    /// Adds a node that is no goal.
    pub fn add(&mut self, at: Point) -> NodeIndex {
        self.roadmap.add(at)
    }

    /// Joins two nodes by a straight motion, unless they are joined already.
    pub fn join(&mut self, a: NodeIndex, b: NodeIndex) {
        self.roadmap.join(a, b);
    }

    /// Joins two nodes by a straight motion with this least distance from the boundary of free space, unless they
    /// are joined already.
    pub fn join_of_width(&mut self, a: NodeIndex, b: NodeIndex, width: f64) {
        self.roadmap.join_of_width(a, b, width);
    }

    /// Consider the widest route from the start to a goal. Returns the graph without motions that are narrower than the
    /// narrowest motion of this route. `None` if that is narrower than `least`, or if there is no route. `O(m log m)`
    /// for `m` motions.
    pub fn widest(&self, least: f64) -> Option<Self> {
        let graph = &self.roadmap.graph;
        let mut order: Vec<_> = graph.edge_references().filter(|edge| edge.weight().width >= least).collect();
        order.sort_by(|a, b| b.weight().width.total_cmp(&a.weight().width));
        let mut joined = UnionFind::new(graph.node_count());
        let mut width = None;
        for edges in order.chunk_by(|a, b| a.weight().width == b.weight().width) {
            for edge in edges {
                joined.union(edge.source(), edge.target());
            }
            if self.ends.iter().any(|&end| joined.equiv(self.start, end)) {
                width = Some(edges[0].weight().width);
                break;
            }
        }
        let width = width?;
        let mut widest = self.clone();
        widest.roadmap.graph.retain_edges(|graph, edge| graph[edge].width >= width);
        Some(widest)
    }

    /// Returns the configuration of a node.
    pub fn at(&self, node: NodeIndex) -> Point {
        self.roadmap.graph[node]
    }

    /// Returns the numbers of nodes and edges.
    pub fn size(&self) -> [usize; 2] {
        [self.roadmap.graph.node_count(), self.roadmap.graph.edge_count()]
    }

    /// Returns both ends of each motion.
    pub fn edges(&self) -> Vec<[Configuration; 2]> {
        let edges = self.roadmap.graph.raw_edges().iter();
        edges.map(|edge| [edge.source(), edge.target()].map(|node| self.at(node))).collect()
    }

    /// Searches the graph. Returns the route, if there is one, and the configurations that were expanded, in order.
    pub fn search(&self, how: RoadmapSearch, terminals: &Terminals) -> (Option<Vec<NodeIndex>>, Vec<Configuration>) {
        let Roadmap { graph, measure } = &self.roadmap;
        let question = SearchProblem {
            start: self.start,
            is_goal: |node: NodeIndex| self.ends.contains(&node),
            cost: |road: &RoadmapEdge| road.length,
            ahead: |node: NodeIndex| terminals.distance(*measure, graph[node]),
            behind: |node: NodeIndex| measure.norm(graph[node] - graph[self.start]),
        };
        let SearchResult { path, expanded } = search(graph, how, &question);
        (path, expanded.into_iter().map(|node| graph[node]).collect())
    }
}
