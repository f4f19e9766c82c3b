//! Bridges: diagonals that join holes to their surroundings, so that all faces of the region are simple polygons.
//!
//! Each hole gets a diagonal from its leftmost vertex to a vertex farther left, and one from its rightmost vertex to a
//! vertex farther right. A diagonal is not necessary if an edge already leads in this direction, or if the hole touches
//! a corner of its surroundings there.
//!
//! Then no single vertex can separate the graph inside an outer loop. For suppose that a vertex cuts off a part. The
//! leftmost vertex of the part has a neighbour farther left, and its rightmost vertex has one farther right. Both
//! neighbours would have to be the cutting vertex.

use super::super::Point;
use super::super::box_tree::BoxTree;
use super::super::predicates::{point_on_segment, segments_meet};
use super::RingError;
use super::noding::{NodedGraph, is_counter_clockwise};
use cplan_interrupt::checkpoint;

/// A graph of rings, and diagonals that connect the holes with their surroundings.
pub(super) struct BridgedGraph {
    pub noded: NodedGraph,
    pub bridges: Vec<Bridge>,
}

/// A diagonal between a hole and its surroundings. The region lies on both sides of it.
pub(super) struct Bridge {
    pub ends: [usize; 2],
    /// The hole for which the diagonal was made.
    pub ring: usize,
}

/// Connects every hole with its surroundings by diagonals.
///
/// # Errors
/// [`RingError::Misplaced`] if the leftmost vertex of a hole sees no vertex to its left, or the rightmost none to its
/// right. Such a hole is not inside the outer ring.
pub(super) fn join_holes(noded: NodedGraph) -> Result<BridgedGraph, RingError> {
    let NodedGraph { points, edges, around, loops } = &noded;
    let sight = Visibility::new(points, edges);
    let mut bridges: Vec<Bridge> = Vec::new();
    // For each vertex, true if an edge leads to the left, and true if an edge leads to the right.
    let mut has: Vec<[bool; 2]> = vec![[false; 2]; points.len()];
    let note = |has: &mut Vec<[bool; 2]>, [a, b]: [usize; 2]| {
        has[a.max(b)][0] = true;
        has[a.min(b)][1] = true;
    };
    edges.iter().for_each(|edge| note(&mut has, *edge));
    for hole in loops.iter().filter(|l| !is_counter_clockwise(points, &l.vertices)) {
        let extremes = [hole.vertices.iter().min(), hole.vertices.iter().max()];
        for (side, &from) in extremes.into_iter().flatten().enumerate() {
            // If all edges lead to one side, the first of them states whether the region is on the other side. It is
            // not if the hole touches a corner of its surroundings there.
            let is_inside = around[from].first().is_some_and(|(_, goes_out)| !goes_out);
            if has[from][side] || !is_inside {
                continue;
            }
            let candidates = if side == 0 { 0..from } else { from + 1..points.len() };
            let Some(to) = sight.nearest(from, candidates, &bridges) else {
                // In a loop of the outer ring, the ring crosses itself at a corner. The faces will show this.
                match hole.ring {
                    0 => continue,
                    hole => return Err(RingError::Misplaced { hole }),
                }
            };
            bridges.push(Bridge { ends: [from, to], ring: hole.ring });
            note(&mut has, [from, to]);
        }
    }
    Ok(BridgedGraph { noded, bridges })
}

/// Visibility between vertices.
struct Visibility<'a> {
    points: &'a [Point],
    edges: &'a [[usize; 2]],
    tree: BoxTree,
}

impl<'a> Visibility<'a> {
    fn new(points: &'a [Point], edges: &'a [[usize; 2]]) -> Self {
        let bounds = |e: &[usize; 2]| {
            let [a, b] = e.map(|v| points[v]);
            [a.inf(&b), a.sup(&b)]
        };
        Self { points, edges, tree: BoxTree::new(edges.iter().map(bounds).collect()) }
    }

    /// Returns the nearest candidate that a vertex sees.
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
            !edges.any(|edge| self.blocks_sight([from, to], edge))
        })
    }

    /// Returns true if an edge obstructs a sight line: they have more than a common end in common.
    fn blocks_sight(&self, [from, to]: [usize; 2], edge: [usize; 2]) -> bool {
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
