//! Shapes of adjoining convex pieces, drawn in at their corners.

use super::{Convex, Orientation, Point, SimplePolygon, Vector, hull, orientation, perpendicular, point_on_segment};
use std::collections::BTreeMap;

/// Of corners at which two pieces meet on a straight side of the whole, the share by which they move: less than beside any corner but needles.
const STRAIGHT: f64 = 1e-3;

/// What is left of each of these pieces, convex too, where each corner of their union moves into it by `distance`, halfway between the
/// sides there. They go on adjoining: what several share moves with all of them. A side moves by `distance` times the sine of half the angle at its ends.
/// Of what is too fine for that no less is left; rounded outlines lose of their radius first.
///
/// Pieces adjoin where their sides have stretches in common, exactly, and do not overlap. `O(n log n)` for `n` sides, and for each the corners
/// below and above it.
#[must_use]
pub(crate) fn drawn_in(pieces: &[Convex], distance: f64) -> Vec<Vec<Convex>> {
    let all = corner_to_corner(pieces);
    let is_sharp = |piece: &&Convex| piece.radius() == 0.0;
    let together = around(all.iter().flatten().filter(is_sharp));
    let left = |piece: &Convex| {
        if is_sharp(&piece) {
            return within(piece.core(), &together, distance);
        }
        let rest = (distance - piece.radius()).max(0.0);
        let radius = (piece.radius() - distance).max(0.0);
        within(piece.core(), &around([piece]), rest).iter().map(|core| core.grown(radius)).collect()
    };
    all.iter().map(|parts| parts.iter().flat_map(left).collect()).collect()
}

/// Each piece cut so that where pieces adjoin no corner of one is between those of a side of another. No new corners.
#[must_use]
pub(crate) fn corner_to_corner(pieces: &[Convex]) -> Vec<Vec<Convex>> {
    let is_sharp = |piece: &&Convex| piece.radius() == 0.0 && piece.core().len() > 2;
    let mut corners: Vec<Point> = pieces.iter().filter(is_sharp).flat_map(Convex::core).copied().collect();
    corners.sort_by(|p, q| p.x.total_cmp(&q.x));
    let parts = |piece: &Convex| {
        if !is_sharp(&piece) {
            return vec![piece.clone()];
        }
        cut(with_corners(piece.core(), &corners)).into_iter().map(|core| Convex::trusted(core, 0.0)).collect()
    };
    pieces.iter().map(parts).collect()
}

/// A convex ring as rings without corners on their sides.
fn cut(ring: Vec<Point>) -> Vec<Vec<Point>> {
    let turn = |a: usize, b: usize, c: usize| orientation(ring[a], ring[b], ring[c]);
    let count = ring.len();
    let straight = (0..count).find(|&k| turn((k + count - 1) % count, k, (k + 1) % count) == Orientation::Collinear);
    let Some(straight) = straight else { return vec![ring] };
    let off: Vec<usize> = (2..count - 1)
        .map(|by| (straight + by) % count)
        .filter(|&k| turn(straight, (straight + 1) % count, k) != Orientation::Collinear)
        .collect();
    // A ring without area has none.
    let Some(&across) = off.get(off.len() / 2) else { return vec![ring] };
    let from = |first: usize, last: usize| {
        let long = (last + count - first) % count;
        (0..=long).map(|by| ring[(first + by) % count]).collect()
    };
    [from(straight, across), from(across, straight)].into_iter().flat_map(cut).collect()
}

/// Of each corner how pieces lie about it: a point on the one side, and on the other counter-clockwise of it.
type Sectors = BTreeMap<[u64; 2], Vec<[Point; 2]>>;

fn key(p: Point) -> [u64; 2] {
    // Adding 0.0 turns -0.0 into 0.0.
    [p.x, p.y].map(|v| (v + 0.0).to_bits())
}

fn around<'a>(pieces: impl IntoIterator<Item = &'a Convex>) -> Sectors {
    let mut sectors = Sectors::new();
    for ring in pieces.into_iter().map(Convex::core) {
        for k in 0..ring.len() {
            sectors.entry(key(ring[k])).or_default().push(sides(ring, k));
        }
    }
    sectors
}

/// The corners after and before one of a ring.
fn sides(ring: &[Point], k: usize) -> [Point; 2] {
    [1, ring.len() - 1].map(|by| ring[(k + by) % ring.len()])
}

