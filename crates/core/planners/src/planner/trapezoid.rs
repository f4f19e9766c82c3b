//! Paths by exact cell decomposition into trapezoids.
//!
//! `decomposition` creates the cells, and `channel` finds a sequence of cells to the goal.
//! [`cplan_model::space::funnel_path`] pulls the path through them taut.

use super::channel::{Adjacency, Channel};
use super::decomposition::{CellPortal, Decomposition};
use super::roadmap::RoadmapSearch;
use super::terminals::Terminals;
use super::{CellKind, ChannelPoints, PathKind, Planner, Proposal, Query, Run, Size, Trace};
use crate::cspace::Regions;
use cplan_geometry::planar::Boundary;
use cplan_geometry::{Orientation, Point, orientation};
use cplan_model::space::funnel::{Turn, turns};
use cplan_model::space::{Configuration, Measure, Metric, Path, Portal, Segment, nearest_end};
use std::ops::Range;
use std::sync::Arc;

/// The *trapezoidal decomposition*. It finds a channel of cells from start to goal whenever there is one, and a path
/// in the channel.
///
/// Two cells are joined if they share a piece of a vertical line of positive length (a *portal*). A* or another search finds the
/// channel. The cost of a passage between two cells is the distance between their centres through the portal's middle. In the
/// first and the last cell, start and goal replace the centre (Latombe, *Robot Motion Planning*, 1991, section 5.1). The path is
/// free, but even a taut one need not be the shortest, because another channel may contain a shorter path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Trapezoid {
    /// The kind of path. [`PathKind::Taut`] is taut within the channel, so it may touch obstacles. [`PathKind::Own`]
    /// passes through the middles of the portals and the centres of the cells: start, `Q1`, `C2`, `Q2`, ..., goal
    /// (Latombe). [`PathKind::Middles`] omits the centres of cells that it crosses from one vertical side to the other.
    pub path: PathKind,
    /// The search method over the graph of cells.
    pub search: RoadmapSearch,
}

impl Default for Trapezoid {
    fn default() -> Self {
        Self { path: PathKind::Taut, search: RoadmapSearch::default() }
    }
}

/// A decomposition and the graph of its cells.
#[derive(Debug, Clone)]
pub struct TrapezoidMap {
    boundary: Boundary,
    decomposition: Decomposition,
    /// Corners of each cell, for pictures.
    corners: Arc<[Vec<Configuration>]>,
    adjacency: Adjacency,
}

impl Planner for Trapezoid {
    const NAME: &'static str = "trapezoid";
    type Space = Regions;
    type Map = TrapezoidMap;

    fn build(&self, space: &Regions) -> TrapezoidMap {
        let boundary = Boundary::new(&space.contours());
        let decomposition = Decomposition::new(&boundary);
        let corners = decomposition.cells.iter().map(|cell| cell.corners(&boundary)).collect();
        let centers = decomposition.cells.iter().map(|cell| cell.centroid(&boundary)).collect();
        let adjacency = Adjacency::new(&decomposition, centers);
        TrapezoidMap { boundary, decomposition, corners, adjacency }
    }

    fn query(&self, space: &Regions, map: &TrapezoidMap, query: &Query) -> Run {
        let parts_of = |segment: &Segment| map.decomposition.parts_of(&map.boundary, segment);
        let mut points = ChannelPoints::default();
        let (outcome, channel, expanded) = match Terminals::new(space, query, parts_of) {
            Err(reason) => (Proposal::GaveUp(reason), Vec::new(), Vec::new()),
            Ok(terminals) => {
                let start_cells: Vec<usize> = map.decomposition.cells_at(&map.boundary, terminals.start).collect();
                let portals = &map.decomposition.portals;
                let (channel, expanded) = map.adjacency.channel(portals, &terminals, &start_cells, self.search);
                match channel {
                    None => (Proposal::NoPath, Vec::new(), expanded),
                    Some(channel) => {
                        let waypoints = match self.path {
                            PathKind::Taut => map.taut_path(&channel),
                            PathKind::Own => map.middle_path(&channel, false),
                            PathKind::Middles => map.middle_path(&channel, true),
                        };
                        let path = Path::new(waypoints);
                        points = map.points(&channel);
                        (Proposal::Found(path), channel.cells, expanded)
                    }
                }
            }
        };
        // Pictures do not show the expansions of the default search.
        let expanded = if self.search.is_default() { Vec::new() } else { expanded };
        let (kind, cells) = (CellKind::Trapezoids, Arc::clone(&map.corners));
        let size = Size::Graph { nodes: map.decomposition.cells.len(), edges: map.decomposition.portals.len() };
        Run::new(outcome, Trace::Channel { kind, cells, channel, points, expanded }, size)
    }
}

