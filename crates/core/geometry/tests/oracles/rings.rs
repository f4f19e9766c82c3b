//! Polygons with holes and touching corners: their covered area, against counting cells and casting rays in integers.

use crate::lattice::{Corner, point};
use cplan_cases::dice::Dice;
use cplan_cases::{dice, times, uses_default_cases};
use cplan_geometry::{Convex, Orientation, Point, Polygon, RingError, orientation};
use std::collections::{BTreeMap, BTreeSet};

fn points(ring: &[Corner]) -> Vec<Point> {
    ring.iter().map(|corner| point(*corner)).collect()
}

fn polygon(rings: &[Vec<Corner>]) -> Result<Polygon, RingError> {
    Polygon::new(points(&rings[0]), rings[1..].iter().map(|ring| points(ring)).collect())
}

/// Returns true if a strictly convex piece contains a point.
fn contains(piece: &Convex, p: Point) -> bool {
    let core = piece.core();
    (0..core.len()).all(|i| orientation(core[i], core[(i + 1) % core.len()], p) != Orientation::Clockwise)
}

/// Returns true if a ray from a point crosses a ring an odd number of times. No corner has the same height as the
/// point.
fn is_inside(ring: &[Corner], p: Point) -> bool {
    let crosses = |i: usize| {
        let (a, b) = (point(ring[i]), point(ring[(i + 1) % ring.len()]));
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
    };
    (0..ring.len()).filter(|i| crosses(*i)).count() % 2 == 1
}

/// Checks that pieces are strictly convex and counter-clockwise, and that they cover exactly the required area.
fn check_cover(pieces: &[Convex], area: f64, inside: impl Fn(Point) -> bool, samples: &[Point]) {
    for piece in pieces {
        let core = piece.core();
        for i in 0..core.len() {
            let [a, b, c] = [i, i + 1, i + 2].map(|k| core[k % core.len()]);
            assert_eq!(orientation(a, b, c), Orientation::CounterClockwise, "{core:?}");
        }
    }
    let sum: f64 = pieces.iter().map(Convex::area).sum();
    assert!((sum - area).abs() < 1e-9 * area.max(1.0), "{sum} {area}");
    for &p in samples {
        let holding = pieces.iter().filter(|piece| contains(piece, p)).count();
        assert_eq!(holding, usize::from(inside(p)), "{p:?}");
    }
}

const SIDE: i64 = 7;

/// Returns random cells that are connected by their sides.
fn connected_cells(dice: &mut Dice) -> BTreeSet<Corner> {
    let mut cells = BTreeSet::from([(SIDE / 2, SIDE / 2)]);
    for _ in 0..dice.below(200) {
        let (x, y) = (dice.below(SIDE as u64) as i64, dice.below(SIDE as u64) as i64);
        if [(1, 0), (-1, 0), (0, 1), (0, -1)].iter().any(|(dx, dy)| cells.contains(&(x + dx, y + dy))) {
            cells.insert((x, y));
        }
        // Cells are removed as long as the rest stays connected. That makes holes and touching corners.
        let (x, y) = (dice.below(SIDE as u64) as i64, dice.below(SIDE as u64) as i64);
        let less: BTreeSet<Corner> = cells.iter().copied().filter(|c| *c != (x, y)).collect();
        if dice.below(2) == 0 && is_connected(&less) {
            cells = less;
        }
    }
    cells
}

fn is_connected(cells: &BTreeSet<Corner>) -> bool {
    let Some(first) = cells.first() else { return false };
    let (mut seen, mut open) = (BTreeSet::from([*first]), vec![*first]);
    while let Some((x, y)) = open.pop() {
        for next in [(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)] {
            if cells.contains(&next) && seen.insert(next) {
                open.push(next);
            }
        }
    }
    seen.len() == cells.len()
}

/// Returns the boundary of cells as rings, with the cells to the left. Where four sides meet in a point, all rings turn
/// left if `turn_left`, otherwise right.
fn boundary(cells: &BTreeSet<Corner>, turn_left: bool) -> Vec<Vec<Corner>> {
    let mut sides: BTreeMap<Corner, Vec<Corner>> = BTreeMap::new();
    for &(x, y) in cells {
        for ((ax, ay), (bx, by), (nx, ny)) in
            [((0, 0), (1, 0), (0, -1)), ((1, 0), (1, 1), (1, 0)), ((1, 1), (0, 1), (0, 1)), ((0, 1), (0, 0), (-1, 0))]
        {
            if !cells.contains(&(x + nx, y + ny)) {
                sides.entry((x + ax, y + ay)).or_default().push((x + bx, y + by));
            }
        }
    }
    let mut rings = Vec::new();
    while let Some((&start, to)) = sides.iter().find(|(_, to)| !to.is_empty()) {
        let mut ring = vec![start];
        let (mut before, mut at) = (start, to[0]);
        sides.get_mut(&start).unwrap().remove(0);
        loop {
            let to = sides.get_mut(&at).unwrap();
            let direction = (at.0 - before.0, at.1 - before.1);
            let left = (at.0 - direction.1, at.1 + direction.0);
            let pick = match to.len() {
                0 => break,
                1 => 0,
                _ => to.iter().position(|next| (*next == left) == turn_left).unwrap(),
            };
            ring.push(at);
            before = at;
            at = to.remove(pick);
        }
        rings.push(ring);
    }
    rings
}

