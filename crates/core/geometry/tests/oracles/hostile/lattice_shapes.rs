//! Convex polygons that touch at a vertex, along a side and from inside, or miss that by a unit.

use super::exact::Pair;
use super::lattice::{PLACES, point};
use super::shapes::{Shape, has_area};
use cplan_cases::dice;
use cplan_cases::dice::Dice;
use cplan_geometry::{Location, Point, point_penetration, polygon_test, segments_cross, segments_meet};
use cplan_testkit::shapes::convex;

type Corner = Pair<i128>;

fn shape(corners: &[Corner], unit: f64) -> Shape<i128> {
    let points: Vec<Point> = corners.iter().map(|&p| point(p, unit)).collect();
    Shape::hull(&points, corners)
}

/// Returns corners with even coordinates, so that midpoints are also on the lattice.
fn corners(dice: &mut Dice, reach: i64, at: Corner) -> Vec<Corner> {
    let count = 1 + dice.below(7);
    let mut even = |x: i128| x + 2 * i128::from(dice.about_zero(reach));
    (0..count).map(|_| (even(at.0), even(at.1))).collect()
}

fn moved(corners: &[Corner], by: Corner) -> Vec<Corner> {
    corners.iter().map(|p| (p.0 + by.0, p.1 + by.1)).collect()
}

/// Returns a polygon that touches `first`.
fn touching(dice: &mut Dice, first: &[Corner], reach: i64) -> Vec<Corner> {
    let n = first.len() as u64;
    let i = dice.below(n) as usize;
    let (a, b) = (first[i], first[(i + 1) % first.len()]);
    let middle = ((a.0 + b.0) / 2, (a.1 + b.1) / 2);
    let reflected = |m: Corner, p: &Corner| (2 * m.0 - p.0, 2 * m.1 - p.1);
    match dice.below(8) {
        // With a vertex at a vertex, or on a side.
        way @ 0..=2 => {
            let other = corners(dice, reach, a);
            let target = if way == 0 { a } else { middle };
            moved(&other, (target.0 - other[0].0, target.1 - other[0].1))
        }
        // Along the whole of a side; at a vertex, all sides in line.
        3 => first.iter().map(|p| reflected(middle, p)).collect(),
        4 => first.iter().map(|p| reflected(a, p)).collect(),
        // From inside, at a vertex and along two sides.
        5 => first.iter().map(|p| ((p.0 + a.0) / 2, (p.1 + a.1) / 2)).collect(),
        // Sides between midpoints of sides, and the same polygon.
        6 => vec![middle, first[dice.below(n) as usize], a],
        _ => first.to_vec(),
    }
}

#[test]
fn pairs_that_touch_or_miss_by_a_unit_are_decided_exactly() {
    let mut dice = dice(3);
    let mut met = 0;
    for round in 0..100_000 {
        let (corner, unit) = PLACES[round % PLACES.len()];
        // Small about a far corner, or as large as the coordinates.
        let reach = [2, 5, 40, 1 << 20, 1 << 49][dice.below(5) as usize];
        let near = if reach == 1 << 49 { 0 } else { i128::from(corner / 2 * 2) };
        // Half of the largest sizes, so that reflections fit 53 bits.
        let at = (near / 2 * 2 / 4, -near / 8 * 2);
        let first = corners(&mut dice, reach, at);
        let mut second = touching(&mut dice, &first, reach);
        if dice.below(2) == 0 {
            second = moved(&second, (i128::from(dice.about_zero(1)), i128::from(dice.about_zero(1))));
        }
        if dice.below(4) == 0 {
            let i = dice.below(second.len() as u64) as usize;
            second[i].0 += i128::from(dice.about_zero(1));
        }
        met += usize::from(shape(&first, unit).check(&shape(&second, unit)));
    }
    assert!((30_000..95_000).contains(&met), "{met}");
}