impl TrapezoidMap {
    /// Returns the centres of cells and middles of portals along a channel.
    fn points(&self, channel: &Channel) -> ChannelPoints {
        let all = |points: &[Point], numbers: &[usize]| numbers.iter().map(|&number| points[number]).collect();
        ChannelPoints {
            centers: all(&self.adjacency.centers, &channel.cells),
            middles: all(&self.adjacency.middles, &channel.portals),
        }
    }

    /// Returns the path through the middles of the portals and the centres of the cells between them. If `sparing`, it
    /// visits a centre only if it enters and leaves the cell through the same vertical side. Without the centre, it
    /// would run along that side.
    fn middle_path(&self, channel: &Channel, sparing: bool) -> Vec<Point> {
        let mut waypoints = vec![channel.start];
        for (k, &cell_portal) in channel.portals.iter().enumerate() {
            let middle = self.adjacency.middles[cell_portal];
            if k > 0 && (!sparing || waypoints[waypoints.len() - 1].x == middle.x) {
                waypoints.push(self.adjacency.centers[channel.cells[k]]);
            }
            waypoints.push(middle);
        }
        let last = waypoints[waypoints.len() - 1];
        waypoints.push(channel.goals.nearest(Measure::from(Metric::Euclidean), last));
        waypoints
    }

    /// Returns the shortest path within the channel to any of its goals.
    fn taut_path(&self, channel: &Channel) -> Vec<Point> {
        let cell_portal = |k: usize| self.decomposition.portals[channel.portals[k]];
        let portal = |k: usize| {
            let CellPortal { cells: [from, _], low, high, .. } = cell_portal(k);
            if from == channel.cells[k] { Portal { left: high, right: low } } else { Portal { left: low, right: high } }
        };
        let portals: Vec<Portal> = (0..channel.portals.len()).map(portal).collect();
        let goal = nearest_end(channel.start, &channel.goals, &portals);
        let path = turns(channel.start, goal, &portals);
        // An end of a portal in the middle of a side is rounded into free space, so a taut path along the side turns
        // there. An exact funnel path turns only at vertices, so these turns are removed.
        let is_vertex = |turn: &Turn| {
            let CellPortal { low, at_vertices, .. } = cell_portal(turn.portal);
            at_vertices[usize::from(turn.at != low)]
        };
        let mut waypoints = vec![channel.start];
        // The first portal after the last waypoint.
        let mut first = 0;
        for run in path.chunk_by(|a, b| is_vertex(a) == is_vertex(b)) {
            let after = run[run.len() - 1].portal + 1;
            if !is_vertex(&run[0]) {
                let rest = path.iter().find(|turn| turn.portal >= after);
                let (end, to) = rest.map_or((portals.len(), goal), |turn| (turn.portal, turn.at));
                if self.is_straight(channel, first..end, waypoints[waypoints.len() - 1], to) {
                    continue;
                }
            }
            waypoints.extend(run.iter().map(|turn| turn.at));
            first = after;
        }
        waypoints.push(goal);
        waypoints
    }

    /// Returns true if the straight line from `a` to `b` stays in the channel through these portals. Exact; linear
    /// in the number of portals.
    ///
    /// Only portal ends that are vertices need a check: the sides between vertices are straight, and `a`, `b` and these
    /// vertices are on their free side.
    fn is_straight(&self, channel: &Channel, portals: Range<usize>, a: Point, b: Point) -> bool {
        let mut x = a.x;
        portals.map(|k| self.decomposition.portals[channel.portals[k]]).all(
            |CellPortal { low, high, at_vertices, .. }| {
                let onwards = if a.x <= b.x { x <= low.x && low.x <= b.x } else { x >= low.x && low.x >= b.x };
                x = low.x;
                let (left, right) = if a.x <= b.x { (a, b) } else { (b, a) };
                onwards
                    && !(at_vertices[0] && orientation(left, right, low) == Orientation::CounterClockwise)
                    && !(at_vertices[1] && orientation(left, right, high) == Orientation::Clockwise)
            },
        )
    }
}
