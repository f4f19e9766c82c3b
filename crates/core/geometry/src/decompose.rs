//! Decomposition of a simple polygon into convex pieces.

use super::planar::{Boundary, HalfEdges, NO_ENTRY, triangulate};
use super::polygon::without_straight_corners;
use super::{Convex, Orientation, Point, SimplePolygon, orientation};
use cplan_interrupt::checkpoint;

/// Largest number of corners of a piece. The time of a query grows with the corners of the examined pieces. If pieces
/// are small, only nearby ones are examined.
pub const MAX_CORNERS: usize = 64;

/// Decomposes a polygon into strictly convex polygons (of radius 0) with disjoint interiors, each of at most
/// [`MAX_CORNERS`] corners. Their union is `polygon`. `O(n log n)`.
///
/// A sweep triangulates the polygon. Then all diagonals that no reflex corner needs are removed (S. Hertel, K.
/// Mehlhorn, *Fast Triangulation of Simple Polygons*, 1983). The number of pieces is at most four times the least
/// possible. Pieces with too many corners are cut further by `cut_up`.
///
/// All corners are corners of the polygon and the predicates are exact, so the union has no rounding. Straight corners
/// of the polygon and of the pieces are removed.
pub fn decompose(polygon: &SimplePolygon) -> Vec<Convex> {
    // Diagonals must not end at straight corners.
    let corners = without_straight_corners(polygon.corners());
    let pieces = if polygon.is_convex() {
        vec![corners]
    } else {
        let boundary = Boundary::new(&[&corners]);
        convex_faces(&boundary.vertices, triangulate(&boundary))
    };
    let mut convex = Vec::with_capacity(pieces.len());
    for piece in pieces {
        cut_up(without_straight_corners(&piece), 0.0, &mut convex);
    }
    convex
}

impl Convex {
    /// Cuts the shape along diagonals into shapes of at most [`MAX_CORNERS`] corners. The core must be strictly
    /// convex. `O(n)`.
    #[must_use]
    pub fn cut_up(self) -> Vec<Self> {
        if self.core().len() <= MAX_CORNERS {
            return vec![self];
        }
        let mut pieces = Vec::new();
        cut_up(self.core().to_vec(), self.radius(), &mut pieces);
        pieces
    }
}

/// Cuts a strictly convex polygon, grown by `radius`, along diagonals into pieces of at most [`MAX_CORNERS`] corners,
/// and appends them to `out`. `O(n)`.
///
/// Each round cuts off caps of equal length, as few as possible, and continues with the rest. So one piece has most of
/// the area, and thin pieces are at the rim.
fn cut_up(mut ring: Vec<Point>, radius: f64, out: &mut Vec<Convex>) {
    while ring.len() > MAX_CORNERS {
        checkpoint();
        let n = ring.len();
        let caps = n.div_ceil(MAX_CORNERS - 1);
        let at = |cap: usize| cap * n / caps;
        for cap in 0..caps {
            let mut corners = ring[at(cap)..at(cap + 1)].to_vec();
            corners.push(ring[at(cap + 1) % n]);
            out.push(Convex::trusted(corners, radius));
        }
        ring = (0..caps).map(|cap| ring[at(cap)]).collect();
    }
    // Between two caps, only the diagonal remains.
    if ring.len() > 2 {
        out.push(Convex::trusted(ring, radius));
    }
}

/// Merges triangles into convex faces. Removes an inner side if both of its ends stay convex.
fn convex_faces(vertices: &[Point], HalfEdges { origin, twin }: HalfEdges) -> Vec<Vec<Point>> {
    let at = |half: usize| vertices[origin[half] as usize];
    // For each half-edge, the previous and the next one in its face.
    let mut before: Vec<u32> = (0..origin.len() as u32).map(|h| if h % 3 == 0 { h + 2 } else { h - 1 }).collect();
    let mut after: Vec<u32> = (0..origin.len() as u32).map(|h| if h % 3 == 2 { h - 2 } else { h + 1 }).collect();
    let mut removed = vec![false; origin.len()];
    for half in 0..origin.len() {
        let other = twin[half];
        if other == NO_ENTRY || (other as usize) < half {
            continue;
        }
        let other = other as usize;
        // At the origin of a half-edge, the boundary of its own face arrives, and the boundary of the other face continues.
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
