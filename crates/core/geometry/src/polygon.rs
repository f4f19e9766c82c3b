//! Simple polygons: validation, orientation, area.

use super::planar::first_meeting;
use super::predicates::{Orientation, orientation, point_on_segment, segments_cross};
use super::{Convex, Point, cross, decompose};
use serde::{Deserialize, Serialize};

/// Reasons why a list of corners is not a simple polygon.
///
/// Indices refer to the given list. Side `i` runs from corner `i` to corner `i + 1`, the last one to the first corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum PolygonError {
    /// Fewer than three corners.
    #[error("a polygon needs at least three corners, this one has {count}")]
    TooFewCorners {
        /// The number of given corners.
        count: usize,
    },
    /// A coordinate is infinite or not a number.
    #[error("corner {} has a coordinate that is not finite", corner + 1)]
    NotFinite {
        /// Index of the corner in the list.
        corner: usize,
    },
    /// Two corners lie in the same place.
    #[error("corners {} and {} coincide", first + 1, second + 1)]
    RepeatedCorner {
        /// The corner that comes first in the list.
        first: usize,
        /// The corner that coincides with it.
        second: usize,
    },
    /// All corners lie on one line.
    #[error("all corners lie on one line: the polygon has no area")]
    NoArea,
    /// The boundary turns back on itself.
    #[error("the side after corner {} folds back onto the side before it", corner + 1)]
    Spike {
        /// The corner at the tip.
        corner: usize,
    },
    /// Two sides cross.
    #[error("sides {} and {} cross", first + 1, second + 1)]
    SidesCross {
        /// The lower index.
        first: usize,
        /// The higher index.
        second: usize,
    },
    /// Two sides that are not neighbours touch or overlap.
    #[error("sides {} and {} touch", first + 1, second + 1)]
    SidesTouch {
        /// The lower index.
        first: usize,
        /// The higher index.
        second: usize,
    },
}

/// A polygon whose boundary neither crosses nor touches itself; counter-clockwise.
///
/// Corners in the middle of a straight side are allowed and kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<Point>", into = "Vec<Point>")]
pub struct SimplePolygon {
    corners: Vec<Point>,
}

impl TryFrom<Vec<Point>> for SimplePolygon {
    type Error = PolygonError;

    fn try_from(corners: Vec<Point>) -> Result<Self, PolygonError> {
        Self::new(corners)
    }
}

impl From<SimplePolygon> for Vec<Point> {
    fn from(polygon: SimplePolygon) -> Self {
        polygon.corners
    }
}

impl SimplePolygon {
    /// Creates a polygon from its corners, given in either direction.
    ///
    /// All conditions are decided exactly. `O(n log n)`, or `O(n log^2 n)` if sides meet.
    ///
    /// # Errors
    /// The first defect, in the order of the variants of [`PolygonError`]. If sides meet, it is the first side that
    /// meets an earlier one.
    pub fn new(mut corners: Vec<Point>) -> Result<Self, PolygonError> {
        check_corners(&corners)?;
        check_neighbors(&corners)?;
        check_sides(&corners)?;
        if !is_counter_clockwise(&corners) {
            corners[1..].reverse();
        }
        Ok(Self { corners })
    }

    /// Creates a polygon without checking that it is simple and counter-clockwise.
    pub(super) fn trusted(corners: Vec<Point>) -> Self {
        debug_assert!(Self::new(corners.clone()).is_ok_and(|polygon| polygon.corners == corners), "{corners:?}");
        Self { corners }
    }

    /// Returns the corners, counter-clockwise, starting with the first given one.
    pub fn corners(&self) -> &[Point] {
        &self.corners
    }

    /// Returns the area, square metres.
    pub fn area(&self) -> f64 {
        // Relative to a corner, a small polygon far from the origin loses no digits.
        let origin = self.corners[0];
        self.corners[1..].windows(2).map(|w| cross(w[0] - origin, w[1] - origin)).sum::<f64>() / 2.0
    }

