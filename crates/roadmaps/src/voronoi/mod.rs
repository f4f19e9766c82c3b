//! Paths of greatest clearance, by the Voronoi diagram of free space.
//!
//! `site` has the sides and corners of the diagram, `bisector` the points equally near to two sites, `cell` the border
//! of the region nearest to one site, and `diagram` all of them. The borders of cells are lower envelopes of closed
//! forms, so only their ends are rounded, and sites that touch or coincide need no special treatment.

mod bisector;
mod cell;
mod diagram;
mod site;
mod chord_graph;

use crate::prm::along;
use chord_graph::ChordGraph;
use cplan_core::cspace::Regions;
use cplan_core::planner::mesh::Mesh;
use cplan_core::planner::roadmap::{self, RoadmapSearch};
use cplan_core::planner::terminals::Terminals;
use cplan_core::planner::{GraphKind, PathKind, Planner, Proposal, Query, Run};
use cplan_geometry::planar::Boundary;
use diagram::Diagram;

/// The *generalised Voronoi diagram* of C-obstacles and joint limits, or medial axis of free space: a path that keeps
/// the greatest distance from them, in joint space.
///
/// Sites are the open sides of free space's boundary and its corners; on the diagram two of them are equally near
/// (O'Dunlaing, Yap, *A "retraction" method for planning the motion of a disc*, 1985). Start and goals are joined to it
/// along the straight line away from the nearest site. Among all paths along the diagram, the search looks for those
/// whose least distance from the boundary is greatest, and among these for the shortest, unless another search is
/// chosen. The limits of joints are walls; on circles sites are repeated across the seam.
///
/// Straight arcs are exact. Parabolas are replaced by chords within 1e-3 rad or m of them, and within a hundredth of
/// their distance from the boundary. Borders of cells are closed forms in floating point. Triangulated free space
/// decides exactly whether a motion is free. `O(n m)` for `n` sites with `m` others around them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Voronoi {
    /// [`PathKind::Own`] is along the diagram; [`PathKind::Taut`] is pulled tight through the triangles that it crosses, so that it may
    /// touch obstacles.
    pub path: PathKind,
    /// Search method for the widest paths.
    pub search: RoadmapSearch,
}

impl Default for Voronoi {
    fn default() -> Self {
        Self { path: PathKind::Own, search: RoadmapSearch::default() }
    }
}

/// The diagram in a window, and triangulated free space.
#[derive(Debug, Clone)]
pub struct VoronoiMap {
    mesh: Mesh,
    diagram: Diagram,
    graph: ChordGraph,
}

impl Planner for Voronoi {
    const NAME: &'static str = "voronoi";
    type Space = Regions;
    type Map = VoronoiMap;

    fn build(&self, space: &Regions) -> VoronoiMap {
        let mesh = Mesh::new(Boundary::new(&space.contours()));
        let diagram = Diagram::new(space, &mesh);
        let graph = ChordGraph::new(&mesh, diagram.repeated(space.window));
        VoronoiMap { mesh, diagram, graph }
    }

    fn query(&self, space: &Regions, map: &VoronoiMap, query: &Query) -> Run {
        let terminals = match Terminals::new(space, query, |segment| map.mesh.parts_of(segment)) {
            Ok(terminals) => terminals,
            Err(reason) => return roadmap::run(GraphKind::Roadmap, Proposal::GaveUp(reason), None, Vec::new()),
        };
        let query_graph = map.graph.query_graph(&map.mesh, &map.diagram, &terminals);
        let Some(widest) = query_graph.widest(chord_graph::MIN_CHORD_CLEARANCE) else {
            return roadmap::run(GraphKind::Roadmap, Proposal::NoPath, Some(&query_graph), Vec::new());
        };
        let (route, expanded) = widest.search(self.search, &terminals);
        let own = |route: Vec<_>| route.into_iter().map(|node| widest.at(node)).collect();
        let outcome = route.map_or(Proposal::NoPath, |route| along(&map.mesh, own(route), self.path));
        roadmap::run(GraphKind::Roadmap, outcome, Some(&query_graph), expanded)
    }
}