fn twice_area(ring: &[Corner]) -> i64 {
    (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()])).map(|(a, b)| a.0 * b.1 - a.1 * b.0).sum()
}

/// Returns a ring as a user might write it: from any corner, in either direction, with or without straight corners.
fn as_written(dice: &mut Dice, ring: &[Corner]) -> Vec<Corner> {
    let n = ring.len();
    let keep_straight = dice.below(3);
    let is_straight = |i: usize| {
        let (a, b, c) = (ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]);
        (b.0 - a.0, b.1 - a.1) == (c.0 - b.0, c.1 - b.1)
    };
    let mut written: Vec<Corner> =
        (0..n).filter(|i| !is_straight(*i) || dice.below(3) < keep_straight).map(|i| ring[i]).collect();
    let start = dice.below(written.len() as u64) as usize;
    written.rotate_left(start);
    if dice.below(2) == 0 {
        written.reverse();
    }
    written
}

#[test]
fn cells_are_covered_whatever_the_rings_touch() {
    let mut dice = dice(0x0051_65e1);
    let (mut holed, mut touching) = (0, 0);
    for _ in 0..times(600) {
        let cells = connected_cells(&mut dice);
        let turn_left = dice.below(2) == 0;
        let mut rings = boundary(&cells, turn_left);
        rings.sort_by_key(|ring| -twice_area(ring));
        // Sheared, so that not all sides are horizontal or vertical.
        let shear = dice.below(3) as i64;
        let sheared = |(x, y): Corner| (3 * x + shear * y, 2 * y - shear * x);
        let determinant = 6 + shear * shear;
        let written: Vec<Vec<Corner>> =
            rings.iter().map(|ring| as_written(&mut dice, ring).into_iter().map(sheared).collect()).collect();
        let polygon = polygon(&written).unwrap_or_else(|error| panic!("{error}: {written:?}"));
        holed += usize::from(rings.len() > 1);
        touching += usize::from(rings.iter().any(|r| r.iter().collect::<BTreeSet<_>>().len() < r.len()));
        let middle = |x: i64, y: i64| {
            let (x, y, s) = (x as f64 + 0.5, y as f64 + 0.5, shear as f64);
            Point::new(3.0 * x + s * y, 2.0 * y - s * x)
        };
        let all: Vec<(Point, bool)> = (-1..=SIDE)
            .flat_map(|x| (-1..=SIDE).map(move |y| (x, y)))
            .map(|(x, y)| (middle(x, y), cells.contains(&(x, y))))
            .collect();
        let wanted = |p: Point| all.iter().any(|(q, inside)| *q == p && *inside);
        let samples: Vec<Point> = all.iter().map(|(p, _)| *p).collect();
        // Centres of cells can lie on diagonals, so areas decide if pieces share a centre.
        let pieces = polygon.convex_pieces();
        let sum: f64 = pieces.iter().map(Convex::area).sum();
        assert!((sum - cells.len() as f64 * determinant as f64).abs() < 1e-9 * sum);
        for p in samples {
            assert_eq!(pieces.iter().any(|piece| contains(piece, p)), wanted(p), "{p:?} {written:?}");
        }
    }
    assert!(!uses_default_cases() || holed > 40 && touching > 40, "{holed} {touching}");
}

