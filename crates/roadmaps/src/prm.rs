//! Paths by a probabilistic roadmap.

use super::triangles::taut;
use cplan_core::cspace::Regions;
use cplan_core::planner::mesh::Mesh;
use cplan_core::planner::roadmap::{self, Asked, Nearby, Roadmap, RoadmapSearch};
use cplan_core::planner::terminals::Terminals;
use cplan_core::planner::{GraphKind, PathKind, Planner, Proposal, Query, Run};
use cplan_core::space::{Draws, Measure, Metric, Path, Segment};
use cplan_geometry::Point;
use cplan_geometry::planar::Boundary;
use cplan_interrupt::checkpoint;
use cplan_text::counted;
use petgraph::graph::NodeIndex;

/// Draws for each sample that is wanted, at most: a free share of a hundredth is enough.
const DRAWS: usize = 100;

/// The *probabilistic roadmap* (Kavraki, Svestka, Latombe, Overmars 1996), for comparison: random free configurations,
/// each joined to the nearest ones that it sees.
///
/// Samples are uniform over free space; on circles each sample has all its copies within the window. Triangulated free
/// space decides exactly whether a motion between samples is free. The seed determines the sequence of samples, and a
/// smaller roadmap uses its first ones, so the same input gives the same roadmap.
///
/// If it finds no path it gives up, because a path may still exist. `O(n k log n)` for `n` samples with `k` neighbours,
/// plus the triangles that motions cross.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Prm {
    /// Number of free samples.
    pub samples: usize,
    /// Number of nearest samples to which each is joined, if it sees them.
    pub nearest: usize,
    /// Seed of the random samples.
    pub seed: u64,
    /// [`PathKind::Own`] leads from sample to sample; [`PathKind::Taut`] is pulled tight through the triangles that it crosses.
    pub path: PathKind,
    /// Search method for the roadmap.
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
    /// The samples; node `k` of the roadmap is the `k`th of them.
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
            // It is the nearest to itself.
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
        let asked = self.asked(map, &terminals);
        let (way, expanded) = asked.search(self.search, &terminals);
        let outcome = match way {
            None => Proposal::GaveUp(format!("{} do not join start and goal", counted(self.samples, "sample"))),
            Some(way) => along(&map.mesh, way.into_iter().map(|node| asked.at(node)).collect(), self.path),
        };
        roadmap::run(GraphKind::Samples, outcome, Some(&asked), expanded)
    }
}

impl Prm {
    /// Returns the free samples with all their copies in the window.
    fn drawn(&self, space: &Regions, mesh: &Mesh) -> Vec<Point> {
        let mut draws = Draws::new(self.seed);
        let (mut points, mut found) = (Vec::new(), 0);
        for _ in 0..DRAWS * self.samples {
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

    /// Returns the roadmap with a query's ends, joined to each other and to the nearest samples.
    fn asked(&self, map: &PrmMap, terminals: &Terminals) -> Asked {
        let mut asked = map.roadmap.clone().asked(terminals.start);
        let start = asked.start;
        let join = |asked: &mut Asked, end: NodeIndex| {
            let at = asked.at(end);
            for sample in map.samples.nearest(at, self.nearest) {
                if map.mesh.is_clear(at, map.samples.points()[sample]) {
                    asked.join(end, NodeIndex::new(sample));
                }
            }
        };
        join(&mut asked, start);
        for at in terminals.places(&map.mesh) {
            let goal = asked.goal(at);
            join(&mut asked, goal);
            if map.mesh.is_clear(terminals.start, at) {
                asked.join(start, goal);
            }
        }
        asked
    }
}

/// Returns a polyline through free space as a path, either unchanged or pulled taut through the triangles that it
/// crosses.
pub(super) fn along(mesh: &Mesh, own: Vec<Point>, kind: PathKind) -> Proposal {
    let waypoints = match kind {
        PathKind::Own | PathKind::Middles => own,
        PathKind::Taut => tightened(mesh, &own).unwrap_or(own),
    };
    Proposal::Found(Path::new(waypoints))
}

/// Pulls a path taut through the triangles that it crosses. Returns `None` if it passes through a vertex or along a
/// side.
fn tightened(mesh: &Mesh, path: &[Point]) -> Option<Vec<Point>> {
    let crossed = |first: u32| {
        let (mut at, mut portals) = (first, Vec::new());
        for leg in path.windows(2) {
            for portal in mesh.walk(at, leg[0], leg[1])? {
                let back = mesh.twin(portal)?;
                at = back / 3;
                // A triangle left through the side of entry can be skipped.
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
