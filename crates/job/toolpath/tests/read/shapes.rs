//! Tests of lines through given points.

use cplan_toolpath::{Curve, Piece, Point, Source, Toolpath, arc_through, polyline, spline};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};

fn far(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Returns the curves as a line, which requires that they join.
fn joined(curves: impl IntoIterator<Item = Curve>) -> Toolpath {
    let piece = |curve| Piece { curve, speed: None, is_travel: false, dwell: None, source: Source::of_line(1) };
    Toolpath::new(curves.into_iter().map(piece).collect()).unwrap()
}

#[test]
fn a_rounded_square_has_the_known_length() {
    let points = [[0.5, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0], [0.5, 0.0]];
    let legs = polyline(&points, 0.1).unwrap();
    assert_eq!(legs.iter().map(|leg| leg.1).collect::<Vec<_>>(), [1, 1, 2, 2, 3, 3, 4, 4, 5]);
    let length = joined(legs.into_iter().map(|leg| leg.0)).length();
    assert!((length - (4.0 - 8.0 * 0.1 + TAU * 0.1)).abs() < 1e-12, "{length}");
}

#[test]
fn radii_that_do_not_fit_are_refused_with_the_greatest_one() {
    let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.3], [2.0, 0.3]];
    let error = polyline(&points, 0.2).unwrap_err();
    assert!(error.message.contains("between points 2 and 3"), "{error}");
    assert!(error.hint.contains("0.150000 m"), "{}", error.hint);
    assert!(polyline(&points, 0.1499).is_ok());
    // Arcs that fill the line between them.
    assert!(polyline(&[[0.2, 0.0], [0.0, 0.0], [0.0, 0.2], [0.2, 0.2]], 0.1).is_ok());
    // A line that returns on itself has no arc.
    assert!(polyline(&[[0.0, 0.0], [1.0, 0.0], [0.0, 0.0]], 0.01).is_err());
    assert_eq!(polyline(&[[0.0, 0.0], [1.0, 0.0], [0.0, 0.0]], 0.0).unwrap().len(), 2);
}

#[test]
fn arcs_pass_their_middle_point() {
    let (Curve::Arc { center, radius, by, .. }, 2) = arc_through([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]]).unwrap() else {
        panic!("an arc")
    };
    assert!(far(center, [0.0, 0.0]) < 1e-12 && (radius - 1.0).abs() < 1e-12 && (by - 2.0 * FRAC_PI_2).abs() < 1e-12);
    let error = arc_through([[0.0, 0.0], [0.5, 0.0], [1.0, 0.0]]).unwrap_err();
    assert!(error.message.contains("straight"), "{error}");
}

#[test]
fn closed_splines_are_smooth_where_they_close() {
    let points: Vec<Point> = (0..=8).map(|i| f64::from(i % 8) * TAU / 8.0).map(|a| [a.cos(), a.sin()]).collect();
    let curves: Vec<Curve> = spline(&points).unwrap().into_iter().map(|leg| leg.0).collect();
    // It is near the circle everywhere, the seam included.
    for curve in &curves {
        for k in 0..=10 {
            assert!((far(curve.at(f64::from(k) / 10.0), [0.0, 0.0]) - 1.0).abs() < 3e-3);
        }
    }
    let [first, last] = [curves[0].direction(0.0).unwrap(), curves[7].direction(1.0).unwrap()];
    assert!(far(first, last) < 1e-12, "{first:?} {last:?}");
}

