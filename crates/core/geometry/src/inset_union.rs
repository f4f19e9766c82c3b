//! Insets of unions of adjoining convex pieces: all corners of the union move inwards.
//!
//! Two pieces adjoin if parts of their sides coincide exactly. Pieces must not overlap. A shared corner moves
//! equally in all its pieces, so the insets adjoin as well. `O(n log n)` for `n` sides, plus time for the corners
//! above and below each side.

use super::{
    BoxTree, Convex, Orientation, Point, SimplePolygon, Vector, cross, hull, orientation, perpendicular,
    point_on_segment, shapes_meet,
};
use std::collections::BTreeMap;

/// Smallest bend of a corner, radians. Rounding bends corners that users place on straight sides.
const MIN_BEND: f64 = 1e-7;

/// Moves each corner of the union of the pieces inwards by `distance`. Returns, for each piece, the convex shapes that
/// remain of it.
///
/// A corner moves along the bisector of its sides, so a side moves by `distance` times the sine of half the angle at its ends. A
/// corner that would leave the union does not move. A part that is so thin that it would turn over is replaced by the hull of
/// its corners. In both cases, all points deeper than `distance` remain. Of rounded outlines, the radius is reduced first.
pub fn inset_union(pieces: &[Convex], distance: f64) -> Vec<Vec<Convex>> {
    let (all, together) = cut_and_move(pieces, distance);
    let left = |piece: &Convex| match piece.radius() {
        0.0 => {
            let hull_of = |ring: &[Point]| vec![Convex::trusted(hull(&together.ring(ring)), 0.0)];
            together.moved_piece(piece.core()).unwrap_or_else(|| hull_of(piece.core()))
        }
        radius if radius >= distance => vec![piece.grown(-distance)],
        radius => inset_union(&[piece.grown(-radius)], distance - radius).concat(),
    };
    all.iter().map(|parts| parts.iter().flat_map(left).collect()).collect()
}

/// Returns true if [`inset_union`] can move every corner. Then each corner stays inside the union, and none belongs to
/// two rings or twice to one ring.
pub fn can_inset_union(pieces: &[Convex], distance: f64) -> bool {
    let (_, together) = cut_and_move(pieces, distance);
    !together.touches && !together.would_leave
}

/// Cuts the pieces from corner to corner, and computes the new positions of the corners.
fn cut_and_move(pieces: &[Convex], distance: f64) -> (Vec<Vec<Convex>>, MovedCorners) {
    let all = corner_to_corner(pieces);
    let mut together = MovedCorners::new(all.iter().flatten().filter(is_sharp), distance);
    let tree = BoxTree::new(pieces.iter().map(Convex::bounds).collect());
    let mut found = Vec::new();
    for [corner, to] in together.to.values_mut() {
        found.clear();
        tree.meeting(&[*to; 2], &mut found);
        if !found.iter().any(|&piece| shapes_meet(&pieces[piece as usize], &Convex::point(*to))) {
            *to = *corner;
            together.would_leave = true;
        }
    }
    (all, together)
}

fn is_sharp(piece: &&Convex) -> bool {
    piece.radius() == 0.0
}

/// Cuts each piece so that no corner of another piece lies between the ends of a side. Adds no corners.
fn corner_to_corner(pieces: &[Convex]) -> Vec<Vec<Convex>> {
    let has_sides = |piece: &&Convex| is_sharp(piece) && piece.core().len() > 2;
    let mut corners: Vec<Point> = pieces.iter().filter(has_sides).flat_map(Convex::core).copied().collect();
    corners.sort_by(|p, q| p.x.total_cmp(&q.x));
    let parts = |piece: &Convex| {
        if !has_sides(&piece) {
            return vec![piece.clone()];
        }
        cut(with_corners(piece.core(), &corners)).into_iter().map(|core| Convex::trusted(core, 0.0)).collect()
    };
    pieces.iter().map(parts).collect()
}

