//! Shortest paths by A* over the visibility graph.
//!
//! `mesh` triangulates free space, and follows cones of lines of sight from triangle to triangle. Lines through vertices bound
//! the cones, so exact predicates decide visibility. `VisibilityMap::arcs` thus finds the whole reduced visibility graph.
//!
//! A query with the default search (`polyanya`) does not need the whole graph. Its open list holds cones as well as
//! corners, each with a lower bound on the length of paths through it. So only edges that matter to the search are
//! found. All other searches build the whole graph. One search serves all metrics: shortest paths turn at the same
//! corners in any norm, and only lengths and bounds differ ([`cplan_model::space::Measure`]).

mod full;

use super::mesh::{Cone, Mesh, Tangency};
use super::polyanya::Polyanya;
use super::roadmap::{QueryGraph, Roadmap, RoadmapSearch};
use super::terminals::Terminals;
use super::{GraphKind, Planner, Proposal, Query, Run, Size, Trace};
use crate::cspace::Regions;
use cplan_geometry::planar::Boundary;
use cplan_interrupt::checkpoint;
use cplan_model::space::{Configuration, Measure, Metric, Path, Segment};
use petgraph::graph::NodeIndex;
use serde::{Deserialize, Serialize};

/// The set of edges of a visibility graph.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum VisibilityGraph {
    /// The edges between convex corners of C-obstacles that are tangent at both ends. They suffice for shortest paths.
    #[default]
    Reduced,
    /// All edges of the definition, between any two corners of C-obstacles that see each other.
    Full,
}

impl VisibilityGraph {
    /// Both graphs, in the order of the command line's help.
    pub const ALL: [Self; 2] = [Self::Reduced, Self::Full];

    /// Returns the name on the command line and in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reduced => "reduced",
            Self::Full => "full",
        }
    }
}

/// The *reduced visibility graph* and A* over it: finds the shortest path in closed free space.
///
/// Nodes are the convex corners of C-obstacles, the start and all copies of the goals. Edges are segments in closed free space
/// that are tangent to the obstacle at each end that is a corner. A shortest path turns only at convex corners and only around
/// them, so it needs no other edges (Latombe, *Robot Motion Planning*, 1991, section 4.1). A path may touch obstacles, but does
/// not pass between two that touch in a corner. It is always a limit of paths in the interior of free space.
///
/// Free space is triangulated (constrained Delaunay, `O(n log n)` for `n` corners and near-linear memory). To find the view from
/// a corner, the search follows its lines of sight from triangle to triangle, in time proportional to the number of triangles
/// crossed. The default search follows them only as far as necessary. Signs are exact, and lengths are rounded.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Visibility {
    /// The quantity to minimise. Of paths with equal travel time, the one with the least Euclidean length is chosen.
    pub metric: Metric,
    /// The search method. The default search builds only the necessary part of the graph. Any other search builds the
    /// whole graph.
    pub search: RoadmapSearch,
    /// The set of edges. [`VisibilityGraph::Full`] is always built completely.
    pub graph: VisibilityGraph,
}

/// Triangulated free space, in which the edges of the visibility graph are found.
#[derive(Debug, Clone)]
pub struct VisibilityMap {
    mesh: Mesh,
    /// Window of the space, as in [`Regions::window`].
    window: [(f64, f64); 2],
}

impl Planner for Visibility {
    const NAME: &'static str = "visibility";
    type Space = Regions;
    type Map = VisibilityMap;

    fn build(&self, space: &Regions) -> VisibilityMap {
        VisibilityMap { mesh: Mesh::new(Boundary::new(&space.contours())), window: space.window }
    }

    /// Answers a query. Trace and size describe the part of the graph that the search visited.
    fn query(&self, space: &Regions, map: &VisibilityMap, query: &Query) -> Run {
        let terminals = match Terminals::new(space, query, |segment| map.mesh.parts_of(segment)) {
            Ok(terminals) => terminals,
            Err(reason) => {
                let nothing = Trace::Roadmap { edges: Vec::new(), whole: false };
                return Run::new(Proposal::GaveUp(reason), nothing, Size::Graph { nodes: 0, edges: 0 });
            }
        };
        if !self.search.is_default() || self.graph == VisibilityGraph::Full {
            return self.search_full_graph(map, &terminals);
        }
        let mut search = Polyanya::new(&map.mesh, Measure::from(self.metric), &terminals);
        let outcome = match search.path() {
            Some(waypoints) => Proposal::Found(Path::new(waypoints)),
            None => Proposal::NoPath,
        };
        let edges = search.arcs.clone();
        let size = Size::Graph { nodes: search.nodes(), edges: edges.len() };
        Run::new(outcome, Trace::Roadmap { edges, whole: false }, size)
    }
}

impl VisibilityMap {
    /// Returns the number of convex corners.
    pub fn corners(&self) -> usize {
        self.mesh.corners().len()
    }

    /// Returns both ends of each edge between corners of the reduced graph. Linear in the number of triangles that
    /// lines of sight cross.
    pub fn arcs(&self) -> Vec<[Configuration; 2]> {
        let corners = self.mesh.corners();
        self.pairs().into_iter().map(|pair| pair.map(|number| corners[number as usize].at)).collect()
    }

