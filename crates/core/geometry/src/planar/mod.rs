//! The boundary of a polygonal region as a planar graph: distinct vertices, and directed sides that meet in vertices only.
//!
//! `noding` cuts sides where they touch, or where rounding has made them cross slightly. `triangulation` triangulates
//! the region. All sweeps keep the sides under the sweep line in the same balanced tree, `status`.

mod noding;
mod simplicity;
mod status;
mod triangulation;

pub(super) use simplicity::first_meeting;
pub use status::Status;
pub use triangulation::{HalfEdges, triangulate};

use super::{Orientation, Point, orientation};
use std::cmp::Ordering;
use std::ops::Range;

/// Represents an empty entry in tables of indices.
pub const NO_ENTRY: u32 = u32::MAX;

/// A side of the boundary, by vertex numbers. The inside (for planners: free space) lies to its left.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Side {
    /// The vertex where it starts.
    pub from: u32,
    /// The vertex where it ends.
    pub to: u32,
}

impl Side {
    /// Returns the end with the lesser abscissa, or the lower end of a vertical side. Vertices are numbered in that
    /// order.
    pub fn left_end(self) -> usize {
        self.from.min(self.to) as usize
    }

    /// Returns the other end.
    pub fn right_end(self) -> usize {
        self.from.max(self.to) as usize
    }

    /// Returns true if the side is directed to the right, so that the inside lies above it.
    pub fn is_floor(self) -> bool {
        self.from < self.to
    }
}

/// Distinct vertices in lexicographic order, and directed sides that meet in vertices only.
///
/// Where contours touch (in a common corner, or in a corner on a side), sides are cut. The sides that end at a point
/// then determine where the inside is, whatever the order of the contours' corners.
///
/// Sides must not cross or overlap, as in the result of a polygon union. Sides that cross only because of rounding are cut, and
/// joined at the corner next to the crossing. Two coincident sides, where obstacles touch along a side, are allowed.
#[derive(Debug, Clone)]
pub struct Boundary {
    /// The vertices, distinct and in lexicographic order.
    pub vertices: Vec<Point>,
    /// The sides, sorted by left end, and from bottom to top if the left end is the same.
    pub sides: Vec<Side>,
    /// The sides that begin at vertex `v` are `first[v]..first[v + 1]`.
    first: Vec<u32>,
    /// Numbers of the sides, sorted by right end, and from bottom to top if the right end is the same. The sides that
    /// end at vertex `v` are `by_right_end[last[v]..last[v + 1]]`.
    by_right_end: Vec<u32>,
    last: Vec<u32>,
    /// For each vertex, the side straight below it that does not end there, or `NO_ENTRY`.
    below: Vec<u32>,
}

impl Boundary {
    /// Builds the boundary of contours that have the inside to their left. `O(n log n)` for `n` corners.
    pub fn new(contours: &[&[Point]]) -> Self {
        noding::planar(Self::unordered(contours))
    }

    /// Collects vertices and sides, in arbitrary order, without the lists by vertex.
    fn unordered(contours: &[&[Point]]) -> Self {
        let mut order: Vec<(Point, u32)> =
            contours.iter().copied().flatten().zip(0..).map(|(p, index)| (unsigned_zero(*p), index)).collect();
        order.sort_unstable_by(|a, b| lexicographic(a.0, b.0).then(a.1.cmp(&b.1)));
        let mut vertices: Vec<Point> = Vec::with_capacity(order.len());
        let mut number = vec![0; order.len()];
        for (p, index) in order {
            if vertices.last() != Some(&p) {
                vertices.push(p);
            }
            number[index as usize] = vertices.len() as u32 - 1;
        }
        let mut sides = Vec::with_capacity(number.len());
        let mut begin = 0;
        for contour in contours {
            let numbers = &number[begin..begin + contour.len()];
            let next = numbers.iter().cycle().skip(1);
            sides.extend(numbers.iter().zip(next).filter(|(a, b)| a != b).map(|(&from, &to)| Side { from, to }));
            begin += contour.len();
        }
        Self { vertices, sides, first: vec![], by_right_end: vec![], last: vec![], below: vec![] }
    }

    /// Builds the first `count` sides of a ring of distinct corners, without cutting. Side `i` runs from corner `i`
    /// to the next one.
    fn of_chain(ring: &[Point], count: usize) -> Self {
        let mut this = Self::unordered(&[ring]);
        this.sides.truncate(count);
        this.arrange();
        this
    }

