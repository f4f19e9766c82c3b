//! Rings as a graph: corners in the same place are one vertex, and sides meet in vertices only.

use super::super::Point;
use super::super::box_tree::BoxTree;
use super::super::predicates::{Orientation, orientation, point_on_segment, segments_cross, segments_meet};
use super::{RingError, RingSide};
use cplan_interrupt::checkpoint;
use std::cmp::Ordering;

/// The graph of several rings. The region lies to the left of every edge, if the rings are consistent.
pub(super) struct NodedGraph {
    /// Positions of the vertices, numbered from left to right, and upwards on vertical lines. So numbers are monotone
    /// along any segment.
    pub points: Vec<Point>,
    /// Directed edges, as pairs of vertices.
    pub edges: Vec<[usize; 2]>,
    /// The neighbours of each vertex, counter-clockwise from straight down. The flag is true if the edge is directed to
    /// the neighbour.
    pub around: Vec<Vec<(usize, bool)>>,
    /// The rings, split where they touch themselves. No loop passes a vertex twice.
    pub loops: Vec<Loop>,
}

/// A closed walk that passes no vertex twice.
pub(super) struct Loop {
    /// The ring to which it belongs.
    pub ring: usize,
    pub vertices: Vec<usize>,
}

/// An undirected piece of a side.
struct Piece {
    ends: [usize; 2],
    of: RingSide,
}

impl NodedGraph {
    /// Builds the graph of some rings.
    ///
    /// # Errors
    /// If two sides cross or overlap.
    pub fn of(rings: &[Vec<Point>]) -> Result<Self, RingError> {
        let (points, numbers) = distinct_positions(rings);
        let sides: Vec<Piece> = numbers
            .iter()
            .enumerate()
            .flat_map(|(ring, corners)| {
                let ends = move |side: usize| [corners[side], corners[(side + 1) % corners.len()]];
                (0..corners.len()).map(move |side| Piece { ends: ends(side), of: RingSide { ring, side } })
            })
            // A corner that repeats the previous one is the same corner.
            .filter(|side| side.ends[0] != side.ends[1])
            .collect();
        let cuts = cuts(&points, &sides)?;
        let mut walks: Vec<Vec<usize>> = vec![Vec::new(); rings.len()];
        let mut pieces = Vec::with_capacity(sides.len());
        for (side, mut between) in sides.iter().zip(cuts) {
            let [from, to] = side.ends;
            between.sort_unstable();
            between.dedup();
            if from > to {
                between.reverse();
            }
            let stops = [vec![from], between, vec![to]].concat();
            pieces.extend(stops.windows(2).map(|w| Piece { ends: [w[0].min(w[1]), w[0].max(w[1])], of: side.of }));
            walks[side.of.ring].extend(&stops[..stops.len() - 1]);
        }
        pieces.sort_unstable_by_key(|piece| (piece.ends, piece.of));
        if let Some(w) = pieces.windows(2).find(|w| w[0].ends == w[1].ends) {
            return Err(RingError::Overlap { first: w[0].of, second: w[1].of });
        }
        let (mut edges, mut loops) = (Vec::with_capacity(pieces.len()), Vec::new());
        for (ring, mut walk) in walks.into_iter().enumerate() {
            if is_counter_clockwise(&points, &walk) != (ring == 0) {
                walk.reverse();
            }
            let n = walk.len();
            edges.extend((0..n).map(|i| [walk[i], walk[(i + 1) % n]]));
            loops.extend(split_into_loops(&walk, points.len()).into_iter().map(|vertices| Loop { ring, vertices }));
        }
        let mut around: Vec<Vec<(usize, bool)>> = vec![Vec::new(); points.len()];
        for &[from, to] in &edges {
            around[from].push((to, true));
            around[to].push((from, false));
        }
        for (vertex, ends) in around.iter_mut().enumerate() {
            ends.sort_by(|a, b| counter_clockwise(&points, vertex, a.0, b.0));
        }
        Ok(Self { points, edges, around, loops })
    }
}

