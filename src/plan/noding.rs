//! Cutting sides where they touch or cross, so that they meet in vertices only.

use super::NONE;
use super::boundary::{Boundary, Side};
use super::status::Status;
use crate::geometry::{Orientation, Point};

/// Passes after which sides that still cross are left so. Corners that rounding has moved across a side by a hair are
/// joined to it in the first pass; the piece of side that this turns by a hair seldom crosses anything new.
const PASSES: usize = 16;

/// A boundary whose sides meet in vertices only, and what lies below each vertex. `O(n log n)` a pass; the first is the
/// only one where contours neither touch nor cross.
pub(super) fn planar(mut boundary: Boundary) -> Boundary {
    for pass in 1..=PASSES {
        boundary.arrange();
        let Sweep { below, mut cuts, .. } = Sweep::over(&mut boundary);
        if cuts.is_empty() || pass == PASSES {
            boundary.set_below(below);
            break;
        }
        cuts.sort_unstable();
        cuts.dedup();
        cut(&mut boundary.sides, &cuts);
    }
    boundary
}

/// Replaces sides by pieces between the vertices at which they are cut, given as pairs of side and vertex in order.
fn cut(sides: &mut Vec<Side>, cuts: &[(usize, u32)]) {
    for of_side in cuts.chunk_by(|a, b| a.0 == b.0) {
        let whole = sides[of_side[0].0];
        // Along a line, the order of vertex numbers is the order of the points.
        let mut stops: Vec<u32> = of_side.iter().map(|cut| cut.1).collect();
        if !whole.is_floor() {
            stops.reverse();
        }
        sides[of_side[0].0].to = stops[0];
        stops.push(whole.to);
        sides.extend(stops.windows(2).map(|w| Side { from: w[0], to: w[1] }));
    }
}

/// A vertical line that passes over all vertices from left to right.
struct Sweep<'a> {
    boundary: &'a mut Boundary,
    status: Status,
    below: Vec<u32>,
    /// Sides and the vertices at which they must be cut.
    cuts: Vec<(usize, u32)>,
}

impl<'a> Sweep<'a> {
    fn over(boundary: &'a mut Boundary) -> Self {
        let (sides, vertices) = (boundary.sides.len(), boundary.vertices.len());
        let mut sweep = Self { boundary, status: Status::new(sides), below: vec![NONE; vertices], cuts: Vec::new() };
        for v in 0..vertices {
            sweep.pass(v);
        }
        sweep
    }

    fn pass(&mut self, v: usize) {
        let (boundary, status) = (&*self.boundary, &mut self.status);
        let at = boundary.vertices[v];
        let ends_here = |side: usize| boundary.sides[side].right_end() == v;
        let (lowest, highest) = (boundary.ending(v).next(), boundary.ending(v).next_back());
        let mut below = match lowest {
            Some(lowest) => status.below(lowest),
            None => status.last_where(|side| boundary.place(side, at) == Orientation::CounterClockwise),
        };
        // Only where sides cross do others lie between those that end here.
        while let Some(side) = below.filter(|&side| ends_here(side)) {
            below = status.below(side);
        }
        for side in boundary.ending(v) {
            status.remove(side);
        }
        self.below[v] = below.map_or(NONE, |side| side as u32);
        let above = status.above(below);
        self.check(below, lowest, Orientation::CounterClockwise, v);
        self.check(above, highest, Orientation::Clockwise, v);
        self.begin(v, below);
    }

    /// Notes where to cut if `neighbour`, next to vertex `v`, does not leave it strictly on its proper side.
    fn check(&mut self, neighbour: Option<usize>, ending: Option<usize>, proper: Orientation, v: usize) {
        let Some(neighbour) = neighbour else { return };
        let place = self.boundary.place(neighbour, self.boundary.vertices[v]);
        if place == Orientation::Collinear {
            self.cuts.push((neighbour, v as u32));
        } else if place != proper
            && let Some(ending) = ending
        {
            self.cuts.extend(nearest_end(self.boundary, neighbour, ending));
        }
    }

    /// Puts the sides that begin at `v` into the status.
    fn begin(&mut self, v: usize, below: Option<usize>) {
        let mut at = below;
        for side in self.boundary.beginning(v) {
            // Floors and ceilings alternate. That tells the order of two coincident sides, where obstacles touch.
            let sides = &mut self.boundary.sides;
            let expects_floor = at.is_none_or(|at| !sides[at].is_floor());
            if let Some(&other) = sides.get(side + 1)
                && sides[side].is_floor() != expects_floor
                && (other.from, other.to) == (sides[side].to, sides[side].from)
            {
                sides.swap(side, side + 1);
            }
            self.status.insert_above(at, side);
            at = Some(side);
        }
    }
}

/// Of two sides that cross, one and the end of the other that is nearest to it.
fn nearest_end(boundary: &Boundary, a: usize, b: usize) -> Option<(usize, u32)> {
    let candidates = [(a, b), (b, a)].into_iter().flat_map(|(side, other)| {
        let Side { from, to } = boundary.sides[other];
        [(side, from), (side, to)]
    });
    let is_end = |side: usize, v: u32| [boundary.sides[side].from, boundary.sides[side].to].contains(&v);
    let distance = |&(side, v): &(usize, u32)| distance(boundary.ends(side), boundary.vertices[v as usize]);
    candidates.filter(|&(side, v)| !is_end(side, v)).min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

/// Distance of a point from a segment.
fn distance((a, b): (Point, Point), p: Point) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    (p - (a + along * t)).norm()
}
