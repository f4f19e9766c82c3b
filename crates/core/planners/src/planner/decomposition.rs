//! Trapezoidal decomposition of polygonal free space.

use super::NO_ENTRY;
use cplan_geometry::planar::{Boundary, Status};
use cplan_geometry::{Orientation, Point, orientation};
use cplan_interrupt::checkpoint;
use cplan_model::space::Segment;

/// A trapezoid or triangle of free space between two vertical lines and two sides of the boundary.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    /// Abscissae of the vertical lines.
    pub left: f64,
    pub right: f64,
    /// The sides below and above, as indices into [`Boundary::sides`].
    pub floor: usize,
    pub ceiling: usize,
}

impl Cell {
    /// Returns true if the closed cell contains `p`; exact.
    pub fn contains(&self, boundary: &Boundary, p: Point) -> bool {
        let is_free = |side: usize| {
            let (from, to) = boundary.ends(side);
            orientation(from, to, p) != Orientation::Clockwise
        };
        self.left <= p.x && p.x <= self.right && is_free(self.floor) && is_free(self.ceiling)
    }

    /// Returns the part of a segment in the closed cell; `None` if there is none.
    fn part(&self, boundary: &Boundary, segment: &Segment) -> Option<Segment> {
        let infinite = f64::INFINITY;
        let between = segment.within([self.left, -infinite], [self.right, infinite])?;
        let (floor, ceiling) = (boundary.ends(self.floor), boundary.ends(self.ceiling));
        between.left_of(floor.0, floor.1)?.left_of(ceiling.0, ceiling.1)
    }

    /// Returns the ordinates of floor and ceiling at the abscissa `x`, rounded into the cell.
    pub fn span(&self, boundary: &Boundary, x: f64) -> (f64, f64) {
        let [floor, ceiling] = [self.floor, self.ceiling].map(|side| boundary.ordinate(side, x));
        (floor, ceiling)
    }

    /// Returns the corners, counter-clockwise: three or four.
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

    /// Returns the centroid, rounded to lie within the cell.
    pub fn centroid(&self, boundary: &Boundary) -> Point {
        let (left, right) = (self.span(boundary, self.left), self.span(boundary, self.right));
        let (a, b) = (left.1 - left.0, right.1 - right.0);
        // The centroid lies on the line through the middles of the parallel sides.
        let t = if a + b > 0.0 { (a + 2.0 * b) / (3.0 * (a + b)) } else { 0.5 };
        let x = (self.left + t * (self.right - self.left)).clamp(self.left, self.right);
        let (floor, ceiling) = self.span(boundary, x);
        let middle = ((1.0 - t) * (left.0 + left.1) + t * (right.0 + right.1)) / 2.0;
        Point::new(x, middle.min(ceiling).max(floor))
    }
}

/// A piece of a vertical line, of positive length, that two cells have in common.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CellPortal {
    /// The cells to the left and to the right of the portal.
    pub cells: [usize; 2],
    /// Lower and upper end. The ends lie exactly in closed free space.
    pub low: Point,
    pub high: Point,
    /// For each end, true if it is a vertex, and false if it is another point of a side.
    pub at_vertices: [bool; 2],
}

/// Cells that cover closed free space without overlapping, and the portals between them.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Decomposition {
    pub cells: Vec<Cell>,
    pub portals: Vec<CellPortal>,
}

impl Decomposition {
    /// Sweeps a vertical line over free space from left to right, `O(n log n)` for `n` vertices.
    ///
    /// All vertices with the same abscissa are one event. So vertical lines through several vertices, and vertical sides, need
    /// no special case. The order of the vertices on the line, which is exact, determines the cells that a portal joins.
    pub fn new(boundary: &Boundary) -> Self {
        let sides = boundary.sides.len();
        let (status, cell_above) = (Status::new(sides), vec![NO_ENTRY; sides]);
        let mut sweep = Sweep { boundary, status, cell_above, result: Decomposition::default() };
        let mut begin = 0;
        for event in boundary.vertices.chunk_by(|a, b| a.x == b.x) {
            checkpoint();
            sweep.pass(begin, event.len());
            begin += event.len();
        }
        sweep.result
    }

