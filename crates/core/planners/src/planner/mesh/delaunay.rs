//! Flips edges until no triangle has the far corner of a neighbour in its circumcircle.

use super::{next, previous};
use crate::planner::NO_ENTRY;
use cplan_geometry::planar::HalfEdges;
use cplan_geometry::{Orientation, Point, in_circle, orientation};
use cplan_interrupt::checkpoint;

/// Greatest number of flips per half-edge. Usually there are about two. Adversarial point sets could need a number that
/// grows like the square of their size. With fewer flips, the triangulation is correct, but searches in it are slower.
const MAX_FLIPS_PER_EDGE: usize = 16;

/// Turns a triangulation into the constrained Delaunay triangulation (Lawson 1977) by flipping edges. Its edges are
/// short, so few of them cross a line of sight. The boundary does not change. If four corners lie on a circle, either
/// diagonal may remain.
pub fn flip(vertices: &[Point], edges: &mut HalfEdges) {
    let at = |v: u32| vertices[v as usize];
    let mut left = MAX_FLIPS_PER_EDGE * edges.origin.len();
    let mut stack: Vec<u32> = (0..edges.origin.len() as u32).filter(|&h| h < edges.twin[h as usize]).collect();
    while let Some(h) = stack.pop() {
        checkpoint();
        let g = edges.twin[h as usize];
        if g == NO_ENTRY {
            continue;
        }
        let origin = |h: u32| edges.origin[h as usize];
        let (a, b, c, d) = (origin(h), origin(g), origin(previous(h)), origin(previous(g)));
        if !in_circle([at(a), at(b), at(c)], at(d))
            || !is_triangle(at(d), at(b), at(c))
            || !is_triangle(at(c), at(a), at(d))
        {
            continue;
        }
        if left == 0 {
            return;
        }
        left -= 1;
        // The quadrilateral a d b c has the diagonal a b, and gets the diagonal d c.
        let around = [next(h), previous(h), next(g), previous(g)];
        let [bc, ca, ad, db] = around.map(|h| edges.twin[h as usize]);
        for (slot, from, twin) in
            [(next(h), c, ca), (previous(h), a, ad), (next(g), d, db), (previous(g), b, bc), (h, d, g), (g, c, h)]
        {
            edges.origin[slot as usize] = from;
            edges.twin[slot as usize] = twin;
            if twin != NO_ENTRY {
                edges.twin[twin as usize] = slot;
            }
        }
        stack.extend(around);
    }
}

/// Returns true if three corners are in counter-clockwise order. Flips preserve this order, unless coordinates are so
/// small that `in_circle` underflows.
fn is_triangle(a: Point, b: Point, c: Point) -> bool {
    orientation(a, b, c) == Orientation::CounterClockwise
}