    /// Returns true if the polygon is convex. Straight corners are allowed. Exact.
    pub fn is_convex(&self) -> bool {
        let n = self.corners.len();
        (0..n).all(|i| turn(&self.corners, i) != Orientation::Clockwise)
    }

    /// Returns true if the closed polygon contains a point; exact. `O(n)`.
    pub fn contains(&self, p: Point) -> bool {
        let n = self.corners.len();
        let mut inside = false;
        for (i, &a) in self.corners.iter().enumerate() {
            let b = self.corners[(i + 1) % n];
            if point_on_segment(p, a, b) {
                return true;
            }
            // Test whether the side crosses the ray from `p` in the direction of x. A side contains its lower end, but
            // not its upper end.
            let rises = b.y > a.y;
            let side = if rises { Orientation::CounterClockwise } else { Orientation::Clockwise };
            inside ^= (a.y > p.y) != (b.y > p.y) && orientation(a, b, p) == side;
        }
        inside
    }

    /// Decomposes the polygon into strictly convex polygons with disjoint interiors, without new corners.
    ///
    /// The number of pieces is at most four times the least possible: see [`decompose`].
    pub fn convex_pieces(&self) -> Vec<Convex> {
        decompose(self)
    }
}

/// Returns the turn of the boundary at corner `i`.
pub(super) fn turn(corners: &[Point], i: usize) -> Orientation {
    let n = corners.len();
    orientation(corners[(i + n - 1) % n], corners[i], corners[(i + 1) % n])
}

/// Removes the straight corners of a ring; exact. No corner may repeat the previous one.
pub(super) fn without_straight_corners(ring: &[Point]) -> Vec<Point> {
    (0..ring.len()).filter(|&i| turn(ring, i) != Orientation::Collinear).map(|i| ring[i]).collect()
}

/// Checks the corners, coordinates and area of a ring that may touch itself.
pub(super) fn check_ring(corners: &[Point]) -> Result<(), PolygonError> {
    check_coordinates(corners)?;
    match (0..corners.len()).all(|i| turn(corners, i) == Orientation::Collinear) {
        true => Err(PolygonError::NoArea),
        false => Ok(()),
    }
}

fn check_coordinates(corners: &[Point]) -> Result<(), PolygonError> {
    if corners.len() < 3 {
        return Err(PolygonError::TooFewCorners { count: corners.len() });
    }
    if let Some(corner) = corners.iter().position(|p| !p.x.is_finite() || !p.y.is_finite()) {
        return Err(PolygonError::NotFinite { corner });
    }
    Ok(())
}

/// Checks the number of corners, their coordinates and repetitions.
fn check_corners(corners: &[Point]) -> Result<(), PolygonError> {
    check_coordinates(corners)?;
    let mut order: Vec<usize> = (0..corners.len()).collect();
    // Adding 0.0 turns -0.0 into 0.0, which `total_cmp` would distinguish.
    let key = |i: usize| (corners[i].x + 0.0, corners[i].y + 0.0);
    order.sort_unstable_by(|&i, &j| {
        let (a, b) = (key(i), key(j));
        a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)).then(i.cmp(&j))
    });
    let repeated = order.windows(2).filter(|w| corners[w[0]] == corners[w[1]]).map(|w| (w[0], w[1])).min();
    match repeated {
        Some((first, second)) => Err(PolygonError::RepeatedCorner { first, second }),
        None => Ok(()),
    }
}

/// Checks the area and spikes, by each corner and its neighbours.
fn check_neighbors(corners: &[Point]) -> Result<(), PolygonError> {
    let n = corners.len();
    if (0..n).all(|i| turn(corners, i) == Orientation::Collinear) {
        return Err(PolygonError::NoArea);
    }
    let spike = |&i: &usize| {
        let (before, after) = (corners[(i + n - 1) % n], corners[(i + 1) % n]);
        turn(corners, i) == Orientation::Collinear && !point_on_segment(corners[i], before, after)
    };
    match (0..n).find(spike) {
        Some(corner) => Err(PolygonError::Spike { corner }),
        None => Ok(()),
    }
}