    /// Returns the cells that contain `p`, borders included. Exact; linear in the number of cells.
    pub fn cells_at<'a>(&'a self, boundary: &'a Boundary, p: Point) -> impl Iterator<Item = usize> + 'a {
        (0..self.cells.len()).filter(move |&cell| self.cells[cell].contains(boundary, p))
    }

    /// Returns the cells that contain a part of a segment, each with that part. Linear in the number of cells.
    pub fn parts_of(&self, boundary: &Boundary, segment: &Segment) -> Vec<(u32, Segment)> {
        if segment.is_point() {
            let [at, _] = segment.ends();
            return self.cells_at(boundary, at).map(|cell| (cell as u32, *segment)).collect();
        }
        let part = |(cell, number): (&Cell, u32)| Some((number, cell.part(boundary, segment)?));
        self.cells.iter().zip(0..).filter_map(part).collect()
    }
}

/// A run of neighbouring vertices on the sweep line, between two sides that continue across the line. All sides between
/// these two begin or end at one of the vertices.
#[derive(Debug, Clone, Copy)]
struct Cluster {
    vertices: (usize, usize),
    below: Option<usize>,
    above: Option<usize>,
}

/// A gap of free space between two neighbouring sides that ends or begins at a cluster. Ranks state its two ends on the
/// sweep line: 0 for the side below the cluster, `i` for its `i`th vertex, and one more than the number of vertices for
/// the side above.
#[derive(Debug, Clone, Copy)]
struct Gap {
    cell: usize,
    low: usize,
    high: usize,
}

struct Sweep<'a> {
    boundary: &'a Boundary,
    /// The sides that meet the sweep line, from bottom to top, without vertical ones.
    status: Status,
    /// For each side in `status`, the unfinished cell above it, or `NO_ENTRY` if an obstacle is above it.
    cell_above: Vec<u32>,
    result: Decomposition,
}