/// Splits a convex ring into rings without corners on their sides.
fn cut(ring: Vec<Point>) -> Vec<Vec<Point>> {
    let (mut todo, mut all) = (vec![ring], Vec::new());
    while let Some(ring) = todo.pop() {
        let count = ring.len();
        let turn = |a: usize, b: usize, c: usize| orientation(ring[a], ring[b], ring[c]);
        let is_straight = |&k: &usize| turn((k + count - 1) % count, k, (k + 1) % count) == Orientation::Collinear;
        let straight: Vec<usize> = (0..count).filter(is_straight).collect();
        // Begin with the middle one of the straight corners, which needs fewer cuts.
        let across = straight.get(straight.len() / 2).and_then(|&at| {
            let is_off = |k: &usize| turn(at, (at + 1) % count, *k) != Orientation::Collinear;
            let off: Vec<usize> = (2..count - 1).map(|by| (at + by) % count).filter(is_off).collect();
            Some((at, *off.get(off.len() / 2)?))
        });
        let Some((at, across)) = across else {
            all.push(ring);
            continue;
        };
        let from = |first: usize, last: usize| {
            let long = (last + count - first) % count;
            (0..=long).map(|by| ring[(first + by) % count]).collect()
        };
        todo.extend([from(at, across), from(across, at)]);
    }
    all
}

/// Inserts into a ring those of `corners` that lie on its sides. `corners` is sorted by `x`.
fn with_corners(core: &[Point], corners: &[Point]) -> Vec<Point> {
    let side = |k: usize| {
        let [from, to] = [core[k], core[(k + 1) % core.len()]];
        let is_between = |p: &&Point| **p != from && **p != to && point_on_segment(**p, from, to);
        let first = corners.partition_point(|p| p.x < from.x.min(to.x));
        let near = corners[first..].iter().take_while(|p| p.x <= from.x.max(to.x));
        let mut between: Vec<Point> = near.filter(is_between).copied().collect();
        between.sort_by(|p, q| (p - from).norm_squared().total_cmp(&(q - from).norm_squared()));
        between.dedup();
        std::iter::once(from).chain(between)
    };
    (0..core.len()).flat_map(side).collect()
}

/// Returns the corner after corner `k` of a ring, and the one before it.
fn adjacent_corners(ring: &[Point], k: usize) -> [Point; 2] {
    [1, ring.len() - 1].map(|by| ring[(k + by) % ring.len()])
}

type Key = [u64; 2];

fn key(p: Point) -> Key {
    // Adding 0.0 turns -0.0 into 0.0.
    [p.x, p.y].map(|v| (v + 0.0).to_bits())
}

/// New positions of the corners of pieces.
struct MovedCorners {
    /// New positions of corners that move. The key consists of a corner and its successor in the piece. Corners that
    /// are completely surrounded by pieces do not move, and are not listed.
    to: BTreeMap<[Key; 2], [Point; 2]>,
    /// True if some corner would have left the union, and so did not move.
    would_leave: bool,
    /// True if some corner of the union belongs to several rings, or twice to one ring.
    touches: bool,
}

/// A corner of the union: the end of one side and the start of the next.
struct Corner {
    at: Point,
    next: Point,
    last: Point,
    /// For each piece of the corner, the keys of the corner and of its successor.
    parts: Vec<[Key; 2]>,
    /// Bisector of the sides, with the cosine and the sine of half the angle between them. `None` if the sides coincide.
    inward: Option<(Vector, [f64; 2])>,
}

impl Corner {
    fn is_straight(&self) -> bool {
        self.inward.is_some_and(|(_, [cosine, _])| cosine.abs() < MIN_BEND / 2.0)
    }
}

