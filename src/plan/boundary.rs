//! The boundary of free space as roadmap planners see it: distinct vertices, directed sides, free sectors.

use super::segment_grid::SegmentGrid;
use crate::cspace::Regions;
use crate::geometry::{Orientation, Point, orientation};
use std::cmp::Ordering;
use std::ops::ControlFlow;

/// A side of the boundary, by vertex index; free space lies to the left of its direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Side {
    pub from: usize,
    pub to: usize,
    /// The polygon of [`Regions::free`] that it bounds.
    pub polygon: usize,
}

impl Side {
    /// End with the lesser abscissa (on a vertical side the lower one): vertices are numbered in that order.
    pub fn left_end(self) -> usize {
        self.from.min(self.to)
    }

    /// The other end.
    pub fn right_end(self) -> usize {
        self.from.max(self.to)
    }

    /// Whether it is directed to the right, so that free space lies above.
    pub fn is_floor(self) -> bool {
        self.from < self.to
    }
}

/// Directions at a vertex that lead into free space: counter-clockwise from the side towards `right` to the side
/// towards `left`, both included. Where obstacles touch in a corner a vertex has several.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sector {
    pub right: Point,
    pub left: Point,
    /// The polygon of [`Regions::free`] that it belongs to.
    pub polygon: usize,
}

impl Sector {
    /// Whether the angle at `apex` exceeds a half turn: a convex corner of an obstacle.
    pub fn is_reflex(&self, apex: Point) -> bool {
        orientation(apex, self.right, self.left) == Orientation::Clockwise
    }

    /// Whether the direction from `apex` to `target` (another point) belongs to the closed sector.
    pub fn contains(&self, apex: Point, target: Point) -> bool {
        let from_right = orientation(apex, self.right, target);
        let from_left = orientation(apex, self.left, target);
        match orientation(apex, self.right, self.left) {
            Orientation::CounterClockwise => {
                from_right != Orientation::Clockwise && from_left != Orientation::CounterClockwise
            }
            Orientation::Clockwise => {
                from_right != Orientation::Clockwise || from_left != Orientation::CounterClockwise
            }
            Orientation::Collinear if is_between(apex, self.right, self.left) => from_right != Orientation::Clockwise,
            Orientation::Collinear => from_right == Orientation::Collinear && !is_between(apex, self.right, target),
        }
    }
}

/// Distinct vertices in lexicographic order, directed sides that meet in vertices only, free sectors by vertex.
///
/// Contours that touch (in a shared corner, or a corner on a side) are cut there, so that what is free around a point
/// can be read off its sectors whichever way the contours were traced. Sides must not cross or overlap each other,
/// which holds for the result of any polygon union.
#[derive(Debug, Clone)]
pub(super) struct Boundary {
    pub vertices: Vec<Point>,
    pub sides: Vec<Side>,
    sectors: Vec<Sector>,
    /// Sectors of vertex `v` are `first_sector[v]..first_sector[v + 1]`.
    first_sector: Vec<usize>,
}

impl Boundary {
    /// From the polygons of free space, `O(n log n)` for `n` corners.
    pub fn new(regions: &Regions) -> Self {
        let contours = || {
            let polygons = regions.free.iter().enumerate();
            polygons.flat_map(|(k, p)| std::iter::once(&p.outer).chain(&p.holes).map(move |contour| (k, contour)))
        };
        let mut vertices: Vec<Point> =
            contours().flat_map(|(_, contour)| contour).copied().map(unsigned_zero).collect();
        vertices.sort_by(|a, b| lexicographic(*a, *b));
        vertices.dedup();

        let mut sides = Vec::with_capacity(vertices.len());
        for (polygon, contour) in contours() {
            let index = |p: &Point| vertices.partition_point(|v| lexicographic(*v, unsigned_zero(*p)).is_lt());
            let next = contour.iter().cycle().skip(1);
            let ends = contour.iter().zip(next).map(|(a, b)| (index(a), index(b)));
            sides.extend(ends.filter(|(a, b)| a != b).map(|(from, to)| Side { from, to, polygon }));
        }
        let sides = cut_at_touching_vertices(&vertices, sides);
        let (sectors, first_sector) = free_sectors(&vertices, &sides);
        Self { vertices, sides, sectors, first_sector }
    }

    /// Ends of a side.
    pub fn ends(&self, side: Side) -> (Point, Point) {
        (self.vertices[side.from], self.vertices[side.to])
    }

    /// The vertex at exactly `p`, if there is one.
    pub fn vertex_at(&self, p: Point) -> Option<usize> {
        self.vertices.binary_search_by(|v| lexicographic(*v, unsigned_zero(p))).ok()
    }

    /// Free sectors at vertex `v`.
    pub fn sectors(&self, v: usize) -> &[Sector] {
        &self.sectors[self.first_sector[v]..self.first_sector[v + 1]]
    }

    /// Whether closed free space contains `p`, exactly; `O(n)`.
    pub fn contains(&self, p: Point) -> bool {
        let mut inside = false;
        for &side in &self.sides {
            let (from, to) = self.ends(side);
            // Half-open in y, so that a ray through a vertex counts it once.
            let (low, high) = if from.y <= to.y { (from, to) } else { (to, from) };
            let place = orientation(low, high, p);
            if place == Orientation::Collinear && is_within(p, from, to) {
                return true;
            }
            inside ^= low.y <= p.y && p.y < high.y && place == Orientation::CounterClockwise;
        }
        inside
    }

