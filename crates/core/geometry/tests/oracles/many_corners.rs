//! Polygons with very many corners. Their pieces are compared with integer arithmetic and with the polygon itself. The
//! reported sides of an invalid polygon are compared with a test of all pairs.

use crate::lattice::{Corner, cross, meet, points};
use cplan_geometry::{Convex, MAX_CORNERS, Point, PolygonError, SimplePolygon, decompose};
use proptest::prelude::*;

/// Returns a ring around the origin on the lattice, with one corner in each of `count` directions. `radius` returns the
/// distance of a corner.
fn ring_around_origin(count: usize, radius: impl Fn(usize) -> f64) -> Vec<Corner> {
    let corner = |k: usize| {
        let angle = k as f64 / count as f64 * std::f64::consts::TAU;
        ((radius(k) * angle.cos()) as i64, (radius(k) * angle.sin()) as i64)
    };
    (0..count).map(corner).collect()
}

/// Returns a comb: `teeth` of alternating heights, slanted so that they overlap in both coordinates.
fn slanted_comb(teeth: usize) -> Vec<Corner> {
    let mut ring = vec![(0, 0)];
    for k in 0..teeth as i64 {
        ring.extend([(10 * k, 10), (10 * k + 5 * teeth as i64, 5 * teeth as i64 + k % 7)]);
    }
    ring.push((10 * teeth as i64, 0));
    ring
}

fn twice_area(ring: &[Corner]) -> i128 {
    let product = |i: usize| {
        let ((a, b), (c, d)) = (ring[i], ring[(i + 1) % ring.len()]);
        i128::from(a) * i128::from(d) - i128::from(c) * i128::from(b)
    };
    (0..ring.len()).map(product).sum()
}

fn in_integers(piece: &Convex) -> Vec<Corner> {
    piece.core().iter().map(|p| (p.x as i64, p.y as i64)).collect()
}

/// Locates a point in a strictly convex ring: 0 outside, 1 on the boundary, 2 inside.
fn locate(ring: &[Corner], p: Corner) -> i64 {
    let side = |i: usize| cross(ring[i], ring[(i + 1) % ring.len()], p).signum();
    (0..ring.len()).map(side).min().map_or(0, |least| least + 1)
}

/// Checks that pieces are strictly convex and small, and have disjoint interiors whose areas add up exactly to the
/// polygon's. Points of the lattice must have the same location in the polygon as in the pieces: inside, on the
/// boundary, or outside.
fn is_cut_up_exactly(ring: &[Corner]) {
    let polygon = SimplePolygon::new(points(ring)).unwrap();
    let pieces: Vec<Vec<Corner>> = decompose(&polygon).iter().map(in_integers).collect();
    for piece in &pieces {
        let n = piece.len();
        assert!((3..=MAX_CORNERS).contains(&n));
        assert!((0..n).all(|i| cross(piece[i], piece[(i + 1) % n], piece[(i + 2) % n]) > 0), "strictly convex");
    }
    assert_eq!(pieces.iter().map(|piece| twice_area(piece)).sum::<i128>(), twice_area(ring).abs());
    let extent = ring.iter().map(|c| c.0.abs().max(c.1.abs())).max().unwrap();
    for k in 0..40_i64 {
        // Multiples of the golden ratio and of another irrational number spread over the square.
        let at = |share: f64| ((k as f64 * share).fract() * 2.2 - 1.1) * extent as f64;
        let p = (at(0.618_033_988_749) as i64, at(0.754_877_666_246) as i64);
        let found: Vec<i64> = pieces.iter().map(|piece| locate(piece, p)).collect();
        let inside = found.iter().filter(|&&held| held == 2).count();
        assert!(inside <= 1, "the interiors of pieces are disjoint");
        assert_eq!(found.iter().any(|&held| held > 0), polygon.contains(Point::new(p.0 as f64, p.1 as f64)), "{p:?}");
    }
}

#[test]
fn a_disc_of_20_000_corners_is_cut_up_exactly() {
    is_cut_up_exactly(&ring_around_origin(20_000, |_| 1e9));
}

#[test]
fn a_star_of_20_000_corners_is_cut_up_exactly() {
    is_cut_up_exactly(&ring_around_origin(20_000, |k| if k % 2 == 0 { 1e9 } else { 5e8 }));
}

#[test]
fn a_ragged_ring_of_20_000_corners_is_cut_up_exactly() {
    is_cut_up_exactly(&ring_around_origin(20_000, |k| 1e9 * (0.4 + (k as f64 * 0.618_033_988_749).fract())));
}

#[test]
fn a_slanted_comb_of_10_000_teeth_is_cut_up_exactly() {
    is_cut_up_exactly(&slanted_comb(10_000));
}

#[test]
fn one_crossing_among_20_000_sides_is_found() {
    let mut ring = slanted_comb(10_000);
    // The tip of one tooth crosses the next one.
    ring[9_000].0 += 14;
    let error = SimplePolygon::new(points(&ring)).unwrap_err();
    let PolygonError::SidesCross { first, second } = error else { panic!("{error}") };
    assert!((8_998..=9_001).contains(&first) && (9_000..=9_003).contains(&second), "{error}");
}

/// Returns two sides that meet but are not neighbours: the first such side in the list, and the earlier side that it
/// meets.
fn first_meeting(ring: &[Corner]) -> Option<(usize, usize)> {
    let n = ring.len();
    let side = |i: usize| [ring[i], ring[(i + 1) % n]];
    (0..n).find_map(|j| {
        let apart = |i: &usize| j - i > 1 && !(*i == 0 && j == n - 1);
        (0..j).filter(apart).find(|&i| meet(&side(i), &side(j))).map(|i| (i, j))
    })
}

proptest! {
    #![proptest_config(cplan_cases::cases(2000))]

    #[test]
    fn the_first_crossing_sides_are_named(ring in prop::collection::vec((-6..=6i64, -6..=6i64), 4..14)) {
        match SimplePolygon::new(points(&ring)) {
            Ok(_) => prop_assert_eq!(first_meeting(&ring), None),
            Err(PolygonError::SidesCross { first, second } | PolygonError::SidesTouch { first, second }) => {
                prop_assert_eq!(first_meeting(&ring), Some((first, second)));
            }
            Err(_) => {}
        }
    }
}