/// Checks that sides meet only their neighbours, and those only in the common corner. Spikes are already excluded.
fn check_sides(corners: &[Point]) -> Result<(), PolygonError> {
    let Some((first, second)) = first_meeting(corners) else { return Ok(()) };
    let side = |i: usize| (corners[i], corners[(i + 1) % corners.len()]);
    let ((a, b), (c, d)) = (side(first), side(second));
    Err(if segments_cross(a, b, c, d) {
        PolygonError::SidesCross { first, second }
    } else {
        PolygonError::SidesTouch { first, second }
    })
}

/// Returns true if a simple boundary is counter-clockwise. The turn at its leftmost (lowest) corner decides, because
/// that corner cannot be straight.
fn is_counter_clockwise(corners: &[Point]) -> bool {
    let lower = |i: usize, j: usize| {
        let (p, q) = (corners[i], corners[j]);
        if (p.x, p.y) < (q.x, q.y) { i } else { j }
    };
    let extreme = (1..corners.len()).fold(0, lower);
    turn(corners, extreme) == Orientation::CounterClockwise
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(list: &[(f64, f64)]) -> Vec<Point> {
        list.iter().map(|&(x, y)| Point::new(x, y)).collect()
    }

    fn error(list: &[(f64, f64)]) -> PolygonError {
        SimplePolygon::new(points(list)).unwrap_err()
    }

    #[test]
    fn each_invalid_polygon_has_its_error() {
        use PolygonError::*;
        assert_eq!(error(&[(0., 0.), (1., 0.)]), TooFewCorners { count: 2 });
        assert_eq!(error(&[(0., 0.), (1., f64::NAN), (1., 1.)]), NotFinite { corner: 1 });
        assert_eq!(error(&[(0., 0.), (1., 0.), (1., 1.), (-0., 0.)]), RepeatedCorner { first: 0, second: 3 });
        assert_eq!(error(&[(0., 0.), (3., 3.), (1., 1.), (2., 2.)]), NoArea);
        assert_eq!(error(&[(0., 0.), (4., 0.), (2., 0.), (2., 2.)]), Spike { corner: 1 });
        assert_eq!(error(&[(0., 0.), (2., 2.), (2., 0.), (0., 2.)]), SidesCross { first: 0, second: 2 });
        // A corner on the opposite side.
        let pinched = [(0., 0.), (4., 0.), (4., 4.), (2., 0.), (0., 4.)];
        assert_eq!(error(&pinched), SidesTouch { first: 0, second: 2 });
        // Two sides that overlap.
        let overlap = [(0., 0.), (4., 0.), (4., 2.), (3., 2.), (3., 0.), (1., 0.), (1., 2.), (0., 2.)];
        assert!(matches!(error(&overlap), SidesTouch { first: 0, .. }));
    }

    #[test]
    fn touching_is_decided_exactly() {
        // The fourth corner is on the line y = x / 3 up to rounding, on one side or on the other.
        let tip = 1.0 / 3.0;
        for (y, simple) in [(tip + f64::EPSILON, true), (tip - f64::EPSILON, false)] {
            let corners = points(&[(0., 0.), (3., 1.), (3., 3.), (1., y), (0., 3.)]);
            assert_eq!(SimplePolygon::new(corners).is_ok(), simple);
        }
    }

    #[test]
    fn either_direction_is_stored_counter_clockwise() {
        let list = [(0., 0.), (2., 0.), (4., 0.), (4., 3.), (2., 1.), (0., 3.)];
        let polygon = SimplePolygon::new(points(&list)).unwrap();
        let mut reversed = list;
        reversed.reverse();
        let other = SimplePolygon::new(points(&reversed)).unwrap();
        assert_eq!(polygon.corners(), points(&list));
        assert_eq!(other.area(), 8.0);
        assert_eq!(polygon.area(), 8.0);
        assert!(!polygon.is_convex());
        assert!(SimplePolygon::new(points(&[(0., 0.), (1., 0.), (2., 0.), (0., 2.)])).unwrap().is_convex());
    }
}
