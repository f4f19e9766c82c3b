//! Straight motions from triangle to triangle.

use super::Mesh;
use cplan_geometry::{Orientation, Point, orientation};

impl Mesh {
    /// Returns true if the segment from `a` to `b` lies in free space. Exact; linear in the number of triangles
    /// crossed. A segment through a vertex, or along an edge into another triangle, counts as not free. Between random
    /// points this does not happen.
    pub fn is_clear(&self, a: Point, b: Point) -> bool {
        self.triangles_at(a).any(|triangle| self.walk(triangle, a, b).is_some())
    }

    /// Returns the half-edges through which the segment from `a` to `b`, which begins in `triangle`, leaves triangles.
    /// `None` if the segment counts as not free, see [`Mesh::is_clear`].
    pub fn walk(&self, triangle: u32, a: Point, b: Point) -> Option<Vec<u32>> {
        let mut portals = Vec::new();
        let mut at = triangle;
        loop {
            let sides = 3 * at..3 * at + 3;
            let is_beyond = |side: u32| {
                let [from, to] = self.ends(side);
                orientation(from, to, b) == Orientation::Clockwise
            };
            if !sides.clone().any(is_beyond) {
                return Some(portals);
            }
            let leaves = |&side: &u32| {
                let [right, left] = self.ends(side).map(|end| orientation(a, b, end));
                right == Orientation::Clockwise && left == Orientation::CounterClockwise && is_beyond(side)
            };
            let portal = sides.clone().find(leaves)?;
            portals.push(portal);
            at = self.twin(portal)? / 3;
        }
    }

    /// Returns the half-edges of a triangle that it shares with another triangle.
    pub fn portals(&self, triangle: u32) -> impl Iterator<Item = u32> + '_ {
        (3 * triangle..3 * triangle + 3).filter(|&side| !self.is_wall(side))
    }
}