    /// Returns the numbers of the corners at both ends of each edge.
    fn pairs(&self) -> Vec<[u32; 2]> {
        let corners = self.mesh.corners();
        let mut pairs = Vec::new();
        let mut stack = Vec::new();
        for (number, corner) in (0..).zip(corners) {
            checkpoint();
            let is_tangent = |other: u32| corners[other as usize].tangency(corner.at) != Tangency::None;
            // Each edge is found from its left end, because corners are numbered from left to right.
            let arc = |half_edge: u32| {
                let other = self.mesh.corner_at(half_edge).filter(|&other| other > number && is_tangent(other))?;
                Some([number, other])
            };
            for successor in corner.tangents().flat_map(|gaze| self.mesh.successors(corner, gaze)) {
                pairs.extend(successor.seen.into_iter().flatten().filter_map(arc));
                self.mesh.visit_visible_corners(corner.at, successor.cone, &mut stack, |half_edge| {
                    pairs.extend(arc(half_edge))
                });
            }
        }
        pairs
    }
}

impl Visibility {
    /// Builds the whole graph and searches it.
    fn search_full_graph(&self, map: &VisibilityMap, terminals: &Terminals) -> Run {
        let measure = Measure::from(self.metric);
        let query_graph = match self.graph {
            VisibilityGraph::Reduced => Ok(map.query_graph(measure, terminals)),
            VisibilityGraph::Full => map.full(measure, terminals),
        };
        let query_graph = match query_graph {
            Ok(query_graph) => query_graph,
            Err(reason) => return super::roadmap::run(GraphKind::Roadmap, Proposal::GaveUp(reason), None, Vec::new()),
        };
        let (route, expanded) = query_graph.search(self.search, terminals);
        let outcome = match route {
            Some(route) => Proposal::Found(Path::new(route.into_iter().map(|node| query_graph.at(node)).collect())),
            None => Proposal::NoPath,
        };
        let [nodes, edges] = query_graph.size();
        let trace = Trace::Roads { edges: query_graph.edges(), expanded, kind: GraphKind::Visibility(self.graph) };
        Run::new(outcome, trace, Size::Graph { nodes, edges })
    }
}

impl VisibilityMap {
    /// Returns the whole reduced graph, with the start and the goals of a query. Edges lead from the start, and from
    /// each corner, to the nearest visible point of each goal.
    fn query_graph(&self, measure: Measure, terminals: &Terminals) -> QueryGraph {
        let (mesh, corners) = (&self.mesh, self.mesh.corners());
        let mut roadmap = Roadmap::new(measure);
        let nodes: Vec<NodeIndex> = corners.iter().map(|corner| roadmap.add(corner.at)).collect();
        for [a, b] in self.pairs() {
            roadmap.join(nodes[a as usize], nodes[b as usize]);
        }
        let mut query_graph = roadmap.query_graph(terminals.start);
        let mut ends = Ends { mesh, measure, terminals, query_graph: &mut query_graph, seen: Vec::new(), notes: true };
        for triangle in mesh.triangles_at(terminals.start) {
            ends.join_goals_in_triangle(ends.query_graph.start, triangle, |part| Some(*part));
            for successor in mesh.successors_within(triangle, terminals.start) {
                ends.seen.extend(successor.seen.into_iter().flatten());
                ends.join_visible_goals(ends.query_graph.start, successor.cone);
            }
        }
        let of_start = std::mem::take(&mut ends.seen);
        ends.notes = false;
        for (node, corner) in nodes.iter().zip(corners) {
            for successor in corner.tangents().flat_map(|gaze| mesh.successors(corner, gaze)) {
                ends.join_goals_in_triangle(*node, successor.cone.edge / 3, |part| Some(*part));
                ends.join_visible_goals(*node, successor.cone);
            }
        }
        let is_tangent = |corner: &u32| corners[*corner as usize].tangency(terminals.start) != Tangency::None;
        let of_start = of_start.into_iter().filter_map(|half_edge| mesh.corner_at(half_edge)).filter(is_tangent);
        of_start.for_each(|corner| query_graph.join(query_graph.start, nodes[corner as usize]));
        query_graph
    }
}

/// A graph to which visible goals are added node by node.
struct Ends<'a> {
    mesh: &'a Mesh,
    measure: Measure,
    terminals: &'a Terminals,
    query_graph: &'a mut QueryGraph,
    /// Half-edges that begin at vertices that the start sees. Filled only while `notes` is true.
    seen: Vec<u32>,
    /// True to fill `seen`.
    notes: bool,
}

impl Ends<'_> {
    /// Joins a node with the goals that it sees in a cone, and fills `seen` if requested.
    fn join_visible_goals(&mut self, root: NodeIndex, cone: Cone) {
        checkpoint();
        self.mesh.visit_visible_triangles(self.query_graph.at(root), cone, |crossing, cone| {
            if self.notes {
                self.seen.extend(crossing.seen);
            }
            self.join_goals_in_triangle(root, crossing.entry / 3, |part| cone.part(part));
        });
    }

    fn join_goals_in_triangle(&mut self, root: NodeIndex, triangle: u32, sees: impl Fn(&Segment) -> Option<Segment>) {
        for (_, part) in self.terminals.parts_in(triangle) {
            if let Some(seen) = sees(part) {
                let at = seen.nearest(self.measure, self.query_graph.at(root));
                let goal = self.query_graph.goal(at);
                self.query_graph.join(root, goal);
            }
        }
    }
}
