//! Convex hull of points.

use super::{Orientation, Point, orientation};

/// Returns the convex hull, counter-clockwise and without collinear corners. It starts at the leftmost corner; if
/// several are leftmost, at the lowest of these.
///
/// Coincident points give one corner, collinear points two, and no points none. The method is Andrew's monotone chain
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
}
