//! Decomposition of a simple polygon into convex ones.

use super::planar::{Boundary, HalfEdges, NONE, triangulate};
use super::polygon::without_straight;
use super::{Convex, Orientation, Point, SimplePolygon, orientation};
use cplan_interrupt::checkpoint;

/// Corners of the largest piece. What is asked of a piece takes time that grows with its corners; of many smaller ones only
/// those that are near are asked.
pub const MOST_CORNERS: usize = 64;

/// Strictly convex polygons (of radius 0) with disjoint interiors whose union is `polygon`, each of at most
/// [`MOST_CORNERS`] corners.
///
/// A triangulation by a sweep, then removal of every diagonal that no reflex corner needs (S. Hertel, K. Mehlhorn, *Fast
/// Triangulation of Simple Polygons*, 1983): at most four times as many as the least possible number. Pieces with too many
/// corners are cut once more (`cut_up`). All corners are corners of the polygon, so with the exact predicates the
/// union is the polygon itself, without rounding. Straight corners, of the polygon and of pieces, are dropped. `O(n log n)`.
#[must_use]
pub fn decompose(polygon: &SimplePolygon) -> Vec<Convex> {
    // No diagonal is to end at a straight corner.
    let corners = without_straight(polygon.corners());
    let pieces = if polygon.is_convex() {
        vec![corners]
    } else {
        let boundary = Boundary::new(&[&corners]);
        convex_faces(&boundary.vertices, triangulate(&boundary))
    };
    let mut convex = Vec::with_capacity(pieces.len());
    for piece in pieces {
        cut_up(without_straight(&piece), 0.0, &mut convex);
    }
    convex
}

impl Convex {
    /// Shapes of at most [`MOST_CORNERS`] corners whose union is this one: cut along diagonals of the core, which must be
    /// strictly convex. `O(n)`.
    #[must_use]
    pub fn cut_up(self) -> Vec<Self> {
        if self.core().len() <= MOST_CORNERS {
            return vec![self];
        }
        let mut pieces = Vec::new();
        cut_up(self.core().to_vec(), self.radius(), &mut pieces);
        pieces
    }
}

/// Adds a strictly convex polygon grown by `radius`, cut along diagonals into pieces of at most [`MOST_CORNERS`] corners: as
/// few caps of equal length as will do, each cut off by one diagonal, and what the diagonals leave, cut up in turn. So one
/// piece holds the most of the polygon, and the thin ones are at its rim. `O(n)`.
fn cut_up(mut ring: Vec<Point>, radius: f64, out: &mut Vec<Convex>) {
    while ring.len() > MOST_CORNERS {
        checkpoint();
        let n = ring.len();
        let caps = n.div_ceil(MOST_CORNERS - 1);
        let at = |cap: usize| cap * n / caps;
        for cap in 0..caps {
            let mut corners = ring[at(cap)..at(cap + 1)].to_vec();
            corners.push(ring[at(cap + 1) % n]);
            out.push(Convex::trusted(corners, radius));
        }
        ring = (0..caps).map(|cap| ring[at(cap)]).collect();
    }
    // Of two caps nothing is left but the diagonal between them.
    if ring.len() > 2 {
        out.push(Convex::trusted(ring, radius));
    }
}

/// The faces that are left of a triangulation when each side between two triangles is removed whose ends both stay convex.
fn convex_faces(vertices: &[Point], HalfEdges { origin, twin }: HalfEdges) -> Vec<Vec<Point>> {
    let at = |half: usize| vertices[origin[half] as usize];
    // Half-edges before and after each in its face.
    let mut before: Vec<u32> = (0..origin.len() as u32).map(|h| if h % 3 == 0 { h + 2 } else { h - 1 }).collect();
    let mut after: Vec<u32> = (0..origin.len() as u32).map(|h| if h % 3 == 2 { h - 2 } else { h + 1 }).collect();
    let mut removed = vec![false; origin.len()];
    for half in 0..origin.len() {
        let other = twin[half];
        if other == NONE || (other as usize) < half {
            continue;
        }
        let other = other as usize;
        // Where a half-edge begins its own face's boundary arrives, and that of the other face goes on.
        let joints = [(before[half], after[other]), (before[other], after[half])];
        let convex = |(arriving, leaving): (u32, u32)| {
            let corner = at(leaving as usize);
            orientation(at(arriving as usize), corner, at(after[leaving as usize] as usize)) != Orientation::Clockwise
        };
        if joints.into_iter().all(convex) {
            for (arriving, leaving) in joints {
                after[arriving as usize] = leaving;
                before[leaving as usize] = arriving;
            }
            (removed[half], removed[other]) = (true, true);
        }
    }
    let mut faces = Vec::new();
    for first in 0..origin.len() {
        let mut face = Vec::new();
        let mut half = first;
        while !std::mem::replace(&mut removed[half], true) {
            face.push(at(half));
            half = after[half] as usize;
        }
        if !face.is_empty() {
            faces.push(face);
        }
    }
    faces
}
