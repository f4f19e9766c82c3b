//! Trapezoidal decomposition of polygonal free space.

use super::boundary::Boundary;
use crate::geometry::{Orientation, Point, orientation};

/// A trapezoid or triangle of free space between two sides and two verticals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    /// Abscissae of its verticals.
    pub left: f64,
    pub right: f64,
    /// Sides below and above, indices into [`Boundary::sides`].
    pub floor: usize,
    pub ceiling: usize,
}

impl Cell {
    /// Whether the closed cell contains `p`; exact.
    pub fn contains(&self, boundary: &Boundary, p: Point) -> bool {
        let is_free = |side: usize| {
            let (from, to) = boundary.ends(boundary.sides[side]);
            orientation(from, to, p) != Orientation::Clockwise
        };
        self.left <= p.x && p.x <= self.right && is_free(self.floor) && is_free(self.ceiling)
    }

    /// Ordinates of floor and ceiling at the abscissa `x`, rounded into the cell.
    pub fn span(&self, boundary: &Boundary, x: f64) -> (f64, f64) {
        let [floor, ceiling] = [self.floor, self.ceiling].map(|side| boundary.ordinate(boundary.sides[side], x));
        (floor, ceiling)
    }

    /// Corners, counter-clockwise: three of a triangle, else four.
    pub fn corners(&self, boundary: &Boundary) -> Vec<Point> {
        let (left, right) = (self.span(boundary, self.left), self.span(boundary, self.right));
        let mut corners = vec![
            Point::new(self.left, left.0),
            Point::new(self.right, right.0),
            Point::new(self.right, right.1),
            Point::new(self.left, left.1),
        ];
        corners.dedup();
        if corners.first() == corners.last() {
            corners.pop();
        }
        corners
    }

    /// The centre of area, rounded into the cell.
    pub fn centroid(&self, boundary: &Boundary) -> Point {
        let (left, right) = (self.span(boundary, self.left), self.span(boundary, self.right));
        let (a, b) = (left.1 - left.0, right.1 - right.0);
        // The centre lies on the line through the middles of the parallel sides.
        let t = if a + b > 0.0 { (a + 2.0 * b) / (3.0 * (a + b)) } else { 0.5 };
        let x = (self.left + t * (self.right - self.left)).clamp(self.left, self.right);
        let (floor, ceiling) = self.span(boundary, x);
        let middle = ((1.0 - t) * (left.0 + left.1) + t * (right.0 + right.1)) / 2.0;
        Point::new(x, middle.min(ceiling).max(floor))
    }
}

/// A piece of a vertical, of positive length, that two cells share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Door {
    /// The cell to its left and the one to its right.
    pub cells: [usize; 2],
    /// Lower and upper end, in closed free space exactly.
    pub low: Point,
    pub high: Point,
}

/// Cells that do not overlap and cover closed free space, and the doors between them.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Decomposition {
    pub cells: Vec<Cell>,
    pub doors: Vec<Door>,
}

impl Decomposition {
    /// Sweeps a vertical line over free space from left to right.
    ///
    /// All vertices of one abscissa are one event, so verticals through several vertices and vertical sides need no
    /// special case: which door joins which cells follows from the order of the vertices on the line alone, which is
    /// exact. `n` vertices and at most `k` sides over any abscissa take `O(n (log n + k))`: the sides under the line
    /// are a sorted array, whose insertions cost less than a tree's up to some thousand sides.
    pub fn new(boundary: &Boundary) -> Self {
        let mut sweep = Sweep::new(boundary);
        let mut begin = 0;
        for event in boundary.vertices.chunk_by(|a, b| a.x == b.x) {
            sweep.pass(begin, event.len());
            begin += event.len();
        }
        sweep.result
    }
}

/// A side that meets the sweep line.
#[derive(Debug, Clone, Copy)]
struct Active {
    side: usize,
    /// The unfinished cell above it, if free space lies there.
    cell: Option<usize>,
}

/// Neighbouring vertices on the sweep line with no side between them that goes on, and the sides `begin..end` of the
/// status that end there.
#[derive(Debug, Clone, Copy)]
struct Cluster {
    vertices: (usize, usize),
    begin: usize,
    end: usize,
}

/// Free space between two neighbours in the status, ending or beginning at a cluster. Its ends on the line are given
/// as ranks: 0 the side below the cluster, `i` the cluster's `i`th vertex, one more than the last the side above.
#[derive(Debug, Clone, Copy)]
struct Gap {
    cell: usize,
    low: usize,
    high: usize,
}

struct Sweep<'a> {
    boundary: &'a Boundary,
    /// Sides that begin at each vertex, in order of slope, as `beginning[first[v]..first[v + 1]]`.
    beginning: Vec<usize>,
    first: Vec<usize>,
    /// Sides that meet the line, from bottom to top.
    status: Vec<Active>,
    result: Decomposition,
}

impl<'a> Sweep<'a> {
    fn new(boundary: &'a Boundary) -> Self {
        let point = |v: usize| boundary.vertices[v];
        let is_vertical = |k: usize| point(boundary.sides[k].from).x == point(boundary.sides[k].to).x;
        let mut beginning: Vec<usize> = (0..boundary.sides.len()).filter(|&k| !is_vertical(k)).collect();
        beginning.sort_by(|&a, &b| {
            let (a, b) = (boundary.sides[a], boundary.sides[b]);
            a.left_end().cmp(&b.left_end()).then_with(|| {
                match orientation(point(a.left_end()), point(a.right_end()), point(b.right_end())) {
                    Orientation::CounterClockwise => std::cmp::Ordering::Less,
                    Orientation::Collinear => std::cmp::Ordering::Equal,
                    Orientation::Clockwise => std::cmp::Ordering::Greater,
                }
            })
        });
        let starts_before = |v: usize| beginning.partition_point(|&k| boundary.sides[k].left_end() < v);
        let first = (0..=boundary.vertices.len()).map(starts_before).collect();
        Self { boundary, beginning, first, status: Vec::new(), result: Decomposition::default() }
    }

