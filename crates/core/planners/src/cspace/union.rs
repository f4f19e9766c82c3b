//! Free space: a window of unwrapped joint values without all copies of the C-obstacles.

use super::PolygonWithHoles;
use cplan_geometry::Point;
use cplan_interrupt::checkpoint;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::core::solver::{Precision, Solver};
use i_overlay::float::overlay::{FloatOverlay, OverlayOptions};

/// Least area of a free part, as a product of radians and metres. Smaller parts result from rounding where contours
/// almost touch, and are too small for an arm.
const SLIVER_AREA: f64 = 1e-10;

/// Returns the free parts of `allowed`, a polygon within `window`: one polygon per connected component.
///
/// Contours must be counter-clockwise, and repeat along each axis that has a period. Corners are rounded to a grid of
/// about 1e-17 of the coordinates' range, and snapped to each other ([`SNAP_PRECISION`]). The margin of contours is far
/// greater than both changes.
pub(super) fn free_space<'a>(
    window: Window,
    allowed: &[Point],
    periods: [Option<f64>; 2],
    contours: impl Iterator<Item = &'a [Point]>,
) -> Vec<PolygonWithHoles> {
    let mut free = parts(window, allowed, periods, contours, OverlayRule::Difference);
    free.retain(|polygon| polygon.area() > SLIVER_AREA);
    free
}

/// Returns the parts of `window` that contours cover.
pub(super) fn blocked_space<'a>(
    window: Window,
    periods: [Option<f64>; 2],
    contours: impl Iterator<Item = &'a [Point]>,
) -> Vec<PolygonWithHoles> {
    parts(window, &corners(window), periods, contours, OverlayRule::Intersect)
}

/// Lower and upper value of each axis.
pub(super) type Window = [(f64, f64); 2];

/// Returns the corners of a window, counter-clockwise.
pub(super) fn corners([(left, right), (bottom, top)]: Window) -> [Point; 4] {
    [(left, bottom), (right, bottom), (right, top), (left, top)].map(|(x, y)| Point::new(x, y))
}

fn parts<'a>(
    window: Window,
    subject: &[Point],
    periods: [Option<f64>; 2],
    contours: impl Iterator<Item = &'a [Point]>,
    rule: OverlayRule,
) -> Vec<PolygonWithHoles> {
    let [(left, right), (bottom, top)] = window;
    let subject: Vec<[f64; 2]> = subject.iter().map(|p| [p.x, p.y]).collect();
    let mut blocked: Vec<Vec<[f64; 2]>> = Vec::new();
    for contour in contours {
        let shifts = |k: usize| copies(contour.iter().map(move |p| p[k]), window[k], periods[k]);
        for dx in shifts(0) {
            for dy in shifts(1) {
                blocked.push(contour.iter().map(|p| [p.x + dx, p.y + dy]).collect());
            }
        }
    }
    if blocked.len() > MAX_DIRECT_CONTOURS {
        blocked = united_by_neighbors(blocked);
    }
    let mut overlay = overlay(&subject, &blocked);
    let inside = |[x, y]: [f64; 2]| Point::new(x.clamp(left, right), y.clamp(bottom, top));
    let polygon = |shape: Contours| {
        let mut contours = shape.into_iter().map(|contour| contour.into_iter().map(inside).collect::<Vec<_>>());
        Some(PolygonWithHoles { outer: contours.next()?, holes: contours.collect() })
    };
    overlay.overlay(rule, FillRule::NonZero).into_iter().filter_map(polygon).collect()
}

/// Number of contours above which neighbouring contours are united first.
const MAX_DIRECT_CONTOURS: usize = 128;

/// Number of contours in each group of the first round.
const CONTOURS_PER_GROUP: usize = 8;

/// Number of neighbouring groups whose outlines are united in each later round.
const GROUPS_PER_ROUND: usize = 4;