/// A ring with the corners of others that lie on its sides; these in the order of their `x`.
fn with_corners(core: &[Point], corners: &[Point]) -> Vec<Point> {
    let side = |k: usize| {
        let [from, to] = [core[k], core[(k + 1) % core.len()]];
        let is_between = |p: &&Point| **p != from && **p != to && point_on_segment(**p, from, to);
        let first = corners.partition_point(|p| p.x < from.x.min(to.x));
        let beside = corners[first..].iter().take_while(|p| p.x <= from.x.max(to.x));
        let mut between: Vec<Point> = beside.filter(is_between).copied().collect();
        between.sort_by(|p, q| (p - from).norm_squared().total_cmp(&(q - from).norm_squared()));
        between.dedup();
        std::iter::once(from).chain(between)
    };
    (0..core.len()).flat_map(side).collect()
}

/// What is left of a piece with these corners.
fn within(ring: &[Point], sectors: &Sectors, distance: f64) -> Vec<Convex> {
    if ring.len() < 3 || distance == 0.0 {
        return vec![Convex::trusted(ring.to_vec(), 0.0)];
    }
    let moved: Vec<Point> =
        (0..ring.len()).map(|k| moved(ring[k], sides(ring, k), &sectors[&key(ring[k])], distance)).collect();
    let is_along = |k: usize| (sides(&moved, k)[0] - moved[k]).dot(&(sides(ring, k)[0] - ring[k])) > 0.0;
    match SimplePolygon::new(moved.clone()) {
        Ok(left) if (0..ring.len()).all(is_along) => left.convex_pieces(),
        // Too fine: what corners do not leave it.
        _ => {
            let is_left = |p: Point, k: usize| orientation(ring[k], sides(ring, k)[0], p) != Orientation::Clockwise;
            let is_in = |p: Point| (0..ring.len()).all(|k| is_left(p, k));
            let stays: Vec<Point> = moved.iter().zip(ring).map(|(p, own)| if is_in(*p) { *p } else { *own }).collect();
            vec![Convex::trusted(hull(&stays), 0.0)]
        }
    }
}

