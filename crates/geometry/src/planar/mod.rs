//! Polygons with holes as distinct vertices and directed sides that meet in vertices, and their triangulation.
//!
//! Sides that touch, or that the rounding of their corners has made cross by a hair, are cut and joined there (`noding`).
//! All sweeps keep the sides under the line in the same balanced tree (`status`).

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

/// No index, in tables of indices.
pub const NONE: u32 = u32::MAX;

/// A side of the boundary, by vertex number; the inside (for planners free space) lies to the left of its direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Side {
    /// Where it begins.
    pub from: u32,
    /// Where it ends.
    pub to: u32,
}

impl Side {
    /// End with the lesser abscissa (on a vertical side the lower one): vertices are numbered in that order.
    pub fn left_end(self) -> usize {
        self.from.min(self.to) as usize
    }

    /// The other end.
    pub fn right_end(self) -> usize {
        self.from.max(self.to) as usize
    }

    /// Whether it is directed to the right, so that the inside lies above.
    pub fn is_floor(self) -> bool {
        self.from < self.to
    }
}

/// Distinct vertices in lexicographic order, directed sides that meet in vertices only.
///
/// Contours that touch (in a shared corner, or a corner on a side) are cut there, so that what is inside around a point
/// is told by the sides that end there, whichever way the contours were traced. Sides must not cross or overlap each
/// other, which holds for the result of any polygon union; where the rounding of its corners has made them cross by a
/// hair, they are cut and joined at the corner next to the crossing. Two coincident sides, where obstacles touch along
/// a side, are allowed.
#[derive(Debug, Clone)]
pub struct Boundary {
    /// Distinct, in lexicographic order.
    pub vertices: Vec<Point>,
    /// By left end, and of one left end from bottom to top.
    pub sides: Vec<Side>,
    /// The sides that begin at vertex `v` are `first[v]..first[v + 1]`.
    first: Vec<u32>,
    /// Sides by right end, of one right end from bottom to top: those of `v` are `last[v]..last[v + 1]` of them.
    by_right_end: Vec<u32>,
    last: Vec<u32>,
    /// For every vertex the side straight below that does not end there, or `NONE`.
    below: Vec<u32>,
}

impl Boundary {
    /// Of contours with the inside to the left, `O(n log n)` for `n` corners.
    #[must_use]
    pub fn new(contours: &[&[Point]]) -> Self {
        noding::planar(Self::bare(contours))
    }

    /// Vertices and sides in no order.
    fn bare(contours: &[&[Point]]) -> Self {
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

    /// Of the first `count` sides of a ring of distinct corners, each from a corner to the next one; nothing is cut.
    fn of_chain(ring: &[Point], count: usize) -> Self {
        let mut this = Self::bare(&[ring]);
        this.sides.truncate(count);
        this.arrange();
        this
    }

    /// Puts the sides in order and sets up the lists by vertex.
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
                // Seen from the right end the lower side is the one counter-clockwise of the other.
                group.sort_by(|&a, &b| below_at(self.vertices[v], left(b), left(a)).then(a.cmp(&b)));
            }
        }
    }

    /// Sides that begin at vertex `v`, going to the right, from bottom to top.
    pub fn beginning(&self, v: usize) -> Range<usize> {
        self.first[v] as usize..self.first[v + 1] as usize
    }

    /// Sides that end at vertex `v`, coming from the left, from bottom to top.
    pub fn ending(&self, v: usize) -> impl DoubleEndedIterator<Item = usize> + Clone + '_ {
        self.by_right_end[self.last[v] as usize..self.last[v + 1] as usize].iter().map(|&side| side as usize)
    }

    /// The side straight below vertex `v` that does not end there.
    pub fn below(&self, v: usize) -> Option<usize> {
        (self.below[v] != NONE).then_some(self.below[v] as usize)
    }

    /// Sets what [`Boundary::below`] tells.
    fn set_below(&mut self, below: Vec<u32>) {
        self.below = below;
    }

    /// Ends of a side.
    pub fn ends(&self, side: usize) -> (Point, Point) {
        (self.vertices[self.sides[side].from as usize], self.vertices[self.sides[side].to as usize])
    }

    /// On which side of the line through a side, directed to the right, `p` lies: counter-clockwise means above.
    pub fn place(&self, side: usize, p: Point) -> Orientation {
        let side = self.sides[side];
        orientation(self.vertices[side.left_end()], self.vertices[side.right_end()], p)
    }

    /// Whether a side is vertical.
    pub fn is_vertical(&self, side: usize) -> bool {
        let (from, to) = self.ends(side);
        from.x == to.x
    }

    /// The ordinate at which a side that is not vertical meets the abscissa `x` within its range, rounded *into* the
    /// inside: the point `(x, y)` is on the side or on its inner side, exactly.
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
        // Doubling the step from the rounding error's size on reaches the far end, which is inside, in any case.
        let mut step = f64::EPSILON * low.abs().max(high.abs()).max(f64::MIN_POSITIVE);
        while orientation(from, to, Point::new(x, y)) == Orientation::Clockwise {
            y = if is_floor { (y + step).min(high) } else { (y - step).max(low) };
            step *= 2.0;
        }
        y
    }
}

/// By abscissa, then ordinate.
fn lexicographic(a: Point, b: Point) -> Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
}

/// The same point with `0.0` for `-0.0`, which sort apart.
fn unsigned_zero(p: Point) -> Point {
    Point::new(p.x + 0.0, p.y + 0.0)
}

/// Order of two segments that begin at `apex` by slope, both to the right of it.
fn below_at(apex: Point, a: Point, b: Point) -> Ordering {
    match orientation(apex, a, b) {
        Orientation::CounterClockwise => Ordering::Less,
        Orientation::Collinear => Ordering::Equal,
        Orientation::Clockwise => Ordering::Greater,
    }
}

/// How many of the `keys` are less than each number up to `count`.
fn starts(count: usize, keys: impl Iterator<Item = usize>) -> Vec<u32> {
    let mut starts = vec![0; count + 1];
    for key in keys {
        starts[key + 1] += 1;
    }
    for k in 0..count {
        starts[k + 1] += starts[k];
    }
    starts
}
