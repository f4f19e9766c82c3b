//! Contours of a C-obstacle from its slices. Chords approximate curves that are known exactly at each `q1`.

use cplan_geometry::Point;
use cplan_interrupt::checkpoint;
use std::f64::consts::{PI, TAU};

/// The range of a revolute `q2` that covers a whole turn.
const REVOLUTE_RANGE: [f64; 2] = [-PI, PI];

/// A C-obstacle that is known slice by slice, and decides which chords are acceptable.
pub(super) trait SlicedObstacle {
    /// A point of the C-obstacle's boundary.
    type End: Copy;

    /// Appends the blocked intervals of `q2` at `q1`: ascending, disjoint and closed. For a revolute joint 2, they are
    /// arcs `[lower, upper]` of at most one turn. If everything is blocked, there is one arc of a whole turn.
    fn intervals(&mut self, q1: f64, out: &mut Vec<[f64; 2]>);

    /// Returns the boundary point `(q1, q2)`.
    fn end(&self, q1: f64, q2: f64) -> Self::End;

    /// Returns the coordinates of a boundary point.
    fn point(&self, end: &Self::End) -> Point;

    /// Returns the same boundary point after whole turns of joint 2.
    fn shifted(&self, end: &Self::End, turns: f64) -> Self::End;

    /// Returns true if straight lines may link the ends of an interval in one slice to those of an interval in
    /// another.
    fn links(&self, from: &[Self::End; 2], to: &[Self::End; 2]) -> bool;

    /// Returns true if one straight line between two boundary points may replace the lines through the slices in between.
    fn shortens(&self, from: &Self::End, to: &Self::End) -> bool;
}

/// Settings of the approximation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Flattening {
    /// True if joint 2 is revolute, so that arcs that differ by whole turns are the same.
    pub turning: bool,
    /// Width in `q1` of the narrowest strips. Such a strip may be covered by rectangles over the intervals of the
    /// slices at both its sides.
    pub min_width: f64,
    /// Length by which neighbouring contours overlap, so that their union has no gaps.
    pub overlap: f64,
}

/// A value of `q1` at which a slice is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Breakpoint {
    /// The value of joint 1.
    pub q1: f64,
    /// True if contours need a vertex at this value, because the C-obstacle may end or split there.
    pub keep: bool,
}

/// Returns simple, counter-clockwise contours whose union covers the C-obstacle over the range of `breaks`, which
/// are ascending.
///
/// Each strip between two slices is bisected until its intervals match one to one and the chords between their ends
/// are accepted, or until the strip is `min_width` wide. Matched intervals form chains, and each chain becomes a
/// contour. A narrow strip without a match is covered by rectangles. Finally, corners are removed from the chains as
/// long as the longer chords are accepted.
pub(super) fn contours<S: SlicedObstacle>(
    source: &mut S,
    breaks: &[Breakpoint],
    flattening: Flattening,
) -> Vec<Vec<Point>> {
    let mut tracer = Tracer { source, flattening, open: Vec::new(), done: Vec::new(), scratch: Vec::new() };
    let Some((first, rest)) = breaks.split_first() else { return Vec::new() };
    let mut slice = tracer.slice(*first);
    tracer.start_chains(&slice);
    for &next in rest {
        let next = tracer.slice(next);
        tracer.strip(&slice, &next);
        slice = next;
    }
    tracer.close_chains();
    tracer.done
}

/// The blocked intervals of one slice, given by the boundary points at their ends.
struct Slice<E> {
    at: Breakpoint,
    intervals: Vec<[E; 2]>,
    /// True if the whole turn of `q2` is blocked. Then `intervals` is empty.
    full: bool,
}

/// A sequence of matched intervals, in unwrapped values.
struct Chain<E> {
    slices: Vec<([E; 2], bool)>,
    /// Whole turns to add to the intervals of the last slice so that they continue the chain.
    turns: f64,
}

struct Tracer<'r, S: SlicedObstacle> {
    source: &'r mut S,
    flattening: Flattening,
    /// The unfinished chains, one for each interval of the last slice.
    open: Vec<Chain<S::End>>,
    done: Vec<Vec<Point>>,
    scratch: Vec<[f64; 2]>,
}