/// Where a corner of a piece goes that lies so about it, as others do.
fn moved(corner: Point, own: [Point; 2], sectors: &[[Point; 2]], distance: f64) -> Point {
    let is_same = |p: Point, q: Point| {
        orientation(corner, p, q) == Orientation::Collinear && (p - corner).dot(&(q - corner)) > 0.0
    };
    let [mut first, mut last] = own;
    for _ in sectors {
        last = sectors.iter().find(|sector| is_same(sector[0], last)).map_or(last, |sector| sector[1]);
        first = sectors.iter().find(|sector| is_same(sector[1], first)).map_or(first, |sector| sector[0]);
    }
    // All round it.
    if sectors.iter().any(|sector| is_same(sector[0], last)) {
        return corner;
    }
    let is_straight = orientation(corner, first, last) == Orientation::Collinear;
    let by = if is_straight { STRAIGHT * distance } else { distance };
    let unit = |v: Vector| v.try_normalize(0.0);
    let halfway = || unit(perpendicular(unit(first - corner)? - unit(last - corner)?));
    // The sides of a needle are not told apart.
    halfway().map_or(corner, |inwards| corner + inwards * by)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Polygon, separation};
    use proptest::prelude::*;

    fn points(corners: &[[f64; 2]]) -> Vec<Point> {
        corners.iter().map(|corner| Point::from(*corner)).collect()
    }

    fn rectangle([x, y]: [f64; 2], [right, top]: [f64; 2]) -> Convex {
        Convex::trusted(points(&[[x, y], [right, y], [right, top], [x, top]]), 0.0)
    }

    fn covers(pieces: &[Vec<Convex>], point: Point) -> bool {
        pieces.iter().flatten().any(|piece| separation(piece, &Convex::point(point)).distance <= 0.0)
    }

    #[test]
    fn corners_move_halfway_between_sides() {
        let left = drawn_in(&[rectangle([0., 0.], [4., 1.])], 0.1 * 2f64.sqrt());
        let corners = points(&[[0.1, 0.1], [3.9, 0.1], [3.9, 0.9], [0.1, 0.9]]);
        let is_near = |p: &Point| corners.iter().any(|corner| (p - corner).norm() < 1e-12);
        assert!(matches!(&left[..], [one] if one.len() == 1 && one[0].core().iter().all(is_near)), "{left:?}");
        let disc = [Convex::point(Point::origin()).grown(0.3)];
        let radii = [0.1, 0.4].map(|by| drawn_in(&disc, by)[0][0].radius());
        assert_eq!(radii, [0.3 - 0.1, 0.0]);
    }

    /// Pieces of a bar with a bar upon it: a side of the one goes on beyond the other, on both sides.
    #[test]
    fn pieces_go_on_adjoining() {
        let left = drawn_in(&[rectangle([0., 0.], [4., 1.]), rectangle([1., 1.], [2., 2.])], 0.1 * 2f64.sqrt());
        let within = [[0.11, 0.5], [1.11, 1.0], [1.89, 1.0], [1.5, 1.89], [0.5, 0.89], [1.11, 0.95], [3., 0.89]];
        let without = [[0.09, 0.5], [1.09, 1.0], [1.91, 1.0], [1.5, 1.91], [0.5, 0.91], [1.09, 0.95], [3., 0.91]];
        for (all, is_covered) in [(within, true), (without, false)] {
            for point in all {
                assert_eq!(covers(&left, point.into()), is_covered, "{point:?} {left:?}");
            }
        }
    }

    #[test]
    fn pieces_are_cut_from_corner_to_corner() {
        let pieces = [rectangle([0., 0.], [4., 1.]), rectangle([1., 1.], [2., 2.]), rectangle([3., 1.], [4., 2.])];
        let parts = corner_to_corner(&pieces);
        assert_eq!(parts[1..], [vec![pieces[1].clone()], vec![pieces[2].clone()]]);
        let area: f64 = parts[0].iter().map(Convex::area).sum();
        assert_eq!((parts[0].len(), area), (4, 4.0));
        let mut own: Vec<Point> = pieces.iter().flat_map(Convex::core).copied().collect();
        own.sort_by(|p, q| p.x.total_cmp(&q.x));
        for part in parts.iter().flatten() {
            assert_eq!(with_corners(part.core(), &own), part.core(), "{parts:?}");
            assert!(Convex::new(part.core().to_vec(), 0.0).is_ok(), "{part:?}");
        }
    }

    #[test]
    fn what_is_too_fine_stays() {
        // A triangle that its corners would cross.
        let small = Convex::trusted(points(&[[0., 0.], [1., 0.], [0.5, 0.8]]), 0.0);
        let left = drawn_in(std::slice::from_ref(&small), 2.0);
        assert_eq!(left, [[small]]);
        // A needle of which no sides are told apart.
        let needle = Convex::trusted(points(&[[0., 0.], [1., 0.], [1., 1e-200]]), 0.0);
        assert!(drawn_in(&[needle], 0.01)[0].iter().flat_map(Convex::core).all(|p| p.x.is_finite() && p.y.is_finite()));
    }

    /// Corners about the origin.
    fn star(far: [f64; 2]) -> impl Strategy<Value = Vec<Point>> {
        prop::collection::vec(far[0]..far[1], 3..9).prop_map(|far| {
            let angle = |k: usize| std::f64::consts::TAU * k as f64 / far.len() as f64;
            (0..far.len()).map(|k| Point::new(far[k] * angle(k).cos(), far[k] * angle(k).sin())).collect()
        })
    }

    /// A ring whose corners are moved by the angles of its sides.
    fn by_angles(ring: &[Point], distance: f64) -> Vec<Point> {
        let angle = |v: Vector| v.y.atan2(v.x);
        let corner = |k: usize| {
            let [next, last] = sides(ring, k).map(|p| angle(p - ring[k]));
            let halfway = next + (last - next).rem_euclid(std::f64::consts::TAU) / 2.0;
            ring[k] + distance * Vector::new(halfway.cos(), halfway.sin())
        };
        (0..ring.len()).map(corner).collect()
    }

    proptest! {
        #![proptest_config(crate::random::cases(300))]

        /// Of a polygon with a hole it is the polygon whose rings are moved.
        #[test]
        fn it_is_what_moved_rings_surround(
            outer in star([1.0, 3.0]), hole in star([0.2, 0.7]), by in 0.0..0.03f64, at in prop::collection::vec((-3.0..3.0f64, -3.0..3.0f64), 60),
        ) {
            let clockwise: Vec<Point> = hole.iter().rev().copied().collect();
            let Ok(polygon) = Polygon::new(outer.clone(), vec![hole]) else { return Ok(()) };
            let left = drawn_in(&polygon.convex_pieces(), by);
            let rings = [outer, clockwise].map(|ring| by_angles(&ring, by));
            let sides = || rings.iter().flat_map(|ring| (0..ring.len()).map(|k| [ring[k], ring[(k + 1) % ring.len()]]));
            let off = |p: Point| sides().map(|[a, b]| separation(&Convex::between(a, b), &Convex::point(p)).distance).fold(f64::INFINITY, f64::min);
            let near = rings.iter().flatten().map(|corner| corner + Vector::new(at[0].0, at[0].1) * 0.01);
            for p in at.iter().map(|(x, y)| Point::new(*x, *y)).chain(near).filter(|p| off(*p) > 1e-9) {
                let crossed = sides().filter(|[a, b]| (a.y > p.y) != (b.y > p.y) && a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) > p.x);
                prop_assert_eq!(covers(&left, p), crossed.count() % 2 == 1, "{} {:?}", p, left);
            }
        }
    }
}
