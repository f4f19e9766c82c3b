//! Paths through the triangles of free space, which join midpoints of their sides.

use cplan_geometry::Point;
use cplan_geometry::planar::{Boundary, NO_ENTRY};
use cplan_model::space::{Configuration, Measure, Metric, Path, Portal, Segment, funnel_path, nearest_end};
use cplan_planners::cspace::Regions;
use cplan_planners::planner::mesh::Mesh;
use cplan_planners::planner::roadmap::{Roadmap, RoadmapSearch};
use cplan_planners::planner::terminals::Terminals;
use cplan_planners::planner::{CellKind, ChannelPoints, PathKind, Planner, Proposal, Query, Run, Size, Trace};
use petgraph::graph::NodeIndex;
use std::sync::Arc;

/// The *triangular decomposition*. It finds a channel of triangles from start to goal whenever there is one, and a path within
/// it.
///
/// Free space is triangulated (constrained Delaunay). The nodes of the roadmap are the midpoints of sides that two triangles
/// share. The nodes of one triangle are joined by straight motions, which lie within the triangle (LaValle, *Planning
/// Algorithms*, 2006, section 6.3.2). A taut path need not be the shortest, because another channel may contain a shorter one.
/// `O(n log n)` for `n` corners, with any search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Triangles {
    /// The kind of path. [`PathKind::Taut`] is pulled taut within the channel, so it may touch obstacles.
    /// [`PathKind::Own`] leads through the midpoints of sides.
    pub path: PathKind,
    /// The search method over the roadmap.
    pub search: RoadmapSearch,
}

impl Default for Triangles {
    fn default() -> Self {
        Self { path: PathKind::Taut, search: RoadmapSearch::default() }
    }
}

/// Triangulated free space, and the roadmap through the midpoints of its sides.
#[derive(Debug, Clone)]
pub struct TrianglesMap {
    mesh: Mesh,
    /// Corners of each triangle, for pictures.
    corners: Arc<[Vec<Configuration>]>,
    roadmap: Roadmap,
    /// For each node, one of the two half-edges of the side whose midpoint it is.
    sides: Vec<u32>,
    /// For each half-edge, the node at its midpoint; `NO_ENTRY` on the boundary.
    middles: Vec<u32>,
}

impl Planner for Triangles {
    const NAME: &'static str = "triangles";
    type Space = Regions;
    type Map = TrianglesMap;

    fn build(&self, space: &Regions) -> TrianglesMap {
        TrianglesMap::new(Mesh::new(Boundary::new(&space.contours())))
    }

    fn query(&self, space: &Regions, map: &TrianglesMap, query: &Query) -> Run {
        let (outcome, channel, expanded) = match Terminals::new(space, query, |segment| map.mesh.parts_of(segment)) {
            Err(reason) => (Proposal::GaveUp(reason), Vec::new(), Vec::new()),
            Ok(terminals) => {
                let (route, expanded) = map.route(&terminals, self.search);
                match route {
                    None => (Proposal::NoPath, Vec::new(), expanded),
                    Some(RoadmapPath { own, channel, portals, goals }) => {
                        let waypoints = match self.path {
                            PathKind::Own | PathKind::Middles => own,
                            PathKind::Taut => taut(&map.mesh, terminals.start, &goals, &portals),
                        };
                        let path = Path::new(waypoints);
                        (
                            Proposal::Found(path),
                            channel.into_iter().map(|triangle| triangle as usize).collect(),
                            expanded,
                        )
                    }
                }
            }
        };
        let (kind, cells) = (CellKind::Triangles, Arc::clone(&map.corners));
        let size = Size::Graph { nodes: map.mesh.triangles(), edges: map.sides.len() };
        Run::new(outcome, Trace::Channel { kind, cells, channel, points: ChannelPoints::default(), expanded }, size)
    }
}

/// Returns the shortest path from the start to the nearest goal through the given sides of triangles. A side is given as the
/// half-edge of the triangle that the path leaves there.
pub(super) fn taut(mesh: &Mesh, start: Point, goals: &Segment, sides: &[u32]) -> Vec<Point> {
    let portal = |&side: &u32| {
        let [right, left] = mesh.ends(side);
        Portal { left, right }
    };
    let portals: Vec<Portal> = sides.iter().map(portal).collect();
    funnel_path(start, nearest_end(start, goals, &portals), &portals)
}

