//! Convex corners of obstacles.

use super::{next, previous};
use crate::planner::NO_ENTRY;
use cplan_geometry::planar::HalfEdges;
use cplan_geometry::{Orientation, Point, orientation};

/// A convex corner of an obstacle: a vertex with a sector of free space of more than half a turn. A vertex where
/// obstacles touch can have several sectors, and so several corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// The vertex.
    pub at: Point,
    /// The other end of the side that bounds the sector clockwise.
    pub right: Point,
    /// The other end of the side that bounds the sector counter-clockwise.
    pub left: Point,
    /// The half-edge from the vertex along the side to the right.
    pub first: u32,
}

/// The side of a line on which the obstacle at a corner lies. The line leads from another point to that corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tangency {
    /// The line enters the obstacle, so no shortest path turns here.
    None,
    /// The obstacle is to the left of the line.
    Left,
    /// The obstacle is to the right of the line.
    Right,
    /// The obstacle has no width, and the line runs along it.
    Both,
}

impl Corner {
    /// Returns the position of the obstacle relative to the line from `p`, which must not be the corner itself.
    pub fn tangency(&self, p: Point) -> Tangency {
        let sides = [self.right, self.left].map(|end| orientation(p, self.at, end));
        match (sides.contains(&Orientation::CounterClockwise), sides.contains(&Orientation::Clockwise)) {
            (true, true) => Tangency::None,
            (true, false) => Tangency::Left,
            (false, true) => Tangency::Right,
            (false, false) => Tangency::Both,
        }
    }
}

/// All convex corners, and for each half-edge the corner at its origin.
#[derive(Debug, Clone)]
pub struct Corners {
    pub list: Vec<Corner>,
    /// For each half-edge, the index of the corner at its origin. `NO_ENTRY` if the sector there is at most half a turn.
    pub of_half_edge: Vec<u32>,
}

impl Corners {
    /// Collects the corners. Linear.
    pub fn new(vertices: &[Point], edges: &HalfEdges) -> Self {
        let at = |h: u32| vertices[edges.origin[h as usize] as usize];
        let mut list = Vec::new();
        let mut of_half_edge = vec![NO_ENTRY; edges.origin.len()];
        // Sorted by vertices, neighbouring corners are close in memory.
        let mut sides: Vec<u32> =
            (0..edges.origin.len() as u32).filter(|&h| edges.twin[h as usize] == NO_ENTRY).collect();
        sides.sort_by_key(|&h| edges.origin[h as usize]);
        for first in sides {
            let mut h = first;
            while edges.twin[previous(h) as usize] != NO_ENTRY {
                h = edges.twin[previous(h) as usize];
            }
            let corner = Corner { at: at(first), right: at(next(first)), left: at(previous(h)), first };
            if !is_convex(&corner) {
                continue;
            }
            let number = list.len() as u32;
            list.push(corner);
            loop {
                of_half_edge[h as usize] = number;
                if h == first {
                    break;
                }
                h = next(edges.twin[h as usize]);
            }
        }
        Self { list, of_half_edge }
    }
}

/// Returns true if the sector of free space is more than half a turn.
fn is_convex(corner: &Corner) -> bool {
    match orientation(corner.at, corner.right, corner.left) {
        Orientation::CounterClockwise => false,
        Orientation::Clockwise => true,
        // A sector has positive width. So sides in the same direction enclose a whole turn, at the end of a wall without width.
        Orientation::Collinear => (corner.right - corner.at).dot(&(corner.left - corner.at)) > 0.0,
    }
}
