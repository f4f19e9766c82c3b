//! Decomposition of a simple polygon into convex ones.

use std::collections::VecDeque;

use super::polygon::turn;
use super::{Convex, Orientation, Point, SimplePolygon, orientation};

/// Strictly convex polygons (of radius 0) with disjoint interiors whose union is `polygon`.
///
/// Ear clipping, then removal of every diagonal that no reflex corner needs (S. Hertel, K. Mehlhorn, *Fast
/// Triangulation of Simple Polygons*, 1983): at most four times as many pieces as the least possible number. All
/// corners are corners of the polygon, so with the exact predicates the union is the polygon itself, without rounding.
/// Straight corners of a piece are dropped. `O(n^2)`.
#[must_use]
pub fn decompose(polygon: &SimplePolygon) -> Vec<Convex> {
    let corners = polygon.corners();
    let (triangles, diagonals) = triangulate(corners);
    let strict = |ring: Vec<usize>| {
        let points: Vec<Point> = ring.into_iter().map(|i| corners[i]).collect();
        let kept = (0..points.len()).filter(|&i| turn(&points, i) != Orientation::Collinear).map(|i| points[i]);
        Convex::new(kept.collect(), 0.0)
    };
    merge(corners, triangles, &diagonals).into_iter().map(strict).collect()
}

/// A side that two triangles share: `[from, to]` as the first of them runs through it.
struct Diagonal {
    ends: [usize; 2],
    triangles: [usize; 2],
}

/// Triangles as counter-clockwise corner indices, and their common sides.
///
/// An ear is a convex corner whose closed triangle with its neighbours contains no further corner. A simple polygon
/// of more than three corners has two ears, straight corners or not (G. H. Meisters, *Polygons Have Ears*, 1975), and
/// cutting one off leaves a simple polygon, of which only the two neighbours can newly be ears.
fn triangulate(corners: &[Point]) -> (Vec<[usize; 3]>, Vec<Diagonal>) {
    let n = corners.len();
    let mut ring = Ring::new(corners);
    // The triangle on the far side of the ring's side from `i`, once that side is a diagonal.
    let mut beyond: Vec<Option<usize>> = vec![None; n];
    let mut triangles = Vec::with_capacity(n - 2);
    let mut diagonals = Vec::with_capacity(n - 3);
    let mut candidates: VecDeque<usize> = (0..n).collect();
    while triangles.len() < n - 2 {
        let Some(tip) = candidates.pop_front() else {
            debug_assert!(false, "a simple polygon has an ear");
            break;
        };
        if ring.removed[tip] || !ring.is_ear(tip) {
            continue;
        }
        let triangle = [ring.before[tip], tip, ring.after[tip]];
        let [from, _, to] = triangle;
        let index = triangles.len();
        let last = index == n - 3;
        for (side, ends) in [(from, [from, tip]), (tip, [tip, to])] {
            if let Some(other) = beyond[side] {
                diagonals.push(Diagonal { ends, triangles: [index, other] });
            }
        }
        if let (true, Some(other)) = (last, beyond[to]) {
            diagonals.push(Diagonal { ends: [to, from], triangles: [index, other] });
        }
        triangles.push(triangle);
        beyond[from] = Some(index);
        ring.remove(tip);
        candidates.extend([from, to]);
    }
    (triangles, diagonals)
}

/// What is left of the boundary while ears are cut off.
struct Ring<'a> {
    corners: &'a [Point],
    before: Vec<usize>,
    after: Vec<usize>,
    removed: Vec<bool>,
}

impl<'a> Ring<'a> {
    fn new(corners: &'a [Point]) -> Self {
        let n = corners.len();
        let before = (0..n).map(|i| (i + n - 1) % n).collect();
        let after = (0..n).map(|i| (i + 1) % n).collect();
        Self { corners, before, after, removed: vec![false; n] }
    }

    fn turn(&self, i: usize) -> Orientation {
        orientation(self.corners[self.before[i]], self.corners[i], self.corners[self.after[i]])
    }

    fn remove(&mut self, i: usize) {
        let (before, after) = (self.before[i], self.after[i]);
        self.after[before] = after;
        self.before[after] = before;
        self.removed[i] = true;
    }

    fn is_ear(&self, tip: usize) -> bool {
        if self.turn(tip) != Orientation::CounterClockwise {
            return false;
        }
        let (from, to) = (self.before[tip], self.after[tip]);
        let [a, b, c] = [from, tip, to].map(|i| self.corners[i]);
        let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
        let mut i = self.after[to];
        while i != from {
            let p = self.corners[i];
            let in_box = low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y;
            let right_of = |s, t| orientation(s, t, p) == Orientation::Clockwise;
            if in_box && !right_of(a, b) && !right_of(b, c) && !right_of(c, a) {
                return false;
            }
            i = self.after[i];
        }
        true
    }
}

/// Joins triangles across every diagonal whose removal leaves no reflex corner.
fn merge(corners: &[Point], triangles: Vec<[usize; 3]>, diagonals: &[Diagonal]) -> Vec<Vec<usize>> {
    let mut owner: Vec<usize> = (0..triangles.len()).collect();
    let mut pieces: Vec<Vec<usize>> = triangles.into_iter().map(Vec::from).collect();
    for Diagonal { ends: [from, to], triangles } in diagonals {
        let [first, second] = triangles.map(|t| find(&mut owner, t));
        let joined = joined(&pieces[first], &pieces[second], *from, *to);
        let n = joined.len();
        // The ends of the diagonal: where `from` and `to` stand in the result of `joined`.
        let convex = [0, pieces[first].len() - 1].into_iter().all(|k| {
            let [a, b, c] = [joined[(k + n - 1) % n], joined[k], joined[(k + 1) % n]].map(|i| corners[i]);
            orientation(a, b, c) != Orientation::Clockwise
        });
        if convex {
            pieces[first] = joined;
            pieces[second].clear();
            owner[second] = first;
        }
    }
    pieces.retain(|piece| !piece.is_empty());
    pieces
}

/// The corners of `first` from `to` on to `from`, then those of `second` between `from` and `to`.
fn joined(first: &[usize], second: &[usize], from: usize, to: usize) -> Vec<usize> {
    let starting_at = |ring: &[usize], corner: usize| {
        let start = ring.iter().position(|&i| i == corner).unwrap_or(0);
        ring.iter().cycle().skip(start).take(ring.len()).copied().collect::<Vec<_>>()
    };
    let mut ring = starting_at(first, to);
    ring.extend(&starting_at(second, from)[1..second.len() - 1]);
    ring
}

/// The piece that triangle `t` has gone into (with path halving).
fn find(owner: &mut [usize], mut t: usize) -> usize {
    while owner[t] != t {
        owner[t] = owner[owner[t]];
        t = owner[t];
    }
    t
}