/// A path on the roadmap.
struct RoadmapPath {
    /// The start, the midpoints, and the goal.
    own: Vec<Point>,
    /// The triangles that the path passes.
    channel: Vec<u32>,
    /// The sides through which the path leaves the triangles, except the last triangle.
    portals: Vec<u32>,
    /// The part of the goals that lies in the last triangle.
    goals: Segment,
}

impl TrianglesMap {
    fn new(mesh: Mesh) -> Self {
        let triangles = 0..mesh.triangles() as u32;
        let corners_of = |triangle: u32| (0..3).map(|k| mesh.ends(3 * triangle + k)[0]).collect();
        let corners = triangles.clone().map(corners_of).collect();
        let mut roadmap = Roadmap::new(Measure::from(Metric::Euclidean));
        let (mut sides, mut middles) = (Vec::new(), vec![NO_ENTRY; 3 * mesh.triangles()]);
        for side in 0..3 * mesh.triangles() as u32 {
            if let Some(twin) = mesh.twin(side).filter(|&twin| side < twin) {
                let [right, left] = mesh.ends(side);
                let node = roadmap.add((right + left) * 0.5).index() as u32;
                (middles[side as usize], middles[twin as usize]) = (node, node);
                sides.push(side);
            }
        }
        let node = |side: u32| NodeIndex::new(middles[side as usize] as usize);
        for triangle in triangles {
            let portals: Vec<NodeIndex> = mesh.portals(triangle).map(node).collect();
            for (k, &a) in portals.iter().enumerate() {
                portals[k + 1..].iter().for_each(|&b| roadmap.join(a, b));
            }
        }
        Self { mesh, corners, roadmap, sides, middles }
    }

    /// Returns the path that a search finds, and the expanded configurations in order.
    fn route(&self, terminals: &Terminals, how: RoadmapSearch) -> (Option<RoadmapPath>, Vec<Configuration>) {
        let (mesh, start) = (&self.mesh, terminals.start);
        let euclid = Measure::from(Metric::Euclidean);
        let node = |side: u32| NodeIndex::new(self.middles[side as usize] as usize);
        let first: Vec<u32> = mesh.triangles_at(start).collect();
        let mut query_graph = self.roadmap.clone().query_graph(start);
        let begin = query_graph.start;
        for side in first.iter().flat_map(|&triangle| mesh.portals(triangle)) {
            query_graph.join(begin, node(side));
        }
        // For the node of each goal, its triangle and the part of the goals there.
        let mut goals: Vec<(NodeIndex, u32, Segment)> = Vec::new();
        for &(triangle, part) in &terminals.parts {
            let mut join = |from: NodeIndex| {
                let goal = query_graph.goal(part.nearest(euclid, query_graph.at(from)));
                query_graph.join(from, goal);
                goals.push((goal, triangle, part));
            };
            mesh.portals(triangle).for_each(|side| join(node(side)));
            if first.contains(&triangle) {
                join(begin);
            }
        }
        let (route, expanded) = query_graph.search(how, terminals);
        let route = route.map(|nodes| {
            // Returns the triangles of a node.
            let around = |node: NodeIndex| -> Vec<u32> {
                if let Some(&side) = self.sides.get(node.index()) {
                    return [Some(side), mesh.twin(side)].into_iter().flatten().map(|side| side / 3).collect();
                }
                if node == begin {
                    return first.clone();
                }
                goals.iter().filter(|goal| goal.0 == node).map(|goal| goal.1).collect()
            };
            let (mut channel, mut portals): (Vec<u32>, Vec<u32>) = (Vec::new(), Vec::new());
            for pair in nodes.windows(2) {
                let [a, b] = [pair[0], pair[1]].map(around);
                let Some(&triangle) = a.iter().find(|triangle| b.contains(triangle)) else { continue };
                if let Some(&last) = channel.last().filter(|&&last| last != triangle) {
                    portals.extend(mesh.portals(last).find(|&side| node(side) == pair[0]));
                }
                if channel.last() != Some(&triangle) {
                    channel.push(triangle);
                }
            }
            let end = nodes[nodes.len() - 1];
            let part = goals.iter().find(|goal| goal.0 == end && Some(&goal.1) == channel.last()).map(|goal| goal.2);
            let own: Vec<Point> = nodes.iter().map(|&node| query_graph.at(node)).collect();
            let goals = part.unwrap_or_else(|| Segment::point(own[own.len() - 1]));
            RoadmapPath { own, channel, portals, goals }
        });
        (route, expanded)
    }
}