    /// Sorts the sides and builds the lists by vertex.
    fn arrange(&mut self) {
        let point = |v: usize| self.vertices[v];
        self.sides.sort_unstable_by(|a, b| {
            let slopes = || below_at(point(a.left_end()), point(a.right_end()), point(b.right_end()));
            a.left_end().cmp(&b.left_end()).then_with(slopes).then(a.right_end().cmp(&b.right_end())).then(a.cmp(b))
        });
        self.sides.dedup();
        self.first = starts(self.vertices.len(), self.sides.iter().map(|side| side.left_end()));
        self.last = starts(self.vertices.len(), self.sides.iter().map(|side| side.right_end()));
        let mut place = self.last.clone();
        self.by_right_end = vec![0; self.sides.len()];
        for (k, side) in self.sides.iter().enumerate() {
            let slot = &mut place[side.right_end()];
            self.by_right_end[*slot as usize] = k as u32;
            *slot += 1;
        }
        for v in 0..self.vertices.len() {
            let group = &mut self.by_right_end[self.last[v] as usize..self.last[v + 1] as usize];
            if group.len() > 1 {
                let left = |k: u32| self.vertices[self.sides[k as usize].left_end()];
                // Seen from the right end, the lower side is counter-clockwise of the other.
                group.sort_by(|&a, &b| below_at(self.vertices[v], left(b), left(a)).then(a.cmp(&b)));
            }
        }
    }

    /// Returns the sides that start at vertex `v` and run to the right, from bottom to top.
    pub fn beginning(&self, v: usize) -> Range<usize> {
        self.first[v] as usize..self.first[v + 1] as usize
    }

    /// Iterates over the sides that end at vertex `v` and come from the left, from bottom to top.
    pub fn ending(&self, v: usize) -> impl DoubleEndedIterator<Item = usize> + Clone + '_ {
        self.by_right_end[self.last[v] as usize..self.last[v + 1] as usize].iter().map(|&side| side as usize)
    }

    /// Returns the side straight below vertex `v` that does not end there, if any.
    pub fn below(&self, v: usize) -> Option<usize> {
        (self.below[v] != NO_ENTRY).then_some(self.below[v] as usize)
    }

    /// Stores the sides that [`Boundary::below`] returns.
    fn set_below(&mut self, below: Vec<u32>) {
        self.below = below;
    }

    /// Returns the ends of a side.
    pub fn ends(&self, side: usize) -> (Point, Point) {
        (self.vertices[self.sides[side].from as usize], self.vertices[self.sides[side].to as usize])
    }

    /// Returns the position of `p` relative to the line through a side, directed to the right. Counter-clockwise
    /// means above the line.
    pub fn place(&self, side: usize, p: Point) -> Orientation {
        let side = self.sides[side];
        orientation(self.vertices[side.left_end()], self.vertices[side.right_end()], p)
    }

    /// Returns true if a side is vertical.
    pub fn is_vertical(&self, side: usize) -> bool {
        let (from, to) = self.ends(side);
        from.x == to.x
    }

    /// Returns the ordinate of a side at the abscissa `x`. The side must not be vertical, and `x` must be within its
    /// range. The ordinate is rounded *inwards*: the point `(x, y)` lies exactly on the side, or inside.
    pub fn ordinate(&self, side: usize, x: f64) -> f64 {
        let is_floor = self.sides[side].is_floor();
        let (from, to) = self.ends(side);
        let (a, b) = if is_floor { (from, to) } else { (to, from) };
        if x <= a.x {
            return a.y;
        }
        if x >= b.x {
            return b.y;
        }
        let (low, high) = (a.y.min(b.y), a.y.max(b.y));
        let mut y = (a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x))).clamp(low, high);
        // The step doubles from the size of the rounding error, so it eventually reaches the far end, which is inside.
        let mut step = f64::EPSILON * low.abs().max(high.abs()).max(f64::MIN_POSITIVE);
        while orientation(from, to, Point::new(x, y)) == Orientation::Clockwise {
            y = if is_floor { (y + step).min(high) } else { (y - step).max(low) };
            step *= 2.0;
        }
        y
    }
}

/// Compares points by abscissa, then by ordinate.
fn lexicographic(a: Point, b: Point) -> Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
}

/// Replaces `-0.0` by `0.0`, because they would be sorted differently.
fn unsigned_zero(p: Point) -> Point {
    Point::new(p.x + 0.0, p.y + 0.0)
}

/// Compares two segments that start at `apex` and run to the right, by slope.
fn below_at(apex: Point, a: Point, b: Point) -> Ordering {
    match orientation(apex, a, b) {
        Orientation::CounterClockwise => Ordering::Less,
        Orientation::Collinear => Ordering::Equal,
        Orientation::Clockwise => Ordering::Greater,
    }
}

/// Returns, for each number from 0 to `count`, how many `keys` are less than it.
pub fn starts(count: usize, keys: impl Iterator<Item = usize>) -> Vec<u32> {
    let mut starts = vec![0; count + 1];
    for key in keys {
        starts[key + 1] += 1;
    }
    for k in 0..count {
        starts[k + 1] += starts[k];
    }
    starts
}