    /// Passes the vertical with vertices `begin..begin + count`.
    fn pass(&mut self, begin: usize, count: usize) {
        let mut clusters: Vec<Cluster> = Vec::new();
        for v in begin..begin + count {
            let below = self.status.partition_point(|active| self.is_below(active.side, v));
            let ending =
                self.status[below..].iter().take_while(|a| self.boundary.sides[a.side].right_end() == v).count();
            match clusters.last_mut() {
                Some(last) if below <= last.end => {
                    last.vertices.1 = v + 1;
                    last.end = last.end.max(below + ending);
                }
                _ => clusters.push(Cluster { vertices: (v, v + 1), begin: below, end: below + ending }),
            }
        }
        // From the top, so that places in the status below remain.
        for cluster in clusters.into_iter().rev() {
            self.replace(cluster);
        }
    }

    /// Whether vertex `v`, which is on the sweep line, is strictly above a side in the status.
    fn is_below(&self, side: usize, v: usize) -> bool {
        let (vertices, side) = (&self.boundary.vertices, self.boundary.sides[side]);
        let (left, right) = (vertices[side.left_end()], vertices[side.right_end()]);
        orientation(left, right, vertices[v]) == Orientation::CounterClockwise
    }

    /// Ends the cells left of a cluster, replaces the sides that end there by those that begin, starts the cells to
    /// the right and joins them by doors.
    fn replace(&mut self, cluster: Cluster) {
        let (begin, end) = (cluster.begin, cluster.end);
        let (first, last) = cluster.vertices;
        let x = self.boundary.vertices[first].x;
        let top = last - first + 1;

        let rank_of = |v: usize| if (first..last).contains(&v) { v - first + 1 } else { 0 };
        let mut left = Vec::new();
        for above in begin..=end.min(self.status.len().saturating_sub(1)) {
            let Some(Active { side, cell: Some(cell) }) = above.checked_sub(1).map(|below| self.status[below]) else {
                continue;
            };
            self.result.cells[cell].right = x;
            let rank = |k: usize| rank_of(self.boundary.sides[k].right_end());
            let low = if above == begin { 0 } else { rank(side) };
            let high = if above == end { top } else { rank(self.status[above].side) };
            left.push(Gap { cell, low, high });
        }

        let fresh: Vec<Active> = self.beginning[self.first[first]..self.first[last]]
            .iter()
            .map(|&side| Active { side, cell: None })
            .collect();
        let fresh_end = begin + fresh.len();
        self.status.splice(begin..end, fresh);
        let mut right = Vec::new();
        for above in begin.max(1)..=fresh_end.min(self.status.len().saturating_sub(1)) {
            let (floor, ceiling) = (self.status[above - 1].side, self.status[above].side);
            let sides = &self.boundary.sides;
            if !sides[floor].is_floor() || sides[ceiling].is_floor() {
                continue;
            }
            let cell = self.result.cells.len();
            self.result.cells.push(Cell { left: x, right: x, floor, ceiling });
            self.status[above - 1].cell = Some(cell);
            let low = if above == begin { 0 } else { rank_of(sides[floor].left_end()) };
            let high = if above == fresh_end { top } else { rank_of(sides[ceiling].left_end()) };
            right.push(Gap { cell, low, high });
        }
        self.join(cluster, &left, &right);
    }

    /// A door wherever a gap on the left and one on the right, both in ascending order, overlap.
    fn join(&mut self, cluster: Cluster, left: &[Gap], right: &[Gap]) {
        let (mut i, mut j) = (0, 0);
        while i < left.len() && j < right.len() {
            let (a, b) = (left[i], right[j]);
            let (low, high) = (a.low.max(b.low), a.high.min(b.high));
            if low < high {
                let sides = &self.result.cells[a.cell];
                let (low, high) = self.door_ends(cluster, (low, sides.floor), (high, sides.ceiling));
                self.result.doors.push(Door { cells: [a.cell, b.cell], low, high });
            }
            if a.high <= b.high {
                i += 1;
            } else {
                j += 1;
            }
        }
    }

    /// The points at two ranks; those of the outermost ranks lie on the given sides.
    fn door_ends(&self, cluster: Cluster, low: (usize, usize), high: (usize, usize)) -> (Point, Point) {
        let (first, last) = cluster.vertices;
        let vertices = &self.boundary.vertices;
        let x = vertices[first].x;
        let on_side = |k: usize| Point::new(x, self.boundary.ordinate(self.boundary.sides[k], x));
        let vertex = |rank: usize| (1..=last - first).contains(&rank).then(|| vertices[first + rank - 1]);
        // Rounding may put a point on a side beyond a vertex that is within rounding of it.
        match (vertex(low.0), vertex(high.0)) {
            (Some(a), Some(b)) => (a, b),
            (Some(a), None) => (a, Point::new(x, on_side(high.1).y.max(a.y))),
            (None, Some(b)) => (Point::new(x, on_side(low.1).y.min(b.y)), b),
            (None, None) => (on_side(low.1), on_side(high.1)),
        }
    }
}
