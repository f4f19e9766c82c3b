//! Exact test whether a convex polygon is part of a polygon.

use crate::decimal::Decimal;
use num_bigint::Sign;

/// A corner of a polygon. Coordinates have exactly the values that are written.
pub type Corner = [Decimal; 2];

/// Returns the side of the line from `a` to `b` on which the point `p` lies: plus for left, minus for right.
pub fn side(a: &Corner, b: &Corner, p: &Corner) -> Sign {
    let cross = |u: &Corner, v: &Corner| &(&u[0] * &v[1]) - &(&u[1] * &v[0]);
    let from_a = |p: &Corner| [&p[0] - &a[0], &p[1] - &a[1]];
    cross(&from_a(b), &from_a(p)).sign()
}

/// Iterates over pairs of a corner and the next one, all around the ring.
pub fn edges(ring: &[Corner]) -> impl Iterator<Item = (&Corner, &Corner)> {
    ring.iter().zip(ring.iter().cycle().skip(1))
}

/// Returns true if each side of the polygon has all other corners on its left. A repeated corner lies on the line of a
/// side, so the result is then false.
pub fn is_convex(ring: &[Corner]) -> bool {
    let others = |from: usize| (2..ring.len()).map(move |k| &ring[(from + k) % ring.len()]);
    ring.len() > 2 && edges(ring).enumerate().all(|(from, (a, b))| others(from).all(|p| side(a, b, p) == Sign::Plus))
}

/// Returns true if the rings enclose a point an odd number of times. The point must not lie on a ring.
pub fn surrounds(rings: &[Vec<Corner>], point: &Corner) -> bool {
    let crosses = |&(a, b): &(&Corner, &Corner)| match (a[1] <= point[1], b[1] <= point[1]) {
        (true, false) => side(a, b, point) == Sign::Plus,
        (false, true) => side(b, a, point) == Sign::Plus,
        _ => false,
    };
    rings.iter().flat_map(|ring| edges(ring)).filter(crosses).count() % 2 == 1
}

/// Returns true if `part`, whose corners turn left, is convex and lies within the region that the rings surround.
///
/// The test shows that no ring enters the interior of the part. For each side of a ring, a line must separate that side
/// from the interior. It may be a line along a side of the part, or along the side of the ring. Then the region
/// contains the interior entirely or not at all, and one of its points decides which.
pub fn holds(rings: &[Vec<Corner>], part: &[Corner]) -> bool {
    let misses = |u: &Corner, v: &Corner| {
        let outside = |a, b| [u, v].iter().all(|p| side(a, b, p) != Sign::Plus);
        let beside = |sign| part.iter().all(|p| side(u, v, p) != sign);
        edges(part).any(|(a, b)| outside(a, b)) || beside(Sign::Plus) || beside(Sign::Minus)
    };
    if !is_convex(part) || !rings.iter().flat_map(|ring| edges(ring)).all(|(u, v)| misses(u, v)) {
        return false;
    }
    let middle = |a: &Corner, b: &Corner| [0, 1].map(|k| Decimal::middle(&a[k], &b[k]));
    surrounds(rings, &middle(&middle(&part[0], &part[1]), &part[2]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(text: &str) -> Vec<Corner> {
        let numbers: Vec<Decimal> = text.split_whitespace().map(|n| n.parse().unwrap()).collect();
        numbers.chunks(2).map(|p| [p[0].clone(), p[1].clone()]).collect()
    }

    #[test]
    fn parts_of_an_l_shape_are_convex_and_inside() {
        let l = [ring("0 0  3 0  3 1  1 1  1 3  0 3")];
        for inside in ["0 0  3 0  3 1", "0 0  3 0  3 1  0 1", "0 0  1 0  1 3  0 3", "0 0  1 1  0 3", "0 3  0 0  1 1"] {
            assert!(holds(&l, &ring(inside)), "{inside}");
        }
        for outside in [
            "0 0  3 0  3 1  0 3",           // Over the notch.
            "3 1  1 3  1 1",                // In the notch.
            "0 0  3 0  3 1  1 1  1 3  0 3", // Not convex.
            "0 0  0 1  3 1",                // Turns right.
            "0 0  3 0  3 1.0000000000000000001",
            "0 0  3 0",
            "0 0  3 0  3 0",
            "0 0  1 0  3 0",
            "5 5  6 5  6 6",
            "0 0  3 0  3 1  0 0  3 0  3 1",
        ] {
            assert!(!holds(&l, &ring(outside)), "{outside}");
        }
        // The ring runs back and forth between corners of two diamonds, through another corner and the gap between them.
        let diamonds = [ring("0 0  0.5 -1  1 0  0.5 1"), ring("2 0  2.5 -1  3 0  2.5 1")];
        assert!(!holds(&diamonds, &ring("0 0  2 0  0 0  2 0")));
        assert!(!holds(&[ring("-9 -9  9 -9  9 9  -9 9")], &ring("0 3  -2 -3  3 1  -3 1  2 -3")));
    }

    #[test]
    fn holes_are_outside_for_both_orientations() {
        let (outer, hole) = ("0 0  9 0  9 9  0 9", "3 3  6 3  6 6  3 6");
        for hole in [ring(hole), ring(hole).into_iter().rev().collect()] {
            let rings = [ring(outer), hole];
            assert!(holds(&rings, &ring("0 0  9 0  6 3  3 3")));
            for outside in [outer, "3 3  6 3  6 6", "4 4  5 4  5 5", "0 0  9 0  4 4"] {
                assert!(!holds(&rings, &ring(outside)), "{outside}");
            }
        }
    }
}