impl<S: SlicedObstacle> Tracer<'_, S> {
    fn slice(&mut self, at: Breakpoint) -> Slice<S::End> {
        checkpoint();
        self.scratch.clear();
        self.source.intervals(at.q1, &mut self.scratch);
        let full = self.flattening.turning && self.scratch.iter().any(|[lower, upper]| upper - lower >= TAU);
        let intervals = if full {
            Vec::new()
        } else {
            self.scratch.iter().map(|i| i.map(|q2| self.source.end(at.q1, q2))).collect()
        };
        Slice { at, intervals, full }
    }

    fn q2(&self, end: &S::End) -> f64 {
        self.source.point(end).y
    }

    /// Extends the chains from slice `u` to slice `v`, through as many slices in between as are needed.
    fn strip(&mut self, u: &Slice<S::End>, v: &Slice<S::End>) {
        if u.full && v.full {
            self.rectangle(u.at.q1, v.at.q1, REVOLUTE_RANGE);
        } else if let Some(links) = self.matching(u, v) {
            self.extend(v, &links);
        } else if v.at.q1 - u.at.q1 <= self.flattening.min_width {
            self.cover(u, v);
        } else {
            let middle = self.slice(Breakpoint { q1: f64::midpoint(u.at.q1, v.at.q1), keep: false });
            self.strip(u, &middle);
            self.strip(&middle, v);
        }
    }

    /// Returns, for each interval of `u`, its partner in `v`, and the turns to add to the partner. `None` if chords
    /// cannot link all the intervals.
    fn matching(&self, u: &Slice<S::End>, v: &Slice<S::End>) -> Option<Vec<(usize, f64)>> {
        let n = u.intervals.len();
        if u.full || v.full || n != v.intervals.len() {
            return None;
        }
        let rotations = if self.flattening.turning { n.max(1) } else { 1 };
        (0..rotations).find_map(|rotation| {
            (0..n)
                .map(|i| {
                    let j = (i + rotation) % n;
                    let turns = self.turns_between(&u.intervals[i], &v.intervals[j]);
                    let to = v.intervals[j].map(|end| self.source.shifted(&end, turns));
                    let linked = self.overlap(&u.intervals[i], &to) && self.source.links(&u.intervals[i], &to);
                    linked.then_some((j, turns))
                })
                .collect()
        })
    }

    /// Returns the whole turns to add to `to` so that its middle is nearest to that of `from`.
    fn turns_between(&self, from: &[S::End; 2], to: &[S::End; 2]) -> f64 {
        if !self.flattening.turning {
            return 0.0;
        }
        let twice = |i: &[S::End; 2]| self.q2(&i[0]) + self.q2(&i[1]);
        ((twice(from) - twice(to)) / (2.0 * TAU)).round()
    }

    fn overlap(&self, a: &[S::End; 2], b: &[S::End; 2]) -> bool {
        self.q2(&a[0]) <= self.q2(&b[1]) && self.q2(&b[0]) <= self.q2(&a[1])
    }

    fn start_chains(&mut self, slice: &Slice<S::End>) {
        self.open =
            slice.intervals.iter().map(|&ends| Chain { slices: vec![(ends, slice.at.keep)], turns: 0.0 }).collect();
    }

    fn extend(&mut self, v: &Slice<S::End>, links: &[(usize, f64)]) {
        let mut next: Vec<Option<Chain<S::End>>> = links.iter().map(|_| None).collect();
        for (mut chain, &(to, turns)) in std::mem::take(&mut self.open).into_iter().zip(links) {
            chain.turns += turns;
            chain.slices.push((v.intervals[to].map(|end| self.source.shifted(&end, chain.turns)), v.at.keep));
            next[to] = Some(chain);
        }
        self.open = next.into_iter().flatten().collect();
    }

    /// Covers the narrow strip between two slices by rectangles if their intervals do not match.
    fn cover(&mut self, u: &Slice<S::End>, v: &Slice<S::End>) {
        self.close_chains();
        let spans = if u.full || v.full {
            vec![REVOLUTE_RANGE]
        } else {
            let both = u.intervals.iter().chain(&v.intervals);
            united(both.map(|i| [self.q2(&i[0]), self.q2(&i[1])]).collect(), self.flattening.turning)
        };
        for span in spans {
            self.rectangle(u.at.q1, v.at.q1, span);
        }
        self.start_chains(v);
    }

    /// Adds a rectangle over a strip and `span`, enlarged by the overlap.
    fn rectangle(&mut self, u: f64, v: f64, [lower, upper]: [f64; 2]) {
        let pad = self.flattening.overlap;
        let (u, v, lower, upper) = (u - pad, v + pad, lower - pad, upper + pad);
        self.finish(vec![Point::new(u, lower), Point::new(v, lower), Point::new(v, upper), Point::new(u, upper)]);
    }

    fn close_chains(&mut self) {
        for chain in std::mem::take(&mut self.open) {
            // A chain of a single slice needs no contour: the rectangles on both sides cover it.
            if chain.slices.len() < 2 {
                continue;
            }
            let sides = [0, 1].map(|side| self.simplified(&chain, side));
            let whole =
                || [0, 1].map(|side| chain.slices.iter().map(|(ends, _)| self.source.point(&ends[side])).collect());
            let sides = if is_nowhere_above(&sides) { sides } else { whole() };
            let contour = outline(&sides, self.flattening.overlap);
            // If one chord serves as both sides of a chain, the chain has no area.
            if contour.len() > 2 {
                self.finish(contour);
            }
        }
    }

    /// Returns one side of a chain, with only the corners that accepted chords need.
    fn simplified(&self, chain: &Chain<S::End>, side: usize) -> Vec<Point> {
        let slices = &chain.slices;
        let mut corners = vec![self.source.point(&slices[0].0[side])];
        let mut from = 0;
        while from + 1 < slices.len() {
            let mut to = from + 1;
            while to + 1 < slices.len()
                && !slices[to].1
                && self.source.shortens(&slices[from].0[side], &slices[to + 1].0[side])
            {
                to += 1;
            }
            corners.push(self.source.point(&slices[to].0[side]));
            from = to;
        }
        corners
    }

    /// Stores a contour, moved by whole turns of joint 2 so that its middle is in `[-pi, pi]`.
    fn finish(&mut self, mut contour: Vec<Point>) {
        if self.flattening.turning {
            let range =
                contour.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| [low.min(p.y), high.max(p.y)]);
            let shift = TAU * (f64::midpoint(range[0], range[1]) / TAU).round();
            contour.iter_mut().for_each(|p| p.y -= shift);
        }
        self.done.push(contour);
    }
}

