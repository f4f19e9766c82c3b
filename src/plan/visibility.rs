//! Shortest paths by visibility graph and A*.

use super::boundary::{Boundary, Sector};
use super::sight::Sight;
use super::terminals::Terminals;
use super::{Outcome, Planner, Query, Run, Size, Trace};
use crate::cspace::Regions;
use crate::geometry::{Orientation, Point, orientation};
use crate::space::Path;
use petgraph::graph::{NodeIndex, UnGraph};

/// The *reduced visibility graph* and A* over it: finds the shortest path in closed free space.
///
/// Nodes are the convex corners of C-obstacles, the start and all copies of the goals; arcs are the segments in closed
/// free space that are tangent to the obstacle at each end that is a corner. A shortest path turns only at convex
/// corners and only around them, so the arcs left out are on none (Latombe, *Robot Motion Planning*, 1991, section
/// 4.1). A path may touch obstacles, but does not squeeze between two that touch in a corner: it is always a limit of
/// paths in the interior of free space.
///
/// Of `n` nodes every pair is looked at, `O(n^2)` cheap tangency tests; the few pairs that pass are tested for
/// visibility through a grid over the boundary. Signs are exact, lengths rounded.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Visibility;

/// A visibility graph without start and goals.
#[derive(Debug, Clone)]
pub struct VisibilityMap {
    sight: Sight,
    corners: Vec<Corner>,
    /// Nodes are numbered like `corners`; arcs carry their length.
    graph: UnGraph<Point, f64>,
}

/// A convex corner of an obstacle, seen from free space.
#[derive(Debug, Clone, Copy)]
struct Corner {
    at: Point,
    free: Sector,
}

impl Corner {
    /// Whether the line to `p` does not enter the obstacle at the corner: both sides there lie on one side of it.
    fn is_tangent(&self, p: Point) -> bool {
        let right = orientation(self.at, p, self.free.right);
        right == Orientation::Collinear || {
            let left = orientation(self.at, p, self.free.left);
            left == right || left == Orientation::Collinear
        }
    }
}

impl Planner for Visibility {
    const NAME: &'static str = "visibility";
    type Space = Regions;
    type Map = VisibilityMap;

    fn build(&self, space: &Regions) -> VisibilityMap {
        let boundary = Boundary::new(space);
        let mut corners = Vec::new();
        for (v, &at) in boundary.vertices.iter().enumerate() {
            let reflex = boundary.sectors(v).iter().filter(|sector| sector.is_reflex(at));
            corners.extend(reflex.map(|&free| Corner { at, free }));
        }
        let sight = Sight::new(boundary);
        let mut graph = UnGraph::default();
        for (j, c) in corners.iter().enumerate() {
            let node = graph.add_node(c.at);
            for (i, d) in corners[..j].iter().enumerate() {
                let tangent = c.free.polygon == d.free.polygon && c.is_tangent(d.at) && d.is_tangent(c.at);
                if tangent && sight.is_unobstructed(c.at, d.at) {
                    graph.add_edge(node, NodeIndex::new(i), (c.at - d.at).norm());
                }
            }
        }
        VisibilityMap { sight, corners, graph }
    }

    fn query(&self, space: &Regions, map: &VisibilityMap, query: &Query) -> Run {
        let mut graph = map.graph.clone();
        let outcome = match Terminals::new(space, map.sight.boundary(), query) {
            Ok(terminals) => map.search(&mut graph, &terminals),
            Err(reason) => Outcome::GaveUp(reason),
        };
        let ends = |e| graph.edge_endpoints(e).map(|(a, b)| [graph[a].coords, graph[b].coords]);
        let edges = graph.edge_indices().filter_map(ends).collect();
        Run {
            outcome,
            trace: Trace::Roadmap { edges },
            size: Size::Graph { nodes: graph.node_count(), edges: graph.edge_count() },
            note: None,
        }
    }
}

impl VisibilityMap {
    /// Adds start and goals to a copy of the graph and finds the shortest path.
    fn search(&self, graph: &mut UnGraph<Point, f64>, terminals: &Terminals) -> Outcome {
        let start = self.connect(graph, terminals.start);
        let first_goal = graph.node_count();
        for &goal in &terminals.goals {
            let node = self.connect(graph, goal);
            if self.sight.sees(terminals.start, goal) {
                graph.add_edge(start, node, (goal - terminals.start).norm());
            }
        }
        let shortest = petgraph::algo::astar(
            &*graph,
            start,
            |node| node.index() >= first_goal,
            |arc| *arc.weight(),
            |node| terminals.straight_distance(graph[node]),
        );
        match shortest {
            Some((_, nodes)) => Outcome::Found(Path::new(nodes.into_iter().map(|n| graph[n].coords).collect())),
            None => Outcome::NoPath,
        }
    }

    /// Adds a node at `p` with arcs to all corners that it sees.
    fn connect(&self, graph: &mut UnGraph<Point, f64>, p: Point) -> NodeIndex {
        let node = graph.add_node(p);
        for (i, corner) in self.corners.iter().enumerate() {
            if corner.at != p && corner.is_tangent(p) && self.sight.sees(p, corner.at) {
                graph.add_edge(node, NodeIndex::new(i), (corner.at - p).norm());
            }
        }
        node
    }
}