/// Greatest fraction of its corners that a group may keep after its union. Above it, contours hardly overlap, and only
/// the final union is computed.
const MAX_CORNER_SHARE: f64 = 0.75;

/// Distance within which corners are snapped to each other. Initially it is 256 steps of the grid, about 3e-15 of the
/// coordinates' range, and four times as much in each further round. With smaller distances, sides that almost coincide
/// are split thousands of times.
const SNAP_PRECISION: Precision = Precision { start: 16, progression: 4 };

type Overlay = FloatOverlay<[f64; 2], i64>;

type Contours = Vec<Vec<[f64; 2]>>;

fn overlay(subject: &[[f64; 2]], clip: &[Vec<[f64; 2]>]) -> Overlay {
    let solver = Solver { precision: SNAP_PRECISION, ..Solver::default() };
    Overlay::from_subj_and_clip_custom(subject, clip, OverlayOptions::ogc(), solver)
}

/// Returns contours with the same union but fewer crossings. Contours of small neighbouring pieces overlap almost completely, so
/// the union of a group has hardly more corners than its outline. The same is true for groups of groups. So the number of
/// crossings grows like the number of corners of the outlines, and not like the square of the number of contours.
fn united_by_neighbors(contours: Contours) -> Contours {
    let middle = |contour: &[[f64; 2]], k: usize| {
        let (low, high) =
            contour.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p[k]), h.max(p[k])));
        low + (high - low) / 2.0
    };
    let mut placed: Vec<PlacedContour> =
        contours.into_iter().map(|contour| ([0, 1].map(|k| middle(&contour, k)), contour)).collect();
    united_part(&mut placed).0
}

/// The middle of a contour's bounding box, and the contour.
type PlacedContour = ([f64; 2], Vec<[f64; 2]>);

/// Returns the outlines of the union of `part`, and true if they have clearly fewer corners.
fn united_part(part: &mut [PlacedContour]) -> (Contours, bool) {
    checkpoint();
    if part.len() <= CONTOURS_PER_GROUP {
        let group: Contours = part.iter_mut().map(|(_, contour)| std::mem::take(contour)).collect();
        return united_if_worth(group);
    }
    let mut parts = vec![part];
    while parts.len() < GROUPS_PER_ROUND && parts.iter().any(|part| part.len() > CONTOURS_PER_GROUP) {
        parts = parts.into_iter().flat_map(halve).collect();
    }
    let (mut outlines, mut worth) = (Contours::new(), false);
    for part in parts {
        let (more, was_worth) = united_part(part);
        outlines.extend(more);
        worth |= was_worth;
    }
    if worth { united_if_worth(outlines) } else { (outlines, false) }
}

/// Returns the outlines of a union, and true if they have clearly fewer corners than the contours.
fn united_if_worth(contours: Contours) -> (Contours, bool) {
    let corners = |contours: &Contours| contours.iter().map(Vec::len).sum::<usize>() as f64;
    let before = corners(&contours);
    let outlines: Contours =
        overlay(&[], &contours).overlay(OverlayRule::Union, FillRule::NonZero).into_iter().flatten().collect();
    let worth = corners(&outlines) <= MAX_CORNER_SHARE * before;
    (outlines, worth)
}

