//! Validation and convex decomposition of polygons against integer arithmetic.

use cplan_geometry::{Point, PolygonError, SimplePolygon, decompose};
use proptest::prelude::*;

use crate::lattice::{Corner, cross, meet, point, points};

fn twice_area(ring: &[Corner]) -> i64 {
    (1..ring.len() - 1).map(|i| cross(ring[0], ring[i], ring[i + 1])).sum()
}

/// Generates simple polygons with up to 30 corners, including straight ones: corners are inserted into sides one by
/// one.
fn simple_ring() -> impl Strategy<Value = Vec<Corner>> {
    prop::collection::vec((-8..=8i64, -8..=8i64, 0..30usize), 3..40).prop_map(|list| {
        let mut ring = vec![(-9, -9), (9, -9), (0, 9)];
        for (x, y, at) in list {
            let mut grown = ring.clone();
            grown.insert(at % ring.len() + 1, (x, y));
            if SimplePolygon::new(points(&grown)).is_ok() {
                ring = grown;
            }
        }
        ring
    })
}

/// Returns true if a ring contains a point that is not on its boundary (crossing number; coordinates in thirds of the
/// lattice).
fn contains(ring: &[Corner], p: Corner) -> bool {
    let scaled = |i: usize| (3 * ring[i % ring.len()].0, 3 * ring[i % ring.len()].1);
    let crossings = (0..ring.len()).filter(|&i| {
        let (a, b) = (scaled(i), scaled(i + 1));
        (a.1 > p.1) != (b.1 > p.1) && (cross(a, b, p) > 0) == (b.1 > a.1)
    });
    crossings.count() % 2 == 1
}

proptest! {
    #![proptest_config(cplan_cases::cases(1200))]

    #[test]
    fn errors_name_what_is_wrong(ring in prop::collection::vec((-2..=2i64, -2..=2i64), 3..7)) {
        let side = |i: usize| [ring[i], ring[(i + 1) % ring.len()]];
        match SimplePolygon::new(points(&ring)) {
            Ok(polygon) => prop_assert_eq!(polygon.area() * 2.0, twice_area(&ring).abs() as f64),
            Err(PolygonError::RepeatedCorner { first, second }) => {
                prop_assert!(first < second && ring[first] == ring[second]);
            }
            Err(PolygonError::NoArea) => prop_assert!((2..ring.len()).all(|i| cross(ring[0], ring[1], ring[i]) == 0)),
            Err(PolygonError::Spike { corner }) => {
                let before = ring[(corner + ring.len() - 1) % ring.len()];
                prop_assert!(meet(&side(corner), &[before]) || meet(&[before, ring[corner]], &[side(corner)[1]]));
            }
            Err(PolygonError::SidesCross { first, second } | PolygonError::SidesTouch { first, second }) => {
                prop_assert!(first < second && meet(&side(first), &side(second)));
            }
            Err(other) => prop_assert!(false, "{other}"),
        }
    }

    #[test]
    fn pieces_make_up_the_polygon(ring in simple_ring()) {
        let polygon = SimplePolygon::new(points(&ring)).unwrap();
        let pieces: Vec<Vec<Corner>> = decompose(&polygon)
            .iter()
            .map(|piece| piece.core().iter().map(|p| (p.x as i64, p.y as i64)).collect())
            .collect();
        let mut area = 0;
        for piece in &pieces {
            let n = piece.len();
            prop_assert!((0..n).all(|i| cross(piece[i], piece[(i + 1) % n], piece[(i + 2) % n]) > 0));
            prop_assert!(piece.iter().all(|p| ring.contains(p)));
            area += twice_area(piece);
        }
        prop_assert_eq!(area, twice_area(&ring));
        // Every point that is not on the line of a side is in one piece if it is in the polygon, and in none otherwise.
        for x in -27..=27 {
            for y in -27..=27 {
                let p = (x, y);
                let on_side = |ring: &[Corner]| (0..ring.len()).any(|i| {
                    let scaled = |i: usize| (3 * ring[i % ring.len()].0, 3 * ring[i % ring.len()].1);
                    cross(scaled(i), scaled(i + 1), p) == 0
                });
                if x % 3 == 0 || y % 3 == 0 || on_side(&ring) || pieces.iter().any(|piece| on_side(piece)) {
                    continue;
                }
                let count = pieces.iter().filter(|piece| contains(piece, p)).count();
                prop_assert_eq!(count, usize::from(contains(&ring, p)));
            }
        }
        // At lattice points, the boundary counts: a closed piece contains them, or none does.
        for x in -10..=10 {
            for y in -10..=10 {
                let on_boundary = (0..ring.len()).any(|i| meet(&[ring[i], ring[(i + 1) % ring.len()]], &[(x, y)]));
                let inside = on_boundary || contains(&ring, (3 * x, 3 * y));
                prop_assert_eq!(polygon.contains(Point::new(x as f64, y as f64)), inside, "({}, {})", x, y);
            }
        }
        let n = ring.len();
        let reflex = (0..n).filter(|&i| cross(ring[i], ring[(i + 1) % n], ring[(i + 2) % n]) < 0).count();
        prop_assert!(pieces.len() <= 2 * reflex + 1);
        prop_assert_eq!(pieces.len() == 1, polygon.is_convex());
    }
}

#[test]
fn a_convex_polygon_is_one_piece_whatever_its_direction() {
    let ring = [(0, 0), (0, 4), (2, 4), (4, 4), (4, 0), (1, 0)];
    let pieces = SimplePolygon::new(points(&ring)).unwrap().convex_pieces();
    assert_eq!(pieces.len(), 1);
    assert_eq!(pieces[0].core().len(), 4);
    assert!(pieces[0].core().contains(&point((4, 4))));
}
