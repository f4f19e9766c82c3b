//! Shortest paths by visibility graph and A*.
//!
//! `mesh` triangulates free space and follows cones of sight from triangle to triangle. Cones are bounded by lines
//! through vertices, so that exact predicates decide what is seen. `VisibilityMap::arcs` reads the whole reduced
//! visibility graph off it. A query (`polyanya`) does not: it is A* over that graph, but keeps cones on the open list
//! beside corners, each with a lower bound on the way through it, so that arcs are found in the order in which they
//! matter (Polyanya). One search serves all metrics: shortest paths in any norm turn at the same corners, only lengths
//! and bounds differ ([`crate::space::Measure`]).

use super::mesh::{Mesh, Tangency};
use super::polyanya::Polyanya;
use super::terminals::Terminals;
use super::{Planner, Proposal, Query, Run, Size, Trace};
use crate::cspace::Regions;
use crate::geometry::planar::Boundary;
use crate::space::{Configuration, Measure, Metric, Path};

/// The *reduced visibility graph* and A* over it: finds the shortest path in closed free space.
///
/// Nodes are the convex corners of C-obstacles, the start and all copies of the goals; arcs are the segments in closed
/// free space that are tangent to the obstacle at each end that is a corner. A shortest path turns only at convex
/// corners and only around them, so the arcs left out are on none (Latombe, *Robot Motion Planning*, 1991, section
/// 4.1). A path may touch obstacles, but does not squeeze between two that touch in a corner: it is always a limit of
/// paths in the interior of free space.
///
/// Free space is triangulated (constrained Delaunay, `O(n log n)` for `n` corners and near-linear memory). What a corner
/// sees is found by following its lines of sight from triangle to triangle, in time proportional to the triangles
/// crossed; a query does so only as far as the estimate of A* asks for. Signs are exact, lengths rounded.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Visibility {
    /// What is shortest. Of motions that take equally long, the one that is shortest in Euclid's sense.
    pub metric: Metric,
}

/// Triangulated free space, from which the visibility graph is read.
#[derive(Debug, Clone)]
pub struct VisibilityMap {
    mesh: Mesh,
}

impl Planner for Visibility {
    const NAME: &'static str = "visibility";
    type Space = Regions;
    type Map = VisibilityMap;

    fn build(&self, space: &Regions) -> VisibilityMap {
        VisibilityMap { mesh: Mesh::new(Boundary::new(&space.contours())) }
    }

    /// The trace and the size are those of the part of the graph that the search looked at.
    fn query(&self, space: &Regions, map: &VisibilityMap, query: &Query) -> Run {
        let terminals = match Terminals::new(space, query, |segment| map.mesh.parts_of(segment)) {
            Ok(terminals) => terminals,
            Err(reason) => {
                return Run {
                    outcome: Proposal::GaveUp(reason),
                    trace: Trace::Roadmap { edges: Vec::new(), whole: false },
                    size: Size::Graph { nodes: 0, edges: 0 },
                    note: None,
                };
            }
        };
        let mut search = Polyanya::new(&map.mesh, Measure::from(self.metric), &terminals);
        let outcome = match search.path() {
            Some(waypoints) => Proposal::Found(Path::new(waypoints.into_iter().map(|p| p.coords).collect())),
            None => Proposal::NoPath,
        };
        let edges: Vec<_> = search.arcs.iter().map(|ends| ends.map(|p| p.coords)).collect();
        let size = Size::Graph { nodes: search.nodes(), edges: edges.len() };
        Run { outcome, trace: Trace::Roadmap { edges, whole: false }, size, note: None }
    }
}

impl VisibilityMap {
    /// Number of convex corners.
    #[must_use]
    pub fn corners(&self) -> usize {
        self.mesh.corners().len()
    }

    /// All arcs between corners: the ends of each. In time proportional to the triangles that lines of sight cross.
    #[must_use]
    pub fn arcs(&self) -> Vec<[Configuration; 2]> {
        let corners = self.mesh.corners();
        let mut arcs = Vec::new();
        let mut stack = Vec::new();
        for (number, corner) in (0..).zip(corners) {
            let is_tangent = |other: u32| corners[other as usize].tangency(corner.at) != Tangency::None;
            // Each arc is found from the end on its left: corners are numbered in that order.
            let arc = |half_edge: u32| {
                let other = self.mesh.corner_at(half_edge).filter(|&other| other > number && is_tangent(other))?;
                Some([corner.at.coords, corners[other as usize].at.coords])
            };
            for successor in corner.tangents().flat_map(|gaze| self.mesh.successors(corner, gaze)) {
                arcs.extend(successor.seen.into_iter().flatten().filter_map(arc));
                self.mesh.look_forward(corner.at, successor.cone, &mut stack, |half_edge| arcs.extend(arc(half_edge)));
            }
        }
        arcs
    }
}
