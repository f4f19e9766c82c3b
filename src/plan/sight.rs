//! Which points of free space see each other.

use super::boundary::{Boundary, is_between};
use super::segment_grid::SegmentGrid;
use crate::geometry::{Orientation, Point, orientation};
use std::ops::ControlFlow;

/// The boundary of free space, indexed for visibility tests.
///
/// Two points see each other if the segment between them is a limit of segments in the interior of free space: it may
/// touch corners of obstacles and run along sides, but not squeeze between obstacles that touch in a corner. All signs
/// are exact.
#[derive(Debug, Clone)]
pub(super) struct Sight {
    boundary: Boundary,
    grid: SegmentGrid,
}

impl Sight {
    pub fn new(boundary: Boundary) -> Self {
        let grid = SegmentGrid::new(boundary.sides.iter().map(|&side| boundary.ends(side)));
        Self { boundary, grid }
    }

    pub fn boundary(&self) -> &Boundary {
        &self.boundary
    }

    /// Whether two points of closed free space see each other. Takes time in the number of grid cells passed and sides
    /// in them.
    pub fn sees(&self, p: Point, q: Point) -> bool {
        p == q || (self.leaves(p, q) && self.leaves(q, p) && self.is_unobstructed(p, q))
    }

    /// Whether the direction from `p` to `q` leads into closed free space, where `p` is a vertex.
    fn leaves(&self, p: Point, q: Point) -> bool {
        let Some(v) = self.boundary.vertex_at(p) else { return true };
        self.boundary.sectors(v).iter().any(|sector| sector.contains(p, q))
    }

    /// Like [`Sight::sees`] for different points where those that are vertices are known to leave into free space.
    pub fn is_unobstructed(&self, p: Point, q: Point) -> bool {
        self.grid.along(p, q, |k| if self.blocks(k, p, q) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
            == ControlFlow::Continue(())
    }

    /// Whether side `k` or one of its ends stands between `p` and `q`.
    fn blocks(&self, k: usize, p: Point, q: Point) -> bool {
        let side = self.boundary.sides[k];
        let (from, to) = self.boundary.ends(side);
        let (turn_from, turn_to) = (orientation(p, q, from), orientation(p, q, to));
        if turn_from == Orientation::Collinear && self.closes_at(side.from, p, q) {
            return true;
        }
        if turn_to == Orientation::Collinear && self.closes_at(side.to, p, q) {
            return true;
        }
        if turn_from == turn_to || turn_from == Orientation::Collinear || turn_to == Orientation::Collinear {
            return false;
        }
        // The line crosses the side. A point on the side itself blocks only a way out to the right of it.
        let (turn_p, turn_q) = (orientation(from, to, p), orientation(from, to, q));
        match (turn_p, turn_q) {
            (Orientation::Collinear, other) | (other, Orientation::Collinear) => other == Orientation::Clockwise,
            _ => turn_p != turn_q,
        }
    }

    /// Whether the way from `p` to `q` passes vertex `v`, which is collinear with them, and no free sector holds both
    /// of its directions there.
    fn closes_at(&self, v: usize, p: Point, q: Point) -> bool {
        let at = self.boundary.vertices[v];
        is_between(at, p, q)
            && !self.boundary.sectors(v).iter().any(|sector| sector.contains(at, p) && sector.contains(at, q))
    }
}
