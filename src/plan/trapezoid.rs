//! Paths by exact cell decomposition: trapezoids, a channel, a taut string.

use super::boundary::Boundary;
use super::channel::{Adjacency, Channel};
use super::decomposition::{Decomposition, Door};
use super::funnel::{Passage, taut_string};
use super::terminals::Terminals;
use super::{Outcome, Planner, Query, Run, Size, Trace};
use crate::cspace::Regions;
use crate::geometry::Point;
use crate::space::{Configuration, Path};

/// The *trapezoidal decomposition*: finds a channel of cells from start to goal whenever there is one, and a path in it.
///
/// Cells are joined where they share a piece of vertical of positive length (a *door*). A* finds the channel; passing
/// from a cell to the next costs the way from the one's centre over the door's middle to the other's, with start and
/// goal for the centres of the end cells (Latombe, *Robot Motion Planning*, 1991, section 5.1). The path is free but
/// not the shortest, even when taut: another channel may hold a shorter one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Trapezoid {
    /// Whether the path is pulled taut within the channel, so that it may touch obstacles. Otherwise it leads through
    /// the middles of doors, and between two doors on one vertical through the centre of the cell.
    pub taut: bool,
}

impl Default for Trapezoid {
    fn default() -> Self {
        Self { taut: true }
    }
}

/// A decomposition and the adjacency of its cells.
#[derive(Debug, Clone)]
pub struct TrapezoidMap {
    boundary: Boundary,
    decomposition: Decomposition,
    /// Corners of the cells.
    corners: Vec<Vec<Configuration>>,
    adjacency: Adjacency,
}

impl Planner for Trapezoid {
    const NAME: &'static str = "trapezoid";
    type Space = Regions;
    type Map = TrapezoidMap;

    fn build(&self, space: &Regions) -> TrapezoidMap {
        let boundary = Boundary::new(space);
        let decomposition = Decomposition::new(&boundary);
        let corners_of = |points: Vec<Point>| points.into_iter().map(|p| p.coords).collect();
        let corners = decomposition.cells.iter().map(|cell| corners_of(cell.corners(&boundary))).collect();
        let centers = decomposition.cells.iter().map(|cell| cell.centroid(&boundary)).collect();
        let adjacency = Adjacency::new(&decomposition, centers);
        TrapezoidMap { boundary, decomposition, corners, adjacency }
    }

    fn query(&self, space: &Regions, map: &TrapezoidMap, query: &Query) -> Run {
        let cells_at = |p| map.decomposition.cells_at(&map.boundary, p);
        let (outcome, channel) = match Terminals::new(space, query, |p| cells_at(p).next().is_some()) {
            Err(reason) => (Outcome::GaveUp(reason), Vec::new()),
            Ok(terminals) => {
                let start_cells: Vec<usize> = cells_at(terminals.start).collect();
                let goal_cells: Vec<(usize, Point)> =
                    terminals.goals.iter().flat_map(|&goal| cells_at(goal).map(move |cell| (cell, goal))).collect();
                let doors = &map.decomposition.doors;
                match map.adjacency.channel(doors, &terminals, &start_cells, &goal_cells) {
                    None => (Outcome::NoPath, Vec::new()),
                    Some(channel) => {
                        let waypoints = if self.taut { map.taut_path(&channel) } else { map.middle_path(&channel) };
                        let path = Path::new(waypoints.into_iter().map(|p| p.coords).collect());
                        (Outcome::Found(path), channel.cells)
                    }
                }
            }
        };
        Run {
            outcome,
            trace: Trace::Channel { cells: map.corners.clone(), channel },
            size: Size::Graph { nodes: map.decomposition.cells.len(), edges: map.decomposition.doors.len() },
            note: None,
        }
    }
}

impl TrapezoidMap {
    /// Through the middles of the doors, and the centre of a cell that is left on the vertical on which it was entered.
    fn middle_path(&self, channel: &Channel) -> Vec<Point> {
        let mut waypoints = vec![channel.start];
        for (k, &door) in channel.doors.iter().enumerate() {
            let middle = self.adjacency.middles[door];
            if k > 0 && self.adjacency.middles[channel.doors[k - 1]].x == middle.x {
                waypoints.push(self.adjacency.centers[channel.cells[k]]);
            }
            waypoints.push(middle);
        }
        waypoints.push(channel.goal);
        waypoints
    }

    /// The shortest way within the channel.
    fn taut_path(&self, channel: &Channel) -> Vec<Point> {
        let passage = |(&door, &cell): (&usize, &usize)| {
            let Door { cells: [from, _], low, high, at_vertices } = self.decomposition.doors[door];
            // An end in the middle of a side is no bound: a string that turns at vertices only, all of them on the free
            // side of the line through that side, cannot pass beyond it; and it has been rounded.
            let low = at_vertices[0].then_some(low);
            let high = at_vertices[1].then_some(high);
            if from == cell { Passage { left: high, right: low } } else { Passage { left: low, right: high } }
        };
        let passages: Vec<Passage> = channel.doors.iter().zip(&channel.cells).map(passage).collect();
        taut_string(channel.start, channel.goal, &passages)
    }
}