    /// The ordinate at which a side that is not vertical meets the abscissa `x` within its range, rounded *into* free
    /// space: the point `(x, y)` is on the side or on its free side, exactly.
    pub fn ordinate(&self, side: Side, x: f64) -> f64 {
        let (a, b) = (self.vertices[side.left_end()], self.vertices[side.right_end()]);
        if x <= a.x {
            return a.y;
        }
        if x >= b.x {
            return b.y;
        }
        let (low, high) = (a.y.min(b.y), a.y.max(b.y));
        let mut y = (a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x))).clamp(low, high);
        let (from, to) = self.ends(side);
        // Doubling the step from the rounding error's size on reaches the far end, which is free, in any case.
        let mut step = f64::EPSILON * low.abs().max(high.abs()).max(f64::MIN_POSITIVE);
        while orientation(from, to, Point::new(x, y)) == Orientation::Clockwise {
            y = if side.is_floor() { (y + step).min(high) } else { (y - step).max(low) };
            step *= 2.0;
        }
        y
    }
}

/// By abscissa, then ordinate.
pub(super) fn lexicographic(a: Point, b: Point) -> Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
}

/// Whether `p`, known to be collinear with `a` and `b`, lies strictly between them.
pub(super) fn is_between(p: Point, a: Point, b: Point) -> bool {
    let (from_a, to_b) = ((p.x, p.y).partial_cmp(&(a.x, a.y)), (b.x, b.y).partial_cmp(&(p.x, p.y)));
    from_a == to_b && from_a.is_some_and(Ordering::is_ne)
}

/// Whether `p`, known to be collinear with `a` and `b`, lies between them or is one of them.
fn is_within(p: Point, a: Point, b: Point) -> bool {
    p == a || p == b || is_between(p, a, b)
}

/// The same point with `0.0` for `-0.0`, which sort apart.
fn unsigned_zero(p: Point) -> Point {
    Point::new(p.x + 0.0, p.y + 0.0)
}

/// Cuts each side at the vertices of other contours that lie on it exactly.
fn cut_at_touching_vertices(vertices: &[Point], mut sides: Vec<Side>) -> Vec<Side> {
    let grid = SegmentGrid::new(sides.iter().map(|s| (vertices[s.from], vertices[s.to])));
    let mut cuts: Vec<(usize, usize)> = Vec::new();
    for (v, &p) in vertices.iter().enumerate() {
        let _ = grid.along(p, p, |k| {
            let (a, b) = (vertices[sides[k].from], vertices[sides[k].to]);
            if is_between(p, a, b) && orientation(a, b, p) == Orientation::Collinear {
                cuts.push((k, v));
            }
            ControlFlow::Continue::<()>(())
        });
    }
    // Along a line, the order of vertex numbers is the order of the points.
    cuts.sort_unstable();
    for on_side in cuts.chunk_by(|a, b| a.0 == b.0) {
        let whole = sides[on_side[0].0];
        let mut stops: Vec<usize> = on_side.iter().map(|c| c.1).collect();
        if !whole.is_floor() {
            stops.reverse();
        }
        sides[on_side[0].0].to = stops[0];
        stops.push(whole.to);
        sides.extend(stops.windows(2).map(|w| Side { from: w[0], to: w[1], ..whole }));
    }
    sides
}

/// One end of a side, seen from the vertex there.
#[derive(Clone, Copy)]
struct Arm {
    vertex: usize,
    other: usize,
    outgoing: bool,
    polygon: usize,
}

/// The free sectors of all vertices and where those of each begin: between an outgoing side and the incoming one that
/// is next counter-clockwise.
fn free_sectors(vertices: &[Point], sides: &[Side]) -> (Vec<Sector>, Vec<usize>) {
    let mut arms: Vec<Arm> = sides
        .iter()
        .flat_map(|s| {
            let polygon = s.polygon;
            [
                Arm { vertex: s.from, other: s.to, outgoing: true, polygon },
                Arm { vertex: s.to, other: s.from, outgoing: false, polygon },
            ]
        })
        .collect();
    arms.sort_by_key(|arm| arm.vertex);
    let mut sectors = Vec::with_capacity(vertices.len());
    let mut first = vec![0; vertices.len() + 1];
    for group in arms.chunk_by_mut(|a, b| a.vertex == b.vertex) {
        let vertex = group[0].vertex;
        let apex = vertices[vertex];
        group.sort_by(|a, b| counter_clockwise(apex, vertices[a.other], vertices[b.other]));
        for (k, arm) in group.iter().enumerate() {
            let next = group[(k + 1) % group.len()];
            if arm.outgoing && !next.outgoing {
                let (right, left) = (vertices[arm.other], vertices[next.other]);
                sectors.push(Sector { right, left, polygon: arm.polygon });
            }
        }
        first[vertex + 1] = sectors.len();
    }
    // A contour of a single point leaves a vertex without sides.
    for v in 0..vertices.len() {
        first[v + 1] = first[v + 1].max(first[v]);
    }
    (sectors, first)
}

/// Order of two directions from `apex` by angle in `[0, 2 pi)`.
fn counter_clockwise(apex: Point, a: Point, b: Point) -> Ordering {
    let lower_half = |p: Point| p.y < apex.y || (p.y == apex.y && p.x < apex.x);
    lower_half(a).cmp(&lower_half(b)).then_with(|| match orientation(apex, a, b) {
        Orientation::CounterClockwise => Ordering::Less,
        Orientation::Collinear => Ordering::Equal,
        Orientation::Clockwise => Ordering::Greater,
    })
}