/// Compares two edges that leave `at` in different directions, counter-clockwise from straight down.
pub(super) fn counter_clockwise(points: &[Point], at: usize, a: usize, b: usize) -> Ordering {
    // Vertices with higher numbers are to the right, or straight above.
    (a < at).cmp(&(b < at)).then_with(|| match orientation(points[at], points[a], points[b]) {
        Orientation::CounterClockwise => Ordering::Less,
        Orientation::Collinear => Ordering::Equal,
        Orientation::Clockwise => Ordering::Greater,
    })
}

/// Returns the distinct positions from left to right, and for each corner the number of its position.
fn distinct_positions(rings: &[Vec<Point>]) -> (Vec<Point>, Vec<Vec<usize>>) {
    // Adding 0.0 turns -0.0 into 0.0, which `total_cmp` would distinguish.
    let mut points: Vec<Point> = rings.iter().flatten().map(|p| Point::new(p.x + 0.0, p.y + 0.0)).collect();
    let order = |a: &Point, b: &Point| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y));
    points.sort_unstable_by(order);
    points.dedup();
    let number = |p: &Point| {
        let p = Point::new(p.x + 0.0, p.y + 0.0);
        points.binary_search_by(|q| order(q, &p)).unwrap_or_else(|nearest| nearest)
    };
    let numbers = rings.iter().map(|ring| ring.iter().map(number).collect()).collect();
    (points, numbers)
}

/// Returns, for each side, the vertices on it except its ends, in arbitrary order.
fn cuts(points: &[Point], sides: &[Piece]) -> Result<Vec<Vec<usize>>, RingError> {
    let segment = |k: usize| sides[k].ends.map(|v| points[v]);
    let bounds = |k: usize| {
        let [a, b] = segment(k);
        [a.inf(&b), a.sup(&b)]
    };
    let tree = BoxTree::new((0..sides.len()).map(bounds).collect());
    let mut cuts = vec![Vec::new(); sides.len()];
    let mut found = Vec::new();
    for i in 0..sides.len() {
        checkpoint();
        found.clear();
        tree.meeting(&bounds(i), &mut found);
        let [a, b] = segment(i);
        for j in found.iter().map(|j| *j as usize).filter(|j| *j > i) {
            let [c, d] = segment(j);
            if !segments_meet(a, b, c, d) {
                continue;
            }
            if segments_cross(a, b, c, d) {
                return Err(RingError::Cross { first: sides[i].of, second: sides[j].of });
            }
            for (on, by) in [(i, j), (j, i)] {
                let [from, to] = segment(on);
                let inside = |v: &&usize| !sides[on].ends.contains(v) && point_on_segment(points[**v], from, to);
                cuts[on].extend(sides[by].ends.iter().filter(inside));
            }
        }
    }
    Ok(cuts)
}

/// Returns true if a ring is counter-clockwise. It may touch itself, but must not cross or overlap itself. All edges at
/// its leftmost vertex lead to the right, and the outside is below the lowest of them.
pub(super) fn is_counter_clockwise(points: &[Point], walk: &[usize]) -> bool {
    let n = walk.len();
    let Some(&least) = walk.iter().min() else { return true };
    let ends = (0..n).flat_map(|i| {
        let (before, at, after) = (walk[(i + n - 1) % n], walk[i], walk[(i + 1) % n]);
        let here = at == least;
        [(after, true), (before, false)].into_iter().filter(move |_| here)
    });
    let lower = |a: (usize, bool), b: (usize, bool)| {
        let is_left = orientation(points[least], points[a.0], points[b.0]) == Orientation::CounterClockwise;
        if is_left { a } else { b }
    };
    ends.reduce(lower).is_some_and(|(_, goes_out)| goes_out)
}

fn split_into_loops(walk: &[usize], vertices: usize) -> Vec<Vec<usize>> {
    const NO_INDEX: usize = usize::MAX;
    let mut place = vec![NO_INDEX; vertices];
    let (mut loops, mut open) = (Vec::new(), Vec::new());
    for &vertex in walk.iter().chain(walk.first()) {
        if place[vertex] == NO_INDEX {
            place[vertex] = open.len();
            open.push(vertex);
            continue;
        }
        let closed: Vec<usize> = open.split_off(place[vertex] + 1);
        closed.iter().for_each(|v| place[*v] = NO_INDEX);
        loops.push([vec![vertex], closed].concat());
    }
    loops
}
