//! Points and segments on integer lattices. All differences of coordinates are a few units. A unit is either the last
//! place of the coordinates, or far above it.

use super::exact::{self, Pair};
use cplan_cases::dice;
use cplan_cases::dice::Dice;
use cplan_geometry::{Orientation, Point, orientation, point_on_segment, segments_cross, segments_meet};
use std::cmp::Ordering;

/// Corner of the lattice in units, and the unit: a power of two, so that every point is stored exactly. The first three
/// have neighbouring doubles as lattice lines, at magnitudes of 1e-12, 1 and 1e12; the last two lie about the origin.
pub const PLACES: [(i64, f64); 5] = [
    ((1 << 52) + 12_345, exp2(-92)),
    ((1 << 52) + 999, exp2(-52)),
    ((1 << 52) + 77, exp2(-12)),
    (-5, exp2(-40)),
    (-4, exp2(40)),
];

/// Returns a power of two.
pub const fn exp2(exponent: i64) -> f64 {
    f64::from_bits(((1023 + exponent) as u64) << 52)
}

/// Returns the point with these coordinates in units, which must fit 53 bits.
pub fn point(p: Pair<i128>, unit: f64) -> Point {
    let coordinate = |x: i128| {
        assert!(x.unsigned_abs() <= 1 << 53);
        x as f64 * unit
    };
    Point::new(coordinate(p.0), coordinate(p.1))
}

/// Converts a side to the library's type.
fn turned(side: Ordering) -> Orientation {
    match side {
        Ordering::Less => Orientation::Clockwise,
        Ordering::Equal => Orientation::Collinear,
        Ordering::Greater => Orientation::CounterClockwise,
    }
}

/// Tests all triples of points of a 10 x 10 lattice, a million, in each place.
#[test]
fn orientations_of_all_lattice_triples_are_exact() {
    let lattice: Vec<(i64, i64)> = (0..100).map(|i| (i / 10, i % 10)).collect();
    for (corner, unit) in PLACES {
        let points: Vec<Point> =
            lattice.iter().map(|&(x, y)| point((i128::from(corner + x), i128::from(corner - y)), unit)).collect();
        for (i, a) in lattice.iter().enumerate() {
            for (j, b) in lattice.iter().enumerate() {
                for (k, c) in lattice.iter().enumerate() {
                    // Ordinates count downwards.
                    let twice = (b.1 - a.1) * (c.0 - a.0) - (b.0 - a.0) * (c.1 - a.1);
                    let found = orientation(points[i], points[j], points[k]);
                    assert!(found == turned(twice.cmp(&0)), "{a:?} {b:?} {c:?} at {corner}: {found:?}");
                }
            }
        }
    }
}

/// Returns a chain of four points on one line or within a unit or two of it; coordinates of up to 52 bits.
fn chain(dice: &mut Dice) -> [Pair<i128>; 4] {
    let bits = 3 + dice.below(45);
    let most = dice.below(51 - bits).min(20);
    let steps = 1 + dice.below(1 << most) as i64;
    let reach = 1_i64 << bits;
    let direction = (dice.about_zero(reach), dice.about_zero(reach));
    let corner = (dice.about_zero(1 << 50), dice.about_zero(1 << 50));
    [0; 4].map(|_| {
        let along = match dice.below(8) {
            0 => 0,
            1 => steps,
            _ => dice.about_zero(steps),
        };
        let nudge = if dice.below(2) == 0 { (0, 0) } else { (dice.about_zero(1), dice.about_zero(1)) };
        let at = |c: i64, d: i64, n: i64| i128::from(c) + i128::from(along) * i128::from(d) + i128::from(n);
        (at(corner.0, direction.0, nudge.0), at(corner.1, direction.1, nudge.1))
    })
}

#[test]
fn orientations_of_triples_near_lines_are_exact() {
    let mut dice = dice(1);
    let mut collinear = 0;
    for round in 0..1_000_000 {
        let chain = chain(&mut dice);
        let unit = PLACES[round % PLACES.len()].1;
        let points = chain.map(|p| point(p, unit));
        for [i, j, k] in [[0, 1, 2], [3, 1, 2]] {
            let expected = turned(exact::side(&chain[i], &chain[j], &chain[k]));
            assert_eq!(orientation(points[i], points[j], points[k]), expected, "{chain:?} {unit:e}");
            collinear += usize::from(expected == Orientation::Collinear);
        }
    }
    // The test is useful: some of them are on the line, and others are not.
    assert!((200_000..1_800_000).contains(&collinear), "{collinear}");
}

#[test]
fn segments_near_lines_are_decided_exactly() {
    let mut dice = dice(2);
    let mut counts = [0; 3];
    for round in 0..1_000_000 {
        let mut ends = chain(&mut dice);
        if dice.below(2) == 0 {
            // Across the line, from one of its points or from a point beside it.
            let (p, q) = (ends[3], ends[2]);
            ends[3] = (p.0 - (p.1 - q.1) / 2, p.1 + (p.0 - q.0) / 2);
        }
        let unit = PLACES[round % PLACES.len()].1;
        let [a, b, c, d] = ends.map(|p| point(p, unit));
        let (meet, cross) = exact::segments([&ends[0], &ends[1]], [&ends[2], &ends[3]]);
        assert_eq!(segments_meet(a, b, c, d), meet, "{ends:?} {unit:e}");
        assert_eq!(segments_cross(a, b, c, d), cross, "{ends:?} {unit:e}");
        let on = exact::segments([&ends[0], &ends[0]], [&ends[2], &ends[3]]).0;
        assert_eq!(point_on_segment(a, c, d), on, "{ends:?} {unit:e}");
        counts = [counts[0] + usize::from(meet), counts[1] + usize::from(cross), counts[2] + usize::from(on)];
    }
    assert!(counts.iter().all(|n| (10_000..900_000).contains(n)), "{counts:?}");
}