impl Sweep<'_> {
    /// Moves the sweep line past the vertices `begin..begin + count`, which have the same abscissa.
    fn pass(&mut self, begin: usize, count: usize) {
        let boundary = self.boundary;
        let mut clusters: Vec<Cluster> = Vec::new();
        for v in begin..begin + count {
            let at = boundary.vertices[v];
            let mut ending = boundary.ending(v).filter(|&side| !boundary.is_vertical(side));
            let (lowest, highest) = (ending.next(), ending.next_back());
            let below = match lowest {
                Some(lowest) => self.status.below(lowest),
                None => self.status.last_where(|side| boundary.place(side, at) == Orientation::CounterClockwise),
            };
            let above = self.status.above(highest.or(lowest).or(below));
            // The vertex joins the last cluster if the same continuing side is next below both, or if the side below it
            // ends at a vertex of the cluster.
            let joins = |last: &Cluster| {
                below == last.below
                    || below.is_some_and(|side| boundary.sides[side].right_end() >= last.vertices.0)
                        && below.is_some_and(|side| boundary.sides[side].right_end() < v)
            };
            match clusters.last_mut().filter(|last| joins(last)) {
                Some(last) => (last.vertices.1, last.above) = (v + 1, above),
                None => clusters.push(Cluster { vertices: (v, v + 1), below, above }),
            }
        }
        for cluster in clusters {
            self.replace(cluster);
        }
    }

    /// Moves the sweep line past a cluster: finishes the cells to the left, replaces the sides that end by those that
    /// begin, starts the cells to the right, and joins the cells by portals.
    fn replace(&mut self, cluster: Cluster) {
        let (first, last) = cluster.vertices;
        let x = self.boundary.vertices[first].x;
        let left = self.gaps(cluster, |side| self.boundary.sides[side].right_end());
        for gap in &left {
            self.result.cells[gap.cell].right = x;
        }
        for v in first..last {
            for side in self.boundary.ending(v).filter(|&side| !self.boundary.is_vertical(side)) {
                self.status.remove(side);
            }
        }
        let mut at = cluster.below;
        for side in (first..last).flat_map(|v| self.boundary.beginning(v)) {
            if !self.boundary.is_vertical(side) {
                self.status.insert_above(at, side);
                at = Some(side);
            }
        }
        let mut floor = cluster.below;
        loop {
            let ceiling = self.status.above(floor);
            if let Some(floor) = floor {
                self.cell_above[floor] = ceiling.map_or(NO_ENTRY, |ceiling| self.begin(floor, ceiling, x));
            }
            if ceiling.is_none() || ceiling == cluster.above {
                break;
            }
            floor = ceiling;
        }
        let right = self.gaps(cluster, |side| self.boundary.sides[side].left_end());
        self.join(cluster, &left, &right);
    }

    /// Starts a cell between two sides, and returns its number. `NO_ENTRY` if the area is an obstacle.
    fn begin(&mut self, floor: usize, ceiling: usize, x: f64) -> u32 {
        let sides = &self.boundary.sides;
        if !sides[floor].is_floor() || sides[ceiling].is_floor() || is_slit(self.boundary, floor, ceiling) {
            return NO_ENTRY;
        }
        self.result.cells.push(Cell { left: x, right: x, floor, ceiling });
        self.result.cells.len() as u32 - 1
    }

    /// Returns the gaps at a cluster, from bottom to top. `end` gives the vertex at which a side ends on the sweep
    /// line.
    fn gaps(&self, cluster: Cluster, end: impl Fn(usize) -> usize) -> Vec<Gap> {
        let (first, last) = cluster.vertices;
        // A side without an end here lies between sides that end here only if sides cross.
        let rank = |side: usize| end(side).checked_sub(first).map_or(0, |k| (k + 1).min(last - first + 1));
        let mut gaps = Vec::new();
        let mut floor = cluster.below;
        loop {
            let ceiling = self.status.above(floor);
            if let Some(under) = floor.filter(|&side| self.cell_above[side] != NO_ENTRY) {
                let low = if floor == cluster.below { 0 } else { rank(under) };
                let high = match ceiling.filter(|_| ceiling != cluster.above) {
                    Some(over) => rank(over),
                    None => last - first + 1,
                };
                gaps.push(Gap { cell: self.cell_above[under] as usize, low, high });
            }
            if ceiling.is_none() || ceiling == cluster.above {
                return gaps;
            }
            floor = ceiling;
        }
    }

    /// Adds a portal wherever a gap on the left and one on the right overlap. Both lists are in ascending order.
    fn join(&mut self, cluster: Cluster, left: &[Gap], right: &[Gap]) {
        let (mut i, mut j) = (0, 0);
        while i < left.len() && j < right.len() {
            let (a, b) = (left[i], right[j]);
            let (low, high) = (a.low.max(b.low), a.high.min(b.high));
            if low < high {
                let portal = self.portal(cluster, [a.cell, b.cell], low, high);
                self.result.portals.push(portal);
            }
            if a.high <= b.high {
                i += 1;
            } else {
                j += 1;
            }
        }
    }

    /// Returns the portal between two cells, from the rank `low` to the rank `high` (see [`Gap`]).
    fn portal(&self, cluster: Cluster, cells: [usize; 2], low: usize, high: usize) -> CellPortal {
        let (first, last) = cluster.vertices;
        let vertices = &self.boundary.vertices;
        let x = vertices[first].x;
        let Cell { floor, ceiling, .. } = self.result.cells[cells[0]];
        let on_side = |side: usize| Point::new(x, self.boundary.ordinate(side, x));
        let vertex = |rank: usize| (1..=last - first).contains(&rank).then(|| vertices[first + rank - 1]);
        let ends = (vertex(low), vertex(high));
        // Rounding may move a point of a side beyond a vertex that is very close to the side.
        let (low, high) = match ends {
            (Some(a), Some(b)) => (a, b),
            (Some(a), None) => (a, Point::new(x, on_side(ceiling).y.max(a.y))),
            (None, Some(b)) => (Point::new(x, on_side(floor).y.min(b.y)), b),
            (None, None) => (on_side(floor), on_side(ceiling)),
        };
        CellPortal { cells, low, high, at_vertices: [ends.0.is_some(), ends.1.is_some()] }
    }
}

/// Returns true if two sides coincide, so that there is no area between them.
fn is_slit(boundary: &Boundary, floor: usize, ceiling: usize) -> bool {
    let (floor, ceiling) = (boundary.sides[floor], boundary.sides[ceiling]);
    (floor.from, floor.to) == (ceiling.to, ceiling.from)
}
