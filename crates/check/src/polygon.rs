//! Whether a convex polygon is part of a polygon, without rounding.

use crate::decimal::Decimal;
use num_bigint::Sign;

/// Coordinates as they are written.
pub type Corner = [Decimal; 2];

/// On which side of the line from `a` to `b` a point lies: plus on the left.
pub fn side(a: &Corner, b: &Corner, p: &Corner) -> Sign {
    let cross = |u: &Corner, v: &Corner| &(&u[0] * &v[1]) - &(&u[1] * &v[0]);
    let from_a = |p: &Corner| [&p[0] - &a[0], &p[1] - &a[1]];
    cross(&from_a(b), &from_a(p)).sign()
}

/// Corner and next corner, all round.
pub fn edges(ring: &[Corner]) -> impl Iterator<Item = (&Corner, &Corner)> {
    ring.iter().zip(ring.iter().cycle().skip(1))
}

/// Whether each side has all other corners on its left. A corner that comes twice is on the line of a side.
pub fn is_convex(ring: &[Corner]) -> bool {
    let others = |from: usize| (2..ring.len()).map(move |k| &ring[(from + k) % ring.len()]);
    ring.len() > 2 && edges(ring).enumerate().all(|(from, (a, b))| others(from).all(|p| side(a, b, p) == Sign::Plus))
}

/// Whether a point that lies on no ring is surrounded by them an odd number of times.
pub fn surrounds(rings: &[Vec<Corner>], point: &Corner) -> bool {
    let crosses = |&(a, b): &(&Corner, &Corner)| match (a[1] <= point[1], b[1] <= point[1]) {
        (true, false) => side(a, b, point) == Sign::Plus,
        (false, true) => side(b, a, point) == Sign::Plus,
        _ => false,
    };
    rings.iter().flat_map(|ring| edges(ring)).filter(crosses).count() % 2 == 1
}

/// Whether `part`, whose corners turn left, is convex and part of what the rings surround.
///
/// No ring enters the part's inside: a line separates each of its sides from there, along one of the part's sides or along
/// itself. So the inside belongs to the polygon as a whole or not at all, which one point of it decides.
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
    fn parts_of_an_l() {
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
        // There and back between corners of two diamonds, through another corner and the room between them.
        let diamonds = [ring("0 0  0.5 -1  1 0  0.5 1"), ring("2 0  2.5 -1  3 0  2.5 1")];
        assert!(!holds(&diamonds, &ring("0 0  2 0  0 0  2 0")));
        assert!(!holds(&[ring("-9 -9  9 -9  9 9  -9 9")], &ring("0 3  -2 -3  3 1  -3 1  2 -3")));
    }

    #[test]
    fn holes_are_outside_whichever_way_they_turn() {
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
