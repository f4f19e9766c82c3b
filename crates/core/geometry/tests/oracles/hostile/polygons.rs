//! Simple polygons and their convex pieces, on lattices, where corners meet sides.

use super::exact::{self, Pair};
use super::lattice::{PLACES, point};
use cplan_cases::dice;
use cplan_geometry::{Point, SimplePolygon};
use std::cmp::Ordering;

type Corner = Pair<i128>;

/// Returns true if sides meet only in the corner that they share, which is the definition of a simple polygon.
fn is_simple(corners: &[Corner]) -> bool {
    let n = corners.len();
    let side = |i: usize| [&corners[i % n], &corners[(i + 1) % n]];
    let repeated = (0..n).any(|i| (i + 1..n).any(|j| corners[i] == corners[j]));
    let apart = |i: usize, j: usize| !exact::segments(side(i), side(j)).0;
    // Neighbours share more than a corner if an end of one lies on the other.
    let on = |p: &Corner, s: [&Corner; 2]| exact::segments([p, p], s).0;
    let spike = |i: usize| on(&corners[(i + 2) % n], side(i)) || on(&corners[i], side(i + 1));
    !repeated && (0..n).all(|i| !spike(i)) && (0..n).all(|i| (i + 2..n).all(|j| (i == 0 && j == n - 1) || apart(i, j)))
}

fn twice_area(corners: &[Corner]) -> i128 {
    let n = corners.len();
    (1..n - 1)
        .map(|i| {
            let (a, b) = (exact::minus(&corners[i], &corners[0]), exact::minus(&corners[i + 1], &corners[0]));
            a.0 * b.1 - a.1 * b.0
        })
        .sum()
}

/// Returns true if a side of one of two convex polygons has the other one on its right. Then their interiors are
/// disjoint.
fn interiors_apart(a: &[Corner], b: &[Corner]) -> bool {
    let parts = |a: &[Corner], b: &[Corner]| {
        (0..a.len()).any(|i| b.iter().all(|p| exact::side(&a[i], &a[(i + 1) % a.len()], p) != Ordering::Greater))
    };
    parts(a, b) || parts(b, a)
}

#[test]
fn random_corner_lists_are_accepted_exactly_if_valid() {
    let mut dice = dice(9);
    let mut simple = 0;
    for round in 0..100_000 {
        let (corner, unit) = PLACES[round % PLACES.len()];
        let n = 3 + dice.below(6);
        let at = |x: u64| i128::from(corner) + i128::from(x);
        let corners: Vec<Corner> = (0..n).map(|_| (at(dice.below(5)), at(dice.below(5)))).collect();
        let found = SimplePolygon::new(corners.iter().map(|&p| point(p, unit)).collect());
        assert_eq!(found.is_ok(), is_simple(&corners), "{corners:?}: {:?}", found.err());
        let Ok(polygon) = found else { continue };
        simple += 1;
        // Coordinates are whole units, so the conversion back is exact.
        let whole = |p: &Point| ((p.x / unit) as i128, (p.y / unit) as i128);
        let outline: Vec<Corner> = polygon.corners().iter().map(whole).collect();
        assert_eq!(twice_area(&outline), twice_area(&corners).abs());
        let pieces: Vec<Vec<Corner>> =
            polygon.convex_pieces().iter().map(|p| p.core().iter().map(whole).collect()).collect();
        assert_eq!(pieces.iter().map(|p| twice_area(p)).sum::<i128>(), twice_area(&outline), "{corners:?}");
        for (i, piece) in pieces.iter().enumerate() {
            let m = piece.len();
            let turn = |k: usize| exact::side(&piece[k], &piece[(k + 1) % m], &piece[(k + 2) % m]);
            assert!((0..m).all(|k| turn(k) == Ordering::Greater), "{piece:?} of {corners:?}");
            assert!(piece.iter().all(|p| corners.contains(p)));
            assert!(pieces[..i].iter().all(|other| interiors_apart(piece, other)), "{corners:?}");
        }
        assert_eq!(polygon.is_convex(), pieces.len() == 1, "{corners:?}");
    }
    assert!((10_000..90_000).contains(&simple), "{simple}");
}
