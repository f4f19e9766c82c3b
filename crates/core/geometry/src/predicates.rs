//! Exact predicates: signs that rounding cannot change.
//!
//! All predicates use the orientation of three points, computed with adaptive exact arithmetic (J. R. Shewchuk, *Adaptive
//! Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates*, 1997). It is exact if no product of two coordinate
//! differences over- or underflows, that is, for coordinates of 0 and of magnitudes from 1e-140 to 1e+140. Such coordinates are
//! multiples of 2^-518, so all parts of a product are multiples of 2^-1036, which doubles can represent.
//!
//! Signs of distances, as in [`super::point_penetration`], are exact for magnitudes from 1e-90 to 1e+90, because the
//! division by a length must not underflow either.

use super::Point;

/// The side of a directed line on which a point lies, or the turn that three points make.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Orientation {
    /// The third point lies to the right: a right turn.
    Clockwise,
    /// The three points lie on one line, or two of them coincide.
    Collinear,
    /// The third point lies to the left: a left turn.
    CounterClockwise,
}

/// Returns the side of the directed line from `a` to `b` on which the point `c` lies; exact.
#[inline]
pub fn orientation(a: Point, b: Point, c: Point) -> Orientation {
    Orientation::of(determinant(a, b, c))
}

impl Orientation {
    #[inline]
    fn of(determinant: f64) -> Self {
        if determinant > 0.0 {
            Self::CounterClockwise
        } else if determinant < 0.0 {
            Self::Clockwise
        } else {
            Self::Collinear
        }
    }
}

/// Returns twice the signed area of the triangle `abc`. The sign is exact, the value rounded.
#[inline]
pub(super) fn determinant(a: Point, b: Point, c: Point) -> f64 {
    let coord = |p: Point| robust::Coord { x: p.x, y: p.y };
    robust::orient2d(coord(a), coord(b), coord(c))
}

/// Returns true if `p` lies strictly inside the circle through the corners of a counter-clockwise triangle; exact.
pub fn in_circle([a, b, c]: [Point; 3], p: Point) -> bool {
    let coord = |p: Point| robust::Coord { x: p.x, y: p.y };
    robust::incircle(coord(a), coord(b), coord(c), coord(p)) > 0.0
}

/// Returns the turn from the direction of the segment `s` to that of the segment `t`; exact.
pub(super) fn turn_of_directions(s: [Point; 2], t: [Point; 2]) -> Orientation {
    // Each product below has three rounding errors, and their difference has a fourth: together at most 2 epsilon of
    // the sum of the products.
    let (u, v) = (s[1] - s[0], t[1] - t[0]);
    let (left, right) = (u.x * v.y, u.y * v.x);
    let difference = left - right;
    if difference.abs() > 4.0 * f64::EPSILON * (left.abs() + right.abs()) {
        return Orientation::of(difference);
    }
    // The cross product of two differences is the volume of a tetrahedron with one edge at height 0 and one at height
    // 1.
    let [a, b] = s.map(|p| robust::Coord3D { x: p.x, y: p.y, z: 0.0 });
    let [c, d] = t.map(|p| robust::Coord3D { x: p.x, y: p.y, z: 1.0 });
    Orientation::of(robust::orient3d(a, b, c, d))
}

/// Returns true if `p` lies on the closed segment `ab`, which may be a point; exact.
pub fn point_on_segment(p: Point, a: Point, b: Point) -> bool {
    boxes_meet(p, p, a, b) && orientation(a, b, p) == Orientation::Collinear
}

/// Returns true if the closed segments `ab` and `cd` have a point in common; exact.
///
/// Touching and overlapping count, and a segment may be a point.
pub fn segments_meet(a: Point, b: Point, c: Point, d: Point) -> bool {
    // For collinear segments, the boxes decide. Otherwise, the segments meet if and only if no line has the other
    // segment strictly on one side. Then the boxes meet, too, so testing them first only saves time.
    boxes_meet(a, b, c, d)
        && !strictly_on_one_side(orientation(a, b, c), orientation(a, b, d))
        && !strictly_on_one_side(orientation(c, d, a), orientation(c, d, b))
}

/// Returns true if the segments `ab` and `cd` cross *properly*, in one point interior to both; exact.
pub fn segments_cross(a: Point, b: Point, c: Point, d: Point) -> bool {
    strictly_apart(orientation(a, b, c), orientation(a, b, d))
        && strictly_apart(orientation(c, d, a), orientation(c, d, b))
}

fn strictly_on_one_side(s: Orientation, t: Orientation) -> bool {
    s == t && s != Orientation::Collinear
}

fn strictly_apart(s: Orientation, t: Orientation) -> bool {
    s != t && s != Orientation::Collinear && t != Orientation::Collinear
}

/// Returns true if the bounding boxes of the segments `ab` and `cd` meet.
fn boxes_meet(a: Point, b: Point, c: Point, d: Point) -> bool {
    a.x.min(b.x) <= c.x.max(d.x)
        && c.x.min(d.x) <= a.x.max(b.x)
        && a.y.min(b.y) <= c.y.max(d.y)
        && c.y.min(d.y) <= a.y.max(b.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Returns the side of the line from `a` to `b` on which `c` lies: positive on the left. Computed in integers,
    /// without rounding and without code of the library.
    fn side(a: (i64, i64), b: (i64, i64), c: (i64, i64)) -> i64 {
        ((b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)).signum()
    }

    /// Returns whether `p` is in the circle through the corners, computed in integers: the sign of the determinant of
    /// the points lifted to a paraboloid.
    fn in_circle_by_determinant(corners: [(i64, i64); 3], p: (i64, i64)) -> bool {
        let [a, b, c] = corners.map(|q| (q.0 - p.0, q.1 - p.1));
        let lift = |q: (i64, i64)| q.0 * q.0 + q.1 * q.1;
        let cross = |q: (i64, i64), r: (i64, i64)| q.0 * r.1 - q.1 * r.0;
        lift(a) * cross(b, c) + lift(b) * cross(c, a) + lift(c) * cross(a, b) > 0
    }

    fn point(p: (i64, i64)) -> Point {
        Point::new(p.0 as f64, p.1 as f64)
    }

    fn lattice() -> impl Strategy<Value = (i64, i64)> {
        (-3..=3i64, -3..=3i64)
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(4000))]

        #[test]
        fn circles_of_the_lattice_agree_with_integer_arithmetic(
            a in lattice(), b in lattice(), c in lattice(), d in lattice(),
        ) {
            prop_assume!(side(a, b, c) > 0);
            let [p, q, r, s] = [a, b, c, d].map(point);
            prop_assert_eq!(in_circle([p, q, r], s), in_circle_by_determinant([a, b, c], d));
        }
    }

    #[test]
    fn orientation_is_exact_where_plain_arithmetic_is_not() {
        // Points within a few ulp of the line y = x. The textbook determinant gives wrong signs here (Kettner et al.).
        let (b, c) = (Point::new(12.0, 12.0), Point::new(24.0, 24.0));
        let ulp = f64::EPSILON / 2.0;
        for i in 0..64 {
            for j in 0..64 {
                let a = Point::new(0.5 + f64::from(i) * ulp, 0.5 + f64::from(j) * ulp);
                let expected = match j.cmp(&i) {
                    std::cmp::Ordering::Less => Orientation::Clockwise,
                    std::cmp::Ordering::Equal => Orientation::Collinear,
                    std::cmp::Ordering::Greater => Orientation::CounterClockwise,
                };
                assert_eq!(orientation(b, c, a), expected, "i = {i}, j = {j}");
            }
        }
    }
}