/// Tests that an accepted polygon covers the area that counting crossings gives. A refused one has a crossing, an
/// overlap, or a ring on the wrong side; other tests name the cases without any of these.
#[test]
fn random_rings_are_refused_or_covered() {
    let mut dice = dice(7);
    let mut taken = 0;
    for _ in 0..times(6000) {
        let mut ring = |most: u64| -> Vec<Corner> {
            (0..3 + dice.below(most)).map(|_| (dice.below(9) as i64, dice.below(9) as i64)).collect()
        };
        let rings: Vec<Vec<Corner>> = if twice_area(&ring(1)) % 2 == 0 {
            vec![ring(5)]
        } else {
            vec![vec![(-1, -2), (10, -1), (11, 10), (-2, 11)], ring(2), ring(1)]
        };
        let Ok(polygon) = polygon(&rings) else { continue };
        taken += usize::from(rings.len() > 1);
        let inside = |p: Point| is_inside(&rings[0], p) && rings[1..].iter().all(|hole| !is_inside(hole, p));
        let samples: Vec<Point> = (0..40)
            .map(|k| {
                Point::new(-1.9 + 0.317 * f64::from(k) + 1e-3 * 2f64.sqrt(), -1.31 + 0.2918 * f64::from(k * 7 % 40))
            })
            .collect();
        let area =
            (twice_area(&rings[0]).abs() - rings[1..].iter().map(|r| twice_area(r).abs()).sum::<i64>()) as f64 / 2.0;
        check_cover(&polygon.convex_pieces(), area, inside, &samples);
    }
    assert!(!uses_default_cases() || taken > 50, "{taken}");
}

#[test]
fn impossible_rings_are_reported() {
    let square = |x: i64, y: i64, size: i64| vec![(x, y), (x + size, y), (x + size, y + size), (x, y + size)];
    // A hole that touches a corner of the outer ring from inside is allowed.
    for (dx, dy) in [(0, 0), (9, 0), (9, 9), (0, 9)] {
        let (sx, sy) = (if dx == 0 { 1 } else { -1 }, if dy == 0 { 1 } else { -1 });
        let hung = vec![(dx, dy), (dx + 3 * sx, dy + sy), (dx + sx, dy + 3 * sy)];
        assert_eq!(polygon(&[square(0, 0, 9), hung]).unwrap().area(), 77.0);
    }
    let cases = [
        (vec![square(0, 0, 9), square(20, 0, 2)], "hole 1 does not lie inside the outer ring"),
        (vec![square(0, 0, 9), square(-20, 0, 2)], "hole 1 does not lie inside the outer ring"),
        (vec![square(0, 0, 9), square(-1, -1, 20)], "hole 1 does not lie inside the outer ring"),
        (vec![square(0, 0, 9), square(1, 1, 6), square(2, 2, 1)], "hole 2 does not lie inside the outer ring"),
        (vec![square(0, 0, 9), square(1, 1, 3), square(2, 2, 4)], "side 2 of hole 1 and side 1 of hole 2 cross"),
        (vec![square(0, 0, 9), square(5, 5, 9)], "side 2 and side 1 of hole 1 cross"),
        (vec![square(0, 0, 9), square(9, 9, 3)], "hole 1 does not lie inside the outer ring"),
        (vec![square(0, 0, 9), vec![(0, 9), (3, 12), (9, 9), (3, 13)]], "hole 1 does not lie inside the outer ring"),
        (vec![square(0, 0, 9), square(0, 2, 3)], "side 4 and side 4 of hole 1 overlap"),
        (vec![square(0, 0, 9), vec![(2, 2), (3, 3), (4, 4)]], "hole 1: all corners lie on one line"),
        (vec![square(0, 0, 9), vec![(2, 2), (3, 3)]], "hole 1: a polygon needs at least three corners"),
        // A figure of eight with a corner in its crossing.
        (vec![vec![(0, 0), (2, 2), (4, 4), (4, 0), (2, 2), (0, 4)]], "the boundary crosses itself at (2, 2)"),
        (vec![vec![(0, 0), (4, 0), (4, 2), (3, 2), (3, 0), (1, 0), (1, 2), (0, 2)]], "side 1 and side 5 overlap"),
    ];
    for (rings, part) in cases {
        let error = polygon(&rings).unwrap_err().to_string();
        assert!(error.contains(part), "{rings:?}: {error}");
    }
}

/// Tests that cutting a plate with many holes takes little more than linear time.
#[test]
fn cutting_a_perforated_plate_takes_nearly_linear_time() {
    let rows = 40;
    let outer = vec![(0, 0), (4 * rows, 0), (4 * rows, 4 * rows), (0, 4 * rows)];
    let hole = |x: i64, y: i64| vec![(x + 1, y + 2), (x + 2, y + 1), (x + 3, y + 2), (x + 2, y + 3)];
    let holes = (0..rows).flat_map(|i| (0..rows).map(move |k| hole(4 * i, 4 * k)));
    let rings: Vec<Vec<Corner>> = std::iter::once(outer).chain(holes).collect();
    let polygon = polygon(&rings).unwrap();
    assert_eq!(polygon.area(), (16 * rows * rows - 2 * rows * rows) as f64);
    assert_eq!(polygon.convex_pieces().iter().map(Convex::area).sum::<f64>(), polygon.area());
}