/// Tests that corners in the middle of sides do not change the convex hull.
#[test]
fn straight_corners_change_nothing() {
    let mut dice = dice(4);
    for round in 0..25_000 {
        let unit = PLACES[round % PLACES.len()].1;
        let first = corners(&mut dice, 3, (0, 0));
        let second = touching(&mut dice, &first, 3);
        let [a, b] = [shape(&first, unit), shape(&second, unit)];
        let [c, d] = [&a, &b].map(|s| padded(&mut dice, s, unit));
        c.check(&d);
        let (plain, with_chain) = (polygon_test(&a.convex(), &b.convex()), polygon_test(&c.convex(), &d.convex()));
        assert_eq!(plain.meet, with_chain.meet);
        for p in b.points {
            let [plain, with_chain] = [&a, &c].map(|s| point_penetration(p, &s.convex()).location);
            assert_eq!(plain, with_chain, "{p:?} in {:?}", c.points);
        }
    }
}

/// Returns the same polygon with additional corners in the middle of sides, in both representations.
fn padded(dice: &mut Dice, shape: &Shape<i128>, unit: f64) -> Shape<i128> {
    let n = shape.exact.len();
    let mut exact = Vec::new();
    for (i, &a) in shape.exact.iter().enumerate() {
        let b = shape.exact[(i + 1) % n];
        exact.push(a);
        let middle = ((a.0 + b.0) / 2, (a.1 + b.1) / 2);
        if n > 2 && dice.below(2) == 0 && (a.0 + b.0) % 2 == 0 && (a.1 + b.1) % 2 == 0 {
            exact.push(middle);
        }
    }
    Shape { points: exact.iter().map(|&p| point(p, unit)).collect(), exact }
}

#[test]
fn every_kind_of_contact_is_decided_exactly() {
    let square: Vec<Corner> = vec![(0, 0), (4, 0), (4, 4), (0, 4)];
    let meets = |other: &[Corner]| {
        let verdicts = PLACES.map(|(_, unit)| shape(&square, unit).check(&shape(other, unit)));
        assert!(verdicts.iter().all(|v| *v == verdicts[0]));
        verdicts[0]
    };
    assert!(meets(&[(4, 4), (6, 4), (6, 6)]), "vertex to vertex");
    assert!(meets(&[(4, 2), (6, 1), (6, 3)]), "vertex to side");
    assert!(meets(&[(4, 0), (8, 0), (8, 4), (4, 4)]), "a whole side");
    assert!(meets(&[(4, 3), (8, 3), (8, 9), (4, 9)]), "part of a side");
    assert!(meets(&[(0, 1), (2, 1), (2, 3), (0, 3)]), "a side from inside");
    assert!(meets(&[(0, 0), (2, 1), (1, 2)]), "a vertex from inside");
    assert!(meets(&[(0, 0), (4, 4)]), "its diagonal");
    assert!(meets(&[(2, 0)]), "a point of a side");
    assert!(!meets(&[(5, 0), (9, 0), (9, 4), (5, 4)]), "a unit away");
    assert!(!meets(&[(0, 5), (4, 9)]) && !meets(&[(5, 5)]) && !meets(&[(5, 4), (9, 0)]), "in line with a side");
    assert!(has_area(&square));
}

/// Tests that points on the line of a wall, but beyond its ends, are outside.
#[test]
fn a_wall_does_not_reach_beyond_its_ends() {
    let [from, to, beyond, farther] = [0.0, 3.0, 4.0, 5.0].map(|x| Point::new(x, x));
    let wall = convex(vec![from, to], 0.0);
    for (t, expected) in [(-1.0, Location::Outside), (0.0, Location::Boundary), (2.5, Location::Boundary)] {
        assert_eq!(point_penetration(Point::new(t, t), &wall).location, expected, "{t}");
    }
    assert!(!polygon_test(&wall, &convex(vec![beyond, farther], 0.0)).meet);
    assert!(!segments_meet(from, to, beyond, farther));
    assert!(!segments_cross(from, to, Point::new(1.0, 1.0), Point::new(2.0, 2.0)));
}