impl MovedCorners {
    /// Computes the new positions for pieces that are cut from corner to corner.
    fn new<'a>(pieces: impl IntoIterator<Item = &'a Convex>, distance: f64) -> Self {
        let mut sectors: BTreeMap<[Key; 2], [Point; 3]> = BTreeMap::new();
        for ring in pieces.into_iter().map(Convex::core) {
            for (k, &corner) in ring.iter().enumerate() {
                let [next, last] = adjacent_corners(ring, k);
                sectors.insert([key(corner), key(next)], [corner, next, last]);
            }
        }
        // Starting from each side of the union, collect the sectors around its first corner, counter-clockwise, up to
        // the next side.
        let mut corners = Vec::new();
        for &[at, next, _] in sectors.values() {
            if sectors.contains_key(&[key(next), key(at)]) {
                continue;
            }
            let (mut last, mut parts) = (next, Vec::new());
            while let Some(sector) = sectors.get(&[key(at), key(last)]).filter(|_| parts.len() < sectors.len()) {
                parts.push([key(at), key(last)]);
                last = sector[2];
            }
            corners.push(Corner { at, next, last, parts, inward: inward_bisector(at, next, last) });
        }
        let number = |of: fn(&Corner) -> Point| -> BTreeMap<[Key; 2], usize> {
            corners.iter().enumerate().map(|(k, corner)| ([key(corner.at), key(of(corner))], k)).collect()
        };
        let (by_next, by_last) = (number(|corner| corner.next), number(|corner| corner.last));
        // Finds the next corner along the union's sides where they bend.
        let ahead = |from: usize, forwards: bool| {
            let mut at = from;
            for _ in 0..corners.len() {
                let Corner { at: own, next, last, .. } = &corners[at];
                let beyond = if forwards {
                    by_last.get(&[key(*next), key(*own)])
                } else {
                    by_next.get(&[key(*last), key(*own)])
                };
                at = *beyond?;
                if !corners[at].is_straight() {
                    let along =
                        |(_, [cosine, sine]): (Vector, [f64; 2])| (corners[at].at, distance * cosine, distance * sine);
                    return corners[at].inward.map(along);
                }
            }
            None
        };
        let mut to = BTreeMap::new();
        for (k, corner) in corners.iter().enumerate() {
            let moved = match corner.inward {
                None => corner.at,
                Some((inward, _)) if !corner.is_straight() => corner.at + inward * distance,
                // A straight corner moves onto the line between the moved corners at the neighbouring bends.
                Some((inward, _)) => ahead(k, false).zip(ahead(k, true)).map_or(corner.at, |(from, to)| {
                    let [behind, before] = [&from, &to].map(|end| (corner.at - end.0).norm());
                    let [start, end] = [from.1, behind + before - to.1];
                    let share = ((behind - start) / (end - start)).clamp(0.0, 1.0);
                    corner.at + inward * (from.2 + share * (to.2 - from.2))
                }),
            };
            to.extend(corner.parts.iter().map(|part| (*part, [corner.at, moved])));
        }
        let mut places: Vec<Key> = corners.iter().map(|corner| key(corner.at)).collect();
        places.sort_unstable();
        let touches = places.windows(2).any(|pair| pair[0] == pair[1]);
        Self { to, would_leave: false, touches }
    }

    fn ring(&self, ring: &[Point]) -> Vec<Point> {
        let to =
            |k: usize| self.to.get(&[key(ring[k]), key(adjacent_corners(ring, k)[0])]).map_or(ring[k], |[_, to]| *to);
        (0..ring.len()).map(to).collect()
    }

    /// Returns what remains of a piece, or `None` if its sides turn over.
    fn moved_piece(&self, ring: &[Point]) -> Option<Vec<Convex>> {
        let moved = self.ring(ring);
        if ring.len() < 3 || moved == ring {
            return Some(vec![Convex::trusted(ring.to_vec(), 0.0)]);
        }
        let is_along =
            |k: usize| (adjacent_corners(&moved, k)[0] - moved[k]).dot(&(adjacent_corners(ring, k)[0] - ring[k])) > 0.0;
        let left = SimplePolygon::new(moved.clone()).ok()?;
        // A thin piece can turn over although the directions of its sides hardly change.
        (left.corners() == moved && (0..ring.len()).all(is_along)).then(|| left.convex_pieces())
    }
}

