//! The probabilistic roadmap.

use super::triangles::taut;
use cplan_geometry::Point;
use cplan_geometry::planar::Boundary;
use cplan_interrupt::checkpoint;
use cplan_model::space::{Measure, Metric, Path, Segment, SplitMix64};
use cplan_planners::cspace::Regions;
use cplan_planners::planner::mesh::Mesh;
use cplan_planners::planner::roadmap::{self, Nearby, QueryGraph, Roadmap, RoadmapSearch};
use cplan_planners::planner::terminals::Terminals;
use cplan_planners::planner::{GraphKind, PathKind, Planner, Proposal, Query, Run};
use cplan_text::counted;
use petgraph::graph::NodeIndex;

/// Largest number of random configurations that are drawn per requested sample. It suffices if a hundredth of the space is free.
const MAX_DRAWS_PER_SAMPLE: usize = 100;

/// The *probabilistic roadmap* (Kavraki, Svestka, Latombe, Overmars 1996), for comparison. It joins random free configurations to
/// the nearest ones that a straight free motion can reach.
///
/// Samples are uniform over free space. On circles, all copies of a sample within the window are nodes. Triangulated free space
/// decides exactly whether a motion between samples is free. The seed determines the sequence of samples, of which a roadmap uses
/// the first ones. So the same input gives the same roadmap.
///
/// If the planner finds no path, it gives up: a path may still exist. `O(n k log n)` for `n` samples with `k` neighbours, plus
/// the triangles that motions cross.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Prm {
    /// Number of free samples.
    pub samples: usize,
    /// Number of nearest samples to which each sample is joined, if the straight motion to them is free.
    pub nearest: usize,
    /// Seed of the random configurations.
    pub seed: u64,
    /// The kind of path. [`PathKind::Own`] leads from sample to sample; [`PathKind::Taut`] is pulled taut through
    /// the triangles that it crosses.
    pub path: PathKind,
    /// The search method over the roadmap.
    pub search: RoadmapSearch,
}

impl Default for Prm {
    fn default() -> Self {
        Self { samples: 500, nearest: 12, seed: 1, path: PathKind::Taut, search: RoadmapSearch::default() }
    }
}

/// A roadmap of samples, and triangulated free space.
#[derive(Debug, Clone)]
pub struct PrmMap {
    mesh: Mesh,
    /// The samples. Sample `k` is node `k` of the roadmap.
    samples: Nearby,
    roadmap: Roadmap,
}

impl Planner for Prm {
    const NAME: &'static str = "prm";
    type Space = Regions;
    type Map = PrmMap;

    fn build(&self, space: &Regions) -> PrmMap {
        let mesh = Mesh::new(Boundary::new(&space.contours()));
        let samples = Nearby::new(self.drawn(space, &mesh));
        let mut roadmap = Roadmap::new(Measure::from(Metric::Euclidean));
        let nodes: Vec<NodeIndex> = samples.points().iter().map(|&at| roadmap.add(at)).collect();
        for (k, &at) in samples.points().iter().enumerate() {
            checkpoint();
            // The nearest sample is the sample itself.
            for other in samples.nearest(at, self.nearest + 1) {
                if other != k && mesh.is_clear(at, samples.points()[other]) {
                    roadmap.join(nodes[k], nodes[other]);
                }
            }
        }
        PrmMap { mesh, samples, roadmap }
    }

    fn query(&self, space: &Regions, map: &PrmMap, query: &Query) -> Run {
        let terminals = match Terminals::new(space, query, |segment| map.mesh.parts_of(segment)) {
            Ok(terminals) => terminals,
            Err(reason) => return roadmap::run(GraphKind::Samples, Proposal::GaveUp(reason), None, Vec::new()),
        };
        let query_graph = self.query_graph(map, &terminals);
        let (route, expanded) = query_graph.search(self.search, &terminals);
        let outcome = match route {
            None => Proposal::GaveUp(format!(
                "the roadmap of {} does not connect start and goal",
                counted(self.samples, "sample")
            )),
            Some(route) => {
                propose_along(&map.mesh, route.into_iter().map(|node| query_graph.at(node)).collect(), self.path)
            }
        };
        roadmap::run(GraphKind::Samples, outcome, Some(&query_graph), expanded)
    }
}

impl Prm {
    /// Returns the free samples, with all their copies in the window.
    fn drawn(&self, space: &Regions, mesh: &Mesh) -> Vec<Point> {
        let mut draws = SplitMix64::new(self.seed);
        let (mut points, mut found) = (Vec::new(), 0);
        for _ in 0..MAX_DRAWS_PER_SAMPLE * self.samples {
            checkpoint();
            let q = draws.configuration(&space.topology);
            let copies = |k: usize| space.topology.ranges[k].copies_within(q[k], space.window[k]);
            let before = points.len();
            for x in copies(0) {
                let there = copies(1).map(|y| Point::new(x, y)).filter(|&p| mesh.triangles_at(p).next().is_some());
                points.extend(there);
            }
            found += usize::from(points.len() > before);
            if found == self.samples {
                break;
            }
        }
        points
    }

    /// Returns the roadmap with the start and the goals of a query. They are joined to the nearest samples, and the start to
    /// goals that a straight free motion reaches.
    fn query_graph(&self, map: &PrmMap, terminals: &Terminals) -> QueryGraph {
        let mut query_graph = map.roadmap.clone().query_graph(terminals.start);
        let start = query_graph.start;
        let join = |query_graph: &mut QueryGraph, end: NodeIndex| {
            let at = query_graph.at(end);
            for sample in map.samples.nearest(at, self.nearest) {
                if map.mesh.is_clear(at, map.samples.points()[sample]) {
                    query_graph.join(end, NodeIndex::new(sample));
                }
            }
        };
        join(&mut query_graph, start);
        for at in terminals.places(&map.mesh) {
            let goal = query_graph.goal(at);
            join(&mut query_graph, goal);
            if map.mesh.is_clear(terminals.start, at) {
                query_graph.join(start, goal);
            }
        }
        query_graph
    }
}

/// Returns a polyline through free space as a path. For [`PathKind::Taut`], it is pulled taut, if possible, through the triangles
/// that it crosses.
pub(super) fn propose_along(mesh: &Mesh, own: Vec<Point>, kind: PathKind) -> Proposal {
    let waypoints = match kind {
        PathKind::Own | PathKind::Middles => own,
        PathKind::Taut => pulled_taut(mesh, &own).unwrap_or(own),
    };
    Proposal::Found(Path::new(waypoints))
}

/// Pulls a path taut through the triangles that it crosses. Returns `None` if the path passes through a vertex or
/// along a side.
fn pulled_taut(mesh: &Mesh, path: &[Point]) -> Option<Vec<Point>> {
    let crossed = |first: u32| {
        let (mut at, mut portals) = (first, Vec::new());
        for leg in path.windows(2) {
            for portal in mesh.walk(at, leg[0], leg[1])? {
                let back = mesh.twin(portal)?;
                at = back / 3;
                // The path leaves this triangle through the side by which it entered, so the triangle is skipped.
                if portals.last() == Some(&back) {
                    portals.pop();
                } else {
                    portals.push(portal);
                }
            }
        }
        Some(portals)
    };
    let portals = mesh.triangles_at(path[0]).find_map(crossed)?;
    Some(taut(mesh, path[0], &Segment::point(path[path.len() - 1]), &portals))
}