/// Returns true if the first polyline is nowhere above the second. Both are functions of `x` over the same range.
fn is_nowhere_above(sides: &[Vec<Point>; 2]) -> bool {
    let below = |points: &[Point], other: &[Point], sign: f64| {
        let mut segment = 0;
        points.iter().all(|p| {
            while segment + 2 < other.len() && other[segment + 1].x < p.x {
                segment += 1;
            }
            let (a, b) = (other[segment], other[segment + 1]);
            let y = if b.x > a.x { a.y + (b.y - a.y) * ((p.x - a.x) / (b.x - a.x)) } else { a.y };
            sign * (y - p.y) >= 0.0
        })
    };
    below(&sides[0], &sides[1], 1.0) && below(&sides[1], &sides[0], -1.0)
}

/// Returns the contour between a lower and an upper polyline. It is extended by `pad` at both ends, except at an end
/// where the two polylines meet.
fn outline(sides: &[Vec<Point>; 2], pad: f64) -> Vec<Point> {
    let [lower, upper] = sides;
    let mut contour = Vec::with_capacity(lower.len() + upper.len() + 4);
    let (first, last) = (0, lower.len() - 1);
    let beyond = |p: &Point, by: f64| Point::new(p.x + by, p.y);
    if lower[first] != upper[first] {
        contour.push(beyond(&lower[first], -pad));
    }
    contour.extend_from_slice(lower);
    let top = upper.len() - 1;
    if lower[last] != upper[top] {
        contour.push(beyond(&lower[last], pad));
        contour.push(beyond(&upper[top], pad));
    }
    contour.extend(upper.iter().rev());
    if lower[first] != upper[first] {
        contour.push(beyond(&upper[first], -pad));
    }
    contour.dedup();
    while contour.len() > 1 && contour.first() == contour.last() {
        contour.pop();
    }
    contour
}

/// Returns the union of intervals. With `turning`, they are arcs on a circle, and an arc of at least a whole turn keeps
/// its length.
fn united(mut spans: Vec<[f64; 2]>, turning: bool) -> Vec<[f64; 2]> {
    let mut out: Vec<[f64; 2]> = Vec::new();
    while let Some(mut span) = spans.pop() {
        let mut k = 0;
        while k < out.len() {
            let other = out[k];
            let turns = if turning { ((span[0] + span[1] - other[0] - other[1]) / (2.0 * TAU)).round() } else { 0.0 };
            let other = other.map(|q2| q2 + turns * TAU);
            if other[0] <= span[1] && span[0] <= other[1] {
                span = [span[0].min(other[0]), span[1].max(other[1])];
                out.swap_remove(k);
                k = 0;
            } else {
                k += 1;
            }
        }
        out.push(span);
    }
    out
}