/// Returns the bisector between two sides of a corner, counter-clockwise from the first, with the cosine and the sine
/// of half the angle between them. Returns `None` if the sides coincide.
fn inward_bisector(corner: Point, first: Point, last: Point) -> Option<(Vector, [f64; 2])> {
    let unit = |v: Vector| v.try_normalize(0.0);
    let [first, last] = [unit(first - corner)?, unit(last - corner)?];
    let inward = unit(perpendicular(first - last))?;
    Some((inward, [first.dot(&inward), cross(first, inward)]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Polygon, separation};
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
        let left = inset_union(&[rectangle([0., 0.], [4., 1.])], 0.1 * 2f64.sqrt());
        let corners = points(&[[0.1, 0.1], [3.9, 0.1], [3.9, 0.9], [0.1, 0.9]]);
        let is_near = |p: &Point| corners.iter().any(|corner| (p - corner).norm() < 1e-12);
        assert!(matches!(&left[..], [one] if one.len() == 1 && one[0].core().iter().all(is_near)), "{left:?}");
        let disc = [Convex::point(Point::zeros()).grown(0.3)];
        let radii = [0.1, 0.4].map(|by| inset_union(&disc, by)[0][0].radius());
        assert_eq!(radii, [0.3 - 0.1, 0.0]);
    }

    /// Tests a bar on top of another bar. A side of the lower bar extends beyond the upper bar at both ends.
    #[test]
    fn adjoining_pieces_stay_adjoining() {
        let left = inset_union(&[rectangle([0., 0.], [4., 1.]), rectangle([1., 1.], [2., 2.])], 0.1 * 2f64.sqrt());
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

    /// Tests a hole so close to the outer ring that the moved sides cross.
    #[test]
    fn thin_pieces_do_not_turn_over() {
        let outer = points(&[[1.34375, 0.0], [-0.58984375, 1.0224609375], [-0.818359375, -1.4169921875]]);
        let hole = points(&[[0.2, 0.0], [0.14, 0.14], [0.0, 0.6982421875], [-0.14, 0.14], [-0.2, 0.0], [0.0, -0.2]]);
        let pieces = Polygon::new(outer, vec![hole]).unwrap().convex_pieces();
        assert!(can_inset_union(&pieces, 0.01) && !can_inset_union(&pieces, 0.019));
        let is_in = |corner: &Point| covers(std::slice::from_ref(&pieces), *corner);
        assert!(inset_union(&pieces, 0.019).iter().flatten().flat_map(Convex::core).all(is_in));
    }

    #[test]
    fn parts_too_fine_for_the_inset_stay_unchanged() {
        // A triangle whose corners would cross.
        let small = Convex::trusted(points(&[[0., 0.], [1., 0.], [0.5, 0.8]]), 0.0);
        let left = inset_union(std::slice::from_ref(&small), 2.0);
        assert_eq!(left, [[small]]);
        // A needle with coincident sides.
        let needle = Convex::trusted(points(&[[0., 0.], [1., 0.], [1., 1e-200]]), 0.0);
        assert!(
            inset_union(&[needle], 0.01)[0].iter().flat_map(Convex::core).all(|p| p.x.is_finite() && p.y.is_finite())
        );
    }

    /// Generates corners around the origin, on a grid that also contains the midpoints of sides.
    fn star(far: [f64; 2]) -> impl Strategy<Value = Vec<Point>> {
        prop::collection::vec(far[0]..far[1], 3..9).prop_map(|far| {
            let angle = |k: usize| std::f64::consts::TAU * k as f64 / far.len() as f64;
            let on_grid = |v: f64| (v * 1024.0).round() / 1024.0;
            let corner = |k: usize| Point::new(on_grid(far[k] * angle(k).cos()), on_grid(far[k] * angle(k).sin()));
            (0..far.len()).map(corner).collect()
        })
    }

    /// Inserts straight corners in the middle of some sides.
    fn with_straight(ring: &[Point], some: u8) -> Vec<Point> {
        let halfway = |k: usize| (some >> k & 1 == 1).then(|| (ring[k] + adjacent_corners(ring, k)[0]) * 0.5);
        (0..ring.len()).flat_map(|k| std::iter::once(ring[k]).chain(halfway(k))).collect()
    }

    /// Moves the corners of a ring inwards, using the angles of its sides.
    fn by_angles(ring: &[Point], distance: f64) -> Vec<Point> {
        let angle = |v: Vector| v.y.atan2(v.x);
        let corner = |k: usize| {
            let [next, last] = adjacent_corners(ring, k).map(|p| angle(p - ring[k]));
            let half = (last - next).rem_euclid(std::f64::consts::TAU) / 2.0;
            ring[k] + distance * Vector::new((next + half).cos(), (next + half).sin())
        };
        (0..ring.len()).map(corner).collect()
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(600))]

        /// Tests that the inset of a polygon with a hole is the polygon with moved rings. However thin the polygon is,
        /// its deep points remain.
        #[test]
        fn the_inset_equals_the_moved_rings(
            outer in star([1.0, 3.0]), hole in star([0.2, 0.7]), some in any::<[u8; 2]>(), by in 0.0..0.03f64,
            at in prop::collection::vec((-3.0..3.0f64, -3.0..3.0f64), 60),
        ) {
            let given = [with_straight(&outer, some[0]), with_straight(&hole, some[1])];
            let polygon = Polygon::new(given[0].clone(), vec![given[1].clone()]);
            prop_assume!(polygon.is_ok());
            let pieces = polygon.unwrap().convex_pieces();
            let is_too_fine = !can_inset_union(&pieces, by) || !turns_over_nothing(&pieces, by);
            let left = inset_union(&pieces, by);
            let clockwise: Vec<Point> = hole.iter().rev().copied().collect();
            let own = [outer, clockwise];
            let moved = own.clone().map(|ring| by_angles(&ring, by));
            let sides = |rings: &[Vec<Point>; 2]| -> Vec<[Point; 2]> {
                rings.iter().flat_map(|ring| (0..ring.len()).map(|k| [ring[k], ring[(k + 1) % ring.len()]])).collect()
            };
            let (own_sides, moved_sides) = (sides(&own), sides(&moved));
            let off = |sides: &[[Point; 2]], p: Point| {
                let to = |[a, b]: &[Point; 2]| separation(&Convex::between(*a, *b), &Convex::point(p)).distance;
                sides.iter().map(to).fold(f64::INFINITY, f64::min)
            };
            let is_inside = |sides: &[[Point; 2]], p: Point| {
                let crosses = |[a, b]: &&[Point; 2]| {
                    (a.y > p.y) != (b.y > p.y) && a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) > p.x
                };
                sides.iter().filter(crosses).count() % 2 == 1
            };
            let near = moved.iter().flatten().map(|corner| corner + Vector::new(at[0].0, at[0].1) * 0.01);
            for p in at.iter().map(|(x, y)| Point::new(*x, *y)).chain(near) {
                if !is_too_fine {
                    let is_left = is_inside(&moved_sides, p);
                    prop_assert!(off(&moved_sides, p) < 1e-9 || covers(&left, p) == is_left, "{} {:?}", p, left);
                } else if off(&own_sides, p) > by + 1e-9 && is_inside(&own_sides, p) {
                    prop_assert!(covers(&left, p), "{} {:?}", p, left);
                }
            }
        }
    }

    /// Returns true if no part of these pieces turns over when their corners move.
    fn turns_over_nothing(pieces: &[Convex], distance: f64) -> bool {
        let (all, together) = cut_and_move(pieces, distance);
        all.iter().flatten().all(|part| together.moved_piece(part.core()).is_some())
    }

    /// Tests a comb with teeth on a straight side. The root of each tooth is a corner on a side of the piece below.
    #[test]
    fn combs_have_parts_for_each_tooth() {
        let teeth = 4000;
        let tooth = |k: usize| points(&[[k as f64, 1.0], [k as f64 + 0.5, 2.0]]);
        let comb = points(&[[0.0, 0.0]])
            .into_iter()
            .chain((0..teeth).flat_map(tooth))
            .chain(points(&[[4000.0, 1.0], [4000.0, 0.0]]));
        let mut corners: Vec<Point> = comb.collect();
        corners.reverse();
        let pieces = SimplePolygon::new(corners).unwrap().convex_pieces();
        let left = inset_union(&pieces, 0.01);
        assert!(left.iter().flatten().count() >= teeth, "{}", left.len());
        for (at, is_covered) in
            [([100.5, 1.98], true), ([100.5, 1.995], false), ([100.0, 0.98], true), ([100.0, 0.995], false)]
        {
            assert_eq!(covers(&left, at.into()), is_covered, "{at:?}");
        }
    }
}
