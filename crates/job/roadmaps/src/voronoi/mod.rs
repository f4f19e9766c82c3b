//! Paths of greatest clearance along the Voronoi diagram of free space.
//!
//! `site` has the sides and corners of the boundary, `bisector` the points that are equally near to two sites, `cell` the border
//! of the region nearest to one site, and `diagram` all these borders. The borders are lower envelopes of closed forms, so only
//! their ends are rounded. Sites that touch or coincide need no special case.

mod bisector;
mod cell;
mod diagram;
mod site;
mod chord_graph;

use crate::prm::propose_along;
use chord_graph::ChordGraph;
use cplan_geometry::planar::Boundary;
use cplan_planners::cspace::Regions;
use cplan_planners::planner::mesh::Mesh;
use cplan_planners::planner::roadmap::{self, RoadmapSearch};
use cplan_planners::planner::terminals::Terminals;
use cplan_planners::planner::{GraphKind, PathKind, Planner, Proposal, Query, Run};
use diagram::Diagram;

/// The *generalised Voronoi diagram* of C-obstacles and joint limits, also called the medial axis of free space. The planner
/// finds a path with the greatest distance, in joint space, from C-obstacles and limits.
///
/// Sites are the corners and the open sides of free space's boundary. Each point of the diagram is equally near to two sites
/// (O'Dunlaing, Yap, *A "retraction" method for planning the motion of a disc*, 1985). Start and goals are joined to the diagram
/// along the straight line away from the nearest site. The limits of joints are walls; on circles, sites repeat across the seam.
///
/// The search uses only edges at least as wide as the narrowest edge of the widest route. Among the paths on these edges, the
/// default search finds the shortest.
///
/// Straight arcs are exact. Parabolas are replaced by chords within 1e-3 rad or m of them, and within a hundredth of their
/// distance from the boundary. Borders of cells are closed forms in floating point. Triangulated free space decides exactly
/// whether a motion is free. `O(n m)` for `n` sites with `m` others near each of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Voronoi {
    /// The kind of path. [`PathKind::Own`] follows the diagram. [`PathKind::Taut`] is pulled taut through the
    /// triangles that it crosses, so it may touch obstacles.
    pub path: PathKind,
    /// The search method among the widest paths.
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
        let outcome = route.map_or(Proposal::NoPath, |route| propose_along(&map.mesh, own(route), self.path));
        roadmap::run(GraphKind::Roadmap, outcome, Some(&query_graph), expanded)
    }
}
