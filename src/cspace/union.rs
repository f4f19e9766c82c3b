//! A window of the universal cover less all copies of the C-obstacles.

use super::Polygon;
use crate::geometry::Point;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::core::solver::Solver;
use i_overlay::float::overlay::{FloatOverlay, OverlayOptions};

/// Free parts of less area than this (products of rad and m) are left out: they are debris of rounding where contours
/// nearly touch, and too small for an arm to make use of.
const SLIVER_AREA: f64 = 1e-10;

/// The free parts of `window`: one polygon a connected component, outer contour counter-clockwise, holes clockwise.
///
/// Every contour is counter-clockwise and repeats by `periods` along each axis that has one. Corners are rounded to a
/// grid of some 1e-17 of the coordinates' range, which contours that carry a margin absorb.
pub(super) fn free_space<'a>(
    window: [(f64, f64); 2],
    periods: [Option<f64>; 2],
    contours: impl Iterator<Item = &'a [Point]>,
) -> Vec<Polygon> {
    let [(left, right), (bottom, top)] = window;
    let subject = vec![[left, bottom], [right, bottom], [right, top], [left, top]];
    let mut blocked: Vec<Vec<[f64; 2]>> = Vec::new();
    for contour in contours {
        let shifts = |k: usize| copies(contour.iter().map(move |p| p[k]), window[k], periods[k]);
        for dx in shifts(0) {
            for dy in shifts(1) {
                blocked.push(contour.iter().map(|p| [p.x + dx, p.y + dy]).collect());
            }
        }
    }
    let mut overlay = FloatOverlay::<[f64; 2], i64>::from_subj_and_clip_custom(
        &subject,
        &blocked,
        OverlayOptions::ogc(),
        Solver::default(),
    );
    let inside = |[x, y]: [f64; 2]| Point::new(x.clamp(left, right), y.clamp(bottom, top));
    overlay
        .overlay(OverlayRule::Difference, FillRule::NonZero)
        .into_iter()
        .filter_map(|shape| {
            let mut contours = shape.into_iter().map(|contour| contour.into_iter().map(inside).collect::<Vec<_>>());
            let polygon = Polygon { outer: contours.next()?, holes: contours.collect() };
            (polygon.area() > SLIVER_AREA).then_some(polygon)
        })
        .collect()
}

/// The shifts by whole periods that bring an extent into touch with a range.
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

    #[test]
    fn an_obstacle_inside_is_a_hole() {
        let free =
            free_space([(0.0, 4.0), (0.0, 4.0)], [None, None], [square(2.0, 2.0, 1.0)].iter().map(Vec::as_slice));
        assert_eq!(free.len(), 1);
        assert_eq!(free[0].holes.len(), 1);
        assert!((free[0].area() - 12.0).abs() < 1e-9);
    }

    #[test]
    fn a_repeated_obstacle_blocks_every_period() {
        let wall = vec![Point::new(0.9, -1.0), Point::new(1.1, -1.0), Point::new(1.1, 9.0), Point::new(0.9, 9.0)];
        let free = free_space([(0.0, 10.0), (0.0, 4.0)], [Some(2.0), None], [wall].iter().map(Vec::as_slice));
        assert_eq!(free.len(), 6);
        assert!((free.iter().map(Polygon::area).sum::<f64>() - (40.0 - 5.0 * 0.2 * 4.0)).abs() < 1e-9);
    }

    #[test]
    fn squares_that_touch_at_a_corner_part_what_lies_between() {
        let squares = [square(1.0, 1.0, 1.0), square(3.0, 3.0, 1.0)];
        let free = free_space([(0.0, 4.0), (0.0, 4.0)], [None, None], squares.iter().map(Vec::as_slice));
        assert_eq!(free.len(), 2);
    }
}
