//! Noding: cuts sides where they touch or cross, so that they meet in vertices only.

use super::{Boundary, NO_ENTRY, Side, Status};
use crate::{Orientation, Point};
use cplan_interrupt::checkpoint;
use std::cmp::Ordering;

/// Greatest extent of a crossing that is attributed to rounding, as a fraction of the greatest coordinate. It is a few
/// units in the last place of the values from which corners were computed.
const CROSSING_TOLERANCE: f64 = 64.0 * f64::EPSILON;

/// Largest number of passes. Crossings that remain are ignored. If rounding has moved a corner across a side, the first
/// pass joins them. The pieces of this side turn slightly, which rarely causes another crossing.
const MAX_PASSES: usize = 16;

/// Returns a boundary whose sides meet in vertices only, with the side below each vertex. Each pass takes `O(n log n)`,
/// and one pass suffices if contours neither touch nor cross.
pub(super) fn planar(mut boundary: Boundary) -> Boundary {
    for pass in 1..=MAX_PASSES {
        boundary.arrange();
        let Sweep { below, mut cuts, .. } = Sweep::new(&mut boundary);
        if cuts.is_empty() || pass == MAX_PASSES {
            boundary.set_below(below);
            break;
        }
        cuts.sort_unstable();
        cuts.dedup();
        cut(&mut boundary.sides, &cuts);
    }
    boundary
}

/// Replaces sides by pieces between the vertices at which they are cut. `cuts` has pairs of a side and a vertex, sorted
/// by side.
fn cut(sides: &mut Vec<Side>, cuts: &[(usize, u32)]) {
    for of_side in cuts.chunk_by(|a, b| a.0 == b.0) {
        let whole = sides[of_side[0].0];
        // Along a line, the vertex numbers are in the order of the points.
        let mut stops: Vec<u32> = of_side.iter().map(|cut| cut.1).collect();
        if !whole.is_floor() {
            stops.reverse();
        }
        sides[of_side[0].0].to = stops[0];
        stops.push(whole.to);
        sides.extend(stops.windows(2).map(|w| Side { from: w[0], to: w[1] }));
    }
}

/// A vertical sweep line that passes all vertices from left to right. If any sides cross, two that cross are neighbours
/// on the line at some time (Shamos, Hoey 1976).
struct Sweep<'a> {
    boundary: &'a mut Boundary,
    status: Status,
    below: Vec<u32>,
    /// [`CROSSING_TOLERANCE`] as a length, in the unit of the coordinates.
    crossing_tolerance: f64,
    /// Sides, each with a vertex at which it must be cut.
    cuts: Vec<(usize, u32)>,
}

impl<'a> Sweep<'a> {
    fn new(boundary: &'a mut Boundary) -> Self {
        let (sides, vertices) = (boundary.sides.len(), boundary.vertices.len());
        let greatest = boundary.vertices.iter().flat_map(|p| [p.x.abs(), p.y.abs()]).fold(0.0, f64::max);
        let (status, below, crossing_tolerance) =
            (Status::new(sides), vec![NO_ENTRY; vertices], CROSSING_TOLERANCE * greatest);
        let mut sweep = Self { boundary, status, below, crossing_tolerance, cuts: Vec::new() };
        for v in 0..vertices {
            checkpoint();
            sweep.pass(v);
        }
        sweep
    }

    fn pass(&mut self, v: usize) {
        let (boundary, status) = (&*self.boundary, &mut self.status);
        let at = boundary.vertices[v];
        let ends_here = |side: usize| boundary.sides[side].right_end() == v;
        let lowest = boundary.ending(v).next();
        let mut below = match lowest {
            Some(lowest) => status.below(lowest),
            None => status.last_where(|side| boundary.place(side, at) == Orientation::CounterClockwise),
        };
        // Other sides can lie between those that end here only if sides cross.
        while let Some(side) = below.filter(|&side| ends_here(side)) {
            below = status.below(side);
        }
        for side in boundary.ending(v) {
            status.remove(side);
        }
        self.below[v] = below.map_or(NO_ENTRY, |side| side as u32);
        let above = status.above(below);
        if let (None, Some(above)) = (lowest, above)
            && boundary.place(above, at) == Orientation::Collinear
        {
            self.cuts.push((above, v as u32));
        }
        let mut last = below;
        for side in self.boundary.beginning(v) {
            self.order_coincident(last, side);
            self.status.insert_above(last, side);
            self.check(last, Some(side));
            last = Some(side);
        }
        self.check(last, above);
    }

    /// Puts two coincident sides, where obstacles touch, in the right order, in which floors and ceilings alternate.
    fn order_coincident(&mut self, below: Option<usize>, side: usize) {
        let sides = &mut self.boundary.sides;
        let expects_floor = below.is_none_or(|below| !sides[below].is_floor());
        if let Some(&other) = sides.get(side + 1)
            && sides[side].is_floor() != expects_floor
            && (other.from, other.to) == (sides[side].to, sides[side].from)
        {
            sides.swap(side, side + 1);
        }
    }

    /// Records the place where two new neighbours must be cut, if they meet before the right end of either.
    fn check(&mut self, below: Option<usize>, above: Option<usize>) {
        let (Some(below), Some(above)) = (below, above) else { return };
        let ends = [below, above].map(|side| self.boundary.sides[side].right_end());
        let (other, first, proper) = match ends[0].cmp(&ends[1]) {
            Ordering::Less => (above, ends[0], Orientation::Clockwise),
            Ordering::Greater => (below, ends[1], Orientation::CounterClockwise),
            Ordering::Equal => return,
        };
        let place = self.boundary.place(other, self.boundary.vertices[first]);
        if place == Orientation::Collinear {
            self.cuts.push((other, first as u32));
        } else if place != proper {
            // If other sides cross, two sides that do not cross can become neighbours by mistake.
            let cut = nearest_end(self.boundary, below, above).filter(|cut| cut.1 <= self.crossing_tolerance);
            self.cuts.extend(cut.map(|cut| cut.0));
        }
    }
}

/// Returns, for two sides that cross, the end of one side that is nearest to the other one. The result is that other
/// side, the vertex, and the distance. `None` if the sides have both ends in common.
fn nearest_end(boundary: &Boundary, a: usize, b: usize) -> Option<((usize, u32), f64)> {
    let candidates = [(a, b), (b, a)].into_iter().flat_map(|(side, other)| {
        let Side { from, to } = boundary.sides[other];
        [(side, from), (side, to)]
    });
    let is_end = |side: usize, v: u32| [boundary.sides[side].from, boundary.sides[side].to].contains(&v);
    let distance = |(side, v)| ((side, v), distance(boundary.ends(side), boundary.vertices[v as usize]));
    candidates.filter(|&(side, v)| !is_end(side, v)).map(distance).min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Returns the distance of a point from a segment.
fn distance((a, b): (Point, Point), p: Point) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    (p - (a + along * t)).norm()
}
