//! Diagonals that join holes to what is around them, so that no part of the region goes round anything.
//!
//! Each hole gets a diagonal from its leftmost vertex to one further left, and from its rightmost to one further right,
//! unless an edge leads there already, or the hole hangs there in a corner of what surrounds it. Then no single vertex separates the graph inside an outer loop: a part that is cut
//! off by one vertex would have both its least and its greatest neighbour outside in that vertex, which would have to lie
//! to the left and to the right of the part. So every face is bounded by a simple polygon.

use super::super::Point;
use super::super::box_tree::BoxTree;
use super::super::predicates::{Orientation, orientation, point_on_segment, segments_meet};
use super::RingError;
use super::noding::{Loop, Noded};
use cplan_interrupt::checkpoint;

/// A graph with its diagonals.
pub(super) struct Bridged {
    pub noded: Noded,
    pub bridges: Vec<Bridge>,
}

/// A diagonal: the region lies on both sides of it.
pub(super) struct Bridge {
    pub ends: [usize; 2],
    /// The hole for which it was made.
    pub ring: usize,
}

/// Joins every hole to its surroundings.
///
/// # Errors
/// When a hole sees nothing on one side, because it is not inside.
pub(super) fn bridged(noded: Noded) -> Result<Bridged, RingError> {
    let Noded { points, edges, around, loops } = &noded;
    let sight = Sight::new(points, edges);
    let mut bridges: Vec<Bridge> = Vec::new();
    // Whether an edge leads to the left, and to the right, of each vertex.
    let mut has: Vec<[bool; 2]> = vec![[false; 2]; points.len()];
    let note = |has: &mut Vec<[bool; 2]>, [a, b]: [usize; 2]| {
        has[a.max(b)][0] = true;
        has[a.min(b)][1] = true;
    };
    edges.iter().for_each(|edge| note(&mut has, *edge));
    for hole in loops.iter().filter(|l| !is_counter_clockwise(points, l)) {
        let extremes = [hole.vertices.iter().min(), hole.vertices.iter().max()];
        for (side, &from) in extremes.into_iter().flatten().enumerate() {
            // Where all edges go to one side, the first of them tells what is on the other: nothing of the region where the
            // hole hangs in a corner of what surrounds it.
            let is_inside = around[from].first().is_some_and(|(_, goes_out)| !goes_out);
            if has[from][side] || !is_inside {
                continue;
            }
            let candidates = if side == 0 { 0..from } else { from + 1..points.len() };
            let Some(to) = sight.nearest(from, candidates, &bridges) else {
                // A loop of the outer ring has a corner in which the ring crosses itself: the faces tell which.
                match hole.ring {
                    0 => continue,
                    hole => return Err(RingError::Misplaced { hole }),
                }
            };
            bridges.push(Bridge { ends: [from, to], ring: hole.ring });
            note(&mut has, [from, to]);
        }
    }
    Ok(Bridged { noded, bridges })
}

/// Direction of a loop, from its leftmost vertex, where it cannot be straight.
fn is_counter_clockwise(points: &[Point], walk: &Loop) -> bool {
    let n = walk.vertices.len();
    let at = (0..n).min_by_key(|i| walk.vertices[*i]).unwrap_or(0);
    let [a, b, c] = [at + n - 1, at, at + 1].map(|i| points[walk.vertices[i % n]]);
    orientation(a, b, c) == Orientation::CounterClockwise
}

/// What sees what.
struct Sight<'a> {
    points: &'a [Point],
    edges: &'a [[usize; 2]],
    tree: BoxTree,
}

impl<'a> Sight<'a> {
    fn new(points: &'a [Point], edges: &'a [[usize; 2]]) -> Self {
        let bounds = |e: &[usize; 2]| {
            let [a, b] = e.map(|v| points[v]);
            [a.inf(&b), a.sup(&b)]
        };
        Self { points, edges, tree: BoxTree::new(edges.iter().map(bounds).collect()) }
    }

    /// The nearest of the candidates that is seen from a vertex.
    fn nearest(&self, from: usize, candidates: impl Iterator<Item = usize>, bridges: &[Bridge]) -> Option<usize> {
        let distance = |v: usize| (self.points[v] - self.points[from]).norm_squared();
        let mut candidates: Vec<(f64, usize)> = candidates.map(|v| (distance(v), v)).collect();
        candidates.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut found = Vec::new();
        candidates.into_iter().map(|(_, v)| v).find(|&to| {
            checkpoint();
            let [a, b] = [self.points[from], self.points[to]];
            found.clear();
            self.tree.meeting(&[a.inf(&b), a.sup(&b)], &mut found);
            let mut edges = found.iter().map(|k| self.edges[*k as usize]).chain(bridges.iter().map(|b| b.ends));
            !edges.any(|edge| self.hides([from, to], edge))
        })
    }

    /// Whether an edge has more in common with a sight line than a common end.
    fn hides(&self, [from, to]: [usize; 2], edge: [usize; 2]) -> bool {
        let [a, b] = [self.points[from], self.points[to]];
        let [c, d] = edge.map(|v| self.points[v]);
        let shared = |v: usize| v == from || v == to;
        match (shared(edge[0]), shared(edge[1])) {
            (false, false) => segments_meet(a, b, c, d),
            (true, true) => true,
            (common, _) => {
                let (common, other) = if common { (edge[0], d) } else { (edge[1], c) };
                let far = if common == from { b } else { a };
                point_on_segment(other, a, b) || point_on_segment(far, c, d)
            }
        }
    }
}
