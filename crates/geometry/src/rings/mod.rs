//! Polygons as people have them: with holes, and with rings that touch themselves or each other in single points.

mod bridges;
mod faces;
mod noding;

use super::polygon::without_straight;
use super::{Convex, Point, PolygonError, SimplePolygon};
use bridges::bridged;
use faces::faces;
use noding::Noded;
use std::fmt;

/// The closed region inside an outer ring and outside its holes.
///
/// Rings may touch themselves and each other in single points (a corner on a corner or on a side); they neither cross nor
/// share a stretch. Holes lie inside the outer ring and outside each other. All of it is decided exactly.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    parts: Vec<SimplePolygon>,
}

/// A side of a ring, as given: ring 0 is the outer one, hole `k` is ring `k`; side `i` follows corner `i`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct RingSide {
    /// The number of the ring; 0 is the outer one.
    pub ring: usize,
    /// The number of the side in the ring, from 0.
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

/// Why rings make no polygon. Numbers refer to the lists as they were given.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum RingError {
    /// The outer ring has a defect that has nothing to do with the holes.
    #[error("{0}")]
    Outer(PolygonError),
    /// A hole by itself is no polygon.
    #[error("hole {hole}: {error}")]
    Hole {
        /// Counted from 1.
        hole: usize,
        /// What is wrong with it.
        error: PolygonError,
    },
    /// Two sides cross.
    #[error("{first} and {second} cross")]
    Cross {
        /// The one given first.
        first: RingSide,
        /// The one given later.
        second: RingSide,
    },
    /// Two sides have more than a point in common.
    #[error("{first} and {second} overlap")]
    Overlap {
        /// The one given first.
        first: RingSide,
        /// The one given later.
        second: RingSide,
    },
    /// Where rings touch, one passes through the other or lies on its wrong side.
    #[error("the boundary crosses itself at ({}, {})", at.x, at.y)]
    CrossesAt {
        /// The point at which it does.
        at: Point,
    },
    /// A hole does not lie inside the outer ring and outside all other holes.
    #[error("hole {hole} does not lie inside the outer ring and outside the other holes")]
    Misplaced {
        /// Counted from 1.
        hole: usize,
    },
}

impl Polygon {
    /// The region inside `outer` and outside `holes`, rings in either direction, the first corner not repeated at the end.
    ///
    /// A simple ring without holes costs what [`SimplePolygon::new`] costs. Otherwise sides are compared where their boxes
    /// meet, and each hole is joined to its surroundings by two diagonals, each of which is looked for in `O(n log n)`.
    ///
    /// # Errors
    /// The first defect found.
    pub fn new(outer: Vec<Point>, holes: Vec<Vec<Point>>) -> Result<Self, RingError> {
        if holes.is_empty() {
            match SimplePolygon::new(outer.clone()) {
                Ok(simple) => return Ok(Self { parts: vec![simple] }),
                // Corners that meet without any side crossing: what is inside is clear.
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
        let noded = Noded::of(&rings)?;
        // No hole is to be joined to a straight corner. Where sides cross in one that is told below.
        let bared: Vec<Vec<Point>> = rings.iter().map(|ring| bare(ring)).collect();
        let noded = if bared == rings { noded } else { Noded::of(&bared).unwrap_or(noded) };
        Ok(Self { parts: faces(&bridged(noded)?)? })
    }

    /// The polygon as simple polygons with disjoint interiors, whose corners are corners of the rings; one if the outer ring
    /// is simple and there are no holes.
    #[must_use]
    pub fn parts(&self) -> &[SimplePolygon] {
        &self.parts
    }

    /// Strictly convex polygons with disjoint interiors whose union is this polygon; no new corners.
    #[must_use]
    pub fn convex_pieces(&self) -> Vec<Convex> {
        self.parts.iter().flat_map(SimplePolygon::convex_pieces).collect()
    }

    /// Area, square metres.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.parts.iter().map(SimplePolygon::area).sum()
    }
}

/// A ring without straight corners, and without repetitions.
fn bare(ring: &[Point]) -> Vec<Point> {
    let mut once = ring.to_vec();
    once.dedup();
    if once.len() > 1 && once.first() == once.last() {
        once.pop();
    }
    without_straight(&once)
}
