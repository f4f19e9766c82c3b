//! Polygons with holes. The rings may touch themselves or each other in single points.

mod bridges;
mod faces;
mod noding;

use super::polygon::without_straight_corners;
use super::{Convex, Point, PolygonError, SimplePolygon};
use bridges::join_holes;
use faces::faces;
use noding::NodedGraph;
use std::fmt;

/// The closed region inside an outer ring and outside its holes.
///
/// Rings may touch themselves and each other in single points (a corner on a corner or on a side). They must not cross
/// or overlap. Holes lie inside the outer ring and outside each other. All conditions are decided exactly.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    parts: Vec<SimplePolygon>,
}

/// A side of a given ring. Ring 0 is the outer ring, ring `k` is hole `k`, and side `i` starts at corner `i`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct RingSide {
    /// Number of the ring; 0 is the outer one.
    pub ring: usize,
    /// Number of the side in the ring, from 0.
    pub side: usize,
}

impl fmt::Display for RingSide {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.ring {
            0 => write!(f, "side {}", self.side + 1),
            hole => write!(f, "side {} of hole {hole}", self.side + 1),
        }
    }
}

/// Reasons why rings do not form a polygon. Numbers refer to the given lists.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum RingError {
    /// The outer ring has a defect that does not involve the holes.
    #[error("{0}")]
    Outer(PolygonError),
    /// A hole is not a valid polygon.
    #[error("hole {hole}: {error}")]
    Hole {
        /// Number of the hole, from 1.
        hole: usize,
        /// The defect.
        error: PolygonError,
    },
    /// Two sides cross.
    #[error("{first} and {second} cross")]
    Cross {
        /// The side that was given first.
        first: RingSide,
        /// The side that was given later.
        second: RingSide,
    },
    /// Two sides have more than a point in common.
    #[error("{first} and {second} overlap")]
    Overlap {
        /// The side that was given first.
        first: RingSide,
        /// The side that was given later.
        second: RingSide,
    },
    /// Rings cross, or one lies on the wrong side of the other, at a point where they touch.
    #[error("the boundary crosses itself at ({}, {})", at.x, at.y)]
    CrossesAt {
        /// The point.
        at: Point,
    },
    /// A hole does not lie inside the outer ring and outside all other holes.
    #[error("hole {hole} does not lie inside the outer ring and outside the other holes")]
    Misplaced {
        /// Number of the hole, from 1.
        hole: usize,
    },
}

impl Polygon {
    /// Creates the region inside `outer` and outside `holes`. Rings have either direction and do not repeat their first
    /// corner.
    ///
    /// A simple ring without holes takes as long as [`SimplePolygon::new`]. Otherwise, sides are compared if their
    /// boxes meet, and two diagonals join each hole to its surroundings. Finding a diagonal takes `O(n log n)`.
    ///
    /// # Errors
    /// The first defect found.
    pub fn new(outer: Vec<Point>, holes: Vec<Vec<Point>>) -> Result<Self, RingError> {
        if holes.is_empty() {
            match SimplePolygon::new(outer.clone()) {
                Ok(simple) => return Ok(Self { parts: vec![simple] }),
                // Corners meet but no side crosses, so the inside is well defined.
                Err(PolygonError::RepeatedCorner { .. } | PolygonError::SidesTouch { .. }) => {}
                Err(error) => return Err(RingError::Outer(error)),
            }
        }
        let rings: Vec<Vec<Point>> = std::iter::once(outer).chain(holes).collect();
        for (ring, corners) in rings.iter().enumerate() {
            let error = |error| match ring {
                0 => RingError::Outer(error),
                hole => RingError::Hole { hole, error },
            };
            super::polygon::check_ring(corners).map_err(error)?;
        }
        let noded = NodedGraph::of(&rings)?;
        // Diagonals must not end at straight corners. If sides cross in one, the noding below reports it.
        let bared: Vec<Vec<Point>> = rings.iter().map(|ring| simplified_ring(ring)).collect();
        let noded = if bared == rings { noded } else { NodedGraph::of(&bared).unwrap_or(noded) };
        Ok(Self { parts: faces(&join_holes(noded)?)? })
    }

    /// Returns the polygon as simple polygons with disjoint interiors, whose corners are corners of the rings. There is
    /// one part if the outer ring is simple and there are no holes.
    pub fn parts(&self) -> &[SimplePolygon] {
        &self.parts
    }

    /// Decomposes the polygon into strictly convex polygons with disjoint interiors, without new corners.
    pub fn convex_pieces(&self) -> Vec<Convex> {
        self.parts.iter().flat_map(SimplePolygon::convex_pieces).collect()
    }

    /// Returns the area, square metres.
    pub fn area(&self) -> f64 {
        self.parts.iter().map(SimplePolygon::area).sum()
    }
}

/// Removes straight corners and repetitions from a ring.
fn simplified_ring(ring: &[Point]) -> Vec<Point> {
    let mut once = ring.to_vec();
    once.dedup();
    if once.len() > 1 && once.first() == once.last() {
        once.pop();
    }
    without_straight_corners(&once)
}