proptest! {
    #![proptest_config(cplan_cases::cases(256))]

    /// Compares arcs with distances from the centre of a circle on which the points were chosen.
    #[test]
    fn arcs_lie_on_their_circle(
        x in -1.0..1.0_f64, y in -1.0..1.0_f64, radius in 0.01..1.0_f64, start in 0.0..TAU, by in 0.2..6.0_f64,
        share in 0.1..0.9_f64, left: bool,
    ) {
        let at = |u: f64| {
            let angle = if left { start + u * by } else { start - u * by };
            [x + radius * angle.cos(), y + radius * angle.sin()]
        };
        let (curve, _) = arc_through([at(0.0), at(share), at(1.0)]).unwrap();
        for k in 0..=8 {
            let u = f64::from(k) / 8.0;
            prop_assert!(far(curve.at(u), at(u)) < 1e-7, "{curve:?}");
        }
    }

    /// Checks rounded polylines: joined, tangents continuous, and as far from the corners as the formula says.
    #[test]
    fn rounded_corners_are_tangent(
        points in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 3..7), share in 0.05..0.95_f64,
    ) {
        let points: Vec<Point> = points.into_iter().map(|(x, y)| [x, y]).collect();
        prop_assume!(points.windows(2).all(|pair| far(pair[0], pair[1]) > 1e-3));
        // The greatest radius that fits: found by halving, since the error reports one.
        let (mut fits, mut refused) = (0.0, 10.0);
        for _ in 0..50 {
            let middle = (fits + refused) / 2.0;
            if polyline(&points, middle).is_ok() { fits = middle } else { refused = middle }
        }
        prop_assume!(fits > 1e-4 && fits < 5.0);
        let radius = fits * share;
        let curves: Vec<Curve> = polyline(&points, radius).unwrap().into_iter().map(|leg| leg.0).collect();
        let path = joined(curves.clone());
        prop_assert!(far(path.start(), points[0]) < 1e-12 && far(path.end(), points[points.len() - 1]) < 1e-9);
        for pair in curves.windows(2) {
            let [a, b] = [pair[0].direction(1.0).unwrap(), pair[1].direction(0.0).unwrap()];
            prop_assert!(far(a, b) < 1e-5, "{pair:?}");
        }
    }

    /// Checks splines by differences: they pass the points, and slopes and second derivatives agree at them.
    #[test]
    fn splines_are_twice_differentiable(
        points in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 2..9), closed: bool,
    ) {
        let mut points: Vec<Point> = points.into_iter().map(|(x, y)| [x, y]).collect();
        if closed && points.len() > 2 {
            points.push(points[0]);
        }
        prop_assume!(points.windows(2).all(|pair| far(pair[0], pair[1]) > 0.02));
        let is_closed = points.len() > 3 && points[0] == points[points.len() - 1];
        let curves: Vec<Curve> = spline(&points).unwrap().into_iter().map(|leg| leg.0).collect();
        let steps: Vec<f64> = points.windows(2).map(|pair| far(pair[0], pair[1])).collect();
        // Derivatives by the distance of the points, from those by the curve's parameter.
        let derivatives = |i: usize, end: f64| {
            let Curve::Cubic([a, b, c, d]) = curves[i] else { panic!("a cubic") };
            let [p, q, r] = if end > 0.5 { [b, c, d] } else { [a, b, c] };
            let first = [0, 1].map(|k| 3.0 * if end > 0.5 { r[k] - q[k] } else { q[k] - p[k] } / steps[i]);
            let second = [0, 1].map(|k| 6.0 * (p[k] - 2.0 * q[k] + r[k]) / (steps[i] * steps[i]));
            (first, second)
        };
        let scale = 1e-8 / (steps.iter().copied().fold(f64::INFINITY, f64::min).powi(2));
        let mut seams: Vec<[usize; 2]> = (1..curves.len()).map(|i| [i - 1, i]).collect();
        if is_closed {
            seams.push([curves.len() - 1, 0]);
        }
        for [before, after] in seams {
            let ((a1, a2), (b1, b2)) = (derivatives(before, 1.0), derivatives(after, 0.0));
            prop_assert!(far(a1, b1) < scale && far(a2, b2) < scale, "{a1:?} {b1:?} {a2:?} {b2:?}");
        }
        if !is_closed {
            let ends = [derivatives(0, 0.0).1, derivatives(curves.len() - 1, 1.0).1];
            prop_assert!(ends.iter().all(|second| far(*second, [0.0, 0.0]) < scale), "{ends:?}");
        }
        for (i, curve) in curves.iter().enumerate() {
            prop_assert!(far(curve.start(), points[i]) < 1e-12 && far(curve.end(), points[i + 1]) < 1e-12);
        }
    }
}

#[test]
fn hints_about_missing_points_name_the_key() {
    let single = [[1.0, 0.0]];
    let hints = [polyline(&single, 0.0), spline(&single)].map(|refused| refused.expect_err("an error").hint);
    assert_eq!(hints, ["points = [[x, y], [x, y]]", "spline = [[x, y], [x, y]]"]);
}