/// Halves a part across the longer side of the bounding box of the contours' middles.
fn halve(part: &mut [PlacedContour]) -> [&mut [PlacedContour]; 2] {
    let extent = |k: usize| {
        let values = || part.iter().map(|(at, _)| at[k]);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    let k = usize::from(extent(1) > extent(0));
    let half = part.len() / 2;
    part.select_nth_unstable_by(half, |(a, _), (b, _)| a[k].total_cmp(&b[k]));
    part.split_at_mut(half).into()
}

/// Returns the shifts by whole periods after which a range of values touches `range`.
fn copies(values: impl Iterator<Item = f64>, range: (f64, f64), period: Option<f64>) -> Vec<f64> {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    match period {
        None if low <= range.1 && high >= range.0 => vec![0.0],
        None => Vec::new(),
        Some(period) => {
            let (first, last) = (((range.0 - high) / period).ceil(), ((range.1 - low) / period).floor());
            (first as i64..=last as i64).map(|k| k as f64 * period).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, half: f64) -> Vec<Point> {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(i, j)| Point::new(x + i * half, y + j * half))
            .to_vec()
    }

    fn free_among(window: Window, periods: [Option<f64>; 2], contours: &[Vec<Point>]) -> Vec<PolygonWithHoles> {
        free_space(window, &corners(window), periods, contours.iter().map(Vec::as_slice))
    }

    #[test]
    fn an_obstacle_inside_is_a_hole() {
        let free = free_among([(0.0, 4.0), (0.0, 4.0)], [None, None], &[square(2.0, 2.0, 1.0)]);
        assert_eq!(free.len(), 1);
        assert_eq!(free[0].holes.len(), 1);
        assert!((free[0].area() - 12.0).abs() < 1e-9);
    }

    #[test]
    fn a_repeated_obstacle_blocks_every_period() {
        let wall = vec![Point::new(0.9, -1.0), Point::new(1.1, -1.0), Point::new(1.1, 9.0), Point::new(0.9, 9.0)];
        let free = free_among([(0.0, 10.0), (0.0, 4.0)], [Some(2.0), None], &[wall]);
        assert_eq!(free.len(), 6);
        assert!((free.iter().map(PolygonWithHoles::area).sum::<f64>() - (40.0 - 5.0 * 0.2 * 4.0)).abs() < 1e-9);
    }

    #[test]
    fn squares_touching_at_a_corner_separate_free_space() {
        let squares = [square(1.0, 1.0, 1.0), square(3.0, 3.0, 1.0)];
        let free = free_among([(0.0, 4.0), (0.0, 4.0)], [None, None], &squares);
        assert_eq!(free.len(), 2);
    }

    /// Tests squares on integer coordinates, whose free cells can be counted.
    #[test]
    fn the_union_of_many_squares_leaves_the_rest_free() {
        let n = 40_usize;
        // Steps of 7 visit the places of the lattice in an irregular order.
        for count in [MAX_DIRECT_CONTOURS - 1, MAX_DIRECT_CONTOURS + 1, 3 * MAX_DIRECT_CONTOURS, 1500] {
            let places: Vec<[usize; 2]> = (0..count).map(|i| 7 * i % (n * n)).map(|k| [k % n, k / n]).collect();
            // Every third square is three wide, so it overlaps others.
            let width = |i: usize| if i.is_multiple_of(3) { 3 } else { 1 };
            let mut covered = vec![[false; 40]; n];
            let squares: Vec<Vec<Point>> = places
                .iter()
                .enumerate()
                .map(|(i, &[x, y])| {
                    covered[y][x..(x + width(i)).min(n)].fill(true);
                    let (left, right) = (x as f64, (x + width(i)) as f64);
                    let (low, high) = (y as f64, y as f64 + 1.0);
                    [(left, low), (right, low), (right, high), (left, high)].map(|(x, y)| Point::new(x, y)).to_vec()
                })
                .collect();
            let side = (0.0, n as f64);
            let free = free_among([side, side], [None, None], &squares);
            let open = covered.iter().flatten().filter(|c| !**c).count() as f64;
            assert!((free.iter().map(PolygonWithHoles::area).sum::<f64>() - open).abs() < 1e-6, "{count}: {open}");
            for (y, row) in covered.iter().enumerate() {
                for (x, covered) in row.iter().enumerate() {
                    let middle = Point::new(x as f64 + 0.5, y as f64 + 0.5);
                    assert_eq!(free.iter().any(|polygon| polygon.contains(middle)), !covered, "({x}, {y}) of {count}");
                }
            }
        }
    }
}
