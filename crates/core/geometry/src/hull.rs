//! Convex hull of points.

use super::{Orientation, Point, orientation};

/// Returns the convex hull, counter-clockwise and without collinear corners. It starts at the leftmost corner; if
/// several are leftmost, at the lowest of these.
///
/// Points that coincide give one corner, collinear points give two, and no points give none. Andrew's monotone chain
/// with the exact predicate, so the result is exactly strictly convex. `O(n log n)`. The coordinates must be finite.
pub fn hull(points: &[Point]) -> Vec<Point> {
    let mut sorted = points.to_vec();
    // Adding 0.0 turns -0.0 into 0.0, which `total_cmp` would distinguish.
    let key = |p: &Point| (p.x + 0.0, p.y + 0.0);
    sorted.sort_unstable_by(|a, b| {
        let (a, b) = (key(a), key(b));
        a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let mut corners = Vec::with_capacity(sorted.len());
    append_chain(&mut corners, sorted.iter());
    corners.pop();
    append_chain(&mut corners, sorted.iter().rev());
    corners.pop();
    corners
}

/// Appends the lower hull of `points` in the given order.
fn append_chain<'a>(corners: &mut Vec<Point>, points: impl Iterator<Item = &'a Point>) {
    let start = corners.len();
    for &point in points {
        while let &[.., a, b] = &corners[start..]
            && orientation(a, b, point) != Orientation::CounterClockwise
        {
            corners.pop();
        }
        corners.push(point);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn degenerate_sets_give_points_and_segments() {
        let p = |x, y| Point::new(x, y);
        assert!(hull(&[]).is_empty());
        assert_eq!(hull(&[p(1.0, 2.0), p(1.0, 2.0)]), [p(1.0, 2.0)]);
        assert_eq!(hull(&[p(1.0, 1.0), p(0.0, 0.0), p(3.0, 3.0), p(2.0, 2.0)]), [p(0.0, 0.0), p(3.0, 3.0)]);
        // Negative zero is zero.
        let square = [p(-0.0, 1.0), p(0.0, 0.0), p(1.0, -0.0), p(1.0, 1.0), p(0.0, 0.5), p(-0.0, 0.25)];
        assert_eq!(hull(&square), [p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)]);
    }

    /// Returns the corners of the hull by definition: points that no triangle and no segment of other points contains.
    fn extreme_points(points: &[(i32, i32)]) -> Vec<(i32, i32)> {
        let mut distinct = points.to_vec();
        distinct.sort_unstable();
        distinct.dedup();
        let side = |a: (i32, i32), b: (i32, i32), p: (i32, i32)| {
            ((b.0 - a.0) * (p.1 - a.1) - (b.1 - a.1) * (p.0 - a.0)).signum()
        };
        let between = |a: (i32, i32), b: (i32, i32), p: (i32, i32)| {
            side(a, b, p) == 0 && (a.0 - p.0) * (b.0 - p.0) <= 0 && (a.1 - p.1) * (b.1 - p.1) <= 0
        };
        let covered = |p: (i32, i32)| {
            let others: Vec<_> = distinct.iter().copied().filter(|&q| q != p).collect();
            others.iter().any(|&a| {
                others.iter().any(|&b| {
                    between(a, b, p)
                        || others.iter().any(|&c| {
                            let s = [side(a, b, p), side(b, c, p), side(c, a, p)];
                            side(a, b, c) > 0 && s.iter().all(|&s| s >= 0)
                        })
                })
            })
        };
        distinct.iter().copied().filter(|&p| !covered(p)).collect()
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(500))]

        #[test]
        fn corners_are_the_extreme_points(points in prop::collection::vec((-4..=4i32, -4..=4i32), 1..12)) {
            let input: Vec<Point> = points.iter().map(|&(x, y)| Point::new(x.into(), y.into())).collect();
            let corners = hull(&input);
            let mut found: Vec<_> = corners.iter().map(|p| (p.x as i32, p.y as i32)).collect();
            if found.len() > 2 {
                for i in 0..found.len() {
                    let [a, b, c] = [0, 1, 2].map(|k| found[(i + k) % found.len()]);
                    prop_assert!((b.0 - a.0) * (c.1 - a.1) > (b.1 - a.1) * (c.0 - a.0));
                }
            }
            found.sort_unstable();
            prop_assert_eq!(found, extreme_points(&points));
        }
    }
}
