//! Convex polygons, moved inwards on all sides.

use super::{Point, Vector, hull, perpendicular};

/// Returns the points of a convex, counter-clockwise polygon that lie at least `by` inside all its sides. Returns
/// `None` if they have no area. `O(n^2)`.
///
/// The result stays within the polygon if it is moved by up to `by` in any direction.
pub fn inset(polygon: &[Point], by: f64) -> Option<Vec<Point>> {
    let mut left = polygon.to_vec();
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let normal = perpendicular(b - a).try_normalize(0.0)?;
        left = clip(&left, normal, normal.dot(&a) + by);
    }
    let left = hull(&left);
    (left.len() > 2).then_some(left)
}

/// Returns the part of a convex polygon (or segment, or point) where `normal . p >= offset`. `O(n)`.
fn clip(polygon: &[Point], normal: Vector, offset: f64) -> Vec<Point> {
    let n = polygon.len();
    let height = |p: Point| normal.dot(&p) - offset;
    let mut left = Vec::with_capacity(n + 1);
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % n];
        let (ha, hb) = (height(a), height(b));
        if ha >= 0.0 {
            left.push(a);
        }
        if (ha > 0.0 && hb < 0.0) || (ha < 0.0 && hb > 0.0) {
            left.push(a + (b - a) * (ha / (ha - hb)));
        }
    }
    left
}

/// Returns the intersection of a convex polygon (or segment, or point) with a convex polygon that has area. The result
/// may repeat corners, and is empty if the two do not meet. `O(n m)`.
pub fn common(polygon: &[Point], with: &[Point]) -> Vec<Point> {
    let mut left = polygon.to_vec();
    for (i, &a) in with.iter().enumerate() {
        let normal = perpendicular(with[(i + 1) % with.len()] - a);
        left = clip(&left, normal, normal.dot(&a));
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::penetration::core_penetration;
    use proptest::prelude::*;

    fn points(list: &[(f64, f64)]) -> Vec<Point> {
        list.iter().map(|&(x, y)| Point::new(x, y)).collect()
    }

    #[test]
    fn the_inset_of_a_square() {
        let square = points(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]);
        assert_eq!(inset(&square, 1.0), Some(points(&[(1.0, 1.0), (3.0, 1.0), (3.0, 3.0), (1.0, 3.0)])));
        assert_eq!(inset(&square, 2.0), None);
        assert_eq!(inset(&square[..2], 0.1), None);
    }

    #[test]
    fn segments_are_clipped_to_a_polygon() {
        let square = points(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]);
        let cut = hull(&common(&points(&[(-1.0, 2.0), (2.0, 2.0)]), &square));
        assert_eq!(cut, points(&[(0.0, 2.0), (2.0, 2.0)]));
        assert!(common(&points(&[(-1.0, 5.0), (2.0, 5.0)]), &square).is_empty());
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        #[test]
        fn points_are_left_as_far_as_they_lie_deep(
            corners in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64), 3..9),
            by in 0.0..0.4f64,
            at in (-1.0..1.0f64, -1.0..1.0f64),
        ) {
            let polygon = hull(&points(&corners));
            prop_assume!(polygon.len() > 2);
            let p = Point::new(at.0, at.1);
            let depth = core_penetration(p, &polygon).depth;
            prop_assume!((depth - by).abs() > 1e-9);
            let left = inset(&polygon, by);
            let inside = left.is_some_and(|left| core_penetration(p, &left).depth >= 0.0);
            prop_assert_eq!(inside, depth > by);
        }
    }
}
